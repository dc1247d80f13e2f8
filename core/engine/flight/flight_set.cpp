#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <ricochet/contact_solvers/circle_solver.hpp>
#include <ricochet/engine/flight/flight_motion.hpp>
#include <ricochet/engine/flight/flight_set.hpp>
#include <ricochet/engine/flight/push_tables.hpp>
#include <ricochet/kernels/dense_solvers.hpp>
#include <ricochet/kernels/eigenvalues.hpp>
#include <ricochet/kernels/flight_kernels.hpp>
#include <ricochet/kernels/floating_point.hpp>

namespace ricochet {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::RowVectorXd;
using Eigen::VectorXd;

// Of positions: what round-off leaves of a transient that is over.
constexpr double over = 64 * 0x1p-52;

// Whether two watches of the same points watch the same.
bool same(const StepRows& rows, const FlightWatch& a, const FlightWatch& b) {
  constexpr double round_off = 1e-12;
  if (!(a.drive - b.drive).isZero(round_off * (a.drive.norm() + b.drive.norm()))) return false;
  for (int mode = 0; mode < rows.modes(); ++mode) {
    const RowVectorXd one = rows.of(mode, a.stage, a.value), other = rows.of(mode, b.stage, b.value);
    if (!(one - other).isZero(round_off * (one.norm() + other.norm()))) return false;
  }
  return true;
}

}  // namespace

// H z of slots that go on as ξ: from the update in which the least is lost by differences. What the measure leaves for
// it would be the second difference of a position, at round-off of the position itself.
RowVectorXd FlightSet::unknown_at_rest(const Stage& plan, const MatrixXd& steady) const {
  const MatrixXd change = steady * drive_.change(1);
  RowVectorXd best = RowVectorXd::Zero(drive_.count());
  double least_lost = infinity;
  for (int j = 0; j < slots_; ++j) {
    const Combination& update = plan.update[static_cast<std::size_t>(j)];
    if (update.z == 0) continue;
    RowVectorXd row = change.row(j), size = row.cwiseAbs();
    for (int i = 0; i < slots_; ++i) {
      const double weight = weight_at(update.slots, i) - (i == j ? 1.0 : 0.0);
      row -= weight * steady.row(i);
      size += (weight * steady.row(i)).cwiseAbs();
    }
    if (const double lost = size.sum() / std::abs(update.z); lost < least_lost) {
      least_lost = lost;
      best = row / update.z;
    }
  }
  return best;
}

// ξ of the closed points: the scheme's own steady answer to stops that move with the clamp.
bool FlightSet::rest(const Program& program) {
  const Stage& plan = program.plan.stages.front();
  const StageProgram& stage = program.stages.front();
  // A displacement of a step is a small difference of positions. With the digits of doubles alone, what they lose would
  // be a velocity of round-off over h. Every flight would meet it again.
  using Real = long double;
  using Complex = std::complex<Real>;
  const Real push = stage.measure.z;
  Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic> closed(slots_, slots_);
  Eigen::Matrix<Real, Eigen::Dynamic, 1> moves(slots_);
  for (int j = 0; j < slots_; ++j) {
    const Combination& update = plan.update[static_cast<std::size_t>(j)];
    moves[j] = update.z;
    for (int i = 0; i < slots_; ++i)
      closed(j, i) = weight_at(update.slots, i) - update.z * weight_at(stage.measure.slots, i) / push;
  }
  const auto identity = decltype(closed)::Identity(slots_, slots_);
  const RowVectorXd carried = harmonic(stage.measure_phase, drive_);
  for (const ClosedPoint& point : closed_) {
    const LaneSpec& lane = program.lanes.front();
    RowVectorXd bound = -carried;
    bound[drive_.one()] += point.lower ? lane.lower[point.point] : lane.upper[point.point];
    MatrixXd steady = MatrixXd::Zero(slots_, drive_.count());
    if (drive_.harmonic()) {
      const Real angle = drive_.angle;
      const Complex turned(std::cos(angle), std::sin(angle));
      const Eigen::Matrix<Complex, Eigen::Dynamic, Eigen::Dynamic> shifted =
          turned * identity.cast<Complex>() - closed.cast<Complex>();
      const Eigen::Matrix<Complex, Eigen::Dynamic, 1> phasor =
          shifted.fullPivLu().solve((Complex(bound[1], -bound[0]) / push) * moves.cast<Complex>());
      steady.col(0) = -phasor.imag().cast<double>();
      steady.col(1) = phasor.real().cast<double>();
    }
    const int one = drive_.one();
    steady.col(one) = (identity - closed).fullPivLu().solve(moves * (bound[one] / push)).cast<double>();
    if (!steady.allFinite()) return false;
    rest_unknown_.push_back(unknown_at_rest(plan, steady));
    rest_.push_back(std::move(steady));
  }
  return true;
}

