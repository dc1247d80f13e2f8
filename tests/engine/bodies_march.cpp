// Several bodies that meet at stops: against one of them, against each alone, against a published motion.
#include <ricochet/scene/bodies.hpp>
#include <ricochet/scene/history/time_history.hpp>

#include "tests/marching.hpp"
#include "tests/refusals.hpp"
#include "tests/scene/structure/beam_files.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

Place in_part(const std::string& body, double x) {
  Place place;
  place.body = body;
  place.x = x;
  return place;
}

Place along_beam(double x) {
  Place place;
  place.x = x;
  return place;
}

/// On as many elements each, at rest.
SceneSpec bodies_scene(std::vector<Body> all, int elements) {
  auto bodies = std::make_shared<Bodies>();
  bodies->all = std::move(all);
  SceneSpec scene;
  scene.structure = AssembledSpec{.structure = nullptr, .bodies = std::move(bodies)};
  return on_mesh(std::move(scene), elements);
}

BeamSpec cantilever() {
  SceneSpec scene = unit_beam();
  beam_of(scene).damping = {1e-4, 0};
  return beam_of(scene);
}

LoadTerm push_part(const Place& place, const std::string& formula) {
  LoadTerm term;
  term.force = true;
  term.place = place;
  term.history = Formula(formula, "", "t");
  return term;
}

LoadTerm push_along(double x, const std::string& formula) {
  LoadTerm term;
  term.force = true;
  term.at = x;
  term.history = Formula(formula, "", "t");
  return term;
}

Choice spring_law(double stiffness) {
  return {"penalty", {{"stiffness", stiffness}}};
}

}  // namespace

TEST_CASE("two mirrored cantilevers that meet move as one against a wall") {
  constexpr int elements = 8;
  SceneSpec two = bodies_scene({{"left", cantilever()}, {"right", cantilever()}}, elements);
  two.stops.named = {{"gap", in_part("left", 1), in_part("right", 1), {}, 0.04},
                     {"seen", in_part("left", 1), {}, -9, {}}};
  two.load.terms = {push_part(in_part("left", 1), "0.4*sin(3*t)"), push_part(in_part("right", 1), "-0.4*sin(3*t)")};
  SceneSpec one;
  one.structure = cantilever();
  one.stops.named = {{"wall", along_beam(1), {}, {}, 0.02}};
  one.load.terms = {push_along(1, "0.4*sin(3*t)")};
  const Choice newmark{"newmark-dumont-paoli", {{"beta", 0.5}}};
  // A spring κ between two that mirror each other is one of 2κ at the wall.
  const std::vector<std::pair<Methods, Methods>> laws = {
      {{{"consistent"}, {"signorini"}, newmark}, {{"consistent"}, {"signorini"}, newmark}},
      {{{"singular"}, {"signorini"}, newmark}, {{"singular"}, {"signorini"}, newmark}},
      {{{"redistributed", {{"form", std::string("projected")}}}, {"signorini"}, newmark},
       {{"redistributed", {{"form", std::string("projected")}}}, {"signorini"}, newmark}},
      {{{"reciprocal"}, {"signorini"}, {"moreau-jean"}}, {{"reciprocal"}, {"signorini"}, {"moreau-jean"}}},
      {{{"consistent"}, spring_law(500), newmark}, {{"consistent"}, spring_law(1000), newmark}}};
  for (const auto& [of_two, of_one] : laws) {
    INFO(of_two.mass.name << ", " << of_two.contact.name);
    const auto both = contact_history(two, elements, of_two, 1e-4, 2),
               alone = contact_history(one, elements, of_one, 1e-4, 2);
    double most = 0, farthest = 0;
    for (std::size_t n = 0; n < both.size(); ++n) {
      most = std::max(most, std::abs(both[n][1] - alone[n][0]));
      most = std::max(most, std::abs(both[n][0] - 2 * alone[n][0]));
      farthest = std::max(farthest, alone[n][0]);
    }
    CHECK(farthest > 0.0199);
    CHECK(most < 1e-10);
  }
}

