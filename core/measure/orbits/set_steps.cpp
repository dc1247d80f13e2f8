#include <algorithm>
#include <cmath>
#include <ricochet/measure/orbits/set_steps.hpp>
#include <ricochet/scene/semi_discrete.hpp>

namespace ricochet {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

// The slopes of the law, which knows its parameters once it is prepared, as Marcher does it; none: rigid, or not
// linear.
std::optional<ContactSlopes> slopes_of(const Program& program) {
  if (!program.law->reads()) return std::nullopt;
  program.law->prepare(program.problem->points(),
                       std::vector<Parameters>(static_cast<std::size_t>(program.width), program.lanes.front().law));
  return program.law->linear_slopes(0);
}

// κ of the law as this program evaluates it; 0: rigid.
double spring_of(const Program& program) {
  const auto slopes = slopes_of(program);
  return slopes ? slopes->stiffness : 0;
}

}  // namespace

int past_efforts(const Program& program) {
  int past = 0;
  if (!program.contact || program.problem->points() == 0) return past;
  for (const StageProgram& stage : program.stages)
    if (stage.reads_contact) past = std::max(past, static_cast<int>(stage.effort.size()) - 1);
  return past;
}

std::optional<std::string> SetSteps::refusal(const Program& program) {
  for (const StageProgram& stage : program.stages) {
    if (stage.gate) return "its stops are closed by velocities";
    if (stage.restores > 0) return "a stage gives back the work of another one";
    if (stage.impulse.op) return "an effort moves a second unknown";
    if (stage.compliance && stage.compliance->before && program.contact) return "its force is a mean over the step";
    if (stage.reads_contact && !program.law->reads() && stage.reach == 0)
      return "its impact measure does not see the effort of its own step";
  }
  if (!program.contact) return std::nullopt;
  if (!program.problem->circles().empty()) return "the force of a circle turns with its point";
  if (std::count_if(program.stages.begin(), program.stages.end(), [](const auto& one) { return one.reads_contact; }) >
      1)
    return "several of its stages read contact";
  if (!program.problem->motions.empty()) return "supports or stops move by histories";
  if (program.law->memory_per_point() > 0) return "its law keeps a memory";
  if (program.own_sets) return "its stops have parameters of their own";
  if (program.law->reads()) {
    const auto slopes = slopes_of(program);
    if (!slopes) return "its law is not linear";
    if (slopes->viscosity != 0 || slopes->before != 0) return "its law has a damper, or a mean over the step";
  }
  if (program.problem->damping.matrix && program.model->modal()) return "its damping matrix is not that of its modes";
  return std::nullopt;
}

SetSteps::SetSteps(const Program& program)
    : program_(&program), rows_(program.model->rows()), slots_(static_cast<int>(program.plan.slots.size())) {
  const MarchModel& model = *program.model;
  const SemiDiscrete& problem = *program.problem;
  layout_.points = program.contact ? problem.points() : 0;
  layout_.loads = program.load ? rows_ * static_cast<int>(program.stages.size()) : 0;
  const MatrixXd K(model.stiffness()), M = dense_mass(model.inertia());
  MatrixXd C = problem.damping.stiffness * K + problem.damping.mass * M;
  if (model.modal_damping().size() > 0)
    C = model.modal_damping().asDiagonal();
  else if (problem.damping.matrix)
    C = MatrixXd(*problem.damping.matrix);
  const auto weighted = [&](const OperatorWeights& w) -> MatrixXd { return w.M * M + w.C * C + w.K * K; };
  if (layout_.points > 0) contact_ = model.measured().dense(rows_);
  const double omega = problem.support.pulsation;
  for (std::size_t k = 0; k < program.stages.size(); ++k) {
    const StageProgram& folded = program.stages[k];
    const ricochet::Stage& plan = program.plan.stages[k];
    Stage& stage = stages_.emplace_back();
    stage.solves = folded.op != nullptr;
    stage.reads = layout_.points > 0 && folded.reads_contact;
    if (stage.reads) reading_.push_back(static_cast<int>(k));
    stage.history = MatrixXd::Zero(rows_, rows_ * slots_);
    stage.free_drive = MatrixXd::Zero(rows_, layout_.size());
    if (!stage.solves) continue;
    stage.system.compute(weighted(plan.matrix));
    for (std::size_t j = 0; j < plan.history.size(); ++j)
      stage.history.middleCols(static_cast<Index>(j) * rows_, rows_) = weighted(plan.history[j]);
    stage.history = stage.system.solve(stage.history);
    if (program.support) {
      stage.free_drive.col(0) = omega * omega * folded.load_phase.along * model.support_shape();
      stage.free_drive.col(1) = omega * omega * folded.load_phase.across * model.support_shape();
    }
    if (layout_.loads > 0)
      stage.free_drive.middleCols(layout_.load() + static_cast<Index>(k) * rows_, rows_).setIdentity();
    stage.free_drive = stage.system.solve(stage.free_drive);
    if (!stage.reads) continue;
    stage.response = stage.system.solve(contact_.transpose());
    stage.delassus = contact_ * stage.response;
    stage.stiffness = spring_of(program);
  }
  past_ = ricochet::past_efforts(program);
  size_ = rows_ * slots_ + past_ * layout_.points;
  number({});
}

