#include "redistribution.hpp"

namespace {

using namespace ricochet;

/// form lumped: lumped mass whose free ends carry none. The half element mass m/2 of a free end node goes to its two
/// neighbours, at ℓ and 2ℓ, as m and −m/2: sum m/2 and first moment 0 as before, so that total mass and centre of
/// gravity are kept. The diagonal next to that end becomes (0, 2m, m/2, m, …).
class OfTheEnds : public MassStrategy {
 public:
  InertiaOrRefusal build(const FiniteElementSpace& space) const override {
    if (space.basis != FiniteElementSpace::Basis::linear || space.elements.empty())
      return Refusal{"the redistributed mass empties the end nodes of a bar; for this " + space.structure +
                     " use its form projected or the mass singular"};
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

/// form projected: consistent mass whose contact dofs carry none (redistribution.hpp).
class Projected : public MassStrategy {
 public:
  explicit Projected(int reach) : reach_(reach) {}

  InertiaOrRefusal build(const FiniteElementSpace& space) const override {
    if (space.elements.empty())
      return Refusal{"a redistributed mass needs elements to move mass over, and this " + space.structure +
                     " has none: use the mass consistent or lumped"};
    FiniteElementSpace bare = space;
    bare.point_masses.clear();
    Inertia inertia;
    inertia.mass = consistent_mass(bare);
    const RigidMotions rigid(space);
    const double length = space.elements.front().length, reach = reach_ > 0 ? reach_ * length : INFINITY;
    for (const std::vector<int>& group : groups(space.contact_dofs, rigid, reach))
      if (!move_mass(inertia.mass, rigid, group, reach))
        return Refusal{"no dof near the contact points of this " + space.structure +
                       " is left to carry their mass, its centre and its moment of inertia: use more elements, fewer "
                       "stops or the mass singular"};
    inertia.mass.prune([](Eigen::Index, Eigen::Index, double value) { return value != 0; });
    if (!positive_elsewhere(inertia.mass, space.contact_dofs))
      return Refusal{"the mass moved off the contact points of this " + space.structure +
                     " leaves a negative eigenvalue: use another reach, more elements or the mass singular"};
    for (const auto& point : space.point_masses) inertia.mass.coeffRef(point.dof, point.dof) += point.mass;
    inertia.mass.makeCompressed();
    for (const int dof : space.contact_dofs)
      if (inertia.mass.coeff(dof, dof) == 0) ++inertia.kernel_dimension;
    return inertia;
  }

 private:
  // Contact dofs whose neighbourhoods overlap: mass, centre and moment of inertia are kept for each group.
  static std::vector<std::vector<int>> groups(const std::vector<int>& dofs, const RigidMotions& rigid, double reach) {
    std::vector<std::vector<int>> found;
    for (const int dof : dofs) {
      if (found.empty() || rigid.place[dof] - rigid.place[found.back().back()] > 2.001 * reach) found.emplace_back();
      found.back().push_back(dof);
    }
    return found;
  }

  int reach_;
};

void register_all(Registry& registry) {
  PluginManual manual;
  manual.name = "redistributed";
  manual.summary = "mass whose contact points carry none: it is moved to their neighbours";
  manual.text =
      "A contact point then has no inertia: an impact there moves no mass and destroys no energy. Form lumped, of "
      "bars: the diagonal mass, the share of each free end moved to its two neighbours, total mass and centre of "
      "gravity kept; order 2.6. Form projected, of bars and beams: the matrix nearest to the consistent one whose "
      "contact dofs have no row, with the same total mass, centre and moment of inertia of the free dofs. It differs "
      "within `reach` elements of a contact point, and frequencies keep their order; reach 0 spreads the mass over "
      "the whole mesh, as the paper does, and leaves order 1. A damped beam with a stop at its tip converges with "
      "order 2 to 4 (reach 2) and 1 (reach 0) in the element length. Refused where no dof is left to carry the mass "
      "(stops at all nodes: singular does that through its velocity space) and where a negative eigenvalue would be "
      "left.";
  manual.source =
      "Khenous, Laborde, Renard 2008, Mass redistribution method for finite element contact problems in "
      "elastodynamics, Eur. J. Mech. A/Solids 27, 918-932; its diagonal form with two neighbours and the reach: this "
      "program";
  manual.parameters = {
      word_parameter(
          "form", {"lumped", "projected"}, "lumped",
          "lumped: the free ends of a bar, from its diagonal mass; projected: the contact dofs of the scene, from "
          "the consistent mass"),
      integer_parameter("reach", 2, {.low = 0, .high = 1000},
                        "elements over which form projected moves mass; 0: the whole mesh")};
  registry.add_mass(std::move(manual), [](const Parameters& p) -> std::unique_ptr<MassStrategy> {
    if (p.word("form") == "lumped") return std::make_unique<OfTheEnds>();
    return std::make_unique<Projected>(static_cast<int>(p.integer("reach")));
  });
}

}  // namespace

RICOCHET_PLUGIN(mass, redistributed, register_all)
