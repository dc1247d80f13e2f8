#include <algorithm>
#include <cmath>
#include <ricochet/measure/contact/stop_contacts.hpp>
#include <utility>

namespace ricochet {

StopContacts::StopContacts(const Marcher& marcher, ImpactRecorder& recorder)
    : recorder_(recorder), list_(stop_list(*marcher.program().problem)) {
  const SemiDiscrete& problem = *marcher.program().problem;
  own_.assign(static_cast<std::size_t>(list_.count()), nowhere);
  round_of_.assign(own_.size(), -1);
  for (int stop = 0; stop < list_.count(); ++stop) {
    if (!list_.round(stop)) continue;
    const Clearance& clearance =
        problem.clearances[static_cast<std::size_t>(list_.clearance[static_cast<std::size_t>(stop)])];
    if (clearance.circle) continue;
    round_of_[static_cast<std::size_t>(stop)] = static_cast<int>(rounds_.size());
    Round& round = rounds_.emplace_back();
    round.stop = stop;
    round.first = clearance.first;
    for (const double angle : clearance.angles) round.normals.push_back(side_direction(angle));
    round.shares.reserve(round.normals.size());
    round.leaves.reserve(round.normals.size());
  }
  if (merges()) recorder_.tell(this);
}

void StopContacts::tell(ContactListener* listener) {
  if (merges())
    listeners_.push_back(listener);
  else
    recorder_.tell(listener);
}

void StopContacts::instant(const ContactInstant& one) {
  const int stop = list_.stop_of[static_cast<std::size_t>(one.point)];
  const int polygon = round_of_[static_cast<std::size_t>(stop)];
  if (polygon < 0) {
    std::size_t& row = own_[static_cast<std::size_t>(stop)];
    if (one.closes) {
      ++count_;
      row = nowhere;
    }
    if (one.closes && one.impact != nowhere) {
      row = impacts_.size();
      impacts_.push_back(recorder_.impacts(0)[one.impact]);
      impacts_.back().point = stop;
      leaves_.push_back({{one.impact, 1}});
    }
    ContactInstant told = one;
    told.point = stop;
    told.impact = row;
    add(told, list_.round(stop) ? -told.normal[0] : told.side == StopSide::lower ? 1 : -1);
    return;
  }
  Round& round = rounds_[static_cast<std::size_t>(polygon)];
  const std::array<double, 2>& normal = round.normals[static_cast<std::size_t>(one.point - round.first)];
  const double outwards = one.side == StopSide::upper ? 1 : -1;
  for (const std::size_t axis : {0, 1}) {
    const double direction = outwards * normal[axis];
    round.given[axis] += one.given * direction;
    if (!round.pushed) round.direction[axis] = direction;
  }
  round.pushed = true;
  round.closes = round.closes && one.closes;
  round.lasts = std::max(round.lasts, one.lasts);
  round.came += one.given * one.speed_in;
  round.shares.push_back({one.impact, one.given});
}

void StopContacts::over(double time) {
  for (Round& round : rounds_) end_instant(round, time);
  force_ = std::exchange(pressed_, 0.0);
  upwards_ = std::exchange(pushed_upwards_, 0.0);
}

void StopContacts::begin_impact(Round& round, double time) {
  StopTotals& totals = round.totals;
  totals.fastest = totals.impacts == 0 ? round.speed_in : std::max(totals.fastest, round.speed_in);
  ++totals.impacts;
  ++count_;
  round.row = impacts_.size();
  if (round.row >= ImpactRecorder::most_impacts) {
    round.row = nowhere;
    return;
  }
  Impact impact;
  impact.time = time;
  impact.point = round.stop;
  impact.side = StopSide::upper;
  impact.speed_in = round.speed_in;
  impacts_.push_back(impact);
  leaves_.emplace_back();
}

void StopContacts::end_instant(Round& round, double time) {
  if (!round.pushed) {
    if (round.closed && round.row != nowhere) {
      impacts_[round.row].open_end = false;
      leaves_[round.row] = round.leaves;
    }
    round.closed = false;
    round.row = nowhere;
    return;
  }
  const double given = std::hypot(round.given[0], round.given[1]);
  ContactInstant told;
  told.point = round.stop;
  told.side = StopSide::upper;
  told.time = time;
  told.lasts = round.lasts;
  told.given = given;
  told.force = round.lasts > 0 ? given / round.lasts : 0.0;
  for (const std::size_t axis : {0, 1})
    told.normal[axis] = given > 0 ? round.given[axis] / given : round.direction[axis];
  // Sides of the start of the motion, and those that take over from others, are no impact.
  told.closes = !round.closed && round.closes;
  if (!round.closed) round.speed_in = given > 0 ? round.came / given : 0;
  if (told.closes) begin_impact(round, time);
  round.closed = true;
  told.speed_in = round.speed_in;
  told.impact = round.row;
  StopTotals& totals = round.totals;
  totals.impulse += given;
  totals.contact_time += told.lasts;
  totals.squares += given * told.force;
  totals.peak_force = std::max(totals.peak_force, told.force);
  if (round.row != nowhere) {
    Impact& impact = impacts_[round.row];
    impact.impulse += given;
    impact.duration += told.lasts;
    impact.peak_force = std::max(impact.peak_force, told.force);
    impact.release_force = told.force;
  }
  round.leaves = round.shares;
  for (Share& share : round.leaves) share.weight = given > 0 ? share.weight / given : 0;
  round.shares.clear();
  round.given[0] = round.given[1] = round.lasts = round.came = 0;
  round.pushed = false;
  round.closes = true;
  add(told, -told.normal[0]);
}

void StopContacts::add(const ContactInstant& told, double upwards) {
  pressed_ += told.force;
  pushed_upwards_ += upwards * told.force;
  impulse_ += told.given;
  peak_ = std::max(peak_, told.force);
  for (ContactListener* listener : listeners_) listener->instant(told);
}

void StopContacts::finish() {
  const std::vector<Impact>& seen = recorder_.impacts(0);
  for (std::size_t i = 0; i < impacts_.size(); ++i) {
    const std::vector<Share>& shares = leaves_[i];
    Impact& impact = impacts_[i];
    if (round_of_[static_cast<std::size_t>(impact.point)] < 0) {
      const int stop = impact.point;
      impact = seen[shares.front().impact];
      impact.point = stop;
      continue;
    }
    if (impact.open_end || shares.empty()) continue;
    impact.speed_out = 0;
    for (const Share& share : shares)
      impact.speed_out += share.impact < seen.size() ? share.weight * seen[share.impact].speed_out
                                                     : std::numeric_limits<double>::quiet_NaN();
  }
}

StopTotals StopContacts::totals(int stop, StopSide side) const {
  const int row = list_.row[static_cast<std::size_t>(stop)];
  const int polygon = round_of_[static_cast<std::size_t>(stop)];
  if (polygon < 0) return recorder_.totals(0, row, side);
  if (side == StopSide::lower) return {};
  const Round& round = rounds_[static_cast<std::size_t>(polygon)];
  StopTotals out = round.totals;
  for (std::size_t k = 0; k < round.normals.size(); ++k)
    for (const StopSide each : {StopSide::lower, StopSide::upper})
      out.normal_work += recorder_.totals(0, round.first + static_cast<int>(k), each).normal_work;
  return out;
}

double StopContacts::take_peak() {
  return merges() ? std::exchange(peak_, 0.0) : recorder_.take_peak(0);
}

}  // namespace ricochet
