#include <ricochet/contract/plugin.hpp>

namespace {

using namespace ricochet;

/// Lumped mass whose free ends carry none. The half element mass m/2 of a free end node goes to its two neighbours, at
/// ℓ and 2ℓ, as m and −m/2: sum m/2 and first moment 0 as before, so that total mass and centre of gravity are kept.
/// The diagonal next to that end becomes (0, 2m, m/2, m, …).
class Redistributed : public MassStrategy {
 public:
  InertiaOrRefusal build(const FiniteElementSpace& space) const override {
    if (space.basis != FiniteElementSpace::Basis::linear || space.elements.empty())
      return Refusal{"the redistributed mass empties the end nodes of a bar; for this " + space.structure +
                     " use the mass singular"};
    const int free_ends = (space.left_fixed ? 0 : 1) + (space.right_fixed ? 0 : 1);
    const auto count = static_cast<int>(space.elements.size());
    // Both neighbours of an end must be free nodes, and not those of the other end.
    if (count < 2 * free_ends + 1)
      return Refusal{"the mass of a free end needs two further free nodes to go to: use at least " +
                     std::to_string(2 * free_ends + 1) + " elements"};
    Eigen::VectorXd diagonal = Eigen::VectorXd::Zero(space.dofs);
    for (const auto& element : space.elements)
      for (int a = 0; a < 2; ++a)
        if (element.dof[a] >= 0) diagonal[element.dof[a]] += element.line_density * element.length / 2;
    const auto empty_end = [&](const FiniteElementSpace::Element& end, int step) {
      const int node = end.dof[step > 0 ? 0 : 1];
      const double mass = end.line_density * end.length;
      diagonal[node] -= mass / 2;
      diagonal[node + step] += mass;
      diagonal[node + 2 * step] -= mass / 2;
      diagonal[node] = 0;
    };
    if (!space.left_fixed) empty_end(space.elements.front(), 1);
    if (!space.right_fixed) empty_end(space.elements.back(), -1);
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
};

void register_all(Registry& registry) {
  PluginManual manual;
  manual.name = "redistributed";
  manual.summary = "diagonal mass of a bar whose free ends, where contact acts, carry none";
  manual.text =
      "The lumped mass of linear elements with the end node's share moved to its two neighbours so that total mass and "
      "centre of gravity are kept. A free end then has no inertia: an impact there moves no mass and destroys no "
      "energy. "
      "For beams, whose every node may touch a stop, the singular mass does the same through its velocity space.";
  manual.source =
      "Khenous, Laborde, Renard 2008, Mass redistribution method for finite element contact problems in "
      "elastodynamics, "
      "Eur. J. Mech. A/Solids 27, 918-932; here its diagonal form with two neighbours";
  registry.add_mass(std::move(manual), [](const Parameters&) { return std::make_unique<Redistributed>(); });
}

}  // namespace

RICOCHET_PLUGIN(mass, redistributed, register_all)
