#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <ricochet/contact_solvers/box_problem.hpp>
#include <stdexcept>

#include "runners/check/allocation_count.hpp"
#include "runners/check/bench.hpp"
#include "runners/check/law_checks.hpp"

namespace ricochet::checking {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// A beam of ten elements with stops at so many nodes: the same elements for any number of points.
void show_beam(ContactLaw& law, int points) {
  constexpr int elements = 10;
  SceneSpec scene = structure_scene({.beam = true, .stops = true});
  scene.stops.place = StopsSpec::Place::positions;
  for (int i = points; i-- > 0;) scene.stops.positions.push_back((elements - i) / static_cast<double>(elements));
  discretised(scene, elements, *consistent_bench_mass(), &law);
}

// Made ready where the sizes of its arrays can be asked.
std::unique_ptr<ContactLaw> prepared(const Law& law, int points, int lanes) {
  auto made = law.make();
  if (made->changes_problem()) show_beam(*made, points);
  made->prepare(points, std::vector<Parameters>(static_cast<std::size_t>(lanes), law.set.values));
  return made;
}

}  // namespace

DenseDelassus::DenseDelassus(Eigen::MatrixXd matrix)
    : matrix_(std::move(matrix)),
      shown_(std::make_shared<GuardedArray<double>>("column", static_cast<std::size_t>(matrix_.size()))) {
  std::copy_n(matrix_.data(), matrix_.size(), shown_->begin());
  shown_->block().freeze();
}

LawBench::LawBench(const Law& law, int points, int lanes)
    : law_(prepared(law, points, lanes)),
      points_(points),
      lanes_(lanes),
      free_("free", numbers()),
      lower_("lower", numbers()),
      upper_("upper", numbers()),
      rate_("rate_free", numbers()),
      before_("before", numbers()),
      effort_("effort", numbers()),
      memory_("memory", numbers() * static_cast<std::size_t>(std::max(0, law_->memory_per_point()))),
      outcomes_("outcome", static_cast<std::size_t>(lanes)) {}

void LawBench::solve(DenseDelassus& W, double reach, double rate_reach, const std::vector<LaneProblem>& problems,
                     const std::vector<int>& touched) {
  const auto put = [&](const GuardedArray<double>& block, int lane, const Eigen::VectorXd& values) {
    for (int i = 0; i < points_; ++i) block[i * lanes_ + lane] = values.size() > 0 ? values[i] : 0.0;
  };
  for (int l = 0; l < lanes_; ++l) {
    const LaneProblem& lane = problems[static_cast<std::size_t>(l)];
    put(free_, l, lane.free);
    put(lower_, l, lane.lower);
    put(upper_, l, lane.upper);
    put(rate_, l, lane.rate);
    put(before_, l, lane.before.size() > 0 ? lane.before : lane.free);
    put(effort_, l, lane.effort);
  }
  if (!remembers_) std::fill(memory_.begin(), memory_.end(), 0.0);
  std::fill(outcomes_.begin(), outcomes_.end(), LaneOutcome{});
  ReducedProblem problem;
  problem.points = points_;
  problem.lanes = lanes_;
  problem.delassus = &W;
  problem.reach = reach;
  problem.free = free_.data();
  problem.lower = lower_.data();
  problem.upper = upper_.data();
  problem.rate_reach = law_->reads_rate() ? rate_reach : 0.0;
  problem.rate_free = law_->reads_rate() ? rate_.data() : nullptr;
  problem.before = law_->reads() == Evaluation::conserving ? before_.data() : nullptr;
  problem.memory = memory_.data();
  problem.effort = effort_.data();
  problem.touched = touched;
  problem.outcome = outcomes_.data();
  call_guarded([&] {
    const long before = allocations_of_this_thread();
    law_->solve(problem);
    allocations_ = allocations_of_this_thread() - before;
  });
  for (int l = 0; l < lanes_; ++l) {
    const LaneProblem& lane = problems[static_cast<std::size_t>(l)];
    const auto as_put = [&](const GuardedArray<double>& block, const Eigen::VectorXd& values) {
      for (int i = 0; i < points_; ++i)
        if (const double was = values.size() > 0 ? values[i] : 0.0; block[i * lanes_ + l] != was)
          throw std::runtime_error(
              fmt::format("writes into the array `{}` that it is given, which it may only read", block.block().name()));
    };
    as_put(free_, lane.free);
    as_put(lower_, lane.lower);
    as_put(upper_, lane.upper);
    as_put(rate_, lane.rate);
    as_put(before_, lane.before.size() > 0 ? lane.before : lane.free);
  }
}

