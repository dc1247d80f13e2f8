// Clearances that move: with supports of matrices, modes and bodies, or by themselves.
#include <ricochet/measure/contact/stop_contacts.hpp>
#include <ricochet/scene/bodies.hpp>
#include <ricochet/scene/clearances.hpp>
#include <ricochet/scene/structure/assembled_structure.hpp>
#include <ricochet/scene/supports.hpp>

#include "tests/engine/steady_motion.hpp"
#include "tests/marching.hpp"
#include "tests/scene/structure/beam_files.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace carried_clearances_tests {

constexpr double wide = 0.01;

MotionSpec uniform(double speed, std::vector<std::string> supports = {}) {
  MotionSpec motion;
  motion.supports = std::move(supports);
  motion.history = std::make_shared<const Steady>(speed);
  return motion;
}

void add_clearance(SceneSpec& scene, const Place& at, const std::string& carrier = "") {
  NamedStop stop{.name = "hole", .at = at, .to = {}, .lower = {}, .upper = {}};
  stop.moves_with = carrier;
  scene.stops.named = clearance_rows(stop, {.radius = wide, .sides = 16});
}

/// A mass of 2 kg on springs along uy and uz, between itself and a plate whose dofs have these supports.
SceneSpec sprung_mass(const std::string& along_y, const std::string& along_z) {
  BeamFiles files;
  files.stiffness =
      "%%MatrixMarket matrix coordinate real symmetric\n4 4 6\n1 1 800\n3 1 -800\n3 3 800\n2 2 500\n4 2 -500\n4 4 "
      "500\n";
  files.mass = "%%MatrixMarket matrix coordinate real symmetric\n4 4 2\n1 1 2\n2 2 2\n";
  files.dofs = "dof,node,component,x,y,z,held\n1,N1,uy,0,0,0,\n2,N1,uz,0,0,0,\n3,P,uy,0,0,0," + along_y +
               "\n4,P,uz,0,0,0," + along_z + "\n";
  SceneSpec scene = assembled_scene(assembled(files));
  scene.initial.dofs = {{1, 0, 0.7}, {2, 0, 0.4}};
  return scene;
}

Place node(const std::string& name) {
  Place place;
  place.node = name;
  return place;
}

std::vector<Impact> impacts_of(const SceneSpec& scene, double duration, int elements = 1, double h = 1e-5) {
  const Methods rebounding{{"consistent"}, {"signorini"}, {"moreau-jean", {{"restitution", 1.0}}}};
  Marcher made = marcher(scene, elements, rebounding, h);
  ImpactRecorder recorder(made);
  StopContacts contacts(made, recorder);
  made.start(&recorder);
  made.march(std::llround(duration / h) - made.step(), &recorder);
  REQUIRE(made.status(0).running);
  recorder.finish(made);
  contacts.finish();
  return contacts.impacts();
}

void check_alike(const std::vector<Impact>& a, const std::vector<Impact>& b, double speed = 1e-6) {
  REQUIRE(a.size() == b.size());
  REQUIRE(a.size() > 3);
  for (std::size_t i = 0; i < a.size(); ++i) {
    CHECK(a[i].time == b[i].time);
    CHECK(a[i].speed_in == Approx(b[i].speed_in).epsilon(speed));  // round-off of v t over h
  }
}

std::string refused(const SceneSpec& scene) {
  return input_error([&] { check_scene(scene, 1); });
}

TEST_CASE("a clearance of given matrices moves with what its support holds: at a steady speed nothing changes") {
  SceneSpec still = sprung_mass("plate", "plate");
  add_clearance(still, node("N1"));
  const std::vector<Impact> expected = impacts_of(still, 0.3);
  // One support that holds both components moves along both.
  SceneSpec moving = sprung_mass("plate", "plate");
  add_clearance(moving, node("N1"), "plate");
  moving.motions = {uniform(0.3)};
  moving.from_supports = true;
  check_alike(impacts_of(moving, 0.3), expected);
  add_clearance(moving, node("N1"), all_supports);
  check_alike(impacts_of(moving, 0.3), expected);
  // Two are called by their components, and move as they do.
  moving = sprung_mass("plate.uy", "plate.uz");
  add_clearance(moving, node("N1"), "plate");
  moving.motions = {uniform(0.3, {"plate.uy"}), uniform(-0.5, {"plate.uz"})};
  moving.from_supports = true;
  check_alike(impacts_of(moving, 0.3), expected);
  // One that holds a single component moves along that alone.
  moving.motions = {uniform(0.3, {"plate.uy"})};
  check_alike(impacts_of(moving, 0.3), expected);
}

