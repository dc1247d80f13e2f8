#include <ricochet/contract/mass_strategy.hpp>
#include <ricochet/contract/plugin.hpp>

#include "without_inertia.hpp"

namespace {

using namespace ricochet;
using Triplets = std::vector<Eigen::Triplet<double>>;

SparseMatrix assemble(int rows, int columns, const Triplets& entries) {
  SparseMatrix matrix(rows, columns);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

/// Velocities in a poorer space than displacements: M = Bᵀ C_v⁻¹ B, B_ij = ∫ρS ψ_i φ_j, C_v = ∫ρS ψψ.
/// A point mass m at dof j is one more velocity of its own. It adds a row m e_jᵀ to B and an entry m to C_v, hence
/// m e_j e_jᵀ to M.
class Singular : public MassStrategy {
 public:
  explicit Singular(bool continuous) : continuous_(continuous) {}

  InertiaOrRefusal build(const FiniteElementSpace& space) const override {
    if (space.given) return ricochet::massless_residual(*space.given);
    if (space.elements.empty())
      return Refusal{"a singular mass needs elements to spread velocities over, and this " + space.structure +
                     " has none: use the mass consistent or lumped"};
    if (continuous_ && space.basis == FiniteElementSpace::Basis::linear)
      return Refusal{"velocities P1 are the displacement space of this " + space.structure +
                     ", whose mass would be the consistent one: use velocity P0, or the mass consistent"};
    if (auto refusal = refuse_rotary_inertia(space)) return *refusal;
    if (continuous_) return factored(space);
    return assembled(space);
  }

  bool takes_modes() const override { return true; }

 private:
  /// P1: hat functions at the nodes, without those where the displacement is imposed. C_v⁻¹ is full: M stays in
  /// factors.
  static InertiaOrRefusal factored(const FiniteElementSpace& space) {
    const int elements = static_cast<int>(space.elements.size());
    const int points = static_cast<int>(space.point_masses.size());
    std::vector<int> number(static_cast<std::size_t>(elements) + 1, -1);
    int velocities = 0;
    for (int node = 0; node <= elements; ++node)
      if ((node < elements ? space.elements[node].dof[0] : space.elements.back().dof[2]) >= 0)
        number[node] = velocities++;
    Triplets coupling, velocity_mass;
    for (int e = 0; e < elements; ++e) {
      const auto& element = space.elements[e];
      const double mass = element.line_density * element.length;
      if (number[e] < 0 && number[e + 1] < 0)
        return Refusal{"no velocity P1 is left on an element of this " + space.structure +
                       " whose two nodes are held: use more elements, velocity P0, or the mass consistent"};
      for (int end = 0; end < 2; ++end) {
        const int row = number[e + end];
        if (row < 0) continue;
        for (int other = 0; other < 2; ++other)
          if (const int column = number[e + other]; column >= 0)
            velocity_mass.emplace_back(row, column, mass / (end == other ? 3 : 6));
        for (int a = 0; a < space.functions(); ++a) {
          if (element.dof[a] < 0) continue;
          double integral = 0;
          for (const auto& [xi, weight] : gauss_points())
            integral += weight * (end == 0 ? 1 - xi : xi) * shape_values(space.basis, element, xi)[a];
          coupling.emplace_back(row, element.dof[a], mass * integral);
        }
      }
    }
    for (int i = 0; i < points; ++i) {
      coupling.emplace_back(velocities + i, space.point_masses[i].dof, space.point_masses[i].mass);
      velocity_mass.emplace_back(velocities + i, velocities + i, space.point_masses[i].mass);
    }
    Inertia inertia;
    inertia.coupling = assemble(velocities + points, space.dofs, coupling);
    inertia.velocity_mass = assemble(velocities + points, velocities + points, velocity_mass);
    inertia.kernel_dimension = space.dofs - row_rank(inertia.coupling);
    return inertia;
  }

  /// P0: one velocity per element, C_v = diag(ρSℓ), so M = Σ_e b_e b_eᵀ/(ρSℓ) with b_e = ρS∫φ: as sparse as K.
  static Inertia assembled(const FiniteElementSpace& space) {
    const int elements = static_cast<int>(space.elements.size());
    Triplets coupling, mass;
    for (int e = 0; e < elements; ++e) {
      const auto& element = space.elements[e];
      const double weight_of_element = element.line_density * element.length;
      std::array<double, 4> mean{};
      for (const auto& [xi, weight] : gauss_points())
        for (int a = 0; a < space.functions(); ++a) mean[a] += weight * shape_values(space.basis, element, xi)[a];
      for (int a = 0; a < space.functions(); ++a) {
        if (element.dof[a] < 0) continue;
        coupling.emplace_back(e, element.dof[a], weight_of_element * mean[a]);
        for (int b = 0; b < space.functions(); ++b)
          if (element.dof[b] >= 0)
            mass.emplace_back(element.dof[a], element.dof[b], weight_of_element * (mean[a] * mean[b]));
      }
    }
    int row = elements;
    for (const auto& point : space.point_masses) {
      coupling.emplace_back(row++, point.dof, point.mass);
      mass.emplace_back(point.dof, point.dof, point.mass);
    }
    Inertia inertia;
    inertia.mass = assemble(space.dofs, space.dofs, mass);
    inertia.kernel_dimension = space.dofs - row_rank(assemble(row, space.dofs, coupling));
    return inertia;
  }

  bool continuous_;
};

void register_singular(Registry& registry) {
  PluginManual manual;
  manual.name = "singular";
  manual.summary = "velocities in a poorer space, so that contact points carry no inertia: M = Bᵀ C_v⁻¹ B";
  manual.text =
      R"(Displacements keep their space, velocities live in P1 (continuous, zero where the displacement is imposed) or
          P0 (one per element), tied to it by B_ij = ∫ρS ψ_i φ_j and C_v = ∫ρS ψψ. For Hermite elements Ker M has one
          dimension per element and can carry the contact: an impact then moves no mass and destroys no energy.
          Frequencies converge with order 4 (P1) and 2 (P0). Initial data that do not satisfy Zᵀ(K q − F) = 0, Z = Ker
          M, lose energy in the first steps: see the scene's projection. P1 must vanish at the clamp, and
          discontinuous P1 or P2 velocities fail the rank condition of contact at all nodes. A point mass keeps its
          inertia. Of a structure in modes, the residual flexibility of its stops has no mass.)";
  manual.source =
      R"(Renard 2010, The singular dynamic method for constrained second order hyperbolic equations, J. Comput. Appl.
          Math. 234, 906-923; after Khenous, Laborde, Renard 2008, Mass redistribution method for finite element
          contact problems in elastodynamics, Eur. J. Mech. A/Solids 27, 918-932)";
  manual.parameters = {
      word_parameter("velocity", {"P1", "P0"}, "P1",
                     "the space of velocities ψ: P1 continuous piecewise linear, P0 piecewise constant")};
  registry.add_mass(std::move(manual), [](const Parameters& parameters) {
    return std::make_unique<Singular>(parameters.word("velocity") == "P1");
  });
}

}  // namespace

RICOCHET_PLUGIN(mass, singular, register_singular)