MatrixXd FlightSet::project(const MatrixXd& all) const {
  return closed_.empty() ? all : MatrixXd(basis_.transpose() * all);
}
MatrixXd FlightSet::onto(const MatrixXd& points) const {
  return closed_.empty() ? points : MatrixXd(points * basis_);
}

void FlightSet::close(const Program& program, const FlightSet* twin) {
  apart_.resize(static_cast<Index>(closed_.size()), slots_);
  if (twin) {
    closed_rows_ = twin->closed_rows_;
    closed_mass_ = twin->closed_mass_;
    basis_ = twin->basis_;
    basis_rows_ = twin->basis_rows_;
    settle_ = twin->settle_;
    lever_ = twin->lever_;
    return;
  }
  const MatrixXd H = program.model->contact().dense(rows_);
  closed_rows_.resize(static_cast<Index>(closed_.size()), rows_);
  for (std::size_t i = 0; i < closed_.size(); ++i) closed_rows_.row(static_cast<Index>(i)) = H.row(closed_[i].point);
  // K = 1 in these coordinates.
  ConstrainedModes modes = constrained_modes(own_mass_, closed_rows_);
  basis_ = std::move(modes.basis);
  closed_mass_ = std::move(modes.mass);
  basis_rows_ = basis_.transpose();
  // Along these columns a step itself moves what is closed. What round-off leaves there is taken off without work; a
  // static lever would move the whole structure by it.
  const FoldedStage& folded = program.stages.front().folded;
  const MatrixXd response =
      (folded.mass * own_mass_.array() + folded.stiffness).inverse().matrix().asDiagonal() * closed_rows_.transpose();
  const MatrixXd one = MatrixXd::Identity(closed_rows_.rows(), closed_rows_.rows());
  settle_ = basis_.transpose() * response * definite_solve(closed_rows_ * response, one);
  lever_ = closed_rows_.transpose() * definite_solve(closed_rows_ * closed_rows_.transpose(), one);
}

// Of the modes that fly.
VectorXd FlightSet::masses(const Program& program) const {
  if (closed_.empty()) return own_mass_;
  VectorXd mass = closed_mass_;
  // What holds of the structure's own massless modes holds of these.
  const double most = mass.maxCoeff(), nothing = 1e-14;
  const auto massless = static_cast<Index>(program.model->inertia().kernel_dimension) - closed_rows_.rows();
  for (Index k = 0; k < massless; ++k)
    if (mass[k] <= nothing * most) mass[k] = 0;
  return mass;
}

MatrixXd FlightSet::lift_by(const std::vector<RowVectorXd>& rests) const {
  MatrixXd lift = MatrixXd::Zero(rows_, drive_.count());
  for (std::size_t i = 0; i < closed_.size(); ++i) lift += lever_.col(static_cast<Index>(i)) * rests[i];
  return lift;
}

std::vector<FlightStage> FlightSet::flight_stages(const Program& program, const MatrixXd& inertia) const {
  std::vector<FlightStage> stages;
  for (std::size_t k = 0; k < program.stages.size(); ++k)
    stages.push_back({program.stages[k].folded, program.plan.stages[k].update,
                      load_over_drive(program, program.plan.stages[k].load, drive_)});
  if (!closed_.empty()) stages.front().force = project(stages.front().force - inertia);
  return stages;
}

// z L − Σ_j history_j L_j: what one operator of a stage leaves of the lift.
MatrixXd FlightSet::residual_of_lift(double z, const std::vector<double>& history, const MatrixXd& lifted) const {
  MatrixXd sum = z * lifted;
  for (int j = 0; j < slots_; ++j) sum -= weight_at(history, j) * lift_[static_cast<std::size_t>(j)];
  return sum;
}

