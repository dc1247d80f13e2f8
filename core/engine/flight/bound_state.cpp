#include <algorithm>
#include <cmath>
#include <ricochet/engine/flight/flight_bound.hpp>
#include <ricochet/kernels/flight_kernels.hpp>
#include <ricochet/kernels/floating_point.hpp>

// What is asked of a bound while an integration goes on; how it is made stands in flight_bound.cpp.
namespace ricochet {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr double slack = 1e-12;  // of a bound: its own round-off
// Of all modes, those that are bounded point by point first: beyond, that costs what the whole bound does.
constexpr double few_slow = 0.6;

}  // namespace

void FlightBound::set_state(const double* x, const double* e) {
  const FlightKernels& kernels = flight_kernels();
  const double drive = drive_.harmonic() ? std::hypot(e[0], e[1]) : 0.0;
  const double turn = 2 * std::sin(drive_.angle / 2);
  double turned[3] = {};  // what e changes by
  for (int k = 0; k < drives_; ++k)
    for (int l = 0; l < drives_; ++l) turned[k] += turn_(k, l) * e[l];
  for (Watched& watched : watches_) {
    watched.differences_known = false;
    kernels.row(modes_, slots_, drives_, watched.value.data(), x, e, watched.now.data());
    kernels.row(modes_, slots_, drives_, watched.change.data(), x, e, watched.step.data());
    for (std::size_t j = 0; j < watched.amplitude.size(); ++j) {
      watched.amplitude[j] = drive * watched.steady_amplitude[j] + watched.rest[j];
      watched.bend[j] = drive * watched.steady_bend[j];
    }
    for (std::size_t l = 0; l < watched.real.size(); ++l) {
      kernels.row(modes_, slots_, drives_, watched.real[l].data(), x, e, real_.data());
      kernels.row(modes_, slots_, drives_, watched.imaginary[l].data(), x, e, imaginary_.data());
      kernels.modulus(modes_, real_.data(), imaginary_.data(), watched.weight[l].data(), watched.amplitude.data(),
                      watched.bend.data());
    }
    if (!watched.grows.empty()) {
      kernels.row(modes_, slots_, drives_, watched.grows.data(), x, e, watched.growth.data());
      for (double& growth : watched.growth) growth = std::abs(growth);
    }
    for (std::size_t i = 0; i < watched.offset.size() && drives_ > 0; ++i) {
      const auto row = static_cast<Index>(i);
      const MatrixXd& own = watched.watch.drive;
      watched.offset[i] = watched.offset_step[i] = 0;
      for (int k = 0; k < drives_; ++k) {
        watched.offset[i] += own(row, k) * e[k];
        watched.offset_step[i] += own(row, k) * turned[k];
      }
      if (drive_.harmonic()) watched.offset_bend[i] = turn * turn * std::hypot(own(row, 0), own(row, 1)) * drive;
    }
  }
  placed_of_ = nullptr;
}

// The cone of all modes at k, where it is not the last one.
void FlightBound::place(Watched& watched, long long k) {
  if (placed_of_ == &watched && placed_ == k) return;
  const FlightKernels& kernels = flight_kernels();
  const double *amplitude = watched.amplitude.data(), *bend = watched.bend.data(), steps = static_cast<double>(k);
  if (!watched.grows.empty()) {
    for (std::size_t j = 0; j < watched.growth.size(); ++j) {
      grown_amplitude_[j] = 1.005 * (amplitude[j] + steps * watched.growth[j]);
      grown_bend_[j] = bend[j] + (steps * watched.doubled[j] + 2 * std::sqrt(watched.doubled[j])) * watched.growth[j];
    }
    amplitude = grown_amplitude_.data();
    bend = grown_bend_.data();
  }
  kernels.cone(modes_, steps, watched.now.data(), watched.step.data(), amplitude, bend, places_.data());
  placed_of_ = &watched;
  placed_ = k;
  slow_from_ = -1;
}

// The modes that are followed along their first values, from the first to the last of them. Also what all others may
// add at any point.
void FlightBound::split(const Watched& watched) {
  if (slow_from_ >= 0) return;
  const double *near = places_.data(), *near_radius = near + modes_, *far = near + 2L * modes_,
               *far_radius = near + 3L * modes_;
  const auto slow = [&](int j) { return near[j] != 0 || far[j] != 0 || near_radius[j] != far_radius[j]; };
  slow_from_ = 0;
  slow_to_ = modes_;
  while (slow_from_ < slow_to_ && !slow(slow_from_)) ++slow_from_;
  while (slow_to_ > slow_from_ && !slow(slow_to_ - 1)) --slow_to_;
  const FlightKernels& kernels = flight_kernels();
  fast_radius_ = kernels.dot(slow_from_, watched.widest.data(), near_radius) +
                 kernels.dot(modes_ - slow_to_, watched.widest.data() + slow_to_, near_radius + slow_to_);
}

// (4) at 0 and at k, of the modes from `first` on, `count` of them; the others add `more` at most.
FlightBound::Range FlightBound::cone(const Watched& watched, std::size_t point, double k, int first, int count,
                                     double more) {
  double sums[4];
  flight_kernels().reach(count, modes_, watched.points.data() + point * static_cast<std::size_t>(modes_) + first,
                         places_.data() + first, sums);
  return around(watched, point, k, sums, 1, more);
}

FlightBound::Range FlightBound::around(const Watched& watched, std::size_t point, double k, const double* sums,
                                       std::size_t stride, double more) const {
  const double near = sums[0] + watched.offset[point], near_radius = sums[stride] + more;
  const double far = sums[2 * stride] + watched.offset[point] + k * watched.offset_step[point];
  const double far_radius = sums[3 * stride] + more + 0.5 * k * (k - 1) * watched.offset_bend[point];
  const double margin = slack * (std::abs(near) + std::abs(far) + near_radius + far_radius);
  return {std::min(near - near_radius, far - far_radius) - margin,
          std::max(near + near_radius, far + far_radius) + margin, margin};
}

