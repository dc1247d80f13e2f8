#include <fmt/format.h>

#include <array>
#include <ricochet/contract/plugin_call.hpp>
#include <ricochet/kernels/dense_solvers.hpp>
#include <ricochet/scene/assembly.hpp>

#include "runners/check/mass_checks.hpp"

namespace ricochet::checking {

FiniteElementSpace unit_space(const SpaceBench& bench) {
  using Basis = FiniteElementSpace::Basis;
  FiniteElementSpace space;
  space.structure = bench.beam ? "beam" : "bar";
  space.basis = bench.beam ? Basis::hermite : Basis::linear;
  space.left_fixed = bench.left_fixed;
  space.right_fixed = bench.right_fixed;
  const int per_node = bench.beam ? 2 : 1;
  std::vector<int> first(static_cast<std::size_t>(bench.elements) + 1, -1);
  for (int node = 0; node <= bench.elements; ++node) {
    if ((node == 0 && bench.left_fixed) || (node == bench.elements && bench.right_fixed)) continue;
    const bool pin = bench.pinned && node == bench.elements / 3;
    first[static_cast<std::size_t>(node)] = pin ? space.dofs - 1 : space.dofs;
    space.dofs += pin ? per_node - 1 : per_node;
  }
  const auto place = [&](int node) {
    const double share = static_cast<double>(node) / bench.elements, from = bench.mirrored ? 1 - share : share;
    if (!bench.uneven) return share;
    const double x = from * (0.6 + 0.4 * from);
    return bench.mirrored ? 1 - x : x;
  };
  for (int e = 0; e < bench.elements; ++e) {
    const int from_left = bench.mirrored ? bench.elements - 1 - e : e;
    const bool second = bench.uneven && 2 * from_left >= bench.elements;
    FiniteElementSpace::Element element{place(e), place(e + 1) - place(e), second ? 2.5 : 1.0, {-1, -1, -1, -1}};
    if (bench.rotary && bench.beam) element.rotary = second ? 6e-3 : 2e-3;
    for (int end = 0; end < 2; ++end) {
      const int dof = first[static_cast<std::size_t>(e + end)];
      for (int k = 0; k < per_node; ++k)
        element.dof[static_cast<std::size_t>(end * per_node + k)] =
            dof < 0 || (k == 0 && bench.pinned && e + end == bench.elements / 3) ? -1 : dof + k;
    }
    space.elements.push_back(element);
  }
  for (int node = 0; node <= bench.elements; ++node) {
    const int dof = first[static_cast<std::size_t>(node)];
    const bool end = node == 0 || node == bench.elements;
    if (dof >= 0 && !(bench.pinned && node == bench.elements / 3) &&
        (bench.stops == SpaceBench::Stops::nodes || (bench.stops == SpaceBench::Stops::ends && end)))
      space.contact_dofs.push_back(dof);
  }
  const int middle = first[static_cast<std::size_t>(bench.elements / 2)];
  if (bench.point_mass) space.point_masses.push_back({middle, 0.3});
  if (bench.point_inertia && bench.beam) space.point_masses.push_back({middle + 1, 0.05, true});
  return space;
}

double mass_of(const FiniteElementSpace& space) {
  double mass = 0;
  for (const auto& element : space.elements) mass += element.line_density * element.length;
  return mass;
}
double rotary_of(const FiniteElementSpace& space) {
  double inertia = 0;
  for (const auto& element : space.elements) inertia += element.rotary * element.length;
  return inertia;
}

std::string space_text(const SpaceBench& bench) {
  const char* ends = bench.left_fixed && bench.right_fixed ? "fixed at both ends"
                     : bench.left_fixed                    ? "fixed at its left end"
                     : bench.right_fixed                   ? "fixed at its right end"
                                                           : "free at both ends";
  const char* stops = bench.stops == SpaceBench::Stops::ends    ? ", with stops at its free ends"
                      : bench.stops == SpaceBench::Stops::nodes ? ", with stops at all nodes"
                                                                : "";
  return fmt::format("a {} of {} {}elements, {}{}{}{}{}{}", bench.beam ? "beam" : "bar", bench.elements,
                     bench.uneven ? "unequal " : "", ends, bench.pinned ? ", pinned between" : "", stops,
                     bench.uneven ? ", of two sections" : "", bench.rotary ? ", with rotary inertia" : "",
                     bench.point_mass || bench.point_inertia ? ", with a point mass" : "");
}

FiniteElementSpace oscillator_space() {
  FiniteElementSpace space;
  space.structure = "oscillator";
  space.dofs = 1;
  space.point_masses = {{0, 1.0}};
  return space;
}

InertiaOrRefusal ask_mass(const Mass& mass, const FiniteElementSpace& space) {
  const PluginIdentity identity{"mass", mass.entry->manual.name, mass.entry->file};
  const PluginCallScope scope(identity, "build");
  return mass.make()->build(space);
}

Inertia built(const Mass& mass, const FiniteElementSpace& space) {
  InertiaOrRefusal answer = ask_mass(mass, space);
  if (auto* refusal = std::get_if<Refusal>(&answer)) throw Refused{refusal->sentence.text};
  return std::get<Inertia>(std::move(answer));
}

Eigen::MatrixXd dense(const Inertia& inertia, const FiniteElementSpace& space) {
  const auto demand = [](bool holds, const std::string& sentence) {
    if (!holds) throw std::runtime_error(sentence);
  };
  if (inertia.inverted()) {
    const Eigen::MatrixXd R = inertia.inverse;
    demand(R.rows() == space.dofs && R.cols() == space.dofs,
           fmt::format("the inverse is {} × {}, the space has {} dofs", R.rows(), R.cols(), space.dofs));
    demand(R.allFinite(), "the inverse has an entry that is not finite");
    demand((R - R.transpose()).norm() <= 1e-13 * R.norm(), "the inverse is not symmetric");
    demand(is_definite(R), "the inverse is not positive definite");
    const Eigen::MatrixXd M = definite_solve(R, Eigen::MatrixXd::Identity(R.rows(), R.rows()));
    return 0.5 * (M + M.transpose());
  }
  if (!inertia.factored()) {
    demand(inertia.mass.rows() == space.dofs && inertia.mass.cols() == space.dofs,
           fmt::format("the matrix is {} × {}, the space has {} dofs", inertia.mass.rows(), inertia.mass.cols(),
                       space.dofs));
    const Eigen::MatrixXd M = inertia.mass;
    demand(M.allFinite(), "the matrix has an entry that is not finite");
    return M;
  }
  const Eigen::MatrixXd B = inertia.coupling, C = inertia.velocity_mass;
  demand(B.cols() == space.dofs && C.rows() == B.rows() && C.cols() == B.rows(),
         fmt::format("the factors are {} × {} and {} × {}, the space has {} dofs", B.rows(), B.cols(), C.rows(),
                     C.cols(), space.dofs));
  demand(B.allFinite() && C.allFinite(), "a factor has an entry that is not finite");
  demand((C - C.transpose()).norm() <= 1e-13 * C.norm(), "the mass of the velocities is not symmetric");
  demand(is_definite(C), "the mass of the velocities is not positive definite");
  return B.transpose() * definite_solve(C, B);
}

Eigen::MatrixXd unit_stiffness(const FiniteElementSpace& space) {
  return Eigen::MatrixXd(space.basis == FiniteElementSpace::Basis::hermite ? bending_stiffness(space, 1)
                                                                           : axial_stiffness(space, 1));
}

std::vector<SpaceBench::Stops> stops_of(bool no_free_end) {
  using Stops = SpaceBench::Stops;
  if (no_free_end) return {Stops::none, Stops::nodes};
  return {Stops::none, Stops::ends, Stops::nodes};
}

std::vector<SpaceBench> accepted(const Mass& mass, int elements) {
  std::vector<SpaceBench> all;
  for (const bool beam : {false, true})
    for (const bool left : {true, false})
      for (const bool right : {false, true})
        for (const auto stops : stops_of(left && right)) {
          const SpaceBench bench{beam, elements, left, right, false, stops};
          if (std::holds_alternative<Inertia>(ask_mass(mass, unit_space(bench)))) all.push_back(bench);
        }
  return all;
}

std::vector<SpaceBench> accepted_pinned(const Mass& mass, int elements) {
  using Stops = SpaceBench::Stops;
  std::vector<SpaceBench> all;
  for (const bool right : {false, true})
    for (const auto stops : {Stops::none, right ? Stops::nodes : Stops::ends}) {
      const SpaceBench bench{true, elements, true, right, false, stops, true};
      if (std::holds_alternative<Inertia>(ask_mass(mass, unit_space(bench)))) all.push_back(bench);
    }
  return all;
}

}  // namespace ricochet::checking
