#include <algorithm>
#include <ricochet/engine/marcher.hpp>
#include <ricochet/engine/stage_state.hpp>
#include <ricochet/scene/massless_part.hpp>
#include <utility>

namespace ricochet {

std::pair<int, std::size_t> place_in_steps(std::ptrdiff_t place, std::ptrdiff_t stages) {
  const std::ptrdiff_t steps = place >= 0 ? 0 : (stages - 1 - place) / stages;
  return {static_cast<int>(place + steps * stages), static_cast<std::size_t>(steps)};
}

// Which block holds p₋ₖ of each stage. Stages follow each other without end. Each keeps as many of its own efforts as
// any stage looks back to.
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
    return Source{stage_states_[static_cast<std::size_t>(j)].get(), j > i ? steps - 1 : steps};
  };
  for (std::ptrdiff_t i = 0; i < stages; ++i) {
    if (!stage_states_[static_cast<std::size_t>(i)]->delassus) continue;
    for (std::ptrdiff_t k = 1; k < weights(i); ++k) {
      const auto [stage, ago] = source(i, k);
      if (!stage->delassus) continue;
      while (stage->effort.size() <= ago) stage->effort.emplace_back(stage->effort[0].rows(), program_.width);
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

// A start beyond a stop is pushed from its first step as from any other. Where a plan weights efforts of steps before,
// those before t = 0 are the force of a compliant law in the initial state, at rest. A law that keeps a memory has seen
// that state. Rigid laws have no force there.
void Marcher::begin_contact() {
  if (!program_.contact || !program_.law->reads() || step_ != 0) return;
  const int points = lower_.rows(), T = program_.width;
  Block place(points, T), rate(points, T);
  const SparseRows& measured = program_.problem->measured();
  for (int lane = 0; lane < lanes(); ++lane) {
    const LaneSpec& spec = program_.lanes[static_cast<std::size_t>(lane)];
    for (int i = 0; i < points; ++i) {
      double at = lift(lane, i, 0), speed = lift_rate(lane, i, 0);
      for (SparseRows::InnerIterator entry(measured, i); entry; ++entry) {
        at += entry.value() * spec.position[entry.col()];
        speed += entry.value() * spec.velocity[entry.col()];
      }
      place.at(i, lane) = at;
      rate.at(i, lane) = speed;
    }
  }
  const std::uint32_t beyond = kernels_.outside(points, place.data(), lower_.data(), upper_.data());
  if (beyond == 0) return;
  StandingPoints standing{points, T, place.data(), law_lower().data(), law_upper().data(), program_.problem->circles()};
  const std::vector<double> force = standing_force(*program_.law, standing);
  if (memory_.rows() > 0) {
    standing.rate = rate.data();
    standing.memory = memory_.data();
    standing_force(*program_.law, standing);
  }
  for (int lane = 0; lane < lanes(); ++lane) {
    if (((beyond >> lane) & 1U) == 0) continue;
    for (const auto& state : stage_states_) {
      if (!state->delassus || state->effort_pointers.size() < 2) continue;
      for (Block& effort : state->effort)
        for (int i = 0; i < points; ++i) effort.at(i, lane) = force[static_cast<std::size_t>(i * T + lane)];
      state->contact_lanes |= 1U << lane;
    }
  }
}

// The stages of the start rule stand where the last ones of the steps before the first would.
void Marcher::keep_start_efforts() {
  const auto before = static_cast<std::ptrdiff_t>(start_states_.size());
  for (std::ptrdiff_t i = 0; i < before; ++i) {
    const auto [j, steps] = place_in_steps(i - before, static_cast<std::ptrdiff_t>(stage_states_.size()));
    const std::size_t ago = steps - 1;
    StageState &start = *start_states_[static_cast<std::size_t>(i)],
               &stage = *stage_states_[static_cast<std::size_t>(j)];
    if (!start.delassus || !stage.delassus || ago >= stage.effort.size()) continue;
    std::copy_n(start.effort[0].data(), start.effort[0].size(), stage.effort[ago].data());
    if (ago == 0) stage.contact_lanes = start.contact_lanes;
  }
}

// Which stage's work each gives back.
void Marcher::connect_works() {
  for (std::size_t k = 0; k < program_.stages.size(); ++k)
    if (const int before = program_.stages[k].restores; before > 0)
      stage_states_[k]->restored = stage_states_[k - static_cast<std::size_t>(before)].get();
}

// Which operators measure what the law reads: positions that no effort has moved yet. The free step has no load added
// apart, and nothing moves by histories. No lane flies, as a flight of one lane sums modes in another order.
void Marcher::connect_tests() {
  if (program_.load || program_.flight || !motions().empty() || slot_count() != 2) return;
  const auto connect = [&](StageProgram& program, StageState& state) {
    if (!state.delassus || !program.driven || program.gate || state.restored || program.effort.size() > 1) return;
    if (state.rate.rows() > 0 || state.before.rows() > 0) return;
    if (!program.op->takes_points(program_.model->measured().view(), state.measure_weights.data())) return;
    PointTest& test = state.test.emplace();
    test.x = slot_pointers_.data();
    std::copy_n(state.measure_weights.begin(), 3, test.weight);
    test.offset = offset_.data();
    test.lower = lower_.data();
    test.upper = upper_.data();
    test.y = state.free.data();
  };
  for (std::size_t k = 0; k < start_states_.size(); ++k) connect(program_.start[k], *start_states_[k]);
  for (std::size_t k = 0; k < stage_states_.size(); ++k) connect(program_.stages[k], *stage_states_[k]);
}

}  // namespace ricochet
