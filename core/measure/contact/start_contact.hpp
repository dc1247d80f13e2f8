#pragma once
#include <ricochet/engine/marcher.hpp>
#include <vector>

namespace ricochet {

/// Contact that is there from the start. A point is held by its stop at t = 0 where it lies beyond the place from which
/// the law acts. It is held as well where it lies on it and its speed towards the stop is at most round-off. It is held
/// until it leaves. What closes there meanwhile is no impact. A point that lies on its
/// stop and moves into it is not held: it hits at t = 0.
///
/// An integration whose clock has left t = 0 has no start. Allocates when constructed.
class StartContact {
 public:
  StartContact(const Marcher& marcher, int lane);

  /// Whether any point is held still.
  bool any() const { return !held_.empty(); }
  /// How far points are from their stop; lets go of those that are well away. The slots before a stage, which begins at
  /// time t.
  void read(const Marcher& marcher, const double* const* slots, double t);
  /// Whether the stop of that side (1 lower, −1 upper) holds the point.
  bool holds(int point, int side) const;
  /// A point closes on that side: whether it is held there. One that is not is from now on as any other.
  bool take(int point, int side);

 private:
  struct Held {
    int point = 0, side = 0;
    bool circle = false;
    double place = 0;      // when last read, m
    double away = 0;       // farthest from its stop, m
    double moved = 0;      // most between two readings, m
    double round_off = 0;  // of its place, m
    bool left() const;
  };
  /// How far a point is from the place where the law begins to act, m (< 0 beyond), and what of it is round-off.
  struct Gap {
    double value = 0, round_off = 0;
  };
  Gap gap(const LaneSpec& spec, const Held& held, double place) const;
  /// What the stop of a point bounds where its row reads `row`(point): the distance from the centre of a circle.
  template <class Row>
  static double place_of(const SemiDiscrete& problem, const LaneSpec& spec, int point, Row&& row) {
    if (problem.circle_axis(point) != 0) return row(point);
    return StopCircle::of(spec.lower, spec.upper, point).distance(row(point), row(point + 1));
  }

  int lane_ = 0;
  std::vector<double> layers_;  // of each point
  std::vector<Held> held_;
};

}  // namespace ricochet
