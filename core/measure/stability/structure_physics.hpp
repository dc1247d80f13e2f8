#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>
#include <ricochet/contract/contact_law.hpp>
#include <ricochet/scene/semi_discrete.hpp>
#include <string>
#include <variant>
#include <vector>

/// \file
/// What a structure is before any step is chosen, so that a slip of units is seen.
namespace ricochet {

/// What stops do is not asked: no contact at all.
class NoContact final : public ContactLaw {
 public:
  bool absent() const override { return true; }
  void prepare(int, std::span<const Parameters>) override {}
  void solve(ReducedProblem&) override {}
};

/// Above so many dofs, modes cost more than marching.
constexpr int most_modal_dofs = 1200;

/// Modes of M φ = μ K φ, slowest first, those of Ker M last.
struct StructureModes {
  Eigen::MatrixXd shapes;  ///< one column per mode
  Eigen::VectorXd mass, stiffness;
  int regular = 0;  ///< modes with mass

  /// `kernel`: the dimension of Ker M; `free`: K is singular.
  StructureModes(const Eigen::MatrixXd& M, const Eigen::MatrixXd& K, int kernel, bool free);

  int size() const { return static_cast<int>(mass.size()); }
  /// rad/s; 0 on Ker M.
  double pulsation(int i) const { return i < regular ? std::sqrt(std::max(0.0, stiffness[i] / mass[i])) : 0.0; }
  std::string name(int i) const;
};

/// The modes of a problem whose contact is open.
StructureModes open_modes(const SemiDiscrete& problem);
/// Those of the structure with H_J q = 0; `free`: without this, K is singular.
StructureModes held_modes(const SemiDiscrete& problem, const std::vector<int>& points, bool free);

/// The longest period of the structure with open contact, s: 2π/ω, ω² = xᵀKx/xᵀMx after two steps of inverse iteration
/// with K. That is at least ω₁², so the period is at most the true one. Nothing where K has no inverse, and of more dofs
/// than modes are found of.
std::optional<double> slowest_period(const SemiDiscrete& problem);

/// A number of the structure, in SI units.
struct PhysicalNumber {
  const char* symbol;
  double value = 0;
  const char* unit;
};

struct StructurePhysics {
  std::string structure;                ///< "beam", "oscillator", "bar"
  std::vector<PhysicalNumber> numbers;  ///< what follows from it: kGA, dofs, rigid motions
  int elements = 0;                     ///< of the mesh whose modes these are
  std::vector<double> pulsations;  ///< ω_i of M φ ω² = K φ, open, slowest first, rad/s; Ker M has no part in them
  Damping damping;                 ///< α, η
  /// Of a beam with breaks, supports or two planes, lines on its rigid motions, its mesh and its dofs. Of given
  /// matrices, their supports. Then lines on a basis of modes, and one on what static modes sum to.
  std::vector<std::string> details;
  /// 1/(h K⁻¹ hᵀ) of each contact point, N/m: the force that moves it by 1 m at rest. Empty where K has no inverse, or
  /// where there are many points.
  std::vector<double> point_stiffness;
  /// R_ii of each contact point, m/N: what the modes of a basis leave out of its flexibility. Empty without a basis.
  std::vector<double> left_out;

  /// ζ_i = (αω_i + η/ω_i)/2 of C = αK + ηM; nothing where nothing is damped, or for a rigid motion.
  std::optional<double> damping_ratio(std::size_t mode) const;
  /// How many modes have `steps_per_period` or more steps of h in their period, 2π/(ω h).
  int resolved(double h, double steps_per_period) const;
};

/// The structure of a scene on `elements` elements, or on fewer where modes would cost more than looking at a plan may.
/// A mass that does not apply is a Refusal. Throws as discretise() does.
std::variant<StructurePhysics, Refusal> structure_physics(const SceneSpec& scene, int elements,
                                                          const MassStrategy& mass);

}  // namespace ricochet
