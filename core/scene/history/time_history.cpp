#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <ricochet/contract/errors.hpp>
#include <ricochet/scene/history/time_history.hpp>
#include <unsupported/Eigen/FFT>
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

// The same of what repeats: f'' is equal at both ends. The cyclic system is a tridiagonal one and a corner of rank one
// (Sherman and Morrison).
std::vector<double> periodic_curvatures(const std::vector<double>& t, const std::vector<double>& f) {
  const std::size_t n = t.size() - 1;
  std::vector<double> curvature(n + 1, 0.0), corner(n, 0.0), above(n, 0.0);
  if (n == 1) return curvature;
  const auto length = [&](std::size_t i) { return t[i + 1] - t[i]; };
  const double wrap = length(n - 1) / 6, shift = -(length(n - 1) + length(0)) / 3;
  corner[0] = shift;
  corner[n - 1] = wrap;
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t before = i == 0 ? n - 1 : i - 1;
    double pivot = (length(before) + length(i)) / 3, jump = (f[i + 1] - f[i]) / length(i);
    jump -= (f[before + 1] - f[before]) / length(before);
    if (i == 0) pivot -= shift;
    if (i == n - 1) pivot -= wrap * wrap / shift;
    const double left = i == 0 ? 0 : length(before) / 6;
    pivot -= i == 0 ? 0 : left * above[i - 1];
    above[i] = i == n - 1 ? 0 : length(i) / 6 / pivot;
    curvature[i] = (jump - (i == 0 ? 0 : left * curvature[i - 1])) / pivot;
    corner[i] = (corner[i] - (i == 0 ? 0 : left * corner[i - 1])) / pivot;
  }
  for (std::size_t i = n - 1; i-- > 0;) {
    curvature[i] -= above[i] * curvature[i + 1];
    corner[i] -= above[i] * corner[i + 1];
  }
  const double share =
      (curvature[0] + wrap / shift * curvature[n - 1]) / (1 + corner[0] + wrap / shift * corner[n - 1]);
  for (std::size_t i = 0; i < n; ++i) curvature[i] -= share * corner[i];
  curvature[n] = curvature[0];
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
  if (period == 0) return;
  constexpr double alike = 1e-9;
  const double length = times.back() - times.front();
  if (std::abs(length - period) > alike * period)
    throw InputError(pointer + "/period", fmt::format("{} is {:.12g} s long and is to repeat after {:.12g} s; expected "
                                                      "one period of it, {:.12g} s",
                                                      name, length, period, length));
  double largest = 0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  if (std::abs(values.back() - values.front()) > alike * largest)
    throw InputError(pointer + "/period",
                     fmt::format("{} begins with {:.9g} and ends with {:.9g}; what repeats ends as it begins", name,
                                 values.front(), values.back()));
}

PiecewiseCubic PiecewiseCubic::interpolate(const TimeTable& table) {
  const std::vector<double>&t = table.times, &f = table.values;
  const std::size_t n = t.size();
  std::vector<double> starts{t.front() - 1}, bends(n, 0.0);
  std::vector<Piece> pieces{{outside(table.before, f.front()), 0, 0, 0}};
  if (table.between == TimeTable::Between::cubic)
    bends = table.period > 0 ? periodic_curvatures(t, f) : spline_curvatures(t, f);
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
  return {std::move(starts), std::move(pieces), table.period};
}

PiecewiseCubic PiecewiseCubic::integral() const {
  std::vector<Piece> pieces(pieces_.size());
  const auto moved = [](const Piece& c, double s) { return s * (c[0] + s * (c[1] / 2 + s * c[2] / 3)); };
  double at = 0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const Piece& c = pieces_[i];
    const double s = i + 1 < pieces.size() ? starts_[i + 1] - starts_[i] : 0.0;
    // What comes before the first instant ends there at 0.
    pieces[i] = {i == 0 ? -moved(c, s) : at, c[0], c[1] / 2, c[2] / 3};
    if (i > 0) at += moved(c, s);
  }
  return {starts_, std::move(pieces), period_};
}

PiecewiseCubic PiecewiseCubic::integrate_twice(const TimeTable& acceleration, double position, double velocity) {
  // From any position and velocity at the first instant, then moved to those at t = 0.
  const PiecewiseCubic raw = interpolate(acceleration).integral().integral();
  const double more = velocity - raw.rate(0), place = position - raw.value(0) - more * raw.within(0);
  std::vector<Piece> pieces = raw.pieces_;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    pieces[i][0] += place + more * raw.starts_[i];
    pieces[i][1] += more;
  }
  return {raw.starts_, std::move(pieces), raw.period_};
}

SteadyStart steady_start(const TimeTable& acceleration) {
  TimeTable once = acceleration;
  once.period = 0;
  const PiecewiseCubic raw = PiecewiseCubic::integrate_twice(once, 0, 0);
  const std::vector<double>& t = acceleration.times;
  const double begin = t.front(), end = t.back(), period = end - begin, first = raw.rate(begin);
  SteadyStart out;
  out.mean_acceleration = (raw.rate(end) - first) / period;
  // From φ' = `speed` at the first instant on, one period leads back.
  const double speed = first - (raw.value(end) - raw.value(begin)) / period;
  const auto place = [&](double at) { return raw.value(at) - raw.value(begin) + (speed - first) * (at - begin); };
  double sum = 0;
  for (std::size_t i = 0; i + 1 < t.size(); ++i) {
    out.largest_acceleration = std::max(out.largest_acceleration, std::abs(acceleration.values[i]));
    out.largest_velocity = std::max(out.largest_velocity, std::abs(raw.rate(t[i]) - first + speed));
    sum += (t[i + 1] - t[i]) / 6 * (place(t[i]) + 4 * place((t[i] + t[i + 1]) / 2) + place(t[i + 1]));
  }
  const double zero = -begin - period * std::floor(-begin / period) + begin;  // t = 0 within the table
  out.velocity = raw.rate(zero) - first + speed;
  out.position = place(zero) - sum / period;
  return out;
}

