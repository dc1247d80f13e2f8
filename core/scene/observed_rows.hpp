#pragma once
#include <ricochet/contract/contact_law.hpp>
#include <ricochet/contract/mass_strategy.hpp>
#include <string>
#include <vector>

namespace ricochet {

struct DiscreteProblem;
struct SceneSpec;
struct SemiDiscrete;

/// Rows that are read and never pushed: displacements of points, and motions along the surface of a stop. The value of
/// row i is R_i q + a_i φ + Σ_j A_ij φ_j, φ the harmonic motion of all supports, φ_j those by histories; m.
struct ObservedRows {
  std::vector<std::string> names;
  SparseRows rows;             ///< R, k × n
  Eigen::VectorXd on_support;  ///< a, k
  Eigen::MatrixXd on_motions;  ///< A, k × r

  int count() const { return static_cast<int>(names.size()); }
};

/// Throws InputError for names that are none or stand twice, also beside stops, and for places that are not there.
void check_points(const SceneSpec& scene, const FiniteElementSpace& space);
/// Fills points and tangents of a problem whose supports and motions are known.
void observe_rows(const SceneSpec& scene, SemiDiscrete& problem);

/// The problem as references of the semi-discrete problem are given it. It has the matrices that a method would march,
/// dense, and rows that give w and its strain at `places` (x, m). A load that depends on t is given by its value at 0.
DiscreteProblem discrete_problem(const SemiDiscrete& problem, const std::vector<double>& places);

/// The displacement at `places` (x, m) as rows (places × n); of matrices that are given, which have no x, that of the
/// tip.
SparseRows place_rows(const SemiDiscrete& problem, const std::vector<double>& places);

/// The strains that the elastic energy integrates, at `places` (x, m), as rows (places × n); zero without elements.
SparseRows strain_rows(const SemiDiscrete& problem, const std::vector<double>& places);

}  // namespace ricochet
