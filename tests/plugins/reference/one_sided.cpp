// Scenes with one stop only, for every reference: the side that is absent is never touched, dated, held or compared.
#include <fmt/format.h>

#include <random>
#include <ricochet/measure/motion/motion_sampler.hpp>
#include <ricochet/scene/assembly.hpp>
#include <ricochet/scene/checks.hpp>

#include "tests/marching.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

/// What a random scene is made of: mirrored, all of it changes its sign, and the stop its side.
struct Drawn {
  std::string structure;
  double stop = 0;  ///< of the lower side; the mirror image has −stop above
  double place = 0, speed = 0, load = 0, force = 0, force_pulsation = 0, amplitude = 0, pulsation = 0;
  double alpha = 0, eta = 0, stiffness = 0;
};

/// Displacements of the order of 0.1, a stop within reach.
Drawn drawn(const std::string& structure, unsigned seed) {
  std::mt19937 random(seed);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  Drawn one;
  one.structure = structure;
  one.stop = seed % 3 == 0 ? 0.0 : between(-0.08, 0.0);
  // Every third scene starts on its stop.
  one.place = seed % 3 == 1 ? one.stop : between(0.01, 0.1);
  one.speed = between(-0.6, 0.6);
  one.load = between(-1, 0.3);
  one.force = between(-1, 1);
  one.force_pulsation = between(1, 6);
  one.amplitude = seed % 2 == 0 ? 0 : between(-0.02, 0.02);
  one.pulsation = between(2, 9);
  one.alpha = between(5e-4, 2e-3);
  one.eta = between(0, 0.5);
  one.stiffness = between(20, 60);
  return one;
}

enum class Far { absent, out_of_reach };

Formula of_x(double factor, const std::string& shape) {
  return Formula(fmt::format("({:.17g})*({})", factor, shape), "/given", "x");
}

/// `sign` −1: the mirror image.
SceneSpec scene_of(const Drawn& one, int sign, Far far) {
  SceneSpec scene;
  std::string shape = "1";
  double load = one.load;
  if (one.structure == "oscillator") {
    OscillatorSpec made{1, one.stiffness, one.eta, {}};
    made.force = {sign * one.force, one.force_pulsation, 0.3};
    scene.structure = made;
  } else if (one.structure == "bar") {
    scene.structure = BarSpec{
        .length = 1, .EA = one.stiffness, .rhoA = 1, .fixed = BarSpec::Fixed::left, .damping = {one.alpha, one.eta}};
    shape = "x";
  } else {
    BeamSpec beam;
    beam.length = 1;
    beam.section.type = Section::Type::given;
    beam.section.EI = one.stiffness / 10;
    beam.section.rhoS = 1;
    beam.damping = {one.alpha, one.eta};
    scene.structure = beam;
    shape = "x*x*(3-x)/2";
  }
  scene.load = Formula(sign * load);
  scene.support = {sign * one.amplitude, one.pulsation, 0};
  scene.initial.displacement = of_x(sign * one.place, shape);
  // The clamp starts at its own speed.
  const double clamp = one.structure == "oscillator" ? 0 : sign * one.amplitude * one.pulsation;
  scene.initial.velocity =
      Formula(fmt::format("({:.17g}) + ({:.17g})*({})", clamp, sign * one.speed - clamp, shape), "/given", "x");
  scene.stops.place = StopsSpec::Place::tip;
  const Formula near(sign * one.stop), away(sign * 1e3);
  (sign > 0 ? scene.stops.lower : scene.stops.upper) = near;
  if (far == Far::out_of_reach) (sign > 0 ? scene.stops.upper : scene.stops.lower) = away;
  return scene;
}

/// The scene as references see it.
struct Asked {
  Asked(const SceneSpec& scene, const std::string& structure, int elements, const Choice& mass, double restitution)
      : semi(problem_of(scene, elements, mass)) {
    problem.structure = structure;
    problem.restitution = restitution;
    if (const auto* oscillator = std::get_if<OscillatorSpec>(&scene.structure)) {
      problem.stiffness = oscillator->stiffness;
      problem.inertia = oscillator->mass;
      problem.force_amplitude = oscillator->force.amplitude;
      problem.force_pulsation = oscillator->force.pulsation;
      problem.force_phase = oscillator->force.phase;
    } else {
      const auto* beam = std::get_if<BeamSpec>(&scene.structure);
      const auto* bar = std::get_if<BarSpec>(&scene.structure);
      problem.length = 1;
      problem.stiffness = beam ? beam->section.EI : bar->EA;
      problem.inertia = 1;
      problem.left_fixed = true;
    }
    problem.damping_stiffness = semi->damping.stiffness;
    problem.damping_mass = semi->damping.mass;
    problem.support_amplitude = scene.support.amplitude;
    problem.support_pulsation = scene.support.pulsation;
    problem.load_zero = scene.load.is_zero();
    problem.load = [load = scene.load](double x, double t) { return load.spread(x, t); };
    problem.displacement = [f = scene.initial.displacement](double x) { return f(x); };
    problem.velocity = [f = scene.initial.velocity](double x) { return f(x); };
    problem.stop_places = semi->contact_x;
    problem.stops_at_tip = true;
    const auto side = [](const std::optional<Formula>& stop, double absent) -> std::function<double(double)> {
      if (!stop) return [absent](double) { return absent; };
      return [f = *stop](double x) { return f(x); };
    };
    problem.lower = side(scene.stops.lower, -INFINITY);
    problem.upper = side(scene.stops.upper, INFINITY);
    discrete.mass = dense_mass(semi->inertia);
    discrete.stiffness = semi->stiffness;
    discrete.contact = semi->contact;
    discrete.lower = semi->lower;
    discrete.upper = semi->upper;
    discrete.support_shape = semi->support_shape;
    discrete.position = semi->position;
    discrete.velocity = semi->velocity;
    discrete.load_constant = Eigen::VectorXd::Zero(semi->dofs());
    SceneSpec still = scene;
    if (auto* oscillator = std::get_if<OscillatorSpec>(&still.structure)) oscillator->force = {};
    problem_of(still, elements, mass)->load->assemble(0, discrete.load_constant.data());
    discrete.tip = Eigen::MatrixXd(semi->tip).row(0);
    discrete.places = discrete.strains = Eigen::MatrixXd(0, semi->dofs());
    problem.discrete = &discrete;
  }
  Asked(const Asked&) = delete;
  std::shared_ptr<const SemiDiscrete> semi;
  DiscreteProblem discrete;
  ReferenceProblem problem;
};

