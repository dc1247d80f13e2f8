// The semi-discrete motion, exact in time: against closed forms, conservation laws and the schemes that march it.
#include <numeric>
#include <ricochet/scene/assembly.hpp>
#include <ricochet/scene/checks.hpp>

#include "tests/eigen.hpp"
#include "tests/marching.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

std::function<double(double)> constant(double value) {
  return [value](double) { return value; };
}

std::vector<double> times(double end, int count) {
  std::vector<double> result;
  for (int i = 0; i <= count; ++i) result.push_back(end * i / count);
  return result;
}

ReferenceOrRefusal solved_by(const std::string& name, const ReferenceProblem& problem, const SampleGrid& grid) {
  const auto* entry = registry().reference(name);
  REQUIRE(entry);
  return entry->make(complete(entry->manual.parameters, {}))->solve(problem, grid);
}

ReferenceMotion found(const ReferenceProblem& problem, const SampleGrid& grid,
                      const std::string& name = "event-driven-semi-discrete") {
  auto result = solved_by(name, problem, grid);
  INFO((std::holds_alternative<Refusal>(result) ? std::get<Refusal>(result).sentence : ""));
  REQUIRE(std::holds_alternative<ReferenceMotion>(result));
  return std::get<ReferenceMotion>(std::move(result));
}

std::string refusal(const ReferenceProblem& problem) {
  const auto result = solved_by("event-driven-semi-discrete", problem, {{0, 0.01}, {}, {}});
  const auto* refused = std::get_if<Refusal>(&result);
  return refused ? refused->sentence : std::string();
}

/// A scene on a mesh, as a reference sees it.
struct Case {
  Case(const SceneSpec& scene, int elements, const Choice& mass, const std::vector<double>& places = {})
      : semi(problem_of(scene, elements, mass)) {
    problem.structure = std::holds_alternative<BarSpec>(scene.structure) ? "bar" : "beam";
    problem.damping_stiffness = semi->damping.stiffness;
    problem.damping_mass = semi->damping.mass;
    problem.support_amplitude = scene.support.amplitude;
    problem.support_pulsation = scene.support.pulsation;
    problem.support_phase = scene.support.phase;
    problem.load_zero = scene.load.is_zero();
    problem.load_constant = !scene.load.uses_t();
    problem.stop_places = semi->contact_x;
    discrete.mass = dense_mass(semi->inertia);
    discrete.stiffness = semi->stiffness;
    discrete.contact = semi->contact;
    discrete.lower = semi->lower;
    discrete.upper = semi->upper;
    discrete.support_shape = semi->support_shape;
    discrete.position = semi->position;
    discrete.velocity = semi->velocity;
    discrete.load_constant.resize(semi->dofs());
    semi->load->assemble(0, discrete.load_constant.data());
    discrete.tip = Eigen::MatrixXd(semi->tip).row(0);
    discrete.places = displacement_rows(semi->space, places);
    discrete.strains = Eigen::MatrixXd::Zero(discrete.places.rows(), discrete.places.cols());
    for (std::size_t i = 0; i < places.size(); ++i)
      for (const auto& [dof, value] : strain_row(semi->space, places[i]))
        discrete.strains(static_cast<Eigen::Index>(i), dof) = value;
    problem.discrete = &discrete;
  }
  Case(const Case&) = delete;

  std::shared_ptr<const SemiDiscrete> semi;
  DiscreteProblem discrete;
  ReferenceProblem problem;
};

SceneSpec projected(SceneSpec scene) {
  scene.initial.projection = InitialSpec::Projection::constraint;
  return scene;
}

