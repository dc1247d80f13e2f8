#pragma once
#include <Eigen/Core>
#include <functional>
#include <memory>
#include <optional>
#include <ricochet/contract/reference.hpp>
#include <ricochet/measure/orbits/branch.hpp>
#include <ricochet/measure/orbits/periodic_map.hpp>

namespace ricochet {

/// P(x, λ) as steps of arclength need it. Not to be shared between threads.
class FollowedMap {
 public:
  virtual ~FollowedMap() = default;
  virtual int size() const = 0;
  virtual const StateMetric& metric() const = 0;

  /// What one march shows. `derivative` where it was asked for.
  struct Image {
    Eigen::VectorXd image;
    Eigen::MatrixXd derivative;
    LaneEnd end;
    int runs = 0, held = 0, shortest = 0;
    double rebounds = 0;  ///< u = h Σ|v⁺ − v⁻| over contacts that rebound, m
    double slowest = 0;   ///< least approach among these, m/s; 0: none rebounds
    double pace = 0;      ///< of contact points, rms speed over rms distance from their mean place, rad/s
    double placed = 0;    ///< u h pace: what is left of u where impacts are placed within their steps, m
    double tip = 0, tip_velocity = 0, penetration = 0;  ///< of the tip at t = 0 of the forcing
    Eigen::VectorXd strobe;                             ///< x at t = 0 of the forcing
    int quiet = 0;        ///< where x stands farthest from impacts (MapClock::begins); the clock's own if none is near
    bool untold = false;  ///< an impact had no jump
  };
  virtual Image march(const Eigen::VectorXd& x, double parameter, const MapClock& clock, bool derivative = false) = 0;
  /// The same motion as x, where another clock begins.
  virtual Eigen::VectorXd moved(const Eigen::VectorXd& x, double, const MapClock&, int) { return x; }
};

/// An orbit by a state that no impact is near. Where one passes the instant at which x stands, x jumps from orbit to
/// orbit and P' there is not the motion's.
struct QuietOrbit {
  Eigen::VectorXd x;
  MapClock clock;
};
QuietOrbit quiet_orbit(FollowedMap& map, const Eigen::VectorXd& x, double parameter, const MapClock& clock);
/// Marches with the derivative from there; where an impact is near, `at` is moved from it first.
FollowedMap::Image march_quiet(FollowedMap& map, QuietOrbit& at, double parameter);
/// On pieces x may stand anywhere.
inline QuietOrbit quiet_orbit(PeriodicMap&, const Eigen::VectorXd& x, double, const MapClock& clock) {
  return {x, clock};
}

/// Orbits that give back speed and are nearer than so many of their rebounds are not told apart.
inline constexpr double unresolved = 5;

/// P(x, λ) of programs that differ from value to value: steps, matrices, laws. The state x has the coordinates of one
/// of them; displacements and velocities of the others are carried there. Derivatives are those of tangent columns,
/// with the jumps of impacts with inertia (impact_jump.hpp). One lane.
class SteppedMap final : public FollowedMap {
 public:
  /// A program of one lane with so many tangents, and the group of its scene.
  struct Scene {
    Program program;
    int group = 0;
  };
  using Make = std::function<Scene(double parameter, int tangents)>;
  /// Columns of a derivative that one march carries.
  static constexpr int most_tangents = 31;
  using Carry = std::function<LaneState(const LaneState& state, int from, int to)>;

  /// `at`: the value whose coordinates x has. `rebounds`: whether stops give back speed to masses, or are met at whole
  /// steps; without, derivatives are those of the steps. Throws Refusal of a law that keeps a memory.
  SteppedMap(Make make, Carry carry, double at, const ArcUnits& units, bool rebounds = true);

  int size() const override { return vector_->size(); }
  const StateMetric& metric() const override { return *metric_; }
  const Program& reference() const { return *reference_; }

  Image march(const Eigen::VectorXd& x, double parameter, const MapClock& clock, bool derivative = false) override;
  Eigen::VectorXd moved(const Eigen::VectorXd& x, double parameter, const MapClock& clock, int begins) override;
  /// A marcher of this value with its lane at x, so many steps after the strobe, and so many tangents; the group of its
  /// scene.
  std::pair<Marcher, int> begin(const Eigen::VectorXd& x, double parameter, int tangents = 0, int begins = 0) const;
  /// A state of a program at this value, as x.
  Eigen::VectorXd read(const LaneState& state, int group) const;
  /// Whether stops are left out from here on.
  void without_stops(bool open) { open_ = open; }

 private:
  LaneState unit(int k) const;

