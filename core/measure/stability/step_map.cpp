#include <algorithm>
#include <cmath>
#include <limits>
#include <ricochet/contract/stage_facts.hpp>
#include <ricochet/kernels/dense_solvers.hpp>
#include <ricochet/kernels/eigenvalues.hpp>
#include <ricochet/measure/stability/step_map.hpp>

namespace ricochet {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

bool solves(const Stage& stage) {
  return stage.matrix.M != 0 || stage.matrix.C != 0 || stage.matrix.K != 0;
}

MatrixXd weighted(const LinearProblem& problem, const OperatorWeights& w) {
  return w.M * problem.mass + w.C * problem.damping + w.K * problem.stiffness;
}

struct Measure {
  const Combination* value = nullptr;
  std::vector<double> effort = {1.0};
  const Combination* before = nullptr;  // a conserving evaluation takes the mean of both
  double impulse = 0;                   // ι, where the stage has a second unknown
};

std::optional<Measure> measure_of(const Stage& stage, const ClosedContact& law) {
  if (!law.evaluation) {
    if (!stage.impact) return std::nullopt;
    return Measure{&stage.impact->value, stage.impact->effort, nullptr, stage.impulse ? stage.impact->impulse : 0.0};
  }
  const auto& compliance = stage.at(*law.evaluation);
  if (!compliance) return std::nullopt;
  return Measure{&compliance->displacement, compliance->effort, compliance->before ? &*compliance->before : nullptr,
                 stage.impulse ? compliance->impulse : 0.0};
}

// The last efforts of all stages in the state, newest first: p₋₁ of the stage to come, p₋₂, …
struct PastEfforts {
  Index at = 0;
  Index levels = 0;
};

// Rows of one stage: the unknown z and the effort p over the state before it.
class StageRows {
 public:
  StageRows(const LinearProblem& problem, const StepPlan& plan, const Stage& stage, Index total)
      : problem_(problem), plan_(plan), stage_(stage), n_(problem.mass.rows()), total_(total) {}

  std::optional<Refusal> free_step() {
    unknown_ = MatrixXd::Zero(n_, total_);
    if (!solves(stage_)) return std::nullopt;
    lu_.compute(weighted(problem_, stage_.matrix));
    for (std::size_t j = 0; j < stage_.history.size(); ++j)
      unknown_.middleCols(static_cast<Index>(j) * n_, n_) = weighted(problem_, stage_.history[j]);
    unknown_ = lu_.solve(unknown_);
    if (!unknown_.allFinite()) return Refusal{"the matrix of the step is singular"};
    return std::nullopt;
  }

  std::optional<Refusal> close(const Measure& measure, const ClosedContact& law, const PastEfforts& past) {
    const MatrixXd& H = problem_.contact;
    const Index points = H.rows();
    if (!solves(stage_)) return Refusal{"the scheme measures contact in a stage that solves nothing"};
    MatrixXd response = lu_.solve(H.transpose()), jumped;
    MatrixXd delassus = H * response;
    for (Index k = 1; k < static_cast<Index>(measure.effort.size()); ++k)
      unknown_.middleCols(past.at + (k - 1) * points, points) += measure.effort[static_cast<std::size_t>(k)] * response;
    double z = measure.value->z, weight = measure.effort.front();
    // What the effort moves z and w by, and the measure with them.
    if (measure.impulse != 0) {
      jumped = DenseLu(weighted(problem_, stage_.impulse->R)).solve(measure.impulse * H.transpose());
      if (!jumped.allFinite()) return Refusal{"the matrix R of the step's impulse is singular"};
      response = weight * response + lu_.solve(weighted(problem_, stage_.impulse->feed) * jumped);
      delassus = H * (z * response + measure.value->w * jumped);
      z = z != 0 || measure.value->w != 0 ? 1 : 0;
      weight = 1;
    }
    MatrixXd free = H * combine(*measure.value);
    if (law.evaluation) {
      const double stiffness = measure.before ? 0.5 * law.stiffness : law.stiffness;
      if (measure.before) free += H * combine(*measure.before);
      const MatrixXd A = MatrixXd::Identity(points, points) + stiffness * z * weight * delassus;
      effort_ = -stiffness * DenseLu(A).solve(free);
    } else {
      if (z == 0) return Refusal{"the scheme's impact measure does not see the effort of its own step"};
      // Points that depend on others share the effort among them: the least one that does it.
      effort_ = -least_norm_solve(z * weight * delassus, free);
    }
    unknown_ += weight * response * effort_;
    if (jumped.size() > 0) jump_ = jumped * effort_;
    if (!unknown_.allFinite()) return Refusal{"the closed contact has no finite step"};
    return std::nullopt;
  }

