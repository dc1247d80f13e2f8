#pragma once
#include <ricochet/kernels/lane_vectors.hpp>

/// \file
/// Sums of squares of one lane beside a step that has its numbers in registers, see SquareSum.
namespace ricochet::lane_bodies {

RICOCHET_INLINE double total(const Vector4& sum) {
  return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

/// Fours of rows from the last to the first; W as many l as a row has.
template <int W>
class SquaresUp {
 public:
  RICOCHET_INLINE SquaresUp(const SquareSum& sum, long groups)
      : fours_(sum.fours + stride * groups), ratio_(sum.ratio) {}

  /// The next four of z and of x_1; zeros beyond the last row.
  RICOCHET_INLINE void add(const Vector4& z, const Vector4& x) {
    fours_ -= stride;
    const Vector4 here = z + ratio_ * x;
    Vector4 strain = here;
    if constexpr (W >= 1) strain += load4(fours_) * __builtin_shufflevector(here, after_, 1, 2, 3, 4);
    if constexpr (W >= 2) strain += load4(fours_ + 4) * __builtin_shufflevector(here, after_, 2, 3, 4, 5);
    if constexpr (W >= 3) strain += load4(fours_ + 8) * __builtin_shufflevector(here, after_, 3, 4, 5, 6);
    form_ += load4(fours_ + 4 * W) * strain * strain;
    projection_ += load4(fours_ + 4 * W + 4) * here;
    after_ = here;
  }
  RICOCHET_INLINE void finish(SquareSum& sum) const {
    sum.form = total(form_);
    sum.projection = total(projection_);
  }

 private:
  static constexpr int stride = 4 * (W + 2);
  const double* fours_;
  double ratio_;
  Vector4 after_ = {}, form_ = {}, projection_ = {};
};

/// Whether the squares of modes are summed up at all, and whether with weights d.
enum class Weights { none, ones, any };

/// Fours of modes, which no l couples, from the first to the last.
template <Weights weights>
class SquaresDown {
 public:
  RICOCHET_INLINE SquaresDown() {}
  RICOCHET_INLINE explicit SquaresDown(const SquareSum& sum) : fours_(sum.fours), ratio_(sum.ratio) {}

  /// The next four of z and of x_1; `rows` of them are there.
  RICOCHET_INLINE void add(long rows, const Vector4& z, const Vector4& x) {
    Vector4 here = z + ratio_ * x;
    if (rows < 4)
      for (long k = 1; k < 4; ++k)
        if (k >= rows) here[k] = 0;
    if constexpr (weights == Weights::ones)
      form_ += here * here;
    else
      form_ += load4(fours_) * here * here;
    projection_ += load4(fours_ + 4) * here;
    fours_ += 8;
  }
  RICOCHET_INLINE void finish(SquareSum& sum) const {
    sum.form = total(form_);
    sum.projection = total(projection_);
  }

 private:
  const double* fours_ = nullptr;
  double ratio_ = 0;
  Vector4 form_ = {}, projection_ = {};
};

}  // namespace ricochet::lane_bodies
