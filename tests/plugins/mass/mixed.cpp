#include "tests/plugins/mass/laws.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {
std::unique_ptr<MassStrategy> mixed(double r) {
  return mass("mixed", {{"r", r}});
}
}  // namespace

TEST_CASE("mixed: between the consistent and the lumped mass, which are its ends") {
  const auto space = make_space(working_set().structure, 5);
  const Eigen::MatrixXd C = built(*mass("consistent"), space).mass, L = built(*mass("lumped"), space).mass;
  CHECK(Eigen::MatrixXd(built(*mixed(0), space).mass) == C);
  CHECK(Eigen::MatrixXd(built(*mixed(1), space).mass) == L);
  CHECK((Eigen::MatrixXd(built(*mixed(0.25), space).mass) - (0.75 * C + 0.25 * L)).norm() <= 1e-15 * C.norm());
  for (int elements : {1, 2, 17}) check_inertia(*mixed(0.5), elements, 0);
}

TEST_CASE("mixed: r = 1/2 is of order 4 on a bar, whose largest pulsation is √6 c/ℓ") {
  // ω = Ω (1 − (Ωℓ/c)⁴/480): the terms of order 2 of both masses cancel.
  const double wave = 1.5707963267948966 / 8;
  CHECK(pulsation_error(*mixed(0.5), unit_bar(), 8) == Approx(-std::pow(wave, 4) / 480).epsilon(0.02));
  CHECK(pulsation_order(*mixed(0.5), unit_bar(), 8) == Approx(4).margin(0.02));
  CHECK(pulsation_order(*mixed(0.5), unit_bar(), 16) == Approx(4).margin(0.02));
  CHECK(pulsation_order(*mixed(0.4), unit_bar(), 16) == Approx(2).margin(0.05));
  // The clamped end takes some 1/N² off the wave of the highest mode.
  CHECK(largest_pulsation(*mixed(0.5), unit_bar(), 64) == Approx(std::sqrt(6)).margin(1e-3));
}

TEST_CASE("mixed: on a beam nothing cancels, r = 1/2 is of order 2") {
  CHECK(pulsation_order(*mixed(0.5), unit_beam(), 20) == Approx(2).margin(0.05));
}