  // Σ w_j x_j + w_z z, over the state before the stage.
  MatrixXd combine(const Combination& c) const {
    MatrixXd rows = c.z * unknown_;
    if (jump_.size() > 0) rows += c.w * jump_;
    for (std::size_t j = 0; j < c.slots.size(); ++j)
      rows.middleCols(static_cast<Index>(j) * n_, n_).diagonal().array() += c.slots[j];
    return rows;
  }

  MatrixXd step(const PastEfforts& past) const {
    MatrixXd map = MatrixXd::Identity(total_, total_);
    for (std::size_t j = 0; j < plan_.slots.size(); ++j)
      map.middleRows(static_cast<Index>(j) * n_, n_) = combine(stage_.update[j]);
    // A stage without contact has found no effort.
    const Index points = problem_.contact.rows();
    for (Index k = past.levels; k-- > 1;) {
      map.middleRows(past.at + k * points, points).setZero();
      map.block(past.at + k * points, past.at + (k - 1) * points, points, points).setIdentity();
    }
    if (past.levels > 0 && effort_.size() > 0) map.middleRows(past.at, points) = effort_;
    if (past.levels > 0 && effort_.size() == 0) map.middleRows(past.at, points).setZero();
    return map;
  }

 private:
  const LinearProblem& problem_;
  const StepPlan& plan_;
  const Stage& stage_;
  Index n_, total_;
  DenseLu lu_;
  MatrixXd unknown_, jump_, effort_;  // z, w and p over the state
};

}  // namespace

StepMapOrRefusal step_map(const LinearProblem& problem, const StepPlan& plan, const ClosedContact& law) {
  const Index n = problem.mass.rows(), points = problem.contact.rows();
  PastEfforts past{n * static_cast<Index>(plan.slots.size()), 0};
  bool reads = false;
  for (const Stage& stage : plan.stages)
    if (const auto measure = points > 0 ? measure_of(stage, law) : std::nullopt) {
      past.levels = std::max(past.levels, static_cast<Index>(measure->effort.size()) - 1);
      reads = true;
    }
  const Index total = past.at + past.levels * points;
  if (points > 0 && !reads)
    return Refusal{law.evaluation ? "the time scheme offers no such evaluation of a compliant law"
                                  : "the time scheme has no impact measure for a rigid law"};
  MatrixXd whole = MatrixXd::Identity(total, total);
  for (std::size_t k = 0; k < plan.stages.size(); ++k) {
    StageRows rows(problem, plan, plan.stages[k], total);
    if (auto refusal = rows.free_step()) return *refusal;
    if (const auto measure = points > 0 ? measure_of(plan.stages[k], law) : std::nullopt)
      if (auto refusal = rows.close(*measure, law, past)) return *refusal;
    whole = rows.step(past) * whole;
  }
  return whole;
}

std::optional<MatrixXd> held_point_map(const StepPlan& plan) {
  if (plan.stages.size() != 1 || !plan.stages[0].impact || plan.stages[0].impact->value.z == 0) return std::nullopt;
  // Weighted past efforts are a state of their own; with w, H z does not follow from H x.
  if (plan.stages[0].impact->effort.size() != 1 || plan.stages[0].impulse) return std::nullopt;
  const Stage& stage = plan.stages[0];
  const Combination& held = stage.impact->value;
  const auto slots = static_cast<Index>(plan.slots.size());
  MatrixXd map = MatrixXd::Zero(slots, slots);
  for (Index j = 0; j < slots; ++j) {
    const Combination& update = stage.update[static_cast<std::size_t>(j)];
    for (std::size_t i = 0; i < update.slots.size(); ++i) map(j, static_cast<Index>(i)) = update.slots[i];
    for (std::size_t i = 0; i < held.slots.size(); ++i)
      map(j, static_cast<Index>(i)) -= update.z * held.slots[i] / held.z;
  }
  return map;
}

MatrixXd in_metres(MatrixXd step, const StepPlan& plan, double h, Index rows, double stiffness) {
  for (std::size_t j = 0; j < plan.slots.size(); ++j) {
    const auto& [position, velocity] = plan.initial[j];
    const double metres = position != 0 ? 1.0 : velocity != 0 ? h / velocity : h * h;
    step.middleRows(static_cast<Index>(j) * rows, rows) *= metres;
    step.middleCols(static_cast<Index>(j) * rows, rows) /= metres;
  }
  const Index efforts = step.rows() - rows * static_cast<Index>(plan.slots.size());
  step.bottomRows(efforts) /= stiffness;
  step.rightCols(efforts) *= stiffness;
  return step;
}

constexpr double triple_cluster = 5e-5;

