#include <algorithm>
#include <ricochet/engine/flight/lane_flight.hpp>

namespace ricochet {

bool LaneFlight::follow(const FlownLane& lane) {
  if (past_.empty()) connect(lane);
  closed_.clear();
  const bool closed = std::any_of(lane.stages.begin(), lane.stages.end(),
                                  [](const auto& stage) { return (stage->contact_lanes & 1U) != 0; });
  open_steps_ = closed ? 0 : open_steps_ + 1;
  if (!lane.program.contact) return true;
  if (!closed) {
    if (open_steps_ < settles_after_) return false;
    const double* memory = lane.memory.data();
    return std::all_of(memory, memory + lane.memory.size(), [](double kept) { return kept == 0; });
  }
  const Flight& flight = *lane.program.flight;
  return (flight.closed_cause().empty() || flight.steps_cause().empty()) && find_closed(lane);
}

// Whether the same points are closed in every stage.
bool LaneFlight::find_closed(const FlownLane& lane) {
  bool first = true;
  for (const auto& stage : lane.stages) {
    if (stage->effort.empty()) continue;
    const Block& effort = stage->effort[0];
    std::size_t next = 0;
    for (int i = 0; i < effort.rows(); ++i) {
      const double p = effort.at(i, 0);
      if (p == 0) continue;
      // Directions of a circle turn from step to step.
      if (lane.program.problem->circle_axis(i) >= 0) return false;
      const ClosedPoint point{i, p > 0};
      if (first)
        closed_.push_back(point);
      else if (next == closed_.size() || !(closed_[next++] == point))
        return false;
    }
    if (!first && next != closed_.size()) return false;
    first = false;
  }
  return true;
}

// Where the efforts of the stages stand.
void LaneFlight::connect(const FlownLane& lane) {
  for (const auto& stage : lane.stages) {
    std::vector<double*>& efforts = past_.emplace_back();
    for (Block& effort : stage->effort) efforts.push_back(effort.data());
    settles_after_ = std::max(settles_after_, static_cast<int>(stage->effort.size()));
  }
}

// The state of the lane and of its tangents, column by column.
void LaneFlight::gather(const FlownLane& lane) {
  const auto width = static_cast<std::size_t>(lane.program.width);
  if (width == 1) {
    column_slots_.assign(1, lane.slots.data());
    return;
  }
  const auto count = static_cast<std::size_t>(1 + lane.program.tangents), slots = lane.slots.size();
  const auto rows = static_cast<std::size_t>(lane.program.model->rows());
  columns_.resize(count * slots * rows);
  column_pointers_.resize(count * slots);
  column_slots_.resize(count);
  for (std::size_t c = 0; c < count; ++c) {
    for (std::size_t j = 0; j < slots; ++j) {
      double* const to = column_pointers_[c * slots + j] = columns_.data() + (c * slots + j) * rows;
      for (std::size_t i = 0; i < rows; ++i) to[i] = lane.slots[j][i * width + c];
    }
    column_slots_[c] = column_pointers_.data() + c * slots;
  }
}

void LaneFlight::scatter(const FlownLane& lane) const {
  const auto width = static_cast<std::size_t>(lane.program.width);
  if (width == 1) return;
  const auto rows = static_cast<std::size_t>(lane.program.model->rows());
  for (std::size_t c = 0; c < column_slots_.size(); ++c)
    for (std::size_t j = 0; j < lane.slots.size(); ++j)
      for (std::size_t i = 0; i < rows; ++i) lane.slots[j][i * width + c] = column_slots_[c][j][i];
}

long long LaneFlight::leave_out(const FlownLane& lane, const double* e, long long most, bool works,
                                StepInterval& told) {
  Flight& flight = *lane.program.flight;
  gather(lane);
  const long long k = flight.search(column_slots_, e, past_, most);
  clear_ = flight.clear();
  if (k == 0) return 0;
  told.steps = k;
  told.flight = &flight;
  told.works = flight.fly(k, column_slots_, past_, works);
  scatter(lane);
  told.closed = closed_;
  if (closed_.empty()) return k;
  for (const StageProgram& stage : lane.program.stages) told.instants += stage.closes_instant ? 1 : 0;
  told.penetration = flight.penetration();
  return k;
}

}  // namespace ricochet
