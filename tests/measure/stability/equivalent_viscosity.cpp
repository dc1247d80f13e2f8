// What schemes dissipate by themselves, against their closed forms and against marching.
#include <ricochet/measure/stability/equivalent_viscosity.hpp>

#include "tests/eigen.hpp"
#include "tests/marching.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

Choice dumont_paoli(double beta) {
  return {"newmark-dumont-paoli", {{"beta", beta}, {"restitution", 0.0}}};
}
Choice newmark(double beta, double gamma) {
  return {"newmark", {{"beta", beta}, {"gamma", gamma}}};
}
Choice moreau_jean(double theta) {
  return {"moreau-jean", {{"theta", theta}}};
}

StepPlan undamped(const Choice& time, double h, int kernel = 0) {
  auto made = plan_of(time, h, {.mass_kernel_dimension = kernel});
  INFO((std::holds_alternative<Refusal>(made) ? std::get<Refusal>(made).sentence.text : ""));
  REQUIRE(std::holds_alternative<StepPlan>(made));
  return std::get<StepPlan>(made);
}

EquivalentViscosity viscosity(const SemiDiscrete& problem, const Choice& time, double h, int modes = 3) {
  const auto found = equivalent_viscosity(problem, undamped(time, h, problem.inertia.kernel_dimension), h, modes);
  REQUIRE(found);
  return *found;
}

SceneSpec oscillator(double mass, double stiffness, double damping) {
  OscillatorSpec spec;
  spec.mass = mass;
  spec.stiffness = stiffness;
  spec.damping = damping;
  SceneSpec scene;
  scene.structure = spec;
  return scene;
}

const Choice consistent{"consistent"};
const std::vector<Choice>& masses() {
  static const std::vector<Choice> all = {consistent,
                                          {"lumped"},
                                          {"singular", {{"velocity", std::string("P1")}}},
                                          {"singular", {{"velocity", std::string("P0")}}}};
  return all;
}

}  // namespace

TEST_CASE("equivalent viscosity: schemes that conserve have none, down to the round-off of their own numbers") {
  // det = 1 for each of these whatever ωh; what is left are the plan's coefficients, rounded to 1e-16.
  for (const Choice& mass : masses()) {
    const auto problem = problem_of(working_set(), 8, mass);
    for (const Choice& time : {dumont_paoli(0.5), dumont_paoli(0.25), dumont_paoli(0.3), newmark(0.25, 0.5),
                               newmark(0.3, 0.5), moreau_jean(0.5)}) {
      for (const double h : {1e-3, 1e-5, 1e-7}) {
        INFO(mass.name << " " << time.name << " h " << h);
        const EquivalentViscosity found = viscosity(*problem, time, h);
        CHECK(std::abs(found.numerical) < 1e-14 * h);
        CHECK(found.misfit < 1e-14 * h);
        CHECK(found.modes == 3);
      }
    }
  }
}

TEST_CASE("equivalent viscosity: to the lowest order (2θ−1)h for the θ-scheme, (γ−½)h for Newmark") {
  const auto problem = problem_of(working_set(), 10, consistent);
  for (const double h : {1e-4, 1e-6, 1e-8}) {
    // The next order is (ωh)², ω = 460 rad/s for the third mode: 2e-3 at h = 1e-4, and the fit weighs that mode most.
    const double third = std::pow(461 * h, 2);
    for (const double theta : {0.5000001, 0.55, 0.75, 1.0}) {
      INFO("θ = " << theta << ", h = " << h);
      CHECK(viscosity(*problem, moreau_jean(theta), h).numerical == Approx((2 * theta - 1) * h).epsilon(third + 1e-8));
    }
    for (const double gamma : {0.5001, 0.6, 1.0}) {
      INFO("γ = " << gamma << ", h = " << h);
      CHECK(viscosity(*problem, newmark(0.5, gamma), h).numerical == Approx((gamma - 0.5) * h).epsilon(third + 1e-8));
    }
  }
}

