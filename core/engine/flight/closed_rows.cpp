#include <algorithm>
#include <bit>
#include <cmath>
#include <ricochet/engine/flight/closed_steps.hpp>
#include <ricochet/engine/flight/flight_motion.hpp>
#include <ricochet/engine/stage_state.hpp>
#include <ricochet/kernels/dense_solvers.hpp>

namespace ricochet {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::RowVectorXd;
using Eigen::VectorXd;

std::vector<double> numbers(const VectorXd& v) {
  return {v.data(), v.data() + v.size()};
}

// c with r = c s; 0 where there is none.
double ratio_of(const Combination& s, const Combination& r) {
  const std::vector<double> a = slot_weights(s), b = slot_weights(r);
  const auto largest =
      std::max_element(a.begin(), a.end(), [](double x, double y) { return std::abs(x) < std::abs(y); });
  if (*largest == 0) return 0;
  const double ratio = b[static_cast<std::size_t>(largest - a.begin())] / *largest;
  constexpr double round_off = 1e-14;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (std::abs(b[i] - ratio * a[i]) > round_off * std::abs(b[i])) return 0;
  return ratio;
}

}  // namespace

ClosedRows::ClosedRows(const Program& program, FlightSet& free, std::vector<ClosedPoint> closed)
    : closed_(std::move(closed)),
      rows_(&free.step_rows()),
      drive_(rows_->drive()),
      modes_(rows_->modes()),
      slots_(rows_->slots()),
      drives_(drive_.count()),
      contact_(program.model->contact().dense(modes_)),
      mass_(program.model->inertia().mass.diagonal()) {
  for (const StageProgram& stage : program.stages) {
    first_.push_back(stage.reads_contact ? static_cast<int>(m_) : -1);
    if (stage.reads_contact) m_ += closed_.size();
  }
  for (const ClosedPoint& point : closed_)
    for (int mode = 0; mode < modes_; ++mode) closed_contact_.push_back(contact_(point.point, mode));
  find_memory(program);
  for (std::size_t q = 0; q <= memory_; ++q) {
    std::vector<EffortResponse>& of_steps = responses_.emplace_back();
    for (int stage = 0; stage < stages(); ++stage)
      for (std::size_t i = 0; reads(stage) && i < closed_.size(); ++i) {
        const EffortResponse& one =
            of_steps.emplace_back(program, stage, static_cast<int>(q), contact_.row(closed_[i].point).transpose());
        if (!one.none()) {
          const MatrixXd& moved = one.change();
          change.emplace_back(q * m_ + of_steps.size() - 1,
                              std::vector<double>(moved.data(), moved.data() + moved.size()));
        }
      }
  }
  add_points(program);
  add_balances(program);
  Combination position;
  position.slots = {1};
  const RowVectorXd here = harmonic(PhaseWeights({{0, 1}}, program.problem->support.pulsation, program.h), drive_);
  for (const ClosedPoint& point : closed_) start.push_back(row_of(0, position, contact_.row(point.point), here));
  tip = row_of(0, position, program.model->tip().dense(modes_).row(0), here);
  add_reach(free);
  responses_.clear();
  rows_ = nullptr;
}

// As far as the equations and the works look back.
void ClosedRows::find_memory(const Program& program) {
  for (int stage = 0; stage < stages(); ++stage) {
    const StageProgram& one = program.stages[static_cast<std::size_t>(stage)];
    const std::size_t weights = std::max(one.effort.size(), one.work_effort.size());
    for (std::size_t k = 0; one.reads_contact && k < weights; ++k)
      memory_ = std::max(memory_, place_in_steps(stage - static_cast<std::ptrdiff_t>(k), stages()).second);
  }
}

