#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "runners/kinds/sweep/sweep_tables.hpp"
#include "runners/run/finish_run.hpp"
#include "runners/table/table_reader.hpp"
#include "tests/runners/kinds/sweep/section_cases.hpp"

namespace dynamics_tables_tests {

namespace {

/// Two attractors: below the line y = slope x + 0.5 an orbit, above it another; beyond the unit circle, a failure.
CaseRecord basin_case(const std::string& mass, double slope, int count, bool interior_unmarched) {
  CaseRecord record;
  record.id = mass;
  record.axes = {{"mass", mass}, {"elements", 10}};
  record.status = Status::done;
  Table cells{"cells", "", named_columns({"x", "y", "class", "period", "attractor", "status", "reason"}), {}};
  NumberTable points = cell_points_type().head();
  for (int j = 0; j < count; ++j)
    for (int i = 0; i < count; ++i) {
      const double x = -1 + 2.0 * i / (count - 1), y = -1 + 2.0 * j / (count - 1);
      const bool failed = x * x + y * y > 1.9, above = y > slope * x + 0.1;
      const auto row = static_cast<double>(cells.rows.size());
      cells.rows.push_back(
          {x, y, failed ? "failed" : "periodic", failed ? Cell() : Cell(1), nullptr, failed ? "diverged" : "done", ""});
      if (failed || (interior_unmarched && std::abs(y - slope * x - 0.1) > 0.5)) continue;
      for (int k = 0; k < 20; ++k) {
        const double d = above ? 0.05 : -0.03, v = above ? 0.4 : 0.9;
        points.add({row, static_cast<double>(k), d, v, 0.06 - d, 0.5 - v});
      }
    }
  record.tables.push_back(std::move(cells));
  record.numbers.push_back(std::move(points));
  return record;
}

StudyResults basins(const std::vector<CaseRecord>& cases, const std::string& x, const std::string& y) {
  StudyResults results;
  results.kind = "basins";
  results.study = {{"axes", {{{"pointer", x}}, {{"pointer", y}}}}};
  results.columns = {"mass", "elements"};
  results.cases = cases;
  return results;
}

}  // namespace

TEST_CASE("basins of two attractors: shares, differences and a smooth boundary") {
  const int count = 41;
  for (const bool inside : {false, true})
    for (const std::string pointer : {"/scene/initial/displacement", "/scene/support/amplitude"}) {
      INFO(pointer << (inside ? ", interior by its class" : ""));
      if (inside && pointer != "/scene/initial/displacement") continue;
      const StudyResults results =
          with_tables(basins({basin_case("full", 0, count, inside), basin_case("poor", 0.5, count, inside)}, pointer,
                             "/scene/initial/velocity"));
      const Derived cells(results, "cells"), attractors(results, "attractors"), fractions(results, "basin_fractions"),
          differences(results, "basin_differences"), uncertainty(results, "basin_uncertainty");
      REQUIRE(attractors.size() == 2);
      CHECK(attractors.text(0, "label") == "common to all");
      CHECK(attractors.at(0, "from").is_nothing());
      REQUIRE(fractions.size() == 4);
      // Every decided cell has the attractor of its side, in both cases.
      std::array<int, 2> decided{}, above{};
      const Cell upper = cells.at(40 * 41 + 20, "attractor");
      for (std::size_t k = 0; k < cells.size(); ++k) {
        const bool poor = cells.text(k, "case") == "poor";
        if (cells.text(k, "class") == "failed") {
          CHECK(cells.at(k, "attractor").is_nothing());
          continue;
        }
        ++decided[poor];
        const bool high = cells.number(k, "y") > (poor ? 0.5 : 0) * cells.number(k, "x") + 0.1;
        above[poor] += high;
        REQUIRE((cells.at(k, "attractor") == upper) == high);
      }
      const std::size_t row = fractions.where("attractor", upper)[0];
      CHECK(fractions.number(row, "cells") == above[0]);
      CHECK(fractions.number(row, "fraction") == Approx(double(above[0]) / decided[0]));
      CHECK(fractions.number(row, "low") < fractions.number(row, "fraction"));
      CHECK(fractions.number(row, "high") > fractions.number(row, "fraction"));
      // Between the two lines: two triangles of height ½ and base 1 in a square of 4.
      REQUIRE(differences.size() == 1);
      CHECK(differences.number(0, "share") == Approx(0.125).margin(0.02));  // a cell's width on 41
      // A line: s = 1.
      CHECK(uncertainty.number(0, "low") < 1.05);
      CHECK(uncertainty.number(0, "high") > 0.95);
    }
}

TEST_CASE("every one of many chaotic sections belongs to an attractor") {
  // All chaotic is the dearest: 2400 sections take about 0.3 s of a free core.
  std::vector<Method> methods;
  for (int k = 0; k < 8; ++k)
    methods.push_back(method(k, 2000, 20, [=](double a, const std::string& start) {
      return chaos(k + a * 1300 + static_cast<double>(start.size()));
    }));
  StudyResults results = study(methods, range(0.07, 0.09, 100), {"rest", "up", "state"}, 300);
  results = with_tables(std::move(results));
  const Derived values(results, "values");
  CHECK(values.size() == 2400);
  for (const Cell& attractor : values.column("attractor")) CHECK(attractor.whole());
}

}  // namespace dynamics_tables_tests
