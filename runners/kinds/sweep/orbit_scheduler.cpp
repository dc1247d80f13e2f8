#include "runners/kinds/sweep/orbit_scheduler.hpp"

#include <oneapi/tbb/task_arena.h>
#include <oneapi/tbb/task_group.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <optional>

#include "runners/kinds/trajectory/run_case.hpp"
#include "runners/march/case_watch.hpp"
#include "runners/march/prepare_case.hpp"

namespace ricochet {
namespace {

using Clock = std::chrono::steady_clock;

double since(Clock::time_point then) {
  return std::chrono::duration<double>(Clock::now() - then).count();
}

}  // namespace

struct OrbitScheduler::Shared {
  std::mutex mutex;
  std::condition_variable changed;
  std::deque<int> ready;      // tasks that may begin
  std::deque<Orbit> resumed;  // orbits that may go on
  int open = 0;               // tasks not finished
  bool ended = false;
  std::exception_ptr failure;
  const std::atomic<bool>* stop = nullptr;
  const std::function<void(const MarchedOrbits&)>* checkpoint = nullptr;
  std::vector<Orbit> fresh;                   // finished since the last checkpoint
  std::vector<std::vector<Orbit>> snapshots;  // per worker, what is on its way
  Clock::time_point last = Clock::now();
  long long wanted = 0;          // snapshots asked for so far
  std::vector<long long> shown;  // and given, per worker
  double spent = 0;
};

OrbitScheduler::OrbitScheduler(const ForcedScenes& scenes, ScheduleOptions options)
    : scenes_(scenes), options_(std::move(options)) {}

int OrbitScheduler::add(OrbitTask task) {
  const int number = count();
  if (task.after >= 0) tasks_[static_cast<std::size_t>(task.after)].follower = number;
  tasks_.push_back(std::move(task));
  orbits_.emplace_back();
  done_.push_back(false);
  return number;
}

void OrbitScheduler::restore(MarchedOrbits marched) {
  for (Orbit& orbit : marched.finished) {
    const auto number = static_cast<std::size_t>(orbit.task);
    if (number >= tasks_.size()) continue;
    done_[number] = true;
    orbit.lane = tasks_[number].lane;
    orbits_[number] = std::move(orbit);
  }
  for (Orbit& orbit : marched.running) {
    const auto number = static_cast<std::size_t>(orbit.task);
    if (number >= tasks_.size() || done_[number]) continue;
    orbit.lane = tasks_[number].lane;
    waiting_.push_back(std::move(orbit));
  }
}

// Whether a task goes on from the end of another; one that stopped in its own first period left none.
bool OrbitScheduler::follows(int number) const {
  const int after = task(number).after;
  return after >= 0 && !orbits_[static_cast<std::size_t>(after)].now.slots.empty();
}

// An orbit whose start is another's end.
Orbit OrbitScheduler::begin(int number) const {
  const OrbitTask& one = task(number);
  Orbit orbit;
  orbit.task = number;
  orbit.lane = one.lane;
  const Orbit& before = orbits_[static_cast<std::size_t>(one.after)];
  orbit.now = scenes_.carry(before.now, scenes_[task(one.after).scene].group, scenes_[one.scene].group);
  return orbit;
}

// Orbits that start from an initial state march their first period together.
std::vector<Orbit> OrbitScheduler::start(const std::vector<int>& numbers) {
  std::vector<LaneSpec> lanes;
  for (const int number : numbers) lanes.push_back(task(number).lane);
  const int group = scenes_[task(numbers.front()).scene].group;
  StartedOrbits started = start_orbits(scenes_.program(group, lanes), options_.section);
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
    }
    orbits.push_back(std::move(orbit));
  }
  return orbits;
}

void OrbitScheduler::finish(Shared& shared, Orbit orbit) {
  const auto number = static_cast<std::size_t>(orbit.task);
  const int follower = tasks_[number].follower;
  if (options_.lean) {
    orbit.impacts = {};
    orbit.points = {};
    orbit.settling = {};
    orbit.entry = orbit.now = {};
  }
  shared.fresh.push_back(orbit);
  orbits_[number] = std::move(orbit);
  done_[number] = true;
  --shared.open;
  if (follower >= 0 && !done_[static_cast<std::size_t>(follower)]) shared.ready.push_front(follower);
  shared.changed.notify_all();
}

