#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <ricochet/kernels/eigenvalues.hpp>
#include <ricochet/kernels/sparse_ldlt.hpp>
#include <ricochet/scene/assembly.hpp>
#include <ricochet/scene/beam.hpp>
#include <ricochet/scene/planes.hpp>
#include <stdexcept>

namespace ricochet {
namespace {

// The left or right node of an element.
struct BeamNode {
  int displacement = -1, rotation = -1;
};
BeamNode node_of(const FiniteElementSpace::Element& element, bool right) {
  return {element.dof[right ? 2 : 0], element.dof[right ? 3 : 1]};
}

BeamNode nearest_node(const FiniteElementSpace& space, double x) {
  const FiniteElementSpace::Element* best = &space.elements.front();
  bool right = false;
  double gap = std::abs(best->left - x);
  for (const auto& element : space.elements)
    for (const bool end : {false, true}) {
      const double here = std::abs(element.left + (end ? element.length : 0) - x);
      if (here >= gap) continue;
      gap = here;
      best = &element;
      right = end;
    }
  return node_of(*best, right);
}

std::vector<double> breaks_of(const BeamSpec& beam) {
  std::vector<double> places = {0, beam.length};
  const auto add = [&](double x) {
    const auto same = [&](double other) { return std::abs(other - x) <= one_place * beam.length; };
    if (std::none_of(places.begin(), places.end(), same)) places.push_back(x);
  };
  for (const BeamSupport& support : supports_of(beam)) add(support.x);
  for (const BeamPart& part : beam.sections) add(part.to);
  for (const BeamMass& mass : beam.masses) add(mass.x);
  std::sort(places.begin(), places.end());
  return places;
}

// All dofs, 2i for w and 2i + 1 for w' of node i; point masses as well.
FiniteElementSpace whole_space(const BeamSpec& beam, int elements) {
  FiniteElementSpace space;
  space.structure = "beam";
  space.basis = FiniteElementSpace::Basis::hermite;
  const std::vector<UniformPart> parts = uniform_parts(beam);
  const std::vector<double> nodes = beam_nodes(beam, elements);
  std::size_t first = 0;
  for (const BeamInterval& interval : beam_intervals(beam, elements)) {
    for (int e = 0; e < interval.elements; ++e, ++first) {
      FiniteElementSpace::Element element;
      element.left = nodes[first];
      element.length = interval.length / interval.elements;
      const UniformPart& part = part_at(parts, element.left + element.length / 2);
      element.line_density = part.section.rhoS;
      element.rotary = part.rotary;
      if (part.kGA > 0) element.shear = 12 * part.section.EI / (part.kGA * element.length * element.length);
      const int dof = 2 * static_cast<int>(first);
      element.dof = {dof, dof + 1, dof + 2, dof + 3};
      space.elements.push_back(element);
    }
  }
  space.dofs = 2 * static_cast<int>(nodes.size());
  for (const BeamMass& mass : beam.masses) {
    const BeamNode node = nearest_node(space, mass.x);
    if (mass.mass > 0) space.point_masses.push_back({node.displacement, mass.mass});
    if (mass.inertia > 0) space.point_masses.push_back({node.rotation, mass.inertia, true});
  }
  return space;
}

// The free dof of each dof of the whole space; −1 where a support holds it.
std::vector<int> free_dofs(const BeamSpec& beam, const FiniteElementSpace& whole) {
  std::vector<int> number(static_cast<std::size_t>(whole.dofs), 0);
  for (const BeamSupport& support : supports_of(beam)) {
    const BeamNode node = nearest_node(whole, support.x);
    if (support.holds_displacement()) number[static_cast<std::size_t>(node.displacement)] = -1;
    if (support.holds_rotation()) number[static_cast<std::size_t>(node.rotation)] = -1;
  }
  int count = 0;
  for (int& dof : number)
    if (dof == 0) dof = count++;
  return number;
}

FiniteElementSpace held_space(const FiniteElementSpace& whole, const std::vector<int>& number) {
  const auto of = [&](int dof) { return number[static_cast<std::size_t>(dof)]; };
  FiniteElementSpace space = whole;
  space.dofs = static_cast<int>(std::count_if(number.begin(), number.end(), [](int dof) { return dof >= 0; }));
  for (auto& element : space.elements)
    for (int& dof : element.dof) dof = of(dof);
  space.point_masses.clear();
  for (auto point : whole.point_masses) {
    point.dof = of(point.dof);
    if (point.dof >= 0) space.point_masses.push_back(point);
  }
  space.left_fixed = number.front() < 0;
  space.right_fixed = of(whole.dofs - 2) < 0;
  return space;
}

// ∫w'w' and ∫w w of an element, per length of 1/ℓ and ℓ.
using Local = std::array<std::array<double, 4>, 4>;
enum class Product { slopes, values };
Local product_of(const FiniteElementSpace::Element& element, Product product) {
  Local sum{};
  for (const auto& [xi, weight] : gauss_points()) {
    const auto at = product == Product::values ? shape_values(FiniteElementSpace::Basis::hermite, element, xi)
                                               : shape_slopes(element, xi);
    for (std::size_t a = 0; a < 4; ++a)
      for (std::size_t b = 0; b < 4; ++b) sum[a][b] += element.length * weight * at[a] * at[b];
  }
  return sum;
}

SparseMatrix product_matrix(const FiniteElementSpace& space, Product product) {
  std::vector<Eigen::Triplet<double>> entries;
  for (const auto& element : space.elements) {
    const Local local = product_of(element, product);
    for (std::size_t a = 0; a < 4; ++a)
      for (std::size_t b = 0; b < 4; ++b)
        if (element.dof[a] >= 0 && element.dof[b] >= 0)
          entries.emplace_back(element.dof[a], element.dof[b], local[a][b]);
  }
  SparseMatrix matrix(space.dofs, space.dofs);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace

std::vector<BeamSupport> supports_of(const BeamSpec& beam) {
  return beam.supports ? *beam.supports : std::vector<BeamSupport>{{.name = "clamp"}};
}

namespace {

UniformPart uniform_part(const BeamSpec& beam, const BeamPart& part) {
  UniformPart out{part.to, section_properties(part.section, part.young, part.density)};
  if (beam.shear) {
    if (part.section.type == Section::Type::given)
      throw InputError("/scene/structure/section/type",
                       "a section \"given\" by EI and rhoS has no area for shear; expected tube, circle or rectangle");
    const double G = part.young / (2 * (1 + beam.shear->poisson));
    out.kGA = beam.shear->factor.value_or(shear_factor(part.section, beam.shear->poisson)) * G * out.section.S;
    if (beam.shear->rotary) out.rotary = part.density * out.section.I;
  }
  out.section.rhoS += beam.added_mass;
  return out;
}

}  // namespace

std::vector<UniformPart> uniform_parts(const BeamSpec& beam) {
  std::vector<UniformPart> parts;
  if (beam.sections.empty()) parts.push_back(uniform_part(beam, {beam.length, beam.section, beam.young, beam.density}));
  for (std::size_t i = 0; i < beam.sections.size(); ++i) try {
      parts.push_back(uniform_part(beam, beam.sections[i]));
    } catch (const InputError& error) {
      const std::string of = "/scene/structure/";
      throw InputError(fmt::format("{}sections/{}/{}", of, i, error.pointer().substr(of.size())), error.what());
    }
  return parts;
}

const UniformPart& part_at(const std::vector<UniformPart>& parts, double x) {
  const auto found = std::find_if(parts.begin(), parts.end(), [&](const UniformPart& part) { return x < part.to; });
  return found == parts.end() ? parts.back() : *found;
}

std::vector<BeamInterval> beam_intervals(const BeamSpec& beam, int elements) {
  const std::vector<double> places = breaks_of(beam);
  std::vector<BeamInterval> intervals;
  for (std::size_t i = 0; i + 1 < places.size(); ++i) {
    const double length = places[i + 1] - places[i];
    const double share = std::round(elements * (length / beam.length));
    intervals.push_back({places[i], length, std::max(1, static_cast<int>(share))});
  }
  return intervals;
}

std::vector<double> beam_nodes(const BeamSpec& beam, int elements) {
  std::vector<double> nodes;
  for (const BeamInterval& interval : beam_intervals(beam, elements))
    for (int i = 0; i < interval.elements; ++i)
      nodes.push_back(interval.from + interval.length * i / interval.elements);
  nodes.push_back(beam.length);
  return nodes;
}

FiniteElementSpace beam_space(const BeamSpec& beam, int elements) {
  if (beam.planes == 2)
    return join_planes(beam_space(in_plane(beam, 0), elements), beam_space(in_plane(beam, 1), elements));
  const FiniteElementSpace whole = whole_space(beam, elements);
  return held_space(whole, free_dofs(beam, whole));
}

SparseMatrix beam_stiffness(const BeamSpec& beam, const FiniteElementSpace& space) {
  if (beam.planes == 2)
    return join_planes(space, {beam_stiffness(in_plane(beam, 0), plane_space(space, 0).space),
                               beam_stiffness(in_plane(beam, 1), plane_space(space, 1).space)});
  const std::vector<UniformPart> parts = uniform_parts(beam);
  std::vector<double> EI;
  for (const auto& element : space.elements) EI.push_back(part_at(parts, element.left + element.length / 2).section.EI);
  SparseMatrix stiffness = bending_stiffness(space, EI);
  if (beam.tension != 0) stiffness += beam.tension * product_matrix(space, Product::slopes);
  if (beam.foundation != 0) stiffness += beam.foundation * product_matrix(space, Product::values);
  for (const BeamSupport& support : supports_of(beam)) {
    const BeamNode node = nearest_node(space, support.x);
    if (support.stiffness > 0) stiffness.coeffRef(node.displacement, node.displacement) += support.stiffness;
    if (support.rotation > 0) stiffness.coeffRef(node.rotation, node.rotation) += support.rotation;
  }
  stiffness.makeCompressed();
  return stiffness;
}

RigidFreedom rigid_freedom(const BeamSpec& beam) {
  if (beam.planes == 2) {
    const RigidFreedom y = rigid_freedom(in_plane(beam, 0)), z = rigid_freedom(in_plane(beam, 1));
    return {y.translates || z.translates, y.turns || z.turns};
  }
  int places = beam.foundation > 0 ? 2 : 0;
  bool turning_held = beam.tension > 0;
  for (const BeamSupport& support : supports_of(beam)) {
    if (support.moves_beam()) ++places;
    turning_held = turning_held || support.holds_rotation() || support.rotation > 0;
  }
  return {places == 0, places < 2 && !turning_held};
}

StaticModes static_modes(const BeamSpec& beam, int elements) {
  if (beam.planes == 2)
    return join_planes(beam_space(beam, elements),
                       {static_modes(in_plane(beam, 0), elements), static_modes(in_plane(beam, 1), elements)});
  const FiniteElementSpace whole = whole_space(beam, elements);
  const std::vector<int> number = free_dofs(beam, whole);
  const FiniteElementSpace space = held_space(whole, number);
  const std::vector<BeamSupport> supports = supports_of(beam);
  const SparseMatrix K = beam_stiffness(beam, whole), M = consistent_mass(whole), free_mass = consistent_mass(space);
  const auto count = static_cast<Eigen::Index>(supports.size());
  StaticModes out;
  out.modes = out.loads = Eigen::MatrixXd::Zero(space.dofs, count);
  SparseLdlt ldlt;
  const bool held = rigid_freedom(beam).held();
  if (held && !ldlt.factorise(beam_stiffness(beam, space)))
    throw std::logic_error("the stiffness of a held beam has no factor: " + ldlt.reason());
  const auto to_free = [&](const SparseMatrix& matrix, int column, double factor,
                           Eigen::Ref<Eigen::VectorXd> out_column) {
    for (SparseMatrix::InnerIterator it(matrix, column); it; ++it)
      if (const int row = number[static_cast<std::size_t>(it.row())]; row >= 0) out_column[row] += factor * it.value();
  };
  for (Eigen::Index j = 0; j < count; ++j) {
    const BeamSupport& support = supports[static_cast<std::size_t>(j)];
    out.supports.push_back(support.name);
    if (!support.moves_beam()) continue;
    const int at = nearest_node(whole, support.x).displacement;
    Eigen::VectorXd mode = Eigen::VectorXd::Zero(space.dofs);
    if (held) {
      if (support.holds_displacement())
        to_free(K, at, -1, mode);
      else
        mode[number[static_cast<std::size_t>(at)]] = support.stiffness;
      ldlt.solve(mode.data(), mode.data());
    } else {
      for (std::size_t i = 0; i < number.size(); i += 2)
        if (number[i] >= 0) mode[number[i]] = 1;
    }
    out.modes.col(j) = mode;
    out.loads.col(j) = free_mass * mode;
    if (support.holds_displacement()) to_free(M, at, 1, out.loads.col(j));
  }
  return out;
}

double buckling_load(const BeamSpec& beam, int elements) {
  if (beam.planes == 2)
    return std::min(buckling_load(in_plane(beam, 0), elements), buckling_load(in_plane(beam, 1), elements));
  constexpr int most = 100;
  BeamSpec unloaded = beam;
  unloaded.tension = 0;
  const RigidFreedom freedom = rigid_freedom(unloaded);
  if (freedom.turns) return 0;
  const FiniteElementSpace space = beam_space(unloaded, std::min(elements, most));
  if (space.dofs == 0) return std::numeric_limits<double>::infinity();
  Eigen::MatrixXd K(beam_stiffness(unloaded, space));
  const Eigen::MatrixXd G(product_matrix(space, Product::slopes));
  if (freedom.translates) {
    // A translation changes neither K nor G: one of them is as good as any other.
    const Eigen::VectorXd s = rigid_motion_load(space);
    K += (K.trace() / s.squaredNorm()) * s * s.transpose();
  }
  const double largest = symmetric_modes(G, K, EigenVectors::none).values.maxCoeff();
  return largest > 0 ? 1 / largest : std::numeric_limits<double>::infinity();
}

}  // namespace ricochet
