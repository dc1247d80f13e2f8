#include <ricochet/contract/plugin.hpp>

namespace {

using namespace ricochet;

/// The mid-point rule on positions and velocities. With z = v_{n+1} − v_n:
///
///     (M/h + ½C + h/4 K) z = F(t+h/2) − C v − K(q + h/2 v) + Hᵀp
///     q ← q + h v + h/2 z,   v ← v + z,   y = H q_{n+1} (end) or H(q_n + q_{n+1})/2 (middle)
///
/// Invariant (undamped, free): ½|v|²_M + ½|q|²_K; test displacement q_{n+1} − q_n = h(v + z/2), which the effort meets
/// whole: with the constraint at the end contact gives p(bound − H q_n) ≤ 0.
class Midpoint final : public TimeScheme {
 public:
  explicit Midpoint(bool middle) : middle_(middle) {}

  PlanOrRefusal plan(double h, const ProblemFacts&) const override {
    StepPlan plan;
    plan.slots = {"q", "v"};
    plan.initial = {{1, 0}, {0, 1}};
    plan.velocity = {.slots = {0, 1}};
    Stage stage;
    stage.matrix = {1 / h, 0.5, h / 4};
    stage.history = {{0, 0, -1}, {0, -1, -h / 2}};
    stage.load = {{0.5, 1}};
    const Combination end{.slots = {1, h}, .z = h / 2}, end_rate{.slots = {0, 1}, .z = 1};
    const Combination mean{.slots = {1, h / 2}, .z = h / 4}, mean_rate{.slots = {0, 1}, .z = 0.5};
    stage.impact = middle_ ? ImpactMeasure{mean, {{0, 0.5}, {1, 0.5}}} : ImpactMeasure{end, {{1, 1}}};
    stage.at(Evaluation::implicit_end) = {end, {{1, 1}}, end_rate, {{1, 1}}, {1}};
    stage.at(Evaluation::averaged) = {mean, {{0, 0.5}, {1, 0.5}}, mean_rate, {{0.5, 1}}, {1}};
    stage.at(Evaluation::explicit_start) = {{.slots = {1, h / 2}}, {{0.5, 1}}, {.slots = {0, 1}}, {{0, 1}}, {1}};
    stage.at(Evaluation::conserving) = {.displacement = end,
                                        .bound = {{1, 1}},
                                        .rate = mean_rate,
                                        .rate_bound = {{0.5, 1}},
                                        .before = Combination{.slots = {1}},
                                        .before_bound = {{0, 1}}};
    stage.update = {end, end_rate};
    stage.work = {.displacement = {.slots = {0, h}, .z = h / 2},
                  .rate = mean_rate,
                  .load = {{0.5, 1}},
                  .support = {{1, 1}, {0, -1}}};
    plan.stages = {stage};
    plan.energy = {{EnergyMatrix::M, 0.5, {0, 1}}, {EnergyMatrix::K, 0.5, {1}}};
    plan.facts.order = 2;
    plan.facts.contact_never_gains = !middle_;
    return plan;
  }

 private:
  bool middle_;
};

void register_all(Registry& registry) {
  registry.add_time(
      {.name = "midpoint",
       .summary = "mid-point rule, stops at position level",
       .text =
           "Forces at mid-step, positions between the stops at its end: of second order, unconditionally stable, and "
           "contact never gives energy; a massed point keeps between none and all of its speed, one half on average. "
           "With a law that takes the discrete gradient of its potential (evaluation conserving) the sum of the "
           "energies is kept to round-off. With the constraint at the middle the rebound is up to three times too "
           "fast: it is here to show that. On the kernel of a singular undamped mass the root −1 stays.",
       .source = "Simo and Tarnow (1992), The discrete energy–momentum method; Armero and Petocz (1998) for contact "
                 "that conserves; Kane, Repetto, Ortiz and Marsden (1999) for the constraint at the end",
       .parameters = {word_parameter("constraint", {"end", "middle"}, "end",
                                     "which position lies between the stops: that of the end, or the mean of both")}},
      [](const Parameters& p) { return std::make_unique<Midpoint>(p.word("constraint") == "middle"); });
}

}  // namespace

RICOCHET_PLUGIN(time, midpoint, register_all)
