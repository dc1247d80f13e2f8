#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cmath>
#include <complex>
#include <numbers>
#include <ricochet/engine/marcher.hpp>
#include <ricochet/measure/energy/energy_audit.hpp>
#include <ricochet/measure/stability/observed_stability.hpp>
#include <ricochet/measure/stability/structure_physics.hpp>

namespace ricochet {
namespace {

using Eigen::VectorXd;

// Motions that begin with half of their energy elastic and half kinetic reach at most twice their first norm.
constexpr double growth_since_start = 4, growth_at_end = 1.5;
// Near the limit h* of an explicit scheme the common energy swings by 1/(1 − (h/h*)²) around what is conserved. It
// reaches a thousand times that only in the last half per mille of h.
constexpr double blown_up = 1000;
constexpr std::size_t window = 1024;

// Whether what its largest values of each third of an integration say grows on to the end.
bool grows_on(double first, double second, double third) {
  return first > 0 && third >= growth_since_start * first && third >= growth_at_end * second;
}

// Which third of an integration of so many steps a step belongs to.
std::size_t third_of(long long step, long long steps) {
  return static_cast<std::size_t>(std::min(2LL, 3 * step / std::max(steps, 3LL)));
}

// |x_j|² in K and in M for every slot, the largest of each third of the horizon.
class NormWatch final : public StepObserver {
 public:
  NormWatch(const Marcher& marcher, long long steps)
      : mass_(QuadraticForm::of(marcher.program().model->inertia())),
        stiffness_(marcher.program().model->stiffness()),
        column_(marcher.program().model->rows()),
        steps_(std::max(steps, 3LL)) {
    for (auto& third : largest_) third.assign(2 * static_cast<std::size_t>(marcher.slot_count()), 0.0);
  }

  void stage_solved(const Marcher&, const StageView&) override {}
  void step_done(Marcher& marcher) override {
    if (!marcher.status(0).running) return;
    const std::size_t third = third_of(marcher.step(), steps_);
    for (int j = 0; j < marcher.slot_count(); ++j) {
      const double* x = marcher.slot(j);
      for (Eigen::Index i = 0; i < column_.size(); ++i) column_[i] = x[i * marcher.width()];
      double& elastic = largest_[third][2 * static_cast<std::size_t>(j)];
      double& kinetic = largest_[third][2 * static_cast<std::size_t>(j) + 1];
      elastic = std::max(elastic, stiffness_(column_.data()));
      kinetic = std::max(kinetic, mass_(column_.data()));
    }
  }

  void judge(ObservedCell& cell) const {
    for (std::size_t s = 0; s < largest_[0].size(); ++s) {
      const double first = largest_[0][s], second = largest_[1][s], third = largest_[2][s];
      if (!grows_on(first, second, third)) continue;
      const double late = third / second, early = second / first;
      // Amplitudes that grow like n^d: 1.5^2d and 2^2d, so ln 2/ln 1.5 = 1.71 between their logarithms, and d = 2 at
      // most of a triple root. One that grows geometrically: 1.
      const bool linear = late < 8 && std::log(early) > 1.35 * std::log(late);
      if (linear && cell.behaviour == Behaviour::stable) {
        cell.behaviour = Behaviour::linear_growth;
        cell.cause = late < 3 ? "amplitudes grow like the number of steps"
                              : "amplitudes grow like the square of the number of steps";
      } else if (!linear) {
        cell.behaviour = Behaviour::growing;
        cell.growth = std::max(cell.growth, std::expm1(1.5 * std::log(late) / static_cast<double>(steps_)));
      }
    }
    if (cell.behaviour == Behaviour::growing)
      cell.cause = fmt::format("amplitudes grow by {:.3g} per step", cell.growth);
  }

 private:
  QuadraticForm mass_, stiffness_;
  VectorXd column_;
  long long steps_;
  std::array<std::vector<double>, 3> largest_;  // per slot: in K, in M
};

// Windows of the contact force, each beginning with an impact.
class ForceWindows {
 public:
  ForceWindows() { signal_.reserve(window); }
  void add(double force) {
    if (windows_ == 64 || (signal_.empty() && force == 0)) return;
    signal_.push_back(force);
    if (signal_.size() < window) return;
    finish();
  }
  double share() {
    if (windows_ == 0 && !signal_.empty()) {
      signal_.resize(window, 0.0);
      finish();
    }
    return windows_ == 0 ? 0.0 : sum_ / windows_;
  }

