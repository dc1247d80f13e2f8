#pragma once
#include <cmath>
#include <string>

#include "runners/kinds/stability/stability_tables.hpp"
#include "runners/store/record.hpp"

/// \file
/// A study of kind `stability` made from formulas.
namespace ricochet::synthetic {

/// Steps 1e-6 … 1e-2, one per half decade. Open: unstable beyond `open` (0: never). Closed: beyond `closed`; the scene
/// is seen to blow up beyond `seen`.
inline CaseRecord stability_case(const std::string& mass, double stiffness, double open, double closed, double seen) {
  CaseRecord record;
  record.axes = {{"mass", mass},
                 {"contact", "spring"},
                 {"contact.stiffness", stiffness},
                 {"time", "three-level"},
                 {"elements", 10}};
  record.id = mass + std::to_string(stiffness);
  record.status = Status::done;
  Table table = stability_type().head();
  Table observed{"stability_observed", "", named_columns({"step", "closed", "behaviour"}), {}};
  const auto limit = [](double h) { return h > 0 ? Cell(h) : Cell(); };
  for (const bool touching : {false, true})
    for (int i = 0; i <= 8; ++i) {
      const double step = std::pow(10, -6 + 0.5 * i), own = touching ? closed : open, met = touching ? seen : open;
      const bool grows = own > 0 && step > own, blows = met > 0 && step > met;
      table.rows.push_back({step, touching, grows ? step / own : 1.0, mass == "poor" ? "root −1 on <the kernel>" : "",
                            limit(own), limit(met), grows || blows ? "unstable" : "stable",
                            grows   ? "it grows"
                            : blows ? "observed: it blew up"
                                    : ""});
      observed.rows.push_back({step, touching, blows ? "diverged" : "stable"});
    }
  record.tables = {table, observed};
  return record;
}

/// Two masses × four stiffnesses, and a case that was refused.
inline StudyResults stability() {
  StudyResults out;
  out.name = "cells";
  out.kind = "stability";
  out.columns = {"mass", "contact", "contact.stiffness", "time", "elements"};
  for (const std::string mass : {"full", "poor"})
    for (const double stiffness : {1e2, 1e4, 1e6, 1e8})
      out.cases.push_back(stability_case(mass, stiffness, mass == "full" ? 2e-3 : 0, 1 / std::sqrt(stiffness) * 1e-2,
                                         1 / std::sqrt(stiffness) * (mass == "full" ? 1e-2 : 4e-2)));
  CaseRecord refused;
  refused.axes = {{"mass", "none at all"},
                  {"contact", "spring"},
                  {"contact.stiffness", 1e2},
                  {"time", "three-level"},
                  {"elements", 10}};
  refused.id = "refused";
  refused.status = Status::refused;
  refused.reasons = {"nothing to march"};
  Table table = stability_type().head();
  table.rows.push_back({1e-6, false, nullptr, "", nullptr, nullptr, "refused", refused.reason()});
  refused.tables = {table};
  out.cases.push_back(std::move(refused));
  out.expected_cases = static_cast<int>(out.cases.size());
  return out;
}

}  // namespace ricochet::synthetic
