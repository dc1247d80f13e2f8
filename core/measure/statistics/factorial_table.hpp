#pragma once
#include <cstddef>
#include <vector>

/// \file
/// The table of a full factorial: every combination of the levels of d factors, the last factor fastest. The arithmetic
/// behind effects.hpp.
namespace ricochet {

/// A set of factors, bit i for factor i.
using FactorMask = std::size_t;

class FactorialTable {
 public:
  /// At least one level per factor.
  explicit FactorialTable(std::vector<std::size_t> levels);

  std::size_t size() const { return size_; }
  std::size_t factors() const { return levels_.size(); }
  const std::vector<std::size_t>& levels() const { return levels_; }
  std::size_t index(const std::vector<std::size_t>& level) const;
  /// Numbers that a model with all terms up to `order` is free to choose.
  std::size_t freedom(std::size_t order) const;

  /// Level weights, one vector that sums to 1 per factor.
  using Weights = std::vector<std::vector<double>>;
  Weights uniform() const;

  /// V_u of every set u, at index u; V_∅ = 0. From Q_u, the weighted mean square of the means f̄_u over the factors
  /// outside u:  V_u = Σ_{v ⊆ u} (−1)^{|u|−|v|} Q_v. About size · Π(1 + 1/n_i) operations.
  std::vector<double> variances(const std::vector<double>& values, const Weights& weights) const;

  /// Least squares by main effects on the known combinations, evaluated everywhere. False where they do not determine
  /// it.
  bool fit_additive(const std::vector<double>& values, const std::vector<char>& known,
                    std::vector<double>& fitted) const;
  /// Fills unknown values by main effects and interactions of two: projects and refills until nothing moves by more
  /// than 1e-11 of the spread. `values` holds a start in the unknown places. Leaves the model's values in `fitted`.
  void fill_pairs(std::vector<double>& values, const std::vector<char>& known, std::vector<double>& fitted) const;

 private:
  std::size_t level(std::size_t cell, std::size_t factor) const { return cell / strides_[factor] % levels_[factor]; }
  std::vector<std::vector<double>> means(std::vector<double> values, const Weights& weights) const;
  std::vector<double> contract(const std::vector<double>& tensor, FactorMask mask, std::size_t factor,
                               const std::vector<double>& weights) const;

  std::vector<std::size_t> levels_, strides_;
  std::size_t size_ = 1;
};

}  // namespace ricochet