ClosedRows::Row ClosedRows::row_of(int stage, const Combination& c, const RowVectorXd& at_point,
                                   const RowVectorXd& drive) const {
  Row row;
  MatrixXd weights = MatrixXd::Zero(modes_, slots_);
  RowVectorXd e = drive;
  for (int mode = 0; mode < modes_; ++mode) {
    const RowVectorXd own = rows_->of(mode, stage, c);
    weights.row(mode) = at_point[mode] * own.head(slots_);
    e += at_point[mode] * own.tail(drives_);
  }
  int begin = 0, end = slots_;
  while (begin < end && weights.col(begin).isZero(0)) ++begin;
  while (end > begin && weights.col(end - 1).isZero(0)) --end;
  row.first = static_cast<std::size_t>(begin) * static_cast<std::size_t>(modes_);
  row.x.assign(weights.data() + static_cast<Index>(begin) * modes_, weights.data() + static_cast<Index>(end) * modes_);
  std::copy_n(e.data(), drives_, row.e.begin());
  for (const auto& of_steps : responses_)
    for (const EffortResponse& response : of_steps) row.p.push_back(at_point.dot(response.of(stage, c)));
  return row;
}

ClosedRows::Vector ClosedRows::vector_of(int stage, const Combination& c) const {
  Vector vector;
  vector.table.resize(static_cast<std::size_t>(slots_ + drives_) * static_cast<std::size_t>(modes_));
  for (int mode = 0; mode < modes_; ++mode) {
    const RowVectorXd own = rows_->of(mode, stage, c);
    for (Index k = 0; k < own.size(); ++k) vector.table[static_cast<std::size_t>(k * modes_ + mode)] = own[k];
  }
  for (std::size_t q = 0; q < responses_.size(); ++q)
    for (std::size_t i = 0; i < m_; ++i)
      if (const VectorXd column = responses_[q][i].of(stage, c); !column.isZero(0))
        vector.p.emplace_back(q * m_ + i, numbers(column));
  return vector;
}

// The row of a spring takes all slots.
void ClosedRows::add_to_law(Point& point, const Row& row, double factor) const {
  Row& law = point.law;
  if (law.x.empty()) {
    law.x.assign(static_cast<std::size_t>(slots_ * modes_), 0.0);
    law.p.assign(row.p.size(), 0.0);
  }
  for (std::size_t i = 0; i < row.x.size(); ++i) law.x[row.first + i] += factor * row.x[i];
  for (std::size_t i = 0; i < 3; ++i) law.e[i] += factor * row.e[i];
  for (std::size_t i = 0; i < row.p.size(); ++i) law.p[i] += factor * row.p[i];
}

void ClosedRows::add_points(const Program& program) {
  const LaneSpec& lane = program.lanes.front();
  const double omega = program.problem->support.pulsation;
  rigid = !program.law->reads();
  const auto slopes_of = [&](const ClosedPoint& closed) {
    return rigid ? ContactSlopes{} : *program.law->linear_slopes(program.law_set(closed.point, 0));
  };
  for (const ClosedPoint& closed : closed_) {
    const ContactSlopes slopes = slopes_of(closed);
    damps = damps || slopes.viscosity != 0;
    means = means || slopes.before != 0;
  }
  MatrixXd W(m_, m_);
  for (int at = 0; at < stages(); ++at) {
    if (!reads(at)) continue;
    const StageProgram& stage = program.stages[static_cast<std::size_t>(at)];
    Combination position;
    position.slots = {1};
    for (const ClosedPoint& closed : closed_) {
      const RowVectorXd h = contact_.row(closed.point);
      const ContactSlopes slopes = slopes_of(closed);
      Point point;
      point.viscosity = slopes.viscosity;
      point.side = closed.lower ? 1 : -1;
      point.stop = closed.lower ? lane.lower[closed.point] : lane.upper[closed.point];
      point.place = row_of(at, position, h, harmonic(PhaseWeights({{stage.facts.from, 1}}, omega, program.h), drive_));
      point.depth = row_of(at, stage.measure, h, harmonic(stage.measure_phase, drive_));
      if (rigid) {
        point.law = point.depth;
        point.target = point.stop;
      } else {
        add_to_law(point, point.depth, slopes.stiffness);
        point.target = (slopes.stiffness + slopes.before) * point.stop;
        if (damps) {
          RowVectorXd turned = RowVectorXd::Zero(drives_);
          if (drive_.support) turned.head(2) << -omega * stage.rate_phase.across, omega * stage.rate_phase.along;
          point.rate = row_of(at, stage.compliance->rate, h, turned);
          add_to_law(point, point.rate, slopes.viscosity);
        }
        if (means) {
          point.before = row_of(at, *stage.compliance->before, h, harmonic(stage.before_phase, drive_));
          add_to_law(point, point.before, slopes.before);
        }
      }
      const auto row = static_cast<Index>(points.size());
      for (std::size_t i = 0; i < m_; ++i) W(row, static_cast<Index>(i)) = point.law.p[i];
      if (!rigid) W(row, row) += 1;
      std::fill_n(point.law.p.begin(), m_, 0.0);
      points.push_back(std::move(point));
      momentum.push_back(stage.momentum);
    }
  }
  const MatrixXd inverse = DenseLu(W).solve(MatrixXd::Identity(W.rows(), W.cols()));
  for (Index i = 0; i < inverse.rows(); ++i)
    for (Index j = 0; j < inverse.cols(); ++j) solution.push_back(inverse(i, j));
}

