// Explicit schemes are stable to the limit that they declare, on a mode and on a beam.
#include "tests/amplification_roots.hpp"
#include "tests/plugins/time/family.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

std::vector<Choice> explicit_schemes() {
  return {scheme("central-difference"),
          scheme("carpenter-taylor-katona"),
          scheme("paoli-schatzman", {{"restitution", 0.8}}),
          scheme("cd-lagrange", {{"restitution", 0.8}}),
          scheme("noh-bathe"),
          scheme("noh-bathe", {{"split", 0.7}})};
}

}  // namespace

TEST_CASE("an explicit scheme's amplification leaves the unit circle at its declared limit") {
  for (const Choice& time : explicit_schemes())
    for (const double h : {1e-6, 1e-2}) {
      const StepPlan plan = plan_made(time, h);
      REQUIRE(plan.facts.stability_limit);
      const double limit = *plan.facts.stability_limit;
      const auto radius = [&](double frequency) {
        return std::abs(amplification_roots(plan, 1, 0, std::pow(frequency / h, 2)).at(0));
      };
      INFO(label(time) << " h = " << h << " limit " << limit);
      for (const double share : {0.1, 0.5, 0.9, 0.999}) CHECK(radius(share * limit) <= 1 + 1e-9);
      CHECK(radius(1.001 * limit) > 1.001);
    }
}

TEST_CASE("the declared limits are 2, and 3.745 for two solves of Noh and Bathe") {
  for (const Choice& time : explicit_schemes())
    if (time.name != "noh-bathe") CHECK(plan_made(time, 1e-3).facts.stability_limit == Approx(2).epsilon(1e-15));
  const StepPlan composed = plan_made(scheme("noh-bathe"), 1e-3);
  // p = 0.54: trace 1.16753, determinant 0.16753; a real root leaves through +1. At 3.743 it is still 0.982.
  CHECK(*composed.facts.stability_limit == Approx(3.745029).margin(1e-6));
  CHECK(composed.stages.size() == 2);
  // Per solve less than central differences: the price of the damping near the limit.
  CHECK(*composed.facts.stability_limit / 2 < 2);
}

TEST_CASE("on the lumped mass a beam marches below the limit of its fastest mode and diverges above it") {
  SceneSpec scene = compared_beam(0);
  const auto problem = problem_of(scene, 8, {"lumped"});
  const double fastest = 1 / std::sqrt(compliances(problem->stiffness, problem->inertia).minCoeff());
  for (const Choice& time : explicit_schemes()) {
    const double limit = *plan_made(time, 1).facts.stability_limit;
    INFO(label(time));
    const auto highest = [&](double share) {
      Marcher beam = marcher(scene, 8, {{"lumped"}, {"none"}, time}, share * limit / fastest);
      beam.start();
      double most = 0;
      for (int k = 0; k < 2000 && beam.status(0).running; ++k) {
        beam.march(1);
        most = std::max(most, std::abs(beam.tip(0)));
      }
      return most;
    };
    // 0.09 m at the start, and 3 m/s; the marcher stops what passes its bound of energy.
    CHECK(highest(0.99) < 0.3);
    CHECK_FALSE(highest(1.01) < 3);
  }
}

TEST_CASE("explicit schemes factorise nothing but the mass, where nothing is damped") {
  for (const Choice& time : explicit_schemes()) {
    INFO(label(time));
    for (const Stage& stage : plan_made(time, 1e-3).stages) {
      CHECK(stage.matrix.K == 0);
      CHECK(stage.matrix.M > 0);
    }
  }
}
