#pragma once
#include <limits>
#include <optional>
#include <ricochet/engine/compile.hpp>
#include <ricochet/kernels/block.hpp>
#include <vector>

namespace ricochet {

/// The distributed load F in model coordinates at the time levels that the current step needs, each assembled once.
class LoadWindow {
 public:
  explicit LoadWindow(const Program& program);

  /// Σ φ_k F(t + c_k h), n numbers that stay until the next call.
  const double* sum(const Levels& levels, double t);

 private:
  struct Entry {
    double level = std::numeric_limits<double>::quiet_NaN();  // in steps
    long long used = -1;                                      // when it was last asked for
    std::vector<double> value;
  };
  void assemble(double t, std::vector<double>& out);

  const SemiDiscrete* problem_;
  const MarchModel* model_;
  double h_;
  bool constant_;
  std::vector<Entry> entries_;
  std::vector<double> sum_, nodal_;
  std::vector<std::vector<double>> terms_;  // of the load
  long long clock_ = 0;
};

/// The clamp's motion φ = A sin(ωt + ψ) for all lanes of a block, each with its own A and ψ. Sine and cosine are asked
/// for once per step, whatever the number of lanes and of time levels.
class ClampMotion {
 public:
  ClampMotion(double pulsation, int width);

  /// A (m) and ψ (rad) of a lane; those of a lane that was never placed are zero.
  void place(int lane, double amplitude, double phase);
  void stop(int lane) { amplitude_.at(0, lane) = 0; }

  /// When the step begins, s. Asked for again, it costs nothing.
  void set_time(double t);
  /// At the beginning of a step of length h, always the same. Steps up to one that was expected are asked for once.
  void set_step(long long step, double h);
  void expect(long long last_step);
  double time() const { return time_; }
  /// A sin ωt of a lane, then, where no lane has a phase; else nothing.
  std::optional<double> plain(double amplitude) const {
    return phases_ ? std::nullopt : std::optional(amplitude * sine_);
  }
  /// A sin(ωt + ψ) and A cos(ωt + ψ) of a lane, then.
  void drive(int lane, double& sine, double& cosine) const {
    sine = sine_;
    cosine = cosine_;
    turn(lane, sine, cosine);
  }
  /// The same of another time, whose sin ωt and cos ωt are given.
  void turn(int lane, double& sine, double& cosine) const {
    const double A = amplitude_.at(0, lane), c = cos_phase_.at(0, lane), s = sin_phase_.at(0, lane);
    const double of_time = sine;
    sine = A * (of_time * c + cosine * s);
    cosine = A * (cosine * c - of_time * s);
  }
  double sine() const { return sine_; }
  double cosine() const { return cosine_; }
  /// Σ_k w_k A sin(ω(t + c_k h) + ψ), or its rate, per lane; `phase` holds the levels (w_k, c_k).
  void offsets(const PhaseWeights& phase, double* out, bool rate) const;
  /// ω² times the first of these: what the clamp's acceleration gives to a load.
  void accelerations(const PhaseWeights& phase, double* out) const;

 private:
  double pulsation_, time_ = 0, sine_ = 0, cosine_ = 1;  // ω, t, sin ωt, cos ωt
  Block amplitude_, cos_phase_, sin_phase_;              // 1 × T
  bool phases_ = false;                                  // whether some ψ is not zero
  struct Known {
    double sine = std::numeric_limits<double>::quiet_NaN(), cosine = 0;
  };
  std::vector<Known> known_;  // by steps; NaN: not asked for yet
};

}  // namespace ricochet