// Tasks of one group that may begin now; group −1: of the group of the first one.
std::vector<int> OrbitScheduler::take(Shared& shared, int group, int most) {
  std::vector<int> taken;
  const auto chained = [&](int number) { return task(number).follower >= 0 || task(number).after >= 0; };
  std::optional<bool> kind;
  for (auto it = shared.ready.begin(); it != shared.ready.end() && static_cast<int>(taken.size()) < most;) {
    const int its_group = scenes_[task(*it).scene].group;
    if (group < 0) group = its_group;
    // A new block holds either chains or single orbits: chains are long, and fastest in narrow blocks.
    if (its_group == group && (!kind || *kind == chained(*it))) {
      kind = chained(*it);
      taken.push_back(*it);
      it = shared.ready.erase(it);
    } else {
      ++it;
    }
  }
  return taken;
}

// Orbits of these tasks, ready to march; those from an initial state march their first period here, unlocked.
std::vector<Orbit> OrbitScheduler::admit(Shared& shared, std::unique_lock<std::mutex>& lock,
                                         const std::vector<int>& numbers) {
  std::vector<Orbit> orbits;
  std::vector<int> first;
  for (const int number : numbers)
    if (follows(number))
      orbits.push_back(begin(number));
    else
      first.push_back(number);
  if (first.empty()) return orbits;
  lock.unlock();
  std::vector<Orbit> started = start(first);
  lock.lock();
  for (Orbit& orbit : started) {
    if (orbit.stage == Orbit::Stage::stopped) {
      orbit.now = {};
      finish(shared, std::move(orbit));
    } else {
      orbits.push_back(std::move(orbit));
    }
  }
  return orbits;
}

// What a worker marches next, all of one group: orbits that an interrupted run had on their way, else new ones. Empty
// after it has waited for other workers, where none was ready.
std::vector<Orbit> OrbitScheduler::next_batch(Shared& shared, int worker, std::unique_lock<std::mutex>& lock) {
  std::vector<Orbit> orbits;
  const auto group_of = [&](int number) { return scenes_[task(number).scene].group; };
  while (!shared.resumed.empty() && static_cast<int>(orbits.size()) < options_.lanes) {
    if (!orbits.empty() && group_of(shared.resumed.front().task) != group_of(orbits.front().task)) break;
    orbits.push_back(std::move(shared.resumed.front()));
    shared.resumed.pop_front();
  }
  shared.snapshots[static_cast<std::size_t>(worker)] = orbits;  // resumed ones are not lost before their first period
  if (!orbits.empty()) return orbits;
  const int fair = (static_cast<int>(shared.ready.size()) + options_.workers - 1) / options_.workers;
  const std::vector<int> taken = take(shared, -1, std::clamp(fair, 1, options_.lanes));
  if (taken.empty()) {
    shared.changed.wait(lock);
    return orbits;
  }
  return admit(shared, lock, taken);
}

// Everything new since the last call, and what is on its way.
MarchedOrbits OrbitScheduler::take_stock(Shared& shared) const {
  MarchedOrbits marched;
  marched.finished = std::move(shared.fresh);
  shared.fresh.clear();
  for (const auto& snapshot : shared.snapshots)
    for (const Orbit& orbit : snapshot)
      if (!done_[static_cast<std::size_t>(orbit.task)]) marched.running.push_back(orbit);
  marched.running.insert(marched.running.end(), shared.resumed.begin(), shared.resumed.end());
  return marched;
}

// Between two periods of a block: stops everyone where that is asked for, and saves what is due.
void OrbitScheduler::look_around(Shared& shared, int worker, const SectionMarch& block) {
  std::vector<Orbit>& snapshot = shared.snapshots[static_cast<std::size_t>(worker)];
  long long& shown = shared.shown[static_cast<std::size_t>(worker)];
  const bool spent = shared.spent > options_.budget;
  const bool due = since(shared.last) > options_.interval;
  if (due) ++shared.wanted;
  if (shared.wanted != shown) snapshot = block.running();
  shown = shared.wanted;
  over_budget_ = over_budget_ || spent;
  shared.ended = shared.ended || spent || *shared.stop;
  if (!due) return;
  shared.last = Clock::now();
  (*shared.checkpoint)(take_stock(shared));
}

