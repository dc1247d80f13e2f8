#include "runners/execution/orbit_exponents.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <map>
#include <mutex>
#include <ricochet/measure/lyapunov.hpp>
#include <ricochet/measure/stability.hpp>
#include <thread>

#include "runners/execution/prepare_case.hpp"
#include "runners/execution/run_case.hpp"

namespace ricochet {
namespace {

constexpr int block_width = 16;
constexpr double twin_offset = 1e-7;  // m

// Orbits of one group that march together.
struct Batch {
  int group = 0;
  std::vector<std::size_t> orbits;
};

Interval interval_of(const std::vector<double>& rates) {
  if (rates.size() >= static_cast<std::size_t>(fewest_resampled)) return block_bootstrap_mean(rates);
  double mean = 0;
  for (const double rate : rates) mean += rate / static_cast<double>(rates.size());
  return {mean, mean, mean};
}

bool usable(const std::vector<double>& rates) {
  return !rates.empty() && std::all_of(rates.begin(), rates.end(), [](double rate) { return std::isfinite(rate); });
}

}  // namespace

MarginalRoots marginal_roots(const ForcedScenes& scenes, int group) {
  const StabilityPredictor predictor(scenes.shared_problem(group),
                                     LinearLaw{.absent = true, .evaluation = {}, .stiffness = {}});
  const auto found = predictor.open(scenes.plan(group), scenes.step(group));
  const auto* spectrum = std::get_if<StepSpectrum>(&found);
  if (!spectrum || spectrum->marginal.empty()) return {};
  return {spectrum->marginal, std::abs(spectrum->root + 1.0) < 1e-4 && spectrum->on_kernel};
}

std::vector<OrbitExponents> measure_exponents(const ForcedScenes& scenes, const std::vector<const Orbit*>& orbits,
                                              const std::vector<int>& groups, const SectionPlan& plan, int count,
                                              const std::vector<bool>& sawtooth, int workers, double& seconds,
                                              const std::atomic<bool>& stop) {
  std::vector<OrbitExponents> found(orbits.size());
  std::map<int, std::vector<std::size_t>> by_group;
  for (std::size_t i = 0; i < orbits.size(); ++i) by_group[groups[i]].push_back(i);
  std::vector<Batch> batches;
  const auto most = static_cast<std::size_t>(std::max(1, block_width / (1 + count)));
  for (const auto& [group, members] : by_group)
    for (std::size_t first = 0; first < members.size(); first += most)
      batches.push_back({group,
                         {members.begin() + static_cast<std::ptrdiff_t>(first),
                          members.begin() + static_cast<std::ptrdiff_t>(std::min(first + most, members.size()))}});
  LyapunovPlan base;
  base.steps_per_period = plan.steps_per_period;
  base.strobe = plan.strobe;
  base.pulsation = plan.pulsation;
  base.discard = std::clamp(plan.keep / 10, 2, 20);
  base.periods = plan.keep;
  const auto measure = [&](const Batch& batch) {
    LyapunovPlan one = base;
    one.without_sawtooth = sawtooth[static_cast<std::size_t>(batch.group)];
    std::vector<LaneSpec> lanes, twins;
    std::vector<LaneState> states;
    for (const std::size_t i : batch.orbits) {
      lanes.push_back(orbits[i]->lane);
      twins.insert(twins.end(), 2, orbits[i]->lane);
      states.push_back(orbits[i]->entry);
    }
    bool tangents = true;
    try {
      const auto rates = lyapunov_rates(scenes.program(batch.group, lanes, count), states, one);
      for (std::size_t b = 0; b < batch.orbits.size(); ++b) {
        OrbitExponents& exponents = found[batch.orbits[b]];
        exponents.cause = rates[b].cause;
        if (!rates[b].cause.empty()) continue;
        for (const auto& series : rates[b].rates)
          if (usable(series)) exponents.values.push_back(interval_of(series));
        exponents.method = rates[b].jumps > 0 ? "tangent+jump" : "tangent";
      }
    } catch (const Refusal&) {
      tangents = false;  // the law has none: twins alone
    }
    const auto twin = twin_rates(scenes.program(batch.group, twins), states, one, twin_offset);
    for (std::size_t b = 0; b < batch.orbits.size(); ++b) {
      OrbitExponents& exponents = found[batch.orbits[b]];
      if (!twin[b].cause.empty() || !usable(twin[b].rates[0])) continue;
      exponents.twin = interval_of(twin[b].rates[0]);
      if (tangents) continue;
      exponents.values = {*exponents.twin};
      exponents.method = fmt::format("twin({:g})", twin_offset);
    }
  };
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  std::exception_ptr failure;
  const auto work = [&] {
    const double began = thread_seconds();
    try {
      for (std::size_t i = next++; i < batches.size() && !stop; i = next++) measure(batches[i]);
    } catch (...) {
      const std::lock_guard guard(mutex);
      failure = std::current_exception();
    }
    const std::lock_guard guard(mutex);
    seconds += thread_seconds() - began;
  };
  {
    std::vector<std::jthread> threads;
    for (int worker = 1; worker < workers; ++worker) threads.emplace_back(work);
    work();
  }
  if (failure) std::rethrow_exception(failure);
  if (stop) throw Interrupted{};
  return found;
}

}  // namespace ricochet
