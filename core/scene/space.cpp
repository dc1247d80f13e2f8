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

/// One point mass and no element.
FiniteElementSpace make(const OscillatorSpec& oscillator, int elements) {
  if (elements != 1)
    throw InputError("/mesh/elements", fmt::format("{} elements; an oscillator has no mesh: expected 1", elements));
  FiniteElementSpace space;
  space.structure = "oscillator";
  space.basis = FiniteElementSpace::Basis::linear;
  space.dofs = 1;
  space.point_masses = {{0, oscillator.mass}};
  return space;
}

/// Dofs w_0 … w_N, those of fixed ends left out: half-bandwidth 1.
FiniteElementSpace make(const BarSpec& bar, int elements) {
  FiniteElementSpace space;
  space.structure = "bar";
  space.basis = FiniteElementSpace::Basis::linear;
  space.left_fixed = bar.fixed == BarSpec::Fixed::left;
  space.right_fixed = bar.fixed == BarSpec::Fixed::right;
  const int first = space.left_fixed ? 1 : 0, last = space.right_fixed ? elements - 1 : elements;
  space.dofs = last - first + 1;
  const auto nodes = node_positions(bar.length, elements);
  const auto dof = [&](int node) { return node < first || node > last ? -1 : node - first; };
  for (int e = 0; e < elements; ++e) {
    FiniteElementSpace::Element element;
    element.left = nodes[static_cast<std::size_t>(e)];
    element.length = bar.length / elements;
    element.line_density = bar.rhoA;
    element.dof = {dof(e), dof(e + 1), -1, -1};
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
