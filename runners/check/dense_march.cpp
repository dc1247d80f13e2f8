#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ricochet/kernels/dense_solvers.hpp>

#include "runners/check/scheme_checks.hpp"

namespace ricochet::checking {
namespace {

// Round-off of ten steps through factors whose condition is that of a small structure's stiffness.
constexpr double tolerance = 1e-8;

}  // namespace

DenseMarch::DenseMarch(const Marcher& marcher)
    : problem_(*marcher.program().problem),
      plan_(marcher.program().plan),
      h_(marcher.program().h),
      reads_(marcher.law().reads()),
      absent_(marcher.law().absent()),
      M_(problem_.inertia.mass),
      K_(problem_.stiffness),
      H_(problem_.measured()) {
  C_ = problem_.damping.stiffness * K_ + problem_.damping.mass * M_;
  for (const LaneSpec& spec : marcher.program().lanes) {
    Lane lane;
    lane.spec = spec;
    for (const auto& [position, velocity] : plan_.initial)
      lane.slots.push_back(position * spec.position + velocity * spec.velocity);
    lane.past.assign(most_efforts, Eigen::VectorXd::Zero(H_.rows()));
    lane.last_start = Eigen::VectorXd::Zero(H_.rows());
    lanes_.push_back(std::move(lane));
  }
}

Eigen::VectorXd DenseMarch::combined(const Lane& lane, const Combination& c, const Found& found) const {
  Eigen::VectorXd sum = c.z * found.z + c.w * found.w;
  for (std::size_t j = 0; j < c.slots.size(); ++j) sum += c.slots[j] * lane.slots[j];
  return sum;
}

double DenseMarch::support(const Lane& lane, double t, const Levels& levels, bool rate) const {
  const double omega = problem_.support.pulsation;
  double sum = 0;
  for (const Level& level : levels) {
    const double angle = omega * (t + level.at * h_) + lane.spec.phase;
    sum += level.weight * lane.spec.amplitude * (rate ? omega * std::cos(angle) : std::sin(angle));
  }
  return sum;
}

Eigen::VectorXd DenseMarch::load(const Lane& lane, double t, const Levels& levels) const {
  const double omega = problem_.support.pulsation;
  Eigen::VectorXd sum = omega * omega * support(lane, t, levels, false) * problem_.support_shape;
  if (!problem_.load || problem_.load->absent()) return sum;
  Eigen::VectorXd at(sum.size());
  for (const Level& level : levels) {
    problem_.load->assemble(t + level.at * h_, at.data());
    sum += level.weight * at;
  }
  return sum;
}

void DenseMarch::note(const std::string& sentence) {
  if (difference_.empty()) difference_ = fmt::format("step {}: {}", step_ + 1, sentence);
}

DenseMarch::Efforts DenseMarch::efforts_of(const Stage& stage) const {
  const auto of = [&](const auto& measure) {
    return absent_ || !measure ? Efforts{} : Efforts{&measure->effort, measure->impulse};
  };
  return reads_ ? of(stage.at(*reads_)) : of(stage.impact);
}

void DenseMarch::solve(const Lane& lane, const StageView& view, const Efforts& efforts, Found& found) const {
  const Stage& stage = *view.plan;
  const OperatorWeights& s = stage.matrix;
  if (s.M == 0 && s.C == 0 && s.K == 0) return;
  const std::vector<double>* weights = efforts.weights;
  const auto dense = [&](const OperatorWeights& o) { return (o.M * M_ + o.C * C_ + o.K * K_).eval(); };
  Eigen::VectorXd b = load(lane, view.time, stage.load);
  for (std::size_t j = 0; j < stage.history.size(); ++j) b += dense(stage.history[j]) * lane.slots[j];
  if (weights && !view.starting)
    for (std::size_t k = 1; k < weights->size(); ++k) b += (*weights)[k] * (H_.transpose() * lane.past[k - 1]);
  const DenseLu S(dense(s));
  found.free = S.solve(b);
  if (weights && stage.impulse && efforts.impulse != 0) {
    found.w = DenseLu(dense(stage.impulse->R)).solve(efforts.impulse * (H_.transpose() * found.p));
    b += dense(stage.impulse->feed) * found.w;
  }
  if (weights) b += weights->front() * (H_.transpose() * found.p);
  found.z = S.solve(b);
}

void DenseMarch::stage_solved(const Marcher& marcher, const StageView& view) {
  const Stage& stage = *view.plan;
  const auto points = H_.rows();
  for (std::size_t l = 0; l < lanes_.size(); ++l) {
    Lane& lane = lanes_[l];
    if (!marcher.status(static_cast<int>(l)).running) continue;
    if (lane.starting && !view.starting) {
      lane.starting = false;
      if (!plan_.start.empty()) lane.past.front() = lane.last_start;
    }
    const Efforts efforts = efforts_of(stage);
    const std::vector<double>* weights = efforts.weights;
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(M_.rows());
    Found found{none, none, Eigen::VectorXd::Zero(points), none};
    Eigen::VectorXd& p = found.p;
    if (weights && view.effort)
      for (Eigen::Index i = 0; i < points; ++i)
        p[i] = view.effort[0][i * marcher.width() + static_cast<Eigen::Index>(l)];
    solve(lane, view, efforts, found);
    if (view.stage == 0) {
      lane.efforts.clear();
      lane.ways.clear();
    }
    lane.efforts.push_back(p);
    lane.ways.push_back(Eigen::VectorXd::Zero(points));
    if (stage.work)
      lane.ways.back() = (H_ * combined(lane, stage.work->displacement, found)).array() +
                         support(lane, view.time, stage.work->support, false);
    const std::size_t restores = weights && !reads_ ? static_cast<std::size_t>(stage.impact->restores) : 0;
    if (restores > 0)
      look_at_work(lane, lane.ways.size() - 1, lane.ways.size() - 1 - restores);
    else if (weights)
      look_at_contact(stage, lane, found, view.time);
    std::vector<Eigen::VectorXd> next;
    for (const Combination& row : stage.update) next.push_back(combined(lane, row, found));
    lane.slots = std::move(next);
    if (view.starting) {
      lane.last_start = p;
    } else {
      std::rotate(lane.past.begin(), lane.past.end() - 1, lane.past.end());
      lane.past.front() = p;
    }
  }
}

void DenseMarch::look_at_contact(const Stage& stage, const Lane& lane, const Found& found, double t) {
  const Eigen::VectorXd& p = found.p;
  const Combination& value = reads_ ? stage.at(*reads_)->displacement : stage.impact->value;
  const Levels& bound = reads_ ? stage.at(*reads_)->bound : stage.impact->bound;
  const bool gated = !reads_ && stage.impact->gate;
  const Eigen::VectorXd y = (H_ * combined(lane, value, found)).array() + support(lane, t, bound, gated);
  if (gated) {
    look_at_gate(*stage.impact, lane, y, found, t);
    return;
  }
  for (Eigen::Index i = 0; i < y.size(); ++i) {
    const double lower = lane.spec.lower[i], upper = lane.spec.upper[i];
    const double size = tolerance * (1 + std::abs(y[i]));
    if (!reads_) {
      const bool holds = y[i] >= lower - size && y[i] <= upper + size && (p[i] <= 0 || y[i] <= lower + size) &&
                         (p[i] >= 0 || y[i] >= upper - size);
      if (!holds)
        note(fmt::format("the impact measure is {:.10g} between {:g} and {:g} under {:g} N", y[i], lower, upper, p[i]));
    } else if (p[i] == 0 && !(y[i] >= lower - size && y[i] <= upper + size)) {
      note(fmt::format("g = {:.10g} lies beyond its stop without an effort", y[i]));
    } else if (p[i] != 0 && !((p[i] > 0 && y[i] <= lower + size) || (p[i] < 0 && y[i] >= upper - size))) {
      note(fmt::format("{:g} N act where g = {:.10g} is open", p[i], y[i]));
    }
  }
}

// Point by point the stops do no work over both stages, and push to one side.
void DenseMarch::look_at_work(const Lane& lane, std::size_t k, std::size_t source) {
  const Eigen::VectorXd &p = lane.efforts[k], &way = lane.ways[k], &before = lane.efforts[source];
  for (Eigen::Index i = 0; i < p.size(); ++i) {
    const double given = p[i] * way[i], taken = before[i] * lane.ways[source][i];
    const double size =
        tolerance * (std::abs(p[i]) + std::abs(before[i])) * (std::abs(way[i]) + std::abs(lane.ways[source][i]) + 1e-6);
    if (!(std::abs(given + taken) <= size))
      note(fmt::format("contact takes {:.10g} J in a stage, and {:.10g} J are given back", -taken, given));
    if (p[i] * before[i] < 0 || (before[i] == 0 && p[i] != 0))
      note(fmt::format("{:g} N give back the work of {:g} N", p[i], before[i]));
  }
}

// Only sides that the gate finds closed carry an effort, and on them y is not below the rebound.
void DenseMarch::look_at_gate(const ImpactMeasure& impact, const Lane& lane, const Eigen::VectorXd& y,
                              const Found& found, double t) {
  const VelocityGate& gate = *impact.gate;
  const Eigen::VectorXd& p = found.p;
  const Found none{found.free, Eigen::VectorXd::Zero(M_.rows()), p, found.free};
  const Eigen::VectorXd gap =
      (H_ * combined(lane, gate.predictor, none)).array() + support(lane, t, gate.predictor_bound, false);
  const Eigen::VectorXd speed =
      (H_ * combined(lane, gate.approach, none)).array() + support(lane, t, gate.approach_bound, true);
  for (Eigen::Index i = 0; i < y.size(); ++i) {
    const double size = tolerance * (1 + std::abs(speed[i]));
    const bool lower = gap[i] <= lane.spec.lower[i] + tolerance, upper = gap[i] >= lane.spec.upper[i] - tolerance;
    if ((p[i] > 0 && !lower) || (p[i] < 0 && !upper))
      note(fmt::format("{:g} N act on a side whose gate is open", p[i]));
    const double rebound = -gate.restitution * speed[i];
    if (p[i] > 0 && std::abs(speed[i]) > size && speed[i] < 0 && !(std::abs(y[i] - rebound) <= size))
      note(
          fmt::format("a point that comes with {:g} m/s leaves with {:g} m/s, not with {:g}", speed[i], y[i], rebound));
    if (p[i] < 0 && std::abs(speed[i]) > size && speed[i] > 0 && !(std::abs(y[i] - rebound) <= size))
      note(
          fmt::format("a point that comes with {:g} m/s leaves with {:g} m/s, not with {:g}", speed[i], y[i], rebound));
  }
}

void DenseMarch::step_done(Marcher& marcher) {
  const int rows = marcher.program().model->rows(), T = marcher.width();
  for (std::size_t j = 0; j < plan_.slots.size(); ++j) {
    double scale = 0, worst = 0;
    for (std::size_t l = 0; l < lanes_.size(); ++l) {
      Eigen::VectorXd model(rows);
      for (int i = 0; i < rows; ++i) model[i] = marcher.slot(static_cast<int>(j))[i * T + static_cast<int>(l)];
      const Eigen::VectorXd& dense = lanes_[l].slots[j];
      worst = std::max(worst, (marcher.program().model->to_nodal(model) - dense).cwiseAbs().maxCoeff());
      scale = std::max(scale, dense.cwiseAbs().maxCoeff());
    }
    if (!(worst <= tolerance * std::max(scale, 1e-6)))
      note(fmt::format("slot {} differs by {:.3g} of {:.3g} from the plan evaluated with dense matrices",
                       plan_.slots[j], worst, scale));
  }
  ++step_;
}

}  // namespace ricochet::checking
