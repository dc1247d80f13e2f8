#include <fmt/format.h>

#include <ricochet/contract/plugin.hpp>

#include "impact_oscillator.hpp"

namespace {

using namespace ricochet;
using namespace ricochet::reference;

double value_of(const std::function<double(double)>& function, double x, double otherwise) {
  return function ? function(x) : otherwise;
}

ReferenceOrRefusal oscillator(const ReferenceProblem& problem, const SampleGrid& grid) {
  if (problem.contact_nonlinear)
    return Refusal{
        "the contact law is not linear, and the flight on such a stop has no closed form: use the reference "
        "self, or a rigid or linear law"};
  if (!problem.load_constant)
    return Refusal{
        "the load depends on t by a formula, and the flight under it has no closed form: use the structure's "
        "own force F cos(ωt + ψ), or the reference self"};
  OscillatorSpec spec;
  spec.mass = problem.inertia;
  spec.stiffness = problem.stiffness;
  spec.viscosity = problem.damping_mass * problem.inertia + problem.damping_stiffness * problem.stiffness;
  if (!problem.load_zero && problem.load) spec.force.add_constant(problem.load(0, 0));
  if (problem.force_amplitude != 0)
    spec.force.add_cosine(problem.force_amplitude, problem.force_pulsation, problem.force_phase);
  if (problem.support_amplitude != 0) {
    const Complex support = std::polar(problem.support_amplitude, problem.support_phase - M_PI / 2);
    spec.support.add(support, problem.support_pulsation);
    spec.force.add((spec.stiffness + Complex(0, spec.viscosity * problem.support_pulsation)) * support,
                   problem.support_pulsation);
  }
  const bool stops = !problem.contact_absent && !problem.stop_places.empty();
  if (stops) {
    spec.lower = value_of(problem.lower, 0, spec.lower);
    spec.upper = value_of(problem.upper, 0, spec.upper);
  }
  spec.restitution = problem.restitution;
  spec.contact_stiffness = problem.contact_stiffness;
  spec.position = value_of(problem.displacement, 0, 0);
  spec.velocity = value_of(problem.velocity, 0, 0);

  auto sampled = ImpactOscillator(spec).sample(grid);
  if (auto* refusal = std::get_if<Refusal>(&sampled)) return *refusal;
  ReferenceMotion found;
  found.motion = std::get<SampledMotion>(std::move(sampled));
  found.how = "closed form of each flight and of each phase on a stop, joined at the zeros of gap and force";
  if (!stops) return found;
  found.notes.push_back(
      spec.contact_stiffness > 0
          ? fmt::format("the stops are linear springs of {:.6g} N/m; a restitution coefficient has no part in it",
                        spec.contact_stiffness)
          : fmt::format("rigid stops, restitution {:g}; a bounce below 1e-15 of the highest ends a chattering",
                        spec.restitution));
  return found;
}

/// Motions that closed forms know: the oscillator between stops, and a bar that bounces with period 3L/c.
class Exact final : public ReferenceSolver {
 public:
  ReferenceOrRefusal solve(const ReferenceProblem& problem, const SampleGrid& grid) const override {
    if (problem.structure == "oscillator") return oscillator(problem, grid);
    return Refusal{"no closed form is known for this scene"};
  }
};

void register_all(Registry& registry) {
  registry.add_reference({.name = "exact",
                          .summary = "closed forms: the oscillator between stops, and the bar of period 3L/c",
                          .text = "Oscillator: flights, rests on a rigid stop and phases on a spring are closed forms.",
                          .source = "Shaw and Holmes (1983)",
                          .parameters = {}},
                         [](const Parameters&) { return std::make_unique<Exact>(); });
}

}  // namespace

RICOCHET_PLUGIN(reference, exact, register_all)
