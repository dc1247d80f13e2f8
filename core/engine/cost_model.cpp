#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <fstream>
#include <mutex>
#include <optional>
#include <ricochet/contract/fingerprint.hpp>
#include <ricochet/engine/cost_model.hpp>
#include <ricochet/kernels/band_ldlt.hpp>
#include <ricochet/kernels/floating_point.hpp>
#include <ricochet/kernels/sparse_factor.hpp>
#include <ricochet/kernels/sparse_ldlt.hpp>
#include <string>
#include <utility>
#include <vector>

namespace ricochet {

namespace {

constexpr double kilobyte = 1024;

// A number that stands alone in a file, or behind a word in it.
std::optional<double> number_in(const char* file, const std::string& word = "") {
  std::ifstream in(file);
  std::string found;
  double number = 0;
  while (!word.empty() && in >> found)
    if (found == word) break;
  if (in >> number) return number;
  return std::nullopt;
}

}  // namespace

double available_memory() {
  double least = infinity;
  if (const auto free = number_in("/proc/meminfo", "MemAvailable:")) least = *free * kilobyte;
  const auto group = number_in("/sys/fs/cgroup/memory.max"), used = number_in("/sys/fs/cgroup/memory.current");
  if (group && used) least = std::min(least, std::max(0.0, *group - *used));
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
    if (const auto taken = number_in("/proc/self/status", "VmSize:"))
      least = std::min(least, std::max(0.0, static_cast<double>(limit.rlim_cur) - *taken * kilobyte));
  return least;
}

namespace {

// Nanoseconds per multiply-add, by block width 1, 2, 4, 8, 16, 32, as measured by `bench_march --calibrate` (AVX2,
// Intel Xeon, 2.5 GHz). Substitution at one lane is bound by latency, not by throughput. The rate of a substitution
// through CHOLMOD's factor is from the benchmark's own rows, over 700 multiply-adds. It is the sparse row less the
// band, plus the substitution that the band has in its place.
struct Rates {
  double product, substitution, sparse, elementwise, diagonal, measure;
};

// Wider bands than narrow ones are substituted one multiply-add after the other: ns each, one lane.
constexpr double wide = 1.3;

// What SparseOperator takes, ns: of a product by rows per entry, of a substitution per entry each time it is read.
double by_rows(double lanes) {
  return lanes == 1 ? 0.4 : 0.2;
}
double by_blocks(double lanes, double entries) {
  constexpr double second_cache = 1e6, third_cache = 16e6, bytes = sizeof(double);
  const double size = bytes * entries, near = lanes == 1 ? 0.25 : 0.15;
  const double fetched = size < second_cache ? 0 : size < third_cache ? 0.4 : 0.9;
  return std::max(near, fetched / lanes);
}

// Of K + M, or of both with their border. Those of the patterns that were counted last are kept.
SparseFill counted_fill(const SemiDiscrete& problem) {
  static std::mutex mutex;
  static std::deque<std::pair<Fingerprint, SparseFill>> kept;
  constexpr std::size_t most = 32;
  std::vector<int> order;
  SparseMatrix system = weighted_system(1, problem.stiffness, 1, problem.inertia).assemble(order);
  system.makeCompressed();
  const Fingerprint pattern = pattern_fingerprint(system);
  const std::lock_guard lock(mutex);
  for (const auto& [known, fill] : kept)
    if (known == pattern) return fill;
  if (kept.size() == most) kept.pop_front();
  kept.emplace_back(pattern, sparse_fill(system));
  return kept.back().second;
}

// What a stage costs besides, whatever its size: calls and the motion of the support. Per step and per lane there is
// the check of contact, closed now and then. What `bench_march` and `bench_decay` measure over their products and sums.
constexpr double per_stage = 130, per_contact = 170, per_contact_lane = 25;

Rates rates(int width) {
  if (width == 1) return {0.16, 0.48, 1.77, 0.08, 0.30, 0.34};
  if (width == 2) return {0.20, 0.20, 0.90, 0.07, 0.20, 0.17};
  if (width == 4) return {0.12, 0.11, 0.50, 0.063, 0.115, 0.098};
  if (width == 8) return {0.081, 0.078, 0.32, 0.058, 0.115, 0.073};
  if (width == 16) return {0.067, 0.064, 0.21, 0.10, 0.135, 0.089};
  return {0.064, 0.118, 0.22, 0.10, 0.125, 0.087};
}

// A step in modes, and a search of a flight, as bench_flight measures them.
double visit_seconds(const SemiDiscrete& problem, const StepWork& work) {
  return predict_cost(OperatorKind::modal, problem, work, 1).step_seconds + 5e-7 +
         2.5e-10 * problem.dofs() * problem.points();
}

}  // namespace

bool kind_applies(OperatorKind kind, const SemiDiscrete& problem) {
  // The modal form divides by φᵀKφ; the dense eigenproblem is cubic.
  if (kind == OperatorKind::modal)
    return problem.dofs() <= 1000 && !problem.damping.matrix && (problem.held || problem.asks_for_modes());
  return !problem.damping.by_modes();
}

Cost predict_cost(OperatorKind kind, const SemiDiscrete& problem, const StepWork& work, int width) {
  const double n = problem.dofs(), lanes = width, slots = work.slots;
  const Rates rate = rates(width);
  const Inertia& inertia = problem.inertia;
  const double border = inertia.factored() ? static_cast<double>(inertia.coupling.rows()) : 0;
  const double nano = 1e-9, stages = std::max(1, work.solves);
  Cost cost;
  const double entries = kind == OperatorKind::modal ? static_cast<double>(problem.points()) * n
                                                     : static_cast<double>(problem.measured().nonZeros());
  double nanoseconds = n * (slots + 1) * slots * rate.elementwise + entries * (slots + 2) * rate.measure;
  if (kind == OperatorKind::modal) {
    nanoseconds += n * (slots + 1) * rate.diagonal;
    cost.setup_seconds = 20 * n * n * n * nano;
    const bool assembled = problem.load && problem.load->has_formula() && !problem.load->constant_in_time();
    if (assembled) nanoseconds += n * n / lanes;
  } else {
    double w = half_bandwidth(problem.stiffness);
    if (problem.space.given || problem.basis) w = std::max<double>(w, half_bandwidth(inertia.mass));
    const double v = border > 0 ? w + 2 : w, r = inertia.inverted() ? half_bandwidth(inertia.inverse) : 0;
    cost.setup_seconds = stages * n * 200 * nano;
    if (inertia.inverted() && work.without_stiffness) {
      nanoseconds += n * (2 * w + 1) * rate.product + n * (2 * r + 1) * rate.product;
    } else if (kind == OperatorKind::sparse && w > narrow_band) {
      const SparseFill fill = counted_fill(problem);
      nanoseconds += static_cast<double>(problem.stiffness.nonZeros()) * by_rows(lanes) +
                     2 * fill.entries * by_blocks(lanes, fill.entries);
      cost.setup_seconds += stages * 0.5 * fill.operations * nano;
    } else {
      const double solve = kind == OperatorKind::sparse    ? rate.sparse
                           : w > narrow_band && lanes == 1 ? wide
                                                           : rate.substitution;
      const double terms = inertia.inverted() ? 2 * n * (4 * std::max(w, r) + 1) : (n + border) * (2 * v + 1);
      nanoseconds += n * (2 * w + 1) * rate.product + terms * solve;
      if (w > narrow_band) cost.setup_seconds += stages * (n + border) * v * v * nano;
    }
  }
  const double fixed = per_stage + (problem.points() > 0 ? per_contact + per_contact_lane * lanes : 0);
  cost.step_seconds = stages * (nanoseconds * lanes + fixed) * nano;
  return cost;
}

double predict_flights(const SemiDiscrete& problem, const StepWork& work, long long steps) {
  const double n = problem.dofs(),
               visited = std::min(static_cast<double>(steps), 4 * std::sqrt(static_cast<double>(steps)));
  return 3e-9 * n * n * n + 1.5e-5 * n + visited * visit_seconds(problem, work);
}

double predict_visits(const SemiDiscrete& problem, const StepWork& work, double steps) {
  return std::min(steps, 60 * std::pow(steps, 0.17)) * visit_seconds(problem, work);
}

OperatorKind cheapest_kind(const SemiDiscrete& problem, const StepWork& work, int width, long long steps) {
  if (problem.asks_for_modes() && kind_applies(OperatorKind::modal, problem)) return OperatorKind::modal;
  OperatorKind best = OperatorKind::band;
  double best_cost = 0;
  for (const OperatorKind kind : {OperatorKind::band, OperatorKind::modal, OperatorKind::sparse}) {
    if (!kind_applies(kind, problem)) continue;
    const Cost cost = predict_cost(kind, problem, work, width);
    const double total = cost.setup_seconds + static_cast<double>(steps) * cost.step_seconds;
    if (best_cost == 0 || total < best_cost) {
      best = kind;
      best_cost = total;
    }
  }
  return best;
}

}  // namespace ricochet
