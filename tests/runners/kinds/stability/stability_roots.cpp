#include "runners/kinds/stability/stability_roots.hpp"

#include <catch2/catch.hpp>

using namespace ricochet;

namespace {

MarginalRoot root(std::complex<double> value, RootPlace place, bool defective = false, int count = 1) {
  return {value, place, "", defective, count};
}

CaseRecord case_of(const std::string& id, const char* mass, const char* scheme, Table roots) {
  CaseRecord record;
  record.id = id;
  record.axes = {{"mass", mass}, {"time", scheme}};
  record.status = "done";
  record.tables.push_back(std::move(roots));
  return record;
}

StepSpectrum with(std::vector<MarginalRoot> roots) {
  StepSpectrum out;
  out.marginal_roots = std::move(roots);
  return out;
}

}  // namespace

TEST_CASE("roots: those of a step that differ by their mode alone are one row, a step counts once") {
  std::vector<RootRow> rows;
  const std::complex<double> turned = std::polar(1.0, 0.3), other = std::polar(1.0, 0.4);
  add_roots(rows, false, 1e-4, 3, with({root(turned, RootPlace::mode), root(other, RootPlace::mode)}));
  add_roots(rows, false, 1e-3, 3, with({root(turned, RootPlace::mode)}));
  add_roots(rows, false, 1e-2, 3, with({}));
  add_roots(rows, true, 1e-3, 3, with({root(turned, RootPlace::kernel), root(other, RootPlace::kernel)}));
  const Table table = stability_roots_type().with(rows);
  REQUIRE(table.rows.size() == 3);
  CHECK(table.rows[0] == Row{false, "modes", "roots of modulus 1", false, 1e-4, 1e-3, 2, 3, 2});
  // On the kernel the angle is the scheme's.
  CHECK(table.rows[1] == Row{true, "kernel of the mass", "roots of modulus 1 at ±17.19°", false, 1e-3, 1e-3, 1, 3, 1});
}

TEST_CASE("roots: an answer tells which, where, on what and by whom, and who has none") {
  const double h = 1e-3;
  std::vector<RootRow> sawtooth, held;
  add_roots(sawtooth, false, h, 1, with({root(-1, RootPlace::kernel, true, 5)}));
  add_roots(held, true, h, 2, with({root(1, RootPlace::held_points)}));
  const TableType<RootRow> type = stability_roots_type();
  StudyResults results;
  results.columns = {"mass", "time"};
  results.cases = {
      case_of("a", "consistent", "newmark", type.head()), case_of("b", "singular", "newmark", type.with(sawtooth)),
      case_of("c", "consistent", "moreau-jean", type.with(held)), case_of("d", "consistent", "bathe", type.head())};
  const std::vector<std::string> said = roots_told(results, {"time"});
  REQUIRE(said.size() == 3);
  CHECK(said[0] ==
        "On the unit circle by the scheme alone, on the kernel of the mass, are double root −1, which grows linearly "
        "(mass singular): newmark.");
  CHECK(
      said[1] ==
      "On the unit circle by the scheme alone, on the held points, are root +1 (mass consistent): moreau-jean (at 50 % "
      "of the steps).");
  CHECK(said[2] == "No root on the unit circle but the motion's own: bathe.");
  CHECK(roots_told(StudyResults{}, {"time"}).empty());
}
