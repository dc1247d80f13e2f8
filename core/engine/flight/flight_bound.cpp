#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <complex>
#include <ricochet/algebra/eigenvalues.hpp>
#include <ricochet/algebra/flight_kernels.hpp>
#include <ricochet/algebra/infinity.hpp>
#include <ricochet/engine/flight/flight_bound.hpp>
#include <ricochet/engine/flight/flight_motion.hpp>

namespace ricochet {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::RowVectorXcd;
using Eigen::RowVectorXd;
using Complex = std::complex<double>;

constexpr double nothing = 1e-3;         // a root below: zero as often as it is found, known to the root of round-off
constexpr double grows = 1e-10;          // of a root beyond the unit circle: what round-off makes of one on it
constexpr double ill_conditioned = 1e6;  // of eigenvectors: roots that coincide
constexpr double slack = 1e-12;          // of a bound: its own round-off

std::size_t place(Index row, int modes, int mode) {
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(modes) + static_cast<std::size_t>(mode);
}

void put(std::vector<double>& table, const RowVectorXd& row, int modes, int mode) {
  for (Index k = 0; k < row.size(); ++k) table[place(k, modes, mode)] = row[k];
}

}  // namespace

// A = I + D of a mode, with x = X e + (right · left + rest)(x − X e): the steady motion, the roots that are not zero,
// and what is over after `rest_steps` steps.
struct FlightBound::ModeRoots {
  MatrixXd step;            // (D B) of a step of the bound
  Eigen::VectorXcd change;  // λ − 1
  MatrixXcd right, left;
  MatrixXd rest;
  int rest_steps = 0;
  MatrixXd steady;          // X
  Eigen::VectorXcd phasor;  // of the harmonic part
  MatrixXd nilpotent;       // N of a double root; empty: there is none
};

FlightBound::FlightBound(const StepRows& rows, std::vector<FlightWatch> watches, int power)
    : modes_(rows.modes()), slots_(rows.slots()), drives_(rows.drive().count()), power_(power), drive_(rows.drive()) {
  drive_.angle *= static_cast<double>(1LL << power);
  turn_ = drive_.change(1);
  const auto n = static_cast<std::size_t>(modes_), width = static_cast<std::size_t>(rows.width());
  for (FlightWatch& watch : watches) {
    Watched& watched = watches_.emplace_back();
    const Index points = watch.rows.rows();
    for (Index i = 0; i < points; ++i)
      for (Index j = 0; j < watch.rows.cols(); ++j) watched.points.push_back(watch.rows(i, j));
    watched.watch = std::move(watch);
    for (auto* table : {&watched.value, &watched.change}) table->assign(width * n, 0.0);
    for (auto* array : {&watched.steady_amplitude, &watched.steady_bend, &watched.rest, &watched.now, &watched.step,
                        &watched.amplitude, &watched.bend, &watched.growth, &watched.doubled})
      array->assign(n, 0.0);
    for (auto* array : {&watched.offset, &watched.offset_step, &watched.offset_bend})
      array->assign(static_cast<std::size_t>(points), 0.0);
  }
  places_.resize(4 * n);
  real_.resize(n);
  imaginary_.resize(n);
  grown_amplitude_.resize(n);
  grown_bend_.resize(n);
  for (int mode = 0; mode < modes_; ++mode) {
    const ModeRoots found = roots(rows, mode);
    if (!cause_.empty()) return;
    for (Watched& watched : watches_) shares(rows, mode, found, watched);
  }
}

// (D B) of a step of the bound.
MatrixXd FlightBound::step_change(const StepRows& rows, int mode) const {
  MatrixXd whole = rows.change(mode);
  for (int k = 0; k < power_; ++k) double_change(whole, slots_, rows.drive().change(static_cast<double>(1LL << k)));
  return whole;
}

