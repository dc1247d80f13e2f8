#pragma once
#include <atomic>
#include <cstddef>
#include <deque>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "runners/kinds/sweep/block_orders.hpp"
#include "runners/kinds/sweep/orbit_exponents.hpp"
#include "runners/kinds/sweep/orbit_scheduler.hpp"

namespace ricochet {

/// Marches the orbits of a queue as blocks in other processes. A block whose process ends goes back orbit by orbit,
/// each from where it was last seen. An orbit that then ends a process of its own as well has stopped there, with the
/// reason. All others are bitwise equal to a run without it.
class DistributedOrbits {
 public:
  DistributedOrbits(OrbitQueue& queue, const ForcedScenes& scenes, const ScheduleOptions& options);

  /// As OrbitScheduler::run().
  void run(const std::atomic<bool>& stop, const std::function<void(const MarchedOrbits&)>& checkpoint);
  double seconds() const { return seconds_; }
  long long lane_periods() const { return lane_periods_; }
  bool over_budget() const { return over_budget_; }

 private:
  struct Block {
    std::vector<int> tasks;  // by their places in the order
    std::vector<Orbit> running;
    double seconds = 0;
    long long lane_periods = 0;
    bool alone = false;
  };

  void fill();
  int block_size() const;
  void send(OrbitQueue::Batch batch, bool alone);
  void hear(Block& block, const std::string& bytes);
  void lose(Block block, const std::string& cause);
  MarchedOrbits under_way();

  OrbitQueue& queue_;
  const ForcedScenes& scenes_;
  const ScheduleOptions& options_;
  BlocksUnderWay service_;
  std::map<int, Block> blocks_;
  std::deque<Orbit> alone_;      // to go on, or with no period: to begin, in blocks of their own
  std::map<int, int> attempts_;  // processes that ended, by task
  int timed_ = 1;                // orbits of a block that take some seconds
  double seconds_ = 0;
  long long lane_periods_ = 0;
  bool over_budget_ = false;
};

/// Measures batches of orbits of a task in other processes: `found` of each orbit is set, and `measured` told of each
/// batch that is complete. A batch whose process ends goes back orbit by orbit. An orbit that then ends a process of
/// its own as well has no exponents, and task.lost says why. Adds the processor seconds.
void measure_elsewhere(const ForcedScenes& scenes, const ExponentTask& task, const SectionPlan& plan,
                       const std::vector<std::vector<std::size_t>>& batches, std::vector<OrbitExponents>& found,
                       double& seconds, const std::function<void(std::size_t batch)>& measured,
                       const std::atomic<bool>& stop);

}  // namespace ricochet
