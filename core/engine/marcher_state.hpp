#pragma once
#include <algorithm>
#include <limits>
#include <memory>
#include <ricochet/engine/marcher.hpp>
#include <vector>

/// \file
/// What a Marcher keeps between steps; for its own sources.
namespace ricochet {

// Columns of W = H S⁻¹ Hᵀ and the responses S⁻¹Hᵀ e_j, kept once computed.
class Marcher::StageDelassus final : public DelassusColumns {
 public:
  StageDelassus(StageOperator& op, const RowMatrix& contact, int rows)
      : op_(op), contact_(contact), rows_(rows), points_(contact.rows()) {
    const auto points = static_cast<std::size_t>(points_);
    known_.assign(points, false);
    columns_ = std::make_unique_for_overwrite<double[]>(points * points);
    responses_ = std::make_unique_for_overwrite<double[]>(points * static_cast<std::size_t>(rows));
    rhs_.assign(static_cast<std::size_t>(rows), 0.0);
  }

  const double* column(int j) override {
    compute(j);
    return columns_.get() + static_cast<std::size_t>(j) * static_cast<std::size_t>(points_);
  }
  const double* response(int j) {
    compute(j);
    return responses_.get() + static_cast<std::size_t>(j) * static_cast<std::size_t>(rows_);
  }
  int computed() const { return static_cast<int>(std::count(known_.begin(), known_.end(), true)); }

 private:
  void compute(int j) {
    if (known_[static_cast<std::size_t>(j)]) return;
    known_[static_cast<std::size_t>(j)] = true;
    const auto first = static_cast<std::size_t>(contact_.start[static_cast<std::size_t>(j)]);
    const auto last = static_cast<std::size_t>(contact_.start[static_cast<std::size_t>(j) + 1]);
    std::fill(rhs_.begin(), rhs_.end(), 0.0);
    for (std::size_t e = first; e < last; ++e) rhs_[static_cast<std::size_t>(contact_.index[e])] = contact_.value[e];
    double* response = responses_.get() + static_cast<std::size_t>(j) * static_cast<std::size_t>(rows_);
    op_.solve_column(rhs_.data(), response);
    double* out = columns_.get() + static_cast<std::size_t>(j) * static_cast<std::size_t>(points_);
    for (std::size_t i = 0; i < static_cast<std::size_t>(points_); ++i) {
      double sum = 0;
      for (auto e = static_cast<std::size_t>(contact_.start[i]); e < static_cast<std::size_t>(contact_.start[i + 1]);
           ++e)
        sum += contact_.value[e] * response[contact_.index[e]];
      out[i] = sum;
    }
  }

  StageOperator& op_;
  const RowMatrix& contact_;
  int rows_, points_;
  std::vector<bool> known_;
  // Pages that no point ever asks for are never written, hence never paid for.
  std::unique_ptr<double[]> columns_, responses_;
  std::vector<double> rhs_;
};

// A small symmetric system over the active points of one lane, A = reach·W + compliance·I, factorised by L D Lᵀ.
struct Marcher::ActiveSystem {
  std::vector<int> points;
  std::vector<double> matrix, right, slopes;
  std::size_t capacity = 0;
  void reserve(int most) {
    capacity = static_cast<std::size_t>(most);
    points.reserve(capacity);
    matrix.resize(capacity * capacity);
    right.resize(capacity);
    slopes.resize(capacity);
  }
  double& at(std::size_t i, std::size_t j) { return matrix[i * capacity + j]; }
  void factorise();
  /// Solves for `right` in place; a point that depends on the others carries nothing.
  void solve();
};

// What a stage keeps between steps, and the constants of its loop.
struct Marcher::StageState {
  std::unique_ptr<StageDelassus> delassus;
  std::vector<Block> effort;  // p of this stage, then of 1, 2, … steps ago as far as anyone weights it
  std::vector<const double*>
      effort_pointers;  // p, p₋₁, p₋₂, …: this stage, the one before it, …; null: no contact there
  Block free, weighted, rate, before, gap, gate_lower, gate_upper, approach;
  Block fastest;                    // largest speed seen at a closed point, per lane
  std::uint32_t contact_lanes = 0;  // lanes with a non-zero effort
  std::uint32_t closed_lanes = 0;   // lanes with a closed gate
  std::uint32_t touched_lanes = 0;  // lanes that the law looked at in this stage
  std::vector<double> update;       // slots × (slots + 1)
  std::vector<double> measure_weights, rate_weights, before_weights, gap_weights, approach_weights;
  std::vector<int> contact_age;  // steps of contact so far, points × T; only where tangents wait
  ActiveSystem tangents;         // of the lane whose tangents are being corrected
};

// F at the time levels that the current step needs, each assembled once.
struct Marcher::LoadWindow {
  struct Entry {
    double level = std::numeric_limits<double>::quiet_NaN();
    long long used = -1;
    std::vector<double> value;
  };
  std::vector<Entry> entries;
  std::vector<double> sum, nodal;
  long long clock = 0;
};

}  // namespace ricochet
