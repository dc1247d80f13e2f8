#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <ricochet/engine/marcher.hpp>
#include <ricochet/measure/contact/contact_instants.hpp>
#include <ricochet/measure/contact/start_contact.hpp>
#include <vector>

/// \file
/// Contact point by point, as an integration meets it. Contact is looked at once per instant: each sub-step, with the
/// stages that ask together as one. A stage has the momentum weight ω (s): what an effort of 1 N finally gives to a
/// free mass. It finds the effort p at a point (N). An instant
///
///     lasts   Ω = max ω                over its stages (s),
///     gives   I = Σ ω |p|              (N s),    by the force    F = I / Ω    (N),
///
/// as the mean force of a window has it. An effort that gives no momentum (ω = 0, of a projection) closes a point and
/// is no force. The velocity of a point between two instants is the difference of its positions over the time between.
/// The positions are absolute, H q + φ, and stand before any stage of either instant. With one stage per step this is
/// (x_{n+1} − x_n)/h; with several sub-steps it is that of one of them. Stops do not move: it is relative to them.
/// The two points of a circle are one, the first, with an upper stop along the radius at each instant.
namespace ricochet {

/// A point closes at a stop, is pushed for one or more instants, and opens.
struct Impact {
  double time = 0;  ///< of the first instant with an effort, s
  int point = 0;    ///< row of H
  StopSide side = StopSide::lower;
  /// Towards the stop, m/s: the velocity over the sub-step that ends where the one that closes the point begins. It is
  /// free of the efforts of that one. Where there is no sub-step before, it is that of the initial state.
  double speed_in = 0;
  /// Away from the stop, m/s: the velocity over the second sub-step without an effort. What the first one still had of
  /// the efforts before it is spent then. The first one counts where the point closes again or the integration ends
  /// after it. NaN while the point is closed, and where it goes to the other stop at once.
  double speed_out = std::numeric_limits<double>::quiet_NaN();
  double impulse = 0;        ///< Σ I, N s
  double peak_force = 0;     ///< largest F, N
  double duration = 0;       ///< Σ Ω, s
  double release_force = 0;  ///< F of the last instant, N
  bool open_end = true;      ///< the point is still closed
};

/// A point at one of its stops, over the whole run.
struct StopTotals {
  long long impacts = 0;
  double peak_force = 0;    ///< N
  double impulse = 0;       ///< N s
  double contact_time = 0;  ///< Σ Ω, s
  double squares = 0;       ///< Σ Ω F², N² s
  /// ∫ F |v| dt, J. An instant gives I times the mean of |v|. The velocity goes evenly with the momentum given, from
  /// that over the sub-step before to that over the instant's own. So a free mass with e has ½ m v² (1 + e²).
  double normal_work = 0;
  double fastest = 0;  ///< largest speed in, m/s

  /// Over the time in contact, N; 0 where that is 0.
  double mean_force() const { return contact_time > 0 ? impulse / contact_time : 0; }
  double rms_force() const { return contact_time > 0 ? std::sqrt(squares / contact_time) : 0; }
};

/// Writes down the impacts of every contact point of every lane.
///
/// A step costs one copy of the positions where no slot of the plan holds what they moved by. A point that is open
/// costs nothing more. Nothing is allocated but by an impact, when the list grows. Beyond `most` impacts of a lane the
/// list ends, totals go on.
class ImpactRecorder final : public StepObserver {
 public:
  static constexpr std::size_t most_impacts = 100000;

  explicit ImpactRecorder(const Marcher& marcher, std::size_t most = most_impacts);

  /// Tells `listener` of every instant from now on. It outlives the integration.
  void tell(ContactListener* listener) { listeners_.push_back(listener); }

  void stage_solved(const Marcher& marcher, const StageView& view) override;
  void step_done(Marcher& marcher) override;
  void interval(Marcher& marcher, const StepInterval& steps) override;
  /// To be called once, when the integration is over: what its last sub-step was, for those who wait for it.
  void finish(const Marcher& marcher);

  /// In the order in which they began, those still closed included.
  const std::vector<Impact>& impacts(int lane) const { return lane_of(lane).impacts; }
  /// How often a point closed, summed over the points; may be more than the list holds.
  long long count(int lane) const { return lane_of(lane).count; }
  const StopTotals& totals(int lane, int point, StopSide side) const {
    return lane_of(lane).stops[2 * static_cast<std::size_t>(point) + static_cast<std::size_t>(side)];
  }

