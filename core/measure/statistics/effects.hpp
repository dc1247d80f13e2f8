#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/// \file
/// How much of a result is owed to each choice. The shares come from the functional analysis of variance of a measure
/// over the factors of a (nearly) full factorial study.
///
/// Every combination of levels l = (l_1, …, l_d) has one value f(l). With f̄_u the mean over the factors outside u,
///
///     f(l) = Σ_u f_u(l_u),   f_u = Σ_{v ⊆ u} (−1)^{|u|−|v|} f̄_v,   V = Σ_{u ≠ ∅} V_u,   V_u = mean of f_u²
///
/// (Hoeffding 1948; Sobol' 1993). The share of u is V_u/V: of a main effect for one factor, of an interaction for two
/// or three. What is left is lumped as "higher". Levels are categories: nothing is assumed of steps or stiffnesses.
///
/// *Missing* combinations (refused, failed, diverged) are filled by least squares on the others. Main effects fill
/// them; interactions of two factors do too where there are 1.25 times as many values as such a model has numbers. That
/// fill starts from the additive one and goes by repeated projection, which leaves alone what no value speaks of. So an
/// additive measure has no bias from what is missing. No shares are given when over half is missing or main effects
/// cannot be told apart.
///
/// *Intervals*: the values are deterministic, so the question is how much the shares hang on which levels the study
/// happens to hold. Each level of each factor gets a random weight, exponential and normalised per factor: the Bayesian
/// bootstrap of Rubin (1981). A combination gets the product of its levels' weights (Owen and Eckles 2012, Ann. Appl.
/// Stat. 6, 895–927). V_u is scaled by Π_{i∈u} (1 − 1/n_i)/(1 − Σp_i²), so that few levels bring no bias and two levels
/// alone no width. Filled values are drawn again with the residuals of their model. The interval is 2.5 % and 97.5 % of
/// the draws, widened to hold the share itself; seeded, the same everywhere.
namespace ricochet {

/// One choice of a study, with the level that each cell has of it.
struct Factor {
  std::string name;                 ///< "mass", "step", "time.beta"
  std::vector<std::string> levels;  ///< in words
  std::vector<std::size_t> level;   ///< of each cell, an index into `levels`
};

struct FactorSet {
  std::vector<Factor> factors;
  std::vector<std::string> notes;
};

/// The factors of a table of cells: cells[c][k] is the text of column k, "" where the cell has none. Parameters of a
/// method ("time.beta" beside a column "time") may exist for some methods only, or not in every combination. These are
/// nested: the method with those parameters becomes one factor under the method's name, and a note says so.
FactorSet factors_of(const std::vector<std::string>& columns, const std::vector<std::vector<std::string>>& cells);

/// The share of one factor or interaction in the variance.
struct EffectShare {
  std::string factor;                   ///< "mass", "mass × step", "higher", "repeats"
  double share = 0, low = 0, high = 0;  ///< in [0, 1]
  std::string reason{};                 ///< why it is 0 by construction (one level, …); else empty
};

struct Effects {
  std::vector<EffectShare> shares;  ///< main effects in the order given, pairs, triples, "higher"; empty: see `notes`
  bool log = false;                 ///< shares of log10 f: all f > 0, over more than two decades
  std::size_t combinations = 0, missing = 0;
  std::vector<std::string> notes;  ///< what a reader must know: missing combinations, levels without a value, …
};

struct EffectOptions {
  int replicates = 400;  ///< draws of the bootstrap; fewer, at least 50, for large tables
  std::uint64_t seed = 1;
};

/// Shares of a measure. values[c] belongs to the cell with levels factors[k].level[c]; nothing (or what is not finite)
/// is a missing value. Several cells of one combination are averaged, and what they differ by is the share "repeats".
/// Throws std::invalid_argument when sizes do not agree.
Effects effects_of(const std::vector<Factor>& factors, const std::vector<std::optional<double>>& values,
                   const EffectOptions& options = {});

// The table of a full factorial: every combination of the levels of d factors, the last factor fastest. The arithmetic
// behind effects.hpp.

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
