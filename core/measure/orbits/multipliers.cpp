#include <algorithm>
#include <cmath>
#include <ricochet/engine/march_model.hpp>
#include <ricochet/kernels/eigenvalues.hpp>
#include <ricochet/measure/orbits/multipliers.hpp>
#include <ricochet/scene/semi_discrete.hpp>
#include <utility>

namespace ricochet {

using Eigen::MatrixXd;

std::vector<std::complex<double>> multipliers_of(MatrixXd derivative, int without_kernel) {
  if (!derivative.allFinite()) return {};
  balance(derivative);
  const GeneralModes modes = general_modes(derivative, EigenVectors::none);
  if (!modes.found) return {};
  std::vector<std::complex<double>> all(modes.values.begin(), modes.values.end());
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) {
    const double one = std::abs(a), other = std::abs(b);
    if (one != other) return one > other;
    return a.imag() > b.imag();
  });
  constexpr double near = 1e-6;
  std::erase_if(all, [&](const std::complex<double>& value) {
    return without_kernel > 0 && std::abs(value + 1.0) < near && without_kernel-- > 0;
  });
  return all;
}

std::vector<std::complex<double>> multipliers_of(const PeriodicMap& map, const MapClock& clock, MatrixXd derivative) {
  constexpr double near = 1e-6;
  auto all = multipliers_of(std::move(derivative));
  for (const std::complex<double>& massless : after_steps(map.massless_roots(), clock.steps(), clock.sign()))
    if (const auto it =
            std::find_if(all.begin(), all.end(), [&](const auto& one) { return std::abs(one - massless) < near; });
        it != all.end())
      all.erase(it);
  return all;
}

Outside outside(const std::vector<std::complex<double>>& multipliers) {
  Outside found;
  for (const std::complex<double>& one : multipliers) {
    if (std::abs(one) <= 1) continue;
    ++found.total;
    found.above += one.imag() == 0 && one.real() > 0;
    found.below += one.imag() == 0 && one.real() < 0;
    found.pairs += one.imag() > 0;
  }
  return found;
}

namespace {

// How far a row is on its side of a change: the distance of the free measure to the bound.
double margin(const PeriodicMap& map, const SetStep& step, int row, double value, bool upper, double parameter) {
  if (step.side[static_cast<std::size_t>(row)] != 0) return std::abs(value) * step.give[static_cast<std::size_t>(row)];
  return std::abs(value - map.bound(row, upper, parameter, false));
}

}  // namespace

MatrixXd half_step_derivative(PeriodicMap& map, MatrixXd frozen, const SetSequence& sets, const MapClock& clock,
                              double parameter, const PeriodicMap::Measures& measures) {
  const auto rows = static_cast<std::size_t>(map.sets().measure_rows()), n = sets.size();
  std::vector<SetBlend> blends;
  // Step 0 follows the last one, of a half map with the sides exchanged: A is that of the same points.
  for (std::size_t last = 0; last < n; ++last) {
    const std::size_t k = last + 1 < n ? last + 1 : 0;
    const bool turned = k == 0 && clock.half;
    if (sets[k] == sets[last] && !turned) continue;
    const SetStep &before = map.sets()[sets[last]], &after = map.sets()[sets[k]];
    for (std::size_t r = 0; r < rows; ++r) {
      const int was = before.side[r], is = after.side[r];
      if (was == (turned ? -is : is) || (was != 0 && is != 0)) continue;
      const int row = static_cast<int>(r);
      const bool upper = is != 0 ? is > 0 : (turned ? was < 0 : was > 0);
      const double m0 = margin(map, before, row, measures.value[last * rows + r], upper != turned, parameter);
      const double m1 = margin(map, after, row, measures.value[k * rows + r], upper, parameter);
      if (!(m0 + m1 > 0)) continue;
      const double theta = m0 / (m0 + m1);
      const std::size_t step = theta < 0.5 ? last : k;
      // A run of one step is blended by its later end.
      const auto same = [&](const SetBlend& one) { return one.step == step && one.row == row; };
      if (step == 0 && k == 0 && std::any_of(blends.begin(), blends.end(), same)) continue;
      std::erase_if(blends, same);
      blends.push_back(
          {step, map.sets().toggled(sets[step], row, upper != (turned && step == last)), std::abs(theta - 0.5), row});
    }
  }
  std::stable_sort(blends.begin(), blends.end(), [](const SetBlend& a, const SetBlend& b) { return a.step < b.step; });
  return map.blended(std::move(frozen), sets, clock, blends);
}

std::vector<std::complex<double>> massless_roots(const Program& program, const SetSteps& sets) {
  constexpr double on_circle = 1e-7, no_mass = 1e-6;
  const Inertia& inertia = program.problem->inertia;
  std::vector<std::complex<double>> roots;
  if (inertia.kernel_dimension == 0) return roots;
  const GeneralModes modes = general_modes(sets[0].state.topRows(sets.state_size()));
  if (!modes.found) return roots;
  const MarchModel& model = *program.model;
  const double largest = dense_mass(inertia).norm();
  for (Eigen::Index i = 0; i < modes.values.size(); ++i) {
    if (std::abs(std::abs(modes.values[i]) - 1) > on_circle) continue;
    bool massless = true;
    for (int first = 0; first < sets.slots_size(); first += model.rows()) {
      const Eigen::VectorXcd slot = modes.vectors.col(i).segment(first, model.rows());
      for (const Eigen::VectorXd& part : {Eigen::VectorXd(slot.real()), Eigen::VectorXd(slot.imag())}) {
        const Eigen::VectorXd nodal = model.to_nodal(part);
        massless = massless && apply_mass(inertia, nodal).norm() <= no_mass * largest * nodal.norm();
      }
    }
    if (massless) roots.push_back(modes.values[i]);
  }
  return roots;
}

std::vector<std::complex<double>> after_steps(std::vector<std::complex<double>> roots, long long steps, double sign) {
  for (std::complex<double>& root : roots) root = sign * std::polar(1.0, std::arg(root) * static_cast<double>(steps));
  return roots;
}

}  // namespace ricochet
