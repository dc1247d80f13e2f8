#pragma once
#include <Eigen/Core>
#include <complex>
#include <functional>
#include <memory>
#include <optional>
#include <ricochet/engine/marcher.hpp>
#include <ricochet/measure/orbits/set_steps.hpp>
#include <ricochet/measure/orbits/state_metric.hpp>
#include <string>
#include <vector>

/// \file
/// P(x, λ): what a program makes of a state in one forcing period, or in half of one with the sign changed. An orbit of
/// period p solves P^p(x, λ) = x; one that is its own image under x → −x, t → t + T/2 solves −P½(x, λ) = x.
namespace ricochet {

/// Lanes whose amplitude and stops are affine in λ.
struct AffineLane {
  LaneSpec origin;  ///< at λ = at
  double at = 0;
  double amplitude = 0;          ///< dA/dλ
  Eigen::VectorXd lower, upper;  ///< of the bounds
  LaneSpec lane(double parameter) const;
};
/// The affine lane through two, or nothing where phases or laws differ.
std::optional<AffineLane> affine_lane(const LaneSpec& first, double at_first, const LaneSpec& second, double at_second);
/// Whether it gives this one, to round-off.
bool passes_through(const AffineLane& affine, const LaneSpec& lane, double at);

/// Over which steps a map goes, on a clock that begins at t = 0.
struct MapClock {
  int steps_per_period = 0;
  int period = 1;     ///< p
  bool half = false;  ///< over p/2 periods, with the sign changed; p odd
  int begins = 0;     ///< steps after t = 0 of the forcing at which x stands (SteppedMap), within the period
  long long steps() const { return static_cast<long long>(period) * steps_per_period / (half ? 2 : 1); }
  double sign() const { return half ? -1.0 : 1.0; }
  bool operator==(const MapClock&) const = default;
};

/// The contact set of each step, by its number in SetSteps.
using SetSequence = std::vector<int>;

/// A step whose derivative is (1 − weight) times that of its set, and weight times that of another one, in which one
/// row has changed. A step may have several: their weights add up.
struct SetBlend {
  std::size_t step;
  int other;
  double weight;
  int row = 0;
};

/// What one march of the map shows.
struct MapMarch {
  Eigen::VectorXd image;             ///< sign · P
  SetSequence sets;                  ///< empty where the program has no steps by sets
  LaneEnd end;                       ///< none: the march went to its end
  double tip = 0, tip_velocity = 0;  ///< at the strobe, absolute; the velocity central over two steps
  double penetration = 0;            ///< m
};

/// Loads that are affine in λ: what makes a program at a value, and another value than that of the lanes' origin.
/// Without a program loads are the same at every value.
struct AffineLoad {
  std::function<Program(double parameter)> program;
  double other = 0;
};

/// The map by marching, and what its contact sets make of it. As long as the sets stay, its image is affine in (x, λ)
/// and its derivatives are constant. One lane; not to be shared between threads.
class PeriodicMap {
 public:
  /// `program` has one lane and no tangents. Throws Refusal where SetSteps refuses it.
  PeriodicMap(Program program, AffineLane lanes, const ArcUnits& units, AffineLoad load = {});

  PeriodicMap(const PeriodicMap&) = delete;

  int size() const { return sets_.state_size(); }
  const StateMetric& metric() const { return metric_; }
  SetSteps& sets() { return sets_; }
  const SetSteps& sets() const { return sets_; }
  const Program& program() const { return marcher_.program(); }
  const AffineLane& lanes() const { return lanes_; }
  const StateVector& vector() const { return vector_; }
  /// Of its steps (massless_roots()).
  const std::vector<std::complex<double>>& massless_roots() const { return massless_roots_; }

  /// The marcher of this value with its lane at x, at the strobe; until the map is asked again.
  Marcher& begin(const Eigen::VectorXd& x, double parameter);
  /// Marches from x. `read`: tip and penetration are wanted too.
  MapMarch march(const Eigen::VectorXd& x, double parameter, const MapClock& clock, bool read = false);
  /// ∂(sign·P)/∂x with these sets.
  Eigen::MatrixXd derivative(const SetSequence& sets, const MapClock& clock) { return product(sets, clock, {}); }
  /// The same with blends, in the order of steps, from that without. Steps that differ in one row differ by a matrix of
  /// rank one: as long as blends are few, vectors alone are carried over the steps.
  Eigen::MatrixXd blended(Eigen::MatrixXd derivative, const SetSequence& sets, const MapClock& clock,
                          const std::vector<SetBlend>& blends);

