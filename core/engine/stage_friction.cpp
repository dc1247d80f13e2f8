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
  if (count == 1) return efforts[0];
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
  moves = !problem.rubbed_motions.empty() || !problem.motions.empty() || !problem.rubbed_speeds.isZero(0) ||
          (program.support && !problem.rubbed.on_support.isZero(0));
  if (program.lanes.size() == 32) always = always != 0 ? ~std::uint32_t{0} : 0;
  tangents.reserve(at(all));
  kept_at.reserve(at(all));
  directions.resize(at(count));
  first_row.reserve(at(count) + 1);
  first_row.assign(1, 0);
  number.reserve(at(count));
  matrix.resize(at(all) * at(all));
  for (auto* numbers : {&free, &effort, &given, &found, &found_before, &off_before}) numbers->resize(at(all));
  for (auto* numbers : {&normals, &sliding, &held, &slides}) numbers->resize(at(count));
  holds.resize(at(count));
  measured.resize(at(problem.points()));
  moved.resize(at(problem.points()));
  rate.resize(at(problem.points()));
}

void StageFriction::keep_first(std::size_t points) {
  number.resize(points);
  first_row.resize(points + 1);
  tangents.resize(at(first_row[points]));
  kept_at.resize(at(first_row[points]));
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
    const auto [x, y] = directions[k];
    along.at(2 * i, lane) = x;
    along.at(2 * i + 1, lane) = y;
  }
}

const double* Marcher::column_of(StageState& state, int row) const {
  const double*& column = state.columns[at(row)];
  if (column) return column;
  column = columns_of(state).column(row);
  const int points = lower_.rows();
  for (int i = 0; row >= points && i < points; ++i)
    state.couples[at(row - points)] = std::max(state.couples[at(row - points)], std::abs(column[i]));
  return column;
}

// The points that something presses, and their tangents: |N| in the units of the stage's efforts of friction, and of a
// round one the direction.
void Marcher::find_pressed(const StageProgram& program, const StageState& state, int lane) {
  StageFriction& rub = *rubbing_;
  const Rubbing* const surfaces = program_.lanes[at(lane)].rubbing.data();
  const double* const own = state.effort[0].data() + lane;
  const int T = program_.width;
  const std::size_t efforts = std::min(program.effort.size(), state.effort_pointers.size());
  const auto normal = [&](int row) {
    if (state.impulse) return own[row * T];
    double sum = 0;
    for (std::size_t k = 0; k < efforts; ++k)
      if (state.effort_pointers[k]) sum += program.effort[k] * state.effort_pointers[k][row * T + lane];
    return sum / program.friction_weight;
  };
  const std::vector<RubbingPoint>& all = program_.problem->rubbing;
  std::size_t next = 0;
  for (int i = 0; i < static_cast<int>(all.size()); ++i) {
    const RubbingPoint& one = all[at(i)];
    const Rubbing& surface = surfaces[i];
    double force = 0;
    std::array<double, 2> direction{};
    if (surface.normal_force) {
      force = *surface.normal_force;
    } else if (!one.round) {
      force = std::abs(normal(one.point));
    } else {
      const double x = normal(one.point), y = normal(one.point + 1);
      force = std::hypot(x, y);
      if (force > 0) direction = {-x / force, -y / force};
    }
    if (!(force > 0)) continue;
    rub.normals[next] = force;
    rub.directions[next] = direction;
    rub.sliding[next] = surface.sliding * force;
    rub.held[next] = rub.sticks.at(i, lane) != 0 ? surface.held * force : rub.sliding[next];
    // As often as not the same points are pressed as before.
    if (next < rub.number.size() && rub.number[next] == i && !one.round) {
      ++next;
      continue;
    }
    rub.keep_first(next++);
    rub.number.push_back(i);
    for (int k = 0; k < one.tangents(); ++k) {
      rub.tangents.push_back(tangent_of(one, k, direction));
      rub.kept_at.push_back(one.row + k);
    }
    rub.first_row.push_back(static_cast<int>(rub.tangents.size()));
  }
  if (next < rub.number.size()) rub.keep_first(next);
}

