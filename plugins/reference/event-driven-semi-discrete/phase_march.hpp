#pragma once
#include <optional>
#include <ricochet/contract/reference.hpp>
#include <vector>

#include "contact_phase.hpp"

namespace ricochet::reference {

/// The motion as it is read on the grid.
class MotionRecord {
 public:
  MotionRecord(const ReferenceProblem& problem, const SampleGrid& grid, const LinearStructure& structure);

  double end() const { return grid_.times.empty() ? 0 : grid_.times.back(); }
  /// Whether the grid asks for more, and for which time first.
  bool pending() const { return sampled_ < grid_.times.size(); }
  double next() const { return grid_.times[sampled_]; }
  /// Takes the next time of the grid, and all others up to that of the state; `impulse` so far, N s.
  void sample(const State& now, double impulse);

  /// ½ wᵀK w, J.
  double elastic_energy(const Eigen::VectorXd& place) const { return 0.5 * (stiffness_root_ * place).squaredNorm(); }

  SampledMotion motion;

 private:
  void sample_one(const State& now, double impulse);

  const ReferenceProblem& problem_;
  const SampleGrid& grid_;
  const LinearStructure& structure_;
  Eigen::MatrixXd mass_root_, stiffness_root_;
  std::size_t sampled_ = 0;
};

/// How a phase ends: what fell below zero, and when.
struct Fall {
  double tau = 0;  ///< since the phase began, s
  Watch watch;
  double impulse = 0;  ///< Σp over the phase, N s
};

/// Follows one phase after the other, each to the first function that falls below zero. Steps resolve the fastest
/// motion that still matters, with a bound of the curvature between samples. Zeros are polished to round-off.
class PhaseMarch {
 public:
  /// `resolution`: step × fastest rate.
  PhaseMarch(const LinearStructure& structure, double resolution, MotionRecord& record)
      : at_(structure), resolution_(resolution), record_(record) {}

  /// Enters a phase. `point` is where a gap or a force has just become zero: what round-off leaves there is no event.
  void begin(const ContactModes& modes, const State& from, int point);
  /// Takes samples on the way, on top of the impulse so far; none: the motion is over.
  std::optional<Fall> march(double impulse_before);
  State state(double tau) const { return phase_->state(tau); }

 private:
  /// How fast what matters still changes, and how curved each watched function may be until then.
  struct Survey {
    double step = 0;
    Eigen::VectorXd curve, noise;
    std::vector<double> left;  // of each content
  };
  void read(double tau, Columns& at);
  void survey(double tau, const Columns& at, Survey& now) const;
  std::optional<Fall> first_of(double from, const Columns& here, double to, const Columns& there, const Survey& now);
  double pushed(double from, double to);

  const LinearStructure& at_;
  double resolution_;
  MotionRecord& record_;
  std::optional<ContactPhase> phase_;
  Columns scratch_;
  Eigen::VectorXd haze_;  // of each watch, what round-off leaves of it at the start
  long long work_ = 0;    // columns read
};

}  // namespace ricochet::reference
