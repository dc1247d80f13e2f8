// Several stops at one place: springs that add up, rigid stops of which the nearest acts, on every kind of structure.
#include <ricochet/measure/contact/impact_recorder.hpp>
#include <ricochet/scene/bodies.hpp>

#include "tests/marching.hpp"
#include "tests/scene/structure/beam_files.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

Place at_place(double x, const std::string& body = "") {
  Place place;
  place.x = x;
  place.body = body;
  return place;
}

NamedStop stop(const std::string& name, const Place& at, std::optional<double> lower, std::optional<double> upper,
               const StopParameters& own = {}) {
  NamedStop out{name, at, {}, lower, upper};
  out.own = own;
  return out;
}

constexpr double stiffness = 4e4;
const Choice averaged_spring{"penalty", {{"stiffness", stiffness}, {"evaluation", std::string("averaged")}}};

/// A structure that swings against stops at one place.
struct Swinging {
  const char* name;
  SceneSpec scene;
  int elements;
  Place at;
  double gap, step, duration;
};

SceneSpec mass_at_stops() {
  SceneSpec scene;
  scene.structure = OscillatorSpec{1, 1e4, 2, {}};
  scene.initial.velocity = Formula(3.0);
  return scene;
}

BeamSpec short_cantilever() {
  SceneSpec scene = unit_beam();
  beam_of(scene).section.EI = 400;
  beam_of(scene).damping = {1e-4, 0};
  return beam_of(scene);
}

std::vector<Swinging> structures() {
  constexpr int elements = 6;
  SceneSpec beam;
  beam.structure = short_cantilever();
  LoadTerm push;
  push.force = true;
  push.at = 1;
  push.history = Formula("60*sin(70*t)", "", "t");
  beam.load.terms = {push};
  SceneSpec matrices = assembled_scene(assembled(beam_files(short_cantilever(), elements)), {1e-4, 0});
  push.at.reset();
  push.place = at_node("N6");
  matrices.load.terms = {push};
  SceneSpec modes = beam;
  modes.basis = BasisSpec{4, true};
  auto all = std::make_shared<Bodies>();
  all->all = {{"ball", OscillatorSpec{1, 0, 0, {}}}, {"wall", OscillatorSpec{2, 1e4, 0, {}}}};
  SceneSpec bodies;
  bodies.structure = AssembledSpec{.structure = nullptr, .bodies = all};
  bodies.initial.of_bodies.emplace_back();
  bodies.initial.of_bodies.back().body = "ball";
  bodies.initial.of_bodies.back().velocity = Formula(1.0);
  return {{"oscillator", mass_at_stops(), 1, at_place(0), 0.01, 1e-4, 0.3},
          {"beam", beam, elements, at_place(0.8), 0.01, 2e-4, 0.6},
          {"matrices", matrices, 1, at_node("N5"), 0.01, 2e-4, 0.6},
          {"modes", modes, elements, at_place(0.8), 0.01, 2e-4, 0.6},
          {"bodies", on_mesh(bodies, 1), 1, at_place(0, "ball"), 0.005, 1e-4, 0.3}};
}

std::vector<double> tips(const Swinging& one, std::vector<NamedStop> stops, const Choice& law, const Choice& time,
                         const CompileOptions& options = {}) {
  SceneSpec scene = one.scene;
  scene.stops.named = std::move(stops);
  if (const JoinedBodies* bodies = bodies_of(scene.structure); bodies)
    for (NamedStop& each : scene.stops.named) each.to = at_place(0, "wall");
  return tip_history(scene, one.elements, {{"consistent"}, law, time}, one.step, one.duration, options);
}

double largest(const std::vector<double>& values) {
  double most = 0;
  for (const double value : values) most = std::max(most, std::abs(value));
  return most;
}

}  // namespace

TEST_CASE("a stop in two halves of half its stiffness is that stop, on every structure") {
  for (const Swinging& one : structures())
    for (const Choice& time : {Choice{"newmark-dumont-paoli", {{"beta", 0.25}}}, Choice{"moreau-jean"}}) {
      INFO(one.name << ", " << time.name);
      const StopParameters half{.stiffness = stiffness / 2};
      const auto whole = tips(one, {stop("whole", one.at, -one.gap, one.gap)}, averaged_spring, time);
      const auto halves =
          tips(one, {stop("a", one.at, -one.gap, one.gap, half), stop("b", one.at, -one.gap, one.gap, half)},
               averaged_spring, time);
      REQUIRE(largest(whole) > one.gap / 2);
      // Round-off that some ten contacts enlarge.
      CHECK(largest_gap(whole, halves) < 1e-9 * largest(whole));
    }
}

