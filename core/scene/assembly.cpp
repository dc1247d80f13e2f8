#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <ricochet/scene/assembly.hpp>
#include <ricochet/scene/beam.hpp>
#include <ricochet/scene/bodies.hpp>
#include <ricochet/scene/planes.hpp>
#include <ricochet/scene/semi_discrete.hpp>
#include <ricochet/scene/structure/assembled_structure.hpp>

namespace ricochet {

SparseMatrix bending_stiffness(const FiniteElementSpace& space, double EI) {
  return bending_stiffness(space, std::vector<double>(space.elements.size(), EI));
}

SparseMatrix bending_stiffness(const FiniteElementSpace& space, const std::vector<double>& EI) {
  assert(space.basis == FiniteElementSpace::Basis::hermite);
  assert(EI.size() == space.elements.size());
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(16 * space.elements.size());
  for (std::size_t e = 0; e < space.elements.size(); ++e) {
    const auto& element = space.elements[e];
    const double l = element.length, phi = element.shear, k = EI[e] / (l * l * l * (1 + phi));
    const double near = 4 + phi, far = 2 - phi;
    const double local[4][4] = {{12 * k, 6 * l * k, -12 * k, 6 * l * k},
                                {6 * l * k, near * l * l * k, -6 * l * k, far * l * l * k},
                                {-12 * k, -6 * l * k, 12 * k, -6 * l * k},
                                {6 * l * k, far * l * l * k, -6 * l * k, near * l * l * k}};
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b < 4; ++b)
        if (element.dof[a] >= 0 && element.dof[b] >= 0)
          entries.emplace_back(element.dof[a], element.dof[b], local[a][b]);
  }
  SparseMatrix stiffness(space.dofs, space.dofs);
  stiffness.setFromTriplets(entries.begin(), entries.end());
  return stiffness;
}

SparseMatrix axial_stiffness(const FiniteElementSpace& space, double EA) {
  assert(space.basis == FiniteElementSpace::Basis::linear);
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(4 * space.elements.size());
  for (const auto& element : space.elements) {
    const double k = EA / element.length;
    for (int a = 0; a < 2; ++a)
      for (int b = 0; b < 2; ++b)
        if (element.dof[a] >= 0 && element.dof[b] >= 0)
          entries.emplace_back(element.dof[a], element.dof[b], a == b ? k : -k);
  }
  SparseMatrix stiffness(space.dofs, space.dofs);
  stiffness.setFromTriplets(entries.begin(), entries.end());
  return stiffness;
}

std::vector<DofPlace> dof_places(const FiniteElementSpace& space) {
  std::vector<DofPlace> places(static_cast<std::size_t>(space.dofs));
  const bool hermite = space.basis == FiniteElementSpace::Basis::hermite;
  for (const auto* elements : {&space.elements, &space.across})
    for (std::size_t e = 0; e < elements->size(); ++e) {
      const auto& element = (*elements)[e];
      // The right end is the next element's left one, to the last bit.
      const double right = e + 1 < elements->size() ? (*elements)[e + 1].left : element.left + element.length;
      for (int a = 0; a < space.functions(); ++a) {
        if (element.dof[a] < 0) continue;
        const bool second = hermite ? a >= 2 : a == 1;
        places[static_cast<std::size_t>(element.dof[a])] = {second ? right : element.left, hermite && a % 2 == 1,
                                                            elements == &space.across};
      }
    }
  return places;
}

Eigen::VectorXd rigid_motion_load(const FiniteElementSpace& space) {
  if (!space.across.empty()) {
    const PlaneSpace plane = plane_space(space, 0);
    Eigen::VectorXd load = Eigen::VectorXd::Zero(space.dofs);
    load(plane.dofs) = rigid_motion_load(plane.space);
    return load;
  }
  Eigen::VectorXd load = Eigen::VectorXd::Zero(space.dofs);
  for (const auto& element : space.elements) {
    const double mass = element.line_density * element.length, half = mass / 2, moment = mass * element.length / 12;
    const std::array<double, 4> integrals = space.basis == FiniteElementSpace::Basis::hermite
                                                ? std::array<double, 4>{half, moment, half, -moment}
                                                : std::array<double, 4>{half, half, 0, 0};
    for (int a = 0; a < space.functions(); ++a)
      if (element.dof[a] >= 0) load[element.dof[a]] += integrals[a];
  }
  for (const auto& point : space.point_masses)
    if (!point.rotation) load[point.dof] += point.mass;
  return load;
}

