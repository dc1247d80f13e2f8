#pragma once
#include <algorithm>
#include <cstddef>
#include <memory>
#include <ricochet/engine/compile.hpp>
#include <ricochet/engine/flight/flight_bound.hpp>
#include <ricochet/engine/flight/flight_motion.hpp>

/// \file
/// The motion between two changes of contact, as uncoupled modes. With no point closed they are the modes of the
/// structure. A rigid law that reads positions may hold the points I at their stops. Then H_I x_j follows from the
/// stops alone. With ξ_j(e) what each slot has there once the transient of the scheme is over,
///
///     x_j = L ξ_j + Ψ η_j,     L = K⁻¹H_Iᵀ(H_I K⁻¹ H_Iᵀ)⁻¹,     H_I Ψ = 0,  ΨᵀKΨ = 1,  ΨᵀMΨ = diag (6)
///
/// (L is K-orthogonal to Ψ, so that only M couples them), and the efforts are p = Lᵀ(S z − b).
namespace ricochet {

/// A contact point closed at one of its stops.
struct ClosedPoint {
  int point = 0;  ///< row of H
  bool lower = true;
  bool operator==(const ClosedPoint&) const = default;
};

/// One point of a watch in each of `block` steps that begin one after the other, from the state before them alone. The
/// rows are h r, h r A, h r A², …; h is the point over the modes.
class StepReadings {
 public:
  static constexpr int block = 8;

  StepReadings(const StepRows& rows, const FlightWatch& watch, int point);

  /// `step` ≤ block steps after (x, e).
  double operator()(int step, const double* x, const double* e) const;
  /// Its weights over x and e in the step that begins now, slots × modes + drives.
  std::vector<double> row() const;
  /// It in each of the first `steps` ≤ block steps.
  void first(int steps, const double* x, const double* e, double* out) const { read(0, steps, x, e, out); }
  /// Its value in the step that begins now, and its first, second and third differences over those that follow. The
  /// rows are h r, h r D, h r D² and h r D³. What the values differ by is thus not lost in their sizes.
  void differences(const double* x, const double* e, double out[4]) const {
    read(differences_from, differences_read, x, e, out);
  }
  /// `see`(value) in each of `steps` steps from (x, e) on, which go on to where the last block ends.
  template <class See>
  void each(const FlightMotion& motion, long long steps, double* x, double* e, See&& see) const {
    for (long long first = 0; first < steps; first += block) {
      const int count = static_cast<int>(std::min<long long>(block, steps - first));
      double values[block];
      this->first(count, x, e, values);
      for (int step = 0; step < count; ++step) see(values[step]);
      motion.advance(block, x, e);
    }
  }

 private:
  static constexpr int differences_from = block + 1, differences_read = 4,
                       rows_read = differences_from + differences_read;

  void read(int first, int count, const double* x, const double* e, double* out) const;

  int size_, drives_;
  std::vector<double> weights_, drive_;  // of each step, then of each difference: slots × modes, drives
};

/// How many steps lie ahead in which every measure of a motion stays between its bounds. The bound of the motion alone
/// covers few steps where a point is near a bound or a fast mode is strong. It is then asked again from where it ends.
/// The few points that it leaves open are read as often as they could have reached their bound since. Just before they
/// do, they are read in every step. The first step in which one does ends it, up to round-off.
class ClearSteps {
 public:
  ClearSteps(const StepRows& rows, FlightBound& bound, const FlightMotion& motion)
      : rows_(rows), bound_(bound), motion_(motion) {}

  /// The largest k ≤ `most` for which they do in the steps that begin 0, 1, …, k steps after (x, e); −1: not in the
  /// first. `ask`: of how many steps to ask first, kept from one count to the next.
  long long count(const std::vector<double>& x, const double* e, long long most, long long& ask);
  /// How many times a point was read for the last count: what it cost beside steps that are marched, which measure all.
  long long read() const { return read_; }
  /// A point of a watch in each step.
  const StepReadings& readings(int watch, int point);

 private:
  // Points that are followed one by one.
  static constexpr std::size_t few = 6;
  struct Followed {
    const StepReadings* reading;
    FlightBound::Differences most;
    double lower, upper;
    long long clear = -1;  // the last step of which it is known to be
  };

  long long follow(long long steps);
  long long clear_steps(const Followed& one);
  bool inside(const Followed& one, int step);
  void advance(long long k);

  const StepRows& rows_;
  FlightBound& bound_;
  const FlightMotion& motion_;
  // Of each watch and point; made when first asked for.
  std::vector<std::vector<std::unique_ptr<StepReadings>>> readings_;
  std::vector<double> x_;
  double e_[3] = {};
  std::vector<WatchedPoint> exposed_;
  std::vector<Followed> followed_;
  long long read_ = 0;
};

class PushTables;

/// What may be asked of extremes of one measure at some points: it (watch 0) and its change to the next step (watch 1),
/// unbounded; and the same of every fourth step, where some mode alternates, else null.
struct ExtremeBounds {
  std::unique_ptr<FlightBound> each, by_four;
};

class FlightSet {
 public:
  /// `program` marches one lane in modal coordinates; its `lanes.front()` says where the stops are. `layer` (m): the
  /// law acts from so far before them. `twin`: one that holds the same points, on whatever side; their modes are one.
  FlightSet(const Program& program, double layer, std::vector<ClosedPoint> closed, int powers,
            const FlightSet* twin = nullptr);
  ~FlightSet();

  /// Why this motion cannot fly; empty where it can.
  const std::string& cause() const { return cause_; }
  const std::vector<ClosedPoint>& closed() const { return closed_; }

