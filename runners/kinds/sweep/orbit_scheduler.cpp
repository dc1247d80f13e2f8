#include "runners/kinds/sweep/orbit_scheduler.hpp"

#include <algorithm>
#include <ricochet/measure/orbits/judge_orbit.hpp>

#include "runners/kinds/sweep/distributed_orbits.hpp"
#include "runners/march/prepare_case.hpp"
#include "runners/march/seconds.hpp"

namespace ricochet {

int OrbitQueue::add(OrbitTask task) {
  const int number = count();
  if (task.after >= 0) tasks_[static_cast<std::size_t>(task.after)].follower = number;
  tasks_.push_back(std::move(task));
  orbits_.emplace_back();
  done_.push_back(false);
  return number;
}

void OrbitQueue::restore(MarchedOrbits marched) {
  for (Orbit& orbit : marched.finished) {
    const auto number = static_cast<std::size_t>(orbit.task);
    if (number >= tasks_.size()) continue;
    done_[number] = true;
    if (!orbit.verdict) orbit.lane = tasks_[number].lane;
    orbits_[number] = std::move(orbit);
  }
  for (Orbit& orbit : marched.running) {
    const auto number = static_cast<std::size_t>(orbit.task);
    if (number >= tasks_.size() || done_[number]) continue;
    orbit.lane = tasks_[number].lane;
    waiting_.push_back(std::move(orbit));
  }
}

void OrbitQueue::open() {
  ready_.clear();
  resumed_.clear();
  open_ = 0;
  std::vector<bool> on_its_way(tasks_.size(), false);
  for (Orbit& orbit : waiting_) {
    on_its_way[static_cast<std::size_t>(orbit.task)] = true;
    resumed_.push_back(std::move(orbit));
  }
  waiting_.clear();
  for (std::size_t number = 0; number < tasks_.size(); ++number) {
    if (done_[number]) continue;
    ++open_;
    const int after = tasks_[number].after;
    if (!on_its_way[number] && (after < 0 || done_[static_cast<std::size_t>(after)]))
      ready_.push_back(static_cast<int>(number));
  }
  std::stable_partition(ready_.begin(), ready_.end(), [&](int number) { return chained(number); });
}

bool OrbitQueue::follows(int number) const {
  const int after = task(number).after;
  return after >= 0 && !orbits_[static_cast<std::size_t>(after)].now.slots.empty();
}

// An orbit whose start is another's end.
Orbit OrbitQueue::begin(int number) const {
  const OrbitTask& one = task(number);
  Orbit orbit;
  orbit.task = number;
  orbit.lane = one.lane;
  orbit.now = scenes_.carry(orbits_[static_cast<std::size_t>(one.after)].now, group(one.after), group(number));
  return orbit;
}

std::vector<Orbit> OrbitQueue::resume(int most) {
  std::vector<Orbit> orbits;
  while (!resumed_.empty() && static_cast<int>(orbits.size()) < most) {
    if (!orbits.empty() && group(resumed_.front().task) != group(orbits.front().task)) break;
    orbits.push_back(std::move(resumed_.front()));
    resumed_.pop_front();
  }
  return orbits;
}

OrbitQueue::Batch OrbitQueue::go_on(int lanes, int most) {
  Batch batch{resume(lanes), {}};
  if (batch.empty() || chained(batch.orbits.front().task)) return batch;
  Batch more = take(group(batch.orbits.front().task), most - static_cast<int>(batch.orbits.size()), false);
  batch.fresh = std::move(more.fresh);
  return batch;
}

void OrbitQueue::give_back(std::vector<Orbit> orbits) {
  for (Orbit& orbit : orbits) resumed_.push_back(std::move(orbit));
}

OrbitQueue::Batch OrbitQueue::take(int wanted, int most, std::optional<bool> chains) {
  Batch batch;
  int taken = 0;
  for (auto it = ready_.begin(); it != ready_.end() && taken < most;) {
    const int number = *it;
    if (wanted < 0) wanted = group(number);
    if (group(number) != wanted || (chains && *chains != chained(number))) {
      ++it;
      continue;
    }
    chains = chained(number);
    ++taken;
    it = ready_.erase(it);
    if (follows(number))
      batch.orbits.push_back(begin(number));
    else
      batch.fresh.push_back(number);
  }
  return batch;
}

void OrbitQueue::finish(Orbit orbit) {
  const auto number = static_cast<std::size_t>(orbit.task);
  if (orbit.stage == Orbit::Stage::stopped) {
    // What it began with, for a follower; nothing where that was its own initial state.
    orbit.now = follows(orbit.task) ? begin(orbit.task).now : LaneState{};
    orbit.entry = {};
  }
  fresh_.push_back(orbit.task);
  orbits_[number] = std::move(orbit);
  done_[number] = true;
  --open_;
  const int follower = tasks_[number].follower;
  if (follower >= 0 && !done_[static_cast<std::size_t>(follower)]) ready_.push_front(follower);
}

MarchedOrbits OrbitQueue::stock(const std::vector<std::vector<Orbit>>& marching) {
  MarchedOrbits marched;
  for (const int number : fresh_) marched.finished.push_back(orbits_[static_cast<std::size_t>(number)]);
  fresh_.clear();
  for (const auto& block : marching)
    for (const Orbit& orbit : block)
      if (!done_[static_cast<std::size_t>(orbit.task)]) marched.running.push_back(orbit);
  marched.running.insert(marched.running.end(), resumed_.begin(), resumed_.end());
  return marched;
}

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

// Marches a block of these orbits, and of others that take the places of those that end. It ends when all have ended or
// the block is half empty. What is left is returned, for a narrower block.
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
    throw std::runtime_error(refusal.sentence.text);
  }
  checkpoint(queue_.stock({orbits}));
  if (stop) throw Interrupted{};
}

}  // namespace ricochet
