#pragma once
#include <ricochet/engine/marcher.hpp>
#include <vector>

namespace ricochet {

/// Contact that is there from the start. A point is held by its stop at t = 0 where it lies beyond the place from which
/// the law acts, or on it without moving into it (its speed towards the stop is at most round-off), and for as long as
/// it has not left it. What closes there meanwhile is no impact: nothing has hit anything. A point that lies on its
/// stop and moves into it is not held: it hits at t = 0.
///
/// A march whose clock has left t = 0 has no start. Allocates when constructed.
class StartContact {
 public:
  StartContact(const Marcher& marcher, int lane);

  /// Whether any point is held still.
  bool any() const { return !held_.empty(); }
  /// Lets go of points that have left their stop: the slots before a stage, which begins at time t.
  void look(const Marcher& marcher, const double* const* slots, double t);
  /// Whether the stop of that side (1 lower, −1 upper) holds the point.
  bool holds(int point, int side) const;
  /// A point closes on that side: whether it was held there. From now on it is as any other.
  bool take(int point, int side);

 private:
  struct Held {
    int point = 0, side = 0;
  };
  /// How far a point is from the place where the law begins to act, m (< 0 beyond), and what of it is round-off.
  struct Gap {
    double value = 0, round_off = 0;
  };
  Gap gap(const LaneSpec& spec, const Held& held, double place) const;

  int lane_ = 0;
  double layer_ = 0;
  std::vector<Held> held_;
};

}  // namespace ricochet
