#include <fmt/format.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <ricochet/contract/momentum_weights.hpp>
#include <ricochet/contract/unit_mass.hpp>
#include <string>
#include <vector>

/// \file
/// What momentum an effort finally gives to a free mass: algebra of the map that a step is on its slots.
namespace ricochet {
namespace {

using namespace free_motion;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::RowVectorXd;
using Eigen::VectorXd;

// Numbers of this size against those that they are sums of are round-off of a few hundred operations.
constexpr double lost = 1e-13;
// Singular values below are zero: a step's entries are of order one once slots have units of their own.
constexpr double singular = 1e-9;

/// A linear map of slots, and the sizes of the terms that its entries are sums of.
struct SlotMap {
  MatrixXd map, size;

  explicit SlotMap(Index slots) : map(MatrixXd::Identity(slots, slots)), size(map) {}
  /// A stage under no effort.
  explicit SlotMap(const Stage& stage) : SlotMap(static_cast<Index>(stage.update.size())) {
    map.setZero();
    size.setZero();
    const auto add = [&](Index to, std::size_t from, double by) {
      map(to, static_cast<Index>(from)) += by;
      size(to, static_cast<Index>(from)) += std::abs(by);
    };
    for (Index to = 0; to < map.rows(); ++to) {
      const Combination& row = stage.update[static_cast<std::size_t>(to)];
      for (std::size_t from = 0; from < row.slots.size(); ++from) add(to, from, row.slots[from]);
      for (std::size_t from = 0; stage.matrix.M != 0 && from < stage.history.size(); ++from)
        add(to, from, row.z * (stage.history[from].M / stage.matrix.M));
    }
  }
  SlotMap after(const SlotMap& first) const {
    SlotMap both(map.rows());
    both.map = map * first.map;
    both.size = size * first.size;
    return both;
  }
  /// What terms that cancel leave is no entry.
  MatrixXd cleaned() const { return (map.array().abs() > lost * size.array()).select(map, 0.0); }
};

/// What 1 N in the equation of z changes the slots by, and what 1 N of effort does through w.
VectorXd push(const Stage& stage) {
  VectorXd change = VectorXd::Zero(static_cast<Index>(stage.update.size()));
  for (std::size_t j = 0; stage.matrix.M != 0 && j < stage.update.size(); ++j)
    change[static_cast<Index>(j)] = stage.update[j].z / stage.matrix.M;
  return change;
}
VectorXd jump(const Stage& stage, double impulse) {
  VectorXd change = VectorXd::Zero(static_cast<Index>(stage.update.size()));
  const double w = UnitMass::jump(stage, impulse);
  if (w == 0) return change;
  change = push(stage) * (stage.impulse->feed.M * w);
  for (std::size_t j = 0; j < stage.update.size(); ++j) change[static_cast<Index>(j)] += stage.update[j].w * w;
  return change;
}

/// Units of slots, powers of two, in which the entries of a map between two slots are about as large either way.
VectorXd balance(MatrixXd& a) {
  constexpr int sweeps = 40;
  const Index n = a.rows();
  VectorXd units = VectorXd::Ones(n);
  for (int sweep = 0; sweep < sweeps; ++sweep)
    for (Index i = 0; i < n; ++i) {
      double out = 0, in = 0;
      for (Index j = 0; j < n; ++j)
        if (j != i) {
          out = std::max(out, std::abs(a(j, i)));
          in = std::max(in, std::abs(a(i, j)));
        }
      if (out == 0 && in == 0) continue;
      const double unit = std::exp2(std::round(out == 0  ? std::log2(in)
                                               : in == 0 ? -std::log2(out)
                                                         : 0.5 * std::log2(in / out)));
      a.col(i) *= unit;
      a.row(i) /= unit;
      units[i] *= unit;
    }
  return units;
}

/// One step of a plan on a free unit mass, x ← A x, in units that suit it. A mass at rest is an eigenvector r of A. One
/// at constant speed is what A moves by h r: it makes a block of Jordan with r. What else A keeps does not move.
class FreeStepMap {
 public:
  explicit FreeStepMap(const StepPlan& plan) : slots_(static_cast<Index>(plan.slots.size())), step_(slots_) {
    for (const Stage& stage : plan.stages) step_ = SlotMap(stage).after(step_);
    balanced_ = step_.cleaned();
    units_ = balance(balanced_);
    const Uniform uniform(plan);
    moving_ = Eigen::Map<const VectorXd>(uniform.moving().slots.data(), slots_).cwiseQuotient(units_);
    h_ = uniform.h();
    velocity_ = VectorXd::Zero(slots_);
    std::copy(plan.velocity.slots.begin(), plan.velocity.slots.end(), velocity_.begin());
    velocity_ = velocity_.cwiseProduct(units_);
    find_momentum();
  }