SampleGrid grid_to(double end) {
  SampleGrid grid;
  for (int i = 0; i <= 60; ++i) grid.times.push_back(end * i / 60);
  return grid;
}

/// The motion by a reference; by the integration of a method itself where that is "self".
SampledMotion motion_by(const std::string& reference, const SceneSpec& scene, const Drawn& one, const Choice& mass,
                        double restitution, double end) {
  const int elements = one.structure == "oscillator" ? 1 : 3;
  if (reference == "self") {
    const Choice time = mass.name == "singular" ? Choice{"newmark-dumont-paoli"}
                                                : Choice{"moreau-jean", {{"restitution", restitution}}};
    Marcher marched = marcher(scene, elements, {mass, {"signorini"}, time}, end / 6000);
    MotionSampler sampler(marched, grid_to(end));
    sampler.march([] { return true; });
    return sampler.finish();
  }
  const Asked asked(scene, one.structure, elements, mass, restitution);
  const auto* entry = registry().reference(reference);
  REQUIRE(entry);
  auto solved = entry->make(complete(entry->manual.parameters, {}))->solve(asked.problem, grid_to(end));
  INFO((std::holds_alternative<Refusal>(solved) ? std::get<Refusal>(solved).sentence.text : ""));
  REQUIRE(std::holds_alternative<ReferenceMotion>(solved));
  return std::get<ReferenceMotion>(std::move(solved)).motion;
}

/// b is a, or its mirror image (sign −1).
void same(const SampledMotion& a, const SampledMotion& b, int sign, double round_off) {
  REQUIRE(a.tip.size() == b.tip.size());
  for (std::size_t i = 0; i < a.tip.size(); ++i) {
    INFO("sample " << i);
    CHECK(sign * b.tip[i] == Approx(a.tip[i]).margin(round_off));
    CHECK(sign * b.tip_velocity[i] == Approx(a.tip_velocity[i]).margin(100 * round_off));
    CHECK(b.energy[i] == Approx(a.energy[i]).margin(100 * round_off));
    CHECK(sign * b.impulse[i] == Approx(a.impulse[i]).margin(100 * round_off));
  }
  // A chattering ends where bounces are lost in the round-off of the scene, a far stop included.
  constexpr double chatters = 1e-3;
  for (std::size_t i = 0; i < a.events.size(); ++i) {
    if (i > 0 && a.events[i].begins && a.events[i].time - a.events[i - 1].time < chatters) break;
    REQUIRE(i < b.events.size());
    CHECK(sign * b.events[i].side == a.events[i].side);
    CHECK(b.events[i].begins == a.events[i].begins);
    CHECK(b.events[i].time == Approx(a.events[i].time).margin(100 * round_off));
  }
}

struct Kind {
  std::string reference, structure, mass;
};

}  // namespace

TEST_CASE("a stop that is absent is a stop out of reach, and a scene in the mirror moves in the mirror") {
  const Kind kind = GENERATE(
      Kind{"exact", "oscillator", "consistent"}, Kind{"self", "oscillator", "consistent"},
      Kind{"self", "beam", "singular"}, Kind{"self", "bar", "consistent"}, Kind{"event-driven", "beam", "consistent"},
      Kind{"event-driven-semi-discrete", "oscillator", "consistent"},
      Kind{"event-driven-semi-discrete", "bar", "consistent"},
      Kind{"event-driven-semi-discrete", "bar", "redistributed"},
      Kind{"event-driven-semi-discrete", "beam", "consistent"}, Kind{"event-driven-semi-discrete", "beam", "singular"});
  const double end = kind.structure == "oscillator" ? 3 : 0.6;
  int touched = 0;
  for (unsigned seed = 1; seed <= 6; ++seed) {
    INFO(kind.reference << ", " << kind.structure << ", " << kind.mass << ", seed " << seed);
    const Drawn one = drawn(kind.structure, seed);
    const auto motion = [&](int sign, Far far) {
      // A beam with mass at its tip that is thrown back chatters without end.
      const double restitution = kind.structure == "beam" ? 0 : 0.6;
      return motion_by(kind.reference, scene_of(one, sign, far), one, {kind.mass}, restitution, end);
    };
    const SampledMotion alone = motion(1, Far::absent);
    for (const ContactEvent& event : alone.events) CHECK(event.side == -1);
    for (const double tip : alone.tip) CHECK(tip >= one.stop - (kind.reference == "self" ? 2e-3 : 1e-9));
    touched += !alone.events.empty();
    // A few impacts make 1e-15 grow; the far stop adds nothing but its own round-off, 1e3 ε.
    same(alone, motion(1, Far::out_of_reach), 1, 1e-9);
    same(alone, motion(-1, Far::absent), -1, 1e-9);
  }
  CHECK(touched >= 3);
}
