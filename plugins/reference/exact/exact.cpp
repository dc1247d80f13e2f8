#include <fmt/format.h>

#include <ricochet/contract/plugin.hpp>
#include <ricochet/contract/said_format.hpp>

#include "bar_waves.hpp"
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
        "the contact law is not linear, and the flight on such a stop has no closed form: use the reference self. A "
        "rigid or a linear law has a closed form"};
  if (!problem.load_constant)
    return Refusal{
        "the load depends on t by a formula, and the flight under it has no closed form: use the reference self. The "
        "structure's own force F cos(ωt + ψ) has a closed form"};
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

Refusal no_bar(const std::string& why) {
  return Refusal{
      "the bar has a closed form when it is undamped and unloaded and its ends stand still. It must also touch "
      "nothing, or be stretched linearly at rest on a rigid stop at 0 at its tip. Here " +
      why + ": use event-driven-semi-discrete, or self"};
}

/// u(x, 0) = a (distance to the fixed end)/L and rest: returns a.
std::optional<double> stretched(const ReferenceProblem& problem, const BarFrame& bar) {
  const double L = bar.length, a = problem.displacement(bar.from_tip(0));
  for (int i = 0; i <= 16; ++i) {
    const double xi = L * i / 16, x = bar.from_tip(xi);
    if (std::abs(problem.displacement(x) - a * (1 - xi / L)) > 1e-12 * std::abs(a) || problem.velocity(x) != 0)
      return std::nullopt;
  }
  return a == 0 ? std::nullopt : std::optional(a);
}

ReferenceOrRefusal bouncing(const ReferenceProblem& problem, const BarFrame& bar, const SampleGrid& grid) {
  if (!problem.stops_at_tip || problem.left_fixed == problem.right_fixed)
    return no_bar("stops are elsewhere than at the only free end");
  if (problem.contact_stiffness > 0 || problem.contact_nonlinear) return no_bar("the contact law is compliant");
  const auto stretch = stretched(problem, bar);
  if (!stretch) return no_bar("the initial state is another one");
  const double a = *stretch, place = bar.from_tip(0), L = bar.length, c = bar.speed(), unit = L / c;
  const double near = a > 0 ? value_of(problem.lower, place, -INFINITY) : value_of(problem.upper, place, INFINITY);
  const double far = a > 0 ? value_of(problem.upper, place, INFINITY) : value_of(problem.lower, place, -INFINITY);
  if (near != 0) return no_bar("the stop that it is pulled from is not at 0");
  if (std::abs(far) < std::abs(a)) return no_bar("the other stop is in its way");
  ReferenceMotion found;
  const auto point = [&](double xi, double t) {
    const BarPoint now = BarBounce::at(xi / L, t / unit);
    return BarPoint{2 * a * now.displacement, 2 * a / L * now.strain, 2 * a / unit * now.velocity};
  };
  sample_bar(bar, grid, point, found.motion);
  for (const double t : grid.times) {
    found.motion.energy.push_back(4 * a * a * bar.stiffness / L * BarBounce::energy);
    found.motion.impulse.push_back(2 * a * bar.stiffness / c * BarBounce::impulse(t / unit));
  }
  const double end = grid.times.empty() ? 0 : grid.times.back();
  for (double start = unit; start <= end; start += 3 * unit) {
    found.motion.events.push_back({start, a > 0 ? -1 : 1, true, -a / unit});
    if (start + unit <= end) found.motion.events.push_back({start + unit, a > 0 ? -1 : 1, false, 0});
  }
  found.how = fmt::format("closed form of the bouncing bar, by characteristics: period 3L/c = {:.10g} s", 3 * unit);
  found.notes.emplace_back("a restitution coefficient has no part in it: the tip of a continuous bar has no mass");
  return found;
}

