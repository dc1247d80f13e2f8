#include <ricochet/measure/contact/stop_statistics.hpp>

namespace ricochet {

void PushTotals::add(const PushTotals& other) {
  impulse += other.impulse;
  squares += other.squares;
  contact_time += other.contact_time;
  peak = std::max(peak, other.peak);
  impacts += other.impacts;
}

StopStatistics::StopStatistics(const Marcher& marcher, const WindowParts& window)
    : window_(window),
      h_(marcher.program().h),
      stops_(marcher),
      places_(static_cast<std::size_t>(stops_.count()) * static_cast<std::size_t>(window.count)),
      pushes_(2 * places_.size()) {}

void StopStatistics::see(const Marcher& marcher) {
  seen_ = marcher.time();
  const int part = window_.of(seen_, 1e-6 * h_);
  if (part < 0) return;
  for (int stop = 0; stop < stops_.count(); ++stop) places_[at(stop, part)].add(stops_.displacement(marcher, stop));
}

void StopStatistics::instant(const ContactInstant& one) {
  const int part = window_.of(one.time, 1e-6 * h_);
  if (part < 0) return;
  PushTotals& totals = pushes_[2 * at(one.point, part) + static_cast<std::size_t>(one.side)];
  totals.impulse += one.given;
  totals.squares += one.given * one.force;
  totals.contact_time += one.lasts;
  totals.peak = std::max(totals.peak, one.force);
  totals.impacts += one.closes;
}

RunningMoments StopStatistics::displacement(int point) const {
  RunningMoments all;
  for (int part = 0; part < window_.count; ++part) all.add(displacement(point, part));
  return all;
}

PushTotals StopStatistics::pushed(int point, StopSide side) const {
  PushTotals all;
  for (int part = 0; part < window_.count; ++part) all.add(pushed(point, side, part));
  return all;
}

}  // namespace ricochet
