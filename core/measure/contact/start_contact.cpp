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
  const double lifted = marcher.support(lane, 0), rising = marcher.support_rate(lane, 0);
  for (int point = 0; point < program.problem->points(); ++point) {
    const double raised = marcher.motions().point_rate(point, 0);
    double place = lifted + marcher.motions().point(point, 0), speed = rising + raised,
           terms = std::abs(rising) + std::abs(raised);
    for (SparseRows::InnerIterator entry(contact, point); entry; ++entry) {
      place += entry.value() * spec.position[entry.col()];
      speed += entry.value() * spec.velocity[entry.col()];
      terms += std::abs(entry.value() * spec.velocity[entry.col()]);
    }
    for (const int side : {1, -1}) {
      const Held one{.point = point, .side = side, .place = place};
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
  const double stop = held.side > 0 ? spec.lower[held.point] + layer : spec.upper[held.point] - layer;
  return {held.side * (place - stop), round_off_of_sums * (std::abs(place) + std::abs(stop))};
}

void StartContact::read(const Marcher& marcher, const double* const* slots, double t) {
  const Program& program = marcher.program();
  const LaneSpec& spec = program.lanes[static_cast<std::size_t>(lane_)];
  const RowMatrix& rows = program.model->contact();
  const double lifted = marcher.support(lane_, t);
  const auto width = static_cast<std::size_t>(marcher.width());
  std::erase_if(held_, [&](Held& held) {
    double place = lifted + marcher.motions().point(held.point, t);
    const auto point = static_cast<std::size_t>(held.point);
    for (int e = rows.start[point]; e < rows.start[point + 1]; ++e)
      place += rows.value[static_cast<std::size_t>(e)] *
               slots[0][static_cast<std::size_t>(rows.index[static_cast<std::size_t>(e)]) * width +
                        static_cast<std::size_t>(lane_)];
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
