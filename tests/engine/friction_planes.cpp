// Friction along two tangents, and round a circle.
#include <fmt/format.h>

#include <numbers>
#include <ricochet/scene/clearances.hpp>

#include "tests/engine/rubbing.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

const Choice soft{"penalty", {{"stiffness", 6e4}, {"evaluation", std::string("averaged")}}};

void push_node(SceneSpec& scene, const std::string& component, const std::string& history) {
  LoadTerm term{.force = true, .at = {}, .shape = Formula(), .history = Formula(history, "", "t")};
  term.place = at_node("P", component);
  scene.load.terms.push_back(term);
}

// A mass on springs with dofs uy, ux, uz of one node and a floor uy ≥ 0 that rubs in the plane of ux and uz.
SceneSpec on_floor(double mass, double mu, const Eigen::Vector3d& stiffness = {800, 0, 0}) {
  SceneSpec scene = given_scene(stiffness.asDiagonal(), mass * Eigen::Matrix3d::Identity(),
                                "dof,node,component,x,y,z,held\n1,P,uy,0,0,0,\n2,P,ux,0,0,0,\n3,P,uz,0,0,0,\n");
  NamedStop floor = rubbing_floor(mu);
  floor.across = TangentSpec{.slope_radius = 0, .direction = {}, .component = "uz", .speed = 0};
  scene.stops.named = {floor};
  return scene;
}

// A mass on springs in a plane, within a circle that rubs.
SceneSpec in_circle(double mass, double stiffness, double damping, double radius, double mu, double speed) {
  SceneSpec scene =
      given_scene(stiffness * Eigen::Matrix2d::Identity(), mass * Eigen::Matrix2d::Identity(),
                  "dof,node,component,x,y,z,held\n1,P,uy,0,0,0,\n2,P,uz,0,0,0,\n", "", {0, damping / mass});
  Place node;
  node.node = "P";
  NamedStop hole{.name = "hole", .at = node, .to = {}, .lower = {}, .upper = {}};
  hole.friction = FrictionSpec{mu, mu};
  hole.tangent = TangentSpec{.slope_radius = 0, .direction = {}, .component = "", .speed = speed};
  scene.stops.named = clearance_rows(hole, {.radius = radius});
  return scene;
}

struct Rubbed {
  Eigen::VectorXd place;
  FrictionTotals friction;
  EnergyTotals energy;
  double residual = 0;
};

Rubbed rubbed(const SceneSpec& scene, const Methods& methods, double h, double duration, double from = 0) {
  Marcher made = marcher(scene, 1, methods, h, with_friction({"coulomb"}));
  const auto all = watched(made, duration, from);
  REQUIRE(made.status(0).running);
  const FrictionWatch& watch = all->watch;
  return {made.position(0), watch.has(0) ? watch.totals(0) : FrictionTotals(), all->audit.totals(0), watch.residual()};
}

}  // namespace

TEST_CASE("friction: a mass put on a belt at an angle is brought along by a disc of efforts", "[friction]") {
  // From (0, 1.5) against (2, 0): 2.5 m/s along one line are lost at μg, whatever the axes.
  const double g = 9.81, mu = 0.3, at_rest = 2.5 / (mu * g);
  for (const Choice& time : {moreau, dumont}) {
    INFO(time.name);
    SceneSpec scene = on_floor(1.2, mu);
    push_node(scene, "uy", "-1.2*9.81");
    scene.stops.named[0].tangent->speed = 2;
    scene.initial.dofs = {{1, 0, 0}, {2, 0, 0}, {3, 0, 1.5}};
    const Rubbed found = rubbed(scene, {{"consistent"}, {"signorini"}, time}, 1e-2, 1);
    CHECK(found.place[1] == Approx(at_rest + 2 * (1 - at_rest)).margin(1e-5));
    CHECK(found.place[2] == Approx(0.6371049949).margin(1e-5));
    CHECK(found.friction.heat == Approx(3.75).epsilon(1e-10));
    CHECK(found.friction.held == Approx(1 - at_rest).margin(0.011));  // to the step in which it stops
    CHECK(found.residual <= 1e-12);
    // Sliding speed is the length of both; the way of a rest within a step is cut at its end.
    CHECK(found.friction.slipped == Approx(0.5 * 2.5 * at_rest).epsilon(1e-4));
  }
}

TEST_CASE("friction: no direction of a plane is special", "[friction]") {
  // A cone of springs, so that the path curves; turned by 30 degrees the tangents are the others.
  const double angle = std::numbers::pi / 6, c = std::cos(angle), s = std::sin(angle);
  const auto run = [&](bool turned, double mu) {
    SceneSpec scene = on_floor(1.2, mu, {0, 300, 800});
    push_node(scene, "uy", "-1.2*9.81*(1+0.4*cos(9*t))");
    push_node(scene, "ux", "3*cos(7*t)");
    push_node(scene, "uz", "2*sin(5*t)");
    scene.initial.dofs = {{1, 0, 0}, {2, 0.01, 0.4}, {3, -0.02, 0.9}};
    NamedStop& floor = scene.stops.named[0];
    if (turned) {
      // The node has axes x, y, z; both tangents lie in its plane of x and z.
      floor.tangent = TangentSpec{.slope_radius = 0, .direction = {c, 0, s}, .component = "", .speed = 0};
      floor.across = TangentSpec{.slope_radius = 0, .direction = {-s, 0, c}, .component = "", .speed = 0};
    }
    return rubbed(scene, {{"consistent"}, {"signorini"}, moreau}, 1e-3, 2).place;
  };
  const Eigen::VectorXd plain = run(false, 0.1);
  CHECK((plain - run(true, 0.1)).norm() <= 1e-10 * plain.norm());
  CHECK((plain - run(false, 0)).norm() > 0.1 * plain.norm());
}