// u° and A of these tangents, and what they begin with.
void Marcher::gather_friction(const StageProgram& program, StageState& state, int lane, bool first) {
  StageFriction& rub = *rubbing_;
  const int points = lower_.rows(), T = program_.width, count = static_cast<int>(rub.tangents.size());
  const double of_normal = program.friction_reach * (state.impulse ? 1.0 : program.effort[0]),
               of_own = program.friction_reach * (state.impulse ? 1.0 : program.friction_weight);
  const Tangent* const ways = rub.tangents.data();
  // Adds what an effort of a column of W moves each tangent by.
  const auto add = [&](const double* column, double effort, double* to, std::ptrdiff_t stride) {
    for (int a = 0; a < count; ++a) to[a * stride] += effort * ways[a].of(column + points + ways[a].row);
  };
  std::fill_n(rub.matrix.begin(), count * count, 0.0);
  for (int b = 0; b < count; ++b)
    for (int l = 0; l < ways[b].count; ++l)
      if (const double share = ways[b].share[at(l)]; share != 0)
        add(column_of(state, points + ways[b].row + l), of_own * share, rub.matrix.data() + b, count);
  for (int a = 0; a < count; ++a) {
    const Tangent& way = ways[a];
    rub.free[at(a)] = way.of(&state.end_rate.at(way.row, lane), T);
    rub.effort[at(a)] = first ? way.effort(&state.effort[0].at(points + way.row, lane), T)
                              : way.effort(rub.found_before.data() + way.row);
    for (int k = 0; k < rub.per_row; ++k)
      rub.remembered[at(a * rub.per_row + k)] = rub.kept.at(rub.kept_at[at(a)] * rub.per_row + k, lane);
  }
  for (int i = 0; i < points; ++i)
    if (const double p = of_normal * state.effort[0].data()[i * T + lane]; p != 0)
      add(column_of(state, i), p, rub.free.data(), 1);
}

namespace {

// Points that slide now and rubbed the other way, or not at all, before: their rate was zero in between, and there the
// static bound holds. It is given to them. False where there are none.
bool hold_turned(StageFriction& rub, const Rubbing* surfaces, const double* before, int stride) {
  bool any = false;
  for (std::size_t k = 0; k < rub.number.size(); ++k) {
    const Rubbing& surface = surfaces[rub.number[k]];
    const double held = surface.held * rub.normals[k];
    if (rub.holds[k] != 0 || !(held > rub.held[k])) continue;
    double along = 0;
    for (int a = rub.first_row[k]; a < rub.first_row[k + 1]; ++a) {
      const Tangent& way = rub.tangents[at(a)];
      along += rub.effort[at(a)] * way.effort(before + static_cast<std::ptrdiff_t>(way.row) * stride, stride);
    }
    if (along > 0) continue;
    rub.held[k] = held;
    any = true;
  }
  return any;
}

}  // namespace

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
  LaneOutcome outcome = program_.friction->solve(problem);
  const double* const before = state.effort[0].data() + static_cast<std::ptrdiff_t>(lower_.rows()) * program_.width;
  if (outcome.converged && hold_turned(rub, program_.lanes[at(lane)].rubbing.data(), before + lane, program_.width))
    outcome = program_.friction->solve(problem);
  for (std::size_t a = 0; a < rub.tangents.size(); ++a)
    for (int k = 0; k < rub.tangents[a].count; ++k)
      rub.found[at(rub.tangents[a].row + k)] += rub.tangents[a].share[at(k)] * rub.effort[a];
  return outcome;
}

// What efforts of friction move the measures of all points by, over c.
void Marcher::moved_by_friction(StageState& state, const std::vector<double>& efforts) {
  std::vector<double>& moved = rubbing_->moved;
  std::fill(moved.begin(), moved.end(), 0.0);
  for (std::size_t row = 0; row < efforts.size(); ++row) {
    if (efforts[row] == 0) continue;
    const double* column = column_of(state, lower_.rows() + static_cast<int>(row));
    for (std::size_t i = 0; i < moved.size(); ++i) moved[i] += efforts[row] * column[i];
  }
}

// Whether what was found moves what the law reads by more than round-off of what the normal efforts do.
bool Marcher::friction_moves_normals(StageState& state, double reach, int lane) {
  if (reach == 0) return false;
  const std::vector<double>& found = rubbing_->found;
  double bound = 0, own = 0, most = 0;
  for (std::size_t row = 0; row < found.size(); ++row)
    if (found[row] != 0) bound += std::abs(found[row]) * state.couples[row];
  if (bound == 0) return false;
  const auto stands_free = [&](int i) { return lower_.at(i, lane) == -infinity && upper_.at(i, lane) == infinity; };
  for (int i = 0; i < lower_.rows(); ++i) {
    const double p = state.effort[0].at(i, lane);
    if (p != 0 && !stands_free(i)) own = std::max(own, std::abs(p * column_of(state, i)[i]));
  }
  if (bound <= negligible * own) return false;
  moved_by_friction(state, found);
  for (int i = 0; i < lower_.rows(); ++i)
    if (!stands_free(i)) most = std::max(most, std::abs(rubbing_->moved[at(i)]));
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
  const auto keep_measures = [&] {
    for (int i = 0; i < points; ++i) {
      rub.measured[at(i)] = state.free.at(i, lane);
      if (state.rate.rows() > 0) rub.rate[at(i)] = state.rate.at(i, lane);
    }
  };
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
    if (turn == 0) keep_measures();
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
  for (int i = 0; turn > 0 && i < points; ++i) {
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