  /// Σ_i F_i of the last instant, N: forces of opposite stops do not cancel.
  double force(int lane) const { return lane_of(lane).force; }
  /// Largest F of one point since it was last asked, N.
  double take_peak(int lane);

 private:
  static constexpr std::size_t nowhere = std::numeric_limits<std::size_t>::max();
  struct Point {
    double given = 0;     // I of the instant under way
    double velocity = 0;  // over the sub-step before the last instant; of closed points
    // Of a circle, whose first point has all: I as a vector, outwards; the velocity of u₂ beside that of u₁; the
    // direction outwards at the last instant.
    std::array<double, 2> vector = {0, 0};
    double across = 0;
    std::array<double, 2> normal = {0, 0};
    double place = 0;   // absolute, before the last instant of steps that were left out
    double pushed = 0;  // I of the last instant
    double came = 0;    // speed towards the stop when it last closed
    int side = 0;       // at the last instant: −1 upper, 0 open, 1 lower
    int free = 0;       // sub-steps without an effort since it opened, while its speed out is open
    // Of its last impact; beyond the list where that is full, or where contact is that of the start.
    std::size_t row = nowhere;
  };
  struct Lane {
    Lane(int count_of_points, StartContact of_start)
        : closed(count_of_points), start(std::move(of_start)), points(static_cast<std::size_t>(count_of_points)) {}
    ClosedPoints closed;
    StartContact start;
    std::vector<Point> points;
    std::vector<int> leaving;  // points whose speed out is open
    std::vector<StopTotals> stops;
    std::vector<Impact> impacts;
    long long count = 0;
    double force = 0, peak = 0;
  };
  const Lane& lane_of(int lane) const { return lanes_[static_cast<std::size_t>(lane)]; }
  static StopTotals& stop(Lane& lane, int point, int side) {
    return lane.stops[2 * static_cast<std::size_t>(point) + (side > 0 ? 0U : 1U)];
  }
  void open_instant(const Marcher& marcher, const StageView& view);
  void move_to(const Marcher& marcher, const double* const* slots, double time);
  bool know(const double* const* slots, double time);
  void know_left_out(const Marcher& marcher, const StepInterval& steps);
  void press_left_out(const Marcher& marcher, const StepInterval& steps);
  long long next_shown(const Marcher& marcher) const;
  void moved(const Marcher& marcher, int lane);
  void leave(const Marcher& marcher, int lane, double lifted);
  double velocity(const Marcher& marcher, int lane, int point, double support) const;
  /// Of the place that a point stands for: along its row, of a circle outwards.
  double velocity_of(const Marcher& marcher, int lane, int point, double support) const;
  double lift(const Marcher& marcher, int lane) const;
  void close_instant(const Marcher& marcher, const StageView& view, int lane);
  bool begin(const Marcher& marcher, const StageView& view, int lane, int point, int side);
  void let_go(const Marcher& marcher, const StageView& view);
  static void move(Lane& lane, int point, double now, double across = 0);
  void move_to_place(Lane& lane, int point, double place, double time);
  bool press_sums(const StageProgram& stage, const StepInterval& steps);
  static void add(Lane& lane, const Point& one, const StopTotals& given, double force, StopTotals& totals);
  void press(Lane& lane, int point, double lasts, double time, bool closes);

  const MarchModel& model_;
  std::size_t most_;
  double h_;
  int T_;
  std::vector<Lane> lanes_;
  std::vector<ContactListener*> listeners_;
  int increment_slot_ = -1;               // holds what the positions moved by; −1: they are kept
  const double* increment_ = nullptr;     // that slot, before the stages of the instant under way
  std::vector<double> earlier_, latest_;  // positions before the instant before the one under way, and before that one
  double earlier_time_ = 0, latest_time_ = 0;
  int known_ = 0;             // how many of these there are
  std::uint32_t busy_ = 0;    // lanes with a point that is closed or whose speed out is open
  bool tells_slots_ = false;  // of steps that are left out
  bool left_ = false;         // whether steps in which closed points moved were left out since
  double left_at_ = 0;        // the time before the last instant of them
  double lasts_ = 0;          // Ω of the instant under way
};

}  // namespace ricochet
