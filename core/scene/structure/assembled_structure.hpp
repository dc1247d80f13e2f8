#pragma once
#include <Eigen/Core>
#include <map>
#include <memory>
#include <optional>
#include <ricochet/scene/files/text_file.hpp>
#include <ricochet/scene/place.hpp>
#include <string>
#include <vector>

namespace ricochet {

class SparseFactor;

struct JoinedBodies;

/// What an assembled structure is made of: matrices over all dofs of the table, held ones too.
struct AssembledFiles {
  std::string stiffness_name, mass_name;  ///< of files, for sentences
  FileMatrix stiffness, mass;             ///< K (N/m), M (kg)
  std::string damping_name = {};          ///< empty: none
  FileMatrix damping = {};                ///< C, N s/m
  DofTable table;
  double length_unit = 1;  ///< m: K and M of a consistent mm–t–s model have 0.001
  /// How the dofs follow a support whose held dofs the matrices do not have any more. It is ψ by dof, from 1, in units
  /// of the files; those left out are 0.
  struct Influence {
    std::string support, file;
    std::vector<std::pair<int, double>> values;
  };
  std::vector<Influence> influences = {};
};

/// What a structure in modes has in the place of nodes (modal_structure()).
struct ModalPart {
  int modes = 0;                   ///< the first dofs; those after them belong to the residual flexibility
  std::vector<int> attached = {};  ///< these
  bool attached_mass = true;       ///< whether the mass says what inertia they have
  std::map<std::string, PlaceRow> points = {};
};

/// A structure given by its matrices, held dofs eliminated: n free dofs, r supports that may move,
///
///     M q'' + K q = F − Σ_j s_j φ_j'',     w = q + Σ_j ψ_j φ_j,     K ψ_j = −K_fs e_j,     s_j = M ψ_j + M_fs e_j
///
/// with e_j = 1 on the displacements that support j holds, 0 on its rotations. Of a support that is given by its
/// influence ψ, s = M ψ. Dofs stand in the order that makes the
/// band narrow (reverse Cuthill–McKee, where it is narrower than the order of the file).
struct AssembledStructure {
  std::string stiffness_name, mass_name, table_name;
  int held_dofs = 0;
  bool definite = true;                        ///< whether K is positive definite: no rigid motion
  int half_width = 0;                          ///< largest |i − j| of the entries of K and M
  SparseMatrix stiffness;                      ///< K, n × n, both triangles
  std::shared_ptr<const SparseFactor> factor;  ///< of K, held for all who factorise it; null: a narrow band, or none
  SparseMatrix mass;                           ///< M, n × n, both triangles, positive semidefinite
  SparseMatrix damping;                        ///< C of a file, n × n, both triangles; empty: none
  std::vector<DofName> names;                  ///< of the free dofs, in their order here; places in m
  GivenMass dofs_known;                        ///< of the free dofs, for mass strategies; its matrices are empty
  std::vector<std::string> supports;
  Eigen::MatrixXd static_modes;   ///< ψ, n × r
  Eigen::MatrixXd support_loads;  ///< s (kg), n × r
  std::vector<std::string> notes;

  /// Of a dof of the file, from 1: its number here where it is free. A held dof has −1 and the number of its support,
  /// or −1 where it is fixed.
  struct Where {
    int free = -1, support = -1;
  };
  std::vector<Where> where;
  /// Dofs of each node of the file, by component, numbered from 1; its place.
  struct Node {
    std::map<std::string, int> dofs;
    std::array<double, 3> place{};
  };
  std::map<std::string, Node> nodes;
  std::vector<std::pair<int, int>> links =
      {};                               ///< pairs of nodes, by their order in `nodes`, that K joins; to be drawn
  std::optional<ModalPart> modes = {};  ///< of a structure in modes
  std::shared_ptr<const JoinedBodies> joined = {};  ///< of several bodies (bodies.hpp); their places are the bodies'

  int dofs() const { return static_cast<int>(names.size()); }
  /// The displacement at a place. Throws InputError, its pointer below `pointer`, for a place that is not there, with
  /// the nearest name.
  PlaceRow row(const Place& place, const std::string& pointer) const;
};

/// Checks the matrices and makes the structure. Throws FileError for an asymmetry above 1e-10, an indefinite matrix, no
/// dof that can move, or one that nothing holds or moves. The same for components without a unit of length, and
/// supports of a structure that they do not hold.
AssembledStructure assemble_structure(const AssembledFiles& files);

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
/// `static_modes` names, is its participation s_j = Φᵀ(Mψ_j + M_fs e_j) in kg. Of ψ_j the modes carry m⁻¹ s_j, a point
/// the rest. `ratios` receives the damping of the elastic modes. Throws FileError for counts that differ, modes that
/// stand twice or miss, and unknown points. The same for frequencies below 0, masses not above 0 and ratios not in
/// ]−1, 1[. A residual must be symmetric and positive semidefinite.
AssembledStructure modal_structure(const ModalFiles& files, std::vector<double>& ratios);

}  // namespace ricochet
