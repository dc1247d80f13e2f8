#include <algorithm>
#include <ricochet/engine/flight/flight.hpp>
#include <ricochet/engine/marcher.hpp>
#include <ricochet/engine/stage_state.hpp>

namespace ricochet {

// The closed points of the lane into held_; false where what contact was still acts, or may. To be asked before every
// step.
bool Marcher::contact_set() {
  held_.clear();
  const bool closed = std::any_of(stage_states_.begin(), stage_states_.end(),
                                  [](const auto& stage) { return (stage->contact_lanes & 1U) != 0; });
  quiet_ = closed ? 0 : quiet_ + 1;
  if (closed) ++closed_visits_;
  if (!program_.contact) return true;
  if (!closed) {
    if (quiet_ < quiet_after_) return false;
    const double* memory = memory_.data();
    return std::all_of(memory, memory + memory_.size(), [](double kept) { return kept == 0; });
  }
  if (!program_.flight->held_cause().empty() && !program_.flight->steps_cause().empty()) return false;
  // The same ones in every stage.
  bool first = true;
  for (const auto& stage : stage_states_) {
    if (stage->effort.empty()) continue;
    const Block& effort = stage->effort[0];
    std::size_t next = 0;
    for (int i = 0; i < effort.rows(); ++i) {
      const double p = effort.at(i, 0);
      if (p == 0) continue;
      const HeldPoint point{i, p > 0};
      if (first)
        held_.push_back(point);
      else if (next == held_.size() || !(held_[next++] == point))
        return false;
    }
    if (!first && next != held_.size()) return false;
    first = false;
  }
  return true;
}

// Where the efforts of the stages stand.
void Marcher::find_past() {
  if (!past_.empty()) return;
  for (const auto& stage : stage_states_) {
    std::vector<double*>& efforts = past_.emplace_back();
    for (Block& effort : stage->effort) efforts.push_back(effort.data());
  }
}

// The state of the lane and of its tangents, column by column.
void Marcher::gather_columns() {
  const auto count = static_cast<std::size_t>(1 + program_.tangents), width = static_cast<std::size_t>(program_.width);
  if (width == 1) {
    column_slots_.assign(1, slots_.data());
    return;
  }
  const auto rows = static_cast<std::size_t>(program_.model->rows()), slots = slots_.size();
  columns_.resize(count * slots * rows);
  column_pointers_.resize(count * slots);
  column_slots_.resize(count);
  for (std::size_t c = 0; c < count; ++c) {
    for (std::size_t j = 0; j < slots; ++j) {
      double* const to = column_pointers_[c * slots + j] = columns_.data() + (c * slots + j) * rows;
      for (std::size_t i = 0; i < rows; ++i) to[i] = slots_[j][i * width + c];
    }
    column_slots_[c] = column_pointers_.data() + c * slots;
  }
}

void Marcher::scatter_columns() {
  const auto width = static_cast<std::size_t>(program_.width);
  if (width == 1) return;
  const auto rows = static_cast<std::size_t>(program_.model->rows());
  for (std::size_t c = 0; c < column_slots_.size(); ++c)
    for (std::size_t j = 0; j < slots_.size(); ++j)
      for (std::size_t i = 0; i < rows; ++i) slots_[j][i * width + c] = column_slots_[c][j][i];
}

// Leaves out steps in which contact stays what it is, before the next one; returns how many.
long long Marcher::fly(long long most, StepObserver* observer) {
  // Tangents that wait through the first steps of an impact count them.
  if (held_steps_ > 0) return 0;
  if (!contact_set() || most < Flight::least || !status_.front().running) return 0;
  if (observer) most = std::min(most, observer->may_skip(*this));
  Flight& flight = *program_.flight;
  if (most < Flight::least || !flight.due(program_, held_)) return 0;
  double e[3] = {0, 0, 0};
  if (program_.support) {
    clamp_.set_time(time());
    clamp_.drive(0, e[0], e[1]);
    e[2] = 1;
  } else {
    e[0] = 1;
  }
  gather_columns();
  find_past();
  const long long k = flight.look(column_slots_, e, past_, most);
  clear_ = flight.clear();
  if (k == 0) return 0;
  SkippedSteps skipped;
  skipped.steps = k;
  skipped.from = time();
  skipped.works = flight.fly(k, column_slots_, past_, observer != nullptr);
  scatter_columns();
  step_ += k;
  if (!held_.empty()) held_left_out_ += k;
  skipped.to = time();
  skipped.held = held_;
  for (const StageProgram& stage : program_.stages) skipped.instants += stage.closes_instant ? 1 : 0;
  skipped.penetration = held_.empty() ? 0 : flight.penetration();
  skipped.flight = &flight;
  combined_for_ = nullptr;
  check_lanes();
  if (observer) observer->skipped(*this, skipped);
  return k;
}

}  // namespace ricochet
