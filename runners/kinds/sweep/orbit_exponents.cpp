#include "runners/kinds/sweep/orbit_exponents.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <ricochet/measure/orbits/exponent_intervals.hpp>
#include <ricochet/measure/orbits/impact_jump.hpp>
#include <ricochet/measure/orbits/judge_orbit.hpp>
#include <ricochet/measure/orbits/lyapunov.hpp>
#include <ricochet/measure/stability/stability.hpp>

#include "runners/kinds/sweep/distributed_exponents.hpp"
#include "runners/march/case_plan.hpp"
#include "runners/march/seconds.hpp"

namespace ricochet {
namespace {

constexpr int block_width = 16;
constexpr double twin_offset = 1e-7;  // m

// Orbits of one group that march together.
struct Batch {
  int group = 0;
  std::vector<std::size_t> orbits;
};

bool usable(const std::vector<double>& rates) {
  return !rates.empty() && std::all_of(rates.begin(), rates.end(), [](double rate) { return std::isfinite(rate); });
}

// More than one period in a hundred: the mean is a lower bound.
bool saturates(const LyapunovRates& twin) {
  return 100 * twin.saturated > static_cast<int>(twin.rates[0].size());
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

std::vector<OrbitExponents> measure_exponents(const ForcedScenes& scenes, const ExponentTask& task,
                                              const SectionPlan& plan, double& seconds, const std::atomic<bool>& stop) {
  const auto& orbits = task.orbits;
  const int count = task.count;
  std::vector<OrbitExponents> found(orbits.size());
  std::map<int, std::vector<std::size_t>> by_group;
  std::map<int, bool> misses;
  for (std::size_t i = 0; i < orbits.size(); ++i) {
    const int group = task.groups[i];
    const auto [at, fresh] = misses.try_emplace(group, false);
    if (fresh) at->second = tangents_miss_impacts(scenes.program(group, {orbits[i]->lane}));
    found[i].blind = at->second && impacts_per_period(*orbits[i]) > 0;
    if (!found[i].blind) by_group[group].push_back(i);
  }
  std::vector<Batch> batches;
  // One column more than asked for: it may belong to the last one as a complex pair.
  const int columns =
      task.groups.empty() ? count : std::min({count + 1, 31, 2 * scenes.problem(task.groups.front()).dofs()});
  // What leaves out steps marches alone.
  const auto most = static_cast<std::size_t>(scenes.flies() ? 1 : std::max(1, block_width / (1 + columns)));
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
    one.without_sawtooth = task.sawtooth[static_cast<std::size_t>(batch.group)];
    std::vector<LaneSpec> lanes;
    std::vector<LaneState> states;
    for (const std::size_t i : batch.orbits) {
      lanes.push_back(orbits[i]->lane);
      states.push_back(orbits[i]->entry);
      one.rounds.push_back(task.rounds.at(i));
    }
    bool tangents = true;
    one.keep_orbit = !one.without_sawtooth;
    std::vector<LyapunovRates> rates;
    try {
      rates = lyapunov_rates(scenes.program(batch.group, lanes, columns), states, one);
      for (std::size_t b = 0; b < batch.orbits.size(); ++b) {
        OrbitExponents& exponents = found[batch.orbits[b]];
        if (rates[b].end) continue;
        exponents.superstable = columns > 0 && rates[b].told == 0;
        exponents.untold = !exponents.superstable && rates[b].untold > 0;
        if (exponents.superstable) exponents.method = "superstable";
        if (exponents.superstable || exponents.untold) continue;
        // A column beyond what the state can tell apart has no growth to speak of.
        const auto& all = rates[b].rates;
        const auto last = std::find_if_not(all.begin(), all.begin() + rates[b].told, usable);
        exponents.values = exponent_intervals({all.begin(), last}, count, rates[b].turning);
        exponents.method = rates[b].jumps > 0 ? "tangent+jump" : "tangent";
      }
    } catch (const Refusal&) {
      tangents = false;  // the law has none: twins alone
      one.keep_orbit = true;
      rates = lyapunov_rates(scenes.program(batch.group, lanes), states, one);
    }
    // A twin carries the sawtooth of single steps, which its distance cannot be rid of.
    if (!one.keep_orbit) return;
    const auto twin = twin_rates(scenes.program(batch.group, lanes), states, rates, one, twin_offset);
    for (std::size_t b = 0; b < batch.orbits.size(); ++b) {
      OrbitExponents& exponents = found[batch.orbits[b]];
      // Closer than a step's way, an orbit and its twin meet their stops at the same steps, as motions do not.
      if (exponents.superstable || rates[b].jumps > 0 || twin[b].end || !usable(twin[b].rates[0])) continue;
      if (saturates(twin[b])) {
        exponents.saturated = !tangents;
        continue;
      }
      exponents.twin = exponent_interval(twin[b].rates[0]);
      if (tangents) continue;
      exponents.values = {*exponents.twin};
      exponents.method = fmt::format("twin({:g})", twin_offset);
    }
  };
  const auto recall_batch = [&](std::size_t i) {
    const std::vector<std::size_t>& members = batches[i].orbits;
    std::vector<OrbitExponents> known = task.find ? task.find(i) : std::vector<OrbitExponents>();
    if (known.size() != members.size()) return false;
    for (std::size_t b = 0; b < members.size(); ++b) found[members[b]] = std::move(known[b]);
    return true;
  };
  const auto keep_batch = [&](std::size_t i) {
    if (!task.keep) return;
    std::vector<OrbitExponents> known;
    for (const std::size_t orbit : batches[i].orbits) known.push_back(found[orbit]);
    task.keep(i, known);
  };
  if (task.blocks) {
    std::vector<std::vector<std::size_t>> unknown;
    for (std::size_t i = 0; i < batches.size(); ++i)
      unknown.push_back(recall_batch(i) ? std::vector<std::size_t>() : batches[i].orbits);
    measure_elsewhere(scenes, task, plan, unknown, found, seconds, keep_batch, stop);
    return found;
  }
  const double begun = thread_seconds();
  for (std::size_t i = 0; i < batches.size() && !stop; ++i) {
    if (recall_batch(i)) continue;
    measure(batches[i]);
    keep_batch(i);
  }
  seconds += thread_seconds() - begun;
  if (stop) throw Interrupted{};
  return found;
}

}  // namespace ricochet
