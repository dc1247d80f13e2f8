#include "runners/kinds/sweep/orbit_scheduler.hpp"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <ricochet/measure/orbits/judge_orbit.hpp>

#include "runners/kinds/sweep/case_workers.hpp"
#include "runners/kinds/sweep/distributed_orbits.hpp"
#include "runners/kinds/trajectory/run_case.hpp"
#include "runners/march/case_plan.hpp"
#include "runners/march/seconds.hpp"

namespace ricochet {

/// What the workers of one run share. Each function takes the lock for itself; nobody marches while it is held.
class OrbitScheduler::Shared {
 public:
  Shared(OrbitScheduler& owner, const std::atomic<bool>& stop,
         const std::function<void(const MarchedOrbits&)>& checkpoint)
      : owner_(owner), queue_(owner.queue_), stop_(stop), checkpoint_(checkpoint), workers_(owner.options_.seats) {
    queue_.open();
  }

  CaseWorkers& workers() { return workers_; }

  /// A place for what a worker has on its way, until it leaves it.
  int enter() {
    const std::lock_guard guard(mutex_);
    std::size_t place = 0;
    while (place < taken_.size() && taken_[place]) ++place;
    if (place == taken_.size()) {
      taken_.push_back(true);
      snapshots_.emplace_back();
      shown_.push_back(0);
    }
    taken_[place] = true;
    return static_cast<int>(place);
  }
  void exit(int place) {
    const std::lock_guard guard(mutex_);
    taken_[static_cast<std::size_t>(place)] = false;
  }

  /// Whether there is more to do.
  bool going() {
    const std::lock_guard guard(mutex_);
    return queue_.open_tasks() > 0 && !ended_;
  }

  /// What a worker marches next: orbits on their way that nobody marches, else new ones. Where none is ready: empty,
  /// for a worker that joined at once, for the other one after it has waited for those that march.
  OrbitQueue::Batch next(const CaseWorker& worker, int place) {
    std::unique_lock lock(mutex_);
    if (queue_.open_tasks() == 0 || ended_) return {};
    const int lanes = owner_.options_.lanes, workers = std::max(1, workers_.could_work());
    const int fair = std::clamp((queue_.ready() + workers - 1) / workers, 1, lanes);
    OrbitQueue::Batch batch = queue_.go_on(lanes, fair);
    snapshots_[static_cast<std::size_t>(place)] = batch.orbits;  // not lost before their first period
    if (batch.empty()) batch = queue_.take(-1, fair);
    if (!batch.empty())
      workers_.call(queue_.waiting());
    else if (!worker.joined())
      workers_.without_seat([&] { changed_.wait(lock); });
    return batch;
  }

  void finish(Orbit orbit) {
    const std::lock_guard guard(mutex_);
    queue_.finish(std::move(orbit));
    changed_.notify_all();
  }

  /// After a period of `running` lanes that took `seconds`: orbits that ended are put away, and others taken for the
  /// places that are free: the next of a chain, or single ones; those of a narrow block are for its chain alone.
  OrbitQueue::Batch settle(std::vector<Orbit> ended, int running, double seconds, int group, bool chained, int places) {
    const std::lock_guard guard(mutex_);
    spent_ += seconds;
    owner_.lane_periods_ += running;
    running -= static_cast<int>(ended.size());
    for (Orbit& orbit : ended) queue_.finish(std::move(orbit));
    changed_.notify_all();
    if (running >= places || queue_.ready() == 0) return {};
    return queue_.take(group, places - running, chained);
  }

  /// Between two periods of a block: stops everyone where that is asked for, and saves what is due. Whether the block
  /// goes on.
  bool look_around(int place, const SectionMarch& block) {
    const std::lock_guard guard(mutex_);
    const bool due = seconds_since(last_) > owner_.options_.interval, spent = spent_ > owner_.options_.budget;
    long long& shown = shown_[static_cast<std::size_t>(place)];
    if (due) ++wanted_;
    if (wanted_ != shown) snapshots_[static_cast<std::size_t>(place)] = block.running();
    shown = wanted_;
    owner_.over_budget_ = owner_.over_budget_ || spent;
    ended_ = ended_ || spent || stop_;
    if (due) {
      last_ = std::chrono::steady_clock::now();
      checkpoint_(queue_.stock(snapshots_));
    }
    if (!ended_) workers_.call(queue_.waiting());
    return !ended_;
  }

  /// Whether these orbits are left to others, and nothing else is to be done.
  bool leaves(const std::vector<Orbit>& orbits) {
    const std::lock_guard guard(mutex_);
    return !orbits.empty() && static_cast<int>(orbits.size()) <= owner_.options_.leave && queue_.ready() == 0;
  }