// Two slots whose roots coincide away from 1, up to round-off: λ = ½ tr A, N = A/λ − 1, N² = (¼ tr² − det)/λ² (Cayley
// and Hamilton).
bool FlightBound::double_root(const MatrixXd& D, ModeRoots& found) {
  if (slots_ != 2) return false;
  const MatrixXd A = MatrixXd::Identity(2, 2) + D;
  const double half = 0.5 * A.trace(), apart = half * half - A.determinant();
  constexpr double round_off = 1e-14, away = 0.1;
  if (std::abs(apart) > round_off || std::abs(half) > 1 + grows || std::abs(half - 1) < away || std::abs(half) < away)
    return false;
  found.change = Eigen::VectorXcd::Constant(1, Complex(half - 1));
  found.nilpotent = A / half - MatrixXd::Identity(2, 2);
  // cosh(i√ε) is 1 up to half a per cent while i√ε ≤ 0.1.
  longest_ = std::min(longest_, static_cast<long long>(0.1 / std::sqrt(std::max(std::abs(apart), 1e-16))));
  return true;
}

FlightBound::ModeRoots FlightBound::roots(const StepRows& rows, int mode) {
  ModeRoots found;
  found.step = step_change(rows, mode);
  const MatrixXd D = found.step.leftCols(slots_);
  if (double_root(D, found)) {
    steady(D, Eigen::VectorXd::Ones(slots_), found);
    return found;
  }
  MatrixXd scaled = D;
  // What is kept is the change of a step: its entries are small by the step, not by round-off.
  const Eigen::VectorXd scale = balance(scaled, 0);
  const GeneralModes modes = general_modes(scaled);
  if (!modes.found) {
    cause_ = "the roots of a step are not found";
    return found;
  }
  std::vector<Index> kept;
  for (Index l = 0; l < modes.values.size(); ++l) {
    const Complex change = modes.values[l];
    if (std::abs(1.0 + change) < nothing) continue;
    // |λ|² − 1, without the loss of digits that |λ| − 1 has.
    if (2 * change.real() + std::norm(change) > 2 * grows) {
      cause_ = "a mode grows by itself";
      return found;
    }
    kept.push_back(l);
    const Complex root = 1.0 + change, square = root * root;
    constexpr double still = 1e-3;
    alternates_ = alternates_ || std::abs(square * square - 1.0) < still * std::abs(change);
  }
  const auto count = static_cast<Index>(kept.size());
  MatrixXcd V(slots_, count);
  found.change.resize(count);
  for (Index l = 0; l < count; ++l) {
    V.col(l) = modes.vectors.col(kept[static_cast<std::size_t>(l)]).normalized();
    found.change[l] = modes.values[kept[static_cast<std::size_t>(l)]];
  }
  if (count > 0) {
    const Eigen::VectorXd sizes = singular_values(V);
    if (sizes[sizes.size() - 1] * ill_conditioned < sizes[0]) {
      cause_ = "roots of a step coincide: it may grow with the number of steps";
      return found;
    }
  }
  MatrixXcd W;
  if (count == slots_) {
    W = V.inverse();
  } else {
    // Aˢ leaves nothing of what is over after s steps: W = Λ⁻ˢ V⁺ Aˢ.
    found.rest_steps = slots_ - static_cast<int>(count);
    MatrixXd power = MatrixXd::Identity(slots_, slots_);
    for (int k = 0; k < slots_; ++k) power += scaled * power.eval();
    W = (V.adjoint() * V).inverse() * V.adjoint() * power.cast<Complex>();
    for (Index l = 0; l < count; ++l) W.row(l) *= std::pow(1.0 + found.change[l], -slots_);
  }
  found.right = scale.cast<Complex>().asDiagonal() * V;
  found.left = W * scale.cwiseInverse().cast<Complex>().asDiagonal();
  found.rest = MatrixXd::Identity(slots_, slots_) - (found.right * found.left).real();
  steady(scaled, scale, found);
  return found;
}