// The position after the step. It is watched whatever the law reads: a point beyond its stop is something to be told.
FlightWatch FlightSet::end_watch(const Program& program, const MatrixXd& points) const {
  FlightWatch end;
  end.stage = static_cast<int>(program.stages.size());
  end.value.slots.assign(static_cast<std::size_t>(slots_), 0.0);
  end.value.slots[0] = 1;
  end.rows = onto(points);
  end.drive = (points * (lift_[0] + lift_[0] * drive_.change(1))).rowwise() +
              harmonic(PhaseWeights({{1, 1}}, program.problem->support.pulsation, program.h), drive_);
  return end;
}

std::vector<FlightWatch> FlightSet::contact_watches(const Program& program, double layer,
                                                    const MatrixXd& lifted) const {
  std::vector<FlightWatch> watches;
  if (!program.contact) return watches;
  const LaneSpec& lane = program.lanes.front();
  const MatrixXd measured = program.model->measured().dense(rows_), contact = program.model->contact().dense(rows_);
  const auto reads = [&](int stage, const Combination& value, const PhaseWeights& phase) {
    FlightWatch watch;
    watch.stage = stage;
    watch.value = value;
    watch.rows = onto(measured);
    watch.drive = (measured * lift_of(value, lifted)).rowwise() + harmonic(phase, drive_);
    watch.bounds = FlightWatch::Bounds::layer;
    set_bounds(watch, lane, layer);
    watches.push_back(std::move(watch));
  };
  for (int k = 0; k < static_cast<int>(program.stages.size()); ++k) {
    const StageProgram& stage = program.stages[static_cast<std::size_t>(k)];
    // Work is given back where some was taken, and nowhere else.
    if (!stage.reads_contact || stage.restores > 0) continue;
    if (stage.gate) {
      reads(k, stage.gate->predictor, stage.predictor_phase);
      continue;
    }
    reads(k, stage.measure, stage.measure_phase);
    if (stage.compliance && stage.compliance->before) reads(k, *stage.compliance->before, stage.before_phase);
  }
  FlightWatch end = end_watch(program, contact);
  end.bounds = FlightWatch::Bounds::stops;
  set_bounds(end, lane, layer);
  if (watches.empty() || layer != 0 || program.problem->changed_by_law() || !same(*step_rows_, watches.back(), end))
    watches.push_back(std::move(end));
  return watches;
}

// p = Lᵀ(S z − b).
FlightWatch FlightSet::effort_watch(const Program& program, const MatrixXd& inertia, const MatrixXd& lifted) const {
  const FoldedStage& folded = program.stages.front().folded;
  FlightWatch pushed;
  pushed.value.z = folded.mass;
  pushed.value.slots.resize(static_cast<std::size_t>(slots_));
  for (int j = 0; j < slots_; ++j) pushed.value.slots[static_cast<std::size_t>(j)] = -weight_at(folded.mass_history, j);
  pushed.rows = lever_.transpose() * own_mass_.asDiagonal() * basis_;
  const MatrixXd elastic = residual_of_lift(folded.stiffness, folded.stiffness_history, lifted);
  pushed.drive =
      lever_.transpose() * (inertia + elastic - load_over_drive(program, program.plan.stages.front().load, drive_));
  for (const ClosedPoint& point : closed_) {
    pushed.lower.push_back(point.lower ? 0 : -infinity);
    pushed.upper.push_back(point.lower ? infinity : 0);
  }
  return pushed;
}