void LawBench::remember(bool on) {
  remembers_ = on;
  std::fill(memory_.begin(), memory_.end(), 0.0);
}

void LawBench::keep(const std::vector<double>& memory) {
  remembers_ = true;
  std::copy(memory.begin(), memory.end(), memory_.begin());
}

std::vector<double> LawBench::of_lane(const std::vector<double>& memory, int lane) const {
  std::vector<double> numbers;
  for (auto at = static_cast<std::size_t>(lane); at < memory.size(); at += static_cast<std::size_t>(lanes_))
    numbers.push_back(memory[at]);
  return numbers;
}

std::vector<double> LawBench::of_point(const std::vector<double>& memory, Eigen::Index point, int lane) const {
  std::vector<double> numbers;
  for (auto at = static_cast<std::size_t>(point * lanes_ + lane); at < memory.size();
       at += static_cast<std::size_t>(points_ * lanes_))
    numbers.push_back(memory[at]);
  return numbers;
}

StopState LawBench::state(int side, double depth) const {
  StopState state{.depth = depth, .side = -side};
  if (memory_.size() > 0) state.memory = {memory_.data(), points_ * lanes_};
  return state;
}

Eigen::VectorXd LawBench::effort(int lane) const {
  Eigen::VectorXd p(points_);
  for (int i = 0; i < points_; ++i) p[i] = effort_[i * lanes_ + lane];
  return p;
}

PointAnswer at_point(LawBench& bench, int side, double depth, double speed, double before) {
  thread_local DenseDelassus W(Eigen::MatrixXd::Constant(1, 1, 1e-6));
  const auto one = [](double x) { return Eigen::VectorXd(Eigen::VectorXd::Constant(1, x)); };
  const double layer = bench.layer();
  LaneProblem lane;
  // The stop of the side at 0, the other one far away; the law sees stops that begin at its layer.
  lane.lower = one(side < 0 ? layer : -infinity);
  lane.upper = one(side < 0 ? infinity : -layer);
  lane.free = one(side * depth);
  lane.rate = one(speed);
  lane.before = one(side * before);
  lane.effort = one(0);
  bench.solve(W, 0, 0, {lane}, {0});
  const double effort = bench.effort(0)[0];
  PointAnswer answer{effort, bench.outcome(0).dissipation, bench.outcome(0).converged && std::isfinite(effort), {}};
  if (bench.law().offers_slopes()) answer.slopes = bench.law().slopes(0, 0);
  return answer;
}

bool is_barrier(LawBench& bench) {
  return bench.law().reads() && bench.layer() > 0 && !at_point(bench, -1, 1e-3, 0, 1e-3).answered;
}

LaneProblem random_lane(std::mt19937& random, int points, bool two_sided) {
  std::uniform_real_distribution<double> place(-0.02, 0.02), gap(0.002, 0.008), speed(-0.5, 0.5);
  LaneProblem lane;
  for (auto* v : {&lane.free, &lane.lower, &lane.upper, &lane.rate, &lane.before, &lane.effort})
    *v = Eigen::VectorXd::Zero(points);
  for (int i = 0; i < points; ++i) {
    lane.free[i] = place(random);
    lane.lower[i] = -gap(random);
    lane.upper[i] = two_sided ? gap(random) : infinity;
    lane.rate[i] = speed(random);
    lane.before[i] = lane.free[i] + 0.1 * place(random);
    if (i % 4 == 3) lane.free[i] = lane.lower[i];  // just touching
  }
  return lane;
}

