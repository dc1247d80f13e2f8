#include <fmt/format.h>

#include <ricochet/contract/plugin.hpp>

namespace {

using namespace ricochet;

/// Kane, Repetto, Ortiz and Marsden's Newmark, contact implicit whatever β and γ; here β = γ/2. With k = (1−γ)h,
/// c = (½−β)h², q* = q + h v + c a:
///
///     stage 1, z = q_{n+1} − q*:   (2/h² M + 2γ/h C + γK) z = γ(F(t+h) − C(v + k a) − K q*) + Hᵀp,   y = H q_{n+1}
///                                  q ← q* + z,   v ← v + k a + (2/h) z
///     stage 2, z = a_{n+1}:        M z = F(t+h) − C v − K q,   a ← z
///
/// p is the mean force of the step, of which the stored acceleration knows nothing. At (¼, ½) the acceleration is not
/// needed: one stage, z = v_{n+1} − v_n, (M/h + ½C + h/4 K) z = ½F(t) + ½F(t+h) − C v − K(q + h/2 v) + Hᵀp.
/// Energy (undamped, free): ½|v|²_M + ½|q|²_K, of which a step takes (γ−½)|Δq|²_K; test displacement Δq = q_{n+1} − q_n
/// with the equations of both ends, γ and 1−γ. Contact gives p(bound − H q_n) ≤ 0.
class Kane final : public TimeScheme {
 public:
  Kane(double beta, double gamma) : beta_(beta), gamma_(gamma) {}

  PlanOrRefusal plan(double h, const ProblemFacts& facts) const override {
    if (beta_ != gamma_ / 2)
      return Refusal{
          fmt::format("beta = {:g} is not gamma/2 = {:g}: the effort then enters position and velocity by "
                      "two solves of one equation, which no plan of one unknown says; use beta = gamma/2",
                      beta_, gamma_ / 2)};
    if (gamma_ != 0.5 && facts.mass_kernel_dimension > 0)
      return Refusal{
          "the acceleration at the end of the step needs the inverse of the mass, which is singular here: "
          "use beta = 0.25 with gamma = 0.5, or a regular mass"};
    StepPlan plan;
    plan.slots = {"q", "v"};
    plan.initial = {{1, 0}, {0, 1}};
    plan.velocity = {.slots = {0, 1}};
    plan.energy = {{EnergyMatrix::M, 0.5, {0, 1}}, {EnergyMatrix::K, 0.5, {1}}};
    plan.facts.order = gamma_ == 0.5 ? 2 : 1;
    plan.facts.contact_never_gains = true;
    if (gamma_ == 0.5) {
      plan.stages = {mean_step(h)};
      return plan;
    }
    plan.slots.emplace_back("a");
    plan.initial.push_back({0, 0});
    plan.start = {acceleration(0)};
    plan.stages = {step(h), acceleration(1)};
    plan.facts.needs_regular_mass = true;
    return plan;
  }

 private:
  // What both forms have in common: the end of the step, its middle, and the way between.
  static void measure(Stage& stage, const Combination& end, const Combination& end_rate, const Combination& known) {
    const auto halfway = [](Combination to, std::size_t from) {
      for (double& slot : to.slots) slot /= 2;
      to.slots[from] += 0.5;
      to.z /= 2;
      return to;
    };
    const Combination mean = halfway(end, 0), mean_rate = halfway(end_rate, 1);
    stage.impact = {.value = end, .bound = {{1, 1}}};
    stage.at(Evaluation::implicit_end) = {end, {{1, 1}}, end_rate, {{1, 1}}, {1}};
    stage.at(Evaluation::averaged) = {mean, {{0, 0.5}, {1, 0.5}}, mean_rate, {{0, 0.5}, {1, 0.5}}, {1}};
    stage.at(Evaluation::explicit_start) = {known, {{0.5, 1}}, {.slots = {0, 1}}, {{0, 1}}, {1}};
    stage.at(Evaluation::conserving) = {
        end, {{1, 1}}, mean_rate, {{0, 0.5}, {1, 0.5}}, {1}, Combination{.slots = {1}}, {{0, 1}}};
    Combination way = end;
    way.slots[0] -= 1;
    stage.work = {.displacement = way, .rate = mean_rate, .load = {{0, 0.5}, {1, 0.5}}, .support = {{1, 1}, {0, -1}}};
  }

  static Stage mean_step(double h) {
    Stage stage;
    stage.matrix = {1 / h, 0.5, h / 4};
    stage.history = {{0, 0, -1}, {0, -1, -h / 2}};
    stage.load = {{0, 0.5}, {1, 0.5}};
    const Combination end{.slots = {1, h}, .z = h / 2}, end_rate{.slots = {0, 1}, .z = 1};
    measure(stage, end, end_rate, {.slots = {1, h / 2}});
    stage.update = {end, end_rate};
    return stage;
  }

  Stage step(double h) const {
    const double lag = (1 - gamma_) * h, curve = (0.5 - beta_) * h * h;
    Stage stage;
    stage.matrix = {2 / (h * h), 2 * gamma_ / h, gamma_};
    stage.history = {{0, 0, -gamma_}, {0, -gamma_, -gamma_ * h}, {0, -gamma_ * lag, -gamma_ * curve}};
    stage.load = {{1, gamma_}};
    const Combination end{.slots = {1, h, curve}, .z = 1}, end_rate{.slots = {0, 1, lag}, .z = 2 / h};
    measure(stage, end, end_rate, {.slots = {1, h / 2}});
    stage.work->rate = {.slots = {0, 1, gamma_ * lag}, .z = 2 * gamma_ / h};
    stage.work->load = {{0, 1 - gamma_}, {1, gamma_}};
    stage.loss = {{EnergyMatrix::K, gamma_ - 0.5, stage.work->displacement}};
    stage.update = {end, end_rate, {.slots = {0, 0, 1}}};
    return stage;
  }

  static Stage acceleration(double at) {
    Stage stage;
    stage.matrix = {1, 0, 0};
    stage.history = {{0, 0, -1}, {0, -1, 0}};
    stage.load = {{at, 1}};
    stage.update = {{.slots = {1}}, {.slots = {0, 1}}, {.slots = {}, .z = 1}};
    return stage;
  }

  double beta_, gamma_;
};

void register_all(Registry& registry) {
  registry.add_time(
      {.name = "kane",
       .summary = "Newmark whose contact is implicit in position and left out of the acceleration",
       .text =
           "Newmark's updates; the contact force is a mean over the step that keeps q_{n+1} between the stops, and the "
           "acceleration that the next step starts from is that of the structure alone. Contact never gives energy, "
           "for β = γ/2 and γ ≥ ½; a massed point keeps between none and all of its speed, one half on average. With "
           "(¼, ½) it is the mid-point rule with loads of both ends, of second order; above γ = ½ it damps, at first "
           "order, and solves twice per step.",
       .source =
           "Kane, Repetto, Ortiz and Marsden (1999), Finite element analysis of nonsmooth contact; Kane, Marsden, "
           "Ortiz and West (2000), Variational integrators and the Newmark algorithm",
       .parameters = {real_parameter("beta", "1", 0.25, {.low = 0, .high = 0.5}, "β"),
                      real_parameter("gamma", "1", 0.5, {.low = 0.5, .high = 1},
                                     "γ; above ½ it damps, at first order")}},
      [](const Parameters& p) { return std::make_unique<Kane>(p.real("beta"), p.real("gamma")); });
}

}  // namespace

RICOCHET_PLUGIN(time, kane, register_all)
