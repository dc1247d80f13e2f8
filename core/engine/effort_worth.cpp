#include <algorithm>
#include <cmath>
#include <ricochet/contract/momentum_weights.hpp>
#include <ricochet/engine/effort_worth.hpp>

namespace ricochet {
namespace {

// What momentum an effort of 1 N gives to a free mass within the stage itself, N s.
double momentum_at_once(const StepPlan& plan, const Stage& stage) {
  double moved = 0;
  for (std::size_t j = 0; j < plan.velocity.slots.size(); ++j) moved += plan.velocity.slots[j] * stage.update[j].z;
  return stage.matrix.M != 0 ? moved / stage.matrix.M : 0.0;
}

// Efforts of friction as those of a law that weights none of before.
StageEfforts friction_read(const std::vector<StageProgram>& stages) {
  StageEfforts efforts(stages.size());
  for (std::size_t k = 0; k < stages.size(); ++k)
    if (stages[k].reads_contact) efforts[k] = {{stages[k].friction_weight}, stages[k].impulse.weight};
  return efforts;
}

StageEfforts efforts_read(const std::vector<StageProgram>& stages) {
  StageEfforts efforts(stages.size());
  for (std::size_t k = 0; k < stages.size(); ++k)
    if (stages[k].reads_contact) efforts[k] = {stages[k].effort, stages[k].impulse.weight};
  return efforts;
}

// Σ_j w_j e₋ⱼ + w_ι ι p, e₋ⱼ = Σ_k π_k p₋ⱼ₋ₖ with the weights of the stage j before; `cyclic`: stages without end.
std::vector<double> work_efforts(const WorkForm& work, std::size_t stage, const StageEfforts& efforts, bool cyclic) {
  const std::size_t stages = efforts.size();
  std::vector<double> weights;
  for (std::size_t j = 0; j < work.effort.size() && (cyclic || j <= stage); ++j) {
    const std::vector<double>& pi = efforts[(stage + stages * j - j) % stages].weights;
    if (weights.size() < j + pi.size()) weights.resize(j + pi.size(), 0.0);
    for (std::size_t k = 0; k < pi.size(); ++k) weights[j + k] += work.effort[j] * pi[k];
  }
  if (efforts[stage].impulse != 0) weights[0] += work.impulse * efforts[stage].impulse;
  return weights;
}

}  // namespace

void add_friction_facts(Program& program) {
  const StageEfforts efforts = friction_read(program.stages), start = friction_read(program.start);
  const EffortMomenta momenta = effort_momenta(program.plan, start, efforts);
  const auto add = [&](std::vector<StageProgram>& stages, const std::vector<Stage>& plan, const StageEfforts& read,
                       const std::vector<double>& worth, bool cyclic) {
    for (std::size_t k = 0; k < stages.size(); ++k) {
      if (!stages[k].reads_contact) continue;
      stages[k].friction_momentum = worth[k];
      if (const auto& work = plan[k].work)
        stages[k].friction_work = work_efforts(*work, k, read, cyclic);
      else if (!cyclic)
        stages[k].friction_work = {momentum_at_once(program.plan, plan[k]) * stages[k].friction_weight};
    }
  };
  add(program.stages, program.plan.stages, efforts, momenta.stages, true);
  add(program.start, program.plan.start, start, momenta.start, false);
}

namespace {

// The latest level at which a stage reads a compliant law; where its instant is, for a rigid one.
double latest_read(const StageProgram& stage) {
  if (!stage.compliance || stage.measure_levels.empty()) return stage.facts.instant;
  double latest = stage.measure_levels.front().at;
  for (const Level& level : stage.measure_levels) latest = std::max(latest, level.at);
  return latest;
}

// Which stages are one contact instant, how long it lasts, and which of a step that goes back in time keeps a memory.
void add_instants(std::vector<StageProgram>& stages) {
  constexpr double same = 1e-9;  // of a step
  std::vector<StageProgram*> asks;
  for (StageProgram& stage : stages)
    if (stage.reads_contact) asks.push_back(&stage);
  if (asks.empty()) return;
  bool goes_back = false;
  double sum = 0, latest = latest_read(*asks.front());
  for (std::size_t k = 0; k < asks.size(); ++k) {
    goes_back = goes_back || (k > 0 && latest_read(*asks[k]) < latest_read(*asks[k - 1]) - same);
    latest = std::max(latest, latest_read(*asks[k]));
    sum += asks[k]->momentum;
  }
  for (std::size_t first = 0, next = 0; first < asks.size(); first = next) {
    double lasts = goes_back ? sum : 0;
    for (next = first; next < asks.size(); ++next) {
      if (!goes_back && std::abs(asks[next]->facts.instant - asks[first]->facts.instant) > same) break;
      lasts = std::max(lasts, asks[next]->momentum);
    }
    asks[first]->opens_instant = asks[next - 1]->closes_instant = true;
    for (std::size_t k = first; k < next; ++k) {
      StageProgram& stage = *asks[k];
      stage.lasts = lasts;
      stage.force_share = goes_back && sum > 0 ? stage.momentum / sum : stage.momentum != 0 ? 1 : 0;
      stage.keeps_memory = !goes_back || latest_read(stage) > latest - same;
    }
  }
}

}  // namespace

std::optional<Refusal> add_contact_facts(Program& program) {
  const StageEfforts efforts = efforts_read(program.stages), start = efforts_read(program.start);
  const EffortMomenta momenta = effort_momenta(program.plan, start, efforts);
  if (program.contact && !momenta.why_none.empty())
    return Refusal{"contact gives no definite impulse under this time scheme, as " + momenta.why_none +
                   ": use another time scheme, or the contact law none"};
  for (std::size_t k = 0; k < program.stages.size(); ++k) {
    StageProgram& stage = program.stages[k];
    if (!stage.reads_contact) continue;
    stage.momentum = momenta.stages[k];
    if (const auto& work = program.plan.stages[k].work) stage.work_effort = work_efforts(*work, k, efforts, true);
  }
  add_instants(program.stages);
  for (std::size_t k = 0; k < program.start.size(); ++k) {
    StageProgram& stage = program.start[k];
    if (!stage.reads_contact) continue;
    stage.opens_instant = stage.closes_instant = true;
    stage.momentum = stage.lasts = momenta.start[k];
    stage.force_share = stage.momentum != 0 ? 1 : 0;
    if (const auto& work = program.plan.start[k].work)
      stage.work_effort = work_efforts(*work, k, start, false);
    else
      stage.work_effort = {momentum_at_once(program.plan, program.plan.start[k])};
  }
  return std::nullopt;
}

}  // namespace ricochet
