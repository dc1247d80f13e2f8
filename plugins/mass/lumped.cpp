#include <ricochet/contract/plugin.hpp>

namespace {

using namespace ricochet;

/// Diagonal mass. Hermite, Hinton–Rock–Zienkiewicz: the consistent diagonal ρSℓ(156, 4ℓ², 156, 4ℓ²)/420 scaled so that
/// the two translations sum to ρSℓ: ρSℓ/2 and ρSℓ³/78. Linear: row sums, ρSℓ/2.
class Lumped : public MassStrategy {
 public:
  explicit Lumped(bool rotations) : rotations_(rotations) {}

  InertiaOrRefusal build(const FiniteElementSpace& space) const override {
    const bool hermite = space.basis == FiniteElementSpace::Basis::hermite;
    Eigen::VectorXd diagonal = Eigen::VectorXd::Zero(space.dofs);
    for (const auto& element : space.elements) {
      const double mass = element.line_density * element.length;
      for (int a = 0; a < space.functions(); ++a) {
        if (element.dof[a] < 0) continue;
        const bool rotation = hermite && a % 2 == 1;
        if (!rotation) diagonal[element.dof[a]] += mass / 2;
        if (rotation && rotations_) diagonal[element.dof[a]] += mass * element.length * element.length / 78;
      }
    }
    for (const auto& point : space.point_masses) diagonal[point.dof] += point.mass;

    Inertia inertia;
    inertia.mass.resize(space.dofs, space.dofs);
    for (int i = 0; i < space.dofs; ++i) {
      if (diagonal[i] == 0) ++inertia.kernel_dimension;
      if (diagonal[i] != 0) inertia.mass.insert(i, i) = diagonal[i];
    }
    inertia.mass.makeCompressed();
    return inertia;
  }

 private:
  bool rotations_;
};

void register_lumped(Registry& registry) {
  PluginManual manual;
  manual.name = "lumped";
  manual.summary = "diagonal mass: half of each element at its ends";
  manual.text =
      "Hermite elements: the consistent diagonal scaled to the element's mass, ρSℓ/2 per translation and ρSℓ³/78 per "
      "rotation; rotation = none leaves rotations without inertia, a singular mass whose kernel is the rotations (its "
      "contact nodes still carry inertia, unlike the singular method). Linear elements: row sums, ρSℓ/2. Frequencies "
      "converge with order 2 in the element length.";
  manual.source =
      "Hinton, Rock, Zienkiewicz 1976, A note on mass lumping and related processes in the finite element method, "
      "Earthquake Eng. Struct. Dyn. 4, 245-249";
  manual.parameters = {word_parameter("rotation", {"scaled", "none"}, "scaled",
                                      "inertia of the rotations: ρSℓ³/78 per element end, or none (singular mass)")};
  registry.add_mass(std::move(manual), [](const Parameters& parameters) {
    return std::make_unique<Lumped>(parameters.word("rotation") == "scaled");
  });
}

}  // namespace

RICOCHET_PLUGIN(mass, lumped, register_lumped)