/// One dof as a mesh of its own: what a plugin of closed forms solves as well.
struct OneDof {
  explicit OneDof(double stiffness, double mass = 1) {
    problem.structure = "oscillator";
    problem.inertia = mass;
    problem.stiffness = stiffness;
    problem.displacement = problem.velocity = constant(0);
    problem.lower = constant(-INFINITY);
    problem.upper = constant(INFINITY);
    problem.stop_places = {0};
    problem.stops_at_tip = true;
  }
  /// The same numbers as matrices.
  const ReferenceProblem& whole() {
    const auto one = [](double value) { return Eigen::MatrixXd::Constant(1, 1, value); };
    const double t = problem.support_phase;
    discrete.mass = one(problem.inertia);
    discrete.stiffness = one(problem.stiffness);
    discrete.contact = one(1);
    discrete.tip = one(1);
    discrete.lower = one(problem.lower(0));
    discrete.upper = one(problem.upper(0));
    discrete.support_shape = one(problem.inertia);
    discrete.position = one(problem.displacement(0) - problem.support_amplitude * std::sin(t));
    discrete.velocity = one(problem.velocity(0) - problem.support_amplitude * problem.support_pulsation * std::cos(t));
    discrete.load_constant = one(0);
    discrete.places = discrete.strains = Eigen::MatrixXd(0, 1);
    problem.discrete = &discrete;
    return problem;
  }
  ReferenceProblem problem;
  DiscreteProblem discrete;
};

void push(ReferenceProblem& problem, double load) {
  problem.load_zero = false;
  problem.load = [load](double, double) { return load; };
}

/// Both roads to the same motion.
void agree(OneDof& one, double duration, double tolerance) {
  const SampleGrid grid{times(duration, 400), {}, {}};
  const SampledMotion a = found(one.whole(), grid).motion, b = found(one.whole(), grid, "exact").motion;
  const auto compare = [&](const std::vector<double>& x, const std::vector<double>& y, double size) {
    REQUIRE(x.size() == y.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
      INFO("t = " << grid.times[i]);
      CHECK(x[i] == Approx(y[i]).margin(tolerance * size));
    }
  };
  compare(a.tip, b.tip, 1);
  compare(a.tip_velocity, b.tip_velocity, 10);
  compare(a.energy, b.energy, 10);
  compare(a.impulse, b.impulse, 10);
  REQUIRE(a.events.size() == b.events.size());
  for (std::size_t i = 0; i < a.events.size(); ++i) {
    CHECK(a.events[i].side == b.events[i].side);
    CHECK(a.events[i].begins == b.events[i].begins);
    CHECK(a.events[i].time == Approx(b.events[i].time).margin(tolerance));
    CHECK(a.events[i].velocity == Approx(b.events[i].velocity).margin(10 * tolerance));
  }
}

}  // namespace

TEST_CASE("one dof moves as its closed form says") {
  SECTION("forced, damped, on a moving support, between rigid stops") {
    OneDof one(90, 1.3);
    one.problem.damping_mass = 0.4;
    one.problem.damping_stiffness = 1e-3;
    one.problem.force_amplitude = 12;
    one.problem.force_pulsation = 7;
    one.problem.force_phase = 0.3;
    one.problem.support_amplitude = 0.05;
    one.problem.support_pulsation = 3;
    one.problem.support_phase = 0.7;
    push(one.problem, -2);
    one.problem.lower = constant(-0.12);
    one.problem.upper = constant(0.1);
    one.problem.displacement = constant(0.02);
    one.problem.velocity = constant(-1);
    one.problem.restitution = GENERATE(0.0, 0.6, 1.0);
    // Differences grow at impacts; the motion is followed for about ten of them.
    agree(one, 3, 1e-9);
  }
  SECTION("the same on springs") {
    OneDof one(90, 1.3);
    one.problem.damping_mass = 0.4;
    one.problem.damping_stiffness = GENERATE(0.0, 1e-3);
    one.problem.force_amplitude = 12;
    one.problem.force_pulsation = 7;
    push(one.problem, -2);
    one.problem.lower = constant(-0.12);
    one.problem.upper = constant(0.1);
    one.problem.velocity = constant(-1);
    one.problem.contact_stiffness = GENERATE(1e3, 1e6);
    agree(one, 3, 1e-9);
  }
  SECTION("a ball that comes to rest") {
    OneDof one(0);
    push(one.problem, -9.81);
    one.problem.lower = constant(0);
    one.problem.displacement = constant(0.7);
    const double e = 0.5;
    one.problem.restitution = e;
    const SampleGrid grid{times(2, 400), {}, {}};
    const auto a = found(one.whole(), grid).motion, b = found(one.whole(), grid, "exact").motion;
    // The chattering ends at bounces of 10⁻¹⁴ m here and 10⁻¹⁵ of the first there.
    for (std::size_t i = 0; i < grid.times.size(); ++i) {
      CHECK(a.tip[i] == Approx(b.tip[i]).margin(1e-12));
      CHECK(a.impulse[i] == Approx(b.impulse[i]).margin(1e-6));
    }
    CHECK(a.impulse.back() == Approx(2 * 9.81).epsilon(1e-12));
  }
}

