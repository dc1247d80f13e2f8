#include <algorithm>
#include <ricochet/engine/marcher.hpp>
#include <ricochet/engine/stage_state.hpp>
#include <utility>

namespace ricochet {
namespace {

// Stage `place` counted from the first of a step, negative in the steps before: which one it is, and how many steps
// ago.
std::pair<std::ptrdiff_t, std::ptrdiff_t> place_in_steps(std::ptrdiff_t place, std::ptrdiff_t stages) {
  const std::ptrdiff_t steps = place >= 0 ? 0 : (stages - 1 - place) / stages;
  return {place + steps * stages, steps};
}

}  // namespace

// Which block holds p₋ₖ of each stage: stages follow each other without end, and each keeps as many of its own efforts
// as any stage looks back to.
void Marcher::connect_efforts() {
  const auto stages = static_cast<std::ptrdiff_t>(stage_states_.size());
  const auto weights = [&](std::ptrdiff_t i) {
    const StageProgram& stage = program_.stages[static_cast<std::size_t>(i)];
    return static_cast<std::ptrdiff_t>(std::max(stage.effort.size(), stage.work_effort.size()));
  };
  struct Source {
    StageState* stage;
    std::size_t ago;
  };
  const auto source = [&](std::ptrdiff_t i, std::ptrdiff_t k) {
    const auto [j, steps] = place_in_steps(i - k, stages);
    // A stage that comes later in the step holds its effort of the step before.
    return Source{stage_states_[static_cast<std::size_t>(j)].get(),
                  static_cast<std::size_t>(j > i ? steps - 1 : steps)};
  };
  for (std::ptrdiff_t i = 0; i < stages; ++i) {
    if (!stage_states_[static_cast<std::size_t>(i)]->delassus) continue;
    for (std::ptrdiff_t k = 1; k < weights(i); ++k) {
      const auto [stage, ago] = source(i, k);
      if (!stage->delassus) continue;
      while (stage->effort.size() <= ago) stage->effort.emplace_back(lower_.rows(), program_.width);
    }
  }
  for (std::ptrdiff_t i = 0; i < stages; ++i) {
    StageState& state = *stage_states_[static_cast<std::size_t>(i)];
    if (!state.delassus) continue;
    for (std::ptrdiff_t k = 0; k < weights(i); ++k) {
      const auto [stage, ago] = source(i, k);
      state.effort_pointers.push_back(stage->delassus ? stage->effort[ago].data() : nullptr);
    }
  }
  // Before the start rule there was nothing.
  for (std::size_t i = 0; i < start_states_.size(); ++i) {
    StageState& state = *start_states_[i];
    if (!state.delassus) continue;
    const std::size_t most = std::max(program_.start[i].effort.size(), program_.start[i].work_effort.size());
    for (std::size_t k = 0; k <= i && k < most; ++k) {
      const StageState& before = *start_states_[i - k];
      state.effort_pointers.push_back(before.delassus ? before.effort[0].data() : nullptr);
    }
  }
}

// The stages of the start rule stand where the last ones of the steps before the first would.
void Marcher::keep_start_efforts() {
  const auto before = static_cast<std::ptrdiff_t>(start_states_.size());
  for (std::ptrdiff_t i = 0; i < before; ++i) {
    const auto [j, steps] = place_in_steps(i - before, static_cast<std::ptrdiff_t>(stage_states_.size()));
    const auto ago = static_cast<std::size_t>(steps - 1);
    StageState &start = *start_states_[static_cast<std::size_t>(i)],
               &stage = *stage_states_[static_cast<std::size_t>(j)];
    if (!start.delassus || !stage.delassus || ago >= stage.effort.size()) continue;
    std::copy_n(start.effort[0].data(), start.effort[0].size(), stage.effort[ago].data());
    if (ago == 0) stage.contact_lanes = start.contact_lanes;
  }
}

}  // namespace ricochet
