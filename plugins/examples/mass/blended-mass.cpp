// A mass matrix in one file: a blend of the consistent one and a diagonal one. Put your element matrix in its place.
#include <ricochet/contract/plugin.hpp>

namespace {

using namespace ricochet;

/// M = (1 − r) M_consistent + r M_lumped. M_lumped has ρSℓ/2 at each translation of an element's ends and, of beams,
/// ρSℓ³/78 at each rotation (Hinton, Rock and Zienkiewicz).
class Mass final : public MassStrategy {
 public:
  explicit Mass(double share) : share_(share) {}

  // The matrix of a space: elements with their local dofs, and point masses. A Refusal where the strategy has none.
  InertiaOrRefusal build(const FiniteElementSpace& space) const override {
    std::vector<Eigen::Triplet<double>> lumped;
    for (const auto& element : space.elements) {
      const double mass = element.line_density * element.length;
      // Local functions: of a beam w_a, w'_a, w_b, w'_b; of a bar u_a, u_b.
      for (int a = 0; a < space.functions(); ++a) {
        const int i = element.dof[a];
        if (i < 0) continue;  // held by a boundary condition
        const bool rotation = space.basis == FiniteElementSpace::Basis::hermite && a % 2 == 1;
        lumped.emplace_back(i, i, rotation ? mass * element.length * element.length / 78 : mass / 2);
      }
    }
    for (const auto& point : space.point_masses) lumped.emplace_back(point.dof, point.dof, point.mass);
    SparseMatrix diagonal(space.dofs, space.dofs);
    diagonal.setFromTriplets(lumped.begin(), lumped.end());

    Inertia inertia;
    // Symmetric, both triangles. (Or B and C_v of M = Bᵀ C_v⁻¹ B, where M itself would be full.)
    inertia.mass = (1 - share_) * consistent_mass(space) + share_ * diagonal;
    // Dimension of the kernel, exactly: here dofs that nothing heavy moves with. Schemes refuse, or not, by it.
    const Eigen::VectorXd found = inertia.mass.diagonal();
    inertia.kernel_dimension = static_cast<int>((found.array() == 0).count());
    return inertia;
  }

 private:
  double share_;
};

void register_all(Registry& registry) {
  registry.add_mass(
      {.name = "blended-mass",
       .summary = "a blend of the consistent and the diagonal mass",
       .text = R"(M = (1 − r) M_consistent + r M_lumped. r = 0 and r = 1 are the methods consistent and lumped; with
          r = ½ the frequencies of a bar of linear elements converge with order 4 in the element length, those of
          either with order 2.)",
       .source = "Goudreau and Taylor (1973), Evaluation of numerical integration methods in elastodynamics",
       // Key, unit, default (std::nullopt: the study must give it), range, meaning.
       .parameters = {real_parameter("share", "1", 0.5, {.low = 0, .high = 1}, "r, share of the diagonal mass")}},
      // Makes the strategy from checked values.
      [](const Parameters& p) { return std::make_unique<Mass>(p.real("share")); });
}

}  // namespace

// Role, name ('-' written '_'), and the function above.
RICOCHET_PLUGIN(mass, blended_mass, register_all)
