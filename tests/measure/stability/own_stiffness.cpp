// Steps while stops of unlike stiffness are closed: against a law of that stiffness, and against springs in K itself.
#include <ricochet/measure/stability/stability.hpp>

#include "tests/marching.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

SceneSpec two_stops(StopParameters first, StopParameters second) {
  SceneSpec scene = unit_beam();
  scene.stops = {};
  Place middle, end;
  middle.x = 0.5;
  end.x = 1;
  scene.stops.named = {{"middle", middle, {}, -0.1, {}, "", {}, {}, first}, {"end", end, {}, -0.1, {}, "", {}, {}, second}};
  return scene;
}

StabilityPredictor springs(const std::shared_ptr<const SemiDiscrete>& problem, double stiffness) {
  const Choice choice{"penalty", {{"stiffness", stiffness}, {"evaluation", std::string("averaged")}}};
  const auto* entry = registry().contact("penalty");
  const auto law = make(entry, choice);
  return {problem,
          linear_law(*law, problem->points(), complete(entry->manual.parameters, choice.values), problem->own)};
}

double radius(const SpectrumOrRefusal& spectrum) {
  REQUIRE(std::holds_alternative<StepSpectrum>(spectrum));
  return std::get<StepSpectrum>(spectrum).radius;
}

const ClosedSet& set_of(const StabilityPredictor& predictor, std::size_t points, int first = -1) {
  for (const ClosedSet& set : predictor.sets())
    if (set.points.size() == points && (first < 0 || set.points.front() == first)) return set;
  FAIL("no such set");
  return predictor.sets().front();
}

}  // namespace

TEST_CASE("closed stops of unlike stiffness step as springs of that stiffness in the structure") {
  constexpr double soft = 40, hard = 900, h = 0.05;
  // What it loses in a step depends on the slowest mode, hence on both springs.
  const Choice scheme{"newmark", {{"beta", 0.49}, {"gamma", 0.8}}};
  const auto unlike = problem_of(two_stops({.stiffness = soft}, {.stiffness = hard}), 6, {"consistent"});
  const auto plain = problem_of(two_stops({}, {}), 6, {"consistent"});
  const StabilityPredictor own = springs(unlike, 7), softer = springs(plain, soft), harder = springs(plain, hard);
  const StepPlan plan = std::get<StepPlan>(plan_of(scheme, h, {.dofs = plain->dofs(), .contact = true}));
  CHECK(radius(own.closed(plan, h, set_of(own, 1, 0))) ==
        Approx(radius(softer.closed(plan, h, set_of(softer, 1, 0)))).epsilon(1e-12));
  CHECK(radius(own.closed(plan, h, set_of(own, 1, 1))) ==
        Approx(radius(harder.closed(plan, h, set_of(harder, 1, 1)))).epsilon(1e-12));

  auto held = std::make_shared<SemiDiscrete>(*plain);
  const SparseMatrix H = held->contact;
  Eigen::VectorXd kappa(2);
  kappa << soft, hard;
  held->stiffness += SparseMatrix(H.transpose() * kappa.asDiagonal() * H);
  LinearLaw open;
  open.absent = true;
  const double both = radius(own.closed(plan, h, set_of(own, 2)));
  CHECK(both == Approx(radius(StabilityPredictor(held, open).open(plan, h))).epsilon(1e-9));
  CHECK(std::abs(both - radius(softer.closed(plan, h, set_of(softer, 2)))) > 1e-6);
}
