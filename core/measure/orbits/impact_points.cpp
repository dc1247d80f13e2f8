#include <algorithm>
#include <cmath>
#include <ricochet/kernels/quadratic_form.hpp>
#include <ricochet/measure/orbits/impact_jump.hpp>
#include <ricochet/measure/stability/plan_restitution.hpp>
#include <ricochet/scene/massless_part.hpp>

// Which contact points have impacts with inertia, and which of these a step resolves.

namespace ricochet {
namespace {

// hω up to which a step resolves the motion that an impact leaves; tangents are held for some steps.
constexpr double resolved_turn = 0.1;

}  // namespace

std::vector<bool> points_with_mass(const SemiDiscrete& problem) {
  std::vector<bool> massive(static_cast<std::size_t>(problem.points()), true);
  if (problem.inertia.kernel_dimension == 0) return massive;
  const MasslessPart massless(problem.stiffness, problem.inertia);
  const Eigen::VectorXd stiff = problem.stiffness.diagonal();
  for (int i = 0; i < problem.points(); ++i) {
    const Eigen::VectorXd push = problem.measured().row(i).transpose();
    double held = 0;  // what the push would store in each dof alone
    for (Eigen::Index j = 0; j < push.size(); ++j)
      if (push[j] != 0) held += 0.5 * push[j] * push[j] / stiff[j];
    massive[static_cast<std::size_t>(i)] = massless.energy(push) < 1e-9 * held;
  }
  return massive;
}

std::vector<std::optional<double>> point_restitutions(const Program& program) {
  const SemiDiscrete& problem = *program.problem;
  std::vector<std::optional<double>> all(static_cast<std::size_t>(problem.points()),
                                         plan_restitution(program.plan, program.h));
  for (std::size_t i = 0; i < problem.own.size(); ++i) {
    if (!problem.own[i].restitution) continue;
    StepPlan plan = program.plan;
    for (std::vector<Stage>* stages : {&plan.start, &plan.stages})
      for (Stage& stage : *stages)
        if (stage.impact && stage.impact->gate) stage.impact->gate->restitution = *problem.own[i].restitution;
    all[i] = plan_restitution(plan, program.h);
  }
  return all;
}

std::vector<bool> thrown_points(const Program& program, double least) {
  const SemiDiscrete& problem = *program.problem;
  std::vector<bool> thrown(static_cast<std::size_t>(problem.points()), false);
  if (!program.contact || program.law->reads()) return thrown;
  const std::vector<std::optional<double>> restitutions = point_restitutions(program);
  for (std::size_t i = 0; i < thrown.size(); ++i) thrown[i] = std::abs(restitutions[i].value_or(0)) >= least;
  if (std::find(thrown.begin(), thrown.end(), true) == thrown.end()) return thrown;
  const std::vector<bool> massive = points_with_mass(problem);
  for (std::size_t i = 0; i < thrown.size(); ++i) thrown[i] = thrown[i] && massive[i];
  return thrown;
}

std::vector<bool> resolved_points(const SemiDiscrete& problem, double h) {
  const auto given_way = [&](double time) {
    QuasiDefinite matrix;
    matrix.A = time * time * problem.stiffness;
    if (problem.inertia.assembled()) {
      matrix.A += problem.inertia.mass;
    } else {
      const MassFactors factors = mass_factors(problem.inertia);
      matrix.G = factors.coupling;
      matrix.Cv = factors.velocity_mass;
      matrix.border_first = problem.inertia.inverted();
    }
    return InverseForm(matrix);
  };
  const InverseForm within_step = given_way(h), at_once = given_way(1e-3 * h);
  std::vector<bool> resolved(static_cast<std::size_t>(problem.points()));
  for (int i = 0; i < problem.points(); ++i) {
    const Eigen::VectorXd push = problem.measured().row(i).transpose();
    const auto step = within_step(push), instant = at_once(push);
    resolved[static_cast<std::size_t>(i)] = step && instant && *instant <= (1 + resolved_turn * resolved_turn) * *step;
  }
  return resolved;
}

bool stops_met_at_steps(const Program& program) {
  const auto& stages = program.plan.stages;
  return program.contact && !program.law->reads() && std::any_of(stages.begin(), stages.end(), [](const Stage& stage) {
           return stage.impact && stage.impact->gate;
         });
}

bool twins_miss_impacts(const Program& program) {
  if (!stops_met_at_steps(program)) return false;
  const std::vector<bool> massive = points_with_mass(*program.problem);
  return std::find(massive.begin(), massive.end(), true) != massive.end();
}

bool tangents_miss_impacts(const Program& program) {
  if (!stops_met_at_steps(program)) return false;
  const std::vector<bool> massive = points_with_mass(*program.problem),
                          resolved = resolved_points(*program.problem, program.h);
  for (std::size_t i = 0; i < massive.size(); ++i)
    if (massive[i] && !resolved[i]) return true;
  return false;
}

}  // namespace ricochet