int SetSteps::row_of(const SetPoint& at) const {
  const auto stage = std::find(reading_.begin(), reading_.end(), at.stage) - reading_.begin();
  return static_cast<int>(stage) * layout_.points + at.point;
}

MatrixXd SetSteps::combine(const Combination& c, const MatrixXd& now, const MatrixXd& z) const {
  MatrixXd sum = c.z * z;
  for (std::size_t j = 0; j < c.slots.size(); ++j)
    if (c.slots[j] != 0) sum += c.slots[j] * now.middleRows(static_cast<Index>(j) * rows_, rows_);
  return sum;
}

// Of the closed points of a stage, rows of `measured` from `first` on: where the law closes what they lack.
MatrixXd SetSteps::closing_efforts(std::size_t k, const std::vector<Index>& closed, const MatrixXd& measured,
                                   Index first, SetStep& step) const {
  const Stage& stage = stages_[k];
  const double reach = program_->stages[k].reach;
  MatrixXd effort = MatrixXd::Zero(layout_.points, measured.cols());
  const auto count = static_cast<Index>(closed.size());
  MatrixXd system(count, count), lacks(count, measured.cols());
  for (Index a = 0; a < count; ++a) {
    const Index i = closed[static_cast<std::size_t>(a)];
    const bool upper = step.side[static_cast<std::size_t>(first + i)] > 0;
    lacks.row(a) = -measured.row(i);
    lacks(a, size_ + (upper ? layout_.upper(static_cast<int>(i)) : layout_.lower(static_cast<int>(i)))) += 1;
    for (Index b = 0; b < count; ++b) system(a, b) = reach * stage.delassus(i, closed[static_cast<std::size_t>(b)]);
    if (stage.stiffness > 0) system(a, a) += 1 / stage.stiffness;
  }
  const MatrixXd found = DenseLu(system).solve(lacks);
  for (Index a = 0; a < count; ++a) effort.row(closed[static_cast<std::size_t>(a)]) = found.row(a);
  const MatrixXd inverted = inverse(system);
  for (Index a = 0; a < count; ++a)
    step.give[static_cast<std::size_t>(first + closed[static_cast<std::size_t>(a)])] = 1 / inverted(a, a);
  return effort;
}

SetStep SetSteps::make(const ContactSet& set) const {
  const Program& program = *program_;
  const Index total = size_ + layout_.size(), points = layout_.points;
  MatrixXd now = MatrixXd::Zero(size_, total);
  now.leftCols(size_).setIdentity();
  MatrixXd measured = MatrixXd::Zero(measure_rows(), total);
  SetStep step;
  step.closed = set;
  step.side.assign(static_cast<std::size_t>(measure_rows()), 0);
  step.give.assign(static_cast<std::size_t>(measure_rows()), 0);
  Index reading = 0;
  for (std::size_t k = 0; k < stages_.size(); ++k) {
    const Stage& stage = stages_[k];
    const StageProgram& folded = program.stages[k];
    MatrixXd z = MatrixXd::Zero(rows_, total), effort = MatrixXd::Zero(points, total);
    if (stage.solves) {
      z = stage.history * now.topRows(slots_size());
      z.rightCols(layout_.size()) += stage.free_drive;
    }
    if (stage.reads) {
      for (std::size_t ago = 1; ago < folded.effort.size(); ++ago)
        z += folded.effort[ago] * stage.response *
             now.middleRows(slots_size() + (static_cast<Index>(ago) - 1) * points, points);
      MatrixXd y = contact_ * combine(folded.measure, now, z);
      if (program.support) {
        y.col(size_).array() += folded.measure_phase.along;
        y.col(size_ + 1).array() += folded.measure_phase.across;
      }
      std::vector<Index> active;
      for (const SetPoint& one : set)
        if (one.stage == static_cast<int>(k)) {
          active.push_back(one.point);
          step.side[static_cast<std::size_t>(reading * points + one.point)] = one.upper ? 1 : -1;
        }
      if (!active.empty()) {
        effort = closing_efforts(k, active, y, reading * points, step);
        y += folded.reach * stage.delassus * effort;
        z += folded.effort[0] * stage.response * effort;
      }
      for (Index i = 0; i < points; ++i)
        measured.row(reading * points + i) =
            step.side[static_cast<std::size_t>(reading * points + i)] == 0 ? y.row(i) : effort.row(i);
      ++reading;
    }
    MatrixXd next = now;
    for (int j = 0; j < slots_; ++j)
      next.middleRows(static_cast<Index>(j) * rows_, rows_) =
          combine(program.plan.stages[k].update[static_cast<std::size_t>(j)], now, z);
    for (Index ago = past_; ago-- > 1;)
      next.middleRows(slots_size() + ago * points, points) = now.middleRows(slots_size() + (ago - 1) * points, points);
    if (past_ > 0) next.middleRows(slots_size(), points) = effort;
    now = std::move(next);
  }
  step.state.resize(size_ + measure_rows(), size_);
  step.drive.resize(size_ + measure_rows(), layout_.size());
  step.state << now.leftCols(size_), measured.leftCols(size_);
  step.drive << now.rightCols(layout_.size()), measured.rightCols(layout_.size());
  return step;
}

