#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace ricochet {

/// Weighted mean and deviation of numbers as they come (Welford): no difference of large squares.
struct RunningMoments {
  double weight = 0, mean = 0, squares = 0;  ///< squares: Σ w (x − mean)²
  double least = std::numeric_limits<double>::infinity(), largest = -std::numeric_limits<double>::infinity();

  void add(double x, double w = 1) {
    weight += w;
    const double apart = x - mean;
    mean += w / weight * apart;
    squares += w * apart * (x - mean);
    least = std::min(least, x);
    largest = std::max(largest, x);
  }
  void add(const RunningMoments& other) {
    if (other.weight == 0) return;
    const double apart = other.mean - mean, all = weight + other.weight;
    squares += other.squares + apart * apart * weight * other.weight / all;
    mean += other.weight / all * apart;
    weight = all;
    least = std::min(least, other.least);
    largest = std::max(largest, other.largest);
  }
  bool any() const { return weight > 0; }
  double deviation() const { return any() ? std::sqrt(squares / weight) : 0; }
  double rms() const { return any() ? std::hypot(mean, deviation()) : 0; }
};

/// An interval of time in equal parts.
struct WindowParts {
  double from = 0, to = 0;  ///< s
  int count = 1;

  double length() const { return (to - from) / count; }
  double begin(int part) const { return from + (to - from) * part / count; }
  /// The part that holds t, which may be off by `slack`; −1 for one outside. An end belongs to the part before it.
  int of(double t, double slack) const {
    if (t <= from + slack || t > to + slack) return -1;
    return std::clamp(static_cast<int>(std::ceil((t - slack - from) / length())) - 1, 0, count - 1);
  }
};

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
