// States at rest under a load and the stops, and motions that begin there.
#include <ricochet/scene/bodies.hpp>
#include <ricochet/scene/history/time_history.hpp>

#include "tests/marching.hpp"
#include "tests/refusals.hpp"
#include "tests/scene/structure/beam_files.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

Place at_length(double x) {
  Place place;
  place.x = x;
  return place;
}

LoadTerm push_length(double x, const std::string& formula) {
  LoadTerm term;
  term.force = true;
  term.at = x;
  term.history = Formula(formula, "", "t");
  return term;
}

/// A cantilever of EI = L = 1 that its tip stop lifts by 0.01 m, and pushes 0.06 N at its middle onto another one.
SceneSpec preloaded_beam() {
  SceneSpec scene = unit_beam();
  scene.stops = {};
  scene.stops.named = {{"tip", at_length(1), {}, 0.01, {}}, {"middle", at_length(0.5), {}, {}, 0.05}};
  scene.load.terms = {push_length(0.5, "0.06")};
  scene.initial.equilibrium = true;
  return scene;
}

Choice half_newmark() {
  return {"newmark-dumont-paoli", {{"beta", 0.5}}};
}

}  // namespace

TEST_CASE("a cantilever rests on its stop as statics say") {
  // Tip w = P_m (5/48) + P_t/3 with EI = L = 1: 0.06·5/48 = 0.00625, the stop adds 3·(0.01 − 0.00625).
  const auto rigid = problem_of(preloaded_beam(), 4, {"consistent"}, Choice{"signorini"});
  const Eigen::VectorXd at = rigid->contact * rigid->position;
  CHECK(at[0] == Approx(0.01).epsilon(1e-13));
  const double push = 3 * (0.01 - 0.00625);
  CHECK(at[1] == Approx(0.06 / 24 + push * 5 / 48).epsilon(1e-12));
  // A spring κ: p = κ(0.01 − w), w = 0.00625 + p/3.
  constexpr double kappa = 30;
  const auto spring = problem_of(preloaded_beam(), 4, {"consistent"}, Choice{"penalty", {{"stiffness", kappa}}});
  const double p = (0.01 - 0.00625) / (1 / kappa + 1.0 / 3);
  CHECK((spring->contact * spring->position)[0] == Approx(0.00625 + p / 3).epsilon(1e-12));
  // Without contact the tip stays below its stop.
  const auto open = problem_of(preloaded_beam(), 4, {"consistent"}, Choice{"none"});
  CHECK((open->contact * open->position)[0] == Approx(0.00625).epsilon(1e-12));
}

TEST_CASE("a rod between two rigid dimples rests on them, whatever its mesh") {
  SceneSpec scene = unit_beam();
  beam_of(scene).supports.emplace();
  beam_of(scene).supports->push_back({.name = "pin", .x = 0, .type = BeamSupport::Type::pinned});
  scene.stops = {};
  scene.stops.named = {{"low", at_length(0.4), {}, 0.001, {}}, {"high", at_length(1), {}, {}, 0.001}};
  scene.initial.equilibrium = true;
  double reference = 0;
  for (const int elements : {10, 80}) {
    const auto rests = problem_of(scene, elements, {"consistent"}, Choice{"signorini"});
    const Eigen::VectorXd at = rests->contact * rests->position;
    CHECK(at[0] == Approx(0.001).epsilon(1e-9));
    CHECK(at[1] == Approx(0.001).epsilon(1e-9));
    const double energy = 0.5 * rests->position.dot(rests->stiffness * rests->position);
    if (reference == 0) reference = energy;
    // Statics of a beam of cubic elements are exact in its nodes.
    CHECK(energy == Approx(reference).epsilon(1e-6));
  }
  // The end is moved from the line 0.0025 m by −0.0015 m: k = 3 EI/(b² L) with b = 0.6 m behind the support.
  CHECK(reference == Approx(0.5 * 3 / (0.6 * 0.6) * 0.0015 * 0.0015).epsilon(1e-6));
}

TEST_CASE("what pushes at rest against rigid bounds lies on them, beyond by round-off, whatever the mesh") {
  for (int elements = 3; elements < 100; elements += 3) {
    INFO(elements);
    SceneSpec scene = preloaded_beam();
    scene.stops.named[0].at = at_length(2.0 / 3);
    const auto rests = problem_of(scene, elements, {"consistent"}, Choice{"signorini"});
    const double place = (rests->contact * rests->position)[0];
    // It lies beyond by 1e-13 of what the effort moves it by, less than 0.01 m.
    CHECK(place <= 0.01);
    CHECK(place > 0.01 * (1 - 2e-13));
  }
}

