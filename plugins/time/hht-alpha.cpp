#include <fmt/format.h>

#include <ricochet/contract/plugin.hpp>

namespace {

using namespace ricochet;

/// Hilber, Hughes and Taylor's scheme: Newmark's updates, forces of structure and loads weighted over both ends of the
/// step. With a = −α, f = 1 − a, γ = ½ + a, β = (1 + a)²/4 and z = a_{n+1}:
///
///     M z + f(C v_{n+1} + K q_{n+1}) + a(C v_n + K q_n) = f F(t+h) + a F(t) + Hᵀπ(p),     y = H q_{n+1}
///     q ← q + h v + (½−β)h² a + βh² z,   v ← v + (1−γ)h a + γh z,   a ← z
///
/// π(p) = p, or f p + a p₋₁ where contact is one of the weighted forces. With d = q_n − q_{n−1}, Δd and Δa its change
/// and that of a, the energy (undamped, free)
///
///     E = ½|v|²_M + ½|q|²_K + ⅛a²h²|a|²_M + ½a(½−a)|d|²_K,     −ΔE = ¼a³h²|Δa|²_M + ½a(½−a)|Δd|²_K
///
/// never grows; test displacement q_{n+1} − q_n with the equations of both ends, ½+a and ½−a. Those of the step before
/// need its velocity (slot u, where there is damping) and its load; the start rule weights its load alike.
class HilberHughesTaylor final : public TimeScheme {
 public:
  HilberHughesTaylor(double alpha, bool weighted)
      : a_(0 - alpha), f_(1 - a_), gamma_(0.5 + a_), beta_(0.25 * (1 + a_) * (1 + a_)), weighted_(weighted) {}

  PlanOrRefusal plan(double h, const ProblemFacts& facts) const override {
    StepPlan plan;
    plan.slots = {"q", "v", "a"};
    plan.initial = {{1, 0}, {0, 1}, {0, 0}};
    plan.velocity = {.slots = {0, 1}};
    plan.start = {initial_acceleration(h, facts.mass_kernel_dimension > 0)};
    plan.stages = {step(h)};
    plan.energy = {{EnergyMatrix::M, 0.5, {0, 1}}, {EnergyMatrix::K, 0.5, {1}}};
    plan.facts.order = 2;
    if (a_ == 0) return plan;
    plan.energy.push_back({EnergyMatrix::M, 0.125 * a_ * a_ * h * h, {0, 0, 1}});
    plan.energy.push_back({EnergyMatrix::K, 0.5 * a_ * (0.5 - a_), {0, 0, 0, 1}});
    add_slot(plan, "d", {0, 0}, increment(h));
    if (facts.damped) {
      add_slot(plan, "u", {0, 1}, {.slots = {0, 1}});
      // Without the slot the share of the step before is counted at v_n: only damping sees it.
      std::vector<double>& r = plan.stages[0].work->rate.slots;
      const double before = (0.5 - a_) * a_;
      r[1] -= before;
      r.resize(5, 0);
      r[4] = before;
    }
    return plan;
  }

 private:
  static void add_slot(StepPlan& plan, const char* name, std::array<double, 2> initial, const Combination& update) {
    plan.slots.emplace_back(name);
    plan.initial.push_back(initial);
    Combination kept;
    kept.slots.assign(plan.slots.size(), 0);
    kept.slots.back() = 1;
    plan.start[0].update.push_back(kept);
    plan.stages[0].update.push_back(update);
  }

  double lag(double h) const { return (1 - gamma_) * h; }
  double curve(double h) const { return (0.5 - beta_) * h * h; }
  Combination end(double h) const { return {.slots = {1, h, curve(h)}, .z = beta_ * h * h}; }
  Combination increment(double h) const { return {.slots = {0, h, curve(h)}, .z = beta_ * h * h}; }
  std::vector<double> both_ends() const { return a_ == 0 ? std::vector{1.0} : std::vector{f_, a_}; }