TEST_CASE("a singular mass keeps the energy of projected data through every contact") {
  const auto velocity = GENERATE(std::string("P1"), std::string("P0"));
  const auto place = GENERATE(StopsSpec::Place::tip, StopsSpec::Place::nodes);
  SceneSpec scene = projected(working_set());
  scene.stops.place = place;
  Case beam(scene, 8, {"singular", {{"velocity", velocity}}});
  const SampleGrid grid{times(0.4, 400), {}, {}};
  const SampledMotion motion = found(beam.problem, grid).motion;
  if (velocity == "P1") CHECK(motion.energy[0] / line_density(scene) == Approx(3.542).margin(5e-4));
  CHECK(motion.events.size() > 10);
  for (std::size_t i = 0; i < grid.times.size(); ++i) {
    // Round-off of a stiffness matrix whose frequencies span 10³ (its condition number is 10⁶).
    CHECK(motion.energy[i] == Approx(motion.energy[0]).epsilon(1e-10));
    CHECK(std::abs(motion.tip[i]) <= 0.1 + 1e-14);
  }
}

TEST_CASE("stops push only while they are touched, and only away") {
  SceneSpec scene = projected(working_set());
  beam_of(scene).damping.stiffness = GENERATE(0.0, 1e-4);
  Case beam(scene, 8, {"singular"});
  const SampleGrid grid{times(0.4, 2000), {}, {}};
  const SampledMotion motion = found(beam.problem, grid).motion;
  for (std::size_t i = 1; i < grid.times.size(); ++i) {
    double touched = 0, side = 0;  // share of the interval
    for (std::size_t k = 0; k < motion.events.size(); k += 2) {
      const double from = motion.events[k].time, to = k + 1 < motion.events.size() ? motion.events[k + 1].time : 1;
      REQUIRE(motion.events[k].begins);
      const double shared = std::min(to, grid.times[i]) - std::max(from, grid.times[i - 1]);
      if (shared > 0) {
        touched += shared;
        side = motion.events[k].side;
      }
    }
    const double pushed = motion.impulse[i] - motion.impulse[i - 1];
    INFO("t = " << grid.times[i]);
    if (touched == 0) CHECK(pushed == 0);
    CHECK(-side * pushed >= 0);
    if (touched > 0.99 * (grid.times[i] - grid.times[i - 1])) CHECK(motion.tip[i] == Approx(0.1 * side).margin(1e-13));
  }
}