TEST_CASE("what begins in equilibrium stays there, whatever mass, law and scheme") {
  const Choice spring{"penalty", {{"stiffness", 30.0}}},
      conserving{"penalty", {{"stiffness", 30.0}, {"evaluation", std::string("conserving")}}},
      damped{"kelvin-voigt", {{"stiffness", 30.0}, {"viscosity", 1.0}}};
  const std::vector<Methods> all = {
      {{"consistent"}, {"signorini"}, half_newmark()},  {{"singular"}, {"signorini"}, half_newmark()},
      {{"consistent"}, {"signorini"}, {"moreau-jean"}}, {{"lumped"}, {"signorini"}, {"nonsmooth-generalised-alpha"}},
      {{"singular"}, spring, half_newmark()},           {{"consistent"}, spring, {"newmark"}},
      {{"consistent"}, conserving, {"midpoint"}},       {{"consistent"}, damped, {"midpoint"}}};
  for (const Methods& methods : all) {
    INFO(methods.mass.name << ", " << methods.contact.name << ", " << methods.time.name);
    Marcher made = marcher(preloaded_beam(), 4, methods, 1e-3);
    made.start();
    const double first = made.tip(0);
    double most = 0;
    for (int n = 0; n < 500; ++n) {
      made.march(1);
      most = std::max(most, std::abs(made.tip(0) - first));
    }
    REQUIRE(made.status(0).running);
    // Round-off of K at a deflection of 0.01.
    CHECK(most < 1e-11);
  }
}

TEST_CASE("stops hold what nothing else does, or say that they do not") {
  SceneSpec scene;
  OscillatorSpec mass;
  mass.mass = 2;
  scene.structure = mass;
  scene.stops.lower = Formula(-0.1);
  scene.stops.place = StopsSpec::Place::tip;
  scene.load = Formula(-3.0);
  scene.initial.equilibrium = true;
  const auto lies = problem_of(scene, 1, {"consistent"}, Choice{"signorini"});
  CHECK(lies->position[0] == Approx(-0.1).epsilon(1e-9));
  const auto pressed = problem_of(scene, 1, {"consistent"}, Choice{"penalty", {{"stiffness", 60.0}}});
  CHECK(pressed->position[0] == Approx(-0.1 - 3.0 / 60).epsilon(1e-9));
  scene.load = Formula(3.0);
  const std::string said = input_error([&] { problem_of(scene, 1, {"consistent"}, Choice{"signorini"}); });
  CHECK_THAT(said, Catch::StartsWith("/scene/initial/equilibrium: "));
  scene.initial.displacement = Formula(0.1);
  CHECK(input_error([&] { check_scene(scene, 1); }) ==
        "/scene/initial/equilibrium: stands beside a displacement; expected one of both");
}

TEST_CASE("a stop that moves by itself is one that its support carries") {
  TimeTable table;
  table.name = "a";
  table.times = {0, 0.2, 1.5};
  table.values = {0, 0.4, -0.4};
  auto motion = std::make_shared<MotionSpec>();
  motion->history = std::make_shared<const PiecewiseCubic>(PiecewiseCubic::integrate_twice(table, 0, 0));
  SceneSpec own = unit_beam();
  own.stops = {};
  own.stops.named = {{"tip", at_length(1), {}, -0.01, 0.02}};
  own.stops.named.front().motion = motion;
  // In the frame of a still stop the beam's whole support moves the other way: two clamped points of view.
  const Methods methods{{"consistent"}, {"signorini"}, half_newmark()};
  const auto moved = tip_history(own, 6, methods, 1e-3, 1.4);
  SceneSpec carried = own;
  carried.stops.named.front().motion = nullptr;
  auto opposite = std::make_shared<MotionSpec>();
  for (double& value : table.values) value = -value;
  carried.motions = {{{}, std::make_shared<const PiecewiseCubic>(PiecewiseCubic::integrate_twice(table, 0, 0))}};
  // w'' + … = F − s φ'': a load that gives s φ'' back leaves w as it is.
  carried.load.terms.clear();
  LoadTerm back;
  back.shape = Formula(1.0);
  const auto pieces = std::make_shared<const PiecewiseCubic>(PiecewiseCubic::integrate_twice(table, 0, 0));
  back.history = Formula([pieces](double t) { return pieces->acceleration(t); }, "back", "");
  carried.load.terms = {back};
  carried.from_supports = true;
  const auto seen = tip_history(carried, 6, methods, 1e-3, 1.4);
  CHECK(largest_gap(moved, seen) < 1e-12);
  CHECK(*std::max_element(moved.begin(), moved.end()) > 0.05);
}