  /// Takes the stops of another lane, where none of them is closed.
  void place(const LaneSpec& lane, double layer);

  /// x of these modes from the slots (rows each), and back. False where the closed points are not where they come to
  /// rest, up to round-off: the transient is not over.
  bool enter(const double* const* slots, const double* e, std::vector<double>& x) const;
  void leave(const std::vector<double>& x, const double* e, double* const* slots) const;

  FlightBound& bound() { return *bound_; }
  /// The steps in which nothing of it is reached.
  ClearSteps& clear_steps() { return *clear_steps_; }
  const FlightMotion& motion() const { return *motion_; }
  const FlightWorks& works() const { return *works_; }
  /// Of the tip after the step; made when first asked for.
  const ExtremeBounds& tip();
  /// The tip after each step; made when first asked for.
  const StepReadings& tip_readings();
  /// The effort of a closed point in each step, N.
  const StepReadings& effort(std::size_t closed) {
    return clear_steps_->readings(effort_watch_, static_cast<int>(closed));
  }
  /// Of the efforts of closed points; made when first asked for.
  const ExtremeBounds& effort_extremes();
  /// Sums of efforts of each closed point over `steps` steps, once so many have been asked for that tables pay; before,
  /// or where they would be large, null.
  std::vector<PushTables>* push_tables(long long steps);
  int modes() const { return modes_; }
  /// Of one step.
  const StepRows& step_rows() const { return *step_rows_; }

 private:
  /// Loads and the like in these modes, and rows of points.
  Eigen::MatrixXd project(const Eigen::MatrixXd& all) const;
  Eigen::MatrixXd onto(const Eigen::MatrixXd& points) const;
  void close(const Program& program, const FlightSet* twin);
  bool rest(const Program& program);
  Eigen::RowVectorXd unknown_at_rest(const Stage& plan, const Eigen::MatrixXd& steady) const;
  void set_bounds(FlightWatch& watch, const LaneSpec& lane, double layer) const;
  Eigen::VectorXd masses(const Program& program) const;
  /// Σ_i L_i r_i, rows × drives.
  Eigen::MatrixXd lift_by(const std::vector<Eigen::RowVectorXd>& rests) const;
  Eigen::MatrixXd lift_of(const Combination& c, const Eigen::MatrixXd& lifted) const;
  Eigen::MatrixXd residual_of_lift(double z, const std::vector<double>& history, const Eigen::MatrixXd& lifted) const;
  std::vector<FlightStage> flight_stages(const Program& program, const Eigen::MatrixXd& inertia) const;
  FlightWatch end_watch(const Program& program, const Eigen::MatrixXd& points) const;
  std::vector<FlightWatch> contact_watches(const Program& program, double layer, const Eigen::MatrixXd& lifted) const;
  FlightWatch effort_watch(const Program& program, const Eigen::MatrixXd& inertia, const Eigen::MatrixXd& lifted) const;
  ExtremeBounds extremes_of(const FlightWatch& value) const;
  FlightWorks::Forms forms(const Program& program, const StepRows& rows, const Eigen::VectorXd& mass,
                           const Eigen::MatrixXd& lifted);

  std::vector<ClosedPoint> closed_;
  std::vector<int> circles_;  // first rows of clearances met as circles
  int rows_ = 0, modes_ = 0, slots_ = 0;
  FlightDrive drive_;
  std::string cause_;
  std::vector<double> metres_;   // what a slot has to be multiplied by to be a length
  Eigen::VectorXd own_mass_;     // M of the structure's modes
  Eigen::VectorXd closed_mass_;  // ΨᵀMΨ
  Eigen::MatrixXd basis_;        // Ψ; empty: the modes of the structure
  Eigen::MatrixXd basis_rows_;   // Ψᵀ
  Eigen::MatrixXd settle_;       // ΨᵀR, R = S⁻¹H_Iᵀ(H_I S⁻¹H_Iᵀ)⁻¹
  mutable Eigen::MatrixXd apart_;
  Eigen::MatrixXd lever_;                         // L, rows × closed
  std::vector<Eigen::MatrixXd> rest_;             // of each closed point: ξ over e, slots × drives
  std::vector<Eigen::RowVectorXd> rest_unknown_;  // and H z
  std::vector<Eigen::MatrixXd> lift_;             // of each slot: Σ_i L_i ξ_i, rows × drives
  Eigen::MatrixXd closed_rows_;                   // H_I
  std::unique_ptr<const StepRows> step_rows_;
  FlightWatch tip_watch_;
  std::unique_ptr<FlightBound> bound_;
  ExtremeBounds tip_, effort_extremes_;
  std::vector<PushTables> push_tables_;
  long long pushed_steps_ = 0;  // that push_tables() was asked of
  std::unique_ptr<FlightMotion> motion_;
  std::unique_ptr<ClearSteps> clear_steps_;
  std::unique_ptr<FlightWorks> works_;
  std::unique_ptr<StepReadings> tip_readings_;
  int effort_watch_ = -1;
};

/// Powers of two steps that tables of an integration of so many steps hold.
int flight_powers(long long steps);
/// Bytes of the tables of one set of closed points, over so many modes and slots.
double flight_set_bytes(int modes, int slots, int powers);
/// Sets of closed points that are remembered: as many as a quarter of a gigabyte holds, 64 at most.
std::size_t most_flight_sets(double set_bytes);
/// Bytes that leaving out steps may take in all; `points`: contact points, 0: none.
double flight_bytes(int modes, int slots, int points, long long steps);

}  // namespace ricochet
