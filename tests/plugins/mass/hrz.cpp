#include "tests/plugins/mass/laws.hpp"

using namespace ricochet;
using namespace ricochet::testing;

TEST_CASE("hrz: the lumped mass with scaled rotations, bit for bit") {
  for (const StructureSpec& structure : {working_set().structure, unit_bar().structure}) {
    const auto space = make_space(structure, 7);
    CHECK(Eigen::MatrixXd(built(*mass("hrz"), space).mass) == Eigen::MatrixXd(built(*mass("lumped"), space).mass));
  }
}

TEST_CASE("hrz: of order 2 on a beam, whose largest pulsation is 21.78 √(EI/ρS)/ℓ²") {
  CHECK(pulsation_order(*mass("hrz"), unit_beam(), 20) == Approx(2).margin(0.02));
  CHECK(largest_pulsation(*mass("hrz"), unit_beam(), 40) == Approx(21.78).margin(0.006));  // the digits of the figure
}
