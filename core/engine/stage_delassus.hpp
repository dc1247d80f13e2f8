#pragma once
#include <cstddef>
#include <memory>
#include <ricochet/contact_solvers/held_band.hpp>
#include <ricochet/contract/contact_law.hpp>
#include <ricochet/engine/march_model.hpp>
#include <ricochet/engine/stage_operator.hpp>
#include <vector>

namespace ricochet {

/// A small symmetric system over the active points of one lane, A = reach·W + compliance·I, factorised by L D Lᵀ.
/// Allocates in reserve() only.
struct ActiveSystem {
  std::vector<int> points;
  std::vector<double> matrix, right, slopes;
  std::vector<double>
      round;  ///< of points of circles: of the right side, over the displacement of its own and the other
  std::size_t capacity = 0;

  void reserve(int most);
  double& at(std::size_t i, std::size_t j) { return matrix[i * capacity + j]; }
  /// L below the diagonal, D on it; zero for a point that depends on those before it.
  void factorise();
  /// Solves for `right` in place; a point that depends on the others carries nothing.
  void solve();
};

/// Columns of W = H S⁻¹ Hᵀ and the responses S⁻¹Hᵀ e_j of one stage, kept once computed. Where S is a band, W is there
/// as a whole. Where points rub, H has the rows along which they do behind those of the points, and W goes by columns.
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

/// What an effort of 1 N at a contact point does in a stage with an impulse. C = αK + ηM is folded in, R = r_M M + r_K
/// K and f_M M + f_K K the feed; M w is had from R w = ι Hᵀp, so that a mass in factors is never formed:
///
///     R w = ι Hᵀe_j,     S z = (π₀ + ι f_M/r_M) Hᵀe_j + (f_K − f_M r_K/r_M) K w
struct ImpulseProgram {
  std::unique_ptr<StageOperator> op;  ///< R; null: the law that is read moves no w
  double direct = 0;                  ///< π₀ + ι f_M/r_M
  double elastic = 0;                 ///< f_K − f_M r_K/r_M
  double weight = 0;                  ///< ι
  double measure_z = 0, measure_w = 0;
};

/// Columns of W = H(y_z Z + y_w W_R), and of what z (Z) and w (W_R) move by, kept once computed: two solves each. A law
/// that is given these has the reach 1.
class StageImpulse final : public DelassusColumns {
 public:
  StageImpulse(const ImpulseProgram& program, StageOperator& op, const MarchModel& model);

  const double* column(int j) override {
    know(j);
    return at(columns_, j, points_);
  }
  const double* unknown(int j) {
    know(j);
    return at(unknowns_, j, rows_);
  }
  const double* jump(int j) {
    know(j);
    return at(jumps_, j, rows_);
  }
  /// How many columns were asked for so far.
  int computed() const;

 private:
  using Columns = std::unique_ptr<double[]>;
  static double* at(const Columns& columns, int j, int rows) {
    return columns.get() + static_cast<std::size_t>(j) * static_cast<std::size_t>(rows);
  }
  void know(int j) {
    if (!known_[static_cast<std::size_t>(j)]) compute(j);
  }
  void compute(int j);

  const ImpulseProgram& program_;
  StageOperator& op_;
  const MarchModel& model_;
  int rows_, points_;
  std::vector<bool> known_;
  // Pages that no point ever asks for are never written, hence never paid for.
  Columns columns_, unknowns_, jumps_;
  std::vector<double> push_, rhs_;
};

}  // namespace ricochet