TEST_CASE("the order of stops at one place does not matter, on every structure") {
  for (const Swinging& one : structures()) {
    INFO(one.name);
    const NamedStop soft = stop("soft", one.at, -one.gap, one.gap, {.stiffness = stiffness / 8}),
                    hard = stop("hard", one.at, {}, 1.2 * one.gap), low = stop("low", one.at, -1.1 * one.gap, {});
    const Choice time{"newmark-dumont-paoli", {{"beta", 0.25}}};
    const auto ahead = tips(one, {soft, hard, low}, averaged_spring, time),
               back = tips(one, {low, hard, soft}, averaged_spring, time);
    CHECK(largest_gap(ahead, back) < 1e-9 * largest(ahead));
    // They are no single one.
    CHECK(largest_gap(ahead, tips(one, {soft}, averaged_spring, time)) > 1e-3 * largest(ahead));
  }
}

TEST_CASE("flights over stops at one place are the steps that they leave out") {
  SceneSpec scene;
  scene.structure = short_cantilever();
  scene.initial.velocity = Formula("3*x", "", "x");
  scene.stops.named = {stop("soft", at_place(1), -0.01, 0.01, {.stiffness = stiffness / 8}),
                       stop("hard", at_place(1), {}, 0.012)};
  const Methods methods{{"consistent"}, averaged_spring, {"newmark-dumont-paoli", {{"beta", 0.25}}}};
  CompileOptions flights;
  flights.march = MarchWay::flights;
  constexpr double step = 1e-5;
  Marcher flown = marcher(scene, 3, methods, step, flights), marched = marcher(scene, 3, methods, step);
  for (Marcher* each : {&flown, &marched}) run(*each, 0.2);
  CHECK(flown.tip(0) == Approx(marched.tip(0)).epsilon(1e-6));  // what flights state
  CHECK(flown.steps_visited() < marched.steps_visited() / 2);
}

TEST_CASE("under a rigid law the nearest of the stops at a place is alone, on every structure") {
  for (const Swinging& one : structures())
    for (const Choice& time :
         {Choice{"newmark-dumont-paoli", {{"restitution", 0.5}}}, Choice{"moreau-jean", {{"restitution", 0.5}}}}) {
      INFO(one.name << ", " << time.name);
      const Choice rigid{"signorini"};
      const auto alone = tips(one, {stop("near", one.at, -one.gap, one.gap)}, rigid, time);
      // One that a step of either scheme goes beyond together with the near one.
      const auto both = tips(
          one, {stop("far", one.at, -1.3 * one.gap, (1 + 1e-6) * one.gap), stop("near", one.at, -one.gap, one.gap)},
          rigid, time);
      CHECK(largest_gap(alone, both) < 1e-9 * largest(alone));
    }
}

TEST_CASE("a place without play is held, whatever rebounds beside it") {
  SceneSpec scene;
  scene.structure = short_cantilever();
  LoadTerm push;
  push.force = true;
  push.at = 0.6;
  push.history = Formula("20*sin(40*t)", "", "t");
  scene.load.terms = {push};
  scene.stops.named = {stop("held", at_place(1), 0, 0), stop("struck", at_place(0.5), -1e-4, 1e-4)};
  for (const Choice& time :
       {Choice{"newmark-dumont-paoli", {{"restitution", 0.5}}}, Choice{"moreau-jean", {{"restitution", 0.5}}}}) {
    INFO(time.name);
    Marcher made = marcher(scene, 4, {{"consistent"}, {"signorini"}, time}, 1e-4);
    const MarchModel& model = *made.program().model;
    EnergyAudit audit(made);
    made.start(&audit);
    double farthest = 0;
    for (int k = 0; k < 400; ++k) {
      made.march(10, &audit);
      farthest = std::max(farthest, std::abs(model.times(model.contact(), 0, made.slot(0))));
    }
    REQUIRE(made.status(0).running);
    CHECK(farthest < 1e-4 * 1e-4);
    CHECK(audit.contact(0).impacts > 1);
  }
}

TEST_CASE("the two sides of a place rebound with restitutions of their own") {
  SceneSpec scene;
  scene.structure = OscillatorSpec{1, 0, 0, {}};
  scene.initial.velocity = Formula(1.0);
  scene.stops.named = {stop("left", at_place(0), -0.01, {}, {.restitution = 0.5}),
                       stop("right", at_place(0), {}, 0.01, {.restitution = 0.25})};
  Marcher made = marcher(scene, 1, {{"consistent"}, {"signorini"}, {"moreau-jean"}}, 1e-5);
  ImpactRecorder recorder(made);
  made.start(&recorder);
  made.march(30000, &recorder);
  const std::vector<Impact>& impacts = recorder.impacts(0);
  REQUIRE(impacts.size() >= 3);
  double speed = 1;
  for (std::size_t k = 0; k < 3; ++k) {
    CHECK(impacts[k].point == (k % 2 == 0 ? 1 : 0));
    CHECK(impacts[k].speed_in == Approx(speed).epsilon(1e-9));
    speed *= k % 2 == 0 ? 0.25 : 0.5;
    CHECK(impacts[k].speed_out == Approx(speed).epsilon(1e-9));
  }
}
