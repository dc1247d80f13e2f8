#include <algorithm>
#include <cmath>
#include <complex>
#include <ricochet/engine/flight/flight_bound.hpp>
#include <ricochet/engine/flight/flight_motion.hpp>
#include <ricochet/kernels/dense_solvers.hpp>
#include <ricochet/kernels/eigenvalues.hpp>

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

std::size_t place(Index row, int modes, int mode) {
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(modes) + static_cast<std::size_t>(mode);
}

// Of a 2 × 2 matrix, in closed form: λ = ½ tr ± √(¼ (a − d)² + b c), and the longer row of A − λ turned.
GeneralModes modes_of_two(const MatrixXd& A) {
  const double half = 0.5 * (A(0, 0) + A(1, 1)), apart = 0.5 * (A(0, 0) - A(1, 1)), product = A(0, 1) * A(1, 0);
  const Complex root = std::sqrt(Complex(apart * apart + product));
  GeneralModes modes{Eigen::VectorXcd(2), MatrixXcd(2, 2), true};
  // The root of the larger sum first, the other by the determinant where nothing is lost by it.
  modes.values << half + root, half - root;
  if (root.imag() == 0) {
    const Complex large = half >= 0 ? half + root : half - root, determinant = A(0, 0) * A(1, 1) - product;
    if (large != 0.0) modes.values << large, determinant / large;
  }
  for (Index l = 0; l < 2; ++l) {
    const Complex first = A(0, 0) - modes.values[l], last = A(1, 1) - modes.values[l];
    if (std::abs(first) + std::abs(A(0, 1)) >= std::abs(last) + std::abs(A(1, 0)))
      modes.vectors.col(l) << -A(0, 1), first;
    else
      modes.vectors.col(l) << last, -A(1, 0);
    if (modes.vectors.col(l).isZero(0)) modes.vectors(l, l) = 1;
  }
  return modes;
}

// Of unit columns; of two it is √((1 + c)/(1 − c)) with c = |v₁ᴴv₂|.
double condition(const MatrixXcd& V) {
  if (V.cols() < 2) return 1;
  if (V.cols() == 2) {
    const double cosine = std::abs(V.col(0).dot(V.col(1)));
    return std::sqrt((1 + cosine) / std::max(1 - cosine, 0.0));
  }
  const Eigen::VectorXd sizes = singular_values(V);
  return sizes[0] / sizes[sizes.size() - 1];
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
                        &watched.amplitude, &watched.bend, &watched.growth, &watched.doubled, &watched.swiftest})
      array->assign(n, 0.0);
    for (auto* array : {&watched.offset, &watched.offset_step, &watched.offset_bend})
      array->assign(static_cast<std::size_t>(points), 0.0);
    watched.columns.resize(watched.points.size());
    watched.sizes.resize(watched.points.size());
    const std::size_t all = watched.points.size() / std::max<std::size_t>(n, 1);
    for (std::size_t at = 0; at < watched.points.size(); ++at) {
      watched.columns[at % n * all + at / n] = watched.points[at];
      watched.sizes[at] = std::abs(watched.points[at]);
    }
    reached_.resize(std::max(reached_.size(), 4 * all));
    watched.differences.assign(5 * n, 0.0);
    watched.widest.assign(n, 0.0);
    for (std::size_t at = 0; at < watched.points.size(); ++at)
      watched.widest[at % n] = std::max(watched.widest[at % n], std::abs(watched.points[at]));
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
  const double half = 0.5 * A.trace(), apart = half * half - determinant(A);
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
  const GeneralModes modes = slots_ == 2 ? modes_of_two(scaled) : general_modes(scaled);
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
  if (condition(V) > ill_conditioned) {
    cause_ = "roots of a step coincide: it may grow with the number of steps";
    return found;
  }
  MatrixXcd W;
  if (count == slots_) {
    W = inverse(V);
  } else {
    // Aˢ leaves nothing of what is over after s steps: W = Λ⁻ˢ V⁺ Aˢ.
    found.rest_steps = slots_ - static_cast<int>(count);
    MatrixXd power = MatrixXd::Identity(slots_, slots_);
    for (int k = 0; k < slots_; ++k) power += scaled * power.eval();
    W = inverse(MatrixXcd(V.adjoint() * V)) * V.adjoint() * power.cast<Complex>();
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
  if (drive_.harmonic()) {
    const double half = std::sin(drive_.angle / 2);
    const Complex turn(-2 * half * half, std::sin(drive_.angle));  // e^{iωh} − 1
    const MatrixXcd shifted = turn * MatrixXcd::Identity(slots_, slots_) - scaled.cast<Complex>();
    const Eigen::VectorXcd force = scaled_B.col(1).cast<Complex>() - Complex(0, 1) * scaled_B.col(0).cast<Complex>();
    found.phasor = scale.cast<Complex>().asDiagonal() * pivoted_solve(shifted, force);
    found.steady.col(0) = -found.phasor.imag();
    found.steady.col(1) = found.phasor.real();
  }
  if (drive_.constant)
    found.steady.col(drive_.one()) =
        scale.asDiagonal() * pivoted_solve(MatrixXd(-scaled), Eigen::VectorXd(scaled_B.col(drive_.one())));
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
    watched.swiftest[at] = std::max(watched.swiftest[at], std::sqrt(weight));
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
  if (drive_.harmonic()) {
    const Complex steady = (own * found.phasor)[0] + Complex(row[slots_ + 1], -row[slots_]);
    const double turn = 2 * std::sin(drive_.angle / 2);
    watched.steady_amplitude[at] = std::abs(steady);
    watched.steady_bend[at] = turn * turn * std::abs(steady);
    watched.swiftest[at] = std::max(watched.swiftest[at], std::abs(turn));
  }
  if (drive_.constant) {
    const int one = drive_.one();
    watched.rest[at] = std::abs(row.head(slots_).dot(found.steady.col(one)) + row[slots_ + one]);
  }
}

}  // namespace ricochet
