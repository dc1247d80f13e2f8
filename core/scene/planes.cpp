#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ricochet/contract/errors.hpp>
#include <ricochet/scene/block_matrices.hpp>
#include <ricochet/scene/planes.hpp>

namespace ricochet {
namespace {

using Element = FiniteElementSpace::Element;

// Every dof of these elements, −1 left out, ascending.
std::vector<int> dofs_of(const std::vector<Element>& elements) {
  std::vector<int> dofs;
  for (const Element& element : elements)
    for (const int dof : element.dof)
      if (dof >= 0) dofs.push_back(dof);
  std::sort(dofs.begin(), dofs.end());
  dofs.erase(std::unique(dofs.begin(), dofs.end()), dofs.end());
  return dofs;
}

std::vector<int> plane_dofs(const FiniteElementSpace& joint, int plane) {
  return dofs_of(plane == 1 ? joint.across : joint.elements);
}

void renumber(std::vector<Element>& elements, const std::vector<int>& number) {
  for (Element& element : elements)
    for (int& dof : element.dof)
      if (dof >= 0) dof = number[static_cast<std::size_t>(dof)];
}

// Joint numbers of both planes, node by node.
std::array<std::vector<int>, 2> joint_numbers(const FiniteElementSpace& along_y, const FiniteElementSpace& along_z) {
  const std::array<const FiniteElementSpace*, 2> planes{&along_y, &along_z};
  std::array<std::vector<int>, 2> number;
  for (std::size_t p = 0; p < 2; ++p) number[p].assign(static_cast<std::size_t>(planes[p]->dofs), -1);
  int next = 0;
  const std::size_t count = along_y.elements.size();
  for (std::size_t node = 0; node <= count; ++node)
    for (std::size_t p = 0; p < 2; ++p) {
      const Element& element = planes[p]->elements[std::min(node, count - 1)];
      const std::size_t first = node < count ? 0 : 2;
      for (const std::size_t a : {first, first + 1})
        if (element.dof[a] >= 0) number[p][static_cast<std::size_t>(element.dof[a])] = next++;
    }
  return number;
}

}  // namespace

BeamSpec in_plane(const BeamSpec& beam, int plane) {
  BeamSpec out = beam;
  out.planes = 1;
  const auto turn = [&](Section& section) {
    if (plane == 1 && section.type == Section::Type::rectangle) std::swap(section.width, section.height);
    if (plane == 1 && section.EI_z > 0) section.EI = section.EI_z;
    section.EI_z = 0;
  };
  turn(out.section);
  for (BeamPart& part : out.sections) turn(part.section);
  if (!out.supports) return out;
  for (BeamSupport& support : *out.supports) {
    if (!support.in_plane[static_cast<std::size_t>(plane)])
      support = {support.name, support.x, BeamSupport::Type::elastic};
    support.in_plane = {true, true};
  }
  return out;
}

FiniteElementSpace plane_elements(const FiniteElementSpace& joint, int plane) {
  FiniteElementSpace out = joint;
  if (joint.across.empty()) return out;
  if (plane == 1) out.elements = joint.across;
  out.across.clear();
  return out;
}

PlaneSpace plane_space(const FiniteElementSpace& joint, int plane) {
  PlaneSpace out{plane_elements(joint, plane), {}};
  FiniteElementSpace& space = out.space;
  out.dofs = dofs_of(space.elements);
  std::vector<int> number(static_cast<std::size_t>(joint.dofs), -1);
  for (std::size_t i = 0; i < out.dofs.size(); ++i) number[static_cast<std::size_t>(out.dofs[i])] = static_cast<int>(i);
  renumber(space.elements, number);
  space.dofs = static_cast<int>(out.dofs.size());
  space.point_masses.clear();
  for (auto point : joint.point_masses)
    if (point.dof = number[static_cast<std::size_t>(point.dof)]; point.dof >= 0) space.point_masses.push_back(point);
  space.contact_dofs.clear();
  for (const int dof : joint.contact_dofs)
    if (const int own = number[static_cast<std::size_t>(dof)]; own >= 0) space.contact_dofs.push_back(own);
  space.left_fixed = space.elements.front().dof[0] < 0;
  space.right_fixed = space.elements.back().dof[2] < 0;
  return out;
}

FiniteElementSpace join_planes(const FiniteElementSpace& along_y, const FiniteElementSpace& along_z) {
  const auto number = joint_numbers(along_y, along_z);
  FiniteElementSpace out = along_y;
  out.dofs = along_y.dofs + along_z.dofs;
  renumber(out.elements, number[0]);
  out.across = along_z.elements;
  renumber(out.across, number[1]);
  out.point_masses.clear();
  for (std::size_t p = 0; p < 2; ++p)
    for (auto point : (p == 0 ? along_y : along_z).point_masses) {
      point.dof = number[p][static_cast<std::size_t>(point.dof)];
      out.point_masses.push_back(point);
    }
  return out;
}

SparseMatrix join_planes(const FiniteElementSpace& joint, const std::array<SparseMatrix, 2>& planes) {
  MatrixEntries entries;
  for (int p = 0; p < 2; ++p) {
    const std::vector<int> dofs = plane_dofs(joint, p);
    add_block(planes[static_cast<std::size_t>(p)], dofs, dofs, entries);
  }
  return sparse_matrix(joint.dofs, joint.dofs, entries);
}

StaticModes join_planes(const FiniteElementSpace& joint, const std::array<StaticModes, 2>& planes) {
  StaticModes out;
  const Eigen::Index count = planes[0].modes.cols();
  out.modes = out.loads = Eigen::MatrixXd::Zero(joint.dofs, 2 * count);
  for (std::size_t p = 0; p < 2; ++p) {
    const std::vector<int> dofs = plane_dofs(joint, static_cast<int>(p));
    const auto columns = Eigen::seqN(static_cast<Eigen::Index>(p) * count, count);
    out.modes(dofs, columns) = planes[p].modes;
    out.loads(dofs, columns) = planes[p].loads;
    out.supports.insert(out.supports.end(), planes[p].supports.begin(), planes[p].supports.end());
  }
  return out;
}

InertiaOrRefusal mass_by_plane(const MassStrategy& mass, const FiniteElementSpace& joint) {
  std::vector<Inertia> masses;
  std::vector<std::vector<int>> dofs;
  for (const int plane : {0, 1}) {
    const PlaneSpace one = plane_space(joint, plane);
    auto built = mass.build(one.space);
    if (auto* refusal = std::get_if<Refusal>(&built)) return std::move(*refusal);
    masses.push_back(std::get<Inertia>(std::move(built)));
    dofs.push_back(one.dofs);
  }
  return join_inertias(masses, dofs, joint.dofs);
}

std::array<double, 2> plane_shares(const Place& place, bool two_planes, const std::string& pointer) {
  if (place.component.empty() && place.direction.empty()) return {1, 0};
  const std::string key = pointer + (place.component.empty() ? "/direction" : "/component");
  const char* one_plane = "a beam of one plane moves along uy alone; expected planes 2";
  if (!place.component.empty()) {
    const auto found = std::find(plane_components.begin(), plane_components.end(), place.component);
    if (found == plane_components.end()) {
      const std::string nearest = nearest_name(place.component, {plane_components.begin(), plane_components.end()});
      throw InputError(key, fmt::format("no component \"{}\"; expected uy or uz{}", place.component,
                                        nearest.empty() ? "" : fmt::format("; did you mean \"{}\"?", nearest)));
    }
    const bool across = found != plane_components.begin();
    if (across && !two_planes) throw InputError(key, one_plane);
    return across ? std::array<double, 2>{0, 1} : std::array<double, 2>{1, 0};
  }
  if (place.direction.size() != 2)
    throw InputError(key, fmt::format("{} numbers; expected two of a beam, along y and z", place.direction.size()));
  const double y = place.direction[0], z = place.direction[1], length = std::hypot(y, z);
  if (!(length > 0) || !std::isfinite(length))
    throw InputError(key, "the direction has no length; expected two numbers, not both 0");
  if (!two_planes && z != 0) throw InputError(key, one_plane);
  return {y / length, z / length};
}

double initial_across(const Formula& formula, const DofPlace& place, double length) {
  return place.slope ? formula.slope(std::min(place.x, length), 0, length) : formula(place.x);
}

}  // namespace ricochet