TEST_CASE("impulses balance momentum") {
  // c = K⁻¹Hᵀ/(H K⁻¹ Hᵀ): the tip alone works on it, cᵀKw = (stiffness of the tip)·(its displacement).
  const auto mass =
      GENERATE(Choice{"singular"}, Choice{"singular", {{"velocity", std::string("P0")}}}, Choice{"consistent"});
  const double alpha = GENERATE(0.0, 1e-4), spring = GENERATE(0.0, 1e5);
  SceneSpec scene = projected(working_set());
  beam_of(scene).damping.stiffness = alpha;
  Case beam(scene, 4, mass);
  beam.problem.contact_stiffness = spring;
  beam.problem.restitution = 0.4;
  const Eigen::VectorXd bent = eigen::ldlt_solve(beam.discrete.stiffness, beam.discrete.contact.transpose());
  const double stiffness = 1 / (beam.discrete.contact * bent)[0];
  beam.discrete.places = (beam.discrete.mass * bent * stiffness).transpose();
  beam.discrete.strains = beam.discrete.places;
  constexpr std::size_t count = 4000;
  const double end = 0.1;
  const SampledMotion motion = found(beam.problem, {times(end, count), {0.5}, {1}}).motion;
  REQUIRE(motion.events.size() >= 2);
  double bend = 0;
  for (std::size_t i = 0; i < count; ++i) bend += end / count * (motion.tip[i] + motion.tip[i + 1]) / 2;
  const double gained = motion.velocity[count] - motion.velocity[0];
  const double held = stiffness * (bend + alpha * (motion.tip[count] - motion.tip[0]));
  INFO(mass.name << " α = " << alpha << " κ = " << spring);
  // The integral of the tip by trapezoids of 25 µs, where its velocity jumps.
  CHECK(motion.impulse[count] == Approx(gained + held).epsilon(1e-5));
}

TEST_CASE("the schemes tend to it as the step is refined") {
  SceneSpec scene = projected(working_set());
  scene.stops.place = GENERATE(StopsSpec::Place::tip, StopsSpec::Place::nodes);
  const double amplitude = GENERATE(0.0, 0.05);
  scene.support.amplitude = amplitude;
  scene.support.pulsation = 30;
  if (amplitude > 0) scene.initial.velocity = Formula("1.5 - 4*x", "/scene/initial/velocity", "x");
  beam_of(scene).damping.stiffness = 1e-4;
  beam_of(scene).damping.mass = 0.3;
  scene.load = Formula(-0.2);
  const bool compliant = GENERATE(false, true);
  Case beam(scene, 6, {"singular"});
  Methods methods;
  methods.time.values = {{"beta", 0.5}};
  if (compliant) {
    methods.contact = {"penalty", {{"stiffness", 2e3}, {"evaluation", std::string("implicit")}}};
    beam.problem.contact_stiffness = 2e3;
  }
  const SampleGrid grid{times(0.2, 50), {}, {}};
  const SampledMotion exact = found(beam.problem, grid).motion;
  REQUIRE(exact.events.size() >= 4);
  std::vector<double> log_h, log_error;
  for (const double h : {1e-4, 5e-5, 2.5e-5, 1.25e-5}) {
    Marcher marched = marcher(scene, 6, methods, h);
    marched.start();
    double worst = 0;
    for (std::size_t i = 1; i < grid.times.size(); ++i) {
      marched.march(std::llround(grid.times[i] / h) - marched.step());
      worst = std::max(worst, std::abs(marched.tip(0) - exact.tip[i]));
    }
    log_h.push_back(std::log(h));
    log_error.push_back(std::log(worst));
  }
  const double order = fitted_slope(log_h, log_error);
  INFO("order " << order << ", error " << std::exp(log_error.back()));
  CHECK(order > 0.9);
  // Speeds of 4 m/s, and a step's worth of delay at each of about ten events.
  CHECK(std::exp(log_error.back()) < 60 * 1.25e-5);
}

