#pragma once
#include <Eigen/Core>
#include <ricochet/contract/reference.hpp>
#include <string>
#include <vector>

#include "linear_mode.hpp"

namespace ricochet::reference {

/// Thrown inside a solve, a Refusal outside.
struct Stopped {
  std::string sentence;
};

/// Rows of signals: column k multiplies e^{σ_k t}, and the real part is meant.
using Signals = Eigen::MatrixXcd;

/// Per contact point the sign of its force: +1 on its lower stop, −1 on its upper stop, 0 open.
using ContactSet = std::vector<signed char>;

/// M w'' + C w' + K w = F + Hᵀp, lower ≤ H w ≤ upper, C = αK + ηM; everything that moves is a signal.
struct LinearStructure {
  Eigen::MatrixXd mass, stiffness;  ///< n × n, M may be singular
  Eigen::MatrixXd contact;          ///< H, m × n
  double alpha = 0, eta = 0;        ///< s, 1/s
  double spring = 0;                ///< κ of a compliant stop, N/m; 0: rigid
  std::vector<Complex> exponents;   ///< σ, the first is 0
  Signals force;                    ///< F, n rows
  Signals lower, upper;             ///< m rows; ±∞ in the first column where absent
  Eigen::VectorXd scale;            ///< of the dofs, so that K has a unit diagonal
  double shift = 0;                 ///< s of K + sM, positive definite; 0 where K is

  Eigen::Index dofs() const { return mass.rows(); }
  Eigen::Index points() const { return contact.rows(); }
  Eigen::VectorXcd sigma() const {
    return Eigen::Map<const Eigen::VectorXcd>(exponents.data(), static_cast<Eigen::Index>(exponents.size()));
  }
  Signals rate(const Signals& of) const { return of * sigma().asDiagonal(); }
  Eigen::MatrixXd damping() const { return alpha * stiffness + eta * mass; }
  const Signals& bound(int sign) const { return sign > 0 ? lower : upper; }
  /// The stops of one side as they bound H w at t.
  Eigen::VectorXd bound_at(int sign, double t) const;

  /// Chooses scale and shift.
  void prepare();
};

/// The structure of a problem with its clamp at rest: w = u − φ, so that the clamp's motion is a force and moves the
/// stops. Points without a stop are left out.
LinearStructure structure_of(const ReferenceProblem& problem);

/// φ and φ' of the clamp, m and m/s.
double support_at(const ReferenceProblem& problem, double t);
double support_rate_at(const ReferenceProblem& problem, double t);

/// The modes of (M, K) that keep E w = 0: M-normalised shapes with their λ, and the massless ones, K-normalised. All
/// are K- and M-orthogonal. Found as M x = μ K x, which keeps the digits of the slow ones.
struct Pencil {
  Eigen::MatrixXd shapes;    ///< n × r
  Eigen::VectorXd squares;   ///< λ, r
  Eigen::MatrixXd massless;  ///< n × k
};

/// `stiffness`: K, of the structure or with springs on it; `closed`: E.
Pencil pencil(const LinearStructure& structure, const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& closed);

}  // namespace ricochet::reference
