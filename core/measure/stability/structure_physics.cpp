#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <ricochet/kernels/block.hpp>
#include <ricochet/kernels/dense_solvers.hpp>
#include <ricochet/kernels/eigenvalues.hpp>
#include <ricochet/kernels/sparse_factor.hpp>
#include <ricochet/kernels/sparse_ldlt.hpp>
#include <ricochet/measure/stability/structure_physics.hpp>
#include <ricochet/scene/assembly.hpp>
#include <ricochet/scene/basis/modal_basis.hpp>
#include <ricochet/scene/beam.hpp>
#include <ricochet/scene/planes.hpp>
#include <ricochet/scene/structure/assembled_structure.hpp>

namespace ricochet {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

}  // namespace

std::string StructureModes::name(int i) const {
  if (i >= regular) return "the kernel of the mass";
  return fmt::format("mode {} of {} ({:.4g} rad/s)", i + 1, regular, pulsation(i));
}

StructureModes::StructureModes(const MatrixXd& M, const MatrixXd& K, int kernel, bool free) {
  const Index n = M.rows();
  if (kernel == 0 && is_definite(M)) {
    // The fast modes, which limit steps, are the accurate ones here.
    const SymmetricModes eigen = symmetric_modes(K, M);
    shapes = eigen.vectors;
    stiffness = eigen.values.cwiseMax(0.0);
    if (free)
      for (double& k : stiffness)
        if (k < 1e-11 * stiffness.maxCoeff()) k = 0;
    mass = VectorXd::Ones(n);
    regular = static_cast<int>(n);
    return;
  }
  // (K + σM) is definite whenever M and K share no kernel.
  const double shift = free ? std::max(K.trace(), 1e-300) / M.trace() / static_cast<double>(n * n) : 0.0;
  const SymmetricModes eigen = symmetric_modes(M, K + shift * M);
  shapes = eigen.vectors.rowwise().reverse();
  mass = eigen.values.reverse().cwiseMax(0.0);
  regular = static_cast<int>(n) - kernel;
  mass.tail(kernel).setZero();
  stiffness = VectorXd::Ones(n) - shift * mass;
  for (double& k : stiffness)
    if (k < 1e-11) k = 0;
}

StructureModes open_modes(const SemiDiscrete& problem) {
  SparseLdlt ldlt;
  const bool free = !ldlt.factorise(problem.stiffness);
  return {dense_mass(problem.inertia), MatrixXd(problem.stiffness), problem.inertia.kernel_dimension, free};
}

std::optional<double> slowest_period(const SemiDiscrete& problem) {
  constexpr int steps = 2;
  if (problem.dofs() > most_modal_dofs) return std::nullopt;
  const auto stiffness = SparseFactor::of(problem.stiffness);
  if (!stiffness) return std::nullopt;
  Block work(problem.dofs() + 1, 1);
  VectorXd shape = VectorXd::Ones(problem.dofs());
  double squared = 0;
  for (int k = 0; k < steps; ++k) {
    const VectorXd pushed = apply_mass(problem.inertia, shape);
    stiffness->solve(pushed.data(), shape.data(), work.data());
    const double mass = shape.dot(apply_mass(problem.inertia, shape));
    if (!(mass > 0)) return std::nullopt;
    squared = shape.dot(pushed) / mass;
    shape /= std::sqrt(mass);
  }
  const double period = 2 * std::numbers::pi / std::sqrt(squared);
  return squared > 0 && std::isfinite(period) ? std::optional(period) : std::nullopt;
}

StructureModes held_modes(const SemiDiscrete& problem, const std::vector<int>& points, bool free) {
  const Index n = problem.dofs();
  MatrixXd rows(static_cast<Index>(points.size()), n);
  for (Index i = 0; i < rows.rows(); ++i)
    rows.row(i) = Eigen::RowVectorXd(problem.measured().row(points[static_cast<std::size_t>(i)]));
  const PivotedBasis pivoted = pivoted_basis(rows.transpose());
  const MatrixXd basis = pivoted.basis.rightCols(n - pivoted.rank);
  int kernel = 0;
  if (problem.inertia.kernel_dimension > 0) {
    const MatrixXd kernel_rows = rows * mass_kernel(problem.inertia);
    kernel = static_cast<int>(kernel_rows.cols() - pivoted_basis(kernel_rows).rank);
  }
  const MatrixXd M = basis.transpose() * dense_mass(problem.inertia) * basis;
  const MatrixXd K = basis.transpose() * MatrixXd(problem.stiffness) * basis;
  StructureModes held(M, K, kernel, free);
  held.shapes = basis * held.shapes;
  return held;
}