TEST_CASE("without contact it is what a scheme of order 2 extrapolates to") {
  SceneSpec scene = working_set();
  scene.support.amplitude = 0.02;
  scene.support.pulsation = 26;  // the first mode is at 26.2
  scene.initial.velocity = Formula("0.52 - 2*x", "/scene/initial/velocity", "x");
  Case beam(scene, 2, {"consistent"});
  beam.problem.contact_absent = true;
  const SampleGrid grid{times(0.2, 10), {}, {}};
  const SampledMotion exact = found(beam.problem, grid).motion;
  CHECK(exact.events.empty());
  std::vector<std::vector<double>> tips;
  for (const double h : {2e-5, 1e-5}) {
    Marcher marched = marcher(scene, 2, {{"consistent"}, {"none"}, {"newmark"}}, h);
    marched.start();
    auto& tip = tips.emplace_back();
    for (std::size_t i = 1; i < grid.times.size(); ++i) {
      marched.march(std::llround(grid.times[i] / h) - marched.step());
      tip.push_back(marched.tip(0));
    }
  }
  for (std::size_t i = 0; i < tips[0].size(); ++i)
    // Fourth order in h times the highest pulsation (10⁴ rad/s), on an amplitude of 10⁻⁴ of that mode.
    CHECK(exact.tip[i + 1] == Approx(tips[1][i] + (tips[1][i] - tips[0][i]) / 3).margin(1e-8));
}

TEST_CASE("stiffer springs tend to the rigid stop") {
  SceneSpec scene = projected(working_set());
  beam_of(scene).damping.stiffness = GENERATE(0.0, 1e-4);
  scene.stops.place = StopsSpec::Place::nodes;
  Case beam(scene, 6, {"singular"});
  const SampleGrid grid{times(0.2, 100), {}, {}};
  const SampledMotion rigid = found(beam.problem, grid).motion;
  double before = 0;
  for (const double spring : {1e8, 1e9, 1e10}) {
    beam.problem.contact_stiffness = spring;
    const SampledMotion soft = found(beam.problem, grid).motion;
    double gap = 0;
    for (std::size_t i = 0; i < grid.times.size(); ++i) gap = std::max(gap, std::abs(soft.tip[i] - rigid.tip[i]));
    // A point without mass sinks in by force/κ: first order in 1/κ.
    INFO("κ = " << spring << " gap " << gap);
    if (before > 0) CHECK(before / gap == Approx(10).epsilon(0.05));
    before = gap;
  }
}

TEST_CASE("on a fine mesh it is the damped beam of the continuum") {
  SceneSpec scene = projected(working_set());
  beam_of(scene).damping.stiffness = 1e-4;
  Case beam(scene, 20, {"singular"});
  const ReferenceMotion reference = found(beam.problem, {times(0.4, 40), {}, {}});
  const SampledMotion& motion = reference.motion;
  const std::vector<ContactEvent> expected = {{0.0487745646, -1, true, -3.85453013}, {0.0598140489, -1, false, 0},
                                              {0.1592507858, 1, true, 1.39190292},   {0.1666838954, 1, false, 0},
                                              {0.1684825520, 1, true, 0.16964822},   {0.1710816835, 1, false, 0},
                                              {0.2582968934, -1, true, -1.13119883}, {0.2697290967, -1, false, 0},
                                              {0.3645463046, 1, true, 1.16836297},   {0.3720931374, 1, false, 0}};
  REQUIRE(motion.events.size() == expected.size());
  // 20 elements of fourth order: (π/20)⁴ of the phase of the modes that an impact excites.
  for (std::size_t i = 0; i < expected.size(); ++i) {
    CHECK(motion.events[i].side == expected[i].side);
    CHECK(motion.events[i].begins == expected[i].begins);
    CHECK(motion.events[i].time == Approx(expected[i].time).margin(2e-5));
    CHECK(motion.events[i].velocity == Approx(expected[i].velocity).margin(2e-3));
  }
  CHECK(motion.tip.back() == Approx(0.060859417359).margin(3e-5));
  CHECK(motion.energy.back() / line_density(scene) == Approx(1.55776753366).margin(1e-4));
  // The coarser watch finds the same events.
  REQUIRE(reference.coarser.tip.size() == motion.tip.size());
  for (std::size_t i = 0; i < motion.tip.size(); ++i)
    CHECK(reference.coarser.tip[i] == Approx(motion.tip[i]).margin(1e-12));
}