  Stage step(double h) const {
    Stage stage;
    stage.matrix = {1, f_ * gamma_ * h, f_ * beta_ * h * h};
    stage.history = {{0, 0, -1}, {0, -1, -f_ * h}, {0, -f_ * lag(h), -f_ * curve(h)}};
    stage.load = {{1, f_}};
    if (a_ != 0) stage.load.push_back({0, a_});
    stage.impact = {.value = end(h), .bound = {{1, 1}}, .effort = weighted_ ? both_ends() : std::vector{1.0}};
    const Combination end_rate{.slots = {0, 1, lag(h)}, .z = gamma_ * h};
    stage.at(Evaluation::implicit_end) = {end(h), {{1, 1}}, end_rate, {{1, 1}}, {1}};
    stage.at(Evaluation::averaged) = {end(h), {{1, 1}}, end_rate, {{1, 1}}, both_ends()};
    stage.at(Evaluation::explicit_start) = {
        {.slots = {1, h, curve(h)}}, {{1, 1}}, {.slots = {0, 1, lag(h)}}, {{1, 1}}, {1}};
    stage.update = {end(h), end_rate, {.slots = {}, .z = 1}};
    const double now = 0.5 + a_, before = 0.5 - a_;
    stage.work = {.displacement = increment(h),
                  .rate = {.slots = {0, now + before, now * f_ * lag(h)}, .z = now * f_ * gamma_ * h},
                  .load = {{0, now * a_ + before * f_}, {1, now * f_}},
                  .effort = {now, before}};
    if (a_ == 0) return stage;
    stage.work->load.push_back({-1, before * a_});
    Combination change = increment(h);
    change.slots.push_back(-1);
    stage.loss = {{EnergyMatrix::M, 0.25 * a_ * a_ * a_ * h * h, {.slots = {0, 0, -1}, .z = 1}},
                  {EnergyMatrix::K, 0.5 * a_ * (0.5 - a_), change}};
    return stage;
  }

  // M a₀ = f F(0) + a F(−h) − C v₀ − K q₀ (+ Hᵀp so that the Taylor step does not pass a stop that the state rests on).
  // On the kernel of a singular mass a₀ is not defined: βh²K is added to M there.
  Stage initial_acceleration(double h, bool singular_mass) const {
    Stage stage;
    stage.matrix = {1, 0, singular_mass ? beta_ * h * h : 0};
    stage.history = {{0, 0, -1}, {0, -1, 0}};
    stage.load = {{0, f_}};
    if (a_ != 0) stage.load.push_back({-1, a_});
    stage.impact = {.value = {.slots = {1, h}, .z = 0.5 * h * h}, .bound = {{1, 1}}};
    for (const auto evaluation : {Evaluation::implicit_end, Evaluation::averaged, Evaluation::explicit_start})
      stage.at(evaluation) = {{.slots = {1}}, {{0, 1}}, {.slots = {0, 1}}, {{0, 1}}, {1}};
    stage.update = {{.slots = {1}}, {.slots = {0, 1}}, {.slots = {}, .z = 1}};
    return stage;
  }

  double a_, f_, gamma_, beta_;
  bool weighted_;
};

void register_all(Registry& registry) {
  registry.add_time(
      {.name = "hht-alpha",
       .summary = "Hilber–Hughes–Taylor α: Newmark that damps high frequencies at second order",
       .text =
           "Newmark's updates with γ = ½ − α, β = (1−α)²/4, and elastic, viscous and applied forces weighted 1+α and "
           "−α over both ends of the step: of second order, unconditionally stable, the highest frequencies shrink by "
           "(1+α)/(1−α) per step. α = 0 is Newmark (¼, ½). Stops are at position level, and a massed point is thrown "
           "back faster than it came (up to 2.3 times at α = −0.1): energy grows at impacts. On a singular mass the "
           "force is clean, and the damping takes the sawtooth that Newmark leaves there.",
       .source = "Hilber, Hughes and Taylor (1977), Improved numerical dissipation for time integration algorithms in "
                 "structural dynamics; Hughes (1987), The Finite Element Method, section 9.3",
       .parameters = {real_parameter("alpha", "1", -0.1, {.low = -1.0 / 3, .high = 0}, "α; 0 does not damp"),
                      word_parameter("contact", {"end", "weighted"}, "end",
                                     "how a rigid effort enters: end, whole (π = 1); weighted, among the internal "
                                     "forces (1+α now, −α of the effort before)")}},
      [](const Parameters& p) {
        return std::make_unique<HilberHughesTaylor>(p.real("alpha"), p.word("contact") == "weighted");
      });
}

}  // namespace

RICOCHET_PLUGIN(time, hht_alpha, register_all)
