// Schemes that are one another: to the last bit where their numbers are the same, to round-off where algebra makes
// them.
#include "tests/plugins/time/family.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

Marcher march_of(const SceneSpec& scene, int elements, const std::string& law, StepPlan plan, double h) {
  const Choice contact{law};
  const auto problem = problem_of(scene, elements, {"consistent"});
  auto made = make(registry().contact(law), contact);
  const LaneSpec lane = scene_lane(*problem, complete(registry().contact(law)->manual.parameters, {}));
  CompileOptions nodal;
  nodal.kind = OperatorKind::band;
  auto program = compile(problem, std::move(plan), h, std::move(made), {lane}, nodal);
  REQUIRE(std::holds_alternative<Program>(program));
  return Marcher(std::move(std::get<Program>(program)));
}

struct Apart {
  double most = 0, scale = 0;  // largest |q_a − q_b| and |q_a| of all steps and dofs
  double relative() const { return most / scale; }
};

Apart apart(Marcher& a, Marcher& b, int steps) {
  Apart found;
  a.start();
  b.start();
  const auto step_to = [](Marcher& m, int n) { m.march(n - m.step()); };
  for (int n = 1; n <= steps; ++n) {
    step_to(a, n);
    step_to(b, n);
    const Eigen::VectorXd q = a.position(0), p = b.position(0);
    found.most = std::max(found.most, (q - p).cwiseAbs().maxCoeff());
    found.scale = std::max(found.scale, q.cwiseAbs().maxCoeff());
  }
  return found;
}

ProblemFacts facts_of(const SceneSpec& scene, bool contact) {
  return {20, 0, std::get<BeamSpec>(scene.structure).damping.stiffness != 0, contact};
}

// Damped, loaded, shaken; five impacts or so in 4000 steps of 10⁻⁴ s.
SceneSpec busy_beam() {
  SceneSpec scene = compared_beam(1e-4);
  scene.support = {0.02, 10, 0.4};
  scene.load = Formula("0.5*x*cos(20*t) - 0.2", "/scene/load");
  return scene;
}

Apart apart(const SceneSpec& scene, const std::string& law, const Choice& a, const Choice& b, double h = 1e-4,
            int steps = 2000) {
  const ProblemFacts facts = facts_of(scene, law != "none");
  Marcher first = march_of(scene, 10, law, plan_made(a, h, facts), h);
  Marcher second = march_of(scene, 10, law, plan_made(b, h, facts), h);
  return apart(first, second, steps);
}

}  // namespace

TEST_CASE("schemes that are the same numbers give bitwise equal motions") {
  struct Pair {
    Choice a, b;
    const char* law = "signorini";
    double h = 1e-4;
  };
  const double e = 0.8;
  const std::vector<Pair> pairs = {
      {scheme("hht-alpha", {{"alpha", 0.0}}), scheme("newmark")},
      {scheme("wbz-alpha", {{"rho_inf", 1.0}}), scheme("newmark")},
      {scheme("generalised-alpha", {{"rho_inf", 0.0}}), scheme("wbz-alpha", {{"rho_inf", 0.0}})},
      {scheme("carpenter-taylor-katona"), scheme("newmark-dumont-paoli", {{"beta", 0.0}}), "signorini", 1e-5},
      {scheme("carpenter-taylor-katona"), scheme("paoli-schatzman"), "signorini", 1e-5},
      {scheme("paoli-schatzman", {{"restitution", e}}),
       scheme("newmark-dumont-paoli", {{"beta", 0.0}, {"restitution", e}}), "signorini", 1e-5},
      {scheme("midpoint"), scheme("laursen-chawla"), "none"},
      {scheme("moreau-jean"), scheme("kane"), "none"},
      {scheme("contact-stabilised-newmark"), scheme("kane"), "none"},
      {worded("contact-stabilised-newmark", "velocity", "corrected"), scheme("kane"), "none"},
      {scheme("central-difference"), scheme("newmark", {{"beta", 0.0}}), "none", 1e-5}};
  for (const Pair& pair : pairs) {
    INFO(label(pair.a) << " and " << label(pair.b) << " with " << pair.law);
    CHECK(apart(busy_beam(), pair.law, pair.a, pair.b, pair.h).most == 0);
  }
}

TEST_CASE("schemes that are one another in exact arithmetic differ by round-off in free motion") {
  // The trapezium on accelerations asks the mean of the equations of both ends. Newmark (¼, ½) meets these one by one
  // from a₀ on. The acceleration drops out of the positions.
  struct Pair {
    Choice a, b;
  };
  const std::vector<Pair> implicit = {
      {scheme("generalised-alpha", {{"rho_inf", 1.0}}), scheme("newmark")},
      {scheme("generalised-alpha", {{"rho_inf", 1.0}}), scheme("kane")},
      {scheme("moreau-jean"), scheme("newmark")},
      {scheme("kane", {{"beta", 0.3}, {"gamma", 0.6}}), scheme("newmark", {{"beta", 0.3}, {"gamma", 0.6}})}};
  for (const Pair& pair : implicit) {
    INFO(label(pair.a) << " and " << label(pair.b));
    // 2000 steps, each of 10⁻¹⁶ of positions and of K q/K.
    CHECK(apart(busy_beam(), "none", pair.a, pair.b).relative() < 1e-12);
  }
  // Undamped, three levels of positions alone; q₁ agrees for β = 0, or from rest.
  const SceneSpec moving = compared_beam(0);
  SceneSpec resting = moving;
  resting.initial.velocity = Formula(0.0);
  CHECK(apart(moving, "none", scheme("central-difference"), scheme("carpenter-taylor-katona"), 1e-5).relative() <
        1e-12);
  CHECK(apart(moving, "none", scheme("central-difference"), scheme("cd-lagrange"), 1e-5).relative() < 1e-12);
  for (const double beta : {0.25, 0.5})
    CHECK(apart(resting, "none", scheme("newmark", {{"beta", beta}}), scheme("newmark-dumont-paoli", {{"beta", beta}}))
              .relative() < 1e-12);
}

