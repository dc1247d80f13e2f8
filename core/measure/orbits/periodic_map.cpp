#include <algorithm>
#include <cmath>
#include <ricochet/engine/march_loads.hpp>
#include <ricochet/kernels/instruction_set.hpp>
#include <ricochet/measure/orbits/multipliers.hpp>
#include <ricochet/measure/orbits/periodic_map.hpp>

namespace ricochet {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

class PeriodicMap::Recorder final : public StepObserver {
 public:
  Recorder(SetSteps& sets, bool depth) : sets_(sets), depth_(depth) {}
  void stage_solved(const Marcher& marcher, const StageView& view) override {
    if (view.contact_lanes == 0) return;
    for (const int point : view.pushed)
      set_.push_back({view.stage, point, view.effort[0][static_cast<std::ptrdiff_t>(point) * marcher.width()] < 0});
  }
  void step_done(Marcher& marcher) override {
    found.push_back(set_.empty() ? 0 : sets_.number(set_));
    if (depth_ && !set_.empty()) deepest = std::max(deepest, marcher.penetration(0));
    set_.clear();
  }
  SetSequence found;
  double deepest = 0;

 private:
  SetSteps& sets_;
  bool depth_;
  ContactSet set_;
};

namespace {

Program checked(Program program) {
  if (const auto reason = SetSteps::refusal(program)) throw Refusal{*reason};
  return program;
}

}  // namespace

PeriodicMap::PeriodicMap(Program program, AffineLane lanes, const ArcUnits& units, AffineLoad load)
    : marcher_(checked(std::move(program))),
      lanes_(std::move(lanes)),
      sets_(marcher_.program()),
      vector_(marcher_.program()),
      metric_(marcher_.program(), sets_.state_size(), units),
      massless_roots_(ricochet::massless_roots(marcher_.program(), sets_)),
      template_(marcher_.lane_state(0)),
      tip_(marcher_.program().model->tip().dense(marcher_.program().model->rows()).row(0)),
      affine_load_(std::move(load)) {}

double PeriodicMap::tip(const VectorXd& x, double parameter) const {
  const double A = lanes_.origin.amplitude + (parameter - lanes_.at) * lanes_.amplitude;
  return tip_.dot(x.head(tip_.size())) + A * std::sin(lanes_.origin.phase);
}

Marcher& PeriodicMap::marcher_at(double parameter) {
  if (!affine_load_.program || parameter == lanes_.at) return marcher_;
  if (!other_ || other_at_ != parameter) {
    other_.reset();
    other_.emplace(affine_load_.program(parameter));
    other_at_ = parameter;
  }
  return *other_;
}

Marcher& PeriodicMap::begin(const VectorXd& x, double parameter) {
  Marcher& marcher = marcher_at(parameter);
  LaneState state = template_;
  vector_.write(x, state);
  marcher.set_clock(0);
  marcher.set_lane(0, lanes_.lane(parameter), state);
  return marcher;
}

MapMarch PeriodicMap::march(const VectorXd& x, double parameter, const MapClock& clock, bool read) {
  MapMarch made;
  Marcher& marcher = begin(x, parameter);
  Recorder recorder(sets_, read);
  const long long steps = clock.steps();
  recorder.found.reserve(static_cast<std::size_t>(steps));
  if (read) {
    const StrobeTip tip = march_over(marcher, clock, &recorder);
    made.tip = tip.displacement;
    made.tip_velocity = tip.velocity;
  } else {
    marcher.march(steps, &recorder);
  }
  made.end = marcher.status(0).end;
  made.image = clock.sign() * vector_.read(marcher.lane_state(0));
  made.sets = std::move(recorder.found);
  made.penetration = recorder.deepest;
  return made;
}

MatrixXd PeriodicMap::derivative(const SetSequence& sets, const MapClock& clock, const std::vector<SetBlend>& blends) {
  MatrixXd product = MatrixXd::Identity(size(), size());
  auto blend = blends.begin();
  for (std::size_t begin = 0; begin < sets.size();) {
    if (blend != blends.end() && blend->step == begin) {
      double own = 1;
      for (auto one = blend; one != blends.end() && one->step == begin; ++one) own -= one->weight;
      MatrixXd step =
          own * sets_[sets[begin]].state.topRows(size()) + blend->weight * sets_[blend->other].state.topRows(size());
      for (++blend; blend != blends.end() && blend->step == begin; ++blend)
        step += blend->weight * sets_[blend->other].state.topRows(size());
      product = step * product;
      ++begin;
      continue;
    }
    const std::size_t stop = blend != blends.end() ? blend->step : sets.size();
    std::size_t end = begin;
    while (end < stop && sets[end] == sets[begin]) ++end;
    sets_.apply(sets[begin], static_cast<long long>(end - begin), product);
    begin = end;
  }
  return clock.sign() * product;
}

void PeriodicMap::set_period(int steps_per_period) {
  if (clocked_ == steps_per_period) return;
  clocked_ = steps_per_period;
  const Program& own = program();
  const double omega = own.problem->support.pulsation, phase = lanes_.origin.phase;
  sine_ = cosine_ = std::vector<double>();
  for (int k = 0; k < steps_per_period; ++k) {
    const double angle = omega * (k * own.h);
    sine_.push_back(std::sin(angle) * std::cos(phase) + std::cos(angle) * std::sin(phase));
    cosine_.push_back(std::cos(angle) * std::cos(phase) - std::sin(angle) * std::sin(phase));
  }
  if (!own.load) return;
  const auto table = [&](const Program& of) {
    const int rows = of.model->rows();
    MatrixXd loads(sets_.layout().loads, steps_per_period);
    LoadWindow window(of);
    for (int k = 0; k < steps_per_period; ++k)
      for (std::size_t stage = 0; stage < of.stages.size(); ++stage)
        std::copy_n(window.sum(of.plan.stages[stage].load, k * of.h), rows,
                    loads.col(k).data() + static_cast<Index>(stage) * rows);
    return loads;
  };
  loads_ = table(own);
  load_slopes_ = MatrixXd::Zero(loads_.rows(), loads_.cols());
  if (affine_load_.program)
    load_slopes_ = (table(affine_load_.program(affine_load_.other)) - loads_) / (affine_load_.other - lanes_.at);
}

double PeriodicMap::bound(int row, bool upper, double parameter, bool direction) const {
  const Index point = sets_.place(row).point;
  const Eigen::VectorXd &origin = upper ? lanes_.origin.upper : lanes_.origin.lower,
                        &slope = upper ? lanes_.upper : lanes_.lower;
  const double layer = program().law->layer(0);
  if (direction) return parameter * slope[point];
  return origin[point] + (parameter - lanes_.at) * slope[point] + (upper ? -layer : layer);
}

// What the bounds bring into a step with this set.
VectorXd PeriodicMap::constant_drive(int set, const Column& column) const {
  const DriveLayout& layout = sets_.layout();
  const SetStep& step = sets_[set];
  VectorXd sum = VectorXd::Zero(step.drive.rows());
  for (const SetPoint& one : step.closed)
    sum += bound(sets_.row_of(one), one.upper, column.parameter, column.direction) *
           step.drive.col(one.upper ? layout.upper(one.point) : layout.lower(one.point));
  return sum;
}

namespace {

// y = E x for one or two columns, E rows × D by columns.
template <int Columns>
inline __attribute__((always_inline)) void multiply_body(const MatrixXd& E, const double* const* x, double* const* y) {
  const Index rows = E.rows(), D = E.cols();
  for (int c = 0; c < Columns; ++c) std::fill_n(y[c], rows, 0.0);
  Index j = 0;
  for (; j + 4 <= D; j += 4) {
    const double *e0 = E.data() + j * rows, *e1 = e0 + rows, *e2 = e1 + rows, *e3 = e2 + rows;
    for (int c = 0; c < Columns; ++c) {
      const double a = x[c][j], b = x[c][j + 1], d = x[c][j + 2], f = x[c][j + 3];
      double* __restrict out = y[c];
      for (Index i = 0; i < rows; ++i) out[i] += (a * e0[i] + b * e1[i]) + (d * e2[i] + f * e3[i]);
    }
  }
  for (; j < D; ++j)
    for (int c = 0; c < Columns; ++c) {
      const double* e = E.data() + j * rows;
      const double a = x[c][j];
      double* __restrict out = y[c];
      for (Index i = 0; i < rows; ++i) out[i] += a * e[i];
    }
}

template <int Columns>
void multiply_anywhere(const MatrixXd& E, const double* const* x, double* const* y) {
  multiply_body<Columns>(E, x, y);
}

// Nothing is fused: the numbers are those of any other processor.
template <int Columns>
RICOCHET_AVX2_ALONE void multiply_by_fours(const MatrixXd& E, const double* const* x, double* const* y) {
  multiply_body<Columns>(E, x, y);
}

template <int Columns>
void multiply(const MatrixXd& E, const double* const* x, double* const* y) {
  has_avx2() ? multiply_by_fours<Columns>(E, x, y) : multiply_anywhere<Columns>(E, x, y);
}

}  // namespace

void PeriodicMap::sweep(const SetSequence& sets, const MapClock& clock, std::vector<Column>& columns,
                        Measures* measures) {
  set_period(clock.steps_per_period);
  const Index D = size(), rows = sets_.measure_rows(), all = D + rows;
  const std::size_t count = columns.size();
  std::vector<std::vector<VectorXd>> constants(static_cast<std::size_t>(sets_.count()));
  std::vector<VectorXd> now(count), next(count, VectorXd::Zero(all));
  std::vector<double> amplitude(count);
  for (std::size_t c = 0; c < count; ++c) {
    now[c] = VectorXd::Zero(all);
    now[c].head(D) = columns[c].x;
    amplitude[c] = columns[c].direction
                       ? columns[c].parameter * lanes_.amplitude
                       : lanes_.origin.amplitude + (columns[c].parameter - lanes_.at) * lanes_.amplitude;
  }
  if (measures) {
    measures->value.resize(sets.size() * static_cast<std::size_t>(rows));
    measures->slope.resize(measures->value.size());
  }
  const bool support = program().support;
  const DriveLayout& layout = sets_.layout();
  for (std::size_t k = 0; k < sets.size(); ++k) {
    const SetStep& step = sets_[sets[k]];
    std::vector<VectorXd>& constant = constants[static_cast<std::size_t>(sets[k])];
    if (constant.empty())
      for (const Column& column : columns) constant.push_back(constant_drive(sets[k], column));
    const auto at = static_cast<Index>(k % static_cast<std::size_t>(clock.steps_per_period));
    const double* x[2] = {now[0].data(), count > 1 ? now[1].data() : nullptr};
    double* y[2] = {next[0].data(), count > 1 ? next[1].data() : nullptr};
    count > 1 ? multiply<2>(step.state, x, y) : multiply<1>(step.state, x, y);
    for (std::size_t c = 0; c < count; ++c) {
      next[c] += constant[c];
      if (support)
        next[c] += amplitude[c] * (sine_[static_cast<std::size_t>(at)] * step.drive.col(0) +
                                   cosine_[static_cast<std::size_t>(at)] * step.drive.col(1));
      if (layout.loads == 0) continue;
      VectorXd load = (columns[c].parameter - (columns[c].direction ? 0 : lanes_.at)) * load_slopes_.col(at);
      if (!columns[c].direction) load += loads_.col(at);
      next[c] += step.drive.rightCols(layout.loads) * load;
    }
    if (measures) {
      const auto from = static_cast<std::ptrdiff_t>(k) * rows;
      std::copy_n(next[0].data() + D, rows, measures->value.begin() + from);
      if (count > 1) std::copy_n(next[1].data() + D, rows, measures->slope.begin() + from);
    }
    std::swap(now, next);
  }
  for (std::size_t c = 0; c < count; ++c) columns[c].x = clock.sign() * now[c].head(D);
}

StrobeTip march_over(Marcher& marcher, const MapClock& clock, const Observers& observers) {
  StrobeTip tip{marcher.tip(0), 0};
  marcher.march(1, observers);
  const double after = marcher.tip(0);
  marcher.march(clock.steps() - 2, observers);
  const double before = marcher.tip(0);
  marcher.march(1, observers);
  // What does not close is no speed.
  const double open = clock.sign() * marcher.tip(0) - tip.displacement;
  tip.velocity = (after - clock.sign() * before + open) / (2 * marcher.program().h);
  return tip;
}

std::optional<LaneState> settle(Program program, int steps_per_period, int periods, LaneEnd& end) {
  Marcher marcher(std::move(program));
  marcher.start();
  marcher.march(steps_per_period - marcher.step());
  for (int n = 1; n < periods && marcher.any_running(); ++n) {
    marcher.set_clock(0);
    marcher.march(steps_per_period);
  }
  end = marcher.status(0).end;
  if (end) return std::nullopt;
  return marcher.lane_state(0);
}

}  // namespace ricochet