TEST_CASE("equivalent viscosity: one mode is its root's modulus, at any step") {
  // |r|² = 1 − (2θ−1)Ω²/(1+θ²Ω²) and 1 − (γ−½)Ω²/(1+βΩ²), Ω = ωh; δ = −ln|r|/h, α_eq = 2δ/ω².
  const double m = 2, k = 800, omega = std::sqrt(k / m);
  const auto problem = problem_of(oscillator(m, k, 0), 1, consistent);
  const auto from = [&](double loss, double h) { return -std::log1p(-loss) / h / (omega * omega); };
  for (const double phase : {1e-6, 1e-3, 0.1, 1.0}) {
    const double h = phase / omega, square = phase * phase;
    for (const double theta : {0.6, 1.0}) {
      const double expected = from((2 * theta - 1) * square / (1 + theta * theta * square), h);
      const EquivalentViscosity found = viscosity(*problem, moreau_jean(theta), h);
      INFO("θ = " << theta << ", Ω = " << phase);
      CHECK(found.numerical == Approx(expected).epsilon(1e-13));  // one logarithm of rounded numbers
      CHECK(found.modes == 1);
      CHECK(found.misfit <= 1e-15 * std::abs(found.numerical));
    }
    const double expected = from(0.2 * square / (1 + 0.4 * square), h);
    CHECK(viscosity(*problem, newmark(0.4, 0.7), h).numerical == Approx(expected).epsilon(1e-13));
  }
}

TEST_CASE("equivalent viscosity: it is the decay that is marched") {
  // The first mode of the beam alone, θ = 0.8: its amplitude after n steps is e^{−δ n h}.
  SceneSpec scene = working_set();
  scene.stops.lower.reset();
  scene.stops.upper.reset();
  const auto problem = problem_of(scene, 4, consistent);
  const eigen::Modes modes = eigen::modes(dense_mass(problem->inertia), problem->stiffness);
  const Eigen::VectorXd shape = modes.vectors.col(problem->dofs() - 1);
  const double square = 1 / modes.values[problem->dofs() - 1], h = 1e-3;
  auto program = compiled(problem, {consistent, {"none"}, moreau_jean(0.8)}, h, {}, [&](LaneSpec lane) {
    lane.position = shape;
    lane.velocity.setZero();
    return std::vector<LaneSpec>{lane};
  });
  REQUIRE(std::holds_alternative<Program>(program));
  Marcher marcher(std::move(std::get<Program>(program)));
  marcher.start();
  // Twice the energy of the first mode: qᵀKq + vᵀMv. The root takes it as a whole after every half turn; over thousands
  // of steps its swing within one turn does not count.
  const auto energy = [&] {
    Eigen::VectorXd q(problem->dofs()), v(problem->dofs());
    for (int i = 0; i < problem->dofs(); ++i) {
      q[i] = marcher.slot(0)[i * marcher.width()];
      v[i] = marcher.slot(1)[i * marcher.width()];
    }
    if (marcher.program().model->modal())
      q = marcher.program().model->to_nodal(q), v = marcher.program().model->to_nodal(v);
    return q.dot(problem->stiffness * q) + v.dot(apply_mass(problem->inertia, v));
  };
  const double before = energy();
  const int steps = 4000;
  marcher.march(steps);
  const double delta = 0.5 * std::log(before / energy()) / (steps * h);
  // The swing of the energy within a turn, (2θ−1)Ω/2 ~ 1 %, over the 2.6 by which its logarithm has fallen: 0.5 %.
  CHECK(2 * delta / square == Approx(viscosity(*problem, moreau_jean(0.8), h, 1).numerical).epsilon(5e-3));
}

