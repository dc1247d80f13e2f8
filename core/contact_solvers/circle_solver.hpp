#pragma once
#include <array>
#include <memory>
#include <ricochet/contract/contact_law.hpp>
#include <span>
#include <vector>

namespace ricochet {

/// A circle as two contact points bear it: bounds c ∓ r of the rows of u₁ and u₂.
struct StopCircle {
  std::array<double, 2> centre = {0, 0};  ///< c, m
  double radius = 0;                      ///< r, m
  /// Of the bounds of its rows, `first` and the next.
  template <class Bounds>
  static StopCircle of(const Bounds& lower, const Bounds& upper, int first) {
    return {{0.5 * (lower[first] + upper[first]), 0.5 * (lower[first + 1] + upper[first + 1])},
            0.5 * (upper[first] - lower[first])};
  }
  double distance(double u1, double u2) const;  ///< |u − c|
  /// How fast a place with a velocity goes outwards, m/s; 0 at the centre.
  double outwards(double u1, double u2, double v1, double v2) const;
  /// The bounds of a square within it: a point between them is within the circle.
  std::array<double, 2> square(int axis) const;
};

/// `put`(point, low, high) of the two bounds of a square within a circle that a layer (m) makes smaller: a point
/// between them is not within the layer.
template <class Bounds, class Put>
void put_square(const Bounds& lower, const Bounds& upper, int first, double layer, Put&& put) {
  StopCircle circle = StopCircle::of(lower, upper, first);
  circle.radius -= layer;
  for (const int axis : {0, 1}) {
    const std::array<double, 2> bounds = circle.square(axis);
    put(first + axis, bounds[0], bounds[1]);
  }
}

/// Contact laws of one scalar depth at points that move within circles. Such a point has two rows, u₁ and u₂, and two
/// efforts. It is pushed along its radius by what the law finds for the radial depth and rate:
///
///     u = u° + ηWp,   ρ = |u − c|,   n = (u − c)/ρ,   p = −N n,   N = N(ρ − r, n·u̇)                                (1)
///
/// Where the law reads the displacement before the step, u⁻, the direction is that of the discrete gradient of ρ:
/// n = (u + u⁻ − 2c)/(ρ + ρ⁻), with which p·(u − u⁻) = −N (ρ − ρ⁻) whatever the step (Gonzalez 1996).
///
/// In a frame (n, t) the law sees an ordinary point with the upper bound r, and a row without bounds. Along t the force
/// (1) answers by −λ t·δu, λ = N/ρ, or N/(ρ + ρ⁻). With that spring condensed, Newton's method goes from frame to frame
/// until none turns; the law solves its own part exactly each time. An elastic (1) is the optimality of a convex
/// problem for a force that does not soften: it has one solution.
///
/// Cost: a solve of the law for each frame (two to five), and columns of W at points that push. A measure that no
/// effort moves (η = 0) takes one.
class CircleSolver {
 public:
  /// `circles`: the first rows of circles among `points`; `memory`: ContactLaw::memory_per_point(). solve() allocates
  /// nothing after this.
  void prepare(int points, int lanes, std::vector<int> circles, int memory);
  bool any() const { return !circles_.empty(); }
  const std::vector<int>& circles() const { return circles_; }
  /// Whether a point is one of those of a circle, and then its first.
  bool holds(int point) const { return any() && circle_of_[static_cast<std::size_t>(point)] >= 0; }
  bool first(int point) const {
    return circles_[static_cast<std::size_t>(circle_of_[static_cast<std::size_t>(point)])] == point;
  }
  /// The law on a problem whose rows of circles have the bounds c ∓ r. The effort of a circle is a vector then, and the
  /// outcome's residual holds what is left of (1), in units of the measure.
  void solve(ContactLaw& law, ReducedProblem& problem);

 private:
  struct Frame {
    StopCircle circle;
    std::array<double, 2> n{}, t{};
    double shift = 0;     // ρ − n·(u − c)
    double across = 0;    // λ
    double distance = 0;  // ρ + ρ⁻, or ρ
    double before = 0;    // ρ⁻
  };
  // W in the frames, springs along t condensed.
  class Turned final : public DelassusColumns {
   public:
    explicit Turned(CircleSolver& solver) : solver_(solver) {}
    const double* column(int j) override;

   private:
    CircleSolver& solver_;
  };
  friend class Turned;

  // How far frames turn: as an angle, beyond round-off, along the circle (m).
  struct Turn {
    double angle = 0, beyond = 0, way = 0;
  };

  void solve_lane(ContactLaw& law, ReducedProblem& problem);
  void turn(std::size_t circle, const std::array<double, 2>& place);
  Turn turn_on(double share);
  void condense();
  void solve_springs(double* x) const;
  void put_frames();
  void call(ContactLaw& law, ReducedProblem& problem);
  void move();
  const double* turned_column(int j, double* to);

  int points_ = 0, lanes_ = 0, kept_ = 0;
  std::vector<int> circles_, circle_of_;  // first rows; of each row the number of its circle, −1: none
  std::vector<Frame> frames_;
  std::vector<double> free_, lower_, upper_, rate_, before_, effort_;  // points × lanes, in the frames
  std::vector<double> memory_;                                         // of the lane, as it came
  std::vector<std::array<double, 2>> place_, next_;                    // u of each circle: of its frame, as moved
  std::vector<double> push_;                                           // p, points
  std::unique_ptr<double[]> columns_;                                  // W in the frames, points × points
  std::vector<unsigned char> known_;
  std::vector<int> springs_;            // circles with λ > 0
  std::vector<double> across_, share_;  // columns of their rows t; L and D of what they answer by
  std::vector<double> give_, held_;     // their efforts; way to u° along t
  std::vector<double> radial_, found_;  // of each circle the law's effort, and as a vector
  LaneProblem lane_;
  std::size_t number_ = 0;  // of the lane
  bool means_ = false;      // whether the law reads what was before
};

/// `see`(point, side, depth) of each side of each place, m beyond its stop; of a circle its first point, side −1 and
/// the radial depth.
template <class Bounds, class See>
void each_side(const CircleSolver& circles, const Bounds& lower, const Bounds& upper, const double* places, See&& see) {
  const auto points = static_cast<int>(lower.size());
  for (int point = 0; point < points; ++point) {
    if (!circles.holds(point)) {
      see(point, 1, lower[point] - places[point]);
      see(point, -1, places[point] - upper[point]);
    } else if (circles.first(point)) {
      const StopCircle circle = StopCircle::of(lower, upper, point);
      see(point, -1, circle.distance(places[point], places[point + 1]) - circle.radius);
    }
  }
}

}  // namespace ricochet
