#pragma once
#include <atomic>
#include <chrono>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "runners/kinds/sweep/forced_scenes.hpp"
#include "runners/march/case_context.hpp"

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

/// Which orbits may begin, and which are done: what a scheduler writes down, without threads and without marching. An
/// orbit that stops hands the state it began with to its follower, so that one bad value does not end a sweep.
class OrbitQueue {
 public:
  explicit OrbitQueue(const ForcedScenes& scenes) : scenes_(scenes) {}

  int add(OrbitTask task);
  const OrbitTask& task(int number) const { return tasks_[static_cast<std::size_t>(number)]; }
  int count() const { return static_cast<int>(tasks_.size()); }
  const Orbit& orbit(int number) const { return orbits_[static_cast<std::size_t>(number)]; }
  bool finished(int number) const { return done_[static_cast<std::size_t>(number)]; }
  /// Whether a task goes on from the end of another; one that stopped in its own first period left none.
  bool follows(int number) const;
  /// Whether it follows another one or is followed.
  bool chained(int number) const { return task(number).follower >= 0 || task(number).after >= 0; }
  int group(int number) const { return scenes_[task(number).scene].group; }

  /// Takes back what an interrupted run had marched.
  void restore(MarchedOrbits marched);
  /// Makes everything that is not finished ready, chains first.
  void open();
  int open_tasks() const { return open_; }
  /// Orbits that may begin or go on.
  int waiting() const { return ready() + static_cast<int>(resumed_.size()); }
  int ready() const { return static_cast<int>(ready_.size()); }

  /// Orbits that march together.
  struct Batch {
    std::vector<Orbit> orbits;  ///< that go on from a state
    std::vector<int> fresh;     ///< tasks that start at t = 0
    bool empty() const { return orbits.empty() && fresh.empty(); }
  };
  /// Orbits of one group that an interrupted run had on their way.
  std::vector<Orbit> resume(int most);
  /// Orbits on their way that nobody marches, at most so many lanes of them; empty where there are none. Single ones
  /// come with others of their group that may begin, up to `most` together.
  Batch go_on(int lanes, int most);
  /// Orbits on their way that are marched no further where they were.
  void give_back(std::vector<Orbit> orbits);
  /// Tasks of one group that may begin now; group −1: of the group of the first one. A batch holds either chains or
  /// single orbits: chains are long, and fastest in narrow blocks.
  Batch take(int group, int most, std::optional<bool> chains = {});

  /// An orbit has completed or stopped.
  void finish(Orbit orbit);
  /// What is finished since the last call, and of the given orbits and those that wait the ones on their way.
  MarchedOrbits stock(const std::vector<std::vector<Orbit>>& marching);

 private:
  Orbit begin(int number) const;

  const ForcedScenes& scenes_;
  std::vector<OrbitTask> tasks_;
  std::vector<Orbit> orbits_;
  std::vector<bool> done_;
  std::vector<Orbit> waiting_;  // on their way when the last run was interrupted
  std::deque<int> ready_;       // tasks that may begin
  std::deque<Orbit> resumed_;   // orbits that may go on
  std::vector<int> fresh_;      // finished since the last stock
  int open_ = 0;                // tasks not finished
};

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
/// The result of an orbit depends on its task alone.
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