  /// The orbits that a worker leaves a block with.
  void leave(int place, const std::vector<Orbit>& orbits) {
    const std::lock_guard guard(mutex_);
    snapshots_[static_cast<std::size_t>(place)] = orbits;
  }

  /// Those of a worker that gives way: others march them on.
  void give_back(int place, std::vector<Orbit> orbits) {
    const std::lock_guard guard(mutex_);
    snapshots_[static_cast<std::size_t>(place)].clear();
    queue_.give_back(std::move(orbits));
    changed_.notify_all();
  }

  /// A worker is done; one that failed stops the others.
  void end(bool failed) {
    const std::lock_guard guard(mutex_);
    ended_ = ended_ || failed;
    changed_.notify_all();
  }

  /// What the last worker leaves behind.
  void close() {
    checkpoint_(queue_.stock(snapshots_));
    if (stop_) throw Interrupted{};
  }

 private:
  OrbitScheduler& owner_;
  OrbitQueue& queue_;
  const std::atomic<bool>& stop_;
  const std::function<void(const MarchedOrbits&)>& checkpoint_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool ended_ = false;
  std::vector<bool> taken_;                    // places of workers
  std::vector<std::vector<Orbit>> snapshots_;  // per place, what is on its way
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
  long long wanted_ = 0;          // snapshots asked for so far
  std::vector<long long> shown_;  // and given, per place
  double spent_ = 0;
  CaseWorkers workers_;
};

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
std::vector<Orbit> OrbitScheduler::begin(Shared& shared, OrbitQueue::Batch batch) {
  std::vector<Orbit> orbits = std::move(batch.orbits);
  if (batch.fresh.empty()) return orbits;
  for (Orbit& orbit : start(batch.fresh))
    if (orbit.stage == Orbit::Stage::stopped)
      shared.finish(std::move(orbit));
    else
      orbits.push_back(std::move(orbit));
  return orbits;
}

// Marches a block of these orbits, and of others that take the places of those that end, until all have ended or the
// block is half empty: what is left is returned, for a narrower one. `counted`: processor time told so far.
std::vector<Orbit> OrbitScheduler::march_block(Shared& shared, CaseWorker& worker, int place, std::vector<Orbit> orbits,
                                               double& counted) {
  const int group = queue_.group(orbits.front().task);
  const bool chained = queue_.chained(orbits.front().task);
  int running = 0;
  const std::vector<LaneSpec> places(static_cast<std::size_t>(lane_width(static_cast<int>(orbits.size()))),
                                     orbits.front().lane);
  SectionMarch block(scenes_.program(group, places), options_.section);
  for (Orbit& orbit : orbits) block.load(running++, std::move(orbit));
  while (running > 0) {
    std::vector<Orbit> ended = block.period();
    if (options_.ends_only)
      for (Orbit& orbit : ended) keep_end(orbit, options_.section);
    const int before = running;
    running -= static_cast<int>(ended.size());
    const double now = thread_seconds(), seconds = now - counted;
    counted = now;
    std::vector<Orbit> more =
        begin(shared, shared.settle(std::move(ended), before, seconds, group, chained, block.places()));
    for (int i = 0; i < block.places() && !more.empty(); ++i) {
      if (!block.idle(i)) continue;
      block.load(i, std::move(more.back()));
      more.pop_back();
      ++running;
    }
    if (!shared.look_around(place, block) || worker.gives_way() || 2 * running <= block.places()) break;
  }
  std::vector<Orbit> left = block.running();
  shared.leave(place, left);
  return left;
}

void OrbitScheduler::work(Shared& shared, CaseWorker& worker) {
  double counted = thread_seconds();
  const int place = shared.enter();
  while (shared.going() && !worker.gives_way()) {
    std::vector<Orbit> orbits = begin(shared, shared.next(worker, place));
    if (orbits.empty() && worker.joined()) break;
    while (!orbits.empty() && shared.going()) {
      orbits = march_block(shared, worker, place, std::move(orbits), counted);
      if (shared.leaves(orbits)) return;
      if (!worker.gives_way()) continue;
      shared.give_back(place, std::move(orbits));
      break;
    }
  }
  shared.exit(place);
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
  Shared shared(*this, stop, checkpoint);
  // A worker waits only for orbits that another one is marching.
  seconds_ += shared.workers().run([&](CaseWorker& worker) {
    try {
      work(shared, worker);
    } catch (const Refusal& refusal) {
      shared.end(true);
      throw std::runtime_error(refusal.sentence);
    } catch (...) {
      shared.end(true);
      throw;
    }
    shared.end(false);
  });
  shared.close();
}

}  // namespace ricochet