// X of the drive, in slots of one size.
void FlightBound::steady(const MatrixXd& scaled, const Eigen::VectorXd& scale, ModeRoots& found) {
  const MatrixXd scaled_B = scale.cwiseInverse().asDiagonal() * found.step.rightCols(drives_);
  found.steady = MatrixXd::Zero(slots_, drives_);
  if (drive_.harmonic) {
    const double half = std::sin(drive_.angle / 2);
    const Complex turn(-2 * half * half, std::sin(drive_.angle));  // e^{iωh} − 1
    const MatrixXcd shifted = turn * MatrixXcd::Identity(slots_, slots_) - scaled.cast<Complex>();
    const Eigen::VectorXcd force = scaled_B.col(1).cast<Complex>() - Complex(0, 1) * scaled_B.col(0).cast<Complex>();
    found.phasor = scale.cast<Complex>().asDiagonal() * shifted.fullPivLu().solve(force);
    found.steady.col(0) = -found.phasor.imag();
    found.steady.col(1) = found.phasor.real();
  }
  if (drive_.constant)
    found.steady.col(drive_.one()) = scale.asDiagonal() * (-scaled).fullPivLu().solve(scaled_B.col(drive_.one()));
  if (!found.steady.allFinite()) cause_ = "a mode is in resonance with the drive";
}

// Of one mode in one measure: its value and change, and what bounds them.
void FlightBound::shares(const StepRows& rows, int mode, const ModeRoots& found, Watched& watched) {
  RowVectorXd row = rows.of(mode, watched.watch.stage, watched.watch.value);
  const auto next = [&](const RowVectorXd& of) {
    RowVectorXd change = of.head(slots_) * found.step;
    if (drives_ > 0) change.tail(drives_) += of.tail(drives_) * turn_;
    return change;
  };
  if (watched.watch.difference) row = next(row);
  put(watched.value, row, modes_, mode);
  const RowVectorXd change = next(row);
  put(watched.change, change, modes_, mode);
  const auto n = static_cast<std::size_t>(modes_), width = static_cast<std::size_t>(rows.width());
  const auto at = static_cast<std::size_t>(mode);
  std::size_t used = 0;
  const auto add = [&](const RowVectorXcd& share, double weight) {
    if (used == watched.real.size()) {
      watched.real.emplace_back(width * n, 0.0);
      watched.imaginary.emplace_back(width * n, 0.0);
      watched.weight.emplace_back(n, 0.0);
    }
    RowVectorXcd whole(rows.width());
    whole.head(slots_) = share;
    if (drives_ > 0) whole.tail(drives_) = -share * found.steady.cast<Complex>();
    put(watched.real[used], whole.real(), modes_, mode);
    put(watched.imaginary[used], whole.imag(), modes_, mode);
    watched.weight[used][at] = weight;
    ++used;
  };
  const RowVectorXcd own = row.head(slots_).cast<Complex>();
  if (found.nilpotent.size() > 0) {
    add(own, std::norm(found.change[0]));
    if (watched.grows.empty()) watched.grows.assign(width * n, 0.0);
    RowVectorXd whole = RowVectorXd::Zero(rows.width());
    whole.head(slots_) = row.head(slots_) * found.nilpotent;
    whole.tail(drives_) = -whole.head(slots_) * found.steady;
    put(watched.grows, whole, modes_, mode);
    watched.doubled[at] = std::norm(found.change[0]);
  }
  for (Index l = 0; l < found.left.rows(); ++l) {
    const Complex lambda = found.change[l];
    if (lambda.imag() < 0) continue;  // of a conjugate pair
    const double times = lambda.imag() > 0 ? 2 : 1;
    add(times * (own * found.right.col(l))[0] * found.left.row(l), std::norm(lambda));
  }
  RowVectorXd over = row.head(slots_);
  for (int k = 0; k < found.rest_steps; ++k) {
    add((over * found.rest).cast<Complex>(), 4);
    over += over * found.step.leftCols(slots_);
  }
  if (drive_.harmonic) {
    const Complex steady = (own * found.phasor)[0] + Complex(row[slots_ + 1], -row[slots_]);
    const double turn = 2 * std::sin(drive_.angle / 2);
    watched.steady_amplitude[at] = std::abs(steady);
    watched.steady_bend[at] = turn * turn * std::abs(steady);
  }
  if (drive_.constant) {
    const int one = drive_.one();
    watched.rest[at] = std::abs(row.head(slots_).dot(found.steady.col(one)) + row[slots_ + one]);
  }
}

