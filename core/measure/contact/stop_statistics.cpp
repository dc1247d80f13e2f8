#include <algorithm>
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
  const double slack = 1e-6 * h_, begins = one.time - one.lasts;
  const auto totals = [&](int part) -> PushTotals& {
    return pushes_[2 * at(one.point, part) + static_cast<std::size_t>(one.side)];
  };
  const auto add = [&](int part, double share) {
    PushTotals& of = totals(part);
    of.impulse += share * one.given;
    of.squares += share * one.given * one.force;
    of.contact_time += share * one.lasts;
    of.peak = std::max(of.peak, one.force);
  };
  const int part = window_.of(one.time, slack);
  if (part >= 0) totals(part).impacts += one.closes;
  if (part >= 0 && begins >= window_.begin(part) - slack) return add(part, 1);
  if (one.time <= window_.from || begins >= window_.to) return;
  // It began before a part does, or ends after the window.
  for (int k = 0; k < window_.count; ++k) {
    const double inside = std::min(one.time, window_.begin(k + 1)) - std::max(begins, window_.begin(k));
    if (inside > 0) add(k, inside / one.lasts);
  }
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

void ShockTotals::add(const Shock& shock) {
  ++shocks;
  rebounds += shock.rebounds;
  lasted += shock.duration;
  pushed += shock.pushed;
  peaks.add(shock.peak);
}

void ShockTotals::add(const ShockTotals& other) {
  shocks += other.shocks;
  rebounds += other.rebounds;
  lasted += other.lasted;
  pushed += other.pushed;
  peaks.add(other.peaks);
}

ShockRecorder::ShockRecorder(int points, const ShockRule& rule, const WindowParts& window, std::size_t most)
    : rule_(rule),
      window_(window),
      most_(most),
      sides_(2 * static_cast<std::size_t>(points)),
      peaks_(static_cast<std::size_t>(points),
             CountedValues(most / static_cast<std::size_t>(std::max(points, 1)) + 1)) {
  for (Side& side : sides_) side.parts.resize(static_cast<std::size_t>(window.count));
}

void ShockRecorder::instant(const ContactInstant& one) {
  Side& side = sides_[place(one.point, one.side)];
  const bool joins = !one.closes && side.above;
  side.above = one.force > rule_.force_above;
  if (!side.above) {
    side.below += one.given;
    return;
  }
  if (!joins) {
    if (side.going && one.time - side.last >= rule_.rest) close(side, false);
    if (!side.going) {
      side.now = {.point = one.point, .side = one.side, .begin = one.time, .speed_in = one.speed_in};
      side.below = 0;
      side.going = true;
    }
    ++side.now.rebounds;
  }
  side.now.impulse += one.given + side.below;
  side.below = 0;
  side.now.pushed += one.lasts;
  side.last = one.time + one.lasts;
  side.now.duration = side.last - side.now.begin;
  if (one.force > side.now.peak) {
    side.now.peak = one.force;
    side.now.peak_at = one.time;
  }
}

void ShockRecorder::close(Side& side, bool open_end) {
  side.now.open_end = open_end;
  side.going = false;
  ++count_;
  if (side.now.begin >= window_.from && side.now.begin <= window_.to) {
    side.totals.add(side.now);
    const int part = static_cast<int>((side.now.begin - window_.from) / window_.length());
    side.parts[static_cast<std::size_t>(std::min(part, window_.count - 1))].add(side.now);
    peaks_[static_cast<std::size_t>(side.now.point)].add(side.now.peak);
  }
  if (shocks_.size() < most_) shocks_.push_back(side.now);
}

void ShockRecorder::finish(double time, double h) {
  for (Side& side : sides_)
    if (side.going) close(side, side.above && side.last > time - h);
}

}  // namespace ricochet
