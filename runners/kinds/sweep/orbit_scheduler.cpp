#include "runners/kinds/sweep/orbit_scheduler.hpp"

#include <algorithm>
#include <ricochet/measure/orbits/judge_orbit.hpp>

#include "runners/kinds/sweep/distributed_orbits.hpp"
#include "runners/march/case_plan.hpp"
#include "runners/march/seconds.hpp"

namespace ricochet {

OrbitScheduler::OrbitScheduler(const ForcedScenes& scenes, ScheduleOptions options)
    : scenes_(scenes), options_(std::move(options)), queue_(scenes) {
  if (scenes.flies()) options_.lanes = 1;
}

// Orbits that start from an initial state march their first period together.
std::vector<Orbit> OrbitScheduler::start(const std::vector<int>& numbers) {
  std::vector<LaneSpec> lanes;
  for (const int number : numbers) lanes.push_back(task(number).lane);
  StartedOrbits started = start_orbits(scenes_.program(queue_.group(numbers.front()), lanes), options_.section);
  std::vector<Orbit> orbits;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    Orbit orbit;
    orbit.task = numbers[i];
    orbit.lane = lanes[i];
    orbit.now = std::move(started.states[i]);
    orbit.transient_periods = 1;
    if (started.ends[i]) {
      orbit.stage = Orbit::Stage::stopped;
      orbit.end = started.ends[i];
      orbit.stopped_period = 1;
      if (options_.ends_only) keep_end(orbit, options_.section);
    }
    orbits.push_back(std::move(orbit));
  }
  return orbits;
}

// Orbits of a batch, ready to march; those that stop in their first period are put away.
std::vector<Orbit> OrbitScheduler::begin(OrbitQueue::Batch batch) {
  std::vector<Orbit> orbits = std::move(batch.orbits);
  if (batch.fresh.empty()) return orbits;
  for (Orbit& orbit : start(batch.fresh))
    if (orbit.stage == Orbit::Stage::stopped)
      queue_.finish(std::move(orbit));
    else
      orbits.push_back(std::move(orbit));
  return orbits;
}

bool OrbitScheduler::going(const std::atomic<bool>& stop) const {
  return queue_.open_tasks() > 0 && !stop && !over_budget_;
}

// Marches a block of these orbits, and of others that take the places of those that end, until all have ended or the
// block is half empty: what is left is returned, for a narrower one.
std::vector<Orbit> OrbitScheduler::march_block(std::vector<Orbit> orbits, const std::atomic<bool>& stop,
                                               const std::function<void(const MarchedOrbits&)>& checkpoint) {
  const int group = queue_.group(orbits.front().task);
  const bool chained = queue_.chained(orbits.front().task);
  int running = 0;
  const std::vector<LaneSpec> places(static_cast<std::size_t>(lane_width(static_cast<int>(orbits.size()))),
                                     orbits.front().lane);
  SectionMarch block(scenes_.program(group, places), options_.section);
  for (Orbit& orbit : orbits) block.load(running++, std::move(orbit));
  while (running > 0) {
    std::vector<Orbit> ended = block.period();
    lane_periods_ += running;
    running -= static_cast<int>(ended.size());
    for (Orbit& orbit : ended) {
      if (options_.ends_only) keep_end(orbit, options_.section);
      queue_.finish(std::move(orbit));
    }
    const double now = thread_seconds();
    seconds_ += now - counted_;
    counted_ = now;
    // The next of a chain, or single ones; the places of a narrow block are for its chain alone.
    std::vector<Orbit> more;
    if (running < block.places() && queue_.ready() > 0)
      more = begin(queue_.take(group, block.places() - running, chained));
    for (int i = 0; i < block.places() && !more.empty(); ++i) {
      if (!block.idle(i)) continue;
      block.load(i, std::move(more.back()));
      more.pop_back();
      ++running;
    }
    over_budget_ = over_budget_ || seconds_ > options_.budget;
    if (seconds_since(last_) > options_.interval) {
      last_ = Clock::now();
      checkpoint(queue_.stock({block.running()}));
    }
    if (!going(stop) || 2 * running <= block.places()) break;
  }
  return block.running();
}

long long OrbitScheduler::marched_periods(int number) const {
  const Orbit& one = queue_.orbit(number);
  const int last = one.stage == Orbit::Stage::stopped ? one.stopped_period : one.transient_periods + one.kept_periods;
  return std::max(0, queue_.follows(number) ? last : last - 1);
}

void OrbitScheduler::run(const std::atomic<bool>& stop, const std::function<void(const MarchedOrbits&)>& checkpoint) {
  if (options_.blocks) {
    DistributedOrbits distributed(queue_, scenes_, options_);
    const auto count = [&] {
      seconds_ += distributed.seconds();
      lane_periods_ += distributed.lane_periods();
      over_budget_ = over_budget_ || distributed.over_budget();
    };
    try {
      distributed.run(stop, checkpoint);
    } catch (...) {
      count();
      throw;
    }
    return count();
  }
  queue_.open();
  counted_ = thread_seconds();
  last_ = Clock::now();
  std::vector<Orbit> orbits;
  const auto leaves = [&] {
    return !orbits.empty() && static_cast<int>(orbits.size()) <= options_.leave && queue_.ready() == 0;
  };
  try {
    while (going(stop) && !leaves()) {
      if (orbits.empty()) {
        const int most = std::clamp(queue_.ready(), 1, options_.lanes);
        OrbitQueue::Batch batch = queue_.go_on(options_.lanes, most);
        if (batch.empty()) batch = queue_.take(-1, most);
        if (batch.empty()) break;
        orbits = begin(std::move(batch));
      }
      if (!orbits.empty()) orbits = march_block(std::move(orbits), stop, checkpoint);
    }
  } catch (const Refusal& refusal) {
    throw std::runtime_error(refusal.sentence);
  }
  checkpoint(queue_.stock({orbits}));
  if (stop) throw Interrupted{};
}

}  // namespace ricochet
