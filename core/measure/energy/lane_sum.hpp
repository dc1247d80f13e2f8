#pragma once
#include <array>
#include <ricochet/algebra/block.hpp>
#include <ricochet/algebra/combined_form.hpp>
#include <ricochet/algebra/lane_kernels.hpp>
#include <ricochet/contract/step_plan.hpp>
#include <vector>

namespace ricochet {

/// A combination as a list of the vectors that it weighs, in the order of the slots, then z, then w.
struct WeighedTerms {
  static constexpr int unknown_z = -1, unknown_w = -2;
  std::vector<int> which;  ///< slot, or an unknown
  std::vector<double> weight;
  std::vector<double> ratio;  ///< weight over the first one

  WeighedTerms() = default;
  explicit WeighedTerms(const Combination& c) {
    for (std::size_t j = 0; j < c.slots.size(); ++j) add(static_cast<int>(j), c.slots[j]);
    add(unknown_z, c.z);
    add(unknown_w, c.w);
  }
  void add(int vector, double by) {
    if (by == 0) return;
    which.push_back(vector);
    weight.push_back(by);
    ratio.push_back(by / weight[0]);
  }
  friend bool operator==(const WeighedTerms&, const WeighedTerms&) = default;
};

/// Σ_k w_k x_k of one lane of blocks that are T wide. What only a form asks of is not written down where T = 1.
class LaneSum {
 public:
  LaneSum(const WeighedTerms& terms, int T, int lane) : terms_(&terms), T_(T), lane_(lane) {}
  /// As the stage finds them: nothing where w did not jump.
  LaneSum(const WeighedTerms& terms, const double* const* slots, const double* z, const double* w, int T, int lane)
      : LaneSum(terms, T, lane) {
    for (const int which : terms.which) {
      const double* x = which >= 0 ? slots[which] : which == WeighedTerms::unknown_z ? z : w;
      if (x) add(x);
    }
  }
  /// The next of the vectors; those that are left out at the end are zero.
  void add(const double* x) { x_[static_cast<std::size_t>(count_++)] = x; }

  /// Its numbers, in `out` where they do not stand already.
  const double* write(Block& out) const {
    const double* weight = terms_->weight.data();
    if (T_ == 1 && count_ == 1 && weight[0] == 1) return x_[0];
    if (T_ == 1 && count_ > 0 && count_ <= most_lane_slots) {
      lane_kernels(1).combine(static_cast<long>(out.size()), count_, x_.data(), weight, out.data());
      return out.data();
    }
    out.fill(0.0);
    const auto T = static_cast<std::size_t>(T_), l = static_cast<std::size_t>(lane_);
    for (int k = 0; k < count_; ++k) {
      const double* from = x_[static_cast<std::size_t>(k)];
      for (std::size_t i = 0; i < out.size(); ++i) out.data()[i] += weight[k] * from[i * T + l];
    }
    return out.data();
  }

  /// What a form says of it; `numbers` holds it afterwards where it is given. Otherwise `scratch` may be written.
  CombinedForm::Value under(const CombinedForm& form, Block& scratch, Block* numbers = nullptr) const {
    if (T_ == 1 && count_ > 0 && count_ <= CombinedForm::most_terms) {
      const double scale = terms_->weight[0];
      CombinedForm::Value value = form(count_, x_.data(), terms_->ratio.data(), numbers ? numbers->data() : nullptr);
      if (scale == 1) return value;
      if (numbers)
        for (std::size_t i = 0; i < numbers->size(); ++i) numbers->data()[i] *= scale;
      return {scale * scale * value.form, scale * value.projection};
    }
    const double* at = write(numbers ? *numbers : scratch);
    constexpr double one = 1;
    return form(1, &at, &one, numbers && at != numbers->data() ? numbers->data() : nullptr);
  }

 private:
  const WeighedTerms* terms_;
  int T_, lane_, count_ = 0;
  std::array<const double*, most_slots + 3> x_;
};

}  // namespace ricochet
