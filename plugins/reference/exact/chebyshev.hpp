#pragma once
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <vector>

namespace ricochet::reference {

/// A smooth function on [0, L] as Σ c_k T_k(2x/L − 1), to round-off: with its derivative and its integral.
class Chebyshev {
 public:
  /// None where 513 points do not reach 10⁻¹³ of the largest value: the function has a kink, or worse.
  static std::optional<Chebyshev> of(const std::function<double(double)>& function, double length) {
    for (int n = 16; n <= 512; n *= 2) {
      Chebyshev fit;
      fit.length_ = length;
      std::vector<double> values;
      double largest = 0;
      for (int j = 0; j <= n; ++j) {
        values.push_back(function(length * (1 + std::cos(M_PI * j / n)) / 2));
        largest = std::max(largest, std::abs(values.back()));
      }
      for (int k = 0; k <= n; ++k) {
        double sum = 0;
        for (int j = 0; j <= n; ++j) {
          const double end = j == 0 || j == n ? 0.5 : 1;
          sum += end * values[static_cast<std::size_t>(j)] * std::cos(M_PI * j * k / n);
        }
        fit.terms_.push_back((k == 0 || k == n ? 1.0 : 2.0) * sum / n);
      }
      double tail = 0;
      for (int k = n - n / 4; k <= n; ++k) tail = std::max(tail, std::abs(fit.terms_[static_cast<std::size_t>(k)]));
      if (!(largest < INFINITY)) return std::nullopt;
      if (tail > 1e-13 * largest) continue;
      while (fit.terms_.size() > 1 && std::abs(fit.terms_.back()) <= 1e-15 * largest) fit.terms_.pop_back();
      return fit;
    }
    return std::nullopt;
  }

  double operator()(double x) const {
    const double z = 2 * x / length_ - 1;
    double last = 0, before = 0;
    for (std::size_t k = terms_.size(); k-- > 1;) {
      const double next = 2 * z * last - before + terms_[k];
      before = last;
      last = next;
    }
    return z * last - before + terms_[0];
  }

  Chebyshev derivative() const {
    Chebyshev result;
    result.length_ = length_;
    const std::size_t n = terms_.size();
    result.terms_.assign(n, 0);
    for (std::size_t k = n - 1; k >= 1; --k)
      result.terms_[k - 1] = (k + 1 < n ? result.terms_[k + 1] : 0) + 2 * static_cast<double>(k) * terms_[k];
    result.terms_[0] /= 2;
    for (double& term : result.terms_) term *= 2 / length_;
    return result;
  }

  /// ∫₀ˣ
  Chebyshev integral() const {
    Chebyshev result;
    result.length_ = length_;
    const std::size_t n = terms_.size();
    const auto term = [&](std::size_t k) { return k < n ? terms_[k] : 0; };
    result.terms_.assign(n + 1, 0);
    for (std::size_t k = 1; k <= n; ++k)
      result.terms_[k] = length_ / 2 * ((k == 1 ? 2 : 1) * term(k - 1) - term(k + 1)) / (2 * static_cast<double>(k));
    result.terms_[0] = -result(0);
    return result;
  }

 private:
  double length_ = 1;
  std::vector<double> terms_;
};

}  // namespace ricochet::reference
