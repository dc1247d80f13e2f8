#pragma once
#include <algorithm>
#include <memory>
#include <ricochet/engine/flight/closed_steps.hpp>
#include <ricochet/engine/flight/flight_set.hpp>
#include <ricochet/engine/step_observer.hpp>
#include <span>
#include <string>
#include <vector>

namespace ricochet {

/// Leaves out the steps of one lane in which nothing happens. Allocates when constructed, and when points close
/// together that it does not remember.
class Flight {
 public:
  /// Below it a flight costs more than its steps.
  static constexpr long long least = 4;

  /// For an integration of about `steps` steps. `layer` (m): the law acts from so far before the stops.
  Flight(const Program& program, double layer, long long steps);

  /// Why it cannot fly at all; empty where it can.
  const std::string& cause() const { return free_->cause(); }
  /// Whether closed contact is composed too, and if not, why.
  const std::string& closed_cause() const { return closed_cause_; }
  /// Whether steps of closed contact are left to ClosedSteps where they are not composed, and if not, why.
  const std::string& steps_cause() const { return steps_cause_; }

  /// Whether the state before any step that is left out can be told. Nobody then has to see a step for what comes
  /// after it: contact may change in the one that follows a flight.
  bool tells_slots() const { return tells_slots_; }

  /// Another lane: its stops, and the layer from which the law acts.
  void place(const LaneSpec& lane, double layer);

  /// Forgets what it has learnt of the steps so far, so that those to come depend on the state alone.
  void forget();

  /// The slots of the lane, and behind them those of its tangent columns, rows each.
  using Columns = std::span<double* const* const>;

  /// Whether a search may find something in a lane with these closed points; to be asked once a step.
  bool due(const Program& program, std::span<const ClosedPoint> closed);
  /// How many of the next `most` steps may be left out; 0: march. Nothing changes in them, nor in the one after where
  /// slots are not told. `columns`, `e`: the lane's state; `past`: its efforts. Where a search is due.
  long long search(Columns columns, const double* e, ClosedSteps::Past past, long long most);
  /// The number of next steps in which no open point can close, as far as the last search has seen. The one after a
  /// flight is among them. No lane without contact then needs to be measured.
  long long clear() const { return clear_; }
  /// Leaves them out: the slots k steps later, of tangents without what drives the lane. Right after search().
  FlightSums fly(long long k, Columns columns, ClosedSteps::Past past, bool works);
  /// Largest penetration after any of them, m.
  double penetration() const { return steps_ ? steps_->penetration() : 0.0; }

  /// The slots before one of the steps last left out, rows each, where tells_slots(); until it is asked again.
  const double* const* slots_before(long long step);

  /// Widens [low, high] by the tip's displacement, absolute, after each of the steps last left out.
  void tip_extremes(double& low, double& high);
  /// The same after each of them, in turn: `see`(displacement, m).
  template <class See>
  void each_tip(See&& see) {
    if (steps_) {
      for (const double tip : steps_->tips()) see(tip);
      return;
    }
    last_ = start_;
    set_->tip_readings().each(set_->motion(), flown_, last_.x.data(), last_.e, see);
  }
  /// Each stage of each of them: `see`(stage, efforts, places). Efforts are those of the closed points in their order,
  /// N. Places are their absolute places before the stage, m; none where they rest. A stage that reads no contact has
  /// no efforts. Found once for all who ask.
  template <class See>
  void each_stage(See&& see) {
    if (steps_) return steps_->each_stage(see);
    const std::size_t points = set_->closed().size();
    for (long long first = 0; first < flown_; first += effort_block) {
      const long long count = find_efforts(first);
      for (long long k = 0; k < count; ++k)
        see(0, std::span<const double>(efforts_.data() + static_cast<std::size_t>(k) * points, points),
            std::span<const double>{});
    }
  }
  /// Σ|p|, Σp², the largest |p| and the last of each closed point over these steps, without reading each. None where
  /// that would not cost less: then each_stage() tells. Found once for all who ask. Where a step has one stage.
  struct Pushed {
    double sum = 0, squares = 0, most = 0, last = 0;  // N, N²
  };
  std::span<const Pushed> pushed();
  /// Whether no step without contact can gain energy beyond what loads bring, whatever the state.
  bool free_never_gains() const { return free_->works().never_gains(); }

 private:
  static constexpr long long effort_block = 4096;

