#pragma once
#include <optional>
#include <ricochet/scene/files/csv_file.hpp>
#include <ricochet/scene/structure/assembled_structure.hpp>

namespace ricochet {

/// What a structure in modes is described by. Names of points are those of the first column.
struct ModalFiles {
  CsvFile modes;   ///< mode, frequency (Hz), mass (kg; kg m² of a mode of rotations), damping (ratio)
  CsvFile shapes;  ///< point, then a column for each mode by its number: displacements of points, pushes of supports
  std::optional<CsvFile> residual;       ///< point, then a column for each of these points: flexibility, m/N
  std::optional<CsvFile> residual_mass;  ///< the same points: inertia of the static shapes, kg
  std::optional<CsvFile> static_modes;   ///< point, then a column for each support: displacement while it moves by 1
};

/// The structure of modes in its own coordinates, q = (η, ζ), slowest mode first:
///
///     K = diag(m_k ω_k², Λ⁻¹),   M = diag(m_k, Vᵀ M_r V),   u(point i) = Σ_k Φ_ik η_k + Σ_l V_il ζ_l
///
/// with R = V Λ Vᵀ the residual flexibility and M_r its mass. A row of `shapes` called like a support, which
/// `static_modes` names, is its participation Φᵀ(Mψ_j + M_fs e_j) in kg. `ratios` receives the damping of the elastic
/// modes. Throws FileError for counts that differ, modes that stand twice or miss, frequencies below 0, masses not
/// above 0, ratios not in ]−1, 1[, a residual that is not symmetric or not positive semidefinite, unknown points.
AssembledStructure modal_structure(const ModalFiles& files, std::vector<double>& ratios);

}  // namespace ricochet
