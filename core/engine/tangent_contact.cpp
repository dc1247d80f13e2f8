#include <algorithm>
#include <array>
#include <cmath>
#include <ricochet/engine/marcher.hpp>
#include <ricochet/engine/stage_state.hpp>

namespace ricochet {
namespace {

// An answer this small against what moves the point is none: I/κ then leaves only what is known, to round-off.
constexpr double least_answer = 1e-17;

// How the force of a circle answers: by D along n, by N/ρ along t.
struct RoundSlopes {
  std::array<double, 2> n{};
  double along = 0, across = 0;
  // a n nᵀ + b t tᵀ
  double entry(int i, int j, double a, double b) const {
    const std::array<double, 2> t = {-n[1], n[0]};
    const auto k = static_cast<std::size_t>(i), l = static_cast<std::size_t>(j);
    return a * n[k] * n[l] + b * t[k] * t[l];
  }
};

}  // namespace

void Marcher::delay_tangents(const std::vector<bool>& points, int steps) {
  delayed_points_ = points;
  delay_steps_ = steps;
  for (auto& state : stage_states_)
    if (state->delassus) state->contact_age.assign(points.size() * static_cast<std::size_t>(program_.width), 0);
}

// Loads move an orbit, not its derivative.
void Marcher::remove_load(StageProgram& program, const double* load) {
  double* z = program.op->unknown();
  program.op->solve_column(load, scratch_.data());
  const auto width = static_cast<std::size_t>(program_.width);
  for (int i = 0; i < program_.model->rows(); ++i)
    for (std::size_t column = static_cast<std::size_t>(lanes()); column < width; ++column)
      z[static_cast<std::size_t>(i) * width + column] -= scratch_[static_cast<std::size_t>(i)];
}

// Right-hand sides of the efforts below. With a rigid law the derivative of each active measure has a target, from
// which the free measure is subtracted. The target is zero where a bound holds, the rebound's share of the approach
// where a gate does.
void Marcher::tangent_targets(const StageProgram& program, StageState& state, int lane, int tangent) {
  ActiveSystem& system = state.tangents;
  for (std::size_t a = 0; a < system.points.size(); ++a) {
    const int i = system.points[a];
    double target = 0;
    if (program.compliance && circles_.holds(i)) {
      // Where I/κ stands on the left, it divides K too.
      const std::size_t other = circles_.first(i) ? a + 1 : a - 1;
      const double u = state.free.at(i, tangent), across = state.free.at(system.points[other], tangent);
      system.right[a] = -(system.round[2 * a] * u + system.round[2 * a + 1] * across);
      continue;
    }
    if (program.compliance) {
      const ContactSlopes slopes = program_.law->slopes(i, lane);
      double push = slopes.stiffness * state.free.at(i, tangent);
      if (state.rate.rows() > 0) push += slopes.viscosity * state.rate.at(i, tangent);
      if (state.before.rows() > 0) push += slopes.before * state.before.at(i, tangent);
      system.right[a] = -push / system.slopes[a];
      continue;
    }
    if (program.gate) {
      const double speed = state.approach.at(i, lane), still = 1e-10 * state.fastest.at(0, lane);
      const bool lower = state.effort[0].at(i, lane) > 0;
      const bool leaves = lower ? speed > still : speed < -still;
      const bool comes = lower ? speed < 0 : speed > 0;
      const double slope = leaves ? -1.0 : (comes ? -state.rebound[static_cast<std::size_t>(i)] : 0.0);
      target = slope * state.approach.at(i, tangent);
    }
    system.right[a] = target - state.free.at(i, tangent);
  }
}

// Circles that push: the answer of their force, 2 × 2, in the place of I/κ, and what the right-hand side takes of K.
void Marcher::add_round_slopes(DelassusColumns& columns, double base, StageState& state, int lane) {
  ActiveSystem& system = state.tangents;
  for (std::size_t a = 0; a + 1 < system.points.size(); ++a) {
    const int first = system.points[a];
    if (!circles_.holds(first) || !circles_.first(first)) continue;
    const double *one = columns.column(first), *other = columns.column(first + 1);
    double push[2], u[2];
    for (const int axis : {0, 1}) {
      push[axis] = state.effort[0].at(first + axis, lane);
      u[axis] = state.free.at(first + axis, lane);
      for (const int j : system.points) u[axis] += base * columns.column(j)[first + axis] * state.effort[0].at(j, lane);
    }
    const double N = std::hypot(push[0], push[1]), rho = circle(lane, first).distance(u[0], u[1]);
    RoundSlopes round{{-push[0] / N, -push[1] / N}, program_.law->slopes(first, lane).stiffness, N / rho};
    const double mobility = base * std::max(one[first], other[first + 1]);
    const double along = base > 0 ? std::max(round.along, least_answer / mobility) : 1.0,
                 across = base > 0 ? std::max(round.across, least_answer / mobility) : 1.0;
    for (const int i : {0, 1})
      for (const int j : {0, 1}) {
        system.at(a + static_cast<std::size_t>(i), a + static_cast<std::size_t>(j)) +=
            round.entry(i, j, 1 / along, 1 / across);
        const std::size_t at = 2 * (a + static_cast<std::size_t>(i)) + (i == j ? 0 : 1);
        system.round[at] = round.entry(i, j, round.along / along, round.across / across);
      }
  }
}

// What columns read at the points of the system, where it has been measured of the lane alone.
void Marcher::measure_tangents(StageState& state, const double* z) {
  std::array<const double*, most_slots + 1> slots{};
  std::copy(slot_pointers_.begin(), slot_pointers_.end(), slots.begin());
  slots[static_cast<std::size_t>(slot_count())] = z;
  const RowMatrix& rows = program_.model->measured();
  const auto measure = [&](const std::vector<double>& weights, Block& out) {
    if (out.rows() == 0) return;
    for (const int i : state.tangents.points) {
      const double known = out.at(i, 0);
      kernels_.measure({1, rows.start.data() + i, rows.index.data(), rows.value.data()}, slot_count() + 1, slots.data(),
                       weights.data(), nullptr, out.row(i));
      out.at(i, 0) = known;
    }
  };
  measure(state.measure_weights, state.free);
  measure(state.rate_weights, state.rate);
  measure(state.before_weights, state.before);
  measure(state.approach_weights, state.approach);
}

// Derivatives of the efforts of every lane that was looked at: with the active set A of the lane,
//     rigid:      base·W_AA δp = target − δy°
//     compliant:  (base·W_AA + I/κ) δp = −(D δg° + D_u δu° + D₋ δg⁻)/κ,    κ = (D η + D_u η_u)/base
//
// where base is η, or η_u where the effort moves the rate alone; where it moves neither, δp = −(…), and κ is 1. Of a
// circle D is the matrix D nnᵀ + (N/ρ) ttᵀ between both of its points.
void Marcher::tangent_contact(StageProgram& program, StageState& state, const double* z) {
  ActiveSystem& system = state.tangents;
  const double reach = program.reach, rate_reach = state.rate.rows() > 0 ? program.rate_reach : 0.0;
  DelassusColumns* columns = state.delassus.get();
  if (state.impulse) columns = state.impulse.get();
  for (const int lane : touched_) {
    const bool active = (state.contact_lanes >> lane) & 1u;
    for (int k = 0; k < program_.tangents; ++k)
      for (int i = 0; i < state.free.rows(); ++i) state.effort[0].at(i, tangent_lane(lane, k)) = 0;
    const auto width = static_cast<std::size_t>(program_.width);
    const auto age = [&](int i) -> int& {
      return state.contact_age[static_cast<std::size_t>(i) * width + static_cast<std::size_t>(lane)];
    };
    system.points.clear();
    for (int i = 0; i < state.free.rows(); ++i) {
      bool closed = active && state.effort[0].at(i, lane) != 0;
      if (active && circles_.holds(i))
        closed = closed || state.effort[0].at(circles_.first(i) ? i + 1 : i - 1, lane) != 0;
      if (delay_steps_ > 0) age(i) = closed ? age(i) + 1 : 0;
      const bool waits = delay_steps_ > 0 && delayed_points_[static_cast<std::size_t>(i)] && age(i) <= delay_steps_;
      if (closed && !waits) system.points.push_back(i);
    }
    if (system.points.empty()) continue;
    if (program_.flight) measure_tangents(state, z);
    const double base = reach != 0 || !program.compliance ? reach : rate_reach;
    for (std::size_t a = 0; a < system.points.size(); ++a) {
      double compliance = 0;
      const double* column = base != 0 ? columns->column(system.points[a]) : nullptr;
      if (program.compliance && !circles_.holds(system.points[a])) {
        const double mobility = column ? base * column[system.points[a]] : 0.0;
        const ContactSlopes slopes = program_.law->slopes(system.points[a], lane);
        double& stiffness = system.slopes[a];
        stiffness = 1;
        if (mobility > 0)
          stiffness =
              std::max((slopes.stiffness * reach + slopes.viscosity * rate_reach) / base, least_answer / mobility);
        compliance = 1 / stiffness;
      }
      for (std::size_t b = 0; b < system.points.size(); ++b)
        system.at(b, a) = (column ? base * column[system.points[b]] : 0.0) + (a == b ? compliance : 0.0);
    }
    if (program.compliance && circles_.any()) add_round_slopes(*columns, base, state, lane);
    system.factorise();
    for (int k = 0; k < program_.tangents; ++k) {
      const int tangent = tangent_lane(lane, k);
      tangent_targets(program, state, lane, tangent);
      system.solve();
      for (std::size_t a = 0; a < system.points.size(); ++a)
        state.effort[0].at(system.points[a], tangent) = system.right[a];
    }
  }
}

}  // namespace ricochet
