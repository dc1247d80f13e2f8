#pragma once
#include <atomic>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "runners/kinds/sweep/orbit_exponents.hpp"
#include "runners/kinds/sweep/orbit_scheduler.hpp"

/// \file
/// Orbits of a case that another process marches, as bytes: what it must be told so that each gets the bits that it has
/// anywhere, and what it answers. Decisions that the first scene takes for all (the operator, the measure of settling)
/// are taken once, by the case, and travel with the order.
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

}  // namespace ricochet