TEST_CASE("friction: a rotor rubs all round its hole as its balance of forces says", "[friction]") {
  // (k − mω²)R + N + i(cωR + μN) = F e^{−iφ}, N = κ(R − r); its rim turns with the whirl: u = ωR + 5 m/s.
  const double R = 0.0144349658, N = 146.09795, power = 175.62282, omega = 70;
  const double phase = -std::atan2(60 * omega * R + 0.2 * N, (8000 - 2 * omega * omega) * R + N);
  for (const Choice& time : {moreau, dumont}) {
    INFO(time.name);
    SceneSpec scene = in_circle(2, 8000, 60, 0.012, 0.2, 5);
    push_node(scene, "uy", "150*cos(70*t)");
    push_node(scene, "uz", "150*sin(70*t)");
    scene.initial.dofs = {{1, R * std::cos(phase), -omega * R * std::sin(phase)},
                          {2, R * std::sin(phase), omega * R * std::cos(phase)}};
    const double duration = 40 * 2 * std::numbers::pi / omega, from = duration / 2;
    const Rubbed found = rubbed(scene, {{"consistent"}, soft, time}, 2.5e-4, duration, from);
    CHECK(found.place.head<2>().norm() == Approx(R).margin(2e-7));
    CHECK(found.friction.impulse / (duration - from) == Approx(0.2 * N).epsilon(1e-3));
    CHECK(found.friction.heat / (duration - from) == Approx(power).epsilon(1e-3));
    CHECK(found.friction.wear / (duration - from) == Approx(power / 0.2).epsilon(1e-3));
    CHECK(found.friction.held == 0);
    CHECK(std::abs(found.energy.balance_residual()) <= 1e-10 * found.friction.heat);
  }
}

TEST_CASE("friction: what rests in a hole is held, and stays, until its cone is left", "[friction]") {
  // Gravity turned against the place by less than arctan μ holds, by more slides.
  const double kappa = 6e4, mu = 0.3;
  for (const double beyond : {0.95, 1.05}) {
    const double angle = beyond * std::atan(mu);
    SceneSpec scene = in_circle(2, 1e-9, 10, 1e-3, mu, 0);
    const double normal = 20 * std::cos(angle), depth = 1e-3 + normal / kappa;
    push_node(scene, "uy", fmt::format("{:.17g}", normal));
    push_node(scene, "uz", fmt::format("{:.17g}", 20 * std::sin(angle)));
    scene.initial.dofs = {{1, depth, 0}, {2, 0, 0}};
    const Rubbed found = rubbed(scene, {{"consistent"}, soft, moreau}, 1e-4, 0.02);
    if (beyond < 1) {
      CHECK(std::abs(found.place[1]) <= 1e-12);
      CHECK(found.friction.held == Approx(found.friction.time));
      CHECK(found.friction.wear == 0);
    } else {
      CHECK(found.place[1] > 1e-6);
      CHECK(found.friction.wear > 0);
    }
  }
}

TEST_CASE("friction: a scene that is turned rubs in its hole as it did", "[friction]") {
  const auto run = [](double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    SceneSpec scene = in_circle(2, 500, 0, 1e-3, 0.2, 0.05);
    scene.initial.dofs = {{1, c * 1e-4 - s * 5e-4, c * 0.5 - s * 0.2}, {2, s * 1e-4 + c * 5e-4, s * 0.5 + c * 0.2}};
    return rubbed(scene, {{"consistent"}, {"penalty", {{"stiffness", 1e6}}}, moreau}, 1e-5, 0.05);
  };
  const Rubbed still = run(0);
  CHECK(still.friction.heat > 0.01 * 0.29);
  for (const double angle : {0.6, 2.2, 5.1}) {
    const Rubbed other = run(angle);
    // Round-off of places (1e-16 of 1e-3 m) beside depths of 1e-4 m, grown by each reflection.
    CHECK(other.friction.heat == Approx(still.friction.heat).epsilon(1e-8));
    CHECK(other.friction.slipped == Approx(still.friction.slipped).epsilon(1e-8));
    CHECK(other.place.norm() == Approx(still.place.norm()).epsilon(1e-8));
  }
}

TEST_CASE("friction: two tangents stand at right angles, and a polygon does not rub", "[friction]") {
  SceneSpec scene = on_floor(1, 0.3);
  push_node(scene, "uy", "-1");
  scene.stops.named[0].across->component = "ux";
  CHECK_THROWS_WITH(discretised(scene, 1, *mass("consistent")), Catch::Contains("not at right angles"));
  scene.stops.named[0].across->component = "uy";
  CHECK_THROWS_WITH(discretised(scene, 1, *mass("consistent")), Catch::Contains("its tangent is its normal"));
  const SceneSpec hole = in_circle(2, 8000, 60, 0.012, 0.2, 0);
  const auto made = discretise(hole, 1, *mass("consistent"), make(registry().contact("signorini"), {}).get());
  REQUIRE(std::holds_alternative<Refusal>(made));
  CHECK_THAT(std::get<Refusal>(made).sentence.text, Catch::Contains("a compliant law, which meets the circle itself"));
}