void ClosedRows::add_balances(const Program& program) {
  const Damping& damping = program.problem->damping;
  for (int at = 0; at < stages(); ++at) {
    const Stage& plan = program.plan.stages[static_cast<std::size_t>(at)];
    const StageProgram& stage = program.stages[static_cast<std::size_t>(at)];
    Balance balance;
    balance.stage = at;
    balance.first = first(at);
    for (const LossTerm& term : plan.loss) {
      if (term.coefficient == 0) continue;
      const VectorXd weight = term.matrix == EnergyMatrix::M ? mass_ : VectorXd::Ones(modes_);
      balance.losses.push_back({vector_of(at, term.value), numbers(term.coefficient * weight)});
    }
    if (plan.work) {
      const WorkForm& work = *plan.work;
      balance.displacement = vector_of(at, work.displacement);
      if (program.problem->damped()) {
        VectorXd of_modes = (damping.stiffness + damping.mass * mass_.array()).matrix();
        if (const VectorXd& own = program.model->modal_damping(); own.size() > 0) of_modes += own;
        balance.damping = numbers(of_modes);
        balance.along = ratio_of(work.displacement, work.rate);
        if (balance.along == 0) balance.rate = vector_of(at, work.rate);
      }
      if (program.support || program.load) {
        const MatrixXd load = load_over_drive(program, work.load, drive_);
        for (int k = 0; k < drives_; ++k)
          if (!load.col(k).isZero(0)) balance.loads.emplace_back(k, numbers(load.col(k)));
      }
      const RowVectorXd lift =
          harmonic(PhaseWeights(work.support, program.problem->support.pulsation, program.h), drive_);
      std::copy_n(lift.data(), drives_, balance.lift.begin());
      for (std::size_t k = 0; reads(at) && k < stage.work_effort.size(); ++k) {
        const auto [source, steps] = place_in_steps(at - static_cast<std::ptrdiff_t>(k), stages());
        if (reads(source))
          balance.work_effort.emplace_back(steps * m_ + static_cast<std::size_t>(first(source)), stage.work_effort[k]);
      }
    }
    if (plan.work || !balance.losses.empty()) balances.push_back(std::move(balance));
  }
}

void ClosedRows::add_reach(FlightSet& free) {
  FlightBound& bound = free.bound();
  const auto count = static_cast<std::size_t>(contact_.rows());
  const int powers = std::bit_width(static_cast<unsigned long long>(ClosedSteps::longest));
  const double still[3] = {};
  reach.resize(static_cast<std::size_t>(bound.watches()));
  for (int w = 0; w < bound.watches(); ++w)
    reach[static_cast<std::size_t>(w)].assign(static_cast<std::size_t>(powers), std::vector<double>(count * m_, 0.0));
  for (const auto& of_steps : responses_)
    for (std::size_t i = 0; i < m_; ++i) {
      const EffortResponse& response = of_steps[i];
      if (response.none()) continue;
      bound.set_state(response.change().data(), still);
      for (int w = 0; w < bound.watches(); ++w) {
        const FlightWatch& watch = bound.watch(w);
        const VectorXd at_once = watch.rows * response.of(watch.stage, watch.value);
        for (int power = 0; power < powers; ++power)
          for (std::size_t j = 0; j < count; ++j) {
            const FlightBound::Range range = bound.range(w, static_cast<int>(j), 1LL << power);
            reach[static_cast<std::size_t>(w)][static_cast<std::size_t>(power)][j * m_ + i] +=
                std::max({-range.low, range.high, std::abs(at_once[static_cast<Index>(j)])});
          }
      }
    }
}

}  // namespace ricochet