  struct Schedule {
    long long next = 16;              // steps to ask for first
    long long wait = 0, penalty = 0;  // steps between two searches
    long long dear = 0;               // steps to march after one that cost as much as marching
  };
  struct ContactSet {
    std::vector<ClosedPoint> closed;
    long long seen = 0;  // steps that began with these points closed, and might have been left out
    std::unique_ptr<FlightSet> set;
    std::unique_ptr<ClosedSteps> steps;
    Schedule schedule;
  };
  /// A state in the modes of set_.
  struct Leg {
    std::vector<double> x;
    double e[3] = {};
  };
  static std::string why_not_closed(const Program& program);
  long long step_closed(Columns columns, const double* e, ClosedSteps::Past past, long long most);
  ContactSet& contact_set(std::span<const ClosedPoint> closed);
  const FlightSet* twin_of(const ContactSet& one, long long enough) const;
  /// `leg` moved on by k steps.
  void advance(long long k, Leg& leg) const { set_->motion().advance(k, leg.x.data(), leg.e); }
  /// Those of the steps from `first`, a multiple of effort_block, on; returns how many.
  long long find_efforts(long long first);
  /// One point of a measure, whose extremes over the steps left out are looked for.
  struct Sought {
    FlightBound* bound;
    const StepReadings& readings;
    int point = 0;
    double low, high;
    void see(double value) {
      low = std::min(low, value);
      high = std::max(high, value);
    }
  };
  void see_at(Sought& sought, const Leg& leg);
  void find_extremes(const ExtremeBounds& bounds, Sought& sought);
  bool told_by_ends(Sought& sought, const Leg& leg, long long k, int stride);
  void read_all(const Leg& leg, long long steps, Sought& sought);
  void search(Sought& sought, std::size_t depth, long long k, int stride);
  void push_point(std::size_t i, PushTables& tables);

  double layer_;
  bool crossed_ = false;     // whether stops pass each other somewhere
  long long worth_reading_;  // readings of points for each step that is left out
  int powers_;
  std::size_t most_sets_;
  std::unique_ptr<FlightSet> free_;
  Schedule schedule_;
  bool comes_back_ = false;  // whether the march was set back once
  std::string closed_cause_, steps_cause_;
  bool tells_slots_ = false;
  std::vector<std::unique_ptr<ContactSet>> sets_;
  const ContactSet* latest_ = nullptr;  // of the last step, and for how many it has been
  long long latest_for_ = 0;
  // Of the search that is due and the flight after it:
  FlightSet* set_ = nullptr;
  ClosedSteps* steps_ = nullptr;  // null: composed
  Schedule* set_schedule_ = nullptr;
  Leg start_, last_;
  std::vector<Leg> tangents_;  // where they start
  long long flown_ = 0, clear_ = 0;
  // Efforts of up to effort_block steps from one of them on (−1: of none yet), and the state that they lead to.
  std::vector<double> efforts_;
  Leg after_efforts_;
  long long efforts_from_ = -1, effort_next_ = 0;
  std::vector<Pushed> pushed_;
  std::vector<double> values_;  // of the points of a measure
  bool pushed_asked_ = false;
  std::vector<Leg> legs_;  // of a search, by depth
  std::vector<std::vector<double>> slots_;
  std::vector<double*> slot_pointers_;
};

/// Steps of one lane of which only sums are told. Either they were marched and no stop was looked at, or a flight left
/// them out and contact stayed what it was. In the step after a flight it is the same too, unless
/// Flight::tells_slots().
struct StepInterval {
  long long steps = 0;
  double from = 0;                      ///< when the first begins, s
  std::span<const FreeStep> marched;    ///< each of them; none: they were left out
  Flight* flight = nullptr;             ///< what left them out; null: they were marched
  FlightSums works;                     ///< of steps left out, where the plan has work forms
  std::span<const ClosedPoint> closed;  ///< points that stayed closed; none: nothing was touched
  int instants = 0;                     ///< instants of contact in a step where some did
  double penetration = 0;               ///< largest after any of these steps, m

  /// `see`(displacement) for the absolute displacement of the tip after each step, in turn, m. Of marched steps an
  /// observer asks for it.
  template <class See>
  void each_tip(See&& see) const {
    if (flight) return flight->each_tip(see);
    for (const FreeStep& step : marched) see(step.tip);
  }
  /// Widens [low, high] by these displacements.
  void tip_extremes(double& low, double& high) const {
    if (flight) return flight->tip_extremes(low, high);
    for (const FreeStep& step : marched) {
      low = std::min(low, step.tip);
      high = std::max(high, step.tip);
    }
  }
  /// See Flight::pushed.
  std::span<const Flight::Pushed> pushed() const { return flight->pushed(); }
  /// Of steps left out, each stage in turn: see Flight::each_stage.
  template <class See>
  void each_stage(See&& see) const {
    flight->each_stage(see);
  }
};

}  // namespace ricochet
