#include "runners/check/bench.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <ricochet/contract/plugin_call.hpp>
#include <ricochet/kernels/eigenvalues.hpp>
#include <ricochet/scene/observed_rows.hpp>

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
  if (auto* refusal = std::get_if<Refusal>(&made)) throw Refused{refusal->sentence.text};
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
  if (auto* refusal = std::get_if<Refusal>(&answer)) throw Refused{refusal->sentence.text};
  return std::move(std::get<StepPlan>(answer));
}

Marcher marcher_of(const ProblemPointer& problem, StepPlan plan, double h, std::unique_ptr<ContactLaw> law,
                   std::vector<LaneSpec> lanes, OperatorKind kind) {
  if (const auto wrong = check_plan(plan)) throw Refused{"the plan is ill-formed: " + *wrong};
  if (lanes.empty()) lanes = {scene_lane(*problem, {})};
  CompileOptions options;
  options.kind = kind;
  auto program = compile(problem, std::move(plan), h, std::move(law), std::move(lanes), options);
  if (auto* refusal = std::get_if<Refusal>(&program)) throw std::runtime_error(refusal->sentence.text);
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

HarmonicMotion::HarmonicMotion(double m, double c, double k, double constant, std::vector<Term> terms, double w,
                               double v, double start)
    : decay_(c / (2 * m)),
      ringing_(std::sqrt(k / m - decay_ * decay_)),
      rest_(constant / k),
      start_(start),
      response_(std::move(terms)) {
  // (k − mω²)A + cωB = a,  (k − mω²)B − cωA = b for A cos + B sin.
  for (Term& term : response_) {
    const double stiff = k - m * term.pulsation * term.pulsation, damp = c * term.pulsation;
    const double size = stiff * stiff + damp * damp;
    const double cosine = (stiff * term.cosine - damp * term.sine) / size;
    const double sine = (stiff * term.sine + damp * term.cosine) / size;
    term.cosine = cosine;
    term.sine = sine;
  }
  const double w_forced = displacement(start), v_forced = velocity(start);
  along_ = w - w_forced;
  across_ = (v - v_forced + decay_ * along_) / ringing_;
}

double HarmonicMotion::displacement(double t) const {
  const double s = t - start_, angle = ringing_ * s;
  double w = rest_ + std::exp(-decay_ * s) * (along_ * std::cos(angle) + across_ * std::sin(angle));
  for (const Term& term : response_)
    w += term.cosine * std::cos(term.pulsation * t) + term.sine * std::sin(term.pulsation * t);
  return w;
}

double HarmonicMotion::velocity(double t) const {
  const double s = t - start_, angle = ringing_ * s;
  double v = std::exp(-decay_ * s) * ((across_ * ringing_ - decay_ * along_) * std::cos(angle) -
                                      (along_ * ringing_ + decay_ * across_) * std::sin(angle));
  for (const Term& term : response_)
    v += term.pulsation * (term.sine * std::cos(term.pulsation * t) - term.cosine * std::sin(term.pulsation * t));
  return v;
}

MeasuredOrder measured_order(const std::vector<double>& steps, const std::vector<double>& errors, double scale) {
  MeasuredOrder result;
  result.finest = errors.back();
  result.exact = *std::max_element(errors.begin(), errors.end()) <= 1e-11 * scale;
  if (result.exact) return result;
  const std::size_t used = std::min<std::size_t>(3, errors.size()), first = errors.size() - used;
  double x = 0, y = 0, xx = 0, xy = 0;
  for (std::size_t i = first; i < errors.size(); ++i) {
    const double a = std::log(steps[i]), b = std::log(std::max(errors[i], 1e-13 * scale));
    x += a;
    y += b;
    xx += a * a;
    xy += a * b;
  }
  const auto n = static_cast<double>(used);
  result.order = (n * xy - x * y) / (n * xx - x * x);
  return result;
}

namespace {

constexpr double no_stop = std::numeric_limits<double>::infinity();

SampleGrid grid_of(double duration, int samples, const std::vector<double>& places) {
  SampleGrid grid;
  for (int k = 0; k <= samples; ++k) grid.times.push_back(duration * k / samples);
  grid.places = places;
  grid.weights.assign(places.size(), places.empty() ? 0 : 1.0 / static_cast<double>(places.size()));
  return grid;
}

ReferenceScene described(std::string name, SceneSpec scene, int elements, double duration,
                         const std::vector<double>& places) {
  ReferenceScene described;
  described.name = std::move(name);
  described.grid = grid_of(duration, 40, places);
  const ProblemPointer problem = discretised(scene, elements);
  described.discrete = std::make_shared<DiscreteProblem>(discrete_problem(*problem, described.grid.places));
  ReferenceProblem& asked = described.problem;
  asked.discrete = described.discrete.get();
  asked.structure = problem->space.structure;
  asked.left_fixed = problem->space.left_fixed;
  asked.right_fixed = problem->space.right_fixed;
  asked.displacement = [formula = scene.initial.displacement](double x) { return formula(x); };
  asked.velocity = [formula = scene.initial.velocity](double x) { return formula(x); };
  asked.load_zero = true;
  asked.load = [](double, double) { return 0.0; };
  asked.stop_places = problem->contact_x;
  asked.stops_at_tip = !problem->contact_x.empty();
  const double lower = scene.stops.lower ? (*scene.stops.lower)(0) : -no_stop;
  asked.lower = [lower](double) { return lower; };
  asked.upper = [](double) { return no_stop; };
  asked.contact_absent = problem->contact_x.empty();
  return described;
}

ReferenceScene free_oscillator() {
  const SceneSpec scene =
      oscillator_scene({.mass = 2, .stiffness = 8, .damping = 0.4, .position = 0.3, .velocity = -1});
  ReferenceScene made = described("a free oscillator", scene, 1, 4, {});
  made.problem.stiffness = 8;
  made.problem.inertia = 2;
  made.problem.damping_mass = 0.2;
  const HarmonicMotion exact(2, 0.4, 8, 0, {}, 0.3, -1);
  made.exact = [exact](double t) { return exact.displacement(t); };
  return made;
}

ReferenceScene forced_oscillator() {
  SceneSpec scene = oscillator_scene({.mass = 2, .stiffness = 8, .damping = 0.4, .position = 0.3, .velocity = -1});
  std::get<OscillatorSpec>(scene.structure).force = {3, 1.3, 0.4};
  ReferenceScene made = described("a forced oscillator", scene, 1, 4, {});
  made.problem.stiffness = 8;
  made.problem.inertia = 2;
  made.problem.damping_mass = 0.2;
  made.problem.force_amplitude = 3;
  made.problem.force_pulsation = 1.3;
  made.problem.force_phase = 0.4;
  const HarmonicMotion exact(2, 0.4, 8, 0, {{3 * std::cos(0.4), -3 * std::sin(0.4), 1.3}}, 0.3, -1);
  made.exact = [exact](double t) { return exact.displacement(t); };
  return made;
}

// Let go at 0.5 m, it falls on a stop at 0 after a quarter of its period and rebounds with e times its speed.
ReferenceScene bouncing_oscillator() {
  constexpr double e = 0.8, height = 0.5, omega = 2, quarter = 0.5 * 1.5707963267948966;
  ReferenceScene made =
      described("a bouncing oscillator",
                oscillator_scene({.mass = 2, .stiffness = 8, .position = height, .stop = true}), 1, 2, {});
  made.problem.stiffness = 8;
  made.problem.inertia = 2;
  made.problem.restitution = e;
  made.exact = [](double t) {
    return t < quarter ? height * std::cos(omega * t) : e * height * std::sin(omega * (t - quarter));
  };
  return made;
}

ReferenceScene bar_on_its_stop() {
  StructureBench bench;
  bench.stops = true;
  SceneSpec scene = structure_scene(bench);
  scene.initial.velocity = Formula(0.0);
  scene.stops.lower = Formula(0.0);
  scene.stops.upper.reset();
  ReferenceScene made = described("a bar on its stop", scene, 6, 2.5, {0.25, 0.5, 0.75});
  made.problem.length = made.problem.stiffness = made.problem.inertia = 1;
  made.tip = 0;
  return made;
}

ReferenceScene cantilever() {
  SceneSpec scene = structure_scene({.beam = true, .stops = true});
  scene.initial.velocity = Formula(0.0);
  scene.stops.upper.reset();
  ReferenceScene made = described("a cantilever against a stop", scene, 4, 0.6, {0.25, 0.5, 0.75});
  made.problem.length = made.problem.stiffness = made.problem.inertia = 1;
  made.tip = 1;
  return made;
}

}  // namespace

std::vector<ReferenceScene> reference_scenes() {
  return {free_oscillator(), forced_oscillator(), bouncing_oscillator(), bar_on_its_stop(), cantilever()};
}

}  // namespace ricochet::checking
