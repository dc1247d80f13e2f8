#include "runners/march/gap_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace ricochet {
namespace {

constexpr double no_gap = std::numeric_limits<double>::infinity();

// Between the stops of a point, m.
double gap_of(const Marcher& marcher, int point) {
  const LaneSpec& lane = marcher.program().lanes.front();
  const double gap = lane.upper[point] - lane.lower[point];
  return gap > 0 ? gap : no_gap;
}

int points_of(const Marcher& marcher) {
  return marcher.program().contact ? marcher.program().problem->points() : 0;
}

}  // namespace

GapWatch::GapWatch(const Marcher& marcher) : looked_at_(no_gap) {
  for (int j = 0; j < points_of(marcher); ++j) looked_at_ = std::min(looked_at_, gap_of(marcher, j));
}

void GapWatch::look(const Marcher& marcher, double penetration) {
  const MarchModel& model = *marcher.program().model;
  const double support = marcher.support(0, marcher.time());
  double most = 0;
  const LaneSpec& lane = marcher.program().lanes.front();
  for (int j = 0; j < points_of(marcher); ++j) {
    const double place = model.times(model.contact(), j, marcher.slot(0)) + support;
    most = std::max(most, std::max(lane.lower[j] - place, place - lane.upper[j]) / gap_of(marcher, j));
  }
  looked_at_ = penetration;
  if (!(most > 1)) return;
  if (times_ == 0) first_ = marcher.time();
  times_ = std::max(times_, most);
}

std::string GapWatch::passed() const {
  if (times_ == 0) return "";
  return fmt::format("a point passes its stop by more than the gap, up to {:.3g} times, first at t = {:.9g} s", times_,
                     first_);
}

std::string GapWatch::crossed(const Marcher& marcher, const ImpactRecorder& recorder) {
  const double h = marcher.program().h;
  constexpr double round_off = 1e-9;  // a point that a rigid law takes from stop to stop moves by the gap itself
  double most = 0;
  for (int j = 0; j < points_of(marcher); ++j)
    for (const StopSide side : {StopSide::lower, StopSide::upper})
      most = std::max(most, recorder.totals(0, j, side).fastest * h / gap_of(marcher, j));
  if (!(most >= 1 - round_off)) return "";
  const auto crosses = [&](const Impact& impact) {
    return impact.speed_in * h >= (1 - round_off) * gap_of(marcher, impact.point);
  };
  const auto first = std::find_if(recorder.impacts(0).begin(), recorder.impacts(0).end(), crosses);
  return fmt::format("a step of {:g} s takes a point further than the gap, {:.3g} times as far{}", h, most,
                     first == recorder.impacts(0).end() ? "" : fmt::format(", first at t = {:.9g} s", first->time));
}

}  // namespace ricochet