  /// One column that goes over the steps: of states (drives at λ) or of directions (drives per λ, times `parameter`).
  struct Column {
    Eigen::VectorXd x;
    double parameter = 0;  ///< λ, or dλ
    bool direction = false;
  };
  /// Rows of v over the steps, rows × steps.
  struct Measures {
    std::vector<double> value, slope;
  };
  /// Marches columns over given sets: their images, sign included. `measures`: v of the first column, and of the second
  /// as slope.
  void sweep(const SetSequence& sets, const MapClock& clock, std::vector<Column>& columns,
             Measures* measures = nullptr);
  /// The bounds that a row of v is held against, at λ or per λ; infinite where there is none.
  double bound(int row, bool upper, double parameter, bool direction) const;
  /// Displacement of the tip of a state at t = 0, absolute.
  double tip(const Eigen::VectorXd& x, double parameter) const;

 private:
  class Recorder;
  Eigen::MatrixXd product(const SetSequence& sets, const MapClock& clock, const std::vector<SetBlend>& blends);
  void carry(const SetSequence& sets, std::size_t from, std::size_t to, Eigen::MatrixXd& columns, bool transposed);
  struct Constant;
  Constant constant_drive(int set, std::size_t power, const Column& column);
  Marcher& marcher_at(double parameter);

  Marcher marcher_;
  AffineLane lanes_;
  SetSteps sets_;
  StateVector vector_;
  StateMetric metric_;
  std::vector<std::complex<double>> massless_roots_;
  LaneState template_;
  Eigen::RowVectorXd tip_;
  std::vector<double> sine_, cosine_;    // of ωt + ψ at the steps of a period
  Eigen::MatrixXd loads_, load_slopes_;  // stages n × steps of a period, at the origin and per λ; empty without load
  AffineLoad affine_load_;
  std::optional<Marcher> other_;  // with the loads of another value
  double other_at_ = 0;
  int clocked_ = 0;
  void set_period(int steps_per_period);
};

/// The tip where steps over a map begin, and its central velocity over two steps there, as the map's sign has it.
struct StrobeTip {
  double displacement = 0, velocity = 0;  ///< m, absolute; m/s
};
/// Marches lane 0 over the steps of a map, from a set clock.
StrobeTip march_over(Marcher& marcher, const MapClock& clock, const Observers& observers);

/// The state of a lane at a strobe, after so many periods from its own initial state under the start rule. Nothing
/// where it stopped; the cause is in `end`.
std::optional<LaneState> settle(Program program, int steps_per_period, int periods, LaneEnd& end);

/// A periodic orbit as far as Newton's method came.
struct ShotOrbit {
  bool found = false;
  Eigen::VectorXd x;
  double parameter = 0;
  SetSequence sets;  ///< of the last march
  int iterations = 0;
  double residual = 0;  ///< |P(x) − x|, m
  double nearest = 0;   ///< the least residual met, m
  LaneEnd end;          ///< of steps that stopped
  /// Of residuals that alternate: a step and a row of v in which the last two contact sets differ; −1: none.
  long long step = -1;
  int row = -1;
};

/// P(x, λ) = x by Newton's method with the derivative at the contact sets of each march: exact once the sets are those
/// of the orbit. Converged where the residual is at most `tolerance`, or the sets stay and it falls no more; at most
/// `most` iterations.
ShotOrbit shoot(PeriodicMap& map, Eigen::VectorXd x, double parameter, const MapClock& clock, double tolerance,
                int most = 30);

/// The fixed point with all points open, whatever the stops. Nothing where 1 is a multiplier of it.
std::optional<Eigen::VectorXd> free_orbit(PeriodicMap& map, double parameter, const MapClock& clock);

/// x with every number that is not 0 one unit in the last place larger.
Eigen::VectorXd one_unit_on(Eigen::VectorXd x);

/// What round-off makes of a period, m, one unit of round-off of x at least. It is the distance between the images of x
/// and of one_unit_on(x).
double round_off_of_map(PeriodicMap& map, const Eigen::VectorXd& x, double parameter, const MapClock& clock);

/// How many units of round-off count as none.
inline constexpr double round_offs = 30;
/// Above it a residual that falls no more is no round-off, m.
inline constexpr double largest_round_off = 1e-9;
/// Above it nothing is an orbit, however badly the map is rounded, and affine steps are not those that are marched, m.
inline constexpr double largest_residual = 1e-8;
/// How many tolerances a residual of steps may stay at where an iteration gains nothing: it is round-off.
inline constexpr double stalled = 100;

}  // namespace ricochet
