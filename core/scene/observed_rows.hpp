#pragma once
#include <ricochet/contract/contact_law.hpp>
#include <ricochet/contract/mass_strategy.hpp>
#include <string>
#include <vector>

namespace ricochet {

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
/// Throws InputError for tangents that the structure or the place of their stop does not have.
void check_tangents(const SceneSpec& scene, const FiniteElementSpace& space);

/// Fills points and tangents of a problem whose supports and motions are known.
void observe_rows(const SceneSpec& scene, SemiDiscrete& problem);

}  // namespace ricochet
