#pragma once
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "runners/kinds/comparison/comparison_tables.hpp"
#include "runners/store/record_values.hpp"
#include "tests/runners/report/synthetic.hpp"

/// \file
/// Results with derived tables, made from formulas: errors C (h/h₀)^p + D ℓ² that scatter, times in proportion to the
/// steps.
namespace ricochet::synthetic {

struct Scheme {
  std::string mass, velocity, time;
  double beta, order, constant, microseconds;
};

inline const std::vector<Scheme>& schemes() {
  static const std::vector<Scheme> all = {{"consistent", "", "newmark-dumont-paoli", 0.25, 1, 3e-3, 0.6},
                                          {"consistent", "", "newmark-dumont-paoli", 0.5, 1, 2e-3, 0.6},
                                          {"consistent", "", "moreau-jean", 0.5, 1, 6e-3, 0.9},
                                          {"singular", "P1", "newmark-dumont-paoli", 0.25, 1, 8e-4, 1.1},
                                          {"singular", "P1", "newmark-dumont-paoli", 0.5, 2, 9e-4, 1.1},
                                          {"singular", "P1", "moreau-jean", 0.5, 1, 1e-3, 1.4}};
  return all;
}

/// `scatter`: relative, of errors and times. One scheme diverges at the largest step, one is refused throughout.
inline StudyResults comparison(const std::vector<double>& steps = {1e-3, 5e-4, 2.5e-4, 1.25e-4, 6.25e-5, 3.125e-5},
                               const std::vector<int>& meshes = {20}, double scatter = 0.15) {
  StudyResults out;
  out.name = "work-precision-free";
  out.question = "Which method reaches a given error in the least time?";
  out.kind = "work-precision";
  out.study = {{"errors", {"tip-linf", "energy", "impact-times"}}};
  out.columns = {"mass", "mass.velocity", "contact", "time", "time.beta", "elements", "step"};
  const std::vector<std::string> kinds = {"tip-linf", "energy", "impact-times"};
  std::mt19937 random(4);
  std::uniform_real_distribution<double> noise(1 - scatter, 1 + scatter);
  std::vector<std::string> methods(out.columns.begin(), out.columns.end() - 1);
  const auto head = [](const char* name, std::vector<std::string> columns, const std::vector<std::string>& more) {
    columns.insert(columns.end(), more.begin(), more.end());
    return Table{name, "", named_columns(columns), {}};
  };
  Table errors = head("errors", out.columns, {"error", "value", "floor"}),
        work = head("work_precision", out.columns, {"error", "value", "run_seconds", "low", "high", "steps", "status"}),
        orders = head("orders", methods, {"refined", "error", "order", "low", "high", "declared", "verdict", "reason"});
  for (const Scheme& scheme : schemes())
    for (const int elements : meshes) {
      const auto axes = [&](bool with_mesh) {
        Row row = {scheme.mass, nullptr, "signorini", scheme.time, scheme.beta, nullptr};
        if (!scheme.velocity.empty()) row[1] = scheme.velocity;
        if (with_mesh) row[5] = elements;
        return row;
      };
      const bool refused = scheme.mass == "singular" && scheme.time == "moreau-jean";
      for (const double step : steps) {
        CaseRecord record;
        Row row = axes(true);
        row.push_back(step);
        for (size_t c = 0; c < row.size(); ++c)
          if (!row[c].is_nothing()) record.axes.emplace_back(out.columns[c], json_of(row[c]));
        record.id = "case" + std::to_string(out.cases.size());
        record.status = Status::done;
        record.steps = std::llround(0.5 / step);
        if (refused) {
          record.status = Status::refused;
          record.reasons = {"this law needs a regular mass"};
        } else if (scheme.time == "moreau-jean" && step > 9e-4) {
          record.status = Status::diverged;
          record.reasons = {"step 12, t = 0.012 s: the energy passed the bound"};
        }
        const double seconds = scheme.microseconds * 1e-6 * static_cast<double>(record.steps) * noise(random);
        if (record.status == Status::done) record.run_seconds = seconds;
        for (size_t k = 0; k < kinds.size(); ++k) {
          const double value =
              (k == 1 ? 40 : 1) * noise(random) *
              (scheme.constant * std::pow(step / steps[0], scheme.order) + 1e-2 / (elements * elements));
          Row worked = row;
          const bool has = record.status == Status::done && !(kinds[k] == "impact-times" && step > 9e-4);
          if (has) {
            Row error = row;
            error.insert(error.end(), {kinds[k], value, k == 2 ? 1e-18 : (k == 1 ? 40 : 1) * 3e-5});
            errors.rows.push_back(std::move(error));
            record.measures.emplace_back("error." + kinds[k], value);
            record.measures.emplace_back("floor." + kinds[k], k == 2 ? 1e-18 : (k == 1 ? 40 : 1) * 3e-5);
          }
          const bool done = record.status == Status::done;
          worked.insert(worked.end(), {kinds[k], has ? Cell(value) : Cell(), done ? Cell(seconds) : Cell(),
                                       done ? Cell(0.93 * seconds) : Cell(), done ? Cell(1.2 * seconds) : Cell(),
                                       record.steps, word(record.status)});
          work.rows.push_back(std::move(worked));
        }
        if (record.status == Status::done)
          record.measures.insert(
              record.measures.end(),
              {{"timed_seconds", seconds}, {"timed_low", 0.93 * seconds}, {"timed_high", 1.2 * seconds}});
        out.cases.push_back(std::move(record));
      }
      if (refused) continue;
      for (const char* refined : {"step", "elements"})
        for (const std::string& kind : kinds) {
          if (std::string(refined) == "elements" && (meshes.size() < 2 || elements != meshes.front())) continue;
          const bool step = std::string(refined) == "step";
          const double order = step ? scheme.order : 2, declared = 1;
          Row row = axes(step);
          row.insert(row.end(), {refined, kind, order - 0.03, order - 0.1, order + 0.08});
          if (step)
            row.push_back(declared);
          else
            row.push_back(nullptr);
          row.insert(row.end(), {!step               ? "undecided"
                                 : order == declared ? "confirmed"
                                                     : "refuted",
                                 !step               ? "no order is declared; 4 of 4 points"
                                 : order == declared ? "agrees with the declared 1; 6 of 6 points <all>"
                                                     : "converges faster than the declared 1; 6 of 6 points"});
          orders.rows.push_back(std::move(row));
        }
    }
  out.expected_cases = static_cast<int>(out.cases.size());
  Table effects = head("effects", {}, {"measure", "factor", "share", "low", "high", "log"});
  const auto share = [&](const char* measure, const char* factor, double value, bool log) {
    effects.rows.push_back({measure, factor, value, 0.8 * value, std::min(1.0, 1.1 * value), log});
  };
  for (const char* measure : {"error.tip-linf", "energy_end"}) {
    const bool first = std::string(measure) == "error.tip-linf";
    share(measure, "mass", first ? 0.09 : 0.86, first);
    share(measure, "contact", 0, first);
    share(measure, "time", first ? 0.02 : 0.025, first);
    share(measure, "step", first ? 0.81 : 0.01, first);
    share(measure, "mass × time", 0.01, first);
    share(measure, "mass × step", first ? 0.055 : 0.08, first);
    share(measure, "mass × time × step", 0.01, first);
    share(measure, "higher", 0.005, first);
  }
  out.derived = {errors, orders, work, effects, precision_targets_table(out), order_verdicts_table(orders)};
  return out;
}

}  // namespace ricochet::synthetic