namespace {

// The element that holds x, and ξ there.
std::pair<const FiniteElementSpace::Element*, double> locate(const FiniteElementSpace& space, double x) {
  const auto after = std::upper_bound(space.elements.begin(), space.elements.end(), x,
                                      [](double value, const auto& element) { return value < element.left; });
  const auto& element = after == space.elements.begin() ? space.elements.front() : *(after - 1);
  double xi = (x - element.left) / element.length;
  if (std::abs(xi - std::round(xi)) < 1e-10) xi = std::round(xi);  // the rounding of a decimal position
  return {&element, xi};
}

std::vector<std::pair<int, double>> row_of(const FiniteElementSpace& space, const FiniteElementSpace::Element& element,
                                           const std::array<double, 4>& values) {
  std::vector<std::pair<int, double>> row;
  for (int a = 0; a < space.functions(); ++a)
    if (element.dof[a] >= 0 && values[a] != 0) row.emplace_back(element.dof[a], values[a]);
  return row;
}

}  // namespace

namespace {

std::array<double, 4> shapes_at(const FiniteElementSpace& space, const FiniteElementSpace::Element& element, double xi,
                                ShapeOf what) {
  const double length = element.length, slope = 6 / (length * length * (1 + element.shear));
  switch (what) {
    case ShapeOf::rotation:
      return shape_rotations(element, xi);
    case ShapeOf::curvature:
      return shape_strains(space.basis, element, xi);
    case ShapeOf::curvature_slope:
      return {2 * slope / length, slope, -2 * slope / length, slope};
    case ShapeOf::displacement:
      break;
  }
  return shape_values(space.basis, element, xi);
}

}  // namespace

std::vector<std::pair<int, double>> displacement_row(const FiniteElementSpace& space, double x, ShapeOf what) {
  if (space.elements.empty()) return {{0, 1.0}};
  const auto [element, xi] = locate(space, x);
  return row_of(space, *element, shapes_at(space, *element, xi, what));
}

std::vector<std::pair<double, double>> held_row(const FiniteElementSpace& space, double x, ShapeOf what) {
  std::vector<std::pair<double, double>> row;
  if (space.elements.empty()) return row;
  const auto [element, xi] = locate(space, x);
  const std::array<double, 4> values = shapes_at(space, *element, xi, what);
  const int right = space.basis == FiniteElementSpace::Basis::hermite ? 2 : 1;
  for (const int a : {0, right})
    if (element->dof[a] < 0 && values[a] != 0)
      row.emplace_back(a == 0 ? element->left : element->left + element->length, values[a]);
  return row;
}

std::vector<std::pair<int, double>> strain_row(const FiniteElementSpace& space, double x) {
  if (space.elements.empty()) return {};
  const auto [element, xi] = locate(space, x);
  return row_of(space, *element, shape_strains(space.basis, *element, xi));
}

Eigen::SparseMatrix<double, Eigen::RowMajor> displacement_rows(const FiniteElementSpace& space,
                                                               const std::vector<double>& x) {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t i = 0; i < x.size(); ++i)
    for (const auto& [dof, value] : displacement_row(space, x[i]))
      entries.emplace_back(static_cast<int>(i), dof, value);
  Eigen::SparseMatrix<double, Eigen::RowMajor> rows(static_cast<Eigen::Index>(x.size()), space.dofs);
  rows.setFromTriplets(entries.begin(), entries.end());
  return rows;
}

std::vector<double> node_positions(double length, int elements) {
  std::vector<double> x(static_cast<std::size_t>(elements) + 1);
  for (int i = 0; i <= elements; ++i) x[i] = i == elements ? length : length * i / elements;
  return x;
}

namespace {

FiniteElementSpace make(const BeamSpec& beam, int elements) {
  return beam_space(beam, elements);
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

/// The matrices as they are; no element.
FiniteElementSpace make(const AssembledSpec& given, int elements) {
  SceneSpec scene;
  scene.structure = given;
  scene = on_mesh(std::move(scene), elements);
  const auto& spec = std::get<AssembledSpec>(scene.structure);
  if (elements != 1 && !spec.bodies)
    throw InputError(
        "/mesh/elements",
        fmt::format("{} elements; an assembled structure has the mesh of its files: expected 1", elements));
  FiniteElementSpace space;
  space.structure = spec.bodies             ? "structure of bodies"
                    : spec.structure->modes ? "modal structure"
                                            : "assembled structure";
  space.basis = FiniteElementSpace::Basis::linear;
  space.dofs = spec.structure->dofs();
  space.given = spec.structure->dofs_known;
  space.given->mass = spec.structure->mass;
  space.given->stiffness = spec.structure->stiffness;
  if (const std::optional<ModalPart>& modes = spec.structure->modes) {
    space.given->modes = true;
    space.given->attached = modes->attached;
    space.given->attached_mass = modes->attached_mass;
  }
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
