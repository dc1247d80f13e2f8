#pragma once
#include <Eigen/Core>
#include <ricochet/contract/mass_strategy.hpp>
#include <ricochet/scene/scene.hpp>
#include <string>
#include <vector>

/// \file
/// Beams as they are held: mesh, stiffness and static modes of any supports, sections and masses. Nothing here runs
/// while marching.
namespace ricochet {

/// Places closer than this share of the length are one: decimals of a study are rounded.
inline constexpr double one_place = 1e-9;

/// Those of the beam; of one that gives none, the clamp at 0.
std::vector<BeamSupport> supports_of(const BeamSpec& beam);

/// A length of a beam with one EI (N m²) and one line density (kg/m, added mass included).
struct UniformPart {
  double to = 0;  ///< m
  SectionProperties section;
  double kGA = 0;     ///< N; 0: rigid in shear
  double rotary = 0;  ///< ρI, kg m; 0: none
};
/// In order of x, the last one up to L. Throws InputError as section_properties() does.
std::vector<UniformPart> uniform_parts(const BeamSpec& beam);
/// The part that holds x.
const UniformPart& part_at(const std::vector<UniformPart>& parts, double x);

/// Between two breaks (0, L, supports, ends of sections, masses), n = max(1, round(N ℓ/L)) equal elements.
struct BeamInterval {
  double from = 0, length = 0;  ///< m
  int elements = 0;             ///< n
};
std::vector<BeamInterval> beam_intervals(const BeamSpec& beam, int elements);
/// Nodes of these intervals, x_0 = 0 to exactly L.
std::vector<double> beam_nodes(const BeamSpec& beam, int elements);

/// Dofs (w, w') node by node, those that a support holds left out: half-bandwidth 3. Of two planes: planes.hpp.
FiniteElementSpace beam_space(const BeamSpec& beam, int elements);

/// K_ij = ∫EI φ_i''φ_j'' + T φ_i'φ_j' + k_f φ_iφ_j dx + springs of elastic supports (n × n, both triangles), on a space
/// of this beam.
SparseMatrix beam_stiffness(const BeamSpec& beam, const FiniteElementSpace& space);

/// Rigid motions that nothing holds: w = 1, and w = x − x₀.
struct RigidFreedom {
  bool translates = false, turns = false;
  bool held() const { return !translates && !turns; }
};
RigidFreedom rigid_freedom(const BeamSpec& beam);

/// See SemiDiscrete.
struct StaticModes {
  std::vector<std::string> supports;
  Eigen::MatrixXd modes, loads;
};
/// K ψ_j = −K_fs e_j and s_j = M ψ_j + M_fs e_j with the consistent mass, e_j a displacement 1 of support j (of an
/// elastic one, of the ground end of its springs; its rotation stays 0). A foundation's ground stays at rest. Where one
/// support alone holds a beam that turns, ψ is the translation. Of two planes: supports along y, then along z.
StaticModes static_modes(const BeamSpec& beam, int elements);

/// The least compression (N, above 0) at which K is not positive definite, on a mesh of at most 100 elements: the first
/// λ of K₀ φ = λ G φ, G = ∫φ'φ'. 0 where nothing keeps the beam from turning; infinite where nothing bends.
double buckling_load(const BeamSpec& beam, int elements);

/// Throws InputError at /scene/structure/… for supports, sections and masses outside of the beam or twice at one place,
/// and for numbers out of range. The same for a tension beyond the first buckling load, and supports that hold every
/// dof.
void check_beam(const BeamSpec& beam, int elements);

}  // namespace ricochet
