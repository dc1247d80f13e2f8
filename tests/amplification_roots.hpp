#pragma once
#include <complex>
#include <ricochet/contract/stage_facts.hpp>
#include <ricochet/measure/stability/step_map.hpp>
#include <vector>

namespace ricochet::testing {

/// Roots of one step on the mode m q'' + c q' + k q = 0, largest modulus first, each as often as its multiplicity. All
/// slots are in metres, so that roots that coincide are known by their mean. Empty where S vanishes.
inline std::vector<std::complex<double>> amplification_roots(const StepPlan& plan, double m, double c, double k) {
  std::vector<std::complex<double>> all;
  const double h = step_of(plan);
  const Eigen::MatrixXd step = amplification(plan, m, c, k);
  for (const Root& root : step_roots(h > 0 ? in_metres(step, plan, h, 1) : step, false))
    all.insert(all.end(), static_cast<std::size_t>(root.multiplicity), root.value);
  return all;
}

}  // namespace ricochet::testing
