#include <cmath>
#include <limits>
#include <ricochet/scene/checks.hpp>

#include "runners/kinds/comparison/references.hpp"
#include "runners/march/prepare_case.hpp"

namespace ricochet {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

std::function<double(double)> of_x(const Formula& formula) {
  return [formula](double x) { return formula(x); };
}
std::function<double(double)> of_x(const std::optional<Formula>& formula, double absent) {
  if (!formula) return [absent](double) { return absent; };
  return of_x(*formula);
}

void describe(const BeamSpec& beam, ReferenceProblem& problem) {
  const SectionProperties section = section_properties(beam.section, beam.young, beam.density);
  problem.structure = "beam";
  problem.length = beam.length;
  problem.stiffness = section.EI;
  problem.inertia = section.rhoS;
  problem.damping_stiffness = beam.damping.stiffness;
  problem.damping_mass = beam.damping.mass;
  problem.left_fixed = true;
}
void describe(const BarSpec& bar, ReferenceProblem& problem) {
  problem.structure = "bar";
  problem.length = bar.length;
  problem.stiffness = bar.EA;
  problem.inertia = bar.rhoA;
  problem.damping_stiffness = bar.damping.stiffness;
  problem.damping_mass = bar.damping.mass;
  problem.left_fixed = bar.fixed == BarSpec::Fixed::left;
  problem.right_fixed = bar.fixed == BarSpec::Fixed::right;
}
void describe(const OscillatorSpec& oscillator, ReferenceProblem& problem) {
  problem.structure = "oscillator";
  problem.stiffness = oscillator.stiffness;
  problem.inertia = oscillator.mass;
  problem.damping_mass = oscillator.damping / oscillator.mass;
  problem.force_amplitude = oscillator.force.amplitude;
  problem.force_pulsation = oscillator.force.pulsation;
  problem.force_phase = oscillator.force.phase;
}

}  // namespace

ReferenceProblem reference_problem(const StudyCase& study_case, const Registry& registry) {
  const SceneSpec& scene = study_case.scene;
  ReferenceProblem problem;
  std::visit([&](const auto& structure) { describe(structure, problem); }, scene.structure);
  problem.support_amplitude = scene.support.amplitude;
  problem.support_pulsation = scene.support.pulsation;
  problem.support_phase = scene.support.phase;
  problem.load_zero = scene.load.is_zero();
  problem.load_constant = !scene.load.uses_t();
  problem.load = [load = scene.load](double x, double t) { return load.spread(x, t); };
  problem.displacement = of_x(scene.initial.displacement);
  problem.velocity = of_x(scene.initial.velocity);
  problem.projected = scene.initial.projection == InitialSpec::Projection::constraint;
  problem.stop_places = contact_positions(scene, study_case.elements);
  problem.stops_at_nodes = scene.stops.place == StopsSpec::Place::nodes && problem.structure != "oscillator";
  problem.stops_at_tip = problem.stop_places.size() == 1 &&
                         std::abs(problem.stop_places[0] - tip_position(scene)) <= 1e-12 * problem.length;
  problem.lower = of_x(scene.stops.lower, -infinity);
  problem.upper = of_x(scene.stops.upper, infinity);
  auto law = make_law(study_case, registry);
  problem.contact_absent = law->absent();
  if (law->reads()) {
    const Parameters parameters = study_case.contact.parameters;
    law->prepare(std::max<int>(1, static_cast<int>(problem.stop_places.size())), {&parameters, 1});
    const auto stiffness = constant_stiffness(*law);
    problem.contact_nonlinear = !stiffness;
    problem.contact_stiffness = stiffness.value_or(0);
  }
  problem.restitution = scheme_restitution(study_case, registry).value_or(0);
  return problem;
}

}  // namespace ricochet