std::vector<Root> step_roots(const MatrixXd& matrix, bool vectors) {
  if (!matrix.allFinite()) return {};
  MatrixXd A = matrix;
  const Eigen::VectorXd scale = balance(A);
  const GeneralModes modes = general_modes(A, vectors ? EigenVectors::wanted : EigenVectors::none);
  if (!modes.found) return {};
  const Eigen::VectorXcd& values = modes.values;
  const Eigen::MatrixXcd& all = modes.vectors;
  std::vector<Index> order(static_cast<std::size_t>(values.size()));
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<Index>(i);
  std::stable_sort(order.begin(), order.end(),
                   [&](Index a, Index b) { return std::abs(values[a]) > std::abs(values[b]); });
  std::vector<Root> roots;
  std::vector<bool> taken(order.size(), false);
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (taken[i]) continue;
    const std::complex<double> first = values[order[i]];
    // Roots −1 of a massless mode meet threefold where a scheme adds its own: known to the third root of round-off.
    const double near = first.real() < 0 ? triple_cluster : root_cluster;
    std::vector<Index> cluster;
    std::complex<double> sum = 0;
    for (std::size_t j = i; j < order.size(); ++j) {
      if (taken[j] || std::abs(values[order[j]] - first) > near * std::max(1.0, std::abs(first))) continue;
      taken[j] = true;
      cluster.push_back(order[j]);
      sum += values[order[j]];
    }
    Root root{sum / static_cast<double>(cluster.size()), static_cast<int>(cluster.size()), false, {}};
    if (vectors) {
      root.vector = scale.cast<std::complex<double>>().cwiseProduct(all.col(cluster.front()));
      if (cluster.size() > 1 && std::abs(root.value) > 0.5) {
        Eigen::MatrixXcd space(values.size(), static_cast<Index>(cluster.size()));
        for (std::size_t j = 0; j < cluster.size(); ++j)
          space.col(static_cast<Index>(j)) = all.col(cluster[j]).normalized();
        // Eigenvectors of a Jordan block of two come out parallel up to the square root of round-off.
        const Eigen::VectorXd sizes = singular_values(space);
        root.defective = sizes[sizes.size() - 1] < 1e-4 * sizes[0];
      }
    }
    roots.push_back(std::move(root));
  }
  return roots;
}

Eigen::MatrixXd amplification(const StepPlan& plan, double m, double c, double k) {
  const auto slots = static_cast<Eigen::Index>(plan.slots.size());
  Eigen::MatrixXd whole = Eigen::MatrixXd::Identity(slots, slots);
  for (const Stage& stage : plan.stages) {
    const double s = stage.matrix.M * m + stage.matrix.C * c + stage.matrix.K * k;
    Eigen::RowVectorXd unknown = Eigen::RowVectorXd::Zero(slots);
    if (stage.matrix.M != 0 || stage.matrix.C != 0 || stage.matrix.K != 0) {
      if (s == 0) return Eigen::MatrixXd::Constant(slots, slots, std::numeric_limits<double>::infinity());
      for (std::size_t j = 0; j < stage.history.size(); ++j) {
        const OperatorWeights& w = stage.history[j];
        unknown[static_cast<Eigen::Index>(j)] = (w.M * m + w.C * c + w.K * k) / s;
      }
    }
    Eigen::MatrixXd step = Eigen::MatrixXd::Zero(slots, slots);
    for (Eigen::Index j = 0; j < slots; ++j) {
      const Combination& update = stage.update[static_cast<std::size_t>(j)];
      for (std::size_t i = 0; i < update.slots.size(); ++i) step(j, static_cast<Eigen::Index>(i)) = update.slots[i];
      step.row(j) += update.z * unknown;
    }
    whole = step * whole;
  }
  return whole;
}

namespace {

// Slots that the position depends on, after however many steps. Others are kept for an energy or for who reads them;
// they have roots of their own that are none of the motion.
std::vector<Eigen::Index> moving_slots(const StepPlan& plan) {
  const Eigen::MatrixXd step = amplification(plan, 1, 0.7, 1.3);  // any mode: what is zero is so by structure
  std::vector<Eigen::Index> found = {0};
  for (std::size_t k = 0; k < found.size(); ++k)
    for (Eigen::Index j = 0; j < step.cols(); ++j)
      if (step(found[k], j) != 0 && std::find(found.begin(), found.end(), j) == found.end()) found.push_back(j);
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace

std::optional<double> root_at_infinity(const StepPlan& plan) {
  const double h = step_of(plan);
  const Eigen::MatrixXd step = amplification(plan, 0, 0, 1);
  // In like units: roots that coincide are lost in slots whose sizes differ by 1/h². Largest first; none where the step
  // is not finite.
  const Eigen::MatrixXd like = h > 0 ? in_metres(step, plan, h, 1) : step;
  const std::vector<Eigen::Index> moving = moving_slots(plan);
  const std::vector<Root> roots = step_roots(like(moving, moving), false);
  if (roots.empty()) return std::nullopt;
  // Zero may be a root of all slots that the spring has, four times in a chain: known to the fourth root of round-off.
  constexpr double nothing = 1e-3;
  const double root = std::abs(roots.front().value);
  return root < nothing ? 0 : root;
}

}  // namespace ricochet
