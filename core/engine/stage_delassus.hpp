#pragma once
#include <memory>
#include <ricochet/contract/contact_law.hpp>
#include <ricochet/engine/march_model.hpp>
#include <ricochet/engine/stage_operator.hpp>
#include <vector>

namespace ricochet {

/// Columns of W = H S⁻¹ Hᵀ and the responses S⁻¹Hᵀ e_j of one stage, kept once computed.
class StageDelassus final : public DelassusColumns {
 public:
  StageDelassus(StageOperator& op, const RowMatrix& contact, int rows);

  const double* column(int j) override {
    if (!known_[static_cast<std::size_t>(j)]) compute(j);
    return columns_.get() + static_cast<std::size_t>(j) * static_cast<std::size_t>(points_);
  }
  const double* response(int j) {
    if (!known_[static_cast<std::size_t>(j)]) compute(j);
    return responses_.get() + static_cast<std::size_t>(j) * static_cast<std::size_t>(rows_);
  }
  /// How many columns were asked for so far.
  int computed() const;

 private:
  void compute(int j);

  StageOperator& op_;
  const RowMatrix& contact_;
  int rows_, points_;
  std::vector<bool> known_;
  // Pages that no point ever asks for are never written, hence never paid for.
  std::unique_ptr<double[]> columns_, responses_;
  std::vector<double> rhs_;
};

}  // namespace ricochet