int SetSteps::number(const ContactSet& set) {
  const auto [place, added] = numbers_.try_emplace(set, count());
  if (added) {
    steps_.push_back(make(set));
    strides_.emplace_back();
  }
  return place->second;
}

int SetSteps::toggled(int number, int row, bool upper) {
  ContactSet set = steps_[static_cast<std::size_t>(number)].closed;
  SetPoint at = place(row);
  const auto found = std::find_if(set.begin(), set.end(),
                                  [&](const SetPoint& one) { return one.stage == at.stage && one.point == at.point; });
  if (found != set.end()) {
    set.erase(found);
  } else {
    at.upper = upper;
    set.insert(std::upper_bound(set.begin(), set.end(), at), at);
  }
  return this->number(set);
}

bool SetSteps::mirrors(int one, int other) const {
  const std::vector<int>&a = (*this)[one].side, &b = (*this)[other].side;
  return std::equal(a.begin(), a.end(), b.begin(), [](int x, int y) { return x == -y; });
}

const MatrixXd& SetSteps::power(int number, std::size_t k) {
  std::vector<MatrixXd>& powers = strides_[static_cast<std::size_t>(number)].state;
  if (powers.empty()) powers.push_back((*this)[number].state.topRows(size_));
  while (powers.size() <= k) powers.push_back(powers.back() * powers.back());
  return powers[k];
}

std::size_t SetSteps::longest_stride() const {
  constexpr std::size_t most = 6;
  std::size_t k = 0;
  while (k < most && (measure_rows() << (k + 1)) <= size_) ++k;
  return k;
}

// B r so many steps later, over r now.
MatrixXd SetSteps::turned(MatrixXd drive, long long steps) const {
  const double angle = program_->problem->support.pulsation * (static_cast<double>(steps) * program_->h);
  const double c = std::cos(angle), s = std::sin(angle);
  const Eigen::VectorXd sine = drive.col(0), cosine = drive.col(1);
  drive.col(0) = c * sine - s * cosine;
  drive.col(1) = s * sine + c * cosine;
  return drive;
}

const SetStrides& SetSteps::strides(int number, std::size_t k) {
  power(number, k);
  SetStrides& out = strides_[static_cast<std::size_t>(number)];
  const SetStep& step = (*this)[number];
  const Index rows = measure_rows(), bounds = layout_.load();
  if (out.drive.empty()) {
    out.drive.push_back(step.drive.topLeftCorner(size_, bounds));
    out.measured = step.state.bottomRows(rows);
    out.measured_drive = step.drive.bottomLeftCorner(rows, bounds);
  }
  while (out.drive.size() <= k) {
    const std::size_t last = out.drive.size() - 1;
    const MatrixXd &A = out.state[last], &B = out.drive[last];
    MatrixXd measured(2 * out.measured.rows(), size_), measured_drive(2 * out.measured.rows(), bounds);
    measured << out.measured, out.measured * A;
    measured_drive << out.measured_drive, out.measured * B + turned(out.measured_drive, 1LL << last);
    out.measured = std::move(measured);
    out.measured_drive = std::move(measured_drive);
    out.drive.push_back(A * B + turned(B, 1LL << last));
  }
  return out;
}

void SetSteps::apply(int number, long long count, MatrixXd& columns) {
  for (std::size_t k = 0; (count >> k) != 0; ++k)
    if ((count >> k) & 1) columns = power(number, k) * columns;
}

void SetSteps::apply_transposed(int number, long long count, MatrixXd& columns) {
  for (std::size_t k = 0; (count >> k) != 0; ++k)
    if ((count >> k) & 1) columns = power(number, k).transpose() * columns;
}

}  // namespace ricochet
