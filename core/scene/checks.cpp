#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <ricochet/contract/errors.hpp>
#include <ricochet/scene/assembly.hpp>
#include <ricochet/scene/checks.hpp>
#include <ricochet/scene/semi_discrete.hpp>

namespace ricochet {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

void require(bool holds, const std::string& pointer, const std::string& message) {
  if (!holds) throw InputError(pointer, message);
}

void check_structure(const BeamSpec& beam) {
  require(std::isfinite(beam.length) && beam.length > 0, "/scene/structure/length",
          fmt::format("the length is {:.6g} m; expected a finite number above 0", beam.length));
  section_properties(beam.section, beam.young, beam.density);
  require(
      std::isfinite(beam.damping.stiffness) && beam.damping.stiffness >= 0, "/scene/structure/damping/stiffness",
      fmt::format("the stiffness damping α is {:.6g} s; expected a finite number, 0 or above", beam.damping.stiffness));
  require(std::isfinite(beam.damping.mass) && beam.damping.mass >= 0, "/scene/structure/damping/mass",
          fmt::format("the mass damping η is {:.6g} 1/s; expected a finite number, 0 or above", beam.damping.mass));
}

void check_support(const SupportSpec& support) {
  require(std::isfinite(support.amplitude), "/scene/support/amplitude", "the amplitude of the support is not finite");
  require(std::isfinite(support.pulsation) && support.pulsation >= 0, "/scene/support/pulsation",
          fmt::format("the pulsation of the support is {:.6g} rad/s; expected a finite number, 0 or above",
                      support.pulsation));
  require(std::isfinite(support.phase), "/scene/support/phase", "the phase of the support is not finite");
}

void check_variables(const SceneSpec& scene) {
  const auto only_x = [](const Formula& formula, const std::string& pointer, const char* what) {
    require(!formula.uses_t(), pointer,
            fmt::format("the formula \"{}\" depends on t; expected {} as a formula in x only", formula.text(), what));
  };
  if (scene.stops.lower) only_x(*scene.stops.lower, "/scene/stops/lower", "a stop");
  if (scene.stops.upper) only_x(*scene.stops.upper, "/scene/stops/upper", "a stop");
  only_x(scene.initial.displacement, "/scene/initial/displacement", "the initial displacement");
  only_x(scene.initial.velocity, "/scene/initial/velocity", "the initial velocity");
}

void check_positions(const SceneSpec& scene) {
  if (scene.stops.place != StopsSpec::Place::positions) return;
  const auto& positions = scene.stops.positions;
  const double length = structure_length(scene);
  require(!positions.empty(), "/scene/stops/at", "the list of positions is empty; expected at least one x");
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const std::string pointer = fmt::format("/scene/stops/at/{}", i);
    require(positions[i] > 0 && positions[i] <= length, pointer,
            fmt::format("a stop at x = {:.6g} m is not on the free part of the beam; expected 0 < x ≤ {:.6g} m",
                        positions[i], length));
    for (std::size_t j = 0; j < i; ++j)
      require(std::abs(positions[i] - positions[j]) > 1e-9 * length, pointer,
              fmt::format("two stops at x = {:.6g} m; expected different positions", positions[i]));
  }
}

/// Where a stop may be touched: the contact points, and between nodes when there is one at every node (a finer mesh
/// would touch there).
std::vector<double> touchable(const SceneSpec& scene, int elements) {
  std::vector<double> x = contact_positions(scene, elements);
  if (x.empty() || scene.stops.place != StopsSpec::Place::nodes) return x;
  constexpr int fine = 200;
  const auto between = node_positions(structure_length(scene), fine);
  x.insert(x.end(), between.begin() + 1, between.end());
  std::sort(x.begin(), x.end());
  return x;
}

void check_order(const std::vector<double>& x, const Eigen::VectorXd& lower, const Eigen::VectorXd& upper) {
  for (std::size_t i = 0; i < x.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    require(lower[row] < upper[row], "/scene/stops/lower",
            fmt::format("at x = {:.6g} m the lower stop, {:.6g} m, is not below the upper stop, {:.6g} m; expected "
                        "lower < upper everywhere",
                        x[i], lower[row], upper[row]));
  }
}

