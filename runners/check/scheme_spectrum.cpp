#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <ricochet/measure/stability/amplification.hpp>
#include <ricochet/measure/stability/step_map.hpp>

#include "runners/check/scheme_checks.hpp"

namespace ricochet::checking {
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
    return fails(
        fmt::format("a march with h·ω = {:g} grows without bounds, below the declared limit", limit ? last : 100));
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
