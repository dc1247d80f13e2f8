#pragma once
#include <algorithm>
#include <cstddef>
#include <vector>

namespace ricochet {

/// How often values came, exactly for up to `most` different ones. Of more, two neighbours count as the larger of both.
class CountedValues {
 public:
  struct Counted {
    double value = 0;
    long long count = 0;
  };

  explicit CountedValues(std::size_t most) : most_(most) {}

  void add(double value) {
    counted_.push_back({value, 1});
    ++count_;
    if (counted_.size() >= 2 * most_) shorten();
  }

  /// In no order; a value may stand several times.
  const std::vector<Counted>& counted() const { return counted_; }
  long long count() const { return count_; }

 private:
  void shorten() {
    std::sort(counted_.begin(), counted_.end(), [](const Counted& a, const Counted& b) { return a.value < b.value; });
    const auto joined = [this](const auto& joins) {
      std::size_t kept = 0;
      for (std::size_t i = 0; i < counted_.size(); ++i)
        if (i > 0 && joins(i, kept - 1))
          counted_[kept - 1] = {counted_[i].value, counted_[kept - 1].count + counted_[i].count};
        else
          counted_[kept++] = counted_[i];
      counted_.resize(kept);
    };
    joined([this](std::size_t i, std::size_t last) { return counted_[i].value == counted_[last].value; });
    if (counted_.size() > most_) joined([](std::size_t i, std::size_t) { return i % 2 == 1; });
  }

  std::size_t most_;
  long long count_ = 0;
  std::vector<Counted> counted_;
};

}  // namespace ricochet
