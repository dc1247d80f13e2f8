#include "runners/march/study_identity.hpp"

#include <cmath>
#include <memory>
#include <ricochet/contract/contact_law.hpp>
#include <ricochet/contract/mass_strategy.hpp>
#include <ricochet/engine/marcher.hpp>
#include <stdexcept>

#include "runners/store/fingerprint.hpp"

namespace ricochet {
namespace {

// Methods of its own: a digest may not depend on the plugins that are there.

class GalerkinMass final : public MassStrategy {
 public:
  InertiaOrRefusal build(const FiniteElementSpace& space) const override {
    Inertia inertia;
    inertia.mass = consistent_mass(space);
    return inertia;
  }
};

/// A rigid stop at one point: lower ≤ free + reach W p ≤ upper.
class RigidPoint final : public ContactLaw {
 public:
  void prepare(int, std::span<const Parameters>) override {}
  void solve(ReducedProblem& problem) override {
    const double slope = problem.reach * problem.delassus->column(0)[0];
    for (const int lane : problem.touched) {
      const double free = problem.free[lane];
      problem.effort[lane] = (std::fmin(std::fmax(free, problem.lower[lane]), problem.upper[lane]) - free) / slope;
      problem.outcome[lane] = {};
    }
  }
};

/// The mid-point rule with z = v_{n+1} − v_n:
///     (M/h + ½C + h/4 K) z = F(t + h/2) − C v − K(q + h/2 v) + Hᵀp,   q ← q + h v + h/2 z,   v ← v + z,   y = H q
StepPlan midpoint_plan(double h) {
  StepPlan plan;
  plan.slots = {"q", "v"};
  plan.initial = {{1, 0}, {0, 1}};
  Stage step;
  step.matrix = {1 / h, 0.5, h / 4};
  step.history = {{0, 0, -1}, {0, -1, -h / 2}};
  step.load = {{0.5, 1}};
  step.update = {{.slots = {1, h}, .z = h / 2}, {.slots = {0, 1}, .z = 1}};
  step.impact = {.value = step.update[0]};
  plan.stages = {step};
  plan.velocity = {.slots = {0, 1}};
  plan.facts.order = 2;
  return plan;
}

SceneSpec forced_beam() {
  BeamSpec beam;
  beam.length = 1.5;
  beam.young = 2e11;
  beam.density = 8000;
  beam.section.outer_diameter = 0.01;
  beam.section.wall = 5e-4;
  beam.damping.stiffness = 1e-4;
  SceneSpec scene;
  scene.structure = beam;
  scene.stops.lower = Formula(-0.1);
  scene.stops.upper = Formula(0.1);
  scene.stops.place = StopsSpec::Place::tip;
  scene.support = {0.02, 26, 0.3};
  scene.load = Formula("exp(-x)*sin(40*t)", "");
  scene.initial.displacement = Formula("0.04*x^2", "");
  scene.initial.velocity = Formula("-2*x", "");
  return scene;
}

void add(std::string& bytes, double value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void add_march(std::string& bytes, const std::shared_ptr<const SemiDiscrete>& problem, OperatorKind kind) {
  constexpr int parts = 8, steps_of_part = 40, lanes = 3;
  constexpr double h = 1e-3;
  CompileOptions options;
  options.kind = kind;
  std::vector<LaneSpec> block(lanes, scene_lane(*problem, {}));
  for (int lane = 0; lane < lanes; ++lane) block[static_cast<std::size_t>(lane)].amplitude *= 1 + 0.1 * lane;
  auto compiled = compile(problem, midpoint_plan(h), h, std::make_unique<RigidPoint>(), std::move(block), options);
  if (const auto* refusal = std::get_if<Refusal>(&compiled)) throw std::logic_error(refusal->sentence.text);
  Marcher marcher(std::move(std::get<Program>(compiled)));
  marcher.start();
  for (int part = 0; part < parts; ++part) {
    marcher.march(steps_of_part);
    for (int lane = 0; lane < lanes; ++lane)
      for (const double x : marcher.lane_state(lane).slots) add(bytes, x);
  }
}

void add_functions(std::string& bytes) {
  constexpr int values = 200;
  for (int i = 0; i < values; ++i) {
    volatile double given = 0.05 + 0.37 * i;  // not for the compiler to work out
    const double x = given;
    for (const double value :
         {std::sin(x), std::cos(x), std::tan(x), std::exp(-x / 8), std::expm1(x / 50), std::log(x), std::pow(x, 1.7),
          std::sqrt(x), std::cbrt(x), std::hypot(x, 3.1), std::atan2(x, 2.3), std::tanh(x / 40), std::sinh(x / 40)})
      add(bytes, value);
  }
}

std::string digest() {
  constexpr int elements = 12;
  auto discretised = discretise(forced_beam(), elements, GalerkinMass());
  if (const auto* refusal = std::get_if<Refusal>(&discretised)) throw std::logic_error(refusal->sentence.text);
  const auto problem = std::make_shared<const SemiDiscrete>(std::move(std::get<SemiDiscrete>(discretised)));
  std::string bytes;
  for (const OperatorKind kind : {OperatorKind::band, OperatorKind::modal, OperatorKind::sparse})
    add_march(bytes, problem, kind);
  add_functions(bytes);
  constexpr std::size_t digits = 12;
  return content_hash(bytes).substr(0, digits);
}

}  // namespace

const std::string& arithmetic_digest() {
  static const std::string found = digest();
  return found;
}

std::vector<std::filesystem::path> libraries_of(const StudyCase& study_case, const Registry& registry) {
  std::vector<std::filesystem::path> files = {registry.file(Role::mass, study_case.mass.name),
                                              registry.file(Role::contact, study_case.contact.name)};
  if (!study_case.friction.name.empty()) files.push_back(registry.file(Role::friction, study_case.friction.name));
  // A plan is content of the case already, wherever it was read.
  if (!study_case.time.plan) files.push_back(registry.file(Role::time, study_case.time.name));
  if (study_case.of_reference) files.push_back(registry.file(Role::reference, study_case.references.front().name));
  return files;
}

std::string StudyIdentity::of(const StudyCase& study_case) {
  return fingerprints_.of(study_case, libraries_of(study_case, registry_));
}

std::string StudyIdentity::of_all() {
  std::string all;
  for (const StudyCase& one : study_.cases) all += of(one);
  return content_hash(all);
}

}  // namespace ricochet
