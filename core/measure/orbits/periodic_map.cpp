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

MatrixXd PeriodicMap::product(const SetSequence& sets, const MapClock& clock, const std::vector<SetBlend>& blends) {
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

// Over the steps from one up to another, or their transposes back from there.
void PeriodicMap::carry(const SetSequence& sets, std::size_t from, std::size_t to, MatrixXd& columns, bool transposed) {
  if (columns.cols() == 0) return;
  for (std::size_t made = 0; made < to - from;) {
    const auto at = [&](std::size_t k) { return sets[transposed ? to - 1 - k : from + k]; };
    std::size_t end = made;
    while (end < to - from && at(end) == at(made)) ++end;
    const auto count = static_cast<long long>(end - made);
    transposed ? sets_.apply_transposed(at(made), count, columns) : sets_.apply(at(made), count, columns);
    made = end;
  }
}

MatrixXd PeriodicMap::blended(MatrixXd derivative, const SetSequence& sets, const MapClock& clock,
                              const std::vector<SetBlend>& blends) {
  const Index D = size(), count = std::ssize(blends);
  if (2 * count > D) return product(sets, clock, blends);
  // B − A = b cᵀ of each blend.
  MatrixXd moved(D, count), read(D, count), links = MatrixXd::Zero(count, count);
  for (Index j = 0; j < count; ++j) {
    const SetBlend& blend = blends[static_cast<std::size_t>(j)];
    const MatrixXd change = sets_[blend.other].state.topRows(D) - sets_[sets[blend.step]].state.topRows(D);
    Index row = 0, column = 0;
    const double largest = change.cwiseAbs().maxCoeff(&row, &column);
    read.col(j) = change.row(row).transpose();
    moved.col(j) = largest > 0 ? VectorXd(change.col(column) / change(row, column)) : VectorXd::Zero(D);
  }
  const auto step_of = [&](Index j) { return blends[static_cast<std::size_t>(j)].step; };
  // b over the steps behind each blend, and what later blends read of it.
  MatrixXd columns(D, 0);
  std::size_t at = 0;
  for (Index j = 0; j < count;) {
    const std::size_t step = step_of(j);
    carry(sets, at, step, columns, false);
    const Index before = j;
    for (; j < count && step_of(j) == step; ++j) links.row(j).head(before) = read.col(j).transpose() * columns;
    carry(sets, step, step + 1, columns, false);
    columns.conservativeResize(Eigen::NoChange, j);
    columns.rightCols(j - before) = moved.middleCols(before, j - before);
    at = step + 1;
  }
  carry(sets, at, sets.size(), columns, false);
  // c over the steps before it.
  MatrixXd rows(D, 0);
  at = sets.size();
  for (Index j = count; j > 0;) {
    const std::size_t step = step_of(j - 1);
    carry(sets, step, at, rows, true);
    Index first = j;
    while (first > 0 && step_of(first - 1) == step) --first;
    MatrixXd more(D, count - first);
    more << read.middleCols(first, j - first), rows;
    rows = std::move(more);
    at = step;
    j = first;
  }
  carry(sets, 0, at, rows, true);
  for (Index j = 0; j < count; ++j) {
    for (Index i = 0; i < j; ++i) rows.col(j) += blends[static_cast<std::size_t>(i)].weight * links(j, i) * rows.col(i);
    derivative.noalias() +=
        (clock.sign() * blends[static_cast<std::size_t>(j)].weight * columns.col(j)) * rows.col(j).transpose();
  }
  return derivative;
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

// What the bounds of closed points bring into 2^k steps, and into their measures.
struct PeriodicMap::Constant {
  VectorXd state, measured;
};

PeriodicMap::Constant PeriodicMap::constant_drive(int set, std::size_t power, const Column& column) {
  const DriveLayout& layout = sets_.layout();
  const SetStrides& strides = sets_.strides(set, power);
  const Index shown = Index{sets_.measure_rows()} << power;
  Constant sum{VectorXd::Zero(size()), VectorXd::Zero(shown)};
  for (const SetPoint& one : sets_[set].closed) {
    const double value = bound(sets_.row_of(one), one.upper, column.parameter, column.direction);
    const Index at = one.upper ? layout.upper(one.point) : layout.lower(one.point);
    sum.state += value * strides.drive[power].col(at);
    sum.measured += value * strides.measured_drive.col(at).head(shown);
  }
  return sum;
}

namespace {

// y = E x for one or two columns: the first rows of E, D columns of `stride` numbers each.
struct Factor {
  const double* E;
  Index stride, rows, D;
};

template <int Columns>
inline __attribute__((always_inline)) void multiply_body(const Factor& of, const double* const* x, double* const* y) {
  for (int c = 0; c < Columns; ++c) std::fill_n(y[c], of.rows, 0.0);
  Index j = 0;
  for (; j + 4 <= of.D; j += 4) {
    const double *e0 = of.E + j * of.stride, *e1 = e0 + of.stride, *e2 = e1 + of.stride, *e3 = e2 + of.stride;
    for (int c = 0; c < Columns; ++c) {
      const double a = x[c][j], b = x[c][j + 1], d = x[c][j + 2], f = x[c][j + 3];
      double* __restrict out = y[c];
      for (Index i = 0; i < of.rows; ++i) out[i] += (a * e0[i] + b * e1[i]) + (d * e2[i] + f * e3[i]);
    }
  }
  for (; j < of.D; ++j)
    for (int c = 0; c < Columns; ++c) {
      const double* e = of.E + j * of.stride;
      const double a = x[c][j];
      double* __restrict out = y[c];
      for (Index i = 0; i < of.rows; ++i) out[i] += a * e[i];
    }
}

template <int Columns>
void multiply_anywhere(const Factor& of, const double* const* x, double* const* y) {
  multiply_body<Columns>(of, x, y);
}

// Nothing is fused: the numbers are those of any other processor.
template <int Columns>
RICOCHET_AVX2_ALONE void multiply_by_fours(const Factor& of, const double* const* x, double* const* y) {
  multiply_body<Columns>(of, x, y);
}

template <int Columns>
void multiply(const Factor& of, const double* const* x, double* const* y) {
  has_avx2() ? multiply_by_fours<Columns>(of, x, y) : multiply_anywhere<Columns>(of, x, y);
}

// The first rows of E, times one or two columns.
void multiply(const MatrixXd& E, Index rows, const std::vector<VectorXd>& x, std::vector<VectorXd>& y) {
  const Factor of{E.data(), E.rows(), rows, E.cols()};
  const double* in[2] = {x[0].data(), x.size() > 1 ? x[1].data() : nullptr};
  double* out[2] = {y[0].data(), y.size() > 1 ? y[1].data() : nullptr};
  x.size() > 1 ? multiply<2>(of, in, out) : multiply<1>(of, in, out);
}

}  // namespace

// Steps with equal sets are made 2^k at once, where no load makes each of them its own.
void PeriodicMap::sweep(const SetSequence& sets, const MapClock& clock, std::vector<Column>& columns,
                        Measures* measures) {
  set_period(clock.steps_per_period);
  const Index D = size(), rows = sets_.measure_rows();
  const DriveLayout& layout = sets_.layout();
  const std::size_t count = columns.size(), longest = layout.loads > 0 ? 0 : sets_.longest_stride();
  std::vector<VectorXd> now(count), next(count, VectorXd(D)), seen(count, VectorXd(rows << longest));
  std::vector<double> amplitude(count);
  for (std::size_t c = 0; c < count; ++c) {
    now[c] = columns[c].x;
    amplitude[c] = columns[c].direction
                       ? columns[c].parameter * lanes_.amplitude
                       : lanes_.origin.amplitude + (columns[c].parameter - lanes_.at) * lanes_.amplitude;
  }
  if (measures) {
    measures->value.resize(sets.size() * static_cast<std::size_t>(rows));
    measures->slope.resize(measures->value.size());
  }
  // By set, power and column.
  std::vector<std::vector<std::vector<Constant>>> constants(static_cast<std::size_t>(sets_.count()));
  for (std::size_t k = 0, end = 0, made = 1; k < sets.size(); k += made) {
    if (k == end)
      while (end < sets.size() && sets[end] == sets[k]) ++end;
    std::size_t power = 0;
    while (power < longest && (std::size_t{2} << power) <= end - k) ++power;
    made = std::size_t{1} << power;
    auto& known = constants[static_cast<std::size_t>(sets[k])];
    known.resize(longest + 1);
    std::vector<Constant>& constant = known[power];
    if (constant.empty())
      for (const Column& column : columns) constant.push_back(constant_drive(sets[k], power, column));
    const SetStrides& strides = sets_.strides(sets[k], power);
    const auto at = static_cast<Index>(k % static_cast<std::size_t>(clock.steps_per_period));
    const Index shown = measures ? rows << power : 0;
    multiply(strides.state[power], D, now, next);
    if (shown > 0) multiply(strides.measured, shown, now, seen);
    for (std::size_t c = 0; c < count; ++c) {
      next[c] += constant[c].state;
      if (shown > 0) seen[c].head(shown) += constant[c].measured;
      if (program().support) {
        const double sine = sine_[static_cast<std::size_t>(at)], cosine = cosine_[static_cast<std::size_t>(at)];
        const MatrixXd &state = strides.drive[power], &measured = strides.measured_drive;
        next[c] += amplitude[c] * (sine * state.col(0) + cosine * state.col(1));
        if (shown > 0)
          seen[c].head(shown) += amplitude[c] * (sine * measured.col(0) + cosine * measured.col(1)).head(shown);
      }
      if (layout.loads == 0) continue;
      VectorXd load = (columns[c].parameter - (columns[c].direction ? 0 : lanes_.at)) * load_slopes_.col(at);
      if (!columns[c].direction) load += loads_.col(at);
      const MatrixXd& loaded = sets_[sets[k]].drive;
      next[c] += loaded.topRightCorner(D, layout.loads) * load;
      if (shown > 0) seen[c].head(shown) += loaded.bottomRightCorner(rows, layout.loads) * load;
    }
    if (shown > 0) {
      const auto from = static_cast<std::ptrdiff_t>(k) * rows;
      std::copy_n(seen[0].data(), shown, measures->value.begin() + from);
      if (count > 1) std::copy_n(seen[1].data(), shown, measures->slope.begin() + from);
    }
    std::swap(now, next);
  }
  for (std::size_t c = 0; c < count; ++c) columns[c].x = clock.sign() * now[c];
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
