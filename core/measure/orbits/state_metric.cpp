#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <ricochet/engine/stage_state.hpp>
#include <ricochet/kernels/dense_solvers.hpp>
#include <ricochet/measure/orbits/set_steps.hpp>
#include <ricochet/measure/orbits/state_metric.hpp>
#include <ricochet/scene/semi_discrete.hpp>

namespace ricochet {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Which block of LaneState::efforts holds p₋ₖ at the beginning of a step: as Marcher lays them out.
StateVector::StateVector(const Program& program)
    : slots_(program.plan.slots.size() * static_cast<std::size_t>(program.model->rows())),
      points_(program.contact ? program.problem->points() : 0) {
  const auto stages = static_cast<std::ptrdiff_t>(program.stages.size());
  const auto reads = [&](std::ptrdiff_t i) { return program.stages[static_cast<std::size_t>(i)].reads_contact; };
  std::vector<std::size_t> blocks(program.stages.size(), 0);
  for (std::ptrdiff_t i = 0; i < stages; ++i)
    if (points_ > 0 && reads(i)) blocks[static_cast<std::size_t>(i)] = 1;
  for (std::ptrdiff_t i = 0; i < stages; ++i) {
    if (points_ == 0 || !reads(i)) continue;
    const StageProgram& stage = program.stages[static_cast<std::size_t>(i)];
    const auto weights = static_cast<std::ptrdiff_t>(std::max(stage.effort.size(), stage.work_effort.size()));
    for (std::ptrdiff_t k = 1; k < weights; ++k) {
      const auto [j, steps] = place_in_steps(i - k, stages);
      if (!reads(j)) continue;
      std::size_t& count = blocks[static_cast<std::size_t>(j)];
      count = std::max(count, (j > i ? steps - 1 : steps) + 1);
    }
  }
  for (int k = 1; k <= past_efforts(program); ++k) {
    const auto [j, steps] = place_in_steps(-k, stages);
    std::ptrdiff_t begin = 0;
    for (std::ptrdiff_t i = 0; i < j; ++i) begin += static_cast<std::ptrdiff_t>(blocks[static_cast<std::size_t>(i)]);
    const bool there = points_ > 0 && reads(j) && steps - 1 < blocks[static_cast<std::size_t>(j)];
    efforts_.push_back(there ? (begin + static_cast<std::ptrdiff_t>(steps) - 1) * points_ : -1);
  }
}

VectorXd StateVector::read(const LaneState& state) const {
  VectorXd x = VectorXd::Zero(size());
  std::copy_n(state.slots.begin(), slots_, x.data());
  double* to = x.data() + slots_;
  for (const std::ptrdiff_t from : efforts_) {
    if (from >= 0) std::copy_n(state.efforts.begin() + from, points_, to);
    to += points_;
  }
  return x;
}

void StateVector::write(const VectorXd& x, LaneState& state) const {
  std::copy_n(x.data(), slots_, state.slots.begin());
  const double* from = x.data() + slots_;
  for (const std::ptrdiff_t to : efforts_) {
    if (to >= 0) std::copy_n(from, points_, state.efforts.begin() + to);
    from += points_;
  }
}

namespace {

// The nodal displacements of a structure: of an element with slopes the first and the third dof of four.
std::vector<int> displacements_of(const SemiDiscrete& problem) {
  std::vector<int> dofs;
  const auto add = [&](int dof) {
    if (dof >= 0 && std::find(dofs.begin(), dofs.end(), dof) == dofs.end()) dofs.push_back(dof);
  };
  const bool hermite = problem.space.basis == FiniteElementSpace::Basis::hermite;
  for (const FiniteElementSpace::Element& element : problem.space.elements)
    for (const int local : {0, hermite ? 2 : 1}) add(element.dof[static_cast<std::size_t>(local)]);
  if (dofs.empty())
    for (int i = 0; i < problem.dofs(); ++i) add(i);
  return dofs;
}

}  // namespace

StateMetric::StateMetric(const Program& program, int state_size, const ArcUnits& units)
    : metres_(units.parameter), pulsation_(units.pulsation) {
  const SemiDiscrete& problem = *program.problem;
  const MarchModel& model = *program.model;
  const int rows = model.rows();
  MatrixXd readings;  // of a slot
  if (problem.in_modes()) {
    readings = model.tip().dense(rows);
  } else {
    const std::vector<int> dofs = displacements_of(problem);
    readings.resize(static_cast<Index>(dofs.size()), rows);
    for (int i = 0; i < rows; ++i) {
      const VectorXd nodal = model.to_nodal(VectorXd::Unit(rows, i));
      for (std::size_t d = 0; d < dofs.size(); ++d) readings(static_cast<Index>(d), i) = nodal[dofs[d]];
    }
  }
  readings /= std::sqrt(static_cast<double>(readings.rows()));
  const double omega = units.pulsation;
  const auto& initial = program.plan.initial;
  rows_ = MatrixXd::Zero(readings.rows() * static_cast<Index>(initial.size()), state_size);
  for (std::size_t j = 0; j < initial.size(); ++j) {
    const auto& [position, velocity] = initial[j];
    const double weight =
        position != 0 ? 1.0 : (velocity != 0 ? 1 / (std::abs(velocity) * omega) : 1 / (omega * omega));
    rows_.block(static_cast<Index>(j) * readings.rows(), static_cast<Index>(j) * rows, readings.rows(), rows) =
        weight * readings;
  }
  // Of slots a_j q + b_j v the q and v of least squares; columns are scaled to their largest number.
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  double largest = 0;
  for (const auto& [position, velocity] : initial) largest = std::max(largest, std::abs(velocity));
  if (largest == 0) largest = 1;
  std::vector<Eigen::Vector2d> parts;
  for (const auto& [position, velocity] : initial) {
    parts.emplace_back(position, velocity / largest);
    normal += parts.back() * parts.back().transpose();
  }
  const Eigen::Matrix2d inverse = least_norm_solve(normal, Eigen::Matrix2d::Identity());
  displacement_ = velocity_ = MatrixXd::Zero(readings.rows(), state_size);
  for (std::size_t j = 0; j < initial.size(); ++j) {
    const Eigen::Vector2d share = inverse * parts[j];
    displacement_.middleCols(static_cast<Index>(j) * rows, rows) = share[0] * readings;
    velocity_.middleCols(static_cast<Index>(j) * rows, rows) = share[1] / largest * readings;
  }
}

double StateMetric::size(const VectorXd& x, double parameter) const {
  return std::hypot((rows_ * x).norm(), metres_ * parameter);
}

}  // namespace ricochet
