#pragma once
#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "runners/kinds/sweep/orbit_exponents.hpp"
#include "runners/kinds/sweep/orbit_scheduler.hpp"
#include "runners/march/case_context.hpp"

/// \file
/// Orbits of a case that another process marches, as bytes: the order that it gets, and what it answers. An order says
/// enough for each result to be bitwise the one that it has anywhere. Decisions that the first scene takes for all (the
/// operator, the measure of settling) are taken once, by the case, and travel with the order.
namespace ricochet {

/// Where an orbit begins; what else its lane is, its scene says.
struct OrderedOrbit {
  int scene = 0;  ///< of the order
  std::vector<double> position, velocity;
};

/// Orbits of one group.
struct BlockOrder {
  std::vector<SceneVariant> scenes;  ///< the one that chose the operator first
  SectionPlan section;
  int lanes = 8;
  int leave = 0;  ///< see ScheduleOptions
  bool ends_only = false;
  double interval = 5;  ///< s between two tellings of what would be lost
  std::vector<OrderedOrbit> orbits;
  MarchedOrbits marched;  ///< numbers of tasks are places in `orbits`; for exponents: finished ones with their entries
  int exponents = 0;      ///< 0: the orbits are marched; else so many exponents of each are measured
  std::vector<int> rounds;  ///< for exponents: see ExponentTask
  bool sawtooth = false;    ///< see MarginalRoots
};

/// What of it is new since the last answer. The last one holds the orbits that are left to others.
struct BlockAnswer {
  MarchedOrbits marched;
  std::vector<OrbitExponents> exponents;
  double seconds = 0;          ///< processor time so far
  long long lane_periods = 0;  ///< so far
};

std::string to_bytes(const BlockOrder& order);
std::string to_bytes(const BlockAnswer& answer);
BlockOrder block_order(const std::string& bytes);
BlockAnswer block_answer(const std::string& bytes);

/// Puts orbits of a case into orders.
class BlockOrders {
 public:
  BlockOrders(const ForcedScenes& scenes, const SectionPlan& section) : scenes_(scenes) { order_.section = section; }
  BlockOrder& order() { return order_; }
  /// Adds an orbit and returns its place.
  int add(int scene, const LaneSpec& lane);

 private:
  int place(int scene);

  const ForcedScenes& scenes_;
  BlockOrder order_;
  std::map<int, int> places_;  // of scenes
};

/// The side that marches: keeps the scenes of the cases that it last worked for.
class BlockMarcher {
 public:
  explicit BlockMarcher(const Registry& registry) : registry_(registry) {}
  /// See CaseRunner::block.
  std::string march(const StudyCase& study_case, const std::string& order,
                    const std::function<void(std::string)>& so_far, const std::atomic<bool>& stop);

 private:
  using Key = std::pair<std::vector<std::pair<std::string, double>>, bool>;
  struct Scenes {
    const StudyCase* study_case;
    Key reference_scene;
    std::unique_ptr<ForcedScenes> all;
    std::map<Key, int> known;
  };
  static Key key_of(const SceneVariant& variant) { return {variant.values, variant.own_state}; }
  Scenes& scenes_of(const StudyCase& study_case, const SceneVariant& reference_scene);

  const Registry& registry_;
  std::list<Scenes> kept_;  // the one that was used last first
};

/// The blocks of one case that other processes march, and what was heard of them. Those that are left at the end are
/// asked to stop.
class BlocksUnderWay {
 public:
  BlocksUnderWay(BlockService& service, std::string case_id);
  ~BlocksUnderWay() { stop(); }
  BlocksUnderWay(const BlocksUnderWay&) = delete;
  BlocksUnderWay& operator=(const BlocksUnderWay&) = delete;

  int begin(const std::string& order);
  /// Blocks of which there is still something to hear.
  std::size_t count() const { return under_way_.size(); }
  /// Whether another one may begin: one more than this case may count on waits for a process that is free.
  bool room() const { return count() <= static_cast<std::size_t>(service_.share()); }
  /// The next status, of the block of this number; nothing where so many seconds brought none.
  std::optional<std::pair<int, BlockStatus>> next(double seconds);
  void stop();

 private:
  // Outlives this object: what is told late is told to nobody.
  struct Inbox {
    std::mutex mutex;
    std::condition_variable changed;
    std::deque<std::pair<int, BlockStatus>> status;
  };

  BlockService& service_;
  const std::string case_id_;
  std::shared_ptr<Inbox> inbox_ = std::make_shared<Inbox>();
  std::map<int, int> under_way_;  // numbers of the service, by ours
  int begun_ = 0;
};

}  // namespace ricochet