TEST_CASE("a tip with inertia rebounds by Newton's law") {
  SceneSpec scene = working_set();
  const double e = GENERATE(0.0, 0.5, 1.0), alpha = GENERATE(0.0, 1e-4);
  beam_of(scene).damping.stiffness = alpha;
  Case beam(scene, 4, {"consistent"});
  beam.problem.restitution = e;
  SampleGrid grid{times(0.2, 200), {}, {}};
  SampledMotion motion = found(beam.problem, grid).motion;
  REQUIRE(motion.events.size() >= 2);
  for (std::size_t i = 1; i < grid.times.size(); ++i) {
    if (alpha > 0) CHECK(motion.energy[i] < motion.energy[i - 1]);
    // The rounding of 4 elements' stiffness.
    if (alpha == 0) CHECK(motion.energy[i] <= motion.energy[i - 1] * (1 + 1e-12));
    if (alpha == 0 && e == 1) CHECK(motion.energy[i] == Approx(motion.energy[0]).epsilon(1e-11));
    CHECK(std::abs(motion.tip[i]) <= 0.1 + 1e-13);
  }
  const ContactEvent first = motion.events.front();
  const double pulsation = std::sqrt(1 / compliances(beam.semi->stiffness, beam.semi->inertia)[0]);
  // Read so soon after that the tip's acceleration has changed nothing yet.
  grid.times = {0, first.time - 1e-9 / pulsation, first.time + 1e-9 / pulsation};
  motion = found(beam.problem, grid).motion;
  CHECK(motion.tip_velocity[1] == Approx(first.velocity).epsilon(1e-7));
  CHECK(motion.tip_velocity[2] == Approx(-e * first.velocity).margin(1e-6));
  const Eigen::MatrixXd W =
      beam.discrete.contact * eigen::ldlt_solve_all(beam.discrete.mass, beam.discrete.contact.transpose());
  CHECK(motion.impulse[2] == Approx(-(1 + e) * first.velocity / W(0, 0)).epsilon(1e-6));
}

TEST_CASE("Moreau–Jean tends to Newton's impacts") {
  SceneSpec scene = working_set();
  beam_of(scene).damping.stiffness = 1e-3;
  Case beam(scene, 2, {"consistent"});
  beam.problem.restitution = 0.5;
  const SampleGrid grid{times(0.1, 20), {}, {}};
  const SampledMotion exact = found(beam.problem, grid).motion;
  double before = 0;
  for (const double h : {4e-5, 1e-5, 2.5e-6}) {
    Marcher marched = marcher(scene, 2, {{"consistent"}, {"signorini"}, {"moreau-jean", {{"restitution", 0.5}}}}, h);
    marched.start();
    double worst = 0;
    for (std::size_t i = 1; i < grid.times.size(); ++i) {
      marched.march(std::llround(grid.times[i] / h) - marched.step());
      worst = std::max(worst, std::abs(marched.tip(0) - exact.tip[i]));
    }
    INFO("h = " << h << " error " << worst);
    CHECK(worst < 40 * h);
    if (before > 0) CHECK(worst < 0.6 * before);
    before = worst;
  }
}

TEST_CASE("data off the constraint of a singular mass jump to it at once") {
  SceneSpec scene = working_set();
  Case beam(scene, 8, {"singular"});
  const ReferenceMotion reference = found(beam.problem, {{0, 1e-12, 0.01}, {}, {}});
  const SampledMotion& motion = reference.motion;
  REQUIRE(reference.notes.size() == 1);
  CHECK(reference.notes[0].find("jumps") != std::string::npos);
  const auto& semi = *beam.semi;
  const Eigen::VectorXd momentum = apply_mass(semi.inertia, semi.velocity);
  CHECK(motion.tip[0] == (semi.tip * semi.position)[0]);
  CHECK(motion.energy[0] ==
        Approx(0.5 * semi.velocity.dot(momentum) + 0.5 * semi.position.dot(semi.stiffness * semi.position))
            .epsilon(1e-10));
  CHECK(semi.kernel_energy > 1e-3 * motion.energy[0]);
  CHECK(motion.energy[1] == Approx(motion.energy[0] - semi.kernel_energy).epsilon(1e-9));
  CHECK(motion.energy[2] == Approx(motion.energy[1]).epsilon(1e-10));
}

