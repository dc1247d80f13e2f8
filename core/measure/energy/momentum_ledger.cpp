#include <algorithm>
#include <cmath>
#include <ricochet/contract/unit_mass.hpp>
#include <ricochet/measure/energy/momentum_ledger.hpp>

namespace ricochet {

MomentumLedger::MomentumLedger(const Program& program) : slot_count_(program.plan.slots.size()) {
  for (std::size_t j = 0; j < program.plan.velocity.slots.size(); ++j) reads_[j] = program.plan.velocity.slots[j];
  for (std::size_t k = 0; k < program.start.size(); ++k)
    start_.push_back(describe(program.plan.start[k], program.start[k]));
  for (std::size_t k = 0; k < program.stages.size(); ++k)
    stages_.push_back(describe(program.plan.stages[k], program.stages[k]));
}

MomentumLedger::Stage MomentumLedger::describe(const ricochet::Stage& plan, const StageProgram& program) const {
  Stage stage;
  const double S = plan.matrix.M;
  for (std::size_t j = 0; j < slot_count_; ++j) {
    const Combination& row = plan.update[j];
    for (std::size_t i = 0; i < row.slots.size(); ++i) stage.slots[j][i] = row.slots[i];
    if (S == 0) continue;
    for (std::size_t i = 0; i < plan.history.size(); ++i) stage.slots[j][i] += row.z * plan.history[i].M / S;
    stage.push[j] = row.z / S;
  }
  if (!program.reads_contact) return stage;
  if (const double w = UnitMass::jump(plan, program.impulse.weight); w != 0) {
    stage.jumps = true;
    const double fed = S != 0 ? plan.impulse->feed.M * w / S : 0.0;
    for (std::size_t j = 0; j < slot_count_; ++j) stage.jump[j] = plan.update[j].z * fed + plan.update[j].w * w;
  }
  stage.efforts = program.effort.size();
  std::copy(program.effort.begin(), program.effort.end(), stage.weights.begin());
  return stage;
}

void MomentumLedger::restart() {
  given_ += velocity_;
  velocity_ = largest_change_ = 0;
  state_.fill(0);
  past_.fill(0);
  moving_ = false;
}

void MomentumLedger::move(bool starting, std::size_t k, double force) {
  moving_ = true;
  quiet_ = force == 0 ? quiet_ + 1 : 0;
  // Only as far back as some stage looks.
  std::size_t longest = 1;
  for (const Stage& one : stages_) longest = std::max(longest, one.efforts);
  for (std::size_t i = longest; i-- > 1;) past_[i] = past_[i - 1];
  past_[0] = force;
  const Stage& stage = starting ? start_[k] : stages_[k];
  double effort = 0;
  for (std::size_t i = 0; i < stage.efforts; ++i) effort += stage.weights[i] * past_[i];
  std::array<double, most_slots> next{};
  for (std::size_t j = 0; j < slot_count_; ++j) {
    double sum = stage.push[j] * effort;
    if (stage.jumps) sum += stage.jump[j] * force;
    for (std::size_t i = 0; i < slot_count_; ++i) sum += stage.slots[j][i] * state_[i];
    next[j] = sum;
  }
  state_ = next;
}

void MomentumLedger::settle() {
  double velocity = 0;
  for (std::size_t j = 0; j < slot_count_; ++j) velocity += reads_[j] * state_[j];
  const double change = std::abs(velocity - velocity_);
  velocity_ = velocity;
  largest_change_ = std::max(largest_change_, change);
  // Once every weight has seen only zeros and the velocity stays, a mass that starts again tells the rest.
  if (quiet_ > most_efforts && change <= 1e-16 * largest_change_) restart();
}

}  // namespace ricochet