TEST_CASE("masses of bodies stand block by block, whatever form each has") {
  constexpr int elements = 5;
  BeamSpec other = cantilever();
  other.length = 0.5;
  other.section.rhoS = 2;
  SceneSpec scene = bodies_scene({{"beam", cantilever()}, {"other", other}}, elements);
  scene.stops.named = {{"gap", in_part("beam", 1), in_part("other", 0.5), {}, 0.01}};
  SceneSpec beam, rod;
  beam.structure = cantilever();
  beam.stops.named = {{"a", along_beam(1), {}, {}, 0.01}};
  rod.structure = other;
  rod.stops.named = {{"a", along_beam(0.5), {}, {}, 0.01}};
  for (const char* name : {"consistent", "lumped", "singular", "hybrid-singular", "hrz", "reciprocal", "mixed"}) {
    INFO(name);
    const auto made = mass(name);
    const SemiDiscrete all = discretised(scene, elements, *made), first = discretised(beam, elements, *made),
                       second = discretised(rod, elements, *made);
    const Eigen::MatrixXd M = dense_mass(all.inertia), A = dense_mass(first.inertia), B = dense_mass(second.inertia);
    Eigen::MatrixXd blocks = Eigen::MatrixXd::Zero(M.rows(), M.cols());
    blocks.topLeftCorner(A.rows(), A.cols()) = A;
    blocks.bottomRightCorner(B.rows(), B.cols()) = B;
    CHECK((M - blocks).norm() <= 1e-12 * blocks.norm());
    CHECK(all.inertia.kernel_dimension == first.inertia.kernel_dimension + second.inertia.kernel_dimension);
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(M.rows(), M.cols());
    K.topLeftCorner(A.rows(), A.cols()) = first.stiffness;
    K.bottomRightCorner(B.rows(), B.cols()) = second.stiffness;
    CHECK((Eigen::MatrixXd(all.stiffness) - K).norm() == 0);
  }
}

TEST_CASE("bodies that do not meet move as each alone, with its own damping") {
  constexpr int elements = 6;
  BeamSpec slow = cantilever(), fast = cantilever();
  fast.damping = {0, 0.7};
  SceneSpec both = bodies_scene({{"slow", slow}, {"fast", fast}}, elements);
  both.stops.named = {{"a", in_part("slow", 1), {}, -9, {}}, {"b", in_part("fast", 1), {}, -9, {}}};
  both.load.terms = {push_part(in_part("slow", 0.7), "sin(5*t)"), push_part(in_part("fast", 0.4), "cos(4*t)")};
  const auto alone = [&](const BeamSpec& beam, double x, const std::string& formula) {
    SceneSpec scene;
    scene.structure = beam;
    scene.stops.named = {{"a", along_beam(1), {}, -9, {}}};
    scene.load.terms = {push_along(x, formula)};
    return scene;
  };
  for (const char* name : {"consistent", "singular"}) {
    const Methods methods{{name}, {"signorini"}, {"newmark-dumont-paoli", {{"beta", 0.5}}}};
    const auto all = contact_history(both, elements, methods, 1e-3, 2),
               first = contact_history(alone(slow, 0.7, "sin(5*t)"), elements, methods, 1e-3, 2),
               second = contact_history(alone(fast, 0.4, "cos(4*t)"), elements, methods, 1e-3, 2);
    double most = 0;
    for (std::size_t n = 0; n < all.size(); ++n)
      most = std::max({most, std::abs(all[n][0] - first[n][0]), std::abs(all[n][1] - second[n][0])});
    INFO(name);
    // η M of a singular mass is that of the consistent one where bodies differ in damping: M is kept in factors there.
    CHECK(most < (name == std::string("consistent") ? 1e-12 : 1e-3));
  }
}

TEST_CASE("bodies in modes have each its own ratios of damping") {
  constexpr int elements = 6;
  BeamSpec slow = cantilever(), fast = cantilever();
  slow.damping = {.beyond = 0.01};
  fast.damping = {.ratios = {0.05, 0.02}, .beyond = 0.1};
  SceneSpec both = bodies_scene({{"slow", slow}, {"fast", fast}}, elements);
  both.stops.named = {{"a", in_part("slow", 1), {}, -9, {}}, {"b", in_part("fast", 1), {}, -9, {}}};
  both.load.terms = {push_part(in_part("slow", 0.7), "sin(5*t)"), push_part(in_part("fast", 0.4), "cos(4*t)")};
  both.basis = BasisSpec{4, true};
  const auto alone = [&](const BeamSpec& beam, double x, const std::string& formula) {
    SceneSpec scene;
    scene.structure = beam;
    scene.stops.named = {{"a", along_beam(1), {}, -9, {}}};
    scene.load.terms = {push_along(x, formula)};
    scene.basis = BasisSpec{4, true};
    return scene;
  };
  const Methods methods{{"singular"}, {"signorini"}, {"newmark-dumont-paoli", {{"beta", 0.5}}}};
  const auto all = contact_history(both, elements, methods, 1e-3, 2),
             first = contact_history(alone(slow, 0.7, "sin(5*t)"), elements, methods, 1e-3, 2),
             second = contact_history(alone(fast, 0.4, "cos(4*t)"), elements, methods, 1e-3, 2);
  double most = 0;
  for (std::size_t n = 0; n < all.size(); ++n)
    most = std::max({most, std::abs(all[n][0] - first[n][0]), std::abs(all[n][1] - second[n][0])});
  CHECK(most < 1e-11);
}