// Marches a block of these orbits, and of others that take the places of those that end, until all have ended or the
// block is more than half empty: what is left is returned, for a narrower one.
std::vector<Orbit> OrbitScheduler::march_block(Shared& shared, int worker, std::unique_lock<std::mutex>& lock,
                                               std::vector<Orbit> orbits, double& counted) {
  const int group = scenes_[task(orbits.front().task).scene].group;
  int running = static_cast<int>(orbits.size());
  lock.unlock();
  const std::vector<LaneSpec> places(static_cast<std::size_t>(lane_width(running)), orbits.front().lane);
  SectionMarch block(scenes_.program(group, places), options_.section);
  for (int i = 0; i < running; ++i) block.load(i, std::move(orbits[static_cast<std::size_t>(i)]));
  lock.lock();
  while (running > 0 && !shared.ended) {
    lock.unlock();
    std::vector<Orbit> ended = block.period();
    const double now = thread_seconds();
    lock.lock();
    shared.spent += now - counted;
    counted = now;
    lane_periods_ += running;
    running -= static_cast<int>(ended.size());
    for (Orbit& orbit : ended) {
      if (orbit.stage == Orbit::Stage::stopped) {
        // What it began with, for a follower; nothing where that was its own initial state.
        orbit.now = follows(orbit.task) ? begin(orbit.task).now : LaneState{};
        orbit.entry = {};
      }
      finish(shared, std::move(orbit));
    }
    if (running < block.places() && !shared.ready.empty()) {
      std::vector<Orbit> more = admit(shared, lock, take(shared, group, block.places() - running));
      for (int i = 0; i < block.places() && !more.empty(); ++i) {
        if (!block.idle(i)) continue;
        block.load(i, std::move(more.back()));
        more.pop_back();
        ++running;
      }
    }
    look_around(shared, worker, block);
    if (2 * running <= block.places()) break;
  }
  std::vector<Orbit> left = block.running();
  shared.snapshots[static_cast<std::size_t>(worker)] = left;
  return left;
}

void OrbitScheduler::work(Shared& shared, int worker) {
  double counted = thread_seconds();
  std::unique_lock lock(shared.mutex);
  while (shared.open > 0 && !shared.ended) {
    std::vector<Orbit> orbits = next_batch(shared, worker, lock);
    while (!orbits.empty() && !shared.ended) orbits = march_block(shared, worker, lock, std::move(orbits), counted);
  }
}

void OrbitScheduler::run(const std::atomic<bool>& stop, const std::function<void(const MarchedOrbits&)>& checkpoint) {
  Shared shared;
  shared.stop = &stop;
  shared.checkpoint = &checkpoint;
  shared.snapshots.resize(static_cast<std::size_t>(options_.workers));
  shared.shown.resize(static_cast<std::size_t>(options_.workers));
  std::vector<bool> on_its_way(tasks_.size(), false);
  for (Orbit& orbit : waiting_) {
    on_its_way[static_cast<std::size_t>(orbit.task)] = true;
    shared.resumed.push_back(std::move(orbit));
  }
  waiting_.clear();
  for (std::size_t number = 0; number < tasks_.size(); ++number) {
    if (done_[number]) continue;
    ++shared.open;
    const int after = tasks_[number].after;
    if (!on_its_way[number] && (after < 0 || done_[static_cast<std::size_t>(after)]))
      shared.ready.push_back(static_cast<int>(number));
  }
  // Chains first.
  std::stable_partition(shared.ready.begin(), shared.ready.end(),
                        [&](int number) { return task(number).follower >= 0 || task(number).after >= 0; });
  std::mutex total;
  const TicketPointer ticket = current_ticket();
  const auto body = [&](int worker) {
    const CaseScope scope(ticket);
    const double began = thread_seconds();
    try {
      work(shared, worker);
    } catch (const Refusal& refusal) {
      const std::lock_guard guard(shared.mutex);
      shared.failure = std::make_exception_ptr(std::runtime_error(refusal.sentence));
      shared.ended = true;
    } catch (...) {
      const std::lock_guard guard(shared.mutex);
      shared.failure = std::current_exception();
      shared.ended = true;
    }
    shared.changed.notify_all();
    const std::lock_guard guard(total);
    seconds_ += thread_seconds() - began;
  };
  // A worker waits only for orbits that another one is marching: fewer threads than workers make no difference.
  tbb::task_arena arena(options_.workers);
  arena.execute([&] {
    tbb::task_group group;
    for (int worker = 1; worker < options_.workers; ++worker) group.run([&body, worker] { body(worker); });
    body(0);
    group.wait();
  });
  if (shared.failure) std::rethrow_exception(shared.failure);
  checkpoint(take_stock(shared));
  if (stop) throw Interrupted{};
}

}  // namespace ricochet
