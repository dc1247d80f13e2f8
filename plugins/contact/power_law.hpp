#pragma once
#include <array>
#include <cmath>
#include <ricochet/contact_solvers/pointwise_solver.hpp>
#include <ricochet/contract/plugin.hpp>
#include <vector>

namespace ricochet {

/// p = k δⁿ for δ > 0, U = k δⁿ⁺¹/(n+1): what the laws of this folder have in common.
struct PowerLaw {
  double stiffness = 0;  ///< k, N/mⁿ
  double exponent = 1;   ///< n ≥ 1

  double stored(double depth) const { return depth > 0 ? force(depth) * depth / (exponent + 1) : 0.0; }
  double force(double depth) const {
    if (!(depth > 0)) return 0;
    return exponent == 1 ? stiffness * depth : stiffness * std::pow(depth, exponent);
  }
  double slope(double depth) const {
    if (!(depth > 0)) return 0;
    return exponent == 1 ? stiffness : stiffness * exponent * std::pow(depth, exponent - 1);
  }
  PointForce at(double depth) const { return {.value = force(depth), .stiffness = slope(depth)}; }

  /// The discrete gradient [U(δ) − U(δ⁻)]/(δ − δ⁻): its work over the step is U(δ) − U(δ⁻) whatever the step. Where
  /// both depths are equal to 1e-9, it is the force half-way. Written with expm1, so that it does not cancel in
  /// between.
  PointForce between(double depth, double before) const;
};

inline PointForce PowerLaw::between(double depth, double before) const {
  constexpr double equal = 1e-9;
  const double change = depth - before;
  if (std::abs(change) <= equal * std::max(std::abs(depth), std::abs(before))) {
    const double half = 0.5 * (depth + before);
    return {.value = force(half), .stiffness = 0.5 * slope(half), .before = 0.5 * slope(half)};
  }
  PointForce mean;
  if (depth > 0 && before > 0) {
    const double ratio = change / before, power = exponent + 1;
    mean.value = stored(before) * std::expm1(power * std::log1p(ratio)) / change;
  } else {
    mean.value = (stored(depth) - stored(before)) / change;
  }
  mean.stiffness = (force(depth) - mean.value) / change;
  mean.before = (mean.value - force(before)) / change;
  return mean;
}

/// The slopes of a spring where a point pushes: of a mean over the step, a half at each of its ends.
inline ContactSlopes spring_slopes(double stiffness, std::optional<Evaluation> reads) {
  if (reads != Evaluation::conserving) return {.stiffness = stiffness};
  return {.stiffness = stiffness / 2, .before = stiffness / 2};
}

/// What the word parameter `evaluation` names: a measure of the scheme, or a mean over the step.
inline ForceEvaluation evaluation_of(const Parameters& parameters) {
  const std::string& word = parameters.word("evaluation");
  if (word == "midpoint") return {Evaluation::conserving, StepForce::midpoint};
  if (word == "hybrid") return {Evaluation::conserving, StepForce::hybrid};
  if (word == "conserving") return {Evaluation::conserving, StepForce::gradient};
  if (word == "averaged") return {Evaluation::averaged};
  if (word == "explicit") return {Evaluation::explicit_start};
  return {};
}

inline ParameterSpec evaluation_parameter() {
  return word_parameter("evaluation", {"implicit", "averaged", "explicit", "midpoint", "conserving", "hybrid"},
                        "implicit", "where in the step the depth is taken that makes the contact force");
}

inline constexpr const char* evaluation_source =
    R"(conserving: Simo and Tarnow (1992), Gonzalez (2000); hybrid: Chouly, Hild and Renard (2015), A Nitsche finite
          element method for dynamic contact)";

/// What the words mean, for the manual of a law without losses.
inline constexpr const char* evaluation_text =
    R"(Where in the step δ is measured is `evaluation`: implicit at the end of the step, averaged over the levels over
          which the scheme averages the elastic force, explicit at what is known when the step begins, midpoint
          half-way between the depths before and after the step, hybrid the same where the step begins in contact and
          else half of the force at its end, conserving by the difference of the stored energy over the step, which
          the energy of the scheme then gives and takes back to round-off. )";

inline ParameterSpec stiffness_parameter(const char* unit, const char* text) {
  ParameterSpec stiffness = real_parameter("stiffness", unit, std::nullopt, {.low = 0, .low_open = true}, text);
  stiffness.per_lane = true;
  return stiffness;
}

inline ParameterSpec viscosity_parameter(Range range, const char* text) {
  ParameterSpec viscosity = real_parameter("viscosity", "N s/m", std::nullopt, range, text);
  viscosity.per_lane = true;
  return with_role(viscosity, ParameterRole::damping);
}

inline ParameterSpec exponent_parameter() {
  ParameterSpec exponent = real_parameter("exponent", "1", 1.5, {.low = 1, .high = 5},
                                          "n, exponent of the depth: 1.5 for a sphere on a plane, 1 for a spring");
  exponent.per_lane = true;
  return exponent;
}

inline std::vector<PowerLaw> power_laws(std::span<const Parameters> lanes) {
  std::vector<PowerLaw> laws;
  for (const Parameters& lane : lanes) laws.push_back({lane.real("stiffness"), lane.real("exponent")});
  return laws;
}

