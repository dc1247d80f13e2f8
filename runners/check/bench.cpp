#include "runners/check/bench.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <ricochet/contract/plugin_call.hpp>
#include <ricochet/kernels/eigenvalues.hpp>

namespace ricochet::checking {
namespace {

class Consistent final : public MassStrategy {
 public:
  InertiaOrRefusal build(const FiniteElementSpace& space) const override {
    Inertia inertia;
    inertia.mass = consistent_mass(space);
    return inertia;
  }
};

class MasslessEnds final : public MassStrategy {
 public:
  InertiaOrRefusal build(const FiniteElementSpace& space) const override {
    Inertia inertia;
    inertia.mass.resize(space.dofs, space.dofs);
    Eigen::VectorXd diagonal = Eigen::VectorXd::Zero(space.dofs);
    for (const auto& element : space.elements)
      for (std::size_t a = 0; a < 2; ++a)
        if (element.dof[a] >= 0) diagonal[element.dof[a]] += 0.5 * element.line_density * element.length;
    if (!space.left_fixed) diagonal[space.elements.front().dof[0]] = 0;
    if (!space.right_fixed) diagonal[space.elements.back().dof[1]] = 0;
    for (int i = 0; i < space.dofs; ++i) {
      if (diagonal[i] == 0)
        ++inertia.kernel_dimension;
      else
        inertia.mass.insert(i, i) = diagonal[i];
    }
    inertia.mass.makeCompressed();
    return inertia;
  }
};

}  // namespace

std::unique_ptr<MassStrategy> consistent_bench_mass() {
  return std::make_unique<Consistent>();
}
std::unique_ptr<MassStrategy> massless_ends() {
  return std::make_unique<MasslessEnds>();
}

SceneSpec oscillator_scene(const OscillatorBench& bench) {
  SceneSpec scene;
  scene.structure =
      OscillatorSpec{.mass = bench.mass, .stiffness = bench.stiffness, .damping = bench.damping, .force = {}};
  if (bench.force != 0) scene.load = Formula(fmt::format("{:.17g}*cos(1.3*t+0.4)", bench.force), "/scene/load", "xt");
  if (bench.support != 0) scene.support = {bench.support, 1.7, 0.3};
  if (bench.stop) {
    scene.stops.lower = Formula(0.0);
    scene.stops.place = StopsSpec::Place::tip;
  }
  scene.initial.displacement = Formula(bench.position);
  scene.initial.velocity = Formula(bench.velocity);
  return scene;
}

SceneSpec structure_scene(const StructureBench& bench) {
  SceneSpec scene;
  if (bench.beam) {
    BeamSpec beam;
    beam.length = 1;
    beam.young = beam.density = 1;
    beam.section.type = Section::Type::given;
    beam.section.EI = beam.section.rhoS = 1;
    beam.damping.stiffness = bench.damping;
    scene.structure = beam;
    scene.initial.displacement = Formula("0.04*x^2", "/scene/initial/displacement", "x");
    scene.initial.velocity = Formula("-0.3*x", "/scene/initial/velocity", "x");
  } else {
    BarSpec bar;
    bar.damping.stiffness = bench.damping;
    scene.structure = bar;
    scene.initial.displacement = Formula("0.04*(1-x)", "/scene/initial/displacement", "x");
    scene.initial.velocity = Formula("-0.1*(1-x)", "/scene/initial/velocity", "x");
  }
  if (bench.load)
    scene.load = Formula(bench.beam ? "0.2*x*cos(3*t+0.4)" : "0.05*(1-x)*cos(3*t+0.4)", "/scene/load", "xt");
  if (bench.support) scene.support = {0.005, 4, 0.3};
  if (bench.stops) {
    scene.stops.lower = Formula(-0.05);
    scene.stops.upper = Formula(0.05);
    scene.stops.place = bench.everywhere ? StopsSpec::Place::nodes : StopsSpec::Place::tip;
  }
  return scene;
}

ProblemPointer discretised(const SceneSpec& scene, int elements, const MassStrategy& mass, ContactLaw* law) {
  auto made = discretise(scene, elements, mass, law);
  if (auto* refusal = std::get_if<Refusal>(&made)) throw Refused{refusal->sentence};
  return std::make_shared<const SemiDiscrete>(std::move(std::get<SemiDiscrete>(made)));
}
ProblemPointer discretised(const SceneSpec& scene, int elements) {
  const bool oscillator = std::holds_alternative<OscillatorSpec>(scene.structure);
  return discretised(scene, oscillator ? 1 : elements, Consistent());
}

Pulsations pulsations(const SemiDiscrete& problem) {
  const Eigen::MatrixXd K = problem.stiffness, M = problem.inertia.mass;
  const Eigen::VectorXd mu = symmetric_modes(M, K, EigenVectors::none).values;
  const double largest = mu[mu.size() - 1];
  double smallest = largest;
  for (const double x : mu)
    if (x > 1e-12 * largest) smallest = std::min(smallest, x);
  return {1 / std::sqrt(largest), 1 / std::sqrt(smallest)};
}

double sound_step(const Scheme& scheme, const SemiDiscrete& problem, double share) {
  const Pulsations of = pulsations(problem);
  const double wanted = share * 2 * std::numbers::pi / of.least;
  const StepPlan plan = plan_of(scheme, wanted, {});
  return plan.facts.stability_limit ? std::min(wanted, 0.4 * *plan.facts.stability_limit / of.most) : wanted;
}

PlanOrRefusal ask_plan(const Scheme& scheme, double h, const ProblemFacts& facts) {
  const PluginIdentity identity{"time", scheme.entry->manual.name, scheme.entry->file};
  const PluginCallScope scope(identity, "plan");
  return scheme.make()->plan(h, facts);
}

StepPlan plan_of(const Scheme& scheme, double h, const ProblemFacts& facts) {
  PlanOrRefusal answer = ask_plan(scheme, h, facts);
  if (auto* refusal = std::get_if<Refusal>(&answer)) throw Refused{refusal->sentence};
  return std::move(std::get<StepPlan>(answer));
}

Marcher marcher_of(const ProblemPointer& problem, StepPlan plan, double h, std::unique_ptr<ContactLaw> law,
                   std::vector<LaneSpec> lanes, OperatorKind kind) {
  if (const auto wrong = check_plan(plan)) throw Refused{"the plan is ill-formed: " + *wrong};
  if (lanes.empty()) lanes = {scene_lane(*problem, {})};
  CompileOptions options;
  options.kind = kind;
  auto program = compile(problem, std::move(plan), h, std::move(law), std::move(lanes), options);
  if (auto* refusal = std::get_if<Refusal>(&program)) throw std::runtime_error(refusal->sentence);
  return Marcher(std::move(std::get<Program>(program)));
}

Marcher marcher_of(const Scheme& scheme, const ProblemPointer& problem, double h, std::unique_ptr<ContactLaw> law,
                   std::vector<LaneSpec> lanes, OperatorKind kind) {
  StepPlan plan = plan_of(scheme, h, problem_facts(*problem, *law));
  return marcher_of(problem, std::move(plan), h, std::move(law), std::move(lanes), kind);
}

double declared_restitution(const Scheme& scheme) {
  return value_of_role(scheme.entry->manual.parameters, scheme.set.values, ParameterRole::restitution).value_or(0);
}

}  // namespace ricochet::checking
