#pragma once
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "runners/kinds/sweep/diagram_tables.hpp"
#include "runners/kinds/sweep/sweep_tables.hpp"
#include "runners/store/record_values.hpp"

/// \file
/// A study of kind `bifurcation` made from formulas. The cubic map x → a x − x³, which is odd as the shaken beam is,
/// stands for the structure. The names of the methods stand for themselves.
namespace ricochet::synthetic {

struct DynamicsShape {
  int values = 120, kept = 200;
  std::vector<std::string> starts = {"rest", "up", "down"};
  std::vector<std::pair<std::string, double>> methods = {{"three-level", 0.5}, {"three-level", 0.25}};
  bool exponents = true, portraits = true, refused = true;
};

/// One orbit of the map at a ∈ [0, 3], with its exponent.
struct MapOrbit {
  std::vector<double> x;
  double exponent = 0;
  int period = 0;  ///< 0: none found
};

inline MapOrbit map_orbit(double a, double x0, int kept) {
  MapOrbit out;
  double x = x0, sum = 0;
  for (int k = 0; k < 2000; ++k) x = a * x - x * x * x;
  for (int k = 0; k < kept; ++k) {
    x = a * x - x * x * x;
    sum += std::log(std::max(std::abs(a - 3 * x * x), 1e-12));
    out.x.push_back(x);
  }
  out.exponent = sum / kept;
  for (int p = 1; p <= 64 && out.period == 0; ++p) {
    double worst = 0;
    for (size_t k = static_cast<size_t>(p); k < out.x.size(); ++k)
      worst = std::max(worst, std::abs(out.x[k] - out.x[k - static_cast<size_t>(p)]));
    if (worst < 1e-6) out.period = p;
  }
  return out;
}

inline CaseRecord dynamics_case(const std::string& time, double beta, const DynamicsShape& shape) {
  CaseRecord record;
  record.id = time.substr(0, 3) + std::to_string(static_cast<int>(100 * beta));
  record.axes = {{"mass", "full"},    {"contact", "rigid"}, {"time", time},
                 {"time.beta", beta}, {"elements", 20},     {"steps_per_period", 2000}};
  record.status = Status::done;
  record.steps = 1200000;
  Table values = values_head(1), changes = bifurcations_head();
  NumberTable points = points_type().head(), portraits = portraits_type().head();
  points.words = portraits.words = {{"start", shape.starts}};
  const auto push = [](NumberTable& table, std::initializer_list<double> row) { table.add(row); };
  for (size_t s = 0; s < shape.starts.size(); ++s) {
    std::string previous;
    double previous_value = 0;
    for (int i = 0; i < shape.values; ++i) {
      const double amplitude = 0.07 + 0.03 * i / std::max(shape.values - 1, 1);
      const double a = 1.2 + 1.75 * (amplitude - 0.07) / 0.03 + (beta < 0.3 ? 0.06 : 0);
      const bool refused = shape.refused && amplitude > 0.0995;
      if (refused) {
        auto& row = values.rows.emplace_back(values.columns.size(), Cell(nullptr));
        row[0] = amplitude, row[1] = shape.starts[s], row[2] = "failed";
        row[row.size() - 2] = "refused", row.back() = "the support passes the <stop> at 0.0995 m";
        continue;
      }
      const bool still = shape.starts[s] == "rest" && amplitude < 0.0791792;
      const double start = still ? 0 : shape.starts[s] == "down" ? -0.3 : 0.3;
      const MapOrbit orbit = map_orbit(a, start, shape.kept);
      const std::string kind = still                   ? "no contact"
                               : orbit.period > 0      ? "periodic"
                               : orbit.exponent > 0.01 ? "chaotic"
                                                       : "undecided";
      const std::string text = kind == "periodic" ? "periodic " + std::to_string(orbit.period) : kind;
      if (!previous.empty() && previous != text)
        changes.rows.push_back({shape.starts[s], previous, text, previous == "no contact" ? "grazing" : "change",
                                0.5 * (previous_value + amplitude), previous_value, amplitude, 12});
      previous = text;
      previous_value = amplitude;
      const Cell exponent = shape.exponents ? Cell(orbit.exponent) : Cell(nullptr);
      const Cell low = shape.exponents ? Cell(orbit.exponent - 0.05) : Cell(nullptr),
                 high = shape.exponents ? Cell(orbit.exponent + 0.05) : Cell(nullptr);
      values.rows.push_back({amplitude,
                             shape.starts[s],
                             kind,
                             orbit.period > 0 ? Cell(orbit.period) : Cell(nullptr),
                             still ? 0.0 : 2.0,
                             kind == "periodic" ? Cell(orbit.period % 2 == 0) : Cell(nullptr),
                             exponent,
                             low,
                             high,
                             shape.exponents ? "tangent+jump" : "",
                             shape.exponents ? Cell(orbit.exponent + 0.01) : Cell(nullptr),
                             beta < 0.3 ? "root −1 on the kernel, of the scheme" : "",
                             nullptr,
                             beta < 0.3 ? 5e-5 : 2e-9,
                             1e-9,
                             0.8,
                             0.1,
                             300,
                             true,
                             false,
                             0.1,
                             0.0,
                             "recurs with period " + std::to_string(orbit.period) + " to 1e-9 of the scale",
                             "done",
                             ""});
      for (int k = 0; k < shape.kept; ++k) {
        const double x = 0.05 * orbit.x[static_cast<size_t>(k)], v = 0.7 * std::sin(40 * x);
        push(points, {amplitude, double(s), double(k), x, v, -x, -v});
      }
      if (shape.portraits && i % 2 == 0)
        for (int k = 0; k <= 200; ++k) {
          const double t = 0.628 * 2 * k / 200;
          push(portraits, {amplitude, double(s), t, 0.05 * orbit.x.back() * std::cos(10 * t),
                           -0.5 * orbit.x.back() * std::sin(10 * t)});
        }
    }
  }
  record.tables = {std::move(values), std::move(changes)};
  record.numbers = {std::move(points), std::move(portraits)};
  return record;
}

/// The derived tables, as runners/kinds/sweep/sweep_tables.hpp says them, from formulas as well.
inline void derive_synthetic(StudyResults& out) {
  const auto row_of = [&](const CaseRecord& record, std::initializer_list<Cell> more) {
    Row row = place_of(out, record);
    row.insert(row.end(), more.begin(), more.end());
    return row;
  };
  Table distances = table_of_cases(out, distances_type().head()), shifts = table_of_cases(out, shifts_type().head()),
        agreement = agreement_type().head(),
        values = table_of_cases(out, "values", "", named_columns({"parameter", "start", "attractor"}));
  const std::string& reference = out.cases.front().id;
  for (size_t c = 0; c < out.cases.size(); ++c) {
    const CaseRecord& record = out.cases[c];
    for (const auto& row : record.tables.front().rows) {
      const double parameter = row[0].number().value();
      values.rows.push_back(
          row_of(record, {parameter, row[1], row[2] == "failed" ? Cell(nullptr) : Cell(1 + (parameter > 0.085))}));
      if (c == 0 || row[2] == "failed") continue;
      const double far = 0.02 * static_cast<double>(c) * std::exp(60 * (parameter - 0.085));
      const bool same = row[2] == "no contact";
      distances.rows.push_back(row_of(record, {reference, parameter, row[1], same ? 0.0 : far, same ? 0.0 : 3 * far,
                                               0.01, 0.03, far / 0.01, parameter < 0.085, "exact"}));
    }
    if (c > 0) {
      shifts.rows.push_back(row_of(record, {reference, "up", "periodic 1", "periodic 2", "change", 0.0838, 0.0828,
                                            -0.001, -0.0012, -0.0008, true}));
      shifts.rows.push_back(row_of(record, {reference, "up", "chaotic", "periodic 3", "change", 0.0938, nullptr,
                                            nullptr, nullptr, nullptr, false}));
    }
    for (size_t o = 0; o < out.cases.size(); ++o) {
      const double share = std::exp(-0.3 * std::abs(static_cast<double>(c) - static_cast<double>(o)));
      agreement.rows.push_back({record.id, out.cases[o].id, 300, std::round(300 * share), std::round(300 * share) / 300,
                                std::round(280 * share), std::round(280 * share) / 300});
    }
  }
  out.derived.push_back(std::move(values));
  out.derived.push_back(attractors_type().head());
  out.derived.back().rows = {{1, "common to all", 2, 0.07, 0.085, "periodic", 1, true, 0.66, 0.6, 0.71, "",
                              "Attractor 1 is met by all cases."},
                             {2, "depends on time.beta", 1, 0.085, 0.1, "chaotic", nullptr, nullptr, 0.34, 0.29, 0.4,
                              "time.beta 0.25: 1 of 1, 0.5: 0 of 1", "Attractor 2 is met with time.beta 0.25 <only>."}};
  out.derived.push_back(std::move(distances));
  out.derived.push_back(std::move(shifts));
  out.derived.push_back(std::move(agreement));
  out.derived.push_back(verdicts_type().head());
  out.derived.back().rows = {
      {0.07, 0.085, "robust", "", "Between 0.07 and 0.085 all methods agree."},
      {0.085, 0.092, "depends", "time.beta", "Between 0.085 and 0.092 time.beta decides: 2 of 2 <differ>."},
      {0.092, 0.1, "undecided", "", "Between 0.092 and 0.1 3 values are undecided."}};
  Table shares_of_range = verdict_shares_table(out.derived.back(), {});
  out.derived.push_back(std::move(shares_of_range));
  const dynamics::StudyDiagram study = dynamics::read_diagram(out);
  for (Table made : {class_counts_table(study), grazing_ranges_table(out, {}), numerical_viscosity_table(study)})
    out.derived.push_back(std::move(made));
}

/// The study with the tables that are derived of all cases.
inline StudyResults dynamics(const DynamicsShape& shape = {}) {
  StudyResults out;
  out.name = "bifurcation-beta";
  out.question = "Does the scheme's parameter change the bifurcation diagram?";
  out.kind = "bifurcation";
  out.study = {{"name", out.name},
               {"parameter", {{"pointer", "/scene/support/amplitude"}, {"values", {0.07, 0.1}}}},
               {"scene", {{"structure", {{"damping", {{"stiffness", 1e-4}, {"mass", 0}}}}}}},
               {"section", "strobe"},
               {"phase", 0.0}};
  out.columns = {"mass", "contact", "time", "time.beta", "elements", "steps_per_period"};
  out.axes = {{"support.amplitude", "m", ""}};
  for (const auto& [time, beta] : shape.methods) out.cases.push_back(dynamics_case(time, beta, shape));
  out.expected_cases = static_cast<int>(out.cases.size());
  derive_synthetic(out);
  return out;
}

/// A study of kind `basins`: the half-planes of x + y/2 against a wavy border, which the second case moves by `shift`.
/// A third attractor is near the origin. A corner failed, and one row is not known yet. The attractor of number k has
/// period k, and the largest basin but k − 1.
inline StudyResults basins(int count = 40, double shift = 0.2) {
  StudyResults out;
  out.name = "basins";
  out.question = "Does the mass matrix move the border?";
  out.kind = "basins";
  out.study = {{"name", out.name},
               {"scene", {{"initial", {{"displacement", "0.1*x"}, {"velocity", 0}}}}},
               {"axes", {{{"pointer", "/scene/initial/displacement"}}, {{"pointer", "/scene/initial/velocity"}}}}};
  out.columns = {"mass", "elements"};
  const TableType<CellRow> type = cells_type();
  for (const std::string mass : {"full", "poor"}) {
    CaseRecord record;
    record.id = mass;
    record.status = Status::done;
    record.axes = {{"mass", mass}, {"elements", 10}};
    std::vector<CellRow> cells;
    NumberTable points = cell_points_type().head();
    std::set<int> met;
    for (int j = 0; j < count - 1; ++j)
      for (int i = 0; i < count; ++i) {
        const double x = -1 + 2.0 * i / (count - 1), y = -2 + 4.0 * j / (count - 1);
        if (x < -0.9 && y < -1.8) {
          cells.push_back({"", x, y, "failed", {}, {}, true, {}, "failed", "the support passes the <stop>"});
          continue;
        }
        const int attractor = x * x + y * y < 0.1                                                  ? 3
                              : x + 0.5 * y + 0.2 * std::sin(6 * y) > (mass == "poor" ? shift : 0) ? 2
                                                                                                   : 1;
        // The section of the first cell of an end stands for all.
        const auto cell = static_cast<double>(cells.size());
        for (int k = 0; met.count(attractor) == 0 && k < attractor; ++k)
          points.add({cell, static_cast<double>(k), 0.1 * attractor + k, 0.2 * k, -0.1 * attractor - k, -0.2 * k});
        met.insert(attractor);
        cells.push_back({"", x, y, "periodic", attractor, attractor, true, {}, "done", ""});
      }
    record.tables = {type.with(cells)};
    record.numbers = {std::move(points)};
    out.cases.push_back(std::move(record));
  }
  out.expected_cases = 2;
  return out;
}

/// Changes the cells of every case: `change(row, number of the row)`.
template <class Change>
StudyResults with_cells(StudyResults results, const Change& change) {
  const TableType<CellRow> type = cells_type();
  for (CaseRecord& record : results.cases) {
    std::vector<CellRow> cells = type.read(record.tables);
    for (std::size_t k = 0; k < cells.size(); ++k) change(cells[k], k);
    record.tables = {type.with(cells)};
  }
  return results;
}

}  // namespace ricochet::synthetic