 private:
  void finish() {
    sum_ += fast_power_share(signal_);
    ++windows_;
    signal_.clear();
  }
  std::vector<double> signal_;
  double sum_ = 0;
  int windows_ = 0;
};

// The energy that nothing gave, and the contact force.
class GainWatch final : public StepObserver {
 public:
  GainWatch(const Marcher& marcher, long long steps) : audit_(marcher), steps_(steps) {}
  void stage_solved(const Marcher& marcher, const StageView& view) override { audit_.stage_solved(marcher, view); }
  void step_done(Marcher& marcher) override {
    audit_.step_done(marcher);
    if (!marcher.status(0).running) return;
    const EnergyTotals& totals = audit_.totals(0);
    given_ = std::max(given_, totals.scheme_start + std::max(0.0, totals.work_of_loads));
    // A spring's potential and the scheme's energy may be of other instants: forms of one scheme differ there. What is
    // gained shows once the spring is slack.
    const double unearned = totals.last.scheme - totals.scheme_start - totals.work_of_loads + totals.work_of_damping;
    if (given_ > 0 && totals.last.contact == 0 && std::isfinite(unearned)) gain_ = std::max(gain_, unearned / given_);
    if (gain_ > 1 && first_bad_ < 0) first_bad_ = marcher.step();
    // A scheme's own energy has no sign beyond its limit.
    const double common = totals.last.common();
    if (!(given_ > 0)) return force_.add(audit_.contact(0).force);
    double& most = common_[third_of(marcher.step(), steps_)];
    most = std::max(most, common / given_);
    if (most > blown_up && first_blown_ < 0) first_blown_ = marcher.step();
    force_.add(audit_.contact(0).force);
  }

  void judge(ObservedCell& cell) {
    const ContactTotals& contact = audit_.contact(0);
    // What swells and falls again is a transient: high modes of a step far beyond their period.
    if (common_[2] > std::max(blown_up, gain_) && grows_on(common_[0], common_[1], common_[2])) {
      gain_ = common_[2];
      if (first_bad_ < 0) first_bad_ = first_blown_;
    }
    cell.gain = gain_;
    cell.impacts = contact.impacts;
    cell.touched = contact.contact_steps > 0 || contact.impacts > 0;
    if (contact.spells > 0)
      cell.changes_per_impact = static_cast<double>(contact.active_set_changes) / static_cast<double>(contact.spells);
    cell.fast_share = force_.share();
    if (gain_ <= 1) return;
    cell.behaviour = Behaviour::growing;
    cell.first_bad_step = first_bad_;
    cell.cause = fmt::format("energy that nothing gave reaches {:.3g} times all that was given, first at step {}",
                             gain_, first_bad_);
  }

