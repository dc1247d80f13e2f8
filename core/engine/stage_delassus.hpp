#pragma once
#include <memory>
#include <ricochet/algebra/held_band.hpp>
#include <ricochet/engine/march_model.hpp>
#include <ricochet/engine/stage_operator.hpp>
#include <vector>

namespace ricochet {

/// Columns of W = H S⁻¹ Hᵀ and the responses S⁻¹Hᵀ e_j of one stage, kept once computed; where S is a band, W as a
/// whole.
class StageDelassus final : public BandDelassus {
 public:
  /// `band`: the stage, where its S is factorised as a band; else null.
  StageDelassus(StageOperator& op, const MarchModel& model, const FoldedStage* band);

  const double* column(int j) override {
    if (!known_[static_cast<std::size_t>(j)]) compute(j);
    return columns_.get() + static_cast<std::size_t>(j) * static_cast<std::size_t>(points_);
  }
  const double* response(int j) {
    if (!known_[static_cast<std::size_t>(j)]) compute(j);
    return responses_.get() + static_cast<std::size_t>(j) * static_cast<std::size_t>(rows_);
  }
  HeldBand* held() override;
  /// S⁻¹Hᵀ p (n) for efforts `stride` apart, in one solve; valid until the next.
  const double* respond(const double* efforts, int stride);
  /// How many columns were asked for so far.
  int computed() const;

 private:
  void compute(int j);

  StageOperator& op_;
  const MarchModel& model_;
  const FoldedStage* band_;
  const RowMatrix& contact_;
  int rows_, points_;
  std::vector<bool> known_;
  // Pages that no point ever asks for are never written, hence never paid for.
  std::unique_ptr<double[]> columns_, responses_;
  std::vector<double> rhs_, response_;
  std::unique_ptr<HeldBand> held_;
};

}  // namespace ricochet
