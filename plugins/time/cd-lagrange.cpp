#include <ricochet/contract/plugin.hpp>

namespace {

using namespace ricochet;

/// CD-Lagrange: central differences in leap-frog form, Newton's law at velocity level. The slot w is the velocity half
/// a step ahead of q, z = w_{n+3/2} − w_{n+1/2}:
///
///     M/h z = F(t+h) − C w − K(q + h w) + Hᵀp,   q ← q + h w,   w ← w + z,   y = H w_{n+3/2}
///
/// on the points that the position q + h w, known before the solve, finds at or beyond their stop. Energy (undamped,
/// free): ½|w|²_M + ½|q + h w/2|²_K − ⅛h²|w|²_K; test displacement h(w + z/2). Start: w = v₀ + h/2 a₀.
class CdLagrange final : public TimeScheme {
 public:
  explicit CdLagrange(double restitution) : e_(restitution) {}

  PlanOrRefusal plan(double h, const ProblemFacts& facts) const override {
    if (facts.mass_kernel_dimension > 0)
      return Refusal{
          "the velocity of the next half step needs the inverse of the mass, which is singular here: use a "
          "lumped mass, or an implicit scheme"};
    StepPlan plan;
    plan.slots = {"q", "w"};
    plan.initial = {{1, 0}, {0, 1}};
    plan.velocity = {.slots = {0, 1}};
    plan.start = {start(h)};
    plan.stages = {step(h)};
    plan.energy = {
        {EnergyMatrix::M, 0.5, {0, 1}}, {EnergyMatrix::K, 0.5, {1, h / 2}}, {EnergyMatrix::K, -0.125 * h * h, {0, 1}}};
    plan.facts.order = facts.damped ? 1 : 2;
    plan.facts.contact_order = 1;
    plan.facts.restitution = Restitution::exact;
    plan.facts.needs_regular_mass = true;
    plan.facts.stability_limit = 2;
    plan.facts.contact_never_gains = true;
    return plan;
  }

 private:
  Stage step(double h) const {
    const Combination ahead{.slots = {1, h}}, rate{.slots = {0, 1}}, next{.slots = {0, 1}, .z = 1};
    const Combination middle{.slots = {0, 1}, .z = 0.5};
    Stage stage;
    stage.matrix = {1 / h, 0, 0};
    stage.history = {{0, 0, -1}, {0, -1, -h}};
    stage.load = {{1, 1}};
    stage.impact = {next, {{1.5, 1}}, VelocityGate{ahead, {{1, 1}}, rate, {{0.5, 1}}, e_}};
    // The position that the force is asked at is known before the solve; the rate it may wait for.
    stage.at(Evaluation::implicit_end) = {ahead, {{1, 1}}, middle, {{1, 1}}, {1}};
    stage.at(Evaluation::averaged) = stage.at(Evaluation::implicit_end);
    stage.at(Evaluation::explicit_start) = {ahead, {{1, 1}}, rate, {{0.5, 1}}, {1}};
    stage.at(Evaluation::conserving) = {.displacement = {.slots = {1, 1.5 * h}, .z = h / 2},
                                        .bound = {{1, 0.5}, {2, 0.5}},
                                        .rate = middle,
                                        .rate_bound = {{1, 1}},
                                        .before = Combination{.slots = {1, 0.5 * h}},
                                        .before_bound = {{0, 0.5}, {1, 0.5}}};
    stage.update = {ahead, next};
    stage.work = {.displacement = {.slots = {0, h}, .z = h / 2},
                  .rate = rate,
                  .load = {{1, 1}},
                  .support = {{2, 0.5}, {0, -0.5}}};
    return stage;
  }

  // 2/h M z = F(0) − C v₀ − K q₀ (+ Hᵀp where the state rests on a stop): w = v₀ + z.
  Stage start(double h) const {
    const Combination position{.slots = {1}}, rate{.slots = {0, 1}}, next{.slots = {0, 1}, .z = 1};
    Stage stage;
    stage.matrix = {2 / h, 0, 0};
    stage.history = {{0, 0, -1}, {0, -1, 0}};
    stage.load = {{0, 1}};
    stage.impact = {next, {{0.5, 1}}, VelocityGate{position, {{0, 1}}, rate, {{0, 1}}, e_}};
    for (auto& compliance : stage.compliance) compliance = {position, {{0, 1}}, rate, {{0, 1}}, {1}};
    stage.at(Evaluation::conserving)->before = position;
    stage.at(Evaluation::conserving)->before_bound = {{0, 1}};
    stage.update = {position, next};
    return stage;
  }

  double e_;
};

void register_all(Registry& registry) {
  registry.add_time(
      {.name = "cd-lagrange",
       .summary = "explicit central differences with Newton's impact law on the mid-step velocities",
       .text = "Leap-frog: positions at the steps, velocities between them, one solve with the mass matrix alone, so "
               "that a lumped mass makes it explicit. Points whose known next position has reached a stop get "
               "v⁺ = −e v⁻ on the mid-step velocities: contact never gives energy. Stable up to hω = 2. A damping "
               "force is taken half a step late: of first order where the structure is damped, of second where it is "
               "not.",
       .source = "Fekak, Brun, Gravouil and Depale (2017), A new heterogeneous asynchronous explicit–implicit time "
                 "integrator for nonsmooth dynamics",
       .parameters = {with_role(
           real_parameter("restitution", "1", 0.0, {.low = 0, .high = 1}, "e, Newton's restitution coefficient"),
           ParameterRole::restitution)}},
      [](const Parameters& p) { return std::make_unique<CdLagrange>(p.real("restitution")); });
}

}  // namespace

RICOCHET_PLUGIN(time, cd_lagrange, register_all)
