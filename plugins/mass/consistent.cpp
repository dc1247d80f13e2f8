#include <ricochet/contract/plugin.hpp>

namespace {

using namespace ricochet;

class Consistent : public MassStrategy {
 public:
  InertiaOrRefusal build(const FiniteElementSpace& space) const override {
    if (space.given && !space.given->attached.empty() && !space.given->attached_mass)
      return Refusal{"the description gives no mass of its residual: use the mass singular, or mesh.residual \"none\""};
    Inertia inertia;
    inertia.mass = consistent_mass(space);
    // A semidefinite matrix has a zero row where its diagonal is zero: dofs that neither an element nor a point mass
    // moves.
    const Eigen::VectorXd diagonal = inertia.mass.diagonal();
    inertia.kernel_dimension =
        space.given ? space.dofs - semidefinite_rank(inertia.mass) : static_cast<int>((diagonal.array() == 0).count());
    return inertia;
  }
  bool takes_given() const override { return true; }
  bool takes_modes() const override { return true; }
};

void register_consistent(Registry& registry) {
  PluginManual manual;
  manual.name = "consistent";
  manual.summary = "velocities in the displacement space: M_ij = ∫ρS φ_i φ_j dx";
  manual.text =
      R"(The Galerkin mass matrix, integrated exactly. Regular; frequencies converge with order 4 in the element
          length for Hermite elements. Every contact point carries inertia, so that a rigid impact destroys the
          kinetic energy of its node: a loss of the discretisation, which shrinks with the mesh. Of an assembled
          structure it is the mass matrix of its files; of a structure in modes that of the modes and of the static
          shapes of its stops.)";
  manual.source = "Archer 1963, Consistent mass matrix for distributed mass systems, J. Struct. Div. ASCE 89, 161-178";
  registry.add_mass(std::move(manual), [](const Parameters&) { return std::make_unique<Consistent>(); });
}

}  // namespace

RICOCHET_PLUGIN(mass, consistent, register_consistent)
