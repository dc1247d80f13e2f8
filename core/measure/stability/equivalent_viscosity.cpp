#include <algorithm>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <complex>
#include <ricochet/kernels/eigenvalues.hpp>
#include <ricochet/kernels/sparse_ldlt.hpp>
#include <ricochet/measure/stability/equivalent_viscosity.hpp>
#include <ricochet/measure/stability/step_map.hpp>
#include <ricochet/measure/stability/structure_physics.hpp>
#include <vector>

namespace ricochet {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Quad = boost::multiprecision::cpp_bin_float_quad;

constexpr double rigid = 1e-9;  // ω² of a motion without stiffness, against the shift that makes K definite

// ω² of the slowest modes that vibrate, from M φ = μ (K + σM) φ.
std::vector<double> squared_pulsations(const SemiDiscrete& problem, int modes) {
  const Index n = problem.dofs();
  if (n == 0 || n > most_modal_dofs) return {};
  const MatrixXd K(problem.stiffness), M = dense_mass(problem.inertia);
  if (!(K.trace() > 0) || !(M.trace() > 0)) return {};
  SparseLdlt ldlt;
  const bool held = ldlt.factorise(problem.stiffness);
  const double shift = held ? 0 : K.trace() / M.trace() / static_cast<double>(n * n);
  const SymmetricModes modes_of = symmetric_modes(M, K + shift * M, EigenVectors::none);
  if (!modes_of.found) return {};
  std::vector<double> squares;
  const Index regular = n - problem.inertia.kernel_dimension;
  for (Index i = 0; i < regular && static_cast<int>(squares.size()) < modes; ++i) {
    const double mu = modes_of.values[n - 1 - i];
    if (mu > 0 && 1 / mu - shift > rigid * shift) squares.push_back(1 / mu - shift);
  }
  return squares;
}

/// A square matrix of quadruple precision, row by row.
struct QuadMatrix {
  std::size_t size;
  std::vector<Quad> entry;
  explicit QuadMatrix(std::size_t n) : size(n), entry(n * n, Quad(0)) {}
  Quad& operator()(std::size_t i, std::size_t j) { return entry[i * size + j]; }
  const Quad& operator()(std::size_t i, std::size_t j) const { return entry[i * size + j]; }
};

QuadMatrix product(const QuadMatrix& a, const QuadMatrix& b) {
  QuadMatrix out(a.size);
  for (std::size_t i = 0; i < a.size; ++i)
    for (std::size_t k = 0; k < a.size; ++k)
      for (std::size_t j = 0; j < a.size; ++j) out(i, j) += a(i, k) * b(k, j);
  return out;
}

// amplification() of the mode q'' + ω² q = 0; nothing where S vanishes.
std::optional<QuadMatrix> step(const StepPlan& plan, double square) {
  const std::size_t slots = plan.slots.size();
  const Quad k = square;
  QuadMatrix whole(slots);
  for (std::size_t j = 0; j < slots; ++j) whole(j, j) = 1;
  for (const Stage& stage : plan.stages) {
    std::vector<Quad> unknown(slots, Quad(0));
    if (stage.matrix.M != 0 || stage.matrix.C != 0 || stage.matrix.K != 0) {
      const Quad s = stage.matrix.M + stage.matrix.K * k;
      if (s == 0) return std::nullopt;
      for (std::size_t j = 0; j < stage.history.size(); ++j)
        unknown[j] = (stage.history[j].M + stage.history[j].K * k) / s;
    }
    QuadMatrix map(slots);
    for (std::size_t j = 0; j < slots; ++j) {
      const Combination& update = stage.update[j];
      for (std::size_t i = 0; i < slots; ++i)
        map(j, i) = (i < update.slots.size() ? update.slots[i] : 0.0) + update.z * unknown[i];
    }
    whole = product(map, whole);
  }
  return whole;
}

// Coefficients of det(rI − A), highest power first, by Faddeev and LeVerrier.
std::vector<Quad> characteristic(const QuadMatrix& A) {
  const std::size_t n = A.size;
  std::vector<Quad> c = {Quad(1)};
  QuadMatrix B(n);
  for (std::size_t k = 1; k <= n; ++k) {
    for (std::size_t i = 0; i < n; ++i) B(i, i) += c.back();
    B = product(A, B);
    Quad trace = 0;
    for (std::size_t i = 0; i < n; ++i) trace += B(i, i);
    c.push_back(-trace / Quad(k));
  }
  return c;
}

struct QuadComplex {
  Quad re = 0, im = 0;
};
QuadComplex times(const QuadComplex& a, const QuadComplex& b) {
  return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}

// |r|² − 1 of the root that Newton's iteration finds from `start`; nothing where it finds none.
std::optional<double> squared_excess(const std::vector<Quad>& polynomial, std::complex<double> start) {
  QuadComplex r{start.real(), start.imag()};
  for (int iteration = 0; iteration < 200; ++iteration) {
    QuadComplex value, slope;
    for (const Quad& c : polynomial) {
      slope = times(slope, r);
      slope.re += value.re, slope.im += value.im;
      value = times(value, r);
      value.re += c;
    }
    const Quad size = slope.re * slope.re + slope.im * slope.im;
    if (size == 0) return std::nullopt;
    const QuadComplex move = times(value, {slope.re / size, -slope.im / size});
    r.re -= move.re, r.im -= move.im;
    const Quad moved = abs(move.re) + abs(move.im);
    if (moved > Quad(1e-27) * (abs(r.re) + abs(r.im))) continue;
    const double excess = static_cast<double>(Quad(r.re * r.re + r.im * r.im - 1));
    return excess > -1 && std::isfinite(excess) ? std::optional(excess) : std::nullopt;
  }
  return std::nullopt;
}

// δ of the mode, 1/s.
std::optional<double> decay(const StepPlan& plan, double square, double h) {
  const auto A = step(plan, square);
  if (!A) return std::nullopt;
  const MatrixXd like_units = in_metres(amplification(plan, 1, 0, square), plan, h, 1);
  if (!like_units.allFinite()) return std::nullopt;
  const Eigen::VectorXcd roots = general_modes(like_units, EigenVectors::none).values;
  const std::complex<double> exact = std::polar(1.0, std::sqrt(square) * h);
  const auto* nearest = std::min_element(roots.data(), roots.data() + roots.size(), [&](const auto& a, const auto& b) {
    return std::abs(a - exact) < std::abs(b - exact);
  });
  const auto excess = squared_excess(characteristic(*A), *nearest);
  if (!excess) return std::nullopt;
  return -0.5 * std::log1p(*excess) / h;
}

}  // namespace

std::optional<EquivalentViscosity> equivalent_viscosity(const SemiDiscrete& problem, const StepPlan& undamped_plan,
                                                        double h, int modes) {
  const std::vector<double> squares = squared_pulsations(problem, modes);
  if (squares.empty() || problem.damping.matrix) return std::nullopt;
  std::vector<double> decays;
  double scheme = 0, structure = 0, fourth = 0;
  for (const double square : squares) {
    const auto delta = decay(undamped_plan, square, h);
    if (!delta) return std::nullopt;
    decays.push_back(*delta);
    scheme += 2 * *delta * square;
    structure += problem.damping.rate(square, decays.size() - 1) * square;
    fourth += square * square;
  }
  EquivalentViscosity out{scheme / fourth, structure / fourth, 0, static_cast<int>(squares.size())};
  for (std::size_t i = 0; i < squares.size(); ++i)
    out.misfit = std::max(out.misfit, std::abs(2 * decays[i] / squares[i] - out.numerical));
  return out;
}

}  // namespace ricochet
