// Points and tangents: rows that are read, what supports add to them, and what they may not be.
#include <ricochet/scene/clearances.hpp>
#include <ricochet/scene/observed_rows.hpp>
#include <ricochet/scene/structure/assembled_structure.hpp>

#include "tests/scene/structure/beam_files.hpp"
#include "tests/scene/working_set.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

Place at_position(double x) {
  Place place;
  place.x = x;
  return place;
}

std::string scene_fault(const SceneSpec& scene, int elements = 4) {
  return input_error([&] { check_scene(scene, elements); });
}

/// Of w = x³ on the unit beam, 4 elements: values and slopes at the free nodes.
Eigen::VectorXd cube() {
  Eigen::VectorXd q(8);
  for (int node = 0; node < 4; ++node) {
    const double x = 0.25 * (node + 1);
    q[2 * node] = x * x * x;
    q[2 * node + 1] = 3 * x * x;
  }
  return q;
}

}  // namespace

TEST_CASE("a point reads the displacement of its place, and the first one is the tip") {
  SceneSpec scene = unit_beam();
  scene.stops = {};
  scene.points = {{"quarter", at_position(0.3)}, {"end", at_position(1), true}};
  const SemiDiscrete problem = discretised(scene, 4, *mass("consistent"));
  REQUIRE(problem.observed.count() == 2);
  const Eigen::VectorXd read = problem.observed.rows * cube();
  // The elements have every cubic.
  CHECK(read[0] == Approx(0.027).epsilon(1e-14));
  CHECK(read[1] == Approx(1).epsilon(1e-14));
  CHECK((problem.tip * cube())[0] == Approx(0.027).epsilon(1e-14));
  CHECK(problem.observed.on_support[0] == 1);
  CHECK(problem.observed.on_support[1] == 0);
}

TEST_CASE("moment and shear force of a cubic are EI w'' and its derivative, of the section to the right of a change") {
  SceneSpec scene = unit_beam();
  scene.stops = {};
  BeamPart half, whole;
  half.to = 0.5;
  half.section = whole.section = beam_of(scene).section;
  half.section.EI = 3;
  whole.to = 1;
  whole.section.EI = 7;
  beam_of(scene).sections = {half, whole};
  scene.points = {{"quarter", at_position(0.3), false, true, true},
                  {"change", at_position(0.5), false, true, false},
                  {"end", at_position(1), false, false, true}};
  const SemiDiscrete problem = discretised(scene, 4, *mass("consistent"));
  CHECK(problem.fields.names ==
        std::vector<std::string>{"quarter_moment", "quarter_shear", "change_moment", "end_shear"});
  const Eigen::VectorXd read = problem.fields.rows * cube();
  CHECK(read[0] == Approx(3 * 6 * 0.3).epsilon(1e-12));
  CHECK(read[1] == Approx(3 * 6).epsilon(1e-12));
  CHECK(read[2] == Approx(7 * 6 * 0.5).epsilon(1e-12));
  CHECK(read[3] == Approx(7 * 6).epsilon(1e-12));
}

TEST_CASE("the surface of a tube moves by the radius times the rotation of its section") {
  SceneSpec scene = unit_beam();
  scene.stops = {};
  NamedStop stop{"bar", at_position(0.6), {}, {}, 1.0};
  stop.tangent = TangentSpec{0.02, {}, ""};
  NamedStop between{"between", at_position(0.9), at_position(0.4), {}, 1.0};
  between.tangent = TangentSpec{0.5, {}, ""};
  scene.stops.named = {{"bare", at_position(1), {}, {}, 1.0}, stop, between};
  const SemiDiscrete problem = discretised(scene, 4, *mass("consistent"));
  CHECK(problem.tangent_of == std::vector<int>{-1, 0, 1});
  const Eigen::VectorXd read = problem.tangents.rows * cube();
  CHECK(read[0] == Approx(0.02 * 3 * 0.36).epsilon(1e-13));
  CHECK(read[1] == Approx(0.5 * 3 * (0.81 - 0.16)).epsilon(1e-13));
  CHECK(problem.tangents.on_support.isZero(0));
}

TEST_CASE("supports that move alike turn no section, and lift every point by what they do, with shear too") {
  SceneSpec scene = unit_beam();
  if (GENERATE(false, true)) {
    BeamSpec& beam = beam_of(scene);
    beam.young = 2e11;
    beam.density = 8000;
    beam.section = {};
    beam.section.type = Section::Type::rectangle;
    beam.section.width = beam.section.height = 0.2;
    beam.shear.emplace();
    beam.shear->poisson = 0.3;
  }
  beam_of(scene).supports = {{"left", 0, BeamSupport::Type::pinned, 0, 0},
                             {"right", 1, BeamSupport::Type::pinned, 0, 0}};
  scene.stops = {};
  NamedStop stop{"bar", at_position(0.1), {}, {}, 1.0};
  stop.tangent = TangentSpec{1, {}, ""};
  scene.stops.named = {stop};
  scene.points = {{"near", at_position(0.1)}, {"between", at_position(0.1), true}};
  TimeTable table;
  table.times = {0, 1};
  table.values = {0, 0};
  scene.motions = {{{}, std::make_shared<const PiecewiseCubic>(PiecewiseCubic::integrate_twice(table, 0, 0))}};
  const SemiDiscrete problem = discretised(scene, 4, *mass("consistent"));
  CHECK(problem.observed.on_motions(0, 0) == Approx(1).epsilon(1e-12));
  CHECK(problem.observed.on_motions(1, 0) == 0);
  CHECK(problem.tangents.on_motions(0, 0) == Approx(0).margin(1e-12));
}