namespace {

// Beyond, a dense eigenvalue problem takes longer than a person waits for a plan (0.1 s); the first frequencies have
// converged long before.
constexpr int most_elements = 120;
// Of matrices that are given, whose mesh nobody coarsens: a dense problem of a few seconds.
constexpr int most_given_dofs = 1000;

// What follows from a structure and is not said of it.
struct Numbers {
  std::vector<PhysicalNumber> operator()(const BeamSpec& beam) const {
    std::vector<PhysicalNumber> numbers;
    const UniformPart first = uniform_parts(beam).front();
    if (beam.sections.empty() && beam.planes == 2 && beam.section.EI_z == 0)
      if (const double EI_z = uniform_parts(in_plane(beam, 1)).front().section.EI; EI_z != first.section.EI)
        numbers.push_back({"EI along z", EI_z, "N m²"});
    if (beam.shear) numbers.push_back({"kGA", first.kGA, "N"});
    return numbers;
  }
  std::vector<PhysicalNumber> operator()(const AssembledSpec& spec) const {
    if (const std::optional<ModalPart>& modes = spec.structure->modes)
      return {{"modes", static_cast<double>(modes->modes), ""},
              {"residual shapes", static_cast<double>(modes->attached.size()), ""}};
    return {{"free dofs", static_cast<double>(spec.structure->dofs()), ""},
            {"held dofs", static_cast<double>(spec.structure->held_dofs), ""},
            {"half-bandwidth", static_cast<double>(spec.structure->half_width), ""}};
  }
  template <class Other>
  std::vector<PhysicalNumber> operator()(const Other&) const {
    return {};
  }
};

struct Details {
  int elements = 0, dofs = 0;

  std::vector<std::string> operator()(const BeamSpec& beam) const {
    const std::vector<BeamInterval> intervals = beam_intervals(beam, elements);
    if (!beam.supports && intervals.size() == 1 && beam.planes == 1) return {};
    std::vector<std::string> lines, parts;
    int rigid = 0;
    for (int plane = 0; plane < beam.planes; ++plane) {
      const RigidFreedom freedom = rigid_freedom(in_plane(beam, plane));
      rigid += (freedom.translates ? 1 : 0) + (freedom.turns ? 1 : 0);
    }
    if (rigid > 0) lines.push_back(fmt::format("{} rigid motion{}", rigid, rigid == 1 ? "" : "s"));
    int count = 0;
    for (const BeamInterval& interval : intervals) {
      parts.push_back(
          fmt::format("{} from {:.6g} to {:.6g} m", interval.elements, interval.from, interval.from + interval.length));
      count += interval.elements;
    }
    lines.push_back(fmt::format("elements: {}", fmt::join(parts, ", ")));
    lines.push_back(fmt::format("dofs: {}, held {}{}", dofs, 2 * beam.planes * (count + 1) - dofs,
                                beam.planes == 2 ? "; two planes" : ""));
    return lines;
  }
  std::vector<std::string> operator()(const AssembledSpec& spec) const {
    const std::vector<std::string>& supports = spec.structure->supports;
    if (supports.empty()) return {};
    return {fmt::format("supports: {}", fmt::join(supports, ", "))};
  }
  template <class Other>
  std::vector<std::string> operator()(const Other&) const {
    return {};
  }
};

// Whether the columns of static modes sum to a translation, where a structure says its supports.
std::optional<std::string> static_modes_text(const SceneSpec& scene, const SemiDiscrete& problem) {
  const auto* beam = std::get_if<BeamSpec>(&scene.structure);
  const bool own = problem.space.given || (beam && beam->supports);
  if (!own || problem.static_modes.cols() == 0) return std::nullopt;
  const VectorXd sums = problem.static_modes.rowwise().sum();
  if (problem.space.given && problem.space.given->direction.empty()) return std::nullopt;
  const std::vector<DofPlace> places = problem.space.given ? std::vector<DofPlace>() : dof_places(problem.space);
  double least = HUGE_VAL, most = -HUGE_VAL;
  for (Index i = 0; i < sums.size(); ++i) {
    const auto dof = static_cast<std::size_t>(i);
    constexpr int unknown = -1, rotation = 3;
    const int direction = problem.space.given ? problem.space.given->direction[dof] : places[dof].slope ? rotation : 1;
    if (direction == unknown || direction == rotation) continue;
    least = std::min(least, sums[i]);
    most = std::max(most, sums[i]);
  }
  if (least > most) return std::nullopt;
  constexpr double round_off = 1e-9;
  if (std::abs(least - 1) <= round_off && std::abs(most - 1) <= round_off)
    return "static modes of the supports sum to 1: moved together they carry every point along";
  return fmt::format("static modes of the supports sum to {:.4g} to {:.4g}; a translation has 1", least, most);
}

std::vector<double> point_stiffness(const SemiDiscrete& problem) {
  constexpr int most_points = 100;
  std::vector<double> out;
  SparseLdlt ldlt;
  if (!problem.held || problem.points() > most_points || !ldlt.factorise(problem.stiffness)) return out;
  for (int i = 0; i < problem.points(); ++i) {
    const VectorXd row = problem.contact.row(i).transpose();
    VectorXd moved = row;
    ldlt.solve(moved.data(), moved.data());
    out.push_back(1 / row.dot(moved));
  }
  return out;
}

// What modes are marched, and what they leave out of the flexibility at each stop.
std::vector<std::string> basis_lines(const SemiDiscrete& problem) {
  const ModalBasis& basis = *problem.basis;
  std::vector<std::string> lines{
      fmt::format("{} mode{} to {:.4g} Hz and {} static shape{} of stops, in the place of {} dofs", basis.modes,
                  basis.modes == 1 ? "" : "s", std::sqrt(basis.squares[basis.modes - 1]) / (2 * std::numbers::pi),
                  basis.dofs() - basis.modes, basis.dofs() - basis.modes == 1 ? "" : "s", problem.space.dofs)};
  constexpr int most_lines = 12;
  constexpr double percent = 100;
  int more = 0;
  for (int i = 0; i < problem.points(); ++i) {
    // Of a clearance, its first side.
    const bool side = std::any_of(problem.clearances.begin(), problem.clearances.end(),
                                  [&](const Clearance& one) { return i > one.first && i <= one.last(); });
    if (side || static_cast<int>(lines.size()) > most_lines) {
      more += side ? 0 : 1;
      continue;
    }
    lines.push_back(fmt::format(
        "{}: the modes leave out {:.2g} % of the flexibility, {:.3g} m/N",
        problem.stops.empty() ? fmt::format("contact point at {:.6g} m", problem.contact_x[static_cast<std::size_t>(i)])
                              : "stop " + problem.stops[static_cast<std::size_t>(i)],
        percent * basis.left_out[i] / basis.flexibility[i], basis.left_out[i]));
  }
  if (more > 0) lines.push_back(fmt::format("and {} more contact points", more));
  return lines;
}

}  // namespace

