#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <ricochet/engine/marcher.hpp>
#include <ricochet/engine/stage_friction.hpp>
#include <ricochet/engine/stage_state.hpp>
#include <ricochet/kernels/floating_point.hpp>

/// \file
/// Friction beside the contact law. In turn the law finds p with the efforts p_t of friction as they are, and the
/// friction law finds p_t with the bounds μ|p|,
///
///     measure = free + reach·W p + c W_nt p_t,     u = u° + c_n W_tn p + c_t W_tt p_t
///
/// until p_t stays. What a turn takes too much, a secant over two turns takes back.
namespace ricochet {
namespace {

constexpr double settled = 1e-13;     // change of p_t over the largest effort
constexpr double negligible = 1e-12;  // what p_t moves a measure by, over what its own effort does
constexpr double grains = 4 * std::numeric_limits<double>::epsilon();  // of a measure: sums of a few terms
constexpr int most_turns = 400;
constexpr int plain_every = 8;  // turns after which one is taken as it is

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

}  // namespace

double Tangent::effort(const double* efforts, std::ptrdiff_t stride) const {
  double squares = 0;
  for (int k = 0; k < count; ++k) squares += share[at(k)] * share[at(k)];
  return of(efforts, stride) / squares;
}

Tangent tangent_of(const RubbingPoint& one, int number, const std::array<double, 2>& normal) {
  if (!one.round) return {one.row + number, 1, {1, 0, 0}};
  if (number == 0) return {one.row, 3, {-normal[1], normal[0], 1}};
  return {one.row + 3, 2, {normal[0], normal[1], 0}};
}

StageFriction::StageFriction(const Program& program) {
  const SemiDiscrete& problem = *program.problem;
  const int T = program.width, count = static_cast<int>(problem.rubbing.size()), all = problem.rubbed.count();
  for (Block* block : {&normal, &sticks, &slid}) *block = Block(count, T);
  along = Block(2 * count, T);
  per_row = program.friction->memory_per_row();
  if (per_row > 0) kept = Block(all * per_row, T);
  for (auto* numbers : {&remembered, &remembers}) numbers->resize(at(all * per_row));
  residual.resize(at(T));
  turns.resize(at(T));
  for (const RubbingPoint& one : problem.rubbing)
    if (one.given.normal_force) always = (std::uint32_t{1} << program.lanes.size()) - 1;
  if (program.lanes.size() == 32) always = always != 0 ? ~std::uint32_t{0} : 0;
  tangents.reserve(at(all));
  kept_at.reserve(at(all));
  directions.resize(at(count));
  first_row.reserve(at(count) + 1);
  number.reserve(at(count));
  matrix.resize(at(all) * at(all));
  for (auto* numbers : {&free, &effort, &given, &found, &found_before, &off_before}) numbers->resize(at(all));
  for (auto* numbers : {&normals, &sliding, &held, &slides}) numbers->resize(at(count));
  holds.resize(at(count));
  measured.resize(at(problem.points()));
  moved.resize(at(problem.points()));
  rate.resize(at(problem.points()));
}

FrictionChange StageFriction::change() const {
  FrictionChange out;
  for (std::size_t row = 0; row < found.size(); ++row) {
    const double off = found[row] - given[row], change = off - off_before[row];
    out.most = std::max(out.most, std::abs(off));
    out.largest = std::max(out.largest, std::abs(found[row]));
    out.down += off * change;
    out.along += change * change;
  }
  for (std::size_t k = 0; k < number.size(); ++k) out.largest = std::max(out.largest, held[k]);
  return out;
}

void StageFriction::give(double back) {
  for (std::size_t row = 0; row < found.size(); ++row) {
    const double off = found[row] - given[row];
    given[row] = found[row] - back * (found[row] - found_before[row]);
    off_before[row] = off;
  }
}

void StageFriction::forget(int lane) {
  for (int i = 0; i < sticks.rows(); ++i) sticks.at(i, lane) = slid.at(i, lane) = normal.at(i, lane) = 0;
  for (int i = 0; i < kept.rows(); ++i) kept.at(i, lane) = 0;
}

void StageFriction::keep(int lane) {
  forget(lane);
  for (std::size_t a = 0; a < tangents.size(); ++a)
    for (int k = 0; k < per_row; ++k) kept.at(kept_at[a] * per_row + k, lane) = remembers[a * at(per_row) + at(k)];
  for (std::size_t k = 0; k < number.size(); ++k) {
    const int i = number[k];
    sticks.at(i, lane) = holds[k] != 0 ? 1 : 0;
    slid.at(i, lane) = slides[k];
    normal.at(i, lane) = normals[k];
    for (const int axis : {0, 1}) along.at(2 * i + axis, lane) = directions[k][at(axis)];
  }
}

// u° of all rows and lanes: that of the stage without its own efforts, against the surface.
void Marcher::measure_end_rates(const StageProgram& program, StageState& state, const double* z) {
  const EndRate& end = program.facts.end_rate;
  std::array<const double*, most_slots + 1> slots{};
  const int terms = static_cast<int>(state.end_rate_of.size());
  for (int k = 0; k < terms; ++k) {
    const std::size_t j = state.end_rate_of[at(k)];
    slots[at(k)] = j == at(slot_count()) ? z : slot_pointers_[j];
  }
  measure_rows(program_.model->rubbed(), terms, slots.data(), state.end_rate_weights.data(), nullptr,
               state.end_rate.data());
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

// |N| of a point that rubs, in the units of the stage's efforts of friction, and the direction of a round one.
Marcher::Pressed Marcher::pressed(const StageProgram& program, const StageState& state, int point, int lane) const {
  const RubbingPoint& one = program_.problem->rubbing[at(point)];
  if (const auto& force = program_.lanes[at(lane)].rubbing[at(point)].normal_force) return {*force, {}};
  const auto normal = [&](int row) {
    const std::size_t e = at(row) * at(program_.width) + at(lane);
    if (state.impulse) return state.effort[0].data()[e];
    double sum = 0;
    for (std::size_t k = 0; k < program.effort.size() && k < state.effort_pointers.size(); ++k)
      if (state.effort_pointers[k]) sum += program.effort[k] * state.effort_pointers[k][e];
    return sum / program.friction_weight;
  };
  if (!one.round) return {std::abs(normal(one.point)), {}};
  const double x = normal(one.point), y = normal(one.point + 1), size = std::hypot(x, y);
  if (!(size > 0)) return {};
  return {size, {-x / size, -y / size}};
}

// The points that something presses, and their tangents.
void Marcher::find_pressed(const StageProgram& program, const StageState& state, int lane) {
  StageFriction& rub = *rubbing_;
  rub.tangents.clear();
  rub.kept_at.clear();
  rub.number.clear();
  rub.first_row.assign(1, 0);
  const std::vector<RubbingPoint>& all = program_.problem->rubbing;
  for (int i = 0; i < static_cast<int>(all.size()); ++i) {
    const Pressed found = pressed(program, state, i, lane);
    if (!(found.force > 0)) continue;
    const std::size_t next = rub.number.size();
    const RubbingPoint& one = all[at(i)];
    const Rubbing& surface = program_.lanes[at(lane)].rubbing[at(i)];
    rub.normals[next] = found.force;
    rub.directions[next] = found.normal;
    rub.sliding[next] = surface.sliding * found.force;
    rub.held[next] = rub.sticks.at(i, lane) != 0 ? surface.held * found.force : rub.sliding[next];
    rub.number.push_back(i);
    for (int k = 0; k < one.tangents(); ++k) {
      rub.tangents.push_back(tangent_of(one, k, found.normal));
      rub.kept_at.push_back(one.row + k);
    }
    rub.first_row.push_back(static_cast<int>(rub.tangents.size()));
  }
}

// u° and A of these tangents, and what they begin with.
void Marcher::gather_friction(const StageProgram& program, StageState& state, int lane, bool first) {
  StageFriction& rub = *rubbing_;
  const int points = lower_.rows(), T = program_.width, count = static_cast<int>(rub.tangents.size());
  const double of_normal = program.friction_reach * (state.impulse ? 1.0 : program.effort[0]),
               of_own = program.friction_reach * (state.impulse ? 1.0 : program.friction_weight);
  DelassusColumns& W = columns_of(state);
  std::fill_n(rub.matrix.begin(), count * count, 0.0);
  for (int b = 0; b < count; ++b) {
    const Tangent& way = rub.tangents[at(b)];
    for (int l = 0; l < way.count; ++l) {
      if (way.share[at(l)] == 0) continue;
      const double *column = W.column(points + way.row + l), share = of_own * way.share[at(l)];
      for (int a = 0; a < count; ++a)
        rub.matrix[at(a * count + b)] += share * rub.tangents[at(a)].of(column + points + rub.tangents[at(a)].row);
    }
  }
  for (int a = 0; a < count; ++a) {
    const Tangent& way = rub.tangents[at(a)];
    rub.free[at(a)] = way.of(&state.end_rate.at(way.row, lane), T);
    rub.effort[at(a)] = first ? way.effort(&state.effort[0].at(points + way.row, lane), T)
                              : way.effort(rub.found_before.data() + way.row);
    for (int k = 0; k < rub.per_row; ++k)
      rub.remembered[at(a * rub.per_row + k)] = rub.kept.at(rub.kept_at[at(a)] * rub.per_row + k, lane);
  }
  for (int i = 0; i < points; ++i) {
    const double p = of_normal * state.effort[0].data()[i * T + lane];
    if (p == 0) continue;
    const double* column = W.column(i);
    for (int a = 0; a < count; ++a)
      rub.free[at(a)] += p * rub.tangents[at(a)].of(column + points + rub.tangents[at(a)].row);
  }
}

// p_t of a lane for the normal efforts as they are, into `found`.
LaneOutcome Marcher::find_friction(const StageProgram& program, StageState& state, int lane, bool first) {
  StageFriction& rub = *rubbing_;
  std::swap(rub.found, rub.found_before);
  std::fill(rub.found.begin(), rub.found.end(), 0.0);
  find_pressed(program, state, lane);
  if (rub.tangents.empty()) return {};
  gather_friction(program, state, lane, first);
  FrictionProblem problem;
  problem.points = static_cast<int>(rub.number.size());
  problem.first_row = rub.first_row.data();
  problem.matrix = rub.matrix.data();
  problem.stride = static_cast<int>(rub.tangents.size());
  problem.free = rub.free.data();
  problem.bound = rub.sliding.data();
  problem.bound_static = rub.held.data();
  problem.h = program.friction_momentum;
  problem.remembered = rub.remembered.data();
  problem.remembers = rub.remembers.data();
  problem.effort = rub.effort.data();
  problem.sticks = rub.holds.data();
  problem.slid = rub.slides.data();
  const LaneOutcome outcome = program_.friction->solve(problem);
  for (std::size_t a = 0; a < rub.tangents.size(); ++a)
    for (int k = 0; k < rub.tangents[a].count; ++k)
      rub.found[at(rub.tangents[a].row + k)] += rub.tangents[a].share[at(k)] * rub.effort[a];
  return outcome;
}

// What efforts of friction move the measures of all points by, over c.
void Marcher::moved_by_friction(StageState& state, const std::vector<double>& efforts) {
  std::vector<double>& moved = rubbing_->moved;
  std::fill(moved.begin(), moved.end(), 0.0);
  DelassusColumns& W = columns_of(state);
  for (std::size_t row = 0; row < efforts.size(); ++row) {
    if (efforts[row] == 0) continue;
    const double* column = W.column(lower_.rows() + static_cast<int>(row));
    for (std::size_t i = 0; i < moved.size(); ++i) moved[i] += efforts[row] * column[i];
  }
}

// Whether what was found moves what the law reads by more than round-off of what the normal efforts do.
bool Marcher::friction_moves_normals(StageState& state, double reach, int lane) {
  if (reach == 0) return false;
  moved_by_friction(state, rubbing_->found);
  DelassusColumns& W = columns_of(state);
  double own = 0, most = 0;
  for (int i = 0; i < lower_.rows(); ++i) {
    if (lower_.at(i, lane) == -infinity && upper_.at(i, lane) == infinity) continue;
    most = std::max(most, std::abs(rubbing_->moved[at(i)]));
    const double p = state.effort[0].at(i, lane);
    if (p != 0) own = std::max(own, std::abs(p * W.column(i)[i]));
  }
  return most > negligible * own;
}

namespace {

// By how much round-off of what the law reads moves a bound of friction, N.
double grain_of(const StageFriction& rub, const Program& program, int lane, DelassusColumns& W, double reach) {
  double most = 0;
  for (const int i : rub.number) {
    const RubbingPoint& one = program.problem->rubbing[at(i)];
    const Rubbing& surface = program.lanes[at(lane)].rubbing[at(i)];
    if (surface.normal_force || reach == 0) continue;
    const double own = std::abs(reach) * W.column(one.point)[one.point],
                 measured = std::hypot(rub.measured[at(one.point)], one.round ? rub.measured[at(one.point + 1)] : 0.0);
    if (own > 0) most = std::max(most, surface.largest() * measured / own);
  }
  return grains * most;
}

}  // namespace

void Marcher::rub_lane(const StageProgram& program, StageState& state, int lane) {
  StageFriction& rub = *rubbing_;
  const int points = lower_.rows(), T = program_.width;
  const double reach = state.impulse ? program.reach : program.measure_z * program.friction_weight;
  const double rate_reach = !program.compliance ? 0.0
                            : state.impulse     ? program.rate_reach
                                                : program.compliance->rate.z * program.friction_weight;
  for (int i = 0; i < points; ++i) {
    rub.measured[at(i)] = state.free.at(i, lane);
    if (state.rate.rows() > 0) rub.rate[at(i)] = state.rate.at(i, lane);
  }
  std::fill(rub.given.begin(), rub.given.end(), 0.0);
  LaneOutcome outcome;
  int turn = 0;
  double largest = 0, most = 0;
  while (true) {
    outcome = find_friction(program, state, lane, turn == 0);
    const FrictionChange change = rub.change();
    // Round-off of a measure says less of a soft law than of a rigid one: turns end where they gain nothing more.
    const bool gains = turn == 0 || change.most < 0.5 * most;
    most = change.most;
    largest = change.largest;
    if (!outcome.converged || most <= settled * largest) break;
    if (!gains && most <= grain_of(rub, program_, lane, columns_of(state), reach)) break;
    if (turn == 0 && !friction_moves_normals(state, std::max(std::abs(reach), std::abs(rate_reach)), lane)) {
      most = 0;
      break;
    }
    if (++turn > most_turns) break;
    rub.give(turn > 1 && turn % plain_every != 0 && change.along > 0 ? change.down / change.along : 0.0);
    moved_by_friction(state, rub.given);
    for (int i = 0; i < points; ++i) {
      const double moved = rub.moved[at(i)];
      state.free.at(i, lane) = rub.measured[at(i)] + reach * moved;
      if (state.rate.rows() > 0) state.rate.at(i, lane) = rub.rate[at(i)] + rate_reach * moved;
    }
    for (std::size_t k = 0; k < rub.memory.size() / at(T); ++k)
      memory_.data()[k * at(T) + at(lane)] = rub.memory[k * at(T) + at(lane)];
    const int one[] = {lane};
    solve_law(program, state, one);
    if (!outcome_[at(lane)].converged) break;
  }
  for (int i = 0; i < points; ++i) {
    state.free.at(i, lane) = rub.measured[at(i)];
    if (state.rate.rows() > 0) state.rate.at(i, lane) = rub.rate[at(i)];
  }
  rub.turns[at(lane)] = turn;
  rub.residual[at(lane)] = std::max(outcome.residual, largest > 0 ? most / largest : 0.0);
  rub.keep(lane);
  bool finite = true;
  for (std::size_t row = 0; row < rub.found.size(); ++row) {
    state.effort[0].at(points + static_cast<int>(row), lane) = rub.found[row];
    finite &= std::isfinite(rub.found[row]);
  }
  if (!outcome_[at(lane)].converged) return;
  if (!finite)
    freeze(lane, {.cause = EndCause::effort_not_finite});
  else if (!outcome.converged || turn > most_turns)
    freeze(lane, {.cause = EndCause::friction_not_found, .value = rub.residual[at(lane)], .count = turn});
}

double Marcher::stored_by_friction(int lane) const {
  if (!rubbing_ || rubbing_->per_row == 0) return 0;
  double numbers[most_friction_memory], sum = 0;
  for (int row = 0; row * rubbing_->per_row < rubbing_->kept.rows(); ++row) {
    for (int k = 0; k < rubbing_->per_row; ++k) numbers[k] = rubbing_->kept.at(row * rubbing_->per_row + k, lane);
    sum += program_.friction->stored(numbers);
  }
  return sum;
}

void Marcher::rub(const StageProgram& program, StageState& state, const double* z) {
  StageFriction& rub = *rubbing_;
  const int points = lower_.rows(), T = program_.width;
  std::uint32_t pressed = 0;
  if (program.friction_momentum != 0 && program.facts.end_rate.known())
    for (const int lane : touched_) {
      bool presses = ((rub.always >> lane) & 1u) != 0;
      for (int i = 0; i < points; ++i) presses |= state.effort[0].at(i, lane) != 0;
      for (std::size_t k = 1; k < program.effort.size() && k < state.effort_pointers.size(); ++k)
        for (int i = 0; i < points && state.effort_pointers[k]; ++i)
          presses |= state.effort_pointers[k][i * T + lane] != 0;
      pressed |= static_cast<std::uint32_t>(presses) << lane;
    }
  if (pressed != 0) measure_end_rates(program, state, z);
  for (const int lane : touched_) {
    if (!outcome_[at(lane)].converged) continue;
    if ((pressed >> lane) & 1u) {
      rub_lane(program, state, lane);
      continue;
    }
    rub.forget(lane);
    for (int row = points; row < state.effort[0].rows(); ++row) state.effort[0].at(row, lane) = 0;
    rub.residual[at(lane)] = rub.turns[at(lane)] = 0;
  }
}

}  // namespace ricochet
