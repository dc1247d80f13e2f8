#pragma once
#include <optional>
#include <ricochet/contract/parameters.hpp>
#include <ricochet/contract/step_plan.hpp>
#include <span>

namespace ricochet {

/// Columns of the Delassus operator W = H S⁻¹ Hᵀ (m × m, SPD or semidefinite, m/N), computed when first asked for.
class DelassusColumns {
 public:
  virtual ~DelassusColumns() = default;
  /// Column j: m numbers, valid until the operator is rebuilt.
  virtual const double* column(int j) = 0;
};

/// How a law's work on one lane ended.
struct LaneOutcome {
  bool converged = true;
  int iterations = 0;   ///< pivoting or augmentation iterations of this solve
  double residual = 0;  ///< complementarity residual, in units of the measure
};

/// What a law sees of one stage: a block of lanes, affine in p with the same W. Blocks are m × lanes, lanes contiguous.
///
///     measure_i = free_i + reach · (W p)_i,     lower_i and upper_i are ±∞ where a side is absent or open
///     rate_i    = rate_free_i + rate_reach · (W p)_i        (only for laws that read a rate)
struct ReducedProblem {
  int points = 0, lanes = 0;
  DelassusColumns* delassus = nullptr;
  double reach = 0;
  const double* free = nullptr;
  const double* lower = nullptr;
  const double* upper = nullptr;
  double rate_reach = 0;
  const double* rate_free = nullptr;
  double* effort = nullptr;      ///< in: last step's p; out: p. Lanes not in `touched` are zero on entry and left alone
  std::span<const int> touched;  ///< lanes where a free measure passes a bound, or that were in contact
  LaneOutcome* outcome = nullptr;  ///< per lane
};

/// A contact law: it never knows the scheme, nor the scheme the law.
class ContactLaw {
 public:
  virtual ~ContactLaw() = default;
  /// No contact at all: no rows of H, no box problem.
  virtual bool absent() const { return false; }
  /// Which compliance measure it reads; none: the impact measure (rigid).
  virtual std::optional<Evaluation> reads() const { return std::nullopt; }
  /// Whether rate_free is needed.
  virtual bool reads_rate() const { return false; }
  /// Sizes workspaces; `lanes` holds one checked parameter set per lane (only `per_lane` parameters differ).
  virtual void prepare(int points, std::span<const Parameters> lanes) = 0;
  /// Finds p for each touched lane. No allocation here.
  virtual void solve(ReducedProblem& problem) = 0;
  /// Energy stored by the law at penetration `depth` ≥ 0 (m) in lane `lane`, joules; rigid laws store none.
  virtual double potential(double /*depth*/, int /*lane*/) const { return 0; }
  /// Stiffness dp/dg of a closed contact (N/m) in lane `lane`; none: bilateral constraint (rigid).
  virtual std::optional<double> linearise(int /*lane*/) const { return std::nullopt; }
};

}  // namespace ricochet