TEST_CASE("Chung–Hulbert at ρ∞ = 1 is Kane's scheme through contact as well") {
  // Round-off grows with each contact: 10⁻¹⁰ to 3·10⁻⁷ for initial displacements within a few per cent.
  CHECK(apart(busy_beam(), "signorini", scheme("generalised-alpha", {{"rho_inf", 1.0}}), scheme("kane")).relative() <
        1e-4);
  // Newmark is another scheme there: its effort acts on three levels.
  CHECK(apart(busy_beam(), "signorini", scheme("newmark"), scheme("kane")).relative() > 1e-2);
}

TEST_CASE("Bathe's scheme of two trapezia is Newmark (¼, ½) of half the step, through contact as well") {
  const SceneSpec scene = busy_beam();
  const double h = 1e-4;
  for (const char* law : {"none", "signorini"}) {
    const ProblemFacts facts = facts_of(scene, true);
    Marcher two = march_of(scene, 10, law, plan_made(scheme("bathe", {{"rho_inf", 1.0}}), h, facts), h);
    Marcher one = march_of(scene, 10, law, plan_made(scheme("newmark"), h / 2, facts), h / 2);
    two.start();
    one.start();
    double worst = 0;
    // To the first impacts: Newmark's chatter then multiplies round-off.
    for (int n = 0; n < 500; ++n) {
      two.march(1);
      one.march(2);
      worst = std::max(worst, std::abs(two.tip(0) - one.tip(0)));
    }
    INFO(law);
    CHECK(worst < 1e-9);
  }
}

TEST_CASE("Bathe's scheme of 2005 takes its second velocity from three positions by backward differences") {
  // v₁ = (q_n − 4q_½ + 3q₁)/h, a₁ = (v_n − 4v_½ + 3v₁)/h and m a₁ + c v₁ + k q₁ = 0, after a trapezium of h/2.
  const double h = 0.05, k = 23, c = 0.7, d = h / 2;
  SceneSpec scene = oscillator(k, c, 0.3, -1.1);
  Marcher marched = marcher(scene, 1, {{"consistent"}, {"none"}, {"bathe", {{"split", 0.5}}}}, h);
  marched.start();
  double q = 0.3, v = -1.1, a = -c * v - k * q;
  for (int n = 0; n < 200; ++n) {
    const double half_a = (-c * (v + d / 2 * a) - k * (q + d * v + d * d / 4 * a)) / (1 + c * d / 2 + k * d * d / 4);
    const double half_v = v + d / 2 * (a + half_a), half_q = q + d / 2 * (v + half_v);
    // v₁ = (q_n − 4q_½)/h + 3q₁/h: one linear equation in q₁.
    const double v0 = (q - 4 * half_q) / h, a0 = (v - 4 * half_v + 3 * v0) / h;
    const double end = -(a0 + c * v0) / (9 / (h * h) + 3 * c / h + k);
    v = v0 + 3 * end / h;
    q = end;
    a = -c * v - k * q;
    marched.march(1);
    CHECK(marched.tip(0) == Approx(q).margin(1e-13));
  }
}

TEST_CASE("Laursen–Chawla is Moreau–Jean with θ = ½ and e = 1, the gate asked of q_n") {
  const SceneSpec scene = busy_beam();
  const double h = 1e-4;
  const ProblemFacts facts = facts_of(scene, true);
  StepPlan asked = plan_made(scheme("moreau-jean", {{"restitution", 1.0}}), h, facts);
  Stage& step = asked.stages[0];
  step.impact->gate->predictor = {.slots = {1}};
  step.impact->gate->predictor_bound = {{0, 1}};
  // The one takes loads at the middle, the other of both ends.
  step.load = {{0.5, 1}};
  Marcher first = march_of(scene, 10, "signorini", asked, h);
  Marcher second = march_of(scene, 10, "signorini", plan_made(scheme("laursen-chawla"), h, facts), h);
  CHECK(apart(first, second, 2000).most == 0);
  // As it is, Moreau–Jean asks half a step ahead, and turns a mass half a step earlier where that is beyond the stop.
  for (const double share : {0.2, 0.8}) {
    SceneSpec thrown = oscillator(0, 0, (3 + share) * h, -1);
    thrown.stops.lower = Formula(0.0);
    thrown.stops.place = StopsSpec::Place::tip;
    std::vector<double> ends;
    for (const Choice& time : {scheme("laursen-chawla"), scheme("moreau-jean", {{"restitution", 1.0}})}) {
      Marcher mass = marcher(thrown, 1, {{"consistent"}, {"signorini"}, time}, h);
      run(mass, 10 * h);
      ends.push_back(mass.tip(0));
    }
    INFO("ξ = " << share);
    // Turned in the step after, the mass is 2h behind.
    CHECK(ends[1] - ends[0] == Approx(share < 0.5 ? 2 * h : 0).margin(1e-15));
  }
}

TEST_CASE("the mid-point rule is Kane's where loads do not depend on time") {
  SceneSpec scene = compared_beam(1e-4);
  scene.load = Formula(-0.2);
  CHECK(apart(scene, "signorini", scheme("midpoint"), scheme("kane")).most == 0);
  CHECK(apart(busy_beam(), "none", scheme("midpoint"), scheme("kane")).most > 0);
}
