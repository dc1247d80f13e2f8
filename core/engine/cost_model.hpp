#pragma once
#include <optional>
#include <ricochet/engine/stage_operator.hpp>

namespace ricochet {

struct Program;

/// Bytes that this process may still take without paging. That is what the machine has free, less where the process or
/// its group is allowed less; infinite where nobody says.
double available_memory();

/// Predicted cost of marching, from operation counts and the per-operation times that the benchmark `bench_march
/// --calibrate` measures. Only its order matters: it chooses an operator and orders cases, it is never a result.
struct Cost {
  double step_seconds = 0;  ///< one step of the whole block, shaken and touching now and then
  double setup_seconds = 0;
};

/// What a step of a plan asks for.
struct StepWork {
  int slots = 1;
  int solves = 1;                  ///< stages that solve, each of which measures and updates as well
  bool without_stiffness = false;  ///< S = s_M M in all of them: a product where M⁻¹ is known
};

/// `width`: T.
Cost predict_cost(OperatorKind kind, const SemiDiscrete& problem, const StepWork& work, int width);

/// An integration of so many steps by flights. Up to four times their root are visited, as bench_flight counts on
/// beams. Each visit is a step in modes and a search of a flight. Seconds, set-up included.
double predict_flights(const SemiDiscrete& problem, const StepWork& work, long long steps);

/// Seconds of one forcing period of so many steps by flights. Some 60 steps^0.17 of them are visited, as bench_flight
/// counts on a beam with six impacts a period.
double predict_visits(const SemiDiscrete& problem, const StepWork& work, double steps);

/// What contact asks of the steps of an integration, as counted on a part of it.
struct ContactWork {
  double touched = 0;     ///< share of the steps in which a stop is touched
  double points = 1;      ///< that push, of each solve of the law while it is
  double iterations = 1;  ///< of each such solve
};

/// What observers of an integration ask of its steps, beside the audit of energies and the recorder of impacts.
struct WatchWork {
  int observers = 0;                        ///< that are shown every step
  double numbers = 0;                       ///< that these read after each step: entries of rows
  bool samples = false;                     ///< whether the audit reads energies after every step
  std::optional<ContactWork> contact = {};  ///< unknown: an assumed share of steps, one point, one iteration
};

/// Seconds of a marched step that loads take, of the whole block.
double predict_loads(const Program& program);
/// Seconds of a marched step beside what its program predicts: works and energies added up, stops that are
/// touched, friction, observers.
double predict_watch(const Program& program, const WatchWork& watch);
/// Of it, what contact adds to a step in which a stop is touched.
double predict_touched_step(const Program& program, const ContactWork& contact);

/// A dense eigenproblem of more is not solved to march by modes.
inline constexpr int most_marched_by_modes = 1000;

/// The cheapest kind that applies for `steps` steps. Modal needs K SPD and at most most_marched_by_modes.
OperatorKind cheapest_kind(const SemiDiscrete& problem, const StepWork& work, int width, long long steps);

/// Whether the kind can represent the problem at all.
bool kind_applies(OperatorKind kind, const SemiDiscrete& problem);

}  // namespace ricochet