DenseDelassus random_delassus(std::mt19937& random, int points, double flexibility) {
  std::normal_distribution<double> normal;
  Eigen::MatrixXd A(points, points);
  for (int i = 0; i < points; ++i)
    for (int j = 0; j < points; ++j) A(i, j) = normal(random);
  Eigen::MatrixXd W = A * A.transpose() / points + 0.2 * Eigen::MatrixXd::Identity(points, points);
  return DenseDelassus(flexibility * W);
}

double flexibility_of(const Law& law) {
  LawBench bench(law, 1, 1);
  if (!bench.law().reads()) return 1e-4;
  constexpr double depth = 0.01;
  const PointAnswer at = at_point(bench, -1, depth, 0, depth);
  return at.answered && at.effort > 0 ? depth / at.effort : 1e-4;
}

namespace {

class NoContact final : public ContactLaw {
 public:
  bool absent() const override { return true; }
  void prepare(int, std::span<const Parameters>) override {}
  void solve(ReducedProblem&) override {}
};

/// Rigid stops, or springs behind them: the same box problem, its diagonal shifted by 1/κ.
class Stops final : public ContactLaw {
 public:
  Stops(std::optional<Evaluation> evaluation, double stiffness) : evaluation_(evaluation), stiffness_(stiffness) {}
  std::optional<Evaluation> reads() const override { return evaluation_; }
  void prepare(int points, std::span<const Parameters>) override { solver_.prepare(points); }
  void solve(ReducedProblem& problem) override {
    for (const int lane : problem.touched)
      problem.outcome[lane] = solver_.solve(*problem.delassus, problem.reach, evaluation_ ? 1 / stiffness_ : 0.0,
                                            problem.free + lane, problem.lower + lane, problem.upper + lane,
                                            problem.effort + lane, problem.points, problem.lanes);
  }
  double potential(const StopState& at) const override {
    return evaluation_ ? 0.5 * stiffness_ * at.depth * at.depth : 0;
  }

 private:
  std::optional<Evaluation> evaluation_;
  double stiffness_;
  BoxSolver solver_;
};

class GluedSpring final : public ContactLaw {
 public:
  GluedSpring(Evaluation evaluation, double stiffness, double damping)
      : evaluation_(evaluation), stiffness_(stiffness), damping_(damping) {}
  std::optional<Evaluation> reads() const override { return evaluation_; }
  bool reads_rate() const override { return damping_ != 0; }
  void prepare(int, std::span<const Parameters>) override {}
  void solve(ReducedProblem& problem) override {
    const double W = problem.delassus->column(0)[0];
    const bool mean = evaluation_ == Evaluation::conserving;
    const double kappa = mean ? 0.5 * stiffness_ : stiffness_;
    for (const int lane : problem.touched) {
      double push = kappa * (problem.lower[lane] - problem.free[lane]);
      if (mean) push += kappa * (problem.lower[lane] - problem.before[lane]);
      double yields = 1 + kappa * problem.reach * W;
      if (damping_ != 0) {
        push -= damping_ * problem.rate_free[lane];
        yields += damping_ * problem.rate_reach * W;
      }
      problem.effort[lane] = push / yields;
      problem.outcome[lane] = {};
    }
  }

 private:
  Evaluation evaluation_;
  double stiffness_, damping_;
};

}  // namespace

std::unique_ptr<ContactLaw> no_contact() {
  return std::make_unique<NoContact>();
}
std::unique_ptr<ContactLaw> rigid_stops() {
  return std::make_unique<Stops>(std::nullopt, 0);
}
std::unique_ptr<ContactLaw> springs(Evaluation evaluation, double stiffness) {
  return std::make_unique<Stops>(evaluation, stiffness);
}
std::unique_ptr<ContactLaw> glued_spring(Evaluation evaluation, double stiffness, double damping) {
  return std::make_unique<GluedSpring>(evaluation, stiffness, damping);
}

}  // namespace ricochet::checking
