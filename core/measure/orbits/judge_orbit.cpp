#include <algorithm>
#include <numbers>
#include <numeric>
#include <ricochet/measure/orbits/judge_orbit.hpp>
#include <ricochet/measure/orbits/zero_one_test.hpp>

namespace ricochet {
namespace {

using Points = std::vector<std::array<double, 2>>;

// The last round of the strobed orbit and that of its image.
bool is_own_image(const Orbit& orbit, int period, const SectionPlan& plan) {
  Points here, opposite;
  const auto last = static_cast<std::ptrdiff_t>(std::min(orbit.strobed.size(), static_cast<std::size_t>(period)));
  for (auto point = orbit.strobed.end() - last; point != orbit.strobed.end(); ++point) {
    here.push_back({point->displacement, point->velocity});
    opposite.push_back({point->opposite_displacement, point->opposite_velocity});
  }
  return same_cloud(here, opposite, {plan.scale, plan.scale * plan.pulsation}, 10 * recurrence_tolerance);
}

}  // namespace

bool touches(const Orbit& orbit) {
  return orbit.contact_steps > 0;
}

double impacts_per_period(const Orbit& orbit) {
  if (orbit.impact_counts.empty()) return 0;
  const double sum = std::accumulate(orbit.impact_counts.begin(), orbit.impact_counts.end(), 0.0);
  return sum / static_cast<double>(orbit.impact_counts.size());
}

JudgedOrbit judge(const Orbit& orbit, const SectionPlan& plan, const std::optional<Interval>& exponent) {
  JudgedOrbit out;
  if (orbit.stage != Orbit::Stage::complete) return out;
  out.recurrence = find_recurrence(orbit.readings, plan.reading_scale(), recurrence_tolerance);
  std::vector<double> displacements;
  for (const SectionPoint& point : orbit.strobed) displacements.push_back(point.displacement);
  out.zero_one = zero_one_test(displacements);
  RegimeInput input;
  input.contact = touches(orbit);
  input.recurrence = out.recurrence;
  input.zero_one = out.zero_one;
  input.exponent = exponent;
  input.impacts_per_period = impacts_per_period(orbit);
  input.settled = orbit.settled;
  input.tolerance = recurrence_tolerance;
  input.forcing_period = 2 * std::numbers::pi / plan.pulsation;
  out.verdict = classify(input);
  if (out.recurrence.period > 0) out.symmetric = is_own_image(orbit, out.recurrence.period, plan);
  return out;
}

std::optional<MotionClass> rough_class(const Orbit& orbit, const SectionPlan& plan) {
  if (orbit.stage != Orbit::Stage::complete) return std::nullopt;
  if (!touches(orbit)) return MotionClass{Regime::no_contact};
  const Recurrence found = find_recurrence(orbit.readings, plan.reading_scale(), recurrence_tolerance);
  return found.period > 0 ? MotionClass{Regime::periodic, found.period} : MotionClass{Regime::undecided};
}

}  // namespace ricochet
