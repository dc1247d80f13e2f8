#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ricochet/engine/indefinite_step.hpp>
#include <ricochet/engine/stage_operator.hpp>

namespace ricochet {
namespace {

constexpr auto mode_numbers = static_cast<std::size_t>(Modes::numbers);

/// Modal coordinates: S, K and M are diagonal, one multiplication per slot and mode.
class ModalOperator final : public StageOperator {
 public:
  ModalOperator(const MarchModel& model, const FoldedStage& stage, int lanes)
      : kernels_(lane_kernels(lanes)),
        rows_(model.rows()),
        slots_(static_cast<int>(stage.mass_history.size())),
        lanes_(lanes) {
    const Eigen::VectorXd K = model.stiffness().diagonal(), M = model.inertia().mass.diagonal();
    const Eigen::VectorXd& C = model.modal_damping();
    zero_scale_ = Block(1, lanes);
    unknown_ = Block(rows_, lanes);
    for (int i = 0; i < rows_; ++i) {
      double weight = stage.mass * M[i] + stage.stiffness * K[i];
      if (C.size() > 0) weight += stage.damping * C[i];
      // The eigenvalues μ = M are known to round-off of the largest one.
      constexpr double round_off = 1e-12;
      const double lost =
          round_off * (std::abs(stage.mass) * M.cwiseAbs().maxCoeff() + std::abs(stage.stiffness * K[i]));
      if (weight < -lost) negative_ = i;
      const double inverse = 1 / weight;
      inverse_.push_back(inverse);
      for (std::size_t j = 0; j < stage.mass_history.size(); ++j) {
        double history = stage.mass_history[j] * M[i] + stage.stiffness_history[j] * K[i];
        if (C.size() > 0) history += stage.damping_history[j] * C[i];
        coefficient_.push_back(history * inverse);
      }
      coefficient_.push_back(model.support_shape()[i] * inverse);
    }
    if (slots_ == 2) describe_modes(nullptr, nullptr);
  }

  bool solves() const {
    return std::all_of(inverse_.begin(), inverse_.end(), [](double x) { return std::isfinite(x) && x > 0; });
  }
  /// A mode on which S is negative; −1: none.
  int negative() const { return negative_; }

  bool keeps_combination() const override { return false; }
  bool takes_update() const override { return slots_ == 2; }

  // One row is summed up with the modes; more of them wait for modes that are there.
  bool takes_points(const LaneRows& rows, const double* weight) override {
    if (slots_ != 2 || rows.rows != 1 || rows.start[1] != rows_) return false;
    describe_modes(rows.value, weight);
    return true;
  }
  const Modes* modes() const override { return slots_ == 2 ? &modes_ : nullptr; }

  std::optional<int> sums_squares() const override {
    return slots_ == 2 && lanes_ == 1 ? std::optional(0) : std::nullopt;
  }

  void free_step(const FreeStepInput& input) override {
    if (input.update || input.test || input.sum) {
      ModeStep step;
      step.modes = modes_;
      step.x = input.slots;
      step.scale = input.scale ? input.scale : zero_scale_.data();
      step.z = unknown_.data();
      step.update = input.update;
      step.test = input.test;
      step.sum = input.sum;
      kernels_.mode_step(step);
      return;
    }
    kernels_.diagonal_step(rows_, slots_, coefficient_.data(), input.slots,
                           input.scale ? input.scale : zero_scale_.data(), unknown_.data());
    if (!input.load) return;
    for (int i = 0; i < rows_; ++i) {
      const double push = input.load[i] * inverse_[static_cast<std::size_t>(i)];
      for (int lane = 0; lane < lanes_; ++lane) unknown_.at(i, lane) += push;
    }
  }

  double* unknown() override { return unknown_.data(); }

  void solve_column(const double* rhs, double* x) override {
    for (int i = 0; i < rows_; ++i) x[i] = rhs[i] * inverse_[static_cast<std::size_t>(i)];
  }

 private:
  // As kernels of two slots read them: of a point that has the row `value` of H, in modes, and reads the slots and z
  // with these weights; null: none.
  void describe_modes(const double* value, const double* weight) {
    const auto rows = static_cast<std::size_t>(rows_), padded = (rows + 7) / 8 * 8;
    numbers_.assign(mode_numbers * padded, 0.0);
    modes_ = {rows_, numbers_.data(), 0};
    for (std::size_t i = 0; i < rows; ++i) {
      const double* c = coefficient_.data() + 3 * i;
      double one[mode_numbers] = {c[0], c[1], c[2], 0, 0};
      if (value) {
        one[3] = value[i] * (weight[0] + weight[2] * c[0]);
        one[4] = value[i] * (weight[1] + weight[2] * c[1]);
        modes_.direct += value[i] * (weight[2] * c[2]);
      }
      for (std::size_t j = 0; j < mode_numbers; ++j)
        numbers_[lanes_ == 1 ? j * padded + i : mode_numbers * i + j] = one[j];
    }
  }

  const LaneKernels& kernels_;
  int rows_, slots_, lanes_, negative_ = -1;
  std::vector<double> coefficient_, inverse_;
  std::vector<double, CacheLineAllocator<double>> numbers_;
  Modes modes_;
  Block unknown_, zero_scale_;
};

}  // namespace

OperatorOrRefusal make_modal_operator(const MarchModel& model, const FoldedStage& stage, int lanes) {
  auto modal = std::make_unique<ModalOperator>(model, stage, lanes);
  if (modal->negative() >= 0) throw IndefiniteMatrix{fmt::format("mode {} of {}", modal->negative() + 1, model.rows())};
  if (!modal->solves()) return Refusal{"the matrix of the step is singular on a mode"};
  return std::unique_ptr<StageOperator>(std::move(modal));
}

}  // namespace ricochet
