#pragma once
#include <ricochet/kernels/block.hpp>
#include <ricochet/kernels/quadratic_form.hpp>

namespace ricochet {

/// xᵀA x and hᵀx of x = x_0 + Σ_k r_k x_k, in one pass over the x_k: for what is added up at every step. Rounded
/// otherwise than QuadraticForm, as well or better; the same on every instruction set that fuses a product and a sum.
/// One lane. No allocation after construction.
class CombinedForm {
 public:
  static constexpr int most_terms = 4;
  struct Value {
    double form = 0, projection = 0;
  };

  CombinedForm() = default;
  /// h: as many numbers as A has rows; null: zeros.
  explicit CombinedForm(const QuadraticForm& form, const double* h = nullptr);

  /// 1 ≤ count ≤ most_terms; `ratio` holds r_0 = 1, r_1, … Each x_k and `out` are blocks of one lane, or start on 32
  /// bytes with room up to a whole number of fours. x itself is written where `out` is given.
  Value operator()(int count, const double* const* x, const double* ratio, double* out = nullptr) const {
    return kernels_ ? kernels_[count - 1]({rows_, fours_.data()}, x, ratio, out) : at_length(count, x, ratio, out);
  }
  Value operator()(const double* x) const {
    constexpr double one = 1;
    return (*this)(1, &x, &one);
  }

  /// What a kernel reads. Fours of rows, of each W fours l_1 … l_W, then the pivots, then h; zero beyond the last row.
  struct Packed {
    int rows = 0;
    const double* fours = nullptr;
  };
  /// These fours, zeros where A is narrower; empty where it is wider than W or no sum of squares.
  static Block packed(const QuadraticForm& form, const double* h, int width);
  using Kernel = Value (*)(const Packed& packed, const double* const* x, const double* ratio, double* out);

 private:
  Value at_length(int count, const double* const* x, const double* ratio, double* out) const;

  int rows_ = 0;
  const Kernel* kernels_ = nullptr;  // by count; null: of another width, or given by factors
  Block fours_;
  QuadraticForm general_;
  Block shape_;
  mutable Block combined_;
};

}  // namespace ricochet
