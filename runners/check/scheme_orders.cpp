#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <ricochet/measure/stability/step_map.hpp>

#include "runners/check/scheme_checks.hpp"

namespace ricochet::checking {
namespace {

constexpr double duration = 4;   // s: 1.3 periods of the free oscillator
constexpr double slower = 0.25;  // a measured order may fall short of the declared one by so much
constexpr double faster = 0.6;   // and may exceed it by so much before the declaration is wrong

struct Errors {
  std::vector<double> steps, displacement, velocity;
};

// w of the oscillator in the frame of its support, with a glued spring κ, η to a stop at `stop` or without (κ = 0).
HarmonicMotion closed_form(const OscillatorBench& of, double kappa = 0, double eta = 0, double stop = 0) {
  const double A = of.support, omega = 1.7, phase = 0.3, s = std::sin(phase), c = std::cos(phase);
  // −mφ'' − κφ − ηφ' of φ = A sin(ωt + ψ), and F cos(1.3t + 0.4).
  const double along = (of.mass * omega * omega - kappa) * A, rate = -eta * A * omega;
  std::vector<HarmonicMotion::Term> terms = {{along * s + rate * c, along * c - rate * s, omega},
                                             {of.force * std::cos(0.4), -of.force * std::sin(0.4), 1.3}};
  return HarmonicMotion(of.mass, of.damping + eta, of.stiffness + kappa, kappa * stop, std::move(terms),
                        of.position - A * s, of.velocity - A * omega * c);
}

// A coarsest step that every scheme can make.
double coarsest(const Scheme& scheme, double pulsation) {
  const StepPlan plan = plan_of(scheme, 0.1, {1, 0, false, false});
  double h = 0.2;
  while (plan.facts.stability_limit && h * pulsation > 0.4 * *plan.facts.stability_limit) h /= 2;
  return h;
}

Errors march_against(const Scheme& scheme, const OscillatorBench& bench, const HarmonicMotion& exact, double coarse,
                     const std::function<std::unique_ptr<ContactLaw>()>& law, double stop) {
  const ProblemPointer problem = discretised(oscillator_scene(bench));
  Errors errors;
  for (double h = coarse; errors.steps.size() < 4; h /= 2) {
    LaneSpec lane = scene_lane(*problem, {});
    if (lane.lower.size() > 0) lane.lower[0] = stop;
    Marcher marcher = marcher_of(scheme, problem, h, law(), {lane});
    const Combination& velocity = marcher.program().plan.velocity;
    marcher.start();
    double worst = 0, worst_velocity = 0;
    const auto steps = std::llround(duration / h);
    while (marcher.step() < steps) {
      marcher.march(1);
      const double t = marcher.time();
      worst = std::max(worst, std::abs(marcher.position(0)[0] - exact.displacement(t)));
      if (marcher.step() < 3) continue;  // means over a step that the start rule makes stand elsewhere
      double v = 0;
      for (std::size_t j = 0; j < velocity.slots.size(); ++j)
        v += velocity.slots[j] * marcher.slot(static_cast<int>(j))[0];
      worst_velocity =
          std::max(worst_velocity, std::abs(v - exact.velocity(t + marcher.program().velocity_offset * h)));
    }
    if (!marcher.status(0).running)
      throw std::runtime_error("the oscillator's integration stopped: " + text(marcher.status(0).end));
    errors.steps.push_back(h);
    errors.displacement.push_back(worst);
    errors.velocity.push_back(worst_velocity);
  }
  return errors;
}

Errors free_oscillator(const Scheme& scheme, const OscillatorBench& bench) {
  return march_against(scheme, bench, closed_form(bench), coarsest(scheme, 2), no_contact, 0);
}

double declared_order(const Scheme& scheme) {
  return plan_of(scheme, 0.1, {1, 0, true, false}).facts.order;
}

std::string numbers(const MeasuredOrder& measured) {
  if (measured.exact) return "errors are round-off";
  return fmt::format("measured {:.2f} (error {:.2g} at the finest of 4 steps)", measured.order, measured.finest);
}

// Loads of any kind: no worse than without, no fact of its own.
Verdict no_worse(const Scheme& scheme, const OscillatorBench& bench, const char* what) {
  const Errors errors = free_oscillator(scheme, bench);
  const MeasuredOrder measured = measured_order(errors.steps, errors.displacement, 1);
  const double declared = declared_order(scheme);
  if (!measured.exact && !(measured.order >= declared - slower))
    return fails(fmt::format("{} spoils the order: declared {:g}, {}: is it taken at the scheme's own times?", what,
                             declared, numbers(measured)));
  return fine(numbers(measured));
}

}  // namespace

Verdict order_as_declared(const Scheme& scheme) {
  const double declared = declared_order(scheme);
  const OscillatorBench bench{.damping = 0.4, .position = 0.3, .velocity = -1};
  const Errors errors = free_oscillator(scheme, bench);
  const MeasuredOrder measured = measured_order(errors.steps, errors.displacement, 0.6);
  if (measured.exact) return fine("errors are round-off");
  if (!(measured.order >= declared - slower))
    return fails(fmt::format("declares order {:g} with this start rule, {}, on the damped oscillator in free flight",
                             declared, numbers(measured)));
  if (measured.order > declared + faster)
    return fails(fmt::format("declares order {:g}, {}: declare what it has", declared, numbers(measured)));
  // A plan may be another one where nothing is damped, and where there is a stop; this one is never met.
  const struct {
    const char* where;
    OscillatorBench bench;
    ProblemFacts facts;
  } others[] = {{"without damping", {.position = 0.3, .velocity = -1}, {1, 0, false, false}},
                {"beside a stop that it never meets",
                 {.damping = 0.4, .position = 0.3, .velocity = -1, .stop = true},
                 {1, 0, true, true}}};
  for (const auto& [where, other, facts] : others) {
    if (other.stop && !measures(plan_of(scheme, 0.1, facts))) continue;
    const double of_these = plan_of(scheme, 0.1, facts).facts.order;
    const Errors found = march_against(scheme, other, closed_form(other), coarsest(scheme, 2),
                                       other.stop ? rigid_stops : no_contact, -1e3);
    const MeasuredOrder order = measured_order(found.steps, found.displacement, 0.6);
    if (!order.exact && !(order.order >= of_these - slower))
      return fails(fmt::format("declares order {:g} with this start rule, {}, on the oscillator {}", of_these,
                               numbers(order), where));
  }
  return fine(fmt::format("declared {:g}, {}", declared, numbers(measured)));
}

Verdict velocity_stands_right(const Scheme& scheme) {
  const OscillatorBench bench{.damping = 0.4, .force = 3, .position = 0.3, .velocity = -1};
  const Errors errors = free_oscillator(scheme, bench);
  const MeasuredOrder measured = measured_order(errors.steps, errors.velocity, 1);
  const double expected = std::min(2.0, declared_order(scheme));
  if (!measured.exact && !(measured.order >= expected - slower))
    return fails(
        fmt::format("the plan's velocity is no velocity at the time where it stands: it tends to q' with order {:.2f}. "
                    "The error is {:.2g} m/s at the finest step. Expected order {:g}",
                    measured.order, measured.finest, expected));
  return fine(numbers(measured));
}

Verdict loads_at_their_times(const Scheme& scheme) {
  return no_worse(scheme, {.damping = 0.4, .force = 3}, "a load");
}

Verdict supports_at_their_times(const Scheme& scheme) {
  const double A = 0.2;  // begins with its support, at rest in its frame
  return no_worse(scheme,
                  {.damping = 0.4, .support = A, .position = A * std::sin(0.3), .velocity = A * 1.7 * std::cos(0.3)},
                  "a moving support");
}

Verdict compliance_is_right(const Scheme& scheme) {
  const StepPlan plan = plan_of(scheme, 0.1, {1, 0, true, true});
  constexpr double kappa = 6, stop = 50;
  std::string found;
  for (int e = 0; e < evaluations; ++e) {
    const auto evaluation = static_cast<Evaluation>(e);
    bool offered = false, rated = true, remembers = true;
    for (const auto* stages : {&plan.start, &plan.stages})
      for (const Stage& stage : *stages)
        if (const auto& compliance = stage.at(evaluation)) {
          offered = offered || stages == &plan.stages;
          rated = rated && (compliance->rate.z != 0 || !compliance->rate.slots.empty());
          remembers = remembers && compliance->before;
        }
    if (!offered) continue;
    if (evaluation == Evaluation::conserving && !remembers)
      return fails("offers a conserving evaluation without the displacement one step before (`before`)");
    // The stop lies far above the motion about its new rest, so that the spring never opens.
    const double eta = rated ? 0.3 : 0;
    OscillatorBench bench{.damping = 0.4, .force = 3, .support = 0.2, .stop = true};
    const double rest = kappa * stop / (bench.stiffness + kappa);
    bench.position = rest + 0.3;
    const HarmonicMotion exact = closed_form(bench, kappa, eta, stop);
    const Errors errors = march_against(
        scheme, bench, exact, coarsest(scheme, 3), [&] { return glued_spring(evaluation, kappa, eta); }, stop);
    const MeasuredOrder measured = measured_order(errors.steps, errors.displacement, 1);
    if (!measured.exact && !(measured.order >= 1 - slower))
      return fails(
          fmt::format("a spring{} that never opens, evaluated \"{}\", on a moving support does not tend to its closed "
                      "form: order {:.2f}. The error is {:.3g} m at the finest step",
                      eta != 0 ? " with a dashpot" : "", evaluation_word(evaluation), measured.order, measured.finest));
    found += (found.empty() ? "" : ", ") + std::string(evaluation_word(evaluation)) +
             (measured.exact ? " exact" : fmt::format(" order {:.2f}", measured.order));
  }
  return found.empty() ? not_declared("no compliance measure: compliant laws are refused") : fine(found);
}

namespace {

constexpr double marginal = 1e-6;  // a double root is known to the square root of round-off only

// The largest modulus of a step's roots at hω; roots that coincide are known by their mean.
double radius(const StepPlan& plan, double h, double frequency) {
  const double omega = frequency / h;
  const auto roots = step_roots(in_metres(amplification(plan, 1, 0, omega * omega), plan, h, 1), false);
  return roots.empty() ? std::numeric_limits<double>::infinity() : std::abs(roots.front().value);
}

// An oscillator of 1 kg that rings with hω.
ProblemPointer ringing(double h, double frequency) {
  const double omega = frequency / h;
  return discretised(oscillator_scene({.mass = 1, .stiffness = omega * omega, .position = 1, .velocity = 0.3 * omega}));
}

Eigen::VectorXd slots_of(const Marcher& marcher) {
  const LaneState state = marcher.lane_state(0);
  return Eigen::Map<const Eigen::VectorXd>(state.slots.data(), static_cast<Eigen::Index>(state.slots.size()));
}

}  // namespace

Verdict spectrum_is_the_march(const Scheme& scheme) {
  constexpr double h = 0.01;
  for (const double frequency : {0.1, 1.0, 1e3, 1e6}) {
    const StepPlan plan = plan_of(scheme, h, {1, 0, false, false});
    if (plan.facts.stability_limit && frequency > 0.9 * *plan.facts.stability_limit) continue;
    const ProblemPointer problem = ringing(h, frequency);
    const double omega = frequency / h;
    const Eigen::MatrixXd A = amplification(plan, 1, 0, omega * omega);
    Marcher marcher = marcher_of(problem, plan, h, no_contact());
    marcher.start();
    // Coefficients of a step cancel the more the stiffer it is.
    const double tolerance = 1e-9 + 1e-15 * frequency * frequency;
    Eigen::VectorXd largest = slots_of(marcher).cwiseAbs();
    for (int n = 0; n < 12; ++n) {
      const Eigen::VectorXd before = slots_of(marcher);
      marcher.march(1);
      const Eigen::VectorXd after = slots_of(marcher), predicted = A * before;
      largest = largest.cwiseMax(after.cwiseAbs()).cwiseMax((A.cwiseAbs() * before.cwiseAbs()));
      for (Eigen::Index j = 0; j < after.size(); ++j)
        if (!(std::abs(after[j] - predicted[j]) <= tolerance * largest[j]))
          return fails(
              fmt::format("h·ω = {:g}: a marched step takes the slot {} to {:.10g}, the matrix of which the "
                          "spectrum is taken to {:.10g}",
                          frequency, plan.slots[static_cast<std::size_t>(j)], after[j], predicted[j]));
    }
  }
  const StepPlan plan = plan_of(scheme, h, {});
  if (plan.facts.stability_limit) return fine("no root at infinity: the step is limited");
  return fine(fmt::format("ρ∞ = {:.6g}", radius(plan, h, 1e6)));
}

Verdict stability_as_declared(const Scheme& scheme) {
  constexpr double h = 0.01;
  const StepPlan plan = plan_of(scheme, h, {});
  const auto& limit = plan.facts.stability_limit;
  const double last = limit ? 0.99 * *limit : 1e4;
  constexpr int count = 96;
  const double first = std::min(1e-3, 0.1 * last);
  for (int k = 0; k <= count; ++k) {
    const double frequency = first * std::pow(last / first, static_cast<double>(k) / count);
    const double r = radius(plan, h, frequency);
    if (!(r <= 1 + marginal))
      return fails(fmt::format(
          "declares {}, yet at h·ω = {:.6g} the spectral radius is {:.8g}",
          limit ? fmt::format("the limit h·ω ≤ {:g}", *limit) : std::string("no limit on the step"), frequency, r));
  }
  // What the spectrum says, marched.
  const auto grows = [&](double frequency) {
    Marcher marcher = marcher_of(ringing(h, frequency), plan, h, no_contact());
    marcher.start();
    marcher.march(1000);
    return !marcher.status(0).running || std::abs(marcher.position(0)[0]) > 1e4;
  };
  if (grows(limit ? last : 100))
    return fails(fmt::format("an integration with h·ω = {:g} grows without bounds, below the declared limit",
                             limit ? last : 100));
  if (!limit) return fine("none up to h·ω = 1e4");
  const double beyond = 1.01 * *limit, r = radius(plan, h, beyond);
  if (r <= 1 + marginal)
    return fails(
        fmt::format("declares the limit h·ω ≤ {:g}, yet at h·ω = {:.6g} the spectral radius is {:.8g}: the "
                    "limit is larger, or there is none",
                    *limit, beyond, r));
  return fine(fmt::format("h·ω ≤ {:g}: stable at 0.99 of it, not at 1.01", *limit));
}

}  // namespace ricochet::checking