void FlightBound::look(const double* x, const double* e) {
  const FlightKernels& kernels = flight_kernels();
  const double drive = drive_.harmonic ? std::hypot(e[0], e[1]) : 0.0;
  const double turn = 2 * std::sin(drive_.angle / 2);
  double turned[3] = {};  // what e changes by
  for (int k = 0; k < drives_; ++k)
    for (int l = 0; l < drives_; ++l) turned[k] += turn_(k, l) * e[l];
  for (Watched& watched : watches_) {
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
      if (drive_.harmonic) watched.offset_bend[i] = turn * turn * std::hypot(own(row, 0), own(row, 1)) * drive;
    }
  }
  placed_of_ = nullptr;
}

// (4) at 0 and at k.
FlightBound::Range FlightBound::cone(Watched& watched, std::size_t point, double k) {
  const FlightKernels& kernels = flight_kernels();
  if (placed_of_ != &watched || placed_ != static_cast<long long>(k)) {
    const double *amplitude = watched.amplitude.data(), *bend = watched.bend.data();
    if (!watched.grows.empty()) {
      for (std::size_t j = 0; j < watched.growth.size(); ++j) {
        grown_amplitude_[j] = 1.005 * (amplitude[j] + k * watched.growth[j]);
        grown_bend_[j] = bend[j] + (k * watched.doubled[j] + 2 * std::sqrt(watched.doubled[j])) * watched.growth[j];
      }
      amplitude = grown_amplitude_.data();
      bend = grown_bend_.data();
    }
    kernels.cone(modes_, k, watched.now.data(), watched.step.data(), amplitude, bend, places_.data());
    placed_of_ = &watched;
    placed_ = static_cast<long long>(k);
  }
  double sums[4];
  kernels.reach(modes_, watched.points.data() + point * static_cast<std::size_t>(modes_), places_.data(), sums);
  const double near = sums[0] + watched.offset[point];
  const double far = sums[2] + watched.offset[point] + k * watched.offset_step[point];
  const double far_radius = sums[3] + 0.5 * k * (k - 1) * watched.offset_bend[point];
  const double margin = slack * (std::abs(near) + std::abs(far) + sums[1] + far_radius);
  return {std::min(near - sums[1], far - far_radius) - margin, std::max(near + sums[1], far + far_radius) + margin};
}

bool FlightBound::holds(long long k) {
  if (k > longest_) return false;
  for (Watched& watched : watches_) {
    const std::size_t points = watched.offset.size();
    const auto inside = [&](std::size_t i) {
      const double lower = watched.watch.lower[i], upper = watched.watch.upper[i];
      if (lower == -infinity && upper == infinity) return true;
      const Range range = cone(watched, i, static_cast<double>(k));
      return range.low > lower && range.high < upper;
    };
    if (points == 0) continue;
    // The point that stopped the last flight is the first to ask.
    if (!inside(watched.tightest)) return false;
    for (std::size_t i = 0; i < points; ++i)
      if (i != watched.tightest && !inside(i)) {
        watched.tightest = i;
        return false;
      }
  }
  return true;
}

FlightBound::Range FlightBound::range(int watch, int point, long long k) {
  return cone(watches_[static_cast<std::size_t>(watch)], static_cast<std::size_t>(point), static_cast<double>(k));
}

double FlightBound::value(int watch, int point) {
  const Watched& watched = watches_[static_cast<std::size_t>(watch)];
  return flight_kernels().dot(
             modes_, watched.points.data() + static_cast<std::size_t>(point) * static_cast<std::size_t>(modes_),
             watched.now.data()) +
         watched.offset[static_cast<std::size_t>(point)];
}

void FlightBound::values(int watch, const double* x, const double* e, double* out) {
  Watched& watched = watches_[static_cast<std::size_t>(watch)];
  const FlightKernels& kernels = flight_kernels();
  kernels.row(modes_, slots_, drives_, watched.value.data(), x, e, real_.data());
  for (std::size_t i = 0; i < watched.offset.size(); ++i) {
    out[i] = kernels.dot(modes_, watched.points.data() + i * static_cast<std::size_t>(modes_), real_.data());
    for (int k = 0; k < drives_; ++k) out[i] += watched.watch.drive(static_cast<Index>(i), k) * e[k];
  }
}

}  // namespace ricochet
