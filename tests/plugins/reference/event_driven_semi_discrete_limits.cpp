#include <ricochet/scene/assembly.hpp>
#include <ricochet/scene/checks.hpp>

#include "tests/eigen.hpp"
#include "tests/marching.hpp"
#include "tests/plugins/reference/semi_discrete_problems.hpp"

namespace event_driven_semi_discrete_tests {

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

}  // namespace event_driven_semi_discrete_tests