  /// ℓ with ℓ A = ℓ, nothing on what stays where it is and 1 on 1 m/s: at what speed the mass finally moves. No entries
  /// where there is none.
  const RowVectorXd& momentum() const { return momentum_; }

  /// "" where the velocity finally is that of the motion at constant speed that a change of the slots brings. Else what
  /// it does for ever.
  std::string unsettled(const VectorXd& change) const {
    constexpr int doublings = 30, looks = 4;
    constexpr double settled = 1e-6, far = 1e6, round_off = 1e-9;
    const VectorXd begins = change.cwiseQuotient(units_);
    const double lasting = momentum_.dot(change);
    const double scale =
        std::max({std::abs(lasting), std::abs(velocity_.dot(begins)), round_off * velocity_.norm() * begins.norm()});
    const double way = std::max(h_ * scale, std::abs(change[0]));
    // Without that motion A has no block of Jordan of 1: its powers stay bounded.
    MatrixXd power = balanced_ - moving_ * (momentum_.transpose().cwiseProduct(units_)).transpose();
    for (int k = 0; k < doublings; ++k) power = power * power;
    VectorXd rest = power * (begins - moving_ * lasting);
    for (int k = 0; k < looks; ++k, rest = balanced_ * rest) {
      const double speed = std::abs(velocity_.dot(rest)), place = std::abs(units_[0] * rest[0]);
      if (!(speed <= far * scale && place <= far * way)) return "grows";
      if (speed > settled * scale) return "changes";
    }
    return "";
  }

 private:
  void find_momentum() {
    const SquareSvd change(balanced_ - MatrixXd::Identity(slots_, slots_), Eigen::ComputeFullU | Eigen::ComputeFullV);
    const VectorXd& sizes = change.singularValues();
    const Index kept = (sizes.array() <= singular * std::max(1.0, sizes[0])).count();
    if (kept == 0) return;
    const MatrixXd left = change.matrixU().rightCols(kept), right = change.matrixV().rightCols(kept);
    const SquareSvd meet(left.transpose() * right, Eigen::ComputeFullU);
    // Two chains of Jordan: then more than one motion goes on.
    if (kept > 1 && !(meet.singularValues()[kept - 2] > singular)) return;
    const VectorXd found = left * meet.matrixU().col(kept - 1);
    const double speed = found.dot(moving_);
    if (!(std::abs(speed) > singular * moving_.norm())) return;
    momentum_ = (found / speed).cwiseQuotient(units_).transpose();
  }

  using SquareSvd = Eigen::JacobiSVD<MatrixXd, Eigen::NoQRPreconditioner>;  // without what only other shapes need