TEST_CASE("points and tangents that cannot be are refused by name and pointer") {
  SceneSpec scene = unit_beam();
  scene.stops = {};
  scene.stops.named = {{"bar", at_position(1), {}, {}, 1.0}};
  const auto with_point = [&](const char* name, const Place& place) {
    SceneSpec other = scene;
    other.points = {{name, place}};
    return scene_fault(other);
  };
  CHECK(with_point("a b", at_position(1)) ==
        "/scene/points/0/name: \"a b\"; expected a name of 1 to 40 letters, digits, '-' or '_'");
  CHECK(with_point("bar", at_position(1)) ==
        "/scene/points/0/name: another point or stop is called \"bar\"; expected another name");
  CHECK(with_point("tip", at_position(1)) ==
        "/scene/points/0/name: \"tip\" is what tables call the first point; expected another name");
  CHECK(with_point("mid", at_position(2)) == "/scene/points/0/at/x: 2 m is beyond the beam; expected 0 to 1 m");
  const auto with_tangent = [&](const TangentSpec& tangent) {
    SceneSpec other = scene;
    other.stops.named[0].tangent = tangent;
    return scene_fault(other);
  };
  CHECK(with_tangent({0, {0, 1, 0}, ""}) ==
        "/scene/stops/0/tangent: stop bar is not at a node: give slope_radius, or "
        "leave tangent out");
  SceneSpec frame = assembled_scene(assembled(beam_files(beam_of(scene), 4)), {});
  frame.stops.named = {{"bar", at_node("N4"), {}, {}, 1.0}};
  frame.stops.named[0].tangent = TangentSpec{0.1, {}, ""};
  CHECK(scene_fault(frame, 1) ==
        "/scene/stops/0/tangent: stop bar has no beam, whose slope it could be: give direction or component");
  frame.stops.named[0].tangent = TangentSpec{0, {}, "uz"};
  CHECK_THAT(scene_fault(frame, 1),
             Catch::Contains("/scene/stops/0/tangent/component: node N4 has ") && Catch::Contains("no uz"));
  frame.stops.named[0].tangent = TangentSpec{0, {}, "rz"};
  CHECK(scene_fault(frame, 1) == "no error");
  frame.points = {{"far", at_node("N44")}};
  CHECK_THAT(scene_fault(frame, 1), Catch::Contains("/scene/points/0/at/node: \"N44\": no such node; nearest N4"));
}

TEST_CASE("what an error about a tangent recommends is accepted, on every structure") {
  SceneSpec beam = unit_beam();
  beam.stops = {};
  SceneSpec planes = beam;
  beam_of(planes).planes = 2;
  SceneSpec frame = assembled_scene(assembled(beam_files(beam_of(beam), 4)), {});
  std::vector<double> ratios;
  SceneSpec modes = frame;
  std::get<AssembledSpec>(modes.structure).structure = std::make_shared<const AssembledStructure>(
      modal_structure({read_csv("mode,frequency,mass,damping\n1,3,2,0\n2,4,2,0\n", "modes.csv"),
                       read_csv("point,1,2\ntube.uy,1,0\ntube.uz,0,1\n", "shapes.csv"),
                       {},
                       {},
                       {}},
                      ratios));
  SceneSpec oscillator = beam, bar = beam;
  oscillator.structure = OscillatorSpec{.mass = 1, .stiffness = 100, .damping = 0, .force = {}};
  bar.structure = BarSpec{};
  Place node = at_node("N4"), tube, dofs;
  node.component.clear();
  tube.point = "tube";
  dofs.dofs = {{5, 1.0}};
  Place mode = tube;
  mode.point = "tube.uy";
  struct Case {
    SceneSpec scene;
    Place at;
    bool round;
    std::array<std::string, 2> components{"uy", "uz"};
  };
  int refused = 0;
  for (const Case& one :
       {Case{planes, at_position(0.5), true}, Case{planes, at_position(0.5), false},
        Case{beam, at_position(0.5), false}, Case{frame, node, true, {"uy", "rz"}}, Case{frame, at_node("N4"), false},
        Case{frame, dofs, false}, Case{modes, tube, true}, Case{modes, mode, false},
        Case{oscillator, at_position(0), false}, Case{bar, at_position(0), false}}) {
    SceneSpec scene = one.scene;
    NamedStop stop{.name = "bar", .at = one.at, .to = {}, .lower = {}, .upper = {}};
    for (const TangentSpec& tangent :
         {TangentSpec{0.01, {}, ""}, TangentSpec{0, {}, "rz"}, TangentSpec{0, {0, 0, 1}, ""}}) {
      const auto fault = [&](const std::optional<TangentSpec>& said) {
        NamedStop own = stop;
        own.tangent = said;
        scene.stops.named = {own};
        if (one.round)
          scene.stops.named = clearance_rows(own, {.radius = 1e-3, .sides = 8, .components = one.components});
        else
          scene.stops.named.front().upper = 1;
        return scene_fault(scene, 1);
      };
      REQUIRE(fault({}) == "no error");
      const std::string said = fault(tangent);
      if (said == "no error" || said.find("no component") != std::string::npos) continue;
      INFO(said);
      ++refused;
      const auto told = [&](const char* words) { return said.find(words) != std::string::npos; };
      CHECK((told("leave tangent out") || told("give slope_radius") || told("give direction or component") ||
             told("has ") || told("/tangent/component: no point")));
      if (told("give slope_radius")) CHECK(fault(TangentSpec{0.01, {}, ""}) == "no error");
      if (told("give direction or component")) CHECK(fault(TangentSpec{0, {}, "rz"}) == "no error");
    }
  }
  CHECK(refused >= 15);
}