FlightSet::FlightSet(const Program& program, double layer, std::vector<ClosedPoint> closed, int powers,
                     const FlightSet* twin)
    : closed_(std::move(closed)),
      circles_(program.problem->circles()),
      rows_(program.model->rows()),
      slots_(static_cast<int>(program.plan.slots.size())) {
  const bool touching = !closed_.empty();
  for (const auto& [position, velocity] : program.plan.initial)
    metres_.push_back(position != 0 ? 1.0 : velocity != 0 ? program.h / velocity : program.h * program.h);
  const double pulsation = program.support ? program.problem->support.pulsation : program.load_pulsation;
  drive_ = {program.support, pulsation > 0 && !program.support, program.load || touching, pulsation * program.h};
  own_mass_ = program.model->inertia().mass.diagonal();
  if (touching) {
    close(program, twin);
    if (!rest(program)) {
      cause_ = "the scheme never rests at a stop";
      return;
    }
  }
  const VectorXd mass = masses(program);
  modes_ = static_cast<int>(mass.size());
  std::vector<RowVectorXd> rests(closed_.size());
  for (int j = 0; j < slots_; ++j) {
    for (std::size_t i = 0; i < closed_.size(); ++i) rests[i] = rest_[i].row(j);
    lift_.push_back(lift_by(rests));
  }
  const MatrixXd lifted = lift_by(rest_unknown_);  // of z
  MatrixXd inertia;                                // M L(s_M H z − Σ β^M_j ξ_j) of the stage that holds
  if (touching) {
    const FoldedStage& holds = program.stages.front().folded;
    inertia = own_mass_.asDiagonal() * residual_of_lift(holds.mass, holds.mass_history, lifted);
  }
  step_rows_ = std::make_unique<const StepRows>(flight_stages(program, inertia), slots_, mass,
                                                program.model->modal_damping(), drive_);

  std::vector<FlightWatch> watches = contact_watches(program, layer, lifted);
  if (touching) {
    effort_watch_ = static_cast<int>(watches.size());
    watches.push_back(effort_watch(program, inertia, lifted));
  }
  bound_ = std::make_unique<FlightBound>(*step_rows_, std::move(watches));
  cause_ = bound_->cause();
  if (!cause_.empty()) return;

  tip_watch_ = end_watch(program, program.model->tip().dense(rows_));
  tip_watch_.lower = {-infinity};
  tip_watch_.upper = {infinity};
  motion_ = std::make_unique<FlightMotion>(*step_rows_, powers);
  clear_steps_ = std::make_unique<ClearSteps>(*step_rows_, *bound_, *motion_);
  works_ = std::make_unique<FlightWorks>(*motion_, forms(program, *step_rows_, mass, lifted));
}

// Held points are watched by their efforts.
void FlightSet::set_bounds(FlightWatch& watch, const LaneSpec& lane, double layer) const {
  if (watch.bounds == FlightWatch::Bounds::own) return;
  const double shift = watch.bounds == FlightWatch::Bounds::layer ? layer : 0;
  const auto points = static_cast<std::size_t>(lane.lower.size());
  watch.lower.resize(points);
  watch.upper.resize(points);
  for (std::size_t i = 0; i < points; ++i) {
    watch.lower[i] = lane.lower[static_cast<Index>(i)] + shift;
    watch.upper[i] = lane.upper[static_cast<Index>(i)] - shift;
  }
  // A circle is left at its corners first: what stays within its square stays within it.
  for (const int first : circles_)
    put_square(lane.lower, lane.upper, first, shift, [&](int point, double low, double high) {
      watch.lower[static_cast<std::size_t>(point)] = low;
      watch.upper[static_cast<std::size_t>(point)] = high;
    });
  for (const ClosedPoint& point : closed_) {
    watch.lower[static_cast<std::size_t>(point.point)] = -infinity;
    watch.upper[static_cast<std::size_t>(point.point)] = infinity;
  }
}

void FlightSet::place(const LaneSpec& lane, double layer) {
  for (int i = 0; i < bound_->watches(); ++i) set_bounds(bound_->watch(i), lane, layer);
}

// What the lift adds to a combination, over e.
MatrixXd FlightSet::lift_of(const Combination& c, const MatrixXd& lifted) const {
  MatrixXd sum = c.z * lifted;
  for (int j = 0; j < slots_; ++j)
    if (weight_at(c.slots, j) != 0) sum += weight_at(c.slots, j) * lift_[static_cast<std::size_t>(j)];
  return sum;
}

