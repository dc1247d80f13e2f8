#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ricochet/contract/errors.hpp>
#include <ricochet/scene/history/piecewise_cubic.hpp>
#include <utility>

namespace ricochet {
namespace {

using Piece = PiecewiseCubic::Piece;

// f'' at the instants of a natural cubic spline: a tridiagonal system, by elimination.
std::vector<double> spline_curvatures(const std::vector<double>& t, const std::vector<double>& f) {
  const std::size_t n = t.size();
  std::vector<double> curvature(n, 0.0), above(n, 0.0);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double left = t[i] - t[i - 1], right = t[i + 1] - t[i];
    const double jump = (f[i + 1] - f[i]) / right - (f[i] - f[i - 1]) / left;
    const double pivot = (left + right) / 3 - left / 6 * above[i - 1];
    above[i] = right / 6 / pivot;
    curvature[i] = (jump - left / 6 * curvature[i - 1]) / pivot;
  }
  for (std::size_t i = n - 1; i-- > 1;) curvature[i] -= above[i] * curvature[i + 1];
  return curvature;
}

double outside(TimeTable::Beyond beyond, double value) {
  return beyond == TimeTable::Beyond::zero ? 0.0 : value;
}

}  // namespace

void TimeTable::check(const std::string& pointer) const {
  if (times.size() != values.size()) throw InputError(pointer, fmt::format("{} has no value for each instant", name));
  if (times.size() < 2)
    throw InputError(pointer, fmt::format("{} has {}; expected two entries or more", name,
                                          times.empty() ? "no entry" : "one entry"));
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (!std::isfinite(times[i]) || !std::isfinite(values[i]))
      throw InputError(pointer, fmt::format("{}, entry {}: expected finite numbers", name, i + 1));
    if (i > 0 && !(times[i] > times[i - 1]))
      throw InputError(pointer, fmt::format("{}, entry {}: t = {:.9g} after {:.9g}; times must increase", name, i + 1,
                                            times[i], times[i - 1]));
  }
}

PiecewiseCubic PiecewiseCubic::interpolate(const TimeTable& table) {
  const std::vector<double>&t = table.times, &f = table.values;
  const std::size_t n = t.size();
  std::vector<double> starts{t.front() - 1}, bends(n, 0.0);
  std::vector<Piece> pieces{{outside(table.before, f.front()), 0, 0, 0}};
  if (table.between == TimeTable::Between::cubic) bends = spline_curvatures(t, f);
  for (std::size_t i = 0; i + 1 < n; ++i) {
    const double length = t[i + 1] - t[i];
    Piece piece{f[i], 0, 0, 0};
    if (table.between != TimeTable::Between::step)
      piece = {f[i], (f[i + 1] - f[i]) / length - length * (2 * bends[i] + bends[i + 1]) / 6, bends[i] / 2,
               (bends[i + 1] - bends[i]) / (6 * length)};
    starts.push_back(t[i]);
    pieces.push_back(piece);
  }
  starts.push_back(t.back());
  pieces.push_back({outside(table.after, f.back()), 0, 0, 0});
  return {std::move(starts), std::move(pieces)};
}

PiecewiseCubic PiecewiseCubic::integrate_twice(const TimeTable& acceleration, double position, double velocity) {
  PiecewiseCubic rate = interpolate(acceleration);
  // From any position and velocity at the first instant, then moved to those at t = 0.
  std::vector<Piece> pieces(rate.pieces_.size());
  double at = 0, speed = 0;
  for (std::size_t i = 1; i < pieces.size(); ++i) {
    const Piece& a = rate.pieces_[i];
    pieces[i] = {at, speed, a[0] / 2, a[1] / 6};
    if (i + 1 == pieces.size()) break;
    const double s = rate.starts_[i + 1] - rate.starts_[i];
    at += s * (speed + s * (a[0] / 2 + s * a[1] / 6));
    speed += s * (a[0] + s * a[1] / 2);
  }
  // What comes before the first instant ends there with the same position and velocity.
  const double a = rate.pieces_[0][0], s = rate.starts_[1] - rate.starts_[0];
  pieces[0] = {a * s * s / 2, -a * s, a / 2, 0};
  const PiecewiseCubic raw(rate.starts_, pieces);
  const double more = velocity - raw.rate(0), place = position - raw.value(0);
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    pieces[i][0] += place + more * rate.starts_[i];
    pieces[i][1] += more;
  }
  return {std::move(rate.starts_), std::move(pieces)};
}

PiecewiseCubic::PiecewiseCubic(std::vector<double> starts, std::vector<Piece> pieces)
    : starts_(std::move(starts)), pieces_(std::move(pieces)) {}

PiecewiseCubic::PiecewiseCubic(const PiecewiseCubic& other)
    : TimeHistory(other), starts_(other.starts_), pieces_(other.pieces_) {}

std::size_t PiecewiseCubic::piece(double t) const {
  std::size_t i = near_.load(std::memory_order_relaxed);
  const auto holds = [&](std::size_t k) {
    return (k == 0 || starts_[k] <= t) && (k + 1 == starts_.size() || t < starts_[k + 1]);
  };
  if (holds(i)) return i;
  if (i + 1 < starts_.size() && holds(i + 1)) {
    ++i;
  } else {
    const auto behind = std::upper_bound(starts_.begin() + 1, starts_.end(), t);
    i = static_cast<std::size_t>(behind - starts_.begin()) - 1;
  }
  near_.store(i, std::memory_order_relaxed);
  return i;
}

double PiecewiseCubic::value(double t) const {
  const std::size_t i = piece(t);
  const Piece& c = pieces_[i];
  const double s = t - starts_[i];
  return c[0] + s * (c[1] + s * (c[2] + s * c[3]));
}

double PiecewiseCubic::rate(double t) const {
  const std::size_t i = piece(t);
  const Piece& c = pieces_[i];
  const double s = t - starts_[i];
  return c[1] + s * (2 * c[2] + s * 3 * c[3]);
}

double PiecewiseCubic::acceleration(double t) const {
  const std::size_t i = piece(t);
  const Piece& c = pieces_[i];
  return 2 * c[2] + 6 * c[3] * (t - starts_[i]);
}

}  // namespace ricochet