std::optional<double> StructurePhysics::damping_ratio(std::size_t mode) const {
  const double pulsation = pulsations.at(mode);
  if (pulsation == 0 || (damping.stiffness == 0 && damping.mass == 0 && !damping.by_modes())) return std::nullopt;
  if (damping.by_modes()) {
    const auto rigid = std::count(pulsations.begin(), pulsations.end(), 0.0);
    return damping.ratio(mode - static_cast<std::size_t>(rigid));
  }
  return (damping.stiffness * pulsation + damping.mass / pulsation) / 2;
}

int StructurePhysics::resolved(double h, double steps_per_period) const {
  return static_cast<int>(std::count_if(pulsations.begin(), pulsations.end(), [&](double pulsation) {
    return pulsation * h * steps_per_period <= 2 * std::numbers::pi;
  }));
}

std::variant<StructurePhysics, Refusal> structure_physics(const SceneSpec& scene, int elements,
                                                          const MassStrategy& mass) {
  StructurePhysics out;
  out.elements = scene.basis ? elements : std::min(elements, most_elements);
  // Nor where the structure begins.
  NoContact nothing;
  const Parameters none;
  const auto made = discretise(scene, out.elements, mass, &nothing, &none);
  if (const auto* refusal = std::get_if<Refusal>(&made)) return *refusal;
  const SemiDiscrete& problem = std::get<SemiDiscrete>(made);
  out.damping = problem.damping;
  out.structure = problem.space.structure;
  out.numbers = std::visit(Numbers{}, scene.structure);
  out.details = std::visit(Details{out.elements, problem.space.dofs}, scene.structure);
  if (problem.basis) {
    for (std::string& line : basis_lines(problem)) out.details.push_back(std::move(line));
    out.left_out.assign(problem.basis->left_out.begin(), problem.basis->left_out.end());
  }
  out.point_stiffness = point_stiffness(problem);
  if (auto sums = static_modes_text(scene, problem)) out.details.push_back(*std::move(sums));
  if (problem.space.given && problem.dofs() > most_given_dofs) return out;
  const StructureModes modes = open_modes(problem);
  for (int i = 0; i < modes.regular; ++i) out.pulsations.push_back(modes.pulsation(i));
  const auto rigid = std::count(out.pulsations.begin(), out.pulsations.end(), 0.0);
  if (problem.space.given && rigid > 0) out.numbers.push_back({"rigid motions", static_cast<double>(rigid), ""});
  if (!out.damping.matrix) return out;
  // What C does to each mode by itself.
  for (int i = 0; i < modes.regular; ++i) {
    const VectorXd shape = modes.shapes.col(i);
    if (modes.pulsation(i) > 0)
      out.damping.ratios.push_back(shape.dot(*out.damping.matrix * shape) / (2 * modes.pulsation(i) * modes.mass[i]));
  }
  return out;
}

}  // namespace ricochet