PiecewiseCubic::PiecewiseCubic(std::vector<double> starts, std::vector<Piece> pieces, double period)
    : starts_(std::move(starts)), pieces_(std::move(pieces)), period_(period) {}

PiecewiseCubic::PiecewiseCubic(const PiecewiseCubic& other)
    : TimeHistory(other), starts_(other.starts_), pieces_(other.pieces_), period_(other.period_) {}

double PiecewiseCubic::within(double t) const {
  if (period_ == 0) return t;
  const double first = starts_[1], since = t - first;
  const double rest = since - period_ * std::floor(since / period_);
  return rest < period_ ? first + rest : first;
}

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

double PiecewiseCubic::value(double at) const {
  const double t = within(at);
  const std::size_t i = piece(t);
  const Piece& c = pieces_[i];
  const double s = t - starts_[i];
  return c[0] + s * (c[1] + s * (c[2] + s * c[3]));
}

double PiecewiseCubic::rate(double at) const {
  const double t = within(at);
  const std::size_t i = piece(t);
  const Piece& c = pieces_[i];
  const double s = t - starts_[i];
  return c[1] + s * (2 * c[2] + s * 3 * c[3]);
}

double PiecewiseCubic::acceleration(double at) const {
  const double t = within(at);
  const std::size_t i = piece(t);
  const Piece& c = pieces_[i];
  return 2 * c[2] + 6 * c[3] * (t - starts_[i]);
}

namespace {

// Steele, Lea, Flood 2014: one output of SplitMix64 for each counter.
std::uint64_t mixed(std::uint64_t counter) {
  std::uint64_t z = counter * 0x9e3779b97f4a7c15ULL;
  z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27U)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31U);
}

// A phase in [0, 2π[ of each line, load and seed.
double phase(std::uint64_t seed, std::uint64_t load, std::uint64_t line) {
  const std::uint64_t drawn = mixed(mixed(mixed(seed + 1) + load + 1) + line + 1);
  return 2 * std::numbers::pi * static_cast<double>(drawn >> 11U) * 0x1p-53;
}

}  // namespace

RandomLoad::RandomLoad(const SpectrumSpec& spectrum) {
  if (!(spectrum.to > spectrum.from))
    throw InputError(spectrum.pointer + "/to", fmt::format("the spectrum ends at {:.6g} Hz; expected more than {:.6g}",
                                                           spectrum.to, spectrum.from));
  constexpr double resolution = 64;  // instants per period of the highest line
  constexpr double pi = std::numbers::pi;
  const int lines = spectrum.lines;
  band_ = (spectrum.to - spectrum.from) / lines;
  const double first = spectrum.from + band_ / 2;
  base_ = 2 * pi * first;
  while (static_cast<double>(count_) * band_ < resolution * spectrum.to) count_ *= 2;
  constexpr std::size_t most = std::size_t{1} << 24U;
  if (count_ > most)
    throw InputError(spectrum.pointer + "/lines",
                     fmt::format("lines {:.3g} Hz apart up to {:.6g} Hz take {} instants; expected at most {}", band_,
                                 spectrum.to, count_, most));
  spacing_ = 1 / (band_ * static_cast<double>(count_));
  for (int i = 0; i < lines; ++i) {
    const double f = first + i * band_, S = spectrum.density(f);
    if (!(S >= 0) || !std::isfinite(S))
      throw InputError(spectrum.pointer, fmt::format("S(f) is {:.6g} at {:.6g} Hz; expected 0 or above", S, f));
    mean_square_ += S * band_;
    lines_.push_back(std::sqrt(2 * S * band_));
    phases_.push_back(phase(spectrum.seed, spectrum.load, static_cast<std::uint64_t>(i)));
  }
}

// Σ_i A_i e^{2πi·i·k/N}: an inverse transform without its 1/N.
void RandomLoad::make_tables() const {
  std::vector<Complex> amplitude(count_), rate(count_);
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    amplitude[i] = std::polar(lines_[i], phases_[i]);
    rate[i] = Complex(0, base_ + 2 * std::numbers::pi * band_ * static_cast<double>(i)) * amplitude[i];
  }
  Eigen::FFT<double> transform;
  transform.SetFlag(Eigen::FFT<double>::Unscaled);
  transform.inv(envelope_, amplitude);
  transform.inv(slope_, rate);
}

double RandomLoad::value(double t) const {
  std::call_once(made_, [this] { make_tables(); });
  const double place = t / spacing_, whole = std::floor(place), s = place - whole;
  const auto count = static_cast<long long>(envelope_.size());
  const auto at = [&](long long k) { return static_cast<std::size_t>(((k % count) + count) % count); };
  const auto k = static_cast<long long>(whole);
  const Complex here = std::polar(1.0, base_ * spacing_ * whole), step = std::polar(1.0, base_ * spacing_);
  const double left = (here * envelope_[at(k)]).real(), right = (here * step * envelope_[at(k + 1)]).real();
  const double rise = spacing_ * (here * slope_[at(k)]).real(),
               fall = spacing_ * (here * step * slope_[at(k + 1)]).real();
  const double c2 = 3 * (right - left) - 2 * rise - fall, c3 = 2 * (left - right) + rise + fall;
  return left + s * (rise + s * (c2 + s * c3));
}

}  // namespace ricochet
