// What a plan does to one mode, against the closed forms of its scheme.
#include <ricochet/measure/stability/step_map.hpp>

#include "tests/amplification_roots.hpp"
#include "tests/marching.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

StepPlan plan(const Choice& time, double h) {
  auto made = plan_of(time, h, {});
  REQUIRE(std::holds_alternative<StepPlan>(made));
  return std::get<StepPlan>(made);
}

std::vector<Choice> all_schemes() {
  std::vector<Choice> schemes;
  for (const double beta : {0.0, 0.1, 0.2, 0.25, 0.3, 0.5})
    schemes.push_back({"newmark-dumont-paoli", {{"beta", beta}}});
  for (const double beta : {0.0, 0.1, 0.25, 0.3})
    for (const double gamma : {0.5, 0.6}) schemes.push_back({"newmark", {{"beta", beta}, {"gamma", gamma}}});
  for (const double theta : {0.5, 0.7, 1.0}) schemes.push_back({"moreau-jean", {{"theta", theta}}});
  for (const double alpha : {-1.0 / 3, -0.1, 0.0}) schemes.push_back({"hht-alpha", {{"alpha", alpha}}});
  for (const double rho : {0.0, 0.5, 1.0}) schemes.push_back({"bathe", {{"rho_inf", rho}}});
  schemes.push_back({"midpoint"});
  return schemes;
}

}  // namespace

TEST_CASE("Dumont–Paoli on the kernel of a singular mass has the roots of its polynomial") {
  const double h = 1e-3;
  for (const double beta : {0.25, 0.3, 0.4, 0.5})
    for (const double alpha : {0.0, 1e-4, 1e-2}) {
      // (β+a) r² + (1−2β) r + (β−a) = 0 with a = α/(2h).
      const double a = alpha / (2 * h);
      const auto roots = amplification_roots(plan({"newmark-dumont-paoli", {{"beta", beta}}}, h), 0, alpha, 1);
      REQUIRE(roots.size() == 2);
      for (const auto& r : roots) CHECK(std::abs((beta + a) * r * r + (1 - 2 * beta) * r + (beta - a)) < 1e-12);
      if (alpha == 0)
        // β = ¼ is a double root, known to the square root of round-off only.
        CHECK(std::abs(roots[0]) == Approx(1).margin(beta == 0.25 ? 1e-7 : 1e-13));
      else if (beta == 0.25)
        CHECK(std::abs(roots[0] + 1.0) < 1e-7);  // the sawtooth that no viscosity damps
      else
        CHECK(std::abs(roots[0]) < 1);
    }
}

TEST_CASE("each scheme is stable up to the limit that it declares and not beyond") {
  const double h = 1e-3;
  for (const Choice& scheme : all_schemes()) {
    const StepPlan step = plan(scheme, h);
    const auto radius = [&](double frequency) {
      return std::abs(amplification_roots(step, 1, 0, frequency * frequency / (h * h))[0]);
    };
    INFO(scheme.name);
    // A step of these schemes has roots of modulus one or less; 1e-6 is far below the growth of any instability here.
    if (step.facts.stability_limit) {
      CHECK(radius(0.99 * *step.facts.stability_limit) <= 1 + 1e-6);
      CHECK(radius(1.01 * *step.facts.stability_limit) > 1 + 1e-6);
    } else {
      for (const double frequency : {0.01, 1.0, 10.0, 1e3}) CHECK(radius(frequency) <= 1 + 1e-6);
    }
  }
}

TEST_CASE("viscosity damps every mode of a stable step") {
  const double h = 1e-3;
  int unlimited = 0;
  for (const Choice& scheme : all_schemes()) {
    const StepPlan step = plan(scheme, h);
    if (step.facts.stability_limit) continue;
    INFO(scheme.name);
    ++unlimited;
    for (const double frequency : {1.0, 100.0, 3000.0})
      CHECK(std::abs(amplification_roots(step, 1, 1e-4 * frequency * frequency, frequency * frequency)[0]) < 1);
  }
  CHECK(unlimited == 16);
}

TEST_CASE("the root at infinity is the one that each scheme is known by") {
  const double h = GENERATE(1e-6, 1e-3, 1.0);
  const auto root = [&](const Choice& time) { return root_at_infinity(plan(time, h)).value_or(-1); };
  // Double roots are known by their mean, to round-off of the matrix.
  const double accuracy = 1e-9;
  for (const double split : {0.0, 0.3, 0.5}) {
    CHECK(root({"bathe", {{"split", split}}}) == 0);
    for (const double rho : {0.3, 0.8, 1.0})
      CHECK(root({"bathe", {{"rho_inf", rho}, {"split", split}}}) == Approx(rho).margin(accuracy));
  }
  for (const double a : {0.0, 0.1, 0.2, 0.3})
    CHECK(root({"hht-alpha", {{"alpha", -a}}}) == Approx((1 - a) / (1 + a)).margin(accuracy));
  // Whatever root the slot has that only their energy reads, beyond ρ∞ below 1/3. Three roots coincide.
  for (const char* scheme : {"generalised-alpha", "wbz-alpha"})
    for (const double rho : {0.0, 0.1, 0.2, 0.3, 0.8}) {
      INFO(scheme);
      CHECK(root({scheme, {{"rho_inf", rho}}}) == Approx(rho).margin(1e-4));
    }
  CHECK(root({"newmark"}) == Approx(1).margin(accuracy));
  CHECK(root({"midpoint"}) == Approx(1).margin(accuracy));
  for (const double theta : {0.5, 0.7, 1.0})
    CHECK(root({"moreau-jean", {{"theta", theta}}}) == Approx((1 - theta) / theta).margin(accuracy));
  for (const double beta : {0.25, 0.3, 0.5})
    CHECK(root({"newmark-dumont-paoli", {{"beta", beta}}}) == Approx(1).margin(accuracy));
  // Central differences solve nothing with K.
  CHECK_FALSE(root_at_infinity(plan({"newmark-dumont-paoli", {{"beta", 0.0}}}, h)));
}
