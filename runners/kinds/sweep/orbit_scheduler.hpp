#pragma once
#include <atomic>
#include <functional>
#include <mutex>
#include <vector>

#include "runners/kinds/sweep/forced_scenes.hpp"

namespace ricochet {

/// An orbit to be marched: at a scene, from an initial state, or on from where another orbit ended.
struct OrbitTask {
  int scene = 0;
  LaneSpec lane;   ///< of the scene, with the initial state of this orbit
  int after = -1;  ///< the task whose end is this one's start; −1: from lane's initial state
  int follower = -1;
};

/// What has been marched so far, for a checkpoint: finished orbits, and those on their way.
struct MarchedOrbits {
  std::vector<Orbit> finished, running;
};

/// How a set of orbits is marched.
struct ScheduleOptions {
  SectionPlan section;
  int workers = 1;
  int lanes = 8;          ///< most lanes of a block
  double interval = 5;    ///< s between checkpoints
  double budget = 1e300;  ///< processor seconds
  bool lean = false;      ///< finished orbits keep what classifies them: no impacts, no states; none may be followed
};

/// Marches orbits in blocks of lanes, on threads that take from one queue: chains (orbits that follow each other) first
/// and in narrow blocks of their own, the others beside them. An orbit's bits depend on its task alone. An orbit that
/// stops hands the state it began with to its follower, so that one bad value does not end a sweep.
class OrbitScheduler {
 public:
  OrbitScheduler(const ForcedScenes& scenes, ScheduleOptions options);

  /// Adds a task and returns its number.
  int add(OrbitTask task);
  const OrbitTask& task(int number) const { return tasks_[static_cast<std::size_t>(number)]; }
  int count() const { return static_cast<int>(tasks_.size()); }

  /// Takes back what an interrupted run had marched.
  void restore(MarchedOrbits marched);
  /// Marches everything that is not finished. `checkpoint` is called now and then, from one thread at a time, with what
  /// is new since the last call. Throws Interrupted when `stop` becomes true (after a last checkpoint).
  void run(const std::atomic<bool>& stop, const std::function<void(const MarchedOrbits&)>& checkpoint);

  /// The orbit of a finished task; stage complete or stopped.
  const Orbit& orbit(int number) const { return orbits_[static_cast<std::size_t>(number)]; }
  bool finished(int number) const { return done_[static_cast<std::size_t>(number)]; }
  /// Processor seconds of marching, and lane-periods made, over all threads.
  double seconds() const { return seconds_; }
  long long lane_periods() const { return lane_periods_; }
  bool over_budget() const { return over_budget_; }

 private:
  struct Shared;
  void work(Shared& shared, int worker);
  std::vector<int> take(Shared& shared, int group, int most);
  std::vector<Orbit> admit(Shared& shared, std::unique_lock<std::mutex>& lock, const std::vector<int>& numbers);
  std::vector<Orbit> next_batch(Shared& shared, int worker, std::unique_lock<std::mutex>& lock);
  std::vector<Orbit> march_block(Shared& shared, int worker, std::unique_lock<std::mutex>& lock,
                                 std::vector<Orbit> orbits, double& counted);
  void look_around(Shared& shared, int worker, const SectionMarch& block);
  MarchedOrbits take_stock(Shared& shared) const;
  bool follows(int number) const;
  void finish(Shared& shared, Orbit orbit);
  Orbit begin(int number) const;
  std::vector<Orbit> start(const std::vector<int>& numbers);

  const ForcedScenes& scenes_;
  ScheduleOptions options_;
  std::vector<OrbitTask> tasks_;
  std::vector<Orbit> orbits_;
  std::vector<bool> done_;
  std::vector<Orbit> waiting_;  // on their way when the last run was interrupted
  double seconds_ = 0;
  long long lane_periods_ = 0;
  bool over_budget_ = false;
};

}  // namespace ricochet
