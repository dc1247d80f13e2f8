#pragma once

// What a bifurcation study owes to its methods, on studies whose answer is known.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <memory>
#include <set>

#include "runners/kinds/sweep/sweep_tables.hpp"
#include "runners/run/finish_run.hpp"
#include "runners/table/table_reader.hpp"

using namespace ricochet;

namespace dynamics_tables_tests {

using Json = nlohmann::ordered_json;

/// What a case would have found for one value and one start.
struct Found {
  std::string regime = "periodic";
  int period = 1;
  std::function<std::array<double, 2>(int)> point;  ///< of period k
  bool mirrored = false;                            ///< the mirror image of that
  double viscosity = 0;
  std::string status = "done";
};

/// Two orbits that are told apart: one near the stops, one near the middle.
inline Found orbit(double x, double v, int period = 1) {
  return {"periodic", period, [=](int k) { return std::array{x + 0.03 * (k % period), v - 0.2 * (k % period)}; }};
}

/// Chaos of the logistic map, from a start that depends on `seed`, so that no two runs have the same points.
inline Found chaos(double seed, double centre = 0) {
  auto x = std::make_shared<std::vector<double>>(1, 0.1 + 0.8 * std::fmod(0.618 * seed, 1));
  return {"chaotic", 0, [=](int k) {
            while (static_cast<int>(x->size()) < k + 60) x->push_back(3.9 * x->back() * (1 - x->back()));
            const auto at = static_cast<std::size_t>(k + 50);
            return std::array{centre + 0.1 * ((*x)[at] - 0.5), (*x)[at + 1] - 0.5};
          }};
}

struct Method {
  std::vector<std::pair<std::string, Json>> axes;
  std::function<Found(double value, const std::string& start)> finds;
};

inline std::string id_of(const Method& method) {
  std::string id;
  for (const auto& [name, value] : method.axes)
    id += (value.is_string() ? value.get<std::string>() : value.dump()) + ";";
  return id;
}

inline CaseRecord make_case(const Method& method, const std::vector<double>& values,
                            const std::vector<std::string>& starts, int keep) {
  CaseRecord record;
  record.id = id_of(method);
  record.axes = method.axes;
  record.status = Status::done;
  Table table{"values",
              "",
              named_columns({"parameter", "start", "class", "period", "impacts_per_period", "symmetric",
                             "exponent_method", "attractor", "alpha_equivalent", "status", "reason"}),
              {}};
  NumberTable points = points_type().head();
  points.words = {{"start", starts}};
  for (std::size_t s = 0; s < starts.size(); ++s)
    for (const double value : values) {
      const Found found = method.finds(value, starts[s]);
      const bool done = found.status == "done";
      table.rows.push_back({value, starts[s], done ? found.regime : "failed",
                            found.period > 0 ? Cell(found.period) : Cell(), 2.0, nullptr, "", nullptr, found.viscosity,
                            found.status, done ? "" : "it diverged"});
      for (int k = 0; done && found.point && k < keep; ++k) {
        // The orbits here are no images of themselves: half a period later they are 0.06 and 0.5 lower.
        std::array<double, 2> here = found.point(k), opposite = {0.06 - here[0], 0.5 - here[1]};
        if (found.mirrored) std::swap(here, opposite);
        points.add({value, static_cast<double>(s), static_cast<double>(k), here[0], here[1], opposite[0], opposite[1]});
      }
    }
  record.tables.push_back(std::move(table));
  record.numbers.push_back(std::move(points));
  return record;
}

inline StudyResults study(const std::vector<Method>& methods, const std::vector<double>& values,
                          const std::vector<std::string>& starts = {"rest", "up"}, int keep = 120) {
  StudyResults results;
  results.kind = "bifurcation";
  results.study = {{"parameter", {{"pointer", "/scene/support/amplitude"}, {"values", values}}},
                   {"section", "strobe"},
                   {"scene", {{"structure", {{"damping", {{"stiffness", 1e-4}}}}}}}};
  for (const auto& [name, value] : methods.front().axes) results.columns.push_back(name);
  for (const Method& method : methods) results.cases.push_back(make_case(method, values, starts, keep));
  results.expected_cases = static_cast<int>(methods.size());
  return results;
}

/// A derived table, read by column.
class Derived {
 public:
  Derived(const StudyResults& results, const std::string& name) : table_(find_table(results.derived, name)) {
    REQUIRE(table_ != nullptr);
  }
  std::size_t size() const { return table_->rows.size(); }
  const Cell& at(std::size_t row, const std::string& column) const {
    const TableReader rows(*table_);
    return rows.cell(row, rows.column(column));
  }
  std::vector<Cell> column(const std::string& name) const {
    std::vector<Cell> out;
    for (std::size_t k = 0; k < size(); ++k) out.push_back(at(k, name));
    return out;
  }
  std::string text(std::size_t row, const std::string& column) const { return at(row, column).text(); }
  double number(std::size_t row, const std::string& column) const { return at(row, column).number().value(); }
  /// Rows that hold `value` in a column.
  std::vector<std::size_t> where(const std::string& name, const Cell& value) const {
    std::vector<std::size_t> out;
    for (std::size_t k = 0; k < size(); ++k)
      if (at(k, name) == value) out.push_back(k);
    return out;
  }

 private:
  const Table* table_ = nullptr;
};

inline std::vector<double> range(double from, double to, int count) {
  std::vector<double> out;
  for (int k = 0; k < count; ++k) out.push_back(from + (to - from) * k / (count - 1));
  return out;
}

inline Method method(double beta, int steps, int elements, std::function<Found(double, const std::string&)> finds) {
  return {{{"contact", "rigid"},
           {"time", "scheme"},
           {"time.beta", beta},
           {"elements", elements},
           {"steps_per_period", steps}},
          std::move(finds)};
}

inline std::set<std::string> identities(const Derived& values) {
  std::set<std::string> out;
  for (const Cell& attractor : values.column("attractor")) out.insert(attractor.text());
  return out;
}

inline const auto moving = [](double a, const std::string&) { return orbit(0.02 + 0.5 * (a - 0.07), 0.3); };

}  // namespace dynamics_tables_tests
