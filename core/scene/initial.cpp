#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ricochet/scene/assembly.hpp>
#include <ricochet/scene/checks.hpp>
#include <ricochet/scene/initial.hpp>
#include <ricochet/scene/massless_part.hpp>

namespace ricochet {
namespace {

double energy(const SemiDiscrete& problem) {
  return 0.5 * problem.position.dot(problem.stiffness * problem.position) +
         0.5 * problem.velocity.dot(apply_mass(problem.inertia, problem.velocity));
}

Eigen::VectorXd load_rate_at_start(const DistributedLoad& load, int dofs) {
  Eigen::VectorXd rate = Eigen::VectorXd::Zero(dofs), value(dofs);
  if (load.absent() || load.constant_in_time()) return rate;
  constexpr double spacing = 2e-5;
  constexpr std::array<double, 7> weights{-49.0 / 20, 6, -15.0 / 2, 20.0 / 3, -15.0 / 4, 6.0 / 5, -1.0 / 6};
  for (std::size_t j = 0; j < weights.size(); ++j) {
    load.assemble(static_cast<double>(j) * spacing, value.data());
    rate += weights[j] / spacing * value;
  }
  return rate;
}

void note_clamp(SemiDiscrete& problem, const char* what, const char* unit, double formula, double imposed,
                double rounding) {
  if (std::abs(formula - imposed) <= rounding) return;
  problem.notes.push_back(fmt::format("the initial {} at the clamp is {:.6g} {}; the clamp imposes {:.6g} {}", what,
                                      formula, unit, imposed, unit));
}

Eigen::VectorXd load_at_start(const SemiDiscrete& problem) {
  Eigen::VectorXd load(problem.dofs());
  problem.load->assemble(0, load.data());
  return load - support_at_start(problem.support).acceleration * problem.support_shape;
}

}  // namespace

void interpolate_initial(const SceneSpec& scene, SemiDiscrete& problem) {
  const double length = structure_length(scene);
  const auto support = support_at_start(scene.support);
  problem.position.resize(problem.space.dofs);
  problem.velocity.resize(problem.space.dofs);
  const auto places = dof_places(problem.space);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const auto [x, slope] = places[i];
    const InitialSpec& initial = scene.initial;
    // The last node, i·(L/N), may lie an ulp beyond the end.
    problem.position[row] =
        slope ? initial.displacement.slope(std::min(x, length), 0, length) : initial.displacement(x) - support.position;
    problem.velocity[row] =
        slope ? initial.velocity.slope(std::min(x, length), 0, length) : initial.velocity(x) - support.velocity;
  }
  if (!problem.space.left_fixed && !problem.space.right_fixed) return;
  const double clamp = problem.space.left_fixed ? 0 : length;

  const double size = problem.position.lpNorm<Eigen::Infinity>() + std::abs(support.position);
  const double rate = problem.velocity.lpNorm<Eigen::Infinity>() + std::abs(support.velocity);
  // Values are rounded to 1e-16; slopes come from a stencil of length/256.
  note_clamp(problem, "displacement", "m", scene.initial.displacement(clamp), support.position, 1e-12 * size);
  note_clamp(problem, "velocity", "m/s", scene.initial.velocity(clamp), support.velocity, 1e-12 * rate);
  if (problem.space.basis != FiniteElementSpace::Basis::hermite) return;
  note_clamp(problem, "slope", "rad", scene.initial.displacement.slope(0, 0, length), 0,
             1e-10 * (size + size / length));
  note_clamp(problem, "rate of slope", "rad/s", scene.initial.velocity.slope(0, 0, length), 0,
             1e-10 * (rate + rate / length));
}

void measure_mass_constraint(SemiDiscrete& problem, const Eigen::VectorXd& pushed) {
  if (problem.inertia.kernel_dimension == 0) return;
  const MasslessPart massless(problem.stiffness, problem.inertia);
  Eigen::VectorXd residual = problem.stiffness * problem.position - load_at_start(problem);
  if (pushed.size() > 0) residual -= pushed;
  problem.kernel_energy = massless.energy(residual);
}

void project_on_mass_constraint(SemiDiscrete& problem) {
  if (problem.inertia.kernel_dimension == 0) {
    problem.notes.emplace_back("projection of the initial state: nothing to do, the mass is regular");
    return;
  }
  const Eigen::VectorXd load = load_at_start(problem);
  Eigen::VectorXd rate = Eigen::VectorXd::Zero(problem.dofs());
  if (problem.damping.stiffness == 0)
    rate = load_rate_at_start(*problem.load, problem.dofs()) -
           support_at_start(problem.support).jerk * problem.support_shape;

  const MasslessPart massless(problem.stiffness, problem.inertia);
  const auto project = [&](Eigen::VectorXd& state, const Eigen::VectorXd& right) {
    state -= massless.response(problem.stiffness * state - right);
  };
  const double before = energy(problem);
  project(problem.position, load);
  project(problem.velocity, rate);
  problem.projection_energy = energy(problem) - before;
  problem.notes.push_back(
      fmt::format("projection of the initial state on the constraint of the singular mass: energy "
                  "from {:.6g} J to {:.6g} J",
                  before, before + problem.projection_energy));
}

}  // namespace ricochet
