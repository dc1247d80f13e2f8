#pragma once
#include <array>
#include <cstddef>
#include <limits>
#include <vector>

namespace ricochet {

enum class StopSide { lower, upper };

/// One instant at which a contact point is pushed; what Ω, I and F are, impact_recorder.hpp says.
struct ContactInstant {
  int point = 0;
  StopSide side = StopSide::lower;
  double time = 0;      ///< of the effort, s
  double lasts = 0;     ///< Ω, s
  double given = 0;     ///< I, N s
  double force = 0;     ///< F, N
  bool closes = false;  ///< whether the point was open before; contact from the start was not
  double speed_in = 0;  ///< towards the stop when the point last closed, m/s
  /// Its row in the list of impacts; above any row where it has none.
  std::size_t impact = std::numeric_limits<std::size_t>::max();
  std::array<double, 2> normal = {0, 0};  ///< of a clearance, the direction in which it is met
};

/// Is told of the instants of lane 0, those of steps that were left out too, in order of time.
class ContactListener {
 public:
  virtual ~ContactListener() = default;
  virtual void instant(const ContactInstant& one) = 0;
  /// After those of one time, also of a time at which what was closed is not pushed.
  virtual void over(double /*time*/) {}
};

/// Which contact points are closed, and on which side, at the instant of contact under way and at the one before it.
/// Whoever counts contact counts by this: a point is closed at an instant at which some stage found an effort for it.
/// What it costs grows with the number of points that are closed, not with that of all. Allocates when constructed.
class ClosedPoints {
 public:
  explicit ClosedPoints(int points)
      : before_(static_cast<std::size_t>(points), 0), now_(static_cast<std::size_t>(points), 0) {
    listed_.reserve(static_cast<std::size_t>(points));
  }

  /// A stage of the instant found a non-zero effort; the side is that of the last stage that does.
  void press(int point, double effort) {
    const auto j = static_cast<std::size_t>(point);
    if (now_[j] == 0 && before_[j] == 0) listed_.push_back(point);
    now_[j] = effort > 0 ? 1 : -1;
  }

  /// Whether no point is closed now, nor was at the instant before.
  bool idle() const { return listed_.empty(); }

  /// `see`(point) for each point that was closed at the instant before; to be asked before any stage of the next one.
  template <class See>
  void each(See&& see) const {
    for (const int point : listed_) see(point);
  }

  /// What an instant is beside the one before it.
  struct Change {
    int active = 0;        ///< points closed now
    int closings = 0;      ///< of them, those that were open or closed on the other side
    bool changed = false;  ///< whether any point opened, closed or changed its side
    bool was_active = false;
  };
  /// Ends the instant: `see`(point, side before, side now) for each point that is closed or was. Sides are −1 (upper
  /// stop), 0 (open) and 1 (lower stop).
  template <class See>
  Change end_instant(See&& see) {
    Change change;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < listed_.size(); ++i) {
      const int point = listed_[i];
      const auto j = static_cast<std::size_t>(point);
      const int before = before_[j], now = now_[j];
      see(point, before, now);
      change.active += now != 0;
      change.closings += now != 0 && now != before;
      change.changed = change.changed || now != before;
      change.was_active = change.was_active || before != 0;
      before_[j] = now_[j];
      now_[j] = 0;
      if (now != 0) listed_[kept++] = point;
    }
    listed_.resize(kept);
    return change;
  }
  Change end_instant() {
    return end_instant([](int, int, int) {});
  }

 private:
  std::vector<signed char> before_, now_;
  std::vector<int> listed_;  // closed now or before
};

}  // namespace ricochet
