#pragma once
#include <atomic>
#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "runners/kinds/sweep/orbit_queue.hpp"
#include "runners/march/block_service.hpp"

namespace ricochet {

/// How a set of orbits is marched.
struct ScheduleOptions {
  SectionPlan section;
  int lanes = 8;  ///< most lanes of a block
  /// Where no orbit is ready any more, so many or fewer that still run are left as they are: another block takes them.
  int leave = 0;
  double interval = 5;             ///< s between checkpoints
  double budget = 1e300;           ///< processor seconds
  bool ends_only = false;          ///< of what has ended only its end is kept (keep_end); no task may be followed
  BlockService* blocks = nullptr;  ///< other processes that march; null: the caller itself
  std::string case_id = {};        ///< for them
};

/// Marches orbits in blocks of lanes: chains (orbits that follow each other) first and in narrow blocks of their own.
/// The bits of an orbit depend on its task alone.
class OrbitScheduler {
 public:
  OrbitScheduler(const ForcedScenes& scenes, ScheduleOptions options);

  /// Adds a task and returns its number.
  int add(OrbitTask task) { return queue_.add(std::move(task)); }
  const OrbitTask& task(int number) const { return queue_.task(number); }
  int count() const { return queue_.count(); }

  /// Takes back what an interrupted run had marched.
  void restore(MarchedOrbits marched) { queue_.restore(std::move(marched)); }
  /// Marches everything that is not finished. `checkpoint` is called now and then with what is new since the last call.
  /// Throws Interrupted when `stop` becomes true (after a last checkpoint).
  void run(const std::atomic<bool>& stop, const std::function<void(const MarchedOrbits&)>& checkpoint);

  /// The orbit of a finished task; stage complete or stopped.
  const Orbit& orbit(int number) const { return queue_.orbit(number); }
  bool finished(int number) const { return queue_.finished(number); }
  /// Periods that a block marched it: all but the first one of an orbit from t = 0. Whoever marched it, and when.
  long long marched_periods(int number) const;
  /// Processor seconds of marching, and lane-periods made.
  double seconds() const { return seconds_; }
  long long lane_periods() const { return lane_periods_; }
  bool over_budget() const { return over_budget_; }

 private:
  using Clock = std::chrono::steady_clock;
  bool going(const std::atomic<bool>& stop) const;
  std::vector<Orbit> begin(OrbitQueue::Batch batch);
  std::vector<Orbit> march_block(std::vector<Orbit> orbits, const std::atomic<bool>& stop,
                                 const std::function<void(const MarchedOrbits&)>& checkpoint);
  std::vector<Orbit> start(const std::vector<int>& numbers);

  const ForcedScenes& scenes_;
  ScheduleOptions options_;
  OrbitQueue queue_;
  double seconds_ = 0;
  long long lane_periods_ = 0;
  bool over_budget_ = false;
  double counted_ = 0;                     // processor time of this thread that has been told
  Clock::time_point last_ = Clock::now();  // of a checkpoint
};

}  // namespace ricochet