ReferenceOrRefusal waves(const ReferenceProblem& problem, const BarFrame& bar, const SampleGrid& grid) {
  const auto along = [&](const std::function<double(double)>& function) {
    return Chebyshev::of([&](double xi) { return function(bar.from_tip(xi)); }, bar.length);
  };
  const auto displacement = along(problem.displacement), velocity = along(problem.velocity);
  if (!displacement || !velocity) return no_bar("the initial state is not smooth");
  const bool fixed = problem.left_fixed || problem.right_fixed;
  const double size = std::abs((*displacement)(0)) + std::abs((*displacement)(bar.length / 3));
  const double rate = std::abs((*velocity)(0)) + std::abs((*velocity)(bar.length / 3));
  if (fixed &&
      (std::abs((*displacement)(bar.length)) > 1e-10 * size || std::abs((*velocity)(bar.length)) > 1e-10 * rate))
    return no_bar("the initial state moves the fixed end");
  const BarWaves found_waves(bar, fixed, *displacement, *velocity);
  ReferenceMotion found;
  sample_bar(
      bar, grid, [&](double xi, double t) { return found_waves.at(xi, t); }, found.motion);
  found.motion.energy.assign(grid.times.size(), found_waves.energy());
  found.motion.impulse.assign(grid.times.size(), 0);
  found.how = "d'Alembert's two waves of the bar that touches nothing, the initial state as Chebyshev series";
  return found;
}

ReferenceOrRefusal bar(const ReferenceProblem& problem, const SampleGrid& grid) {
  if (problem.damping_stiffness != 0 || problem.damping_mass != 0) return no_bar("it is damped");
  if (!problem.load_zero) return no_bar("it is loaded");
  if (problem.support_amplitude != 0) return no_bar("its support moves");
  if (problem.left_fixed && problem.right_fixed) return no_bar("both of its ends are fixed");
  if (!problem.displacement || !problem.velocity) return no_bar("the initial state is missing");
  const BarFrame frame{problem.length, problem.stiffness, problem.inertia, !problem.left_fixed};
  bool stops = false;
  for (const double x : problem.contact_absent ? std::vector<double>{} : problem.stop_places)
    stops = stops || std::isfinite(value_of(problem.lower, x, -INFINITY)) ||
            std::isfinite(value_of(problem.upper, x, INFINITY));
  auto found = stops ? bouncing(problem, frame, grid) : waves(problem, frame, grid);
  if (auto* motion = std::get_if<ReferenceMotion>(&found); motion && problem.projected)
    motion->notes.emplace_back("it starts from the formulas of the scene; the meshes start from their projection");
  return found;
}

/// Motions that closed forms know: the oscillator between stops, and bars.
class Exact final : public ReferenceSolver {
 public:
  ReferenceOrRefusal solve(const ReferenceProblem& problem, const SampleGrid& grid) const override {
    if (problem.structure == "oscillator") return oscillator(problem, grid);
    if (problem.structure == "bar") return bar(problem, grid);
    return Refusal{
        said("closed forms are known for the oscillator and the bar, not for a {}: use event-driven (rigid "
             "stops at the tip, or none). Otherwise use event-driven-semi-discrete (on the mesh), or self",
             problem.structure)};
  }
};

void register_exact(Registry& registry) {
  registry.add_reference(
      {.name = "exact",
       .summary = "closed forms: the oscillator between stops, the bar that bounces or touches nothing",
       .text = R"(Oscillator: flights under constant and harmonic force, on a moving support, in every regime of
          damping and in resonance; impacts v⁺ = −e v⁻ at rigid stops, rests on them while the force pushes, or
          phases on linear springs. Each arc is a closed form, counted from where it begins, and arcs join at zeros
          of gap and force that are bracketed by a bound of the curvature, so that none is missed, and polished to
          round-off; a bounce below 1e-15 of the highest ends a chattering. Bar, undamped and unloaded: at rest and
          stretched linearly from a rigid stop at 0 at its tip, it bounces with period 3L/c; touching nothing, it is
          d'Alembert's two waves. Everything else is refused.)",
       .source = R"(Shaw and Holmes (1983), A periodically forced piecewise linear oscillator, J. Sound Vib. 90 (the
          oscillator); characteristics (the bar), as in Doyen, Ern and Piperno (2011), Time-integration schemes for
          the finite element dynamic Signorini problem)",
       .parameters = {}},
      [](const Parameters&) { return std::make_unique<Exact>(); });
}

}  // namespace

RICOCHET_PLUGIN(reference, exact, register_exact)