/// The discrete gradient [U(δ) − U(δ⁻)]/(δ − δ⁻) of a law with stored(), force() and slope(), whose force changes over
/// lengths of `scale` (m) near both depths. Where they are closer than a fiftieth of that, the difference would cancel.
/// There the mean of the force over the way is taken at five Gauss points, exact to round-off.
template <class Law>
PointForce mean_force(const Law& law, double depth, double before, double scale) {
  constexpr double near = 0.02;
  const double change = depth - before;
  if (!(depth > 0 && before > 0) || std::abs(change) > near * scale) {
    PointForce mean;
    mean.value = (law.stored(depth) - law.stored(before)) / change;
    mean.stiffness = (law.force(depth) - mean.value) / change;
    mean.before = (mean.value - law.force(before)) / change;
    return mean;
  }
  // Of the interval from −1 to 1: node, weight/2.
  constexpr std::array<std::array<double, 2>, 5> points = {{{-0.906179845938663992797627, 0.118463442528094543757132},
                                                            {-0.538469310105683091036314, 0.239314335249683234020646},
                                                            {0, 0.284444444444444444444444},
                                                            {0.538469310105683091036314, 0.239314335249683234020646},
                                                            {0.906179845938663992797627, 0.118463442528094543757132}}};
  const double half = 0.5 * (depth + before);
  PointForce mean{.stiffness = 0.5 * law.slope(half), .before = 0.5 * law.slope(half)};
  for (const auto& [node, weight] : points) mean.value += weight * law.force(half + 0.5 * node * change);
  return mean;
}

/// p = f (1 + χ δ̇)₊ with an elastic force f: k δⁿ or its mean over a step. It grows with the speed of closing and
/// never pulls. It starts and ends at zero.
inline PointForce damped(const PointForce& elastic, double chi, double rate) {
  const double factor = 1 + chi * rate;
  PointForce force;
  // What is not given back: (p − f) δ̇.
  if (factor > 0) {
    force.value = elastic.value * factor;
    force.stiffness = elastic.stiffness * factor;
    force.before = elastic.before * factor;
    force.viscosity = elastic.value * chi;
    force.dissipation = elastic.value * chi * rate * rate;
  } else {
    force.dissipation = -elastic.value * rate;
  }
  return force;
}

/// A dashpot that is felt beyond the stop: c δ̇, or nothing on the way out where it is `one_way`.
struct Dashpot {
  double viscosity = 0;  ///< c, N s/m
  bool one_way = false;

  /// At δ > 0.
  PointForce at(double rate) const { return of(rate, {.value = 1}); }
  /// Over a step: on the share of its way that lies beyond the stop, [δ₊ − δ⁻₊]/(δ − δ⁻): no jump at entry.
  PointForce over(const ContactState& step) const { return of(step.rate, beyond(step)); }

  /// That share of the way, and how it changes.
  static PointForce beyond(const ContactState& state) {
    if (state.depth > 0 && state.before > 0) return {.value = 1};
    const double way = state.depth - state.before, square = way * way;
    if (state.depth > 0) return {state.depth / way, -state.before / square, 0, state.depth / square};
    return {-state.before / way, state.before / square, 0, -state.depth / square};
  }

 private:
  PointForce of(double rate, const PointForce& share) const {
    if (one_way && !(rate > 0)) return {};
    const double acting = viscosity * share.value, viscous = acting * rate;
    return {.value = viscous,
            .stiffness = viscosity * share.stiffness * rate,
            .viscosity = acting,
            .before = viscosity * share.before * rate,
            .dissipation = viscous * rate};
  }
};

/// A spring beside a dashpot, which never pull. What the spring gives back beyond that is lost too.
inline PointForce beside(const PointForce& elastic, const PointForce& viscous, double rate) {
  if (!(elastic.value + viscous.value > 0)) return {.dissipation = -elastic.value * rate};
  return {.value = elastic.value + viscous.value,
          .stiffness = elastic.stiffness + viscous.stiffness,
          .viscosity = viscous.viscosity,
          .before = elastic.before + viscous.before,
          .dissipation = elastic.dissipation + viscous.dissipation};
}

/// Calls keep(point, side, δ) with the depths that the efforts of a solved lane lead to, at both stops of each point.
template <class Keep>
void each_depth(const ReducedProblem& problem, int number, Keep keep) {
  const LaneProblem lane = problem.lane(number);
  for (int i = 0; i < lane.points; ++i) {
    double place = lane.free[i];
    for (int j = 0; lane.reach > 0 && j < lane.points; ++j)
      if (lane.effort[j] != 0) place += lane.reach * lane.delassus->column(j)[i] * lane.effort[j];
    keep(i, 1, lane.lower[i] - place);
    keep(i, -1, place - lane.upper[i]);
  }
}

/// The number that a law keeps of each of the two stops of a point.
inline int memory_of_side(int side) {
  return side > 0 ? 0 : 1;
}

/// What `evaluation` means for a law that damps.
inline constexpr const char* damped_evaluation_text =
    R"(`evaluation` says where in the step depth and speed are taken: implicit at its end, averaged over the levels
          over which the scheme averages the elastic force, explicit at what is known when it begins; midpoint
          half-way between the depths before and after the step, hybrid the same where the step begins in contact and
          else half of the force at its end, conserving with the elastic part by the difference of its energy over the
          step, which then comes back to round-off but for what is reported as dissipated; these with the mean speed
          over the step. )";

}  // namespace ricochet