 private:
  EnergyAudit audit_;
  ForceWindows force_;
  long long steps_;
  double given_ = 0, gain_ = 0;
  std::array<double, 3> common_{};  // largest common energy over what was given, of each third
  long long first_bad_ = -1, first_blown_ = -1;
};

template <class Watch>
ObservedCell march(Marcher& marcher, Watch& watch, const Horizon& horizon) {
  using Clock = std::chrono::steady_clock;
  marcher.start(&watch);
  // Steps between two questions whether to go on: about a hundredth of a second, where one step takes less.
  long long stretch = 1;
  while (marcher.step() < horizon.steps && marcher.any_running()) {
    if (horizon.go_on && !horizon.go_on()) break;
    const Clock::time_point before = Clock::now();
    marcher.march(std::min(stretch, horizon.steps - marcher.step()), &watch);
    const double seconds = std::chrono::duration<double>(Clock::now() - before).count();
    stretch = seconds < 0.01 ? 2 * stretch : std::max(stretch / 2, 1LL);
  }
  ObservedCell cell;
  cell.steps = marcher.step();
  watch.judge(cell);
  const LaneStatus& status = marcher.status(0);
  if (status.running) return cell;
  cell.behaviour = status.end.failed() ? Behaviour::failed : Behaviour::diverged;
  cell.steps = status.step;
  if (cell.first_bad_step < 0) cell.first_bad_step = status.step;
  cell.cause = fmt::format("step {}: {}", status.step, text(status.end));
  return cell;
}

/// What one observation marches: the law is made anew for each integration.
struct Observation {
  std::shared_ptr<const SemiDiscrete> problem;
  const StepPlan& plan;
  double h;
  std::function<std::unique_ptr<ContactLaw>()> law;
  LaneSpec lane;
  const Horizon& horizon;
};

template <class Watch>
ObservedOrRefusal march_once(const Observation& of, bool bounded) {
  CompileOptions options;
  options.expected_steps = of.horizon.steps;
  options.bounded = bounded;
  auto program = compile(of.problem, of.plan, of.h, of.law(), {of.lane}, options);
  if (const auto* refusal = std::get_if<Refusal>(&program)) return *refusal;
  Marcher marcher(std::move(std::get<Program>(program)));
  Watch watch(marcher, of.horizon.steps);
  return march(marcher, watch, of.horizon);
}

// An integration that its energy bound stopped is made again without: where it then ends without growing, the energy
// was that of a transient.
template <class Watch>
ObservedOrRefusal observe(const Observation& of) {
  const ObservedOrRefusal stopped = march_once<Watch>(of, true);
  const auto* cell = std::get_if<ObservedCell>(&stopped);
  if (!cell || cell->behaviour != Behaviour::diverged || (of.horizon.go_on && !of.horizon.go_on())) return stopped;
  const ObservedOrRefusal whole = march_once<Watch>(of, false);
  const auto* seen = std::get_if<ObservedCell>(&whole);
  return seen && seen->stable() ? whole : stopped;
}

std::shared_ptr<const SemiDiscrete> without_loads(const SemiDiscrete& problem) {
  auto bare = std::make_shared<SemiDiscrete>(problem);
  bare->load = nullptr;
  bare->support.amplitude = 0;
  return bare;
}

}  // namespace

double fast_power_share(std::vector<double> signal) {
  const std::size_t n = signal.size();
  double mean = 0;
  for (const double x : signal) mean += x / static_cast<double>(n);
  std::vector<std::complex<double>> a(n);
  // Bit-reversed order, then butterflies (Cooley and Tukey 1965).
  const int bits = std::countr_zero(n);
  for (std::size_t i = 0; i < n; ++i) {
    std::size_t reversed = 0;
    for (int b = 0; b < bits; ++b) reversed |= ((i >> b) & 1u) << (bits - 1 - b);
    a[reversed] = signal[i] - mean;
  }
  for (std::size_t half = 1; half < n; half *= 2) {
    const auto turn = std::polar(1.0, -std::numbers::pi / static_cast<double>(half));
    for (std::size_t block = 0; block < n; block += 2 * half) {
      std::complex<double> factor = 1;
      for (std::size_t k = block; k < block + half; ++k) {
        const auto odd = factor * a[k + half];
        a[k + half] = a[k] - odd;
        a[k] += odd;
        factor *= turn;
      }
    }
  }
  double all = 0, fast = 0;
  for (std::size_t k = 1; k < n; ++k) {
    all += std::norm(a[k]);
    if (k > n / 4 && k < n - n / 4) fast += std::norm(a[k]);
  }
  // A constant leaves the round-off of its mean.
  const double scale =
      *std::max_element(signal.begin(), signal.end(), [](double x, double y) { return std::abs(x) < std::abs(y); });
  return all > 1e-24 * scale * scale * static_cast<double>(n) ? fast / all : 0.0;
}

ObservedOrRefusal observe_free(const std::shared_ptr<const SemiDiscrete>& problem, const StepPlan& plan, double h,
                               const Excitation& start, const Horizon& horizon) {
  const auto bare = without_loads(*problem);
  LaneSpec lane = scene_lane(*bare, {});
  if (start.position.size() > 0) {
    lane.position = start.position;
    lane.velocity = start.velocity;
  }
  return observe<NormWatch>({bare, plan, h, [] { return std::make_unique<NoContact>(); }, std::move(lane), horizon});
}

ObservedOrRefusal observe_scene(const std::shared_ptr<const SemiDiscrete>& problem, const StepPlan& plan, double h,
                                const std::function<std::unique_ptr<ContactLaw>()>& law, const Parameters& parameters,
                                const Horizon& horizon) {
  return observe<GainWatch>({problem, plan, h, law, scene_lane(*problem, parameters), horizon});
}

ObservedLimit observed_limit(const std::vector<double>& steps, const std::vector<std::optional<ObservedCell>>& known,
                             const std::function<std::optional<ObservedCell>(double h)>& observe, bool below) {
  ObservedLimit limit;
  std::optional<double> stable, unstable;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (!known[i]) continue;
    if (!unstable && known[i]->stable()) stable = steps[i];
    if (!unstable && !known[i]->stable()) unstable = steps[i];
    if (unstable && known[i]->stable()) limit.returns = true;
  }
  if (!unstable) return limit;
  limit.below_range = !stable;
  for (double h = *unstable; below && !stable && h > 1e-6 * steps.front();) {
    h /= 4;
    const auto cell = observe(h);
    if (!cell) return limit;
    (cell->stable() ? stable : unstable) = h;
  }
  if (!stable) return limit;
  double low = *stable, high = *unstable;
  while (high > 1.01 * low) {
    const double middle = std::sqrt(low * high);
    const auto cell = observe(middle);
    if (!cell) break;
    (cell->stable() ? low : high) = middle;
  }
  limit.step = std::sqrt(low * high);
  limit.half = std::max(high - *limit.step, *limit.step - low);
  return limit;
}

}  // namespace ricochet
