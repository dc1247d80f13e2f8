#include "runners/kinds/sweep/orbit_exponents.hpp"

#include <algorithm>
#include <map>
#include <ricochet/measure/orbits/impact_jump.hpp>
#include <ricochet/measure/orbits/judge_orbit.hpp>
#include <ricochet/measure/stability/stability.hpp>

#include "runners/kinds/sweep/distributed_orbits.hpp"
#include "runners/march/prepare_case.hpp"
#include "runners/march/seconds.hpp"

namespace ricochet {
namespace {

constexpr int block_width = 16;

// Orbits of one group that march together.
struct Batch {
  int group = 0;
  std::vector<std::size_t> orbits;
};

}  // namespace

bool nothing_tells(const ForcedScenes& scenes, int group, const LaneSpec& lane) {
  const Program program = scenes.program(group, {lane});
  if (tangents_miss_impacts(program)) return true;
  if (!twins_miss_impacts(program)) return false;
  try {
    scenes.program(group, {lane}, 1);
    return false;
  } catch (const Refusal&) {
    return true;
  }
}

MarginalRoots marginal_roots(const ForcedScenes& scenes, int group) {
  const StabilityPredictor predictor(scenes.shared_problem(group),
                                     LinearLaw{.absent = true, .evaluation = {}, .stiffness = {}});
  const auto found = predictor.open(scenes.plan(group), scenes.step(group));
  const auto* spectrum = std::get_if<StepSpectrum>(&found);
  if (!spectrum || spectrum->marginal.empty()) return {};
  return {spectrum->marginal, std::abs(spectrum->root + 1.0) < 1e-4 && spectrum->on_kernel};
}

namespace {

// Orbits whose tangents tell, group by group, at most `most` in a batch; those of the others are marked blind.
std::vector<Batch> batches_of(const ForcedScenes& scenes, const ExponentTask& task, std::size_t most,
                              std::vector<OrbitExponents>& found) {
  std::map<int, std::vector<std::size_t>> by_group;
  std::map<int, bool> misses;
  for (std::size_t i = 0; i < task.orbits.size(); ++i) {
    const int group = task.groups[i];
    const auto [at, fresh] = misses.try_emplace(group, false);
    if (fresh) at->second = nothing_tells(scenes, group, task.orbits[i]->lane);
    found[i].blind = at->second && impacts_per_period(*task.orbits[i]) > 0;
    if (!found[i].blind) by_group[group].push_back(i);
  }
  std::vector<Batch> batches;
  for (const auto& [group, members] : by_group)
    for (std::size_t first = 0; first < members.size(); first += most)
      batches.push_back({group,
                         {members.begin() + static_cast<std::ptrdiff_t>(first),
                          members.begin() + static_cast<std::ptrdiff_t>(std::min(first + most, members.size()))}});
  return batches;
}

LyapunovPlan lyapunov_plan(const SectionPlan& plan) {
  LyapunovPlan lyapunov;
  lyapunov.steps_per_period = plan.steps_per_period;
  lyapunov.strobe = plan.strobe;
  lyapunov.pulsation = plan.pulsation;
  lyapunov.discard = std::clamp(plan.keep / 10, 2, 20);
  lyapunov.periods = plan.keep;
  return lyapunov;
}

}  // namespace

std::vector<OrbitExponents> measure_exponents(const ForcedScenes& scenes, const ExponentTask& task,
                                              const SectionPlan& plan, double& seconds, const std::atomic<bool>& stop) {
  const auto& orbits = task.orbits;
  const int count = task.count;
  std::vector<OrbitExponents> found(orbits.size());
  // One column more than asked for: it may belong to the last one as a complex pair.
  const int columns =
      task.groups.empty() ? count : std::min({count + 1, 31, 2 * scenes.problem(task.groups.front()).dofs()});
  // What leaves out steps marches alone.
  const auto most = static_cast<std::size_t>(scenes.flies() ? 1 : std::max(1, block_width / (1 + columns)));
  const std::vector<Batch> batches = batches_of(scenes, task, most, found);
  const LyapunovPlan base = lyapunov_plan(plan);
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
    const auto program = [&](int with) { return scenes.program(batch.group, lanes, with); };
    const std::vector<OrbitExponents> measured = exponents_of(program, states, one, count, columns);
    for (std::size_t b = 0; b < batch.orbits.size(); ++b) found[batch.orbits[b]] = measured[b];
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