  Make make_;
  Carry carry_;
  std::unique_ptr<Program> reference_;
  int group_ = 0;
  std::unique_ptr<StateVector> vector_;
  std::unique_ptr<StateMetric> metric_;
  LaneState template_;
  bool open_ = false, rebounds_;
};

/// P(x, λ) = x at a given λ by Newton's method. Converged where the residual is at most `tolerance`, or at most the
/// rebounds of the orbit where stops give back speed.
ShotOrbit shoot(FollowedMap& map, Eigen::VectorXd x, double parameter, const MapClock& clock, double tolerance,
                int most = 30);

/// The orbit without stops by Newton's method, exact at once; nothing where 1 is a multiplier of it.
std::optional<Eigen::VectorXd> free_orbit(SteppedMap& map, double parameter, const MapClock& clock);

/// What round-off makes of a period, m: as for a PeriodicMap, and at least that of tangent columns over as many steps.
double round_off_of_map(SteppedMap& map, const Eigen::VectorXd& x, double parameter, const MapClock& clock);

/// How a branch is followed by steps.
struct ArcSteps {
  BranchLimits branch;
  double tolerance = 1e-12;  ///< of residuals, m
  double first = 0;          ///< step, m
  double located = 1e-4;     ///< of the range: the step at which the count of multipliers outside may change
  /// Of a map without steps of time. Turns and contacts are placed to `located` too. A branch goes on where a contact
  /// that comes or goes turns it.
  bool smooth = false;
};

/// Follows a branch of P(x, λ) = x by steps of arclength. A secant predicts, Newton's method bordered by the secant
/// corrects. ∂P/∂λ is a difference over 1e-6 of the range. A step grows by a factor of 1.5 after at most four
/// iterations and shrinks by the same after more than seven. It is halved in these cases:
///   - No orbit is found.
///   - The branch turns by more than 45 degrees.
///   - The count of multipliers outside changes within more than `located` of the range.
///   - The bordered matrix changes the sign of its determinant: the step goes back along the branch.
/// Where an impact comes near the instant at which x stands, x goes to where none is near (QuietOrbit).
/// Below 1e-9 of the range's length the steps are at a corner of a piecewise smooth map. They go on along the null
/// direction beyond it, or the branch ends.
class StepFollower {
 public:
  StepFollower(FollowedMap& map, const MapClock& clock, Eigen::VectorXd x, double parameter, int way,
               const ArcSteps& limits);
  /// From where another one stopped.
  StepFollower(FollowedMap& map, const MapClock& clock, const BranchState& state, const ArcSteps& limits,
               BranchTrace trace);

  /// Makes up to so many steps; false where the branch has ended.
  bool advance(long long steps);
  const BranchTrace& trace() const { return trace_; }
  long long pieces() const { return static_cast<long long>(trace_.corners.size()); }
  /// The last orbit, the unit secant and the step.
  BranchState state() const;
  /// The orbit of the branch in the plane normal to the way from the last orbit to another one, so far along. Not found
  /// where Newton's method did not come to it.
  ShotOrbit towards(const Eigen::VectorXd& x, double parameter, double arc);

 private:
  static constexpr double smallest_step = 1e-9, largest_step = 0.05;  // of the range
  static constexpr double sharpest = 0.70710678118654752;             // cos 45°

  struct Point {
    Eigen::VectorXd x;
    double parameter = 0;
  };
  /// A step to an orbit, solved there.
  struct Step {
    Point to;
    FollowedMap::Image image = {};
    std::vector<std::complex<double>> multipliers = {};
    int iterations = 0;
    int turned = 0;      ///< sign of the determinant of the last bordered matrix; 0: none was needed
    bool jumps = false;  ///< over a contact that the map does not resolve
  };
  enum class Verdict { taken, crosses, failed };

  double range() const;  // m
  bool within(const Point& point) const;
  std::optional<FollowedMap::Image> image_of(const Point& point, bool derivative = false);
  std::optional<FollowedMap::Image> image_over(const Point& point, const MapClock& clock, bool derivative);
  int repeats_after(const Step& step);
  bool correct(Step& step, const Point& along);
  std::optional<Point> tangent(const Point& at, const Eigen::MatrixXd& derivative);
  bool set_tangent(int way, const Eigen::MatrixXd& derivative);
  Eigen::VectorXd by_parameter(const Point& point, double share);
  Eigen::MatrixXd bordered(const Eigen::MatrixXd& derivative, const Eigen::VectorXd& slope, const Point& along) const;
  double overlap(const Point& a, const Point& b) const;
  std::pair<Point, double> secant_to(const Point& point) const;
  Eigen::VectorXd asymmetry(const Point& point);

  std::optional<Step> next_orbit();
  Verdict judge(Step& step);
  bool goes_back(const Step& step) const;
  bool pass_graze(Step& step);
  bool turn_corner();
  bool reaches_end(const Point& beyond);
  std::string why_left(const Step& tried) const;
  void take(Step step);
  void stand(const Point& before, int begins);
  Eigen::VectorXd first_orbit() const;
  bool comes_back(const Point& secant, double far) const;
  void mark_up_to(const Point& next);
  void place_contact(const Step& beyond);
  void keep(Step step);

  FollowedMap* map_;
  MapClock clock_;
  ArcSteps limits_;
  Point now_, along_;  // the last orbit, the unit secant
  double step_ = 0;
  int orientation_ = 0;    // sign of det(1 − P') dλ/ds, which a branch keeps
  double corner_ = -1;     // arc of the last corner that was turned
  Eigen::VectorXd apart_;  // x − its image, where branches end at images
  Eigen::VectorXd first_;  // the first orbit, where x stands now
  std::string failure_;
  BranchTrace trace_;
};

/// P(x, λ) of a reference: without steps and mesh. Where the reference has no state the march throws its Refusal. Of a
/// clock the period and `half` count.
class ReferenceOrbits final : public FollowedMap {
 public:
  struct Scene {
    std::unique_ptr<ReferenceMap> map;
    double period = 0;  ///< of the forcing, s
  };
  /// Throws Refusal where the scene is refused at a value.
  using Make = std::function<Scene(double parameter)>;

  ReferenceOrbits(Make make, double at, double parameter_metres);

  int size() const override { return scene_.map->size(); }
  const StateMetric& metric() const override { return *metric_; }
  Image march(const Eigen::VectorXd& x, double parameter, const MapClock& clock, bool derivative = false) override;
  /// Displacement and velocity of the tip, as ReferenceMap has them.
  std::pair<double, double> tip(const Eigen::VectorXd& x, double parameter) { return at(parameter).map->tip(x); }
  /// The state after so many periods from the scene's initial state.
  Eigen::VectorXd settle(double parameter, int periods);

 private:
  Scene& at(double parameter);

  Make make_;
  Scene scene_;  // of the last value
  double value_;
  std::unique_ptr<StateMetric> metric_;
};

}  // namespace ricochet