TEST_CASE("moments and slopes of a body are those of it alone") {
  SceneSpec two = bodies_scene({{"a", cantilever()}, {"b", cantilever()}}, 4);
  two.points = {{"p", in_part("b", 0.3), false, true, true}};
  two.stops.named = {{"s", in_part("b", 0.7), {}, -9, {}}};
  two.stops.named.front().tangent = TangentSpec{0.01, {}, ""};
  SceneSpec one;
  one.structure = cantilever();
  one.points = {{"p", along_beam(0.3), false, true, true}};
  one.stops.named = {{"s", along_beam(0.7), {}, -9, {}}};
  one.stops.named.front().tangent = TangentSpec{0.01, {}, ""};
  const SemiDiscrete both = discretised(two, 4, *mass("consistent")), alone = discretised(one, 4, *mass("consistent"));
  const auto own = [&](const SparseRows& rows) -> Eigen::MatrixXd {
    return Eigen::MatrixXd(rows).rightCols(alone.dofs());
  };
  CHECK(own(both.fields.rows) == Eigen::MatrixXd(alone.fields.rows));
  CHECK(own(both.tangents.rows) == Eigen::MatrixXd(alone.tangents.rows));
  CHECK(Eigen::MatrixXd(both.fields.rows).leftCols(alone.dofs()).norm() == 0);
}

TEST_CASE("supports of one name move together, in each body by its own static modes") {
  BeamSpec beam = cantilever();
  beam.supports = {{{"ground", 0, BeamSupport::Type::clamped}}};
  SceneSpec two = bodies_scene({{"a", beam}, {"b", beam}}, 4);
  CHECK(std::get<AssembledSpec>(two.structure).structure->supports == std::vector<std::string>{"ground"});
  two.stops.named = {{"a", in_part("a", 1), {}, -9, {}}, {"gap", in_part("a", 1), in_part("b", 1), -9, {}}};
  TimeTable table;
  table.name = "a";
  table.times = {0, 0.1, 2};
  table.values = {0, 3, -1};
  const auto motion = std::make_shared<const PiecewiseCubic>(PiecewiseCubic::integrate_twice(table, 0, 0));
  two.motions = {{{"ground"}, motion}};
  SceneSpec one;
  one.structure = beam;
  one.stops.named = {{"a", along_beam(1), {}, -9, {}}};
  one.motions = two.motions;
  const Methods methods{{"consistent"}, {"signorini"}, {"newmark"}};
  const auto both = contact_history(two, 4, methods, 1e-3, 1), alone = contact_history(one, 4, methods, 1e-3, 1);
  for (std::size_t n = 0; n < both.size(); ++n) {
    REQUIRE(std::abs(both[n][0] - alone[n][0]) < 1e-13);
    REQUIRE(std::abs(both[n][1]) < 1e-13);
  }
  CHECK(std::abs(alone.back()[0]) > 0.01);
}

TEST_CASE("three beams as bodies, each in its modes, push each other as in code_aster (SDNL105)") {
  using Type = BeamSupport::Type;
  BeamSpec beam;
  beam.length = 1;
  beam.young = 1e10;
  beam.density = 1e8;
  beam.section = {.type = Section::Type::tube, .outer_diameter = 0.2, .wall = 0.01};
  beam.supports = {{{"left", 0, Type::clamped}, {"right", 1, Type::clamped}}};
  SceneSpec scene = bodies_scene({{"A", beam}, {"B", beam}, {"C", beam}}, 10);
  scene.basis = BasisSpec{5, false};
  scene.stops.named = {{"first", in_part("A", 0.5), in_part("B", 0.5), {}, 1e-3},
                       {"second", in_part("B", 0.5), in_part("C", 0.5), {}, 1e-3},
                       {"a", in_part("A", 0.5), {}, -1, {}},
                       {"b", in_part("B", 0.5), {}, -1, {}},
                       {"c", in_part("C", 0.5), {}, -1, {}}};
  scene.load.terms = {push_part(in_part("A", 0.5), "1e6")};
  Marcher made = marcher(scene, 10, {{"consistent"}, spring_law(1e8), {"central-difference"}}, 1e-5);
  REQUIRE(made.program().problem->dofs() == 15);
  made.start();
  made.march(99999 - made.step());
  const Eigen::VectorXd before = made.program().problem->contact * made.position(0);
  made.march(1);
  const Eigen::VectorXd end = made.program().problem->contact * made.position(0);
  const double u[] = {0.0164265, 0.0111628, 0.0058874}, v[] = {0.02543, 0.04413, 0.10456};
  for (int body = 0; body < 3; ++body) {
    CHECK(std::abs(end[2 + body] - u[body]) < 1e-6);
    CHECK(std::abs((end[2 + body] - before[2 + body]) / 1e-5 - v[body]) < 2e-4);
  }
}