  Index slots_;
  SlotMap step_;
  MatrixXd balanced_;
  VectorXd units_, moving_, velocity_;  // a mass at 1 m/s, and what the plan reads, in these units
  double h_ = 0;
  RowVectorXd momentum_;
};

/// Of stages in a row, before each of which and after the last one a functional of the slots is known: those after
/// each.
std::vector<RowVectorXd> functionals(const std::vector<Stage>& stages, const RowVectorXd& last) {
  std::vector<RowVectorXd> after(stages.size(), last);
  for (std::size_t k = stages.size(); k-- > 1;) after[k - 1] = after[k] * SlotMap(stages[k]).map;
  return after;
}

VectorXd at_the_end(const std::vector<Stage>& stages, std::size_t stage, VectorXd change) {
  for (std::size_t k = stage + 1; k < stages.size(); ++k) change = SlotMap(stages[k]).map * change;
  return change;
}

}  // namespace

StageEfforts stage_efforts(const std::vector<Stage>& stages, const std::optional<Evaluation>& evaluation) {
  StageEfforts efforts;
  for (const Stage& stage : stages) {
    efforts.emplace_back();
    const auto reads = [&](const auto& measure) {
      if (measure) efforts.back() = {measure->effort, stage.impulse ? measure->impulse : 0.0};
    };
    if (evaluation)
      reads(stage.at(*evaluation));
    else
      reads(stage.impact);
  }
  return efforts;
}

EffortMomenta effort_momenta(const StepPlan& plan, const StageEfforts& start, const StageEfforts& efforts) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  EffortMomenta momenta;
  momenta.start.assign(plan.start.size(), none);
  momenta.stages.assign(plan.stages.size(), none);
  if (!has_inertia(plan)) {
    momenta.why_none = "a stage of the plan solves without M";
    return momenta;
  }
  const FreeStepMap step(plan);
  if (step.momentum().size() == 0) {
    momenta.why_none = "a free mass may go on at a speed that changes for ever";
    return momenta;
  }
  const double h = Uniform(plan).h();
  const auto stages = plan.stages.size(), before = plan.start.size();
  const std::vector<RowVectorXd> after = functionals(plan.stages, step.momentum());
  const RowVectorXd begins = after.front() * SlotMap(plan.stages.front()).map;
  const std::vector<RowVectorXd> after_start = functionals(plan.start, begins);
  // What 1 N in the equation of a stage gives: an effort acts by the weights of the stages that look back at it.
  const auto settles = [&](const std::vector<Stage>& list, std::size_t k, double impulse, const std::string& name) {
    for (const VectorXd& change : {push(list[k]), jump(list[k], impulse)}) {
      VectorXd end = at_the_end(list, k, change);
      if (&list == &plan.start) end = at_the_end(plan.stages, 0, SlotMap(plan.stages.front()).map * end);
      if (const std::string does = step.unsettled(end); momenta.why_none.empty() && !does.empty())
        momenta.why_none = fmt::format("what an effort of {} gives to a free mass {} for ever", name, does);
    }
  };
  std::vector<double> pushes;
  for (std::size_t k = 0; k < stages; ++k) {
    pushes.push_back(after[k].dot(push(plan.stages[k])));
    if (!efforts[k].weights.empty()) settles(plan.stages, k, efforts[k].impulse, fmt::format("stage {}", k + 1));
  }
  for (std::size_t k = 0; k < before; ++k)
    if (!start[k].weights.empty()) settles(plan.start, k, start[k].impulse, "the start");
  if (!momenta.why_none.empty()) return momenta;

  // `place`: of the stage that finds the effort, 0 the first one of a step.
  const auto by_steps = [&](std::ptrdiff_t place) {
    double sum = 0;
    for (std::size_t back = 0; back < most_efforts; ++back) {
      const std::ptrdiff_t at = place + static_cast<std::ptrdiff_t>(back);
      if (at < 0) continue;
      const std::size_t k = static_cast<std::size_t>(at) % stages;
      if (back < efforts[k].weights.size()) sum += efforts[k].weights[back] * pushes[k];
    }
    return sum;
  };
  for (std::size_t k = 0; k < stages; ++k) {
    const double given =
        by_steps(static_cast<std::ptrdiff_t>(k)) + after[k].dot(jump(plan.stages[k], efforts[k].impulse));
    momenta.stages[k] = h * simple(given / h);
  }
  for (std::size_t k = 0; k < before; ++k) {
    double given = by_steps(static_cast<std::ptrdiff_t>(k) - static_cast<std::ptrdiff_t>(before)) +
                   after_start[k].dot(jump(plan.start[k], start[k].impulse));
    for (std::size_t later = k; later < before; ++later)
      if (later - k < start[later].weights.size())
        given += start[later].weights[later - k] * after_start[later].dot(push(plan.start[later]));
    momenta.start[k] = h * simple(given / h);
  }
  return momenta;
}

EffortMomenta effort_momenta(const StepPlan& plan, const std::optional<Evaluation>& evaluation) {
  return effort_momenta(plan, stage_efforts(plan.start, evaluation), stage_efforts(plan.stages, evaluation));
}

}  // namespace ricochet
