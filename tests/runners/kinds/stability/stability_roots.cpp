#include <catch2/catch.hpp>
#include <ricochet/measure/stability/stability.hpp>

#include "runners/kinds/stability/stability_tables.hpp"

using namespace ricochet;

namespace {

MarginalRoot root(std::complex<double> value, RootPlace place, bool defective = false, int count = 1) {
  return {value, place, "", defective, count};
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
