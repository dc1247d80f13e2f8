#pragma once
#include <ricochet/engine/stage_operator.hpp>

namespace ricochet {

/// Predicted cost of marching, from operation counts and the per-operation times that the benchmark `bench_march
/// --calibrate` measures. Only its order matters: it chooses an operator and orders cases, it is never a result.
struct Cost {
  double step_seconds = 0;  ///< one step of the whole block, contact closed excluded
  double setup_seconds = 0;
};

/// `points`: rows of H; `slots`: of the plan; `width`: T.
Cost predict_cost(OperatorKind kind, const SemiDiscrete& problem, int slots, int width);

/// The cheapest kind that applies for `steps` steps. Modal needs K SPD and few enough dofs for a dense eigenproblem.
OperatorKind cheapest_kind(const SemiDiscrete& problem, int slots, int width, long long steps);

/// Whether the kind can represent the problem at all.
bool kind_applies(OperatorKind kind, const SemiDiscrete& problem);

}  // namespace ricochet
