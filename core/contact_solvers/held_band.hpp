#pragma once
#include <memory>
#include <ricochet/contract/contact_law.hpp>
#include <ricochet/kernels/band_ldlt.hpp>
#include <ricochet/kernels/block.hpp>
#include <vector>

namespace ricochet {

/// W = H S⁻¹ Hᵀ (m × m) of a band matrix S (n × n), with any of its points held. The cost is n times the bandwidth,
/// whatever their number:
///
///     [ S   Hᵀ ] [ x]   [0]
///     [ H  −c  ] [−p] = [r],     hence (W + diag(c)) p = r,     p_j = 0 where c_j = ∞                           (1)
///
/// S is SPD or quasi-definite as (1) of band_ldlt.hpp, c ≥ 0. The unknown −p_j stands right behind the last dof that
/// row j of H touches. Every leading block of (1) is then one of the same kind, regular where its rows of H are
/// independent: L D Lᵀ without pivoting. Between two sets only what stands behind the first change is factorised again.
///
/// A point whose pivot is lost in round-off is dropped, p_j = 0. It depends on points before it (two at one place), or
/// nothing moves it.
///
/// A solve carries the round-off of S, its condition times ε. W itself, by multiply(), is that of the factor that
/// BandLdlt gives of S. A residual formed by it therefore corrects p. One object serves one thread at a time; nothing
/// allocates after construction.
class HeldBand {
 public:
  /// The rows of H are not kept. Null where BandLdlt has no factor of S, or where (1) is no narrow band: half as wide
  /// as 64 rows.
  static std::unique_ptr<HeldBand> make(const QuasiDefinite& S, const LaneRows& H);

  int points() const { return static_cast<int>(multiplier_.size()); }
  /// W_jj.
  double diagonal(int j) const { return diagonal_[static_cast<std::size_t>(j)]; }
  /// out = W p, m numbers each.
  void multiply(const double* p, double* out);

  /// Factorises (1) for c (m).
  void hold(const double* compliance);
  /// Whether point j, though held, was dropped.
  bool dropped(int j) const { return dropped_[static_cast<std::size_t>(j)] != 0; }
  /// p of (1), m numbers each; r is read where points are held.
  void solve(const double* r, double* p);
  /// p of (W + diag(c)) p = W e_j for a point j that is not held: what takes its push off the others.
  void solve_column(int j, double* p);

 private:
  struct Entry {
    int row, in_S;  // of a dof in (1), and in the factor of S
    double value;
  };
  HeldBand() = default;
  double* column(int j) { return factor_.data() + static_cast<std::size_t>(j) * static_cast<std::size_t>(width_ + 1); }
  void place(const std::vector<int>& row_of, const LaneRows& H);
  bool store(const SparseMatrix& whole);
  void find_diagonal();
  int first_change(const double* compliance);
  void renew(int first);
  void eliminate(int first);
  void drop(int row);
  void substitute(int first);
  void read_efforts(double* p) const;

  // S alone.
  BandLdlt ldlt_;
  Block right_, solution_;
  std::vector<double> diagonal_;  // m
  // (1): rows_ unknowns, of each column of L D Lᵀ the diagonal and width_ entries below it.
  int rows_ = 0, width_ = 0;
  std::vector<double> plain_, factor_;      // nobody held; as it is held now
  std::vector<double> inverse_, size_, x_;  // 1/D; what D is the rest of, as moduli; work
  std::vector<int> point_;                  // rows_: the point that an unknown pushes, −1: none
  std::vector<int> multiplier_;             // m: row of −p_j
  std::vector<int> start_;                  // m + 1: entries of row j of H
  std::vector<Entry> entry_;                // rows increasing
  std::vector<int> moved_;                  // where a row of S stands in (1)
  std::vector<double> compliance_;          // m: c as it is factorised
  std::vector<char> dropped_;               // m
};

/// Columns of a W that many points can be held in at once.
class BandDelassus : public DelassusColumns {
 public:
  /// Made when first asked for, then the same; null: the band is none.
  virtual HeldBand* held() = 0;
};

}  // namespace ricochet
