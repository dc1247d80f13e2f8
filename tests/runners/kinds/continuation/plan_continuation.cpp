// Laws of the forecast of a branch that is followed by steps, and what its map makes for a value.
#include "runners/kinds/continuation/continuation_study.hpp"
#include "runners/kinds/continuation/continued_map.hpp"
#include "tests/runners/kinds/continuation/tube_study.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

Json hertz_tube() {
  Json study = tube_continuation();
  study["methods"]["contact"] = {{"name", "hertz"}, {"stiffness", 1e8}};
  study["follow"] = "steps";
  return study;
}

double planned_seconds(const Json& study) {
  const OpenedContinuation opened = opened_continuation(study);
  const CasePlan plan = plan_continuation(opened.study.cases.front(), *opened.registry);
  REQUIRE(plan.refusal.empty());
  return plan.predicted_seconds;
}

}  // namespace

TEST_CASE("a branch that is followed by steps costs the more the more steps a period has and the more dofs move") {
  Json study = hertz_tube();
  const double coarse = planned_seconds(study);
  study["steps_per_period"] = 2000;
  const double fine = planned_seconds(study);
  CHECK(fine > 3 * coarse);
  CHECK(fine < 10 * coarse);
  study["mesh"]["elements"] = 10;
  CHECK(planned_seconds(study) > 2 * fine);  // more orbits, and more columns in each march
}

TEST_CASE("steps at a value that enters linearly make no scene, and are those of its own scene") {
  const OpenedContinuation opened = opened_continuation(hertz_tube());
  const StudyCase& one = opened.study.cases.front();
  const ContinuationPlan plan = continuation_plan(one.settings);
  ContinuedMap continued(one, *opened.registry, plan);
  REQUIRE(continued.refusal().empty());
  SteppedMap map = continued.stepped_map(0.085);
  const MapClock clock{one.steps_per_period, 1, false};
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(map.size());
  const int scenes = continued.scenes().count();
  for (const double value : {0.071, 0.0777, 0.0899}) {
    const SteppedMap::Image image = map.march(rest, value, clock);
    REQUIRE(!image.end);
    CHECK(continued.scenes().count() == scenes);
    std::string reason;
    ContinuedMap other(one, *opened.registry, plan);
    const int own = other.scene_at(value, false, reason);
    REQUIRE(own >= 0);
    const auto make = [&](double, int) { return SteppedMap::Scene{other.program(own), 0}; };
    const auto carry = [](const LaneState& state, int, int) { return state; };
    SteppedMap of_scene(make, carry, value, continued.units());
    const Eigen::VectorXd expected = of_scene.march(rest, value, clock).image;
    CHECK(map.metric().size(image.image - expected) < 1e-10 * map.metric().size(expected));
  }
}
