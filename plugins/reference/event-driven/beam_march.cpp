#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "beam_run.hpp"

/// \file
/// The search for the end of a phase.
namespace ricochet::event_driven {

std::variant<int, Refusal> BeamRun::march(ModalPhase& phase, std::array<Guard, 2>& guards, double tolerance) {
  if (out_.events.size() > settings_.events_per_period * (1 + state_.time / first_period_))
    return Refusal{fmt::format(
        "more than {:g} impacts and releases per period of the first mode by t = {:g} s: the tip chatters, which "
        "modal phases cannot follow; raise `events`, add damping, or use another reference",
        settings_.events_per_period, state_.time)};
  Look here = phase.look(state_);
  for (Guard& guard : guards) guard.look(state_.time, here.value);
  while (next_ < grid_.times.size()) {
    if (++looks_ > most_looks)
      return Refusal{fmt::format(
          "the search for events needs more than {:g} looks at the gap to reach t = {:g} s: shorten the duration, "
          "lower `modes`, or loosen `tolerance`",
          static_cast<double>(most_looks), grid_.times.back())};
    phase.forget_dead_modes(state_, 1e-30 * scale_);
    phase.measure(state_);
    if (guards[0].waits())
      while (phase.step(level_) > shortest_period_) ++level_;
    const int deepest = deepest_level(phase);
    for (;; ++level_, ++looks_) {
      ahead_ = state_;
      phase.move_by_level(ahead_, level_);
      const Look there = phase.look(ahead_);
      const double step = phase.step(level_), error = phase.interpolation_error(level_);
      const Cubic cubic{here.value, step * here.slope, there.value, step * there.slope};
      bool clear = true;
      for (const Guard& guard : guards) clear = clear && guard.least(cubic) - error > guard.threshold();
      if (!clear && error > tolerance && level_ < deepest) continue;
      if (!clear) {
        const int passed = first_passed(phase, guards, cubic, step, 2 * tolerance);
        if (passed >= 0) return passed;
      }
      here = there;
      break;
    }
    sample_until(phase, ahead_.time);
    std::swap(state_, ahead_);
    for (Guard& guard : guards) guard.look(state_.time, here.value);
    if (level_ > 0) --level_;
  }
  return -1;
}

int BeamRun::deepest_level(const ModalPhase& phase) const {
  const double least = 1e-14 * std::max(state_.time, first_period_);
  return std::clamp(static_cast<int>(std::log2(phase.step(0) / least)), level_, ModalPhase::levels - 1);
}

int BeamRun::first_passed(ModalPhase& phase, const std::array<Guard, 2>& guards, const Cubic& cubic, double step,
                          double tolerance) {
  int first = -1;
  double earliest = step;
  for (int i = 0; i < 2; ++i) {
    const Guard& guard = guards[static_cast<std::size_t>(i)];
    const auto beyond = guard.passed_by(cubic, tolerance);
    if (!beyond) continue;
    const double level = guard.threshold();
    const auto margin = [&](double tau) {
      const Look look = phase.look_at(state_, state_.time + tau);
      return std::pair{guard.margin(look.value) - level, guard.inside * look.slope};
    };
    const double tau = guard.margin(cubic.start) <= level ? 0 : falling_root(margin, 0, *beyond * step);
    if (first < 0 || tau < earliest) {
      first = i;
      earliest = tau;
    }
  }
  if (first >= 0) {
    sample_until(phase, state_.time + earliest);
    phase.move(state_, state_.time + earliest);
  }
  return first;
}

}  // namespace ricochet::event_driven