TEST_CASE("a basis of all modes of bodies moves them as all their dofs do") {
  constexpr int elements = 4;
  BarSpec bar;
  SceneSpec scene = bodies_scene({{"beam", cantilever()}, {"bar", bar}}, elements);
  scene.stops.named = {{"gap", in_part("beam", 1), in_part("bar", 0), {}, 0.01},
                       {"seen", in_part("bar", 0), {}, -9, {}}};
  scene.load.terms = {push_part(in_part("beam", 1), "0.4*sin(3*t)")};
  const Methods methods{{"consistent"}, spring_law(500), {"newmark-dumont-paoli", {{"beta", 0.5}}}};
  const auto all = contact_history(scene, elements, methods, 1e-4, 1);
  scene.basis = BasisSpec{0, true};
  const auto modes = contact_history(scene, elements, methods, 1e-4, 1);
  double most = 0, farthest = 0;
  for (std::size_t n = 0; n < all.size(); ++n) {
    most = std::max(most, (all[n] - modes[n]).norm());
    farthest = std::max(farthest, all[n][0]);
  }
  CHECK(farthest > 0.01);
  CHECK(most < 1e-9);
}

TEST_CASE("a body that refuses refuses with its name") {
  BeamSpec rotary = cantilever();
  rotary.shear = BeamShear{0.3, 0.85, true};
  rotary.section = {.type = Section::Type::circle, .diameter = 0.1};
  rotary.young = rotary.density = 1;
  SceneSpec scene = bodies_scene({{"rod", cantilever()}, {"grid", rotary}}, 4);
  scene.stops.named = {{"gap", in_part("rod", 1), in_part("grid", 1), {}, 0.01}};
  const auto made = discretise(scene, 4, *mass("singular"));
  REQUIRE(std::holds_alternative<Refusal>(made));
  CHECK_THAT(std::get<Refusal>(made).sentence.text, Catch::StartsWith("body grid: rotary inertia"));
  const auto fault = [&](const NamedStop& stop) {
    scene.stops.named = {stop};
    return input_error([&] { check_scene(scene, 4); });
  };
  CHECK(fault({"gap", along_beam(1), {}, {}, 0.01}) ==
        "/scene/stops/0/at: does not say the body; expected \"body\": one of rod, grid");
  CHECK(fault({"gap", in_part("gird", 1), {}, {}, 0.01}) == "/scene/stops/0/at/body: no body \"gird\"; nearest grid");
  CHECK(fault({"gap", in_part("grid", 2), {}, {}, 0.01}) ==
        "/scene/stops/0/at/x: 2 m is beyond the beam; expected 0 to 1 m");
  rotary.length = -1;
  CHECK(input_error([&] {
          bodies_scene({{"rod", cantilever()}, {"grid", rotary}}, 4);
        }) == "/scene/bodies/grid/length: the length is -1 m; expected a finite number above 0");
  SceneSpec single = unit_beam();
  single.stops = {};
  single.stops.named = {{"a", in_part("rod", 1), {}, {}, 0.01}};
  CHECK(input_error([&] { check_scene(single, 4); }) ==
        "/scene/stops/0/at/body: \"rod\" in a scene of one structure; expected no body");
}

TEST_CASE("a body begins where it would begin alone, and what nothing is said of begins at rest") {
  BeamSpec rod = cantilever();
  rod.planes = 2;
  OscillatorSpec ball;
  ball.stiffness = 3;
  InitialSpec bent;
  bent.body = "rod";
  bent.displacement = Formula("0.01*x^2", "/scene/initial", "x");
  bent.velocity_z = Formula("0.3*x", "/scene/initial", "x");
  SceneSpec joined = bodies_scene({{"rod", rod, 1}, {"ball", ball, 1}, {"other", ball, 1}}, 5), alone = unit_beam();
  joined.stops.named = {{"wall", in_part("ball", 0), {}, {}, 1.0}};
  joined.initial.of_bodies = {bent, {}};
  joined.initial.of_bodies[1].body = "other";
  joined.initial.of_bodies[1].displacement = Formula(0.2);
  alone.structure = rod;
  alone.stops = {};
  alone.initial = bent;
  const SemiDiscrete all = discretised(joined, 5, *mass("consistent")),
                     one = discretised(alone, 5, *mass("consistent"));
  REQUIRE(all.dofs() == one.dofs() + 2);
  CHECK((all.position.head(one.dofs()) - one.position).norm() == 0);
  CHECK((all.velocity.head(one.dofs()) - one.velocity).norm() == 0);
  CHECK(one.velocity.norm() > 0);
  CHECK(all.position[one.dofs()] == 0);
  CHECK(all.position[one.dofs() + 1] == 0.2);
  // A stop that a body begins beyond is told.
  joined.stops.named[0].at = in_part("other", 0);
  joined.stops.named[0].upper = 0.1;
  CHECK_THROWS_AS(check_scene(joined, 5), BeyondStop);
}
