#pragma once
#include <array>
#include <ricochet/contract/step_plan.hpp>
#include <utility>

/// \file
/// Combinations of slots, operators and times written as a page writes them:
///
///     const auto [q, v, a] = slots<3>();
///     const Combination next = q + h * v + (0.5 - beta) * h * h * a + beta * h * h * z;
///     const Combination next_v = v + (1 - gamma) * h * a + gamma * h * z;
///     Stage stage = equation(M * z + C * next_v + K * next, (1 - theta) * at(0) + theta * at(1));
///
/// A sum adds weights slot by slot; a factor multiplies each: the numbers are those of the formula, in its order.
namespace ricochet {

/// b of a stage: one row of weights of M, C and K per slot (step_plan.hpp, equation 3).
using History = std::vector<OperatorWeights>;

/// A sum of operators applied to combinations (N): what it weighs of each slot, and of z.
struct Forces {
  History slots;
  OperatorWeights z;
  /// b alone; what is weighed of z belongs into S.
  operator History() const { return slots; }
};

namespace plan_algebra {

/// The slots of a plan, x_0 … x_{count−1}.
template <std::size_t count>
std::array<Combination, count> slots() {
  std::array<Combination, count> all;
  for (std::size_t j = 0; j < count; ++j) {
    all[j].slots.assign(j + 1, 0.0);
    all[j].slots[j] = 1;
  }
  return all;
}
/// The unknowns of a stage.
inline const Combination z{.slots = {}, .z = 1}, w{.slots = {}, .z = 0, .w = 1};
inline constexpr OperatorWeights M{1, 0, 0}, C{0, 1, 0}, K{0, 0, 1};
/// The time t + c h, with weight 1.
inline Levels at(double c) {
  return {{c, 1}};
}

}  // namespace plan_algebra

inline Combination operator*(double factor, Combination c) {
  for (double& slot : c.slots) slot *= factor;
  c.z *= factor;
  c.w *= factor;
  return c;
}
inline Combination operator/(Combination c, double divisor) {
  for (double& slot : c.slots) slot /= divisor;
  c.z /= divisor;
  c.w /= divisor;
  return c;
}
inline Combination operator+(Combination a, const Combination& b) {
  if (a.slots.size() < b.slots.size()) a.slots.resize(b.slots.size(), 0.0);
  for (std::size_t j = 0; j < b.slots.size(); ++j) a.slots[j] += b.slots[j];
  a.z += b.z;
  a.w += b.w;
  return a;
}
inline Combination operator-(const Combination& c) {
  return -1.0 * c;
}
inline Combination operator-(Combination a, const Combination& b) {
  return std::move(a) + -b;
}
/// The same without its unknowns: what is known before the solve.
inline Combination known(Combination c) {
  c.z = c.w = 0;
  return c;
}

inline constexpr OperatorWeights operator*(double factor, const OperatorWeights& o) {
  return {factor * o.M, factor * o.C, factor * o.K};
}
inline constexpr OperatorWeights operator/(const OperatorWeights& o, double divisor) {
  return {o.M / divisor, o.C / divisor, o.K / divisor};
}
inline constexpr OperatorWeights operator+(const OperatorWeights& a, const OperatorWeights& b) {
  return {a.M + b.M, a.C + b.C, a.K + b.K};
}
inline constexpr OperatorWeights operator-(const OperatorWeights& o) {
  return -1.0 * o;
}
inline constexpr OperatorWeights operator-(const OperatorWeights& a, const OperatorWeights& b) {
  return a + -b;
}

/// An operator applied to a combination.
inline Forces operator*(const OperatorWeights& o, const Combination& c) {
  Forces forces{{}, c.z * o};
  for (const double weight : c.slots) forces.slots.push_back(weight * o);
  return forces;
}
inline Forces operator*(double factor, Forces forces) {
  for (OperatorWeights& row : forces.slots) row = factor * row;
  return {std::move(forces.slots), factor * forces.z};
}
inline Forces operator+(Forces a, const Forces& b) {
  if (a.slots.size() < b.slots.size()) a.slots.resize(b.slots.size());
  for (std::size_t j = 0; j < b.slots.size(); ++j) a.slots[j] = a.slots[j] + b.slots[j];
  return {std::move(a.slots), a.z + b.z};
}
inline Forces operator-(Forces forces) {
  return -1.0 * std::move(forces);
}
inline Forces operator-(Forces a, const Forces& b) {
  return std::move(a) + -b;
}

/// The stage whose equation is forces = load + Hᵀp: S is what they weigh of z, b what they weigh of the slots,
/// negative.
inline Stage equation(const Forces& forces, Levels load) {
  Stage stage;
  stage.matrix = forces.z;
  stage.history = -forces;
  stage.load = std::move(load);
  return stage;
}

inline Levels operator*(double factor, Levels levels) {
  for (Level& level : levels) level.weight *= factor;
  return levels;
}
/// Both lists of times; the same time twice stays twice.
inline Levels operator+(Levels a, const Levels& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}
inline Levels operator-(Levels a, const Levels& b) {
  return std::move(a) + -1.0 * b;
}

/// coefficient · |x|²_A, a term of the scheme's energy (J).
inline QuadraticTerm square(EnergyMatrix matrix, double coefficient, const Combination& x) {
  return {matrix, coefficient, x.slots};
}

}  // namespace ricochet
