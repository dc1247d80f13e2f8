#include <algorithm>
#include <cmath>
#include <ricochet/measure/contact/start_contact.hpp>

namespace ricochet {
namespace {

// Of places and speeds, relative to the numbers that they are sums of.
constexpr double round_off_of_sums = 1e-12;
// Of what a point moves by in a step.
constexpr double round_off_of_steps = 1e-6;
// Steps away from its stop that no round-off makes.
constexpr double well_away = 10;

}  // namespace

StartContact::StartContact(const Marcher& marcher, int lane) : lane_(lane) {
  const Program& program = marcher.program();
  if (!program.contact || marcher.step() > 0) return;
  const SparseRows& contact = program.problem->contact;
  const LaneSpec& spec = program.lanes[static_cast<std::size_t>(lane)];
  for (int point = 0; point < program.problem->points(); ++point)
    layers_.push_back(marcher.law().layer(program.law_set(point, lane)));
  const SemiDiscrete& problem = *program.problem;
  const double lifted = marcher.support(lane, 0), rising = marcher.support_rate(lane, 0);
  for (int point = 0; point < problem.points(); ++point) {
    const int axis = problem.circle_axis(point);
    if (axis == 1) continue;
    const auto row = [&](int j) {
      double place = lifted + marcher.motions().point(j, 0);
      for (SparseRows::InnerIterator entry(contact, j); entry; ++entry)
        place += entry.value() * spec.position[entry.col()];
      return place;
    };
    double terms = 0;
    const auto rate = [&](int j) {
      const double raised = marcher.motions().point_rate(j, 0);
      double speed = rising + raised;
      terms += std::abs(rising) + std::abs(raised);
      for (SparseRows::InnerIterator entry(contact, j); entry; ++entry) {
        speed += entry.value() * spec.velocity[entry.col()];
        terms += std::abs(entry.value() * spec.velocity[entry.col()]);
      }
      return speed;
    };
    const double place = place_of(problem, spec, point, row);
    double speed = rate(point);
    if (axis == 0) speed = marcher.circle(lane, point).outwards(row(point), row(point + 1), speed, rate(point + 1));
    for (const int side : {1, -1}) {
      if (axis == 0 && side > 0) continue;
      const Held one{.point = point, .side = side, .circle = axis == 0, .place = place};
      const Gap gap = this->gap(spec, one, place);
      if (!(gap.value <= gap.round_off)) continue;
      const bool beyond = gap.value < -gap.round_off, still = -side * speed <= round_off_of_sums * terms;
      if (beyond || still) held_.push_back(one);
    }
  }
}

bool StartContact::Held::left() const {
  return away > round_off + round_off_of_steps * moved;
}

StartContact::Gap StartContact::gap(const LaneSpec& spec, const Held& held, double place) const {
  const double layer = layers_[static_cast<std::size_t>(held.point)];
  double stop = held.side > 0 ? spec.lower[held.point] + layer : spec.upper[held.point] - layer;
  if (held.circle) stop = StopCircle::of(spec.lower, spec.upper, held.point).radius - layer;
  return {held.side * (place - stop), round_off_of_sums * (std::abs(place) + std::abs(stop))};
}

void StartContact::read(const Marcher& marcher, const double* const* slots, double t) {
  const Program& program = marcher.program();
  const LaneSpec& spec = program.lanes[static_cast<std::size_t>(lane_)];
  const RowMatrix& rows = program.model->contact();
  const double lifted = marcher.support(lane_, t);
  const auto width = static_cast<std::size_t>(marcher.width());
  std::erase_if(held_, [&](Held& held) {
    const double place = place_of(*program.problem, spec, held.point, [&](int j) {
      double sum = lifted + marcher.motions().point(j, t);
      const auto point = static_cast<std::size_t>(j);
      for (int e = rows.start[point]; e < rows.start[point + 1]; ++e)
        sum += rows.value[static_cast<std::size_t>(e)] *
               slots[0][static_cast<std::size_t>(rows.index[static_cast<std::size_t>(e)]) * width +
                        static_cast<std::size_t>(lane_)];
      return sum;
    });
    const Gap gap = this->gap(spec, held, place);
    held.round_off = gap.round_off;
    held.away = std::max(held.away, gap.value);
    held.moved = std::max(held.moved, std::abs(place - held.place));
    held.place = place;
    return held.away > gap.round_off + well_away * held.moved;
  });
}

bool StartContact::holds(int point, int side) const {
  return std::any_of(held_.begin(), held_.end(),
                     [&](const Held& one) { return one.point == point && one.side == side && !one.left(); });
}

bool StartContact::take(int point, int side) {
  const bool held = holds(point, side);
  if (!held) std::erase_if(held_, [&](const Held& one) { return one.point == point; });
  return held;
}

}  // namespace ricochet
