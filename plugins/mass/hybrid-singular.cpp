#include <algorithm>
#include <ricochet/contract/mass_strategy.hpp>
#include <ricochet/contract/plugin.hpp>

#include "without_inertia.hpp"

namespace {

using namespace ricochet;
using Triplets = std::vector<Eigen::Triplet<double>>;

SparseMatrix assembled(int rows, int columns, const Triplets& entries) {
  SparseMatrix matrix(rows, columns);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

/// Displacements, velocities v = Σ ψ^v_i v_i and momenta tied weakly, ∫ψ^p_i (u̇ − v) = 0:
///
///     M = Bᵀ C B,     B = Y⁻¹A,  A_ij = ∫ψ^p_i φ_j,  Y_ij = ∫ψ^p_i ψ^v_j,  C_ij = ∫ρS ψ^v_i ψ^v_j
///
/// ψ^v are hat functions at the nodes, ψ^p their duals (on an element 2−3ξ and 3ξ−1), so that Y = diag(∫ψ^v) and M is
/// sparse. There is none where the displacement is imposed, nor, with linear displacements, at a node that may touch a
/// stop: there the hat of its neighbour is extended by 1 over their element, which keeps Σψ^v = 1, hence the total
/// mass.
class HybridSingular : public MassStrategy {
 public:
  bool takes_modes() const override { return true; }
  InertiaOrRefusal build(const FiniteElementSpace& space) const override {
    if (space.given) return massless_residual(*space.given);
    if (space.elements.empty())
      return Refusal{"the hybrid-singular mass needs elements to spread velocities over, and this " + space.structure +
                     " has none: use the mass consistent or lumped"};
    if (auto refusal = refuse_rotary_inertia(space)) return *refusal;
    const bool hermite = space.basis == FiniteElementSpace::Basis::hermite;
    const int elements = static_cast<int>(space.elements.size());
    // The number of the velocity at each node.
    std::vector<int> velocity(static_cast<std::size_t>(elements) + 1, -1);
    std::vector<bool> touched(velocity.size());
    int count = 0;
    for (int node = 0; node <= elements; ++node) {
      const int dof = node < elements ? space.elements[node].dof[0] : space.elements.back().dof[hermite ? 2 : 1];
      touched[node] =
          !hermite && std::binary_search(space.contact_dofs.begin(), space.contact_dofs.end(), dof) && dof >= 0;
      if (dof >= 0 && !touched[node]) velocity[node] = count++;
    }
    Triplets coupling, mass;
    Eigen::VectorXd width = Eigen::VectorXd::Zero(count);
    for (int e = 0; e < elements; ++e) {
      const auto& element = space.elements[e];
      if (velocity[e] < 0 && velocity[e + 1] < 0)
        return Refusal{"no velocity is left on an element of this " + space.structure +
                       " whose two nodes touch a stop or are fixed: leave a free node between them, or use the mass "
                       "consistent"};
      for (const auto& [xi, weight] : gauss_points()) {
        const auto phi = shape_values(space.basis, element, xi);
        const std::array<double, 2> dual{2 - 3 * xi, 3 * xi - 1};
        const std::array<double, 2> hat{touched[e + 1] ? 1 : 1 - xi, touched[e] ? 1 : xi};
        const double length = weight * element.length;
        for (int s = 0; s < 2; ++s) {
          const int row = velocity[e + s];
          if (row < 0) continue;
          width[row] += length * hat[s] * dual[s];
          for (int a = 0; a < space.functions(); ++a)
            if (element.dof[a] >= 0) coupling.emplace_back(row, element.dof[a], length * dual[s] * phi[a]);
          for (int t = 0; t < 2; ++t)
            if (velocity[e + t] >= 0)
              mass.emplace_back(row, velocity[e + t], element.line_density * length * (hat[s] * hat[t]));
        }
      }
    }
    SparseMatrix B = width.cwiseInverse().asDiagonal() * assembled(count, space.dofs, coupling);
    // Duals are orthogonal to the other linear functions: what is left of that is round-off.
    if (!hermite) B.prune([](Eigen::Index, Eigen::Index, double value) { return std::abs(value) > 1e-14; });
    return inertia_of(space, B, assembled(count, count, mass));
  }

 private:
  // Linear elements: BᵀCB, as sparse as K. Hermite elements: the factors CB and C, whose rank is that of M by
  // construction. A point mass m at dof j is one more velocity of its own, as in the singular mass.
  static Inertia inertia_of(const FiniteElementSpace& space, const SparseMatrix& B, const SparseMatrix& C) {
    Triplets coupling, velocity_mass;
    each(SparseMatrix(C * B), [&](int i, int j, double value) { coupling.emplace_back(i, j, value); });
    each(C, [&](int i, int j, double value) { velocity_mass.emplace_back(i, j, value); });
    int row = static_cast<int>(B.rows());
    for (const auto& point : space.point_masses) {
      if (point.mass == 0) continue;
      coupling.emplace_back(row, point.dof, point.mass);
      velocity_mass.emplace_back(row, row, point.mass);
      ++row;
    }
    Inertia inertia;
    inertia.coupling = assembled(row, space.dofs, coupling);
    inertia.kernel_dimension = space.dofs - row_rank(inertia.coupling);
    if (space.basis == FiniteElementSpace::Basis::hermite) {
      inertia.velocity_mass = assembled(row, row, velocity_mass);
      return inertia;
    }
    inertia.coupling = SparseMatrix();
    const SparseMatrix half = SparseMatrix(B.transpose()) * C * B;
    inertia.mass = 0.5 * (half + SparseMatrix(half.transpose()));  // symmetric to the last bit
    for (const auto& point : space.point_masses) inertia.mass.coeffRef(point.dof, point.dof) += point.mass;
    inertia.mass.makeCompressed();
    return inertia;
  }

  template <class Use>
  static void each(const SparseMatrix& matrix, Use use) {
    for (int j = 0; j < matrix.outerSize(); ++j)
      for (SparseMatrix::InnerIterator it(matrix, j); it; ++it) use(static_cast<int>(it.row()), j, it.value());
  }
};

void register_hybrid_singular(Registry& registry) {
  PluginManual manual;
  manual.name = "hybrid-singular";
  manual.words = "hybrid singular";
  manual.summary = "velocities and momenta of their own, bi-orthogonal, none at contact: M = (Y⁻¹A)ᵀ C (Y⁻¹A)";
  manual.text =
      R"(Velocities are hat functions ψ^v at the nodes, tied to displacements through dual functions ψ^p, which makes
          the tie diagonal and M sparse. Linear elements: a node that may touch a stop has no velocity and no mass,
          its part goes to its neighbours' (total mass is kept); without stops M is the consistent mass, with stops at
          neighbouring nodes it is refused. Hermite elements: every node keeps its velocity, M has one kernel
          dimension per element, which carries contact as that of singular does; frequencies converge with order 4 in
          the element length, with order 2 for linear elements. A point mass keeps its inertia.)";
  manual.source =
      R"(Tkachuk, Wohlmuth and Bischoff 2013, Hybrid-mixed discretization of elasto-dynamic contact problems using
          consistent singular mass matrices, Int. J. Numer. Methods Eng. 94, 473-493; Hermite elements: this program)";
  registry.add_mass(std::move(manual), [](const Parameters&) { return std::make_unique<HybridSingular>(); });
}

}  // namespace

RICOCHET_PLUGIN(mass, hybrid_singular, register_hybrid_singular)
