#pragma once
#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "runners/kinds/sweep/orbit_queue.hpp"
#include "runners/march/block_service.hpp"
#include "runners/march/thread_seats.hpp"

namespace ricochet {

class CaseWorker;

/// How a set of orbits is marched.
struct ScheduleOptions {
  SectionPlan section;
  ThreadSeats* seats = nullptr;  ///< of threads that may march; null: the caller alone
  int lanes = 8;                 ///< most lanes of a block
  /// Where no orbit is ready any more, so many or fewer that still run are left as they are: somebody marches them in
  /// company.
  int leave = 0;
  double interval = 5;             ///< s between checkpoints
  double budget = 1e300;           ///< processor seconds
  bool ends_only = false;          ///< of what has ended only its end is kept (keep_end); no task may be followed
  BlockService* blocks = nullptr;  ///< other processes that march; null: threads of this one
  std::string case_id = {};        ///< for them
};

/// Marches orbits in blocks of lanes, on threads that take from one queue and come and go with the seats: chains
/// (orbits that follow each other) first and in narrow blocks of their own, the others beside them. An orbit's bits
/// depend on its task alone.
class OrbitScheduler {
 public:
  OrbitScheduler(const ForcedScenes& scenes, ScheduleOptions options);

  /// Adds a task and returns its number.
  int add(OrbitTask task) { return queue_.add(std::move(task)); }
  const OrbitTask& task(int number) const { return queue_.task(number); }
  int count() const { return queue_.count(); }

  /// Takes back what an interrupted run had marched.
  void restore(MarchedOrbits marched) { queue_.restore(std::move(marched)); }
  /// Marches everything that is not finished. `checkpoint` is called now and then, from one thread at a time, with what
  /// is new since the last call. Throws Interrupted when `stop` becomes true (after a last checkpoint).
  void run(const std::atomic<bool>& stop, const std::function<void(const MarchedOrbits&)>& checkpoint);

  /// The orbit of a finished task; stage complete or stopped.
  const Orbit& orbit(int number) const { return queue_.orbit(number); }
  bool finished(int number) const { return queue_.finished(number); }
  /// Periods that a block marched it: all but the first one of an orbit from t = 0. Whoever marched it, and when.
  long long marched_periods(int number) const;
  /// Processor seconds of marching, and lane-periods made, over all threads.
  double seconds() const { return seconds_; }
  long long lane_periods() const { return lane_periods_; }
  bool over_budget() const { return over_budget_; }

 private:
  class Shared;
  void work(Shared& shared, CaseWorker& worker);
  std::vector<Orbit> begin(Shared& shared, OrbitQueue::Batch batch);
  std::vector<Orbit> march_block(Shared& shared, CaseWorker& worker, int place, std::vector<Orbit> orbits,
                                 double& counted);
  std::vector<Orbit> start(const std::vector<int>& numbers);

  const ForcedScenes& scenes_;
  ScheduleOptions options_;
  OrbitQueue queue_;
  double seconds_ = 0;
  long long lane_periods_ = 0;
  bool over_budget_ = false;
};

}  // namespace ricochet
