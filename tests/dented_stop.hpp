#pragma once
#include <algorithm>
#include <memory>
#include <ricochet/contact_solvers/pointwise_solver.hpp>

/// \file
/// A stop that keeps a dent, for what is asked of laws that remember.
namespace ricochet::testing {

/// Walton and Braun's (1986) springs: k δ on the way to a new greatest depth D, k D − K (D − δ) ≥ 0 on the way back and
/// in again, K > k. It lets go at D (1 − k/K). A point of mass m comes off with √(k/K) of its speed.
///
/// Memory: D of the lower and of the upper stop.
class DentedStop final : public PointwiseContact {
 public:
  static constexpr double loading = 1e4, unloading = 4e4;  // N/m
  /// `forgets`: tells the energy of the loading spring, as a law does whose energy cannot see what it keeps.
  explicit DentedStop(bool forgets = false)
      : PointwiseContact({Evaluation::implicit_end, StepForce::at_measure}), forgets_(forgets) {}
  int memory_per_point() const override { return 2; }
  bool per_point() const override { return false; }
  void solve(ReducedProblem& problem) override {
    problem_ = &problem;
    PointwiseContact::solve(problem);
    for (const int lane : problem.touched) keep(problem.lane(lane), lane);
  }
  double potential(const StopState& at) const override {
    if (forgets_) return at.depth > 0 ? 0.5 * loading * at.depth * at.depth : 0;
    const double p = pushed(at.depth, at.memory[at.side > 0 ? 0 : 1]).value;
    return 0.5 * p * p / unloading;
  }

 private:
  static PointForce pushed(double depth, double deepest) {
    if (depth <= 0) return {};
    if (depth >= deepest) return {.value = loading * depth, .stiffness = loading};
    const double p = loading * deepest - unloading * (deepest - depth);
    return p > 0 ? PointForce{.value = p, .stiffness = unloading} : PointForce{};
  }
  void keep(const LaneProblem& lane, int number) {
    for (int i = 0; i < lane.points; ++i) {
      double place = lane.free[i];
      for (int j = 0; lane.reach > 0 && j < lane.points; ++j)
        if (lane.effort[j] != 0) place += lane.reach * lane.delassus->column(j)[i] * lane.effort[j];
      for (const int which : {0, 1}) {
        double& deepest = problem_->memory_of(number, which)[i];
        deepest = std::max(deepest, which == 0 ? lane.lower[i] - place : place - lane.upper[i]);
      }
    }
  }
  void set_lanes(std::span<const Parameters>) override {}
  PointForce at(const ContactState& state) const override {
    return pushed(state.depth, problem_->memory_of(state.lane, state.side > 0 ? 0 : 1)[state.point]);
  }
  PointForce gradient(const ContactState& state) const override { return at(state); }
  double stored(double, int) const override { return 0; }

  bool forgets_;
  const ReducedProblem* problem_ = nullptr;  // while it is solved
};

}  // namespace ricochet::testing
