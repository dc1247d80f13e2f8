#include <array>
#include <ricochet/engine/marcher.hpp>
#include <ricochet/engine/stage_friction.hpp>
#include <ricochet/engine/stage_state.hpp>

/// \file
/// How fast what rubs goes along the surfaces that it meets, and how they move.
namespace ricochet {

// u° of all rows and lanes: that of the stage without its own efforts, against the surface.
void Marcher::measure_end_rates(const StageProgram& program, StageState& state, const double* z) {
  const EndRate& end = program.facts.end_rate;
  std::array<const double*, most_slots + 1> slots{};
  const int terms = static_cast<int>(state.end_rate_of.size());
  const auto unknown = static_cast<std::size_t>(slot_count());
  for (std::size_t k = 0; k < state.end_rate_of.size(); ++k) {
    const std::size_t j = state.end_rate_of[k];
    slots[k] = j == unknown ? z : slot_pointers_[j];
  }
  measure_rows(program_.model->rubbed(), terms, slots.data(), state.end_rate_weights.data(), nullptr,
               state.end_rate.data());
  if (!rubbing_->moves) return;
  for (int row = 0; row < state.end_rate.rows(); ++row)
    for (int lane = 0; lane < lanes(); ++lane) {
      double& rate = state.end_rate.at(row, lane);
      for (const Level& level : end.speeds)
        rate += level.weight * rubbed_rate(lane, row, time() + level.at * program_.h);
      rate += rubbed_levels(lane, row, time(), end.places);
    }
}

double Marcher::rubbed_rate(int lane, int row, double t) const {
  const SemiDiscrete& problem = *program_.problem;
  double rate = -problem.rubbed_speeds[row];
  for (const SurfaceMotion& one : problem.rubbed_motions)
    if (one.row == row) rate -= one.share * one.history->rate(t);
  if (problem.rubbed.on_support[row] != 0 && program_.support)
    rate += problem.rubbed.on_support[row] * support_rate(lane, t);
  if (!motions().empty()) rate += motions().sum(problem.rubbed.on_motions.row(row), t, true);
  return rate;
}

double Marcher::rubbed_levels(int lane, int row, double t, const Levels& levels) const {
  const SemiDiscrete& problem = *program_.problem;
  double way = 0;
  if (problem.rubbed.on_support[row] != 0) way += problem.rubbed.on_support[row] * support_levels(lane, t, levels);
  for (const Level& level : levels) {
    const double later = level.at * program_.h;
    way -= level.weight * later * problem.rubbed_speeds[row];
    for (const SurfaceMotion& one : problem.rubbed_motions)
      if (one.row == row) way -= level.weight * one.share * (one.history->value(t + later) - one.history->value(t));
    if (!motions().empty()) way += level.weight * motions().sum(problem.rubbed.on_motions.row(row), t + later, false);
  }
  return way;
}

bool Marcher::surfaces_move() const {
  return rubbing_ && rubbing_->moves;
}

}  // namespace ricochet