/// With a stop along the whole beam the clamp lies between the stops too, wherever the support takes it.
void check_clamp(const SceneSpec& scene) {
  if (scene.stops.place != StopsSpec::Place::nodes) return;
  const double lower = scene.stops.lower ? (*scene.stops.lower)(0) : -infinity;
  const double upper = scene.stops.upper ? (*scene.stops.upper)(0) : infinity;
  const bool moves = scene.support.pulsation != 0;
  const double start = support_at_start(scene.support).position;
  const double highest = moves ? std::abs(scene.support.amplitude) : start, lowest = moves ? -highest : start;
  if (lower <= lowest && highest <= upper) return;
  const bool above = highest > upper;
  const char* side = above ? "upper" : "lower";
  const double stop = above ? upper : lower, reached = above ? highest : lowest;
  if (scene.support.amplitude == 0)
    throw InputError(fmt::format("/scene/stops/{}", side),
                     fmt::format("the {} stop at x = 0 is at {:.6g} m, beyond the clamp at 0 m; expected lower ≤ 0 ≤ "
                                 "upper there",
                                 side, stop));
  throw InputError("/scene/support/amplitude",
                   fmt::format("the support takes the clamp to {:.6g} m, through the {} stop at {:.6g} m (x = 0); "
                               "expected an amplitude of at most {:.6g} m",
                               reached, side, stop, std::max(0.0, std::min(-lower, upper))));
}

}  // namespace

double structure_length(const SceneSpec& scene) {
  return std::get<BeamSpec>(scene.structure).length;
}

std::vector<double> contact_positions(const SceneSpec& scene, int elements) {
  if (!scene.stops.lower && !scene.stops.upper) return {};
  if (scene.stops.place == StopsSpec::Place::tip) return {structure_length(scene)};
  if (scene.stops.place == StopsSpec::Place::positions) return scene.stops.positions;
  auto nodes = node_positions(structure_length(scene), elements);
  nodes.erase(nodes.begin());
  return nodes;
}

void check_between_stops(const std::vector<double>& x, const Eigen::VectorXd& u, const Eigen::VectorXd& lower,
                         const Eigen::VectorXd& upper, const std::string& pointer, const std::string& what) {
  for (std::size_t i = 0; i < x.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const bool above = u[row] > upper[row] + 1e-12 * (std::abs(u[row]) + std::abs(upper[row]));
    const bool below = u[row] < lower[row] - 1e-12 * (std::abs(u[row]) + std::abs(lower[row]));
    require(!above && !below, pointer,
            fmt::format("{} is {:.6g} m at x = {:.6g} m, beyond the {} stop at {:.6g} m; expected a state between the "
                        "stops",
                        what, u[row], x[i], above ? "upper" : "lower", above ? upper[row] : lower[row]));
  }
}

SupportMotion support_at_start(const SupportSpec& support) {
  const double w = support.pulsation, in_phase = support.amplitude * std::sin(support.phase),
               quadrature = support.amplitude * std::cos(support.phase);
  return {in_phase, w * quadrature, -w * w * in_phase, -w * w * w * quadrature};
}

Eigen::VectorXd stop_values(const std::optional<Formula>& stop, const std::vector<double>& x, double absent) {
  Eigen::VectorXd values = Eigen::VectorXd::Constant(static_cast<Eigen::Index>(x.size()), absent);
  if (stop)
    for (std::size_t i = 0; i < x.size(); ++i) values[static_cast<Eigen::Index>(i)] = (*stop)(x[i]);
  return values;
}

void check_scene(const SceneSpec& shared, int elements) {
  const SceneSpec scene = shared;  // formulas keep their variables inside: evaluate our own copies
  std::visit([](const auto& structure) { check_structure(structure); }, scene.structure);
  const auto space = make_space(scene.structure, elements);
  check_support(scene.support);
  check_variables(scene);
  check_positions(scene);

  const auto x = touchable(scene, elements);
  const auto lower = stop_values(scene.stops.lower, x, -infinity);
  const auto upper = stop_values(scene.stops.upper, x, infinity);
  check_order(x, lower, upper);
  check_clamp(scene);
  Eigen::VectorXd start(static_cast<Eigen::Index>(x.size()));
  for (std::size_t i = 0; i < x.size(); ++i) start[static_cast<Eigen::Index>(i)] = scene.initial.displacement(x[i]);
  check_between_stops(x, start, lower, upper, "/scene/initial/displacement", "the initial displacement");

  for (double node : node_positions(structure_length(scene), elements)) {
    scene.initial.displacement(node);
    scene.initial.velocity(node);
  }
  for (const auto& element : space.elements)
    for (const auto& point : gauss_points()) scene.load(element.left + point.xi * element.length, 0);
}

}  // namespace ricochet
