#include "linear_structure.hpp"

#include <cmath>
#include <ricochet/kernels/dense_solvers.hpp>
#include <ricochet/kernels/eigenvalues.hpp>

namespace ricochet::reference {

void LinearStructure::prepare() {
  const auto rescale = [&](double by) {
    shift = by;
    scale = (stiffness + by * mass).diagonal().cwiseSqrt().cwiseInverse();
  };
  const double total = std::max(stiffness.trace(), 0.0);
  if (stiffness.diagonal().minCoeff() > 0) {
    rescale(0);
    const Eigen::MatrixXd unit = scale.asDiagonal() * stiffness * scale.asDiagonal();
    if (symmetric_modes(unit, EigenVectors::none).values[0] > 1e-12) return;
  }
  rescale(total > 0 ? total / mass.trace() : 1);
  // Rigid motions are known now; the slowest other mode is a better shift than the average.
  double slowest = shift;
  for (const double square : pencil(*this, stiffness, Eigen::MatrixXd(0, dofs())).squares)
    if (square > 1e-8 * shift) slowest = std::min(slowest, square);
  rescale(slowest);
}

Eigen::VectorXd LinearStructure::bound_at(int sign, double t) const {
  Eigen::VectorXd result = bound(sign).col(0).real();
  for (Eigen::Index k = 1; k < force.cols(); ++k)
    result += (bound(sign).col(k) * std::exp(exponents[static_cast<std::size_t>(k)] * t)).real();
  return result;
}

LinearStructure structure_of(const ReferenceProblem& problem) {
  const DiscreteProblem& discrete = *problem.discrete;
  const Eigen::Index n = discrete.mass.rows();
  LinearStructure structure;
  structure.mass = discrete.mass;
  structure.stiffness = discrete.stiffness;
  structure.alpha = problem.damping_stiffness;
  structure.eta = problem.damping_mass;
  structure.spring = problem.contact_absent ? 0 : problem.contact_stiffness;
  std::vector<Eigen::Index> stopped;
  for (Eigen::Index i = 0; i < (problem.contact_absent ? 0 : discrete.contact.rows()); ++i)
    if (std::isfinite(discrete.lower[i]) || std::isfinite(discrete.upper[i])) stopped.push_back(i);
  structure.contact = discrete.contact(stopped, Eigen::all);
  const Eigen::Index m = structure.points();

  const Complex support = std::polar(problem.support_amplitude, problem.support_phase - M_PI / 2);
  const Complex push =
      std::polar(std::abs(problem.force_amplitude), problem.force_phase + (problem.force_amplitude < 0 ? M_PI : 0));
  structure.exponents = {0};
  const auto column = [&](double pulsation) -> Eigen::Index {
    if (pulsation == 0) return 0;
    structure.exponents.push_back({0, pulsation});
    return static_cast<Eigen::Index>(structure.exponents.size()) - 1;
  };
  const Eigen::Index moved = problem.support_amplitude != 0 ? column(problem.support_pulsation) : 0;
  const Eigen::Index pushed = problem.force_amplitude != 0 ? column(problem.force_pulsation) : 0;
  const auto signals = static_cast<Eigen::Index>(structure.exponents.size());
  structure.force = Signals::Zero(n, signals);
  structure.lower = Signals::Zero(m, signals);
  structure.upper = Signals::Zero(m, signals);
  // An oscillator's load may come with its harmonic force inside: read apart.
  if (problem.structure == "oscillator") {
    if (!problem.load_zero && problem.load) structure.force(0, 0) += problem.load(0, 0);
    structure.force(0, pushed) += pushed == 0 ? push.real() : push;
  } else if (!problem.load_zero) {
    structure.force.col(0) += discrete.load_constant;
  }
  const double pulsation = problem.support_pulsation;
  if (moved > 0) structure.force.col(moved) += pulsation * pulsation * support * discrete.support_shape;
  if (m > 0) {
    structure.lower.col(0) = discrete.lower(stopped).cast<Complex>();
    structure.upper.col(0) = discrete.upper(stopped).cast<Complex>();
    for (Signals* bound : {&structure.lower, &structure.upper})
      bound->col(moved).array() -= moved == 0 ? Complex(support.real()) : support;
  }
  structure.prepare();
  return structure;
}

double support_at(const ReferenceProblem& problem, double t) {
  return problem.support_amplitude * std::sin(problem.support_pulsation * t + problem.support_phase);
}

double support_rate_at(const ReferenceProblem& problem, double t) {
  return problem.support_amplitude * problem.support_pulsation *
         std::cos(problem.support_pulsation * t + problem.support_phase);
}

Pencil pencil(const LinearStructure& structure, const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& closed) {
  const Eigen::Index n = structure.dofs(), a = closed.rows();
  const Eigen::MatrixXd whole = stiffness + structure.shift * structure.mass;
  // Springs may be far stiffer than the structure: the dof they act on is scaled by them.
  const Eigen::VectorXd scale = whole.diagonal().cwiseSqrt().cwiseInverse();
  const auto S = scale.asDiagonal();
  const Eigen::MatrixXd M = S * structure.mass * S, K = S * whole * S;
  Eigen::MatrixXd kept = Eigen::MatrixXd::Identity(n, n);
  if (a > 0) {
    const Eigen::MatrixXd across = (closed * S).transpose();
    kept = householder_basis(across).rightCols(n - a);
  }
  Pencil result;
  result.shapes.resize(n, 0);
  result.massless.resize(n, 0);
  if (kept.cols() == 0) return result;
  // The kernel is judged where springs have no part in it.
  const Eigen::VectorXd ratio = scale.cwiseQuotient(structure.scale);
  const Eigen::MatrixXd plain = householder_columns(ratio.asDiagonal() * kept);
  const auto P = structure.scale.asDiagonal();
  const Eigen::MatrixXd light = P * structure.mass * P;
  const SymmetricModes inertia = symmetric_modes(plain.transpose() * light * plain);
  const Eigen::Index k = (inertia.values.array() <= 1e-11 * light.diagonal().maxCoeff()).count();
  if (k > 0) {
    const Eigen::MatrixXd Z = ratio.cwiseInverse().asDiagonal() * (plain * inertia.vectors.leftCols(k));
    const Eigen::MatrixXd massless = cholesky_forward(Z.transpose() * K * Z, Z.transpose()).transpose();
    result.massless = S * massless;
    const Eigen::MatrixXd pulled = kept.transpose() * (K * massless);
    const Eigen::MatrixXd turned = householder_basis(pulled);
    kept = (kept * turned.rightCols(kept.cols() - k)).eval();
  }
  if (kept.cols() == 0) return result;
  const SymmetricModes moving = symmetric_modes(kept.transpose() * M * kept, kept.transpose() * K * kept);
  const Eigen::VectorXd mu = moving.values;
  result.shapes = S * (kept * (moving.vectors * mu.cwiseSqrt().cwiseInverse().asDiagonal()));
  result.squares = mu.cwiseInverse().array() - structure.shift;
  for (double& square : result.squares)
    if (square < 1e-9 * structure.shift) square = 0;
  return result;
}

}  // namespace ricochet::reference
