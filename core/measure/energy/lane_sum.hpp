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
  }
  friend bool operator==(const WeighedTerms&, const WeighedTerms&) = default;
};

/// Σ_k w_k x_k of one lane of blocks that are T wide. What only a form asks of is not written down where T = 1.
class LaneSum {
 public:
  LaneSum(int T, int lane) : T_(T), lane_(lane) {}

  void add(const double* x, double weight) {
    x_[static_cast<std::size_t>(count_)] = x;
    weight_[static_cast<std::size_t>(count_++)] = weight;
  }

  /// Its numbers, in `out` where they do not stand already.
  const double* write(Block& out) const {
    if (T_ == 1 && count_ == 1 && weight_[0] == 1) return x_[0];
    if (T_ == 1 && count_ > 0 && count_ <= most_lane_slots) {
      lane_kernels(1).combine(static_cast<long>(out.size()), count_, x_.data(), weight_.data(), out.data());
      return out.data();
    }
    out.fill(0.0);
    const auto T = static_cast<std::size_t>(T_), l = static_cast<std::size_t>(lane_);
    for (int k = 0; k < count_; ++k) {
      const double w = weight_[static_cast<std::size_t>(k)];
      const double* from = x_[static_cast<std::size_t>(k)];
      for (std::size_t i = 0; i < out.size(); ++i) out.data()[i] += w * from[i * T + l];
    }
    return out.data();
  }

  /// What a form says of it; `out` holds its numbers afterwards where they are asked for.
  CombinedForm::Value under(const CombinedForm& form, Block& out, bool written = false) const {
    if (T_ == 1 && count_ > 0 && count_ <= CombinedForm::most_terms)
      return form(count_, x_.data(), weight_.data(), written ? out.data() : nullptr);
    const double* numbers = write(out);
    constexpr double one = 1;
    return form(1, &numbers, &one, written && numbers != out.data() ? out.data() : nullptr);
  }

 private:
  int T_, lane_, count_ = 0;
  std::array<const double*, most_slots + 2> x_;
  std::array<double, most_slots + 2> weight_;
};

}  // namespace ricochet