bool FlightSet::enter(const double* const* slots, const double* e, std::vector<double>& x) const {
  x.resize(static_cast<std::size_t>(slots_) * static_cast<std::size_t>(modes_));
  if (closed_.empty()) {
    for (int j = 0; j < slots_; ++j) std::copy_n(slots[j], modes_, x.data() + static_cast<std::ptrdiff_t>(j) * modes_);
    return true;
  }
  const Eigen::Map<const VectorXd> drive(e, drive_.count());
  double size = 0;
  for (int j = 0; j < slots_; ++j) {
    const Eigen::Map<const VectorXd> slot(slots[j], rows_);
    for (std::size_t i = 0; i < closed_.size(); ++i) {
      const auto row = closed_rows_.row(static_cast<Index>(i));
      if (j == 0) size = std::max(size, row.cwiseAbs().dot(slot.cwiseAbs()));
      apart_(static_cast<Index>(i), j) = row.dot(slot) - rest_[i].row(j).dot(drive);
      if (!(std::abs(metres_[static_cast<std::size_t>(j)] * apart_(static_cast<Index>(i), j)) <= over * size))
        return false;
    }
  }
  double* modes[most_slots];
  for (int j = 0; j < slots_; ++j) modes[j] = x.data() + static_cast<std::ptrdiff_t>(j) * modes_;
  flight_kernels().products(rows_, modes_, basis_.data(), slots_, slots, modes);
  for (int j = 0; j < slots_; ++j) Eigen::Map<VectorXd>(modes[j], modes_).noalias() -= settle_ * apart_.col(j);
  return true;
}

void FlightSet::leave(const std::vector<double>& x, const double* e, double* const* slots) const {
  if (closed_.empty()) {
    for (int j = 0; j < slots_; ++j) std::copy_n(x.data() + static_cast<std::ptrdiff_t>(j) * modes_, modes_, slots[j]);
    return;
  }
  const Eigen::Map<const VectorXd> drive(e, drive_.count());
  const double* modes[most_slots];
  for (int j = 0; j < slots_; ++j) modes[j] = x.data() + static_cast<std::ptrdiff_t>(j) * modes_;
  flight_kernels().products(modes_, rows_, basis_rows_.data(), slots_, modes, slots);
  for (int j = 0; j < slots_; ++j)
    Eigen::Map<VectorXd>(slots[j], rows_).noalias() += lift_[static_cast<std::size_t>(j)] * drive;
}

FlightSet::~FlightSet() = default;

ExtremeBounds FlightSet::extremes_of(const FlightWatch& value) const {
  FlightWatch change = value;
  change.difference = true;
  change.drive = value.drive * drive_.change(1);
  ExtremeBounds bounds{std::make_unique<FlightBound>(*step_rows_, std::vector<FlightWatch>{value, change}), nullptr};
  if (!bounds.each->alternates()) return bounds;
  change.drive = value.drive * drive_.change(4);
  bounds.by_four = std::make_unique<FlightBound>(*step_rows_, std::vector<FlightWatch>{value, std::move(change)}, 2);
  if (!bounds.by_four->cause().empty()) bounds.by_four.reset();
  return bounds;
}

const ExtremeBounds& FlightSet::tip() {
  if (!tip_.each) tip_ = extremes_of(tip_watch_);
  return tip_;
}

const ExtremeBounds& FlightSet::effort_extremes() {
  if (effort_extremes_.each) return effort_extremes_;
  FlightWatch unbounded = bound_->watch(effort_watch_);
  unbounded.lower.assign(closed_.size(), -infinity);
  unbounded.upper.assign(closed_.size(), infinity);
  effort_extremes_ = extremes_of(unbounded);
  return effort_extremes_;
}

std::vector<PushTables>* FlightSet::push_tables(long long steps) {
  constexpr double most_bytes = 2e6;  // of one table
  if (steps >> PushTables::shortest == 0 || PushTables::bytes(*motion_) > most_bytes) return nullptr;
  pushed_steps_ += steps;
  if (push_tables_.empty()) {
    if (pushed_steps_ < PushTables::worth(*motion_)) return nullptr;
    for (std::size_t i = 0; i < closed_.size(); ++i) push_tables_.emplace_back(*motion_, effort(i));
  }
  return &push_tables_;
}

const StepReadings& FlightSet::tip_readings() {
  if (!tip_readings_) tip_readings_ = std::make_unique<StepReadings>(*step_rows_, tip_watch_, 0);
  return *tip_readings_;
}

}  // namespace ricochet
