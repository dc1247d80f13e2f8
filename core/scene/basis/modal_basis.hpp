#pragma once
#include <Eigen/Core>
#include <memory>
#include <ricochet/contract/contact_law.hpp>
#include <ricochet/contract/mass_strategy.hpp>
#include <ricochet/scene/scene.hpp>
#include <vector>

namespace ricochet {

/// The slowest modes of a structure and, beside them, the static shapes of its stops that these leave out:
///
///     q = Q q̂ = Φ η + Ψ V Λ⁻¹ ζ,     K Ψ = Hᵀ − M Φ (HΦ)ᵀ,     R = H Ψ = V Λ Vᵀ
///     K̂ = diag(Ω², Λ⁻¹),     Ĥ = [HΦ, V],     M̂ = diag(1, Λ⁻¹ VᵀΨᵀMΨV Λ⁻¹)
///
/// R is the residual flexibility at the stops (MacNeal 1971, A hybrid method of component mode synthesis, Computers &
/// Structures 1, 581-601): with it, a static force at a stop moves the stop as in the whole structure. Ψ is solved for
/// its own load, which no mode carries: as a difference of flexibilities R loses its digits. Points whose R_ii is below
/// 1e-12 of their flexibility, and directions of R below 1e-12 of its largest, have no shape.
struct ModalBasis {
  Eigen::MatrixXd shapes;       ///< Q, n × n̂, modes first
  Eigen::VectorXd stiffness;    ///< diagonal of K̂, n̂
  SparseMatrix mass;            ///< M̂, n̂ × n̂
  Eigen::MatrixXd at_points;    ///< Ĥ, m × n̂
  int modes = 0;                ///< N; the other n̂ − N coordinates are those of stops
  Eigen::VectorXd squares;      ///< ω² of the modes, N
  Eigen::VectorXd left_out;     ///< R_ii, m/N, whether or not a shape holds it
  Eigen::VectorXd flexibility;  ///< (HK⁻¹Hᵀ)_ii, m/N; of a structure that moves rigidly that of its elastic modes

  /// Of several bodies, that of each: modes of all bodies stand first, then the coordinates of stops.
  struct Part {
    int first = 0;  ///< its first dof
    std::shared_ptr<const ModalBasis> basis = {};
    SparseMatrix mass = {};
    SparseRows contact = {};      ///< of all stops, on its dofs
    std::vector<int> where = {};  ///< where its coordinates stand
  };
  std::vector<Part> parts = {};  ///< empty: one structure

  int dofs() const { return static_cast<int>(shapes.cols()); }
  /// The coordinates ζ.
  std::vector<int> stops() const {
    std::vector<int> out;
    for (int i = modes; i < dofs(); ++i) out.push_back(i);
    return out;
  }
};

/// Throws InputError at /mesh/modes for more modes than have mass.
ModalBasis modal_basis(const SparseMatrix& stiffness, const SparseMatrix& mass, const SparseRows& contact,
                       bool definite, const BasisSpec& spec);

/// A displacement (n) in the coordinates of the basis: η = ΦᵀM v, and the ζ with which the stops are where v has them,
/// Vᵀ(H v − HΦ η). For contact (m × n) and mass as the basis was made of.
Eigen::VectorXd in_basis(const ModalBasis& basis, const SparseMatrix& mass, const SparseRows& contact,
                         const Eigen::VectorXd& displacement);
/// The same by least squares over all dofs, (QᵀQ)⁻¹Qᵀ v.
Eigen::VectorXd in_basis_by_least_squares(const ModalBasis& basis, const Eigen::VectorXd& displacement);

}  // namespace ricochet