// Whether a point stays strictly between its bounds.
bool FlightBound::inside(Watched& watched, std::size_t point, long long k) {
  const double lower = watched.watch.lower[point], upper = watched.watch.upper[point];
  if (lower == -infinity && upper == infinity) return true;
  place(watched, k);
  const Range range = cone(watched, point, static_cast<double>(k), 0, modes_, 0);
  return range.low > lower && range.high < upper;
}

// `see`(point) of each that may not stay there, until it says false. Where few modes are slow, all points are first
// bounded with what the fast modes may add anywhere. That is one number and says enough of most.
template <class See>
bool FlightBound::see_exposed(Watched& watched, long long k, See&& see) {
  const std::size_t points = watched.offset.size();
  if (points == 0) return true;
  place(watched, k);
  split(watched);
  const bool rough = slow_to_ - slow_from_ < few_slow * modes_;
  const int first = rough ? slow_from_ : 0, count = rough ? slow_to_ - slow_from_ : modes_;
  flight_kernels().reaches(count, modes_, static_cast<int>(points),
                           watched.columns.data() + static_cast<std::size_t>(first) * points, places_.data() + first,
                           reached_.data());
  for (std::size_t i = 0; i < points; ++i) {
    const double lower = watched.watch.lower[i], upper = watched.watch.upper[i];
    if (lower == -infinity && upper == infinity) continue;
    const Range range =
        around(watched, i, static_cast<double>(k), reached_.data() + i, points, rough ? fast_radius_ : 0);
    if ((range.low > lower && range.high < upper) || (rough && inside(watched, i, k))) continue;
    if (!see(i)) return false;
  }
  return true;
}

bool FlightBound::holds(long long k) {
  if (k > longest_) return false;
  for (Watched& watched : watches_) {
    if (watched.offset.empty()) continue;
    // The point that stopped the last flight is the first to ask.
    if (!inside(watched, watched.tightest, k)) return false;
    const bool all = see_exposed(watched, k, [&](std::size_t point) {
      watched.tightest = point;
      return false;
    });
    if (!all) return false;
  }
  return true;
}

bool FlightBound::find_exposed(long long k, std::vector<WatchedPoint>& exposed, std::size_t most) {
  exposed.clear();
  for (std::size_t w = 0; w < watches_.size(); ++w) {
    const bool all = see_exposed(watches_[w], k, [&](std::size_t point) {
      if (exposed.size() == most) return false;
      exposed.push_back({static_cast<int>(w), static_cast<int>(point)});
      return true;
    });
    if (!all) return false;
  }
  return true;
}

FlightBound::Range FlightBound::range(int watch, int point, long long k) {
  Watched& watched = watches_[static_cast<std::size_t>(watch)];
  place(watched, k);
  return cone(watched, static_cast<std::size_t>(point), static_cast<double>(k), 0, modes_, 0);
}

// Of a share c λⁱ the m-th difference is |λ − 1|ᵐ |c|. The first is at most the root of its amplitude times its bend,
// as their sums have it. The third and fourth are bounded by the fastest share.
FlightBound::Differences FlightBound::differences(int watch, int point) {
  Watched& watched = watches_[static_cast<std::size_t>(watch)];
  const auto at = static_cast<std::size_t>(point);
  if (!watched.grows.empty()) return {infinity, infinity, infinity, infinity, range(watch, point, 1).margin};
  const auto n = static_cast<std::size_t>(modes_);
  double* const differences = watched.differences.data();
  if (!watched.differences_known) {
    const double *amplitude = watched.amplitude.data(), *bend = watched.bend.data(), *swift = watched.swiftest.data();
    for (std::size_t j = 0; j < n; ++j) {
      differences[j] = amplitude[j];
      differences[n + j] = std::sqrt(amplitude[j] * bend[j]);
      differences[2 * n + j] = bend[j];
      differences[3 * n + j] = bend[j] * swift[j];
      differences[4 * n + j] = bend[j] * swift[j] * swift[j];
    }
    watched.differences_known = true;
  }
  double sums[5];
  flight_kernels().dots(modes_, 5, differences, watched.sizes.data() + at * n, sums);
  const double bent = watched.offset_bend[at], turn = std::abs(2 * std::sin(drive_.angle / 2));
  return {sums[1] + (turn != 0 ? bent / turn : 0.0), sums[2] + bent, sums[3] + turn * bent,
          sums[4] + turn * turn * bent, slack * (sums[0] + std::abs(watched.offset[at]))};
}

double FlightBound::value(int watch, int point) {
  const Watched& watched = watches_[static_cast<std::size_t>(watch)];
  return flight_kernels().dot(modes_, row(watch, point), watched.now.data()) +
         watched.offset[static_cast<std::size_t>(point)];
}

void FlightBound::values(int watch, const double* x, const double* e, double* out) {
  Watched& watched = watches_[static_cast<std::size_t>(watch)];
  const FlightKernels& kernels = flight_kernels();
  kernels.row(modes_, slots_, drives_, watched.value.data(), x, e, real_.data());
  for (std::size_t i = 0; i < watched.offset.size(); ++i) {
    out[i] = kernels.dot(modes_, row(watch, static_cast<int>(i)), real_.data());
    for (int k = 0; k < drives_; ++k) out[i] += watched.watch.drive(static_cast<Index>(i), k) * e[k];
  }
}

}  // namespace ricochet
