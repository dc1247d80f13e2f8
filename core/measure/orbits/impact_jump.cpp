#include <Eigen/Cholesky>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <ricochet/measure/orbits/impact_jump.hpp>

namespace ricochet {
namespace {

// Steps of flight after which a point that had impacts without a jump does not come to rest of them.
constexpr int clear_flight = 10;
// An impact is over within this many steps of contact: restitution over three levels takes two.
constexpr int longest_impact = 3;
// e is read off an integration of the plan: of none, round-off over h is left.
constexpr double rebounds_above = 1e-6;

bool rebounds_not(const std::optional<double>& restitution) {
  return restitution && std::abs(*restitution) < rebounds_above;
}

}  // namespace

// The last three displacements, newest first.
struct ImpactJump::Past {
  std::array<Eigen::VectorXd, 3> q;
  int known = 0;
  // One column of a block; allocates the first time only.
  void add(const double* block, int rows, int width, int column) {
    std::rotate(q.begin(), q.begin() + 2, q.end());
    q[0].resize(rows);
    for (int i = 0; i < rows; ++i) q[0][i] = block[static_cast<std::ptrdiff_t>(i) * width + column];
    known = std::min(known + 1, 3);
  }
  // Velocity and acceleration about the middle of the three, and what they give `ago` seconds before the newest.
  Eigen::VectorXd acceleration(double h) const { return (q[0] - 2 * q[1] + q[2]) / (h * h); }
  Eigen::VectorXd velocity(double h, double ago) const { return (q[0] - q[1]) / h + (h / 2 - ago) * acceleration(h); }
  Eigen::VectorXd displacement(double h, double ago) const {
    return q[0] - ago * velocity(h, 0) + ago * ago / 2 * acceleration(h);
  }
};

struct ImpactJump::Impact {
  int point = 0;
  double time = 0;                                       // t*
  Eigen::VectorXd displacement, velocity, acceleration;  // q⁻, v⁻, a⁻ at t*
  double approach = 0;                                   // w⁻
};

struct ImpactJump::Moved {
  Eigen::VectorXd place, rate, bend;  // displacement, velocity, acceleration at t*
};

struct ImpactJump::Lane {
  Past orbit;
  std::vector<Past> columns;
  bool contact = false, known = false;
  int steps = 0;       // of contact in this impact
  int free_steps = 0;  // since
  int unshifted = 0;   // steps since columns were set anew, 3 at most
  Impact impact;
  int applied = 0;
  std::vector<int> age;       // per point, steps of contact in a row
  std::vector<bool> pushing;  // per point, in the step under way
  void forget_columns() {
    for (Past& past : columns) past.known = 0;
    unshifted = 0;
  }
  bool skipped = false;  // an impact has no jump, and its point has neither come to rest nor flown since
  int resting = 0, most_resting = 0, untold = 0;
  bool ended = false;  // an impact without rebound had its jump
};

struct ImpactJump::Inverse {
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> mass;
  Eigen::SparseMatrix<double> stiffness;
  Damping damping;
  Eigen::SparseMatrix<double> inertia, inverse;  // one of both
  Eigen::VectorXd answer(const Eigen::VectorXd& force) const {
    return inverse.rows() > 0 ? Eigen::VectorXd(inverse * force) : Eigen::VectorXd(mass.solve(force));
  }
  // The acceleration of a free motion (q, v).
  Eigen::VectorXd of(const Eigen::VectorXd& q, const Eigen::VectorXd& v) const {
    if (inverse.rows() > 0) return -(inverse * (stiffness * (q + damping.stiffness * v))) - damping.mass * v;
    const Eigen::VectorXd force = stiffness * (q + damping.stiffness * v) + damping.mass * (inertia * v);
    return -mass.solve(force);
  }
};

ImpactJump::ImpactJump(Marcher& marcher, Orbit orbit) : places_(orbit == Orbit::placed) {
  const Program& program = marcher.program();
  if ((program.tangents == 0 && !places_) || !program.contact || program.law->reads()) return;
  massive_ = points_with_mass(*program.problem);
  const auto some = [&] { return std::find(massive_.begin(), massive_.end(), true) != massive_.end(); };
  if (!some()) return;
  const std::vector<bool> resolved = resolved_points(*program.problem, program.h);
  for (std::size_t i = 0; i < massive_.size(); ++i) massive_[i] = massive_[i] && resolved[i];
  needed_ = some();
  if (!needed_) return;
  marcher.delay_tangents(massive_, longest_impact);
  offset_ = program.velocity_offset;
  restitution_ = point_restitutions(program);
  for (int lane = 0; lane < marcher.lanes(); ++lane) {
    lanes_.push_back(std::make_unique<Lane>());
    lanes_.back()->columns.resize(static_cast<std::size_t>(program.tangents));
    lanes_.back()->age.assign(massive_.size(), 0);
    lanes_.back()->pushing.assign(massive_.size(), false);
  }
  const Inertia& inertia = program.model->inertia();
  if (inertia.factored() || inertia.kernel_dimension > 0) return;
  inverse_mass_ = std::make_unique<Inverse>();
  inverse_mass_->inertia = inertia.mass;
  inverse_mass_->inverse = inertia.inverse;
  inverse_mass_->stiffness = program.model->stiffness();
  inverse_mass_->damping = program.problem->damping;
  if (inertia.inverted()) return;
  inverse_mass_->mass.compute(inverse_mass_->inertia);
  if (inverse_mass_->mass.info() != Eigen::Success) inverse_mass_.reset();
}

ImpactJump::~ImpactJump() = default;

void ImpactJump::columns_replaced() {
  for (auto& lane : lanes_) lane->forget_columns();
}

int ImpactJump::applied(int lane) const {
  return needed_ ? lanes_[static_cast<std::size_t>(lane)]->applied : 0;
}

int ImpactJump::lost(int lane) const {
  if (!needed_) return 0;
  const Lane& one = *lanes_[static_cast<std::size_t>(lane)];
  if (one.most_resting > 0) return 2 * one.most_resting;
  return one.ended ? 1 : 0;
}

int ImpactJump::untold(int lane) const {
  if (!needed_) return 0;
  const Lane& one = *lanes_[static_cast<std::size_t>(lane)];
  return one.untold + (one.skipped ? 1 : 0);
}

void ImpactJump::stage_solved(const Marcher& marcher, const StageView& view) {
  for (std::size_t index = 0; index < lanes_.size(); ++index) {
    Lane& lane = *lanes_[index];
    // Contact anywhere in the step, whichever of its stages asked.
    if (view.stage == 0) {
      lane.contact = false;
      std::fill(lane.pushing.begin(), lane.pushing.end(), false);
    }
    if (!view.effort || !((view.contact_lanes >> index) & 1u)) continue;
    for (std::size_t i = 0; i < massive_.size(); ++i) {
      const double p = view.effort[0][i * static_cast<std::size_t>(marcher.width()) + index];
      if (p == 0 || !massive_[i]) continue;
      lane.pushing[i] = true;
      if (lane.age[i] > longest_impact) continue;  // it rests
      const auto point = static_cast<int>(i);
      lane.contact = true;
      if (lane.known && lane.impact.point != point)
        lane.known = false;
      else if (!lane.known && lane.steps == 0 && lane.orbit.known == 3)
        watch(marcher, lane, static_cast<int>(index), point, p > 0 ? 0 : 1, view.time);
    }
  }
}

namespace {

// What clamps accelerate a contact point by.
double clamp_acceleration(const Marcher& marcher, int lane, int point, double time) {
  const double omega = marcher.program().problem->support.pulsation;
  return -omega * omega * marcher.support(lane, time) + marcher.motions().point_acceleration(point, time);
}

}  // namespace

// The orbit just before an impact, carried to the time at which the gap of the point closes.
void ImpactJump::watch(const Marcher& marcher, Lane& lane, int index, int point, int side, double time) {
  const double h = marcher.program().h;
  const RowMatrix& rows = marcher.program().model->measured();
  const LaneSpec& spec = marcher.program().lanes[static_cast<std::size_t>(index)];
  Impact& impact = lane.impact;
  impact.point = point;
  impact.acceleration = lane.orbit.acceleration(h);
  const Eigen::VectorXd now = lane.orbit.velocity(h, 0);
  const double speed = rows.times(point, now.data()) + marcher.lift_rate(index, point, time);
  const double gap = (side == 0 ? spec.lower[point] : spec.upper[point]) - rows.times(point, lane.orbit.q[0].data()) -
                     marcher.lift(index, point, time);
  // Closing towards a lower stop, gap and speed are both negative.
  double ahead = speed != 0 ? gap / speed : 0.0;
  if (places_) {  // to the order of the orbit's own place
    const double bend = rows.times(point, impact.acceleration.data()) + clamp_acceleration(marcher, index, point, time);
    for (int k = 0; k < 3 && speed != 0; ++k)
      if (const double then = speed + ahead * bend; then * speed > 0)
        ahead -= (ahead * (speed + ahead * bend / 2) - gap) / then;
  }
  ahead = std::min(std::max(ahead, -2 * h), 2 * h);
  impact.time = time + ahead;
  impact.displacement = lane.orbit.displacement(h, -ahead);
  impact.velocity = lane.orbit.velocity(h, -ahead);
  impact.approach = rows.times(point, impact.velocity.data()) + marcher.lift_rate(index, point, impact.time);
  lane.known = impact.approach != 0;
}

void ImpactJump::step_done(Marcher& marcher) {
  const int rows = marcher.program().model->rows(), width = marcher.width();
  for (std::size_t index = 0; index < lanes_.size(); ++index) {
    Lane& lane = *lanes_[index];
    const int number = static_cast<int>(index);
    lane.orbit.add(marcher.slot(0), rows, width, number);
    lane.unshifted = std::min(lane.unshifted + 1, 3);
    for (std::size_t k = 0; k < lane.columns.size(); ++k)
      lane.columns[k].add(marcher.slot(0), rows, width, marcher.tangent_lane(number, static_cast<int>(k)));
    bool comes_to_rest = false;
    lane.resting = 0;
    for (std::size_t i = 0; i < lane.age.size(); ++i) {
      lane.age[i] = lane.pushing[i] ? lane.age[i] + 1 : 0;
      comes_to_rest = comes_to_rest || lane.age[i] == longest_impact + 1;
      lane.resting += lane.age[i] > longest_impact;
    }
    lane.most_resting = std::max(lane.most_resting, lane.resting);
    if (comes_to_rest) {
      hold(marcher, lane, number);
      // Of another point's impact nothing is known any more.
      lane.skipped = lane.known && lane.age[static_cast<std::size_t>(lane.impact.point)] <= longest_impact;
      lane.known = lane.contact = false;
      lane.steps = lane.free_steps = 0;
      lane.forget_columns();
      continue;
    }
    if (lane.contact) {
      ++lane.steps;
      lane.free_steps = 0;
      if (lane.steps > longest_impact) lane.known = false;
      continue;
    }
    ++lane.free_steps;
    if (lane.skipped && lane.free_steps > clear_flight) {
      lane.skipped = false;
      ++lane.untold;
    }
    if (lane.steps == 0) continue;
    if (!lane.known) {
      lane.steps = 0;
      lane.skipped = true;
      continue;
    }
    if (lane.free_steps < 2 || lane.unshifted < 3) continue;
    finish(marcher, lane, number);
    lane.known = false;
    lane.steps = 0;
  }
}

// Takes out of the columns what moves the points that rest.
void ImpactJump::hold(Marcher& marcher, Lane& lane, int index) {
  const MarchModel& model = *marcher.program().model;
  const RowMatrix& rows = model.measured();
  const Eigen::Index size = model.rows();
  const bool all = lane.resting >= size;
  // Without rebound the speed is lost at once, and what damping makes of that is not in the limit of chattering.
  bool lost = !inverse_mass_;
  for (std::size_t i = 0; i < lane.age.size(); ++i)
    lost = lost || (lane.age[i] > longest_impact && rebounds_not(restitution_[i]));
  if (!all && lost) {
    ++lane.untold;
    return;
  }
  Eigen::MatrixXd push = Eigen::MatrixXd::Zero(size, lane.resting), answer(size, lane.resting);
  Eigen::Index a = 0;
  for (std::size_t i = 0; i < lane.age.size(); ++i) {
    if (lane.age[i] <= longest_impact) continue;
    for (auto e = static_cast<std::size_t>(rows.start[i]); e < static_cast<std::size_t>(rows.start[i + 1]); ++e)
      push(rows.index[e], a) += rows.value[e];
    if (!all) answer.col(a) = inverse_mass_->answer(push.col(a));
    ++a;
  }
  const Eigen::MatrixXd share =
      all ? Eigen::MatrixXd() : Eigen::MatrixXd((push.transpose() * answer).ldlt().solve(push.transpose()));
  for (int k = 0; k < marcher.tangents(); ++k) {
    LaneState column = marcher.tangent(index, k);
    for (std::size_t first = 0; first < column.slots.size(); first += static_cast<std::size_t>(size)) {
      Eigen::Map<Eigen::VectorXd> slot(column.slots.data() + first, size);
      if (all)
        slot.setZero();
      else
        slot -= answer * (share * slot);
    }
    std::fill(column.efforts.begin(), column.efforts.end(), 0.0);
    marcher.set_tangent(index, k, column);
  }
}

// What an impact takes of the velocities. Its direction is that of the orbit; its size is the law's, which the orbit
// itself keeps to O(h) only.
Eigen::VectorXd ImpactJump::lost_speed(const Marcher& marcher, const Impact& impact,
                                       const Eigen::VectorXd& after) const {
  Eigen::VectorXd lost = impact.velocity - after;
  const double taken = marcher.program().model->measured().times(impact.point, lost.data());
  const std::optional<double>& e = restitution_[static_cast<std::size_t>(impact.point)];
  if (e && taken != 0) lost *= (1 + *e) * impact.approach / taken;
  return lost;
}

// Adds to a state what an impact moves, so long after it.
void ImpactJump::put(const Marcher& marcher, const Moved& by, double since, LaneState& state) const {
  const Eigen::VectorXd place = by.place + (since * by.rate + since * since / 2 * by.bend),
                        rate = by.rate + since * by.bend;
  double* slot = state.slots.data();
  for (const auto& [position, velocity] : marcher.program().plan.initial) {
    for (int i = 0; i < place.size(); ++i)
      slot[i] += position != 0
                     ? position * place[i] + velocity * rate[i]
                     : (velocity != 0 ? velocity * (rate[i] + offset_ * marcher.program().h * by.bend[i]) : by.bend[i]);
    slot += place.size();
  }
}

// Puts the orbit where an impact at t* leads to.
void ImpactJump::place(Marcher& marcher, Lane& lane, int index, double since) const {
  const double h = marcher.program().h;
  const Eigen::VectorXd after = lane.orbit.velocity(h, since);
  Moved by;
  by.place = lane.impact.displacement - lane.orbit.displacement(h, since);
  by.rate = lane.impact.velocity - lost_speed(marcher, lane.impact, after) - after;
  by.bend = inverse_mass_ ? inverse_mass_->of(by.place, by.rate) : Eigen::VectorXd::Zero(after.size());
  LaneState state = marcher.lane_state(index);
  put(marcher, by, since, state);
  marcher.set_lane(index, LaneSpec(marcher.program().lanes[static_cast<std::size_t>(index)]), state);
  double then = since;
  for (Eigen::VectorXd& q : lane.orbit.q) {
    q += by.place + then * by.rate + then * then / 2 * by.bend;
    then -= h;
  }
}

void ImpactJump::finish(Marcher& marcher, Lane& lane, int index) {
  const Program& program = marcher.program();
  const double h = program.h, since = marcher.time() - lane.impact.time;
  if (places_) place(marcher, lane, index, since);
  const RowMatrix& rows = program.model->measured();
  const Impact& impact = lane.impact;
  const Eigen::VectorXd after = lane.orbit.velocity(h, since), acceleration = lane.orbit.acceleration(h);
  const Eigen::VectorXd lost = lost_speed(marcher, impact, after);
  const double pushed = rows.times(impact.point, impact.acceleration.data()) +
                        clamp_acceleration(marcher, index, impact.point, impact.time);
  for (std::size_t k = 0; k < lane.columns.size(); ++k) {
    const Past& past = lane.columns[k];
    const Eigen::VectorXd dq = past.displacement(h, since), dv = past.velocity(h, since);
    const double shift = -rows.times(impact.point, dq.data()) / impact.approach;
    const double closing = rows.times(impact.point, dv.data()) + pushed * shift;
    Eigen::VectorXd place = lost * shift;
    Eigen::VectorXd rate = (impact.acceleration - acceleration) * shift - lost * (closing / impact.approach);
    Eigen::VectorXd bend = Eigen::VectorXd::Zero(place.size());
    if (inverse_mass_) bend = inverse_mass_->of(place, rate);
    LaneState column = marcher.tangent(index, static_cast<int>(k));
    put(marcher, {std::move(place), std::move(rate), std::move(bend)}, since, column);
    marcher.set_tangent(index, static_cast<int>(k), column);
  }
  if (lane.resting > 0) hold(marcher, lane, index);
  lane.forget_columns();
  ++lane.applied;
  lane.ended = lane.ended || rebounds_not(restitution_[static_cast<std::size_t>(impact.point)]);
}

}  // namespace ricochet
