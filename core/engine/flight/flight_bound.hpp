#pragma once
#include <limits>
#include <ricochet/engine/flight/flight_motion.hpp>
#include <string>
#include <vector>

/// \file
/// How far a linear motion can get in k steps. With A = I + D = V Λ V⁻¹ of a mode, all |λ| ≤ 1, and a row r of its
/// slots, every later value and every later second difference obeys
///
///     |r Aⁱ x| ≤ a = Σ_l |r V|_l |V⁻¹ x|_l,     |r Aⁱ (A − I)² x| ≤ z = Σ_l |λ_l − 1|² |r V|_l |V⁻¹ x|_l (3)
///
/// a steady motion under the drive taken off first, and given its own amplitude and its own second difference. (A
/// double root λ of two slots has Aⁱ = λⁱ(1 + i N), N² = 0: a then grows by |r N x| a step, and z with it.) A point h
/// of the modes then stands after i ≤ k steps within
///
///     Σ_j h_j (c_j + i d_j) ± Σ_j |h_j| min(½ i (i−1) z_j, a_j),     c_j = r x_j, d_j = r D x_j (4)
///
/// without c_j + i d_j for the modes whose amplitude says more. The bounds are concave and convex in i: what holds at 0
/// and at k holds between.
namespace ricochet {

/// A linear measure of the motion at several points, and between what it has to stay: strictly.
struct FlightWatch {
  int stage = 0;            ///< before which it stands (StepRows::of)
  Combination value;        ///< of each mode
  bool difference = false;  ///< its change from this step to the next instead
  Eigen::MatrixXd rows;     ///< points × modes
  Eigen::MatrixXd drive;    ///< points × drives: what e adds
  std::vector<double> lower, upper;
  /// What these bounds are: the stops, the stops less the layer from which the law acts, or the watch's own.
  enum class Bounds { own, stops, layer } bounds = Bounds::own;
};

/// One point of one watch.
struct WatchedPoint {
  int watch = 0, point = 0;
};

/// The bound of some measures. Allocates when constructed.
class FlightBound {
 public:
  /// A step of the bound is 2^power of the motion's: what alternates from step to step may then stand still.
  FlightBound(const StepRows& rows, std::vector<FlightWatch> watches, int power = 0);

  /// Why nothing bounds this motion: a mode that grows, roots that coincide; empty where (3) does.
  const std::string& cause() const { return cause_; }
  /// Whether some mode repeats itself after four steps, and not after one.
  bool alternates() const { return alternates_; }

  /// Sets the state; `x`: slots × modes, `e`: drives.
  void set_state(const double* x, const double* e);
  /// Steps over which (3) and (4) are known to hold.
  long long longest() const { return longest_; }
  /// Whether every measure stays strictly between its bounds at this step and the k that follow it.
  bool holds(long long k);
  /// The points of which that is not known, k ≤ longest(); false where they are more than `most`.
  bool find_exposed(long long k, std::vector<WatchedPoint>& exposed, std::size_t most);

  /// A point of a watch over the modes.
  const double* row(int watch, int point) const {
    return watches_[static_cast<std::size_t>(watch)].points.data() +
           static_cast<std::size_t>(point) * static_cast<std::size_t>(modes_);
  }
  FlightWatch& watch(int i) { return watches_[static_cast<std::size_t>(i)].watch; }
  int watches() const { return static_cast<int>(watches_.size()); }

  /// Where one point of one measure, from the state set last, may be within k steps; what it has for round-off.
  struct Range {
    double low = 0, high = 0, margin = 0;
  };
  Range range(int watch, int point, long long k);
  /// What a point can do from that state on, forever: the largest of its first, second, third and fourth differences
  /// from step to step. Its values have `margin` for round-off.
  struct Differences {
    double first = 0, second = 0, third = 0, fourth = 0, margin = 0;
  };
  Differences differences(int watch, int point);
  /// Its value in the state itself.
  double value(int watch, int point);
  /// Values of all points of one measure in another state.
  void values(int watch, const double* x, const double* e, double* out);

 private:
  struct Watched {
    FlightWatch watch;
    std::vector<double> points;                        // rows, one after the other
    std::vector<double> columns, sizes;                // the same by modes; and the size of each number of `points`
    std::vector<double> widest;                        // of each mode, the largest size in any of them
    std::vector<double> value, change;                 // rows of a mode, width × modes
    std::vector<std::vector<double>> real, imaginary;  // of the eigenvectors' shares, width × modes each
    std::vector<std::vector<double>> weight;           // |λ − 1|², modes
    std::vector<double> doubled;                       // |λ − 1|² of a double root, modes; else 0
    std::vector<double> swiftest;                      // the largest |λ − 1| in it, modes
    std::vector<double> grows;                         // r N of a double root, width × modes; empty: there is none
    std::vector<double> steady_amplitude, steady_bend,
        rest;  // under a drive of amplitude 1, and under the constant one
    // Of the state set last:
    std::vector<double> now, step, amplitude, bend, growth;
    std::vector<double> offset, offset_step, offset_bend;  // of the points, by e
    std::vector<double> differences;                       // of each mode, what Differences adds up, five arrays
    bool differences_known = false;                        // whether they are of this state
    std::size_t tightest = 0;
  };
  void place(Watched& watched, long long k);
  void split(const Watched& watched);
  bool inside(Watched& watched, std::size_t point, long long k);
  Range cone(const Watched& watched, std::size_t point, double k, int first, int count, double more);
  Range around(const Watched& watched, std::size_t point, double k, const double* sums, std::size_t stride,
               double more) const;
  template <class See>
  bool see_exposed(Watched& watched, long long k, See&& see);
  struct ModeRoots;
  ModeRoots roots(const StepRows& rows, int mode);
  bool double_root(const Eigen::MatrixXd& D, ModeRoots& found);
  void steady(const Eigen::MatrixXd& scaled, const Eigen::VectorXd& scale, ModeRoots& found);
  void shares(const StepRows& rows, int mode, const ModeRoots& found, Watched& watched);

  Eigen::MatrixXd step_change(const StepRows& rows, int mode) const;

  int modes_, slots_, drives_, power_;
  FlightDrive drive_;
  Eigen::MatrixXd turn_;  // R of one step
  std::vector<Watched> watches_;
  std::vector<double> places_, reached_, real_, imaginary_, grown_amplitude_, grown_bend_;
  long long placed_ = -1;
  long long longest_ = std::numeric_limits<long long>::max();  // for which the bound holds
  const Watched* placed_of_ = nullptr;
  // Of the cone that is placed: modes that are followed, −1: not known; what the others add at most.
  int slow_from_ = -1, slow_to_ = 0;
  double fast_radius_ = 0;
  bool alternates_ = false;
  std::string cause_;
};

}  // namespace ricochet
