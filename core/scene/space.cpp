#include <fmt/format.h>

#include <ricochet/scene/assembly.hpp>
#include <ricochet/scene/semi_discrete.hpp>

namespace ricochet {
namespace {

/// Clamped at x = 0, dofs (w_1, w'_1, w_2, w'_2, …): half-bandwidth 3.
FiniteElementSpace make(const BeamSpec& beam, int elements) {
  FiniteElementSpace space;
  space.structure = "beam";
  space.basis = FiniteElementSpace::Basis::hermite;
  space.dofs = 2 * elements;
  space.left_fixed = true;
  const double density = section_properties(beam.section, beam.young, beam.density).rhoS;
  const auto nodes = node_positions(beam.length, elements);
  for (int e = 0; e < elements; ++e) {
    FiniteElementSpace::Element element;
    element.left = nodes[e];
    element.length = beam.length / elements;
    element.line_density = density;
    element.dof = {2 * e - 2, 2 * e - 1, 2 * e, 2 * e + 1};
    if (e == 0) element.dof = {-1, -1, 0, 1};
    space.elements.push_back(element);
  }
  return space;
}

}  // namespace

FiniteElementSpace make_space(const StructureSpec& structure, int elements) {
  if (elements < 1) throw InputError("/mesh/elements", fmt::format("{} elements; expected at least 1", elements));
  return std::visit([&](const auto& spec) { return make(spec, elements); }, structure);
}

}  // namespace ricochet