TEST_CASE("pressed on its stop it comes to rest with the reaction of statics") {
  SceneSpec scene = working_set();
  beam_of(scene).damping.mass = 6;
  const auto& section = beam_of(scene);
  const double EI = section_properties(section.section, section.young, section.density).EI, L = section.length;
  const double load = 24 * EI * 0.1 / std::pow(L, 4);
  scene.load = Formula(load);
  scene.initial = {};
  Case beam(scene, 4, {"singular"});
  const SampledMotion motion = found(beam.problem, {{0, 11, 12}, {}, {}}).motion;
  CHECK(motion.tip.back() == Approx(0.1).epsilon(1e-13));
  // Cubic elements bend exactly; what moved has decayed by e^{−3·11}.
  CHECK(motion.impulse[1] - motion.impulse[2] ==
        Approx(3 * load * L / 8 - 3 * EI * 0.1 / std::pow(L, 3)).epsilon(1e-10));
}

TEST_CASE("a free bar that is thrown at a stop keeps momentum and energy") {
  const auto mass = GENERATE(Choice{"consistent"}, Choice{"lumped"}, Choice{"redistributed"});
  const bool compliant = mass.name != "redistributed" || GENERATE(false, true);
  SceneSpec scene;
  BarSpec bar;
  bar.length = 2;
  bar.EA = 50;
  bar.rhoA = 0.5;
  bar.fixed = BarSpec::Fixed::none;
  scene.structure = bar;
  scene.stops.lower = Formula(0.0);
  scene.stops.place = StopsSpec::Place::tip;
  scene.initial.displacement = Formula(0.05);
  scene.initial.velocity = Formula(-1.0);
  Case thrown(scene, 6, mass);
  if (compliant) thrown.problem.contact_stiffness = 300;
  const Eigen::VectorXd rigid = Eigen::VectorXd::Ones(thrown.semi->dofs());
  thrown.discrete.places = (thrown.discrete.mass * rigid).transpose();
  thrown.discrete.strains = thrown.discrete.places;
  const SampledMotion motion = found(thrown.problem, {times(2, 200), {0.5}, {1}}).motion;
  CHECK(motion.events.size() >= 2);
  CHECK(motion.energy[0] == Approx(0.5).epsilon(1e-14));
  for (std::size_t i = 0; i < motion.energy.size(); ++i) {
    CHECK(motion.energy[i] == Approx(0.5).epsilon(1e-11));
    CHECK(motion.velocity[i] == Approx(-1 + motion.impulse[i]).margin(1e-10));
  }
  // It has left, and the impulse reversed it.
  CHECK(motion.tip.back() > 0.1);
  CHECK(motion.impulse.back() > 1.2);
}

TEST_CASE("what it cannot solve is refused with the way out") {
  SceneSpec scene = working_set();
  scene.stops.place = StopsSpec::Place::nodes;
  {
    Case beam(scene, 4, {"consistent"});
    CHECK(refusal(beam.problem).find("singular mass") != std::string::npos);
    beam.problem.contact_stiffness = 1e4;
    CHECK(refusal(beam.problem).empty());
    beam.problem.contact_nonlinear = true;
    CHECK(refusal(beam.problem).find("self") != std::string::npos);
  }
  {
    Case beam(scene, 31, {"singular"});
    CHECK(refusal(beam.problem).find("62 dofs") != std::string::npos);
  }
  scene.load = Formula("sin(t)", "/scene/load");
  Case beam(scene, 4, {"singular"});
  CHECK(refusal(beam.problem).find("self") != std::string::npos);
  beam.problem.discrete = nullptr;
  CHECK(refusal(beam.problem).find("mesh") != std::string::npos);
}
