#pragma once
#include <Eigen/Cholesky>
#include <optional>
#include <ricochet/contract/contact_law.hpp>
#include <ricochet/contract/mass_strategy.hpp>
#include <ricochet/kernels/quadratic_form.hpp>
#include <vector>

namespace ricochet {

/// The massless part of a structure: Ker M of a singular mass (n × n), with what K makes of it.
///
/// Up to 400 dofs by a dense basis Z of Ker M, δ = Z (ZᵀKZ)⁻¹ Zᵀ r. Beyond, in O(n), by the iteration (1). With
/// S = K + σM, σ a thousand times the largest K_ii/M_ii,
///
///     δ₁ = S⁻¹ r,    δ_{k+1} = S⁻¹ K δ_k                                                                        (1)
///
/// keeps what lies in Ker M, where S is K. Of a mode of pulsation ω it takes all but ω²/(ω² + σ). It ends when nothing
/// is left but round-off. (The method of multipliers for: least ½δᵀKδ − rᵀδ where Mδ = 0.) M is not formed.
class MasslessPart {
 public:
  MasslessPart(const SparseMatrix& stiffness, const Inertia& inertia);

  /// The δ in Ker M that answers to a load r (n): zᵀ(Kδ − r) = 0 for every z in Ker M.
  Eigen::VectorXd response(const Eigen::VectorXd& load) const;
  /// ½ rᵀδ (J).
  double energy(const Eigen::VectorXd& load) const;

 private:
  const SparseMatrix& stiffness_;
  Eigen::MatrixXd basis_;  // Z, of few dofs
  std::optional<Eigen::LLT<Eigen::MatrixXd>> reduced_;
  std::optional<InverseForm> shifted_;  // S, of many
};

/// Where contact points stand when the force of a compliant law is asked: m × lanes, lanes contiguous. Bounds are as
/// the law sees them, its layer included.
struct StandingPoints {
  int points = 0, lanes = 0;
  const double* place = nullptr;
  const double *lower = nullptr, *upper = nullptr;
  std::vector<int> circles = {};  ///< first rows of clearances met as circles
  const double* rate = nullptr;   ///< null: at rest
  double* memory = nullptr;       ///< of the law, which it may change; null: one that has seen nothing, and is not kept
};

/// The efforts p (m × lanes, N) of a compliant law that was sized for these points, whatever moves them. They are zero
/// in a lane where the law has none that is finite. For set-up: allocates.
std::vector<double> standing_force(ContactLaw& law, const StandingPoints& at);

}  // namespace ricochet