TEST_CASE("a clearance of a description in modes moves with supports called by their components") {
  const auto modal = [](const std::string& y, const std::string& z) {
    SceneSpec scene = sprung_mass("plate.uy", "plate.uz");
    std::vector<double> ratios;
    const double first = std::sqrt(400) / (2 * 3.14159265358979323846),
                 second = std::sqrt(250) / (2 * 3.14159265358979323846);
    std::get<AssembledSpec>(scene.structure).structure = std::make_shared<const AssembledStructure>(modal_structure(
        {read_csv(fmt::format("mode,frequency,mass,damping\n1,{:.17g},2,0\n2,{:.17g},2,0\n", second, first),
                  "modes.csv"),
         read_csv("point,1,2\nN1.uy,0,1\nN1.uz,1,0\n" + y + ",0,2\n" + z + ",2,0\n", "shapes.csv"),
         {},
         {},
         read_csv("point," + y + "," + z + "\nN1.uy,1,0\nN1.uz,0,1\n", "static.csv")},
        ratios));
    scene.initial.dofs = {{1, 0, 0.4}, {2, 0, 0.7}};
    Place point;
    point.point = "N1";
    add_clearance(scene, point, "plate");
    scene.motions = {uniform(0.3, {y}), uniform(-0.5, {z})};
    scene.from_supports = true;
    return scene;
  };
  SceneSpec still = sprung_mass("plate", "plate");
  add_clearance(still, node("N1"));
  check_alike(impacts_of(modal("plate.uy", "plate.uz"), 0.3), impacts_of(still, 0.3));
  CHECK(refused(modal("plate", "wall")) ==
        "/scene/stops/0/moves_with: nothing tells along what support \"plate\" moves in the plane of the clearance; "
        "expected one that holds uy or uz, or is called plate.uy");
}

TEST_CASE("a support of a beam in two planes is two of the bodies that it is one of") {
  SceneSpec alone = working_set();
  BeamSpec& beam = beam_of(alone);
  beam.planes = 2;
  beam.supports = {{"left", 0, BeamSupport::Type::pinned, 0, 0}, {"right", 1.501, BeamSupport::Type::pinned, 0, 0}};
  alone.initial = {};
  alone.support = {};
  alone.stops = {};
  Place place;
  place.x = 0.7;
  add_clearance(alone, place, "left");
  alone.motions = {uniform(2, {"left"}), uniform(3, {"right"}), uniform(-1, {"left"})};
  alone.motions[2].component = "uz";
  SceneSpec among = alone;
  auto bodies = std::make_shared<Bodies>();
  OscillatorSpec other;
  other.stiffness = 100;
  bodies->all = {{"rod", alone.structure, 6}, {"other", other, 1}};
  bodies->elements = 6;
  among.structure = AssembledSpec{.structure = nullptr, .bodies = bodies};
  among = on_mesh(among, 6);
  place.body = "rod";
  add_clearance(among, place, "left");
  check_alike(impacts_of(among, 0.1, 6), impacts_of(alone, 0.1, 6), 1e-5);
  // The harmonic support moves along uy alone, in both.
  for (SceneSpec* scene : {&alone, &among}) {
    scene->motions.clear();
    scene->support = {.amplitude = 0.03, .pulsation = 60, .phase = 0};
    for (NamedStop& row : scene->stops.named) row.moves_with.clear();
  }
  check_alike(impacts_of(among, 0.2, 6), impacts_of(alone, 0.2, 6), 1e-5);
}

TEST_CASE("a clearance that moves by itself goes along one component, and meets what runs towards it") {
  // In its own frame a free mass runs the other way.
  BeamFiles files;
  files.stiffness = "%%MatrixMarket matrix coordinate real symmetric\n2 2 0\n";
  files.mass = "%%MatrixMarket matrix coordinate real symmetric\n2 2 2\n1 1 2\n2 2 2\n";
  files.dofs = "dof,node,component,x,y,z,held\n1,N1,uy,0,0,0,\n2,N1,uz,0,0,0,\n";
  for (const std::string component : {"", "uy", "uz"}) {
    SceneSpec running = assembled_scene(assembled(files)), moving = running;
    const bool along_z = component == "uz";
    running.initial.dofs = {{1, 0, along_z ? 0.2 : -0.6}, {2, 0, along_z ? -0.7 : 0.1}};
    moving.initial.dofs = {{1, 0, along_z ? 0.2 : -0.2}, {2, 0, along_z ? -0.3 : 0.1}};
    add_clearance(running, node("N1"));
    add_clearance(moving, node("N1"));
    MotionSpec own = uniform(0.4);
    own.component = component;
    for (NamedStop& row : moving.stops.named) row.motion = std::make_shared<const MotionSpec>(own);
    check_alike(impacts_of(moving, 0.2), impacts_of(running, 0.2));
    own.component = "ux";
    for (NamedStop& row : moving.stops.named) row.motion = std::make_shared<const MotionSpec>(own);
    CHECK(refused(moving) ==
          "/scene/stops/0/moves_with/component: \"ux\" is no component of the clearance; expected uy or uz");
  }
}

TEST_CASE("what carries a clearance is a support that is there and moves in its plane") {
  SceneSpec scene = sprung_mass("plate", "plate");
  scene.motions = {uniform(0.3)};
  add_clearance(scene, node("N1"), "plaet");
  CHECK(refused(scene) == "/scene/stops/0/moves_with: no support \"plaet\"; did you mean \"plate\"?");
  scene = sprung_mass("plate.uy", "plate.uz");
  scene.motions = {uniform(0.3, {"plate.uy"}), uniform(0.2, {"plate.uz"})};
  add_clearance(scene, node("N1"), all_supports);
  CHECK(refused(scene) == "/scene/stops/0/moves_with: the supports move apart; expected the name of one");
  scene.stops.named = {{"flat", at_node("N1"), {}, -0.1, 0.1}};
  MotionSpec own = uniform(0.4);
  own.component = "uz";
  scene.stops.named.front().motion = std::make_shared<const MotionSpec>(own);
  CHECK(refused(scene) ==
        "/scene/stops/0/moves_with/component: a stop moves along its row; only a clearance has a "
        "component to move along");
}

}  // namespace carried_clearances_tests