TEST_CASE("equivalent viscosity: the structure's own is beside it, in the same measure") {
  SceneSpec scene = working_set();
  beam_of(scene).damping.stiffness = 1e-4;
  const double h = 1e-4;
  const EquivalentViscosity free = viscosity(*problem_of(working_set(), 6, consistent), moreau_jean(0.75), h);
  const EquivalentViscosity damped = viscosity(*problem_of(scene, 6, consistent), moreau_jean(0.75), h);
  CHECK(free.physical == 0);
  CHECK(damped.physical == Approx(1e-4).epsilon(1e-12));
  CHECK(damped.numerical == free.numerical);
  // A dashpot c does what α = c/k does to its one mode.
  const EquivalentViscosity dashpot =
      viscosity(*problem_of(oscillator(2, 800, 4), 1, consistent), moreau_jean(0.75), h);
  CHECK(dashpot.physical == Approx(4.0 / 800).epsilon(1e-12));
  // Mass damping is seen by the mode that is slow: fitted over fast ones it is small.
  SceneSpec rayleigh = working_set();
  beam_of(rayleigh).damping.mass = 1;
  const auto problem = problem_of(rayleigh, 6, consistent);
  CHECK(viscosity(*problem, moreau_jean(0.75), h, 1).physical == Approx(1 / std::pow(26.2445, 2)).epsilon(1e-4));
  CHECK(viscosity(*problem, moreau_jean(0.75), h, 3).physical < 0.01 / std::pow(26.2445, 2));
}

TEST_CASE("equivalent viscosity: units scale it as a time, the mesh and the mass matrix hardly matter") {
  const double h = 1e-5,
               expected = viscosity(*problem_of(working_set(), 10, consistent), moreau_jean(0.6), h).numerical;
  for (const Choice& mass : masses())
    for (const int elements : {6, 40}) {
      const auto problem = problem_of(working_set(), elements, mass);
      INFO(mass.name << " " << elements);
      // (ωh)² = 2e-5 is what it may depend on the modes.
      CHECK(viscosity(*problem, moreau_jean(0.6), h).numerical == Approx(expected).epsilon(2e-5));
    }
  // Time × 100: pulsations fall with it.
  SceneSpec slow = working_set();
  beam_of(slow).young *= 1e-4;
  CHECK(viscosity(*problem_of(slow, 10, consistent), moreau_jean(0.6), 100 * h).numerical ==
        Approx(100 * expected).epsilon(1e-9));  // pulsations from two eigenproblems
  // As many modes as asked for; no more than there are.
  CHECK(viscosity(*problem_of(working_set(), 1, consistent), moreau_jean(0.6), h).modes == 2);
  CHECK(viscosity(*problem_of(working_set(), 10, consistent), moreau_jean(0.6), h, 7).modes == 7);
}

TEST_CASE("equivalent viscosity: negative where free motion grows, nothing where nothing can be said") {
  // Explicit Euler, which no plugin offers.
  const double h = 1e-3, omega = 20;
  StepPlan euler;
  euler.slots = {"q", "v"};
  euler.initial = {{1, 0}, {0, 1}};
  Stage stage;
  stage.matrix = {1, 0, 0};
  stage.history = {{0, 0, -1}, {0, 0, 0}};
  stage.update = {{.slots = {1, h}}, {.slots = {0, 1}, .z = h}};
  euler.stages = {stage};
  const auto problem = problem_of(oscillator(1, omega * omega, 0), 1, consistent);
  const auto found = equivalent_viscosity(*problem, euler, h);
  REQUIRE(found);
  // |r|² = 1 + Ω².
  CHECK(found->numerical == Approx(-std::log1p(omega * omega * h * h) / h / (omega * omega)).epsilon(1e-12));

  CHECK_FALSE(equivalent_viscosity(*problem_of(oscillator(1, 0, 0), 1, consistent), undamped(moreau_jean(0.6), h), h));
  StepPlan stuck = euler;
  stuck.stages[0].matrix = {0, 1, 0};
  CHECK_FALSE(equivalent_viscosity(*problem, stuck, h));
}

TEST_CASE("equivalent viscosity: motions without stiffness are passed over") {
  BarSpec bar;
  bar.fixed = BarSpec::Fixed::none;
  SceneSpec free, held;
  free.structure = bar;
  bar.fixed = BarSpec::Fixed::right;
  held.structure = bar;
  const double h = 1e-4;
  const EquivalentViscosity found = viscosity(*problem_of(free, 12, consistent), moreau_jean(0.7), h);
  CHECK(found.modes == 3);
  // (ωh)² with ω = 3π: 1e-6.
  CHECK(found.numerical == Approx(0.4 * h).epsilon(2e-6));
  CHECK(viscosity(*problem_of(held, 12, consistent), moreau_jean(0.7), h).numerical == Approx(0.4 * h).epsilon(2e-6));
}
