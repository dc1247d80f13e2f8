#pragma once
#include <array>
#include <ricochet/engine/compile.hpp>

namespace ricochet {

/// The momentum that contact efforts have given by the end of each step (N s), whatever the plan. The plan itself moves
/// a free unit mass under the sum of the efforts, with the weights that the program gives them. The velocity of that
/// mass is read as the plan reads it. In a plan of one stage that is Σ h p; where an effort acts over several steps
/// (Newmark: γh now, (1−γ)h in the next; averaged penalties), its momentum comes when the plan gives it.
/// Allocates in its constructor only; between contacts it costs one test.
class MomentumLedger {
 public:
  explicit MomentumLedger(const Program& program);

  /// Σ_i p_i that stage `k` of the start rule or of a step found (0 where it found none); every stage in turn.
  void stage(bool starting, std::size_t k, double force) {
    if (moving_ || force != 0) move(starting, k, force);
  }
  void step_done() {
    if (moving_) settle();
  }
  /// Whether efforts found so far still give some.
  bool moving() const { return moving_; }
  /// Where the scheme's velocity stands: at Program::velocity_offset.
  double momentum() const { return given_ + velocity_; }

 private:
  struct Stage {
    std::array<std::array<double, most_slots>, most_slots> slots{};  // x ← A x + b e
    std::array<double, most_slots> push{};
    std::array<double, most_slots> jump{};  // of the effort that is found now, through w
    bool jumps = false;
    std::array<double, most_efforts> weights{};
    std::size_t efforts = 0;
  };
  Stage describe(const ricochet::Stage& plan, const StageProgram& program) const;
  void move(bool starting, std::size_t k, double force);
  void settle();
  void restart();

  std::size_t slot_count_ = 0;
  std::vector<Stage> start_, stages_;
  std::array<double, most_slots> reads_{};  // the velocity
  std::array<double, most_slots> state_{};
  std::array<double, most_efforts> past_{};  // newest first
  int quiet_ = 0;                            // stages since the last effort
  bool moving_ = false;
  double given_ = 0, velocity_ = 0, largest_change_ = 0;
};

}  // namespace ricochet
