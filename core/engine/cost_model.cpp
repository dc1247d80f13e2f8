#include <algorithm>
#include <ricochet/algebra/band_ldlt.hpp>
#include <ricochet/engine/cost_model.hpp>

namespace ricochet {
namespace {

// Nanoseconds per multiply-add, by block width 1, 2, 4, 8, 16, 32, as measured by `bench_march --calibrate` (AVX2, AMD
// EPYC, 2.4 GHz). Substitution at one lane is bound by latency, not by throughput.
struct Rates {
  double product, substitution, elementwise;
};
// The same for CHOLMOD's factor, one lane at a time, from the benchmark's own rows (1780 ns for 700 multiply-adds and
// the rest).
constexpr double sparse_rate = 2.4;

Rates rates(int width) {
  if (width == 1) return {0.13, 0.40, 0.05};
  if (width == 2) return {0.16, 0.21, 0.05};
  if (width == 4) return {0.08, 0.07, 0.05};
  if (width == 8) return {0.06, 0.05, 0.05};
  if (width == 16) return {0.053, 0.058, 0.053};
  return {0.051, 0.064, 0.065};
}

}  // namespace

bool kind_applies(OperatorKind kind, const SemiDiscrete& problem) {
  // The modal form divides by φᵀKφ; the dense eigenproblem is cubic.
  if (kind == OperatorKind::modal)
    return problem.dofs() <= 1000 && (problem.space.left_fixed || problem.space.right_fixed);
  return true;
}

Cost predict_cost(OperatorKind kind, const SemiDiscrete& problem, int slots, int width) {
  const double n = problem.dofs(), lanes = width;
  const Rates rate = rates(width);
  const double border = problem.inertia.factored() ? static_cast<double>(problem.inertia.coupling.rows()) : 0;
  const double nano = 1e-9;
  Cost cost;
  const double entries = kind == OperatorKind::modal ? static_cast<double>(problem.points()) * n
                                                     : static_cast<double>(problem.contact.nonZeros());
  double nanoseconds = (n * (slots + 1) * slots + entries * (slots + 2)) * rate.elementwise;
  if (kind == OperatorKind::modal) {
    nanoseconds += n * (slots + 1) * rate.elementwise;
    cost.setup_seconds = 20 * n * n * n * nano;
    if (problem.load && !problem.load->absent() && !problem.load->constant_in_time()) nanoseconds += n * n / lanes;
  } else {
    const double w = half_bandwidth(problem.stiffness);
    const double v = border > 0 ? w + 2 : w;
    nanoseconds += n * (2 * w + 1) * rate.product;
    nanoseconds += (n + border) * (2 * v + 1) * (kind == OperatorKind::sparse ? sparse_rate : rate.substitution);
    cost.setup_seconds = n * 200 * nano;
  }
  cost.step_seconds = (nanoseconds * lanes + 60) * nano;
  return cost;
}

OperatorKind cheapest_kind(const SemiDiscrete& problem, int slots, int width, long long steps) {
  OperatorKind best = OperatorKind::band;
  double best_cost = 0;
  for (const OperatorKind kind : {OperatorKind::band, OperatorKind::modal, OperatorKind::sparse}) {
    if (!kind_applies(kind, problem)) continue;
    const Cost cost = predict_cost(kind, problem, slots, width);
    const double total = cost.setup_seconds + static_cast<double>(steps) * cost.step_seconds;
    if (best_cost == 0 || total < best_cost) {
      best = kind;
      best_cost = total;
    }
  }
  return best;
}

}  // namespace ricochet
