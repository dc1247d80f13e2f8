#include <algorithm>
#include <cmath>
#include <limits>
#include <ricochet/contact_solvers/held_band.hpp>
#include <ricochet/kernels/floating_point.hpp>
#include <utility>

namespace ricochet {
namespace {

/// Takes column j of a band off the w columns behind it. The column is w + 1 numbers from its diagonal down. With
/// v = l D, A_(j+s)(j+t) −= v_s l_t. The entries become l. D is that of its inverse, as renew() knows it.
template <int W>
void eliminate_column(double* column, double inverse, double* size, int width) {
  const int w = W > 0 ? W : width;
  const int stride = w + 1;
  double l[W > 0 ? W + 1 : 64];
  for (int s = 1; s <= w; ++s) l[s] = column[s] * inverse;
  const double pivot = 1 / inverse;
  for (int s = 1; s <= w; ++s) {
    if (l[s] == 0) continue;
    const double v = l[s] * pivot;
    double* later = column + s * stride;
    for (int t = s; t <= w; ++t) later[t - s] -= v * l[t];
    size[s] += std::abs(v * l[s]);
  }
  for (int s = 1; s <= w; ++s) column[s] = l[s];
}

/// L D Lᵀ x = b in place, columns from `first` on where b is not zero; `inverse` is 1/D.
template <int W>
void substitute_columns(const double* factor, const double* inverse, double* x, int first, int rows, int width) {
  const int w = W > 0 ? W : width;
  const int stride = w + 1;
  for (int j = first; j < rows; ++j) {
    const double* l = factor + static_cast<std::ptrdiff_t>(j) * stride;
    const double known = x[j];
    for (int s = 1; s <= w; ++s) x[j + s] -= l[s] * known;
  }
  for (int j = rows - 1; j >= 0; --j) {
    const double* l = factor + static_cast<std::ptrdiff_t>(j) * stride;
    double sum = x[j] * inverse[j];
    for (int s = w; s > 0; --s) sum -= l[s] * x[j + s];
    x[j] = sum;
  }
}

constexpr int widest = 63, most_unrolled = 8;

struct BandKernels {
  void (*eliminate)(double*, double, double*, int);
  void (*substitute)(const double*, const double*, double*, int, int, int);
};

template <int... W>
BandKernels kernels_among(int width, std::integer_sequence<int, W...>) {
  static constexpr BandKernels table[] = {{eliminate_column<W>, substitute_columns<W>}...};
  return table[width <= most_unrolled ? width : 0];
}

BandKernels kernels_for(int width) {
  return kernels_among(width, std::make_integer_sequence<int, most_unrolled + 1>());
}

}  // namespace

std::unique_ptr<HeldBand> HeldBand::make(const QuasiDefinite& S, const LaneRows& H) {
  std::unique_ptr<HeldBand> band(new HeldBand);
  if (band->ldlt_.factorise(S)) return nullptr;
  std::vector<int> order;
  const SparseMatrix whole = S.assemble(order);
  std::vector<int> row_of(order.size());
  for (std::size_t r = 0; r < order.size(); ++r) row_of[static_cast<std::size_t>(order[r])] = static_cast<int>(r);
  band->place(row_of, H);
  if (!band->store(whole)) return nullptr;
  band->right_ = Block(band->ldlt_.rows(), 1);
  band->solution_ = Block(band->ldlt_.rows(), 1, band->ldlt_.half_width());
  band->find_diagonal();
  return band;
}

// The unknowns of (1) in one order: those of S, each point behind the last that it touches.
void HeldBand::place(const std::vector<int>& row_of, const LaneRows& H) {
  const auto points = static_cast<std::size_t>(H.rows);
  start_.assign(1, 0);
  // Number 0 stands before all rows of S, r + 1 behind row r.
  std::vector<int> behind(points, 0), next(row_of.size() + 1, 0);
  for (std::size_t j = 0; j < points; ++j) {
    for (int e = H.start[j]; e < H.start[j + 1]; ++e) {
      if (H.value[e] == 0) continue;
      const int row = row_of[static_cast<std::size_t>(H.index[e])];
      entry_.push_back({0, row, H.value[e]});
      behind[j] = std::max(behind[j], row + 1);
    }
    std::sort(entry_.begin() + start_.back(), entry_.end(), [](Entry a, Entry b) { return a.in_S < b.in_S; });
    start_.push_back(static_cast<int>(entry_.size()));
    ++next[static_cast<std::size_t>(behind[j])];
  }
  rows_ = 0;
  for (std::size_t r = 0; r < next.size(); ++r) {
    const int here = next[r];
    next[r] = rows_;
    rows_ += here;
    if (r < row_of.size()) moved_.push_back(rows_++);
  }
  point_.assign(static_cast<std::size_t>(rows_), -1);
  for (std::size_t j = 0; j < points; ++j) {
    multiplier_.push_back(next[static_cast<std::size_t>(behind[j])]++);
    point_[static_cast<std::size_t>(multiplier_[j])] = static_cast<int>(j);
    for (int e = start_[j]; e < start_[j + 1]; ++e) {
      Entry& entry = entry_[static_cast<std::size_t>(e)];
      entry.row = moved_[static_cast<std::size_t>(entry.in_S)];
      width_ = std::max(width_, multiplier_[j] - entry.row);
    }
  }
}

// S among them, with nobody held; false where that is no narrow band.
bool HeldBand::store(const SparseMatrix& whole) {
  const auto each = [&](auto use) {
    for (int c = 0; c < whole.outerSize(); ++c)
      for (SparseMatrix::InnerIterator it(whole, c); it; ++it)
        if (it.value() != 0 && it.row() >= c)
          use(moved_[static_cast<std::size_t>(c)], moved_[static_cast<std::size_t>(it.row())], it.value());
  };
  each([&](int column, int row, double) { width_ = std::max(width_, row - column); });
  if (width_ > widest) return false;
  const auto stride = static_cast<std::size_t>(width_ + 1);
  const auto padded = static_cast<std::size_t>(rows_ + width_);
  plain_.assign(padded * stride, 0.0);
  each([&](int column, int row, double value) {
    plain_[static_cast<std::size_t>(column) * stride + static_cast<std::size_t>(row - column)] = value;
  });
  for (const int row : multiplier_) plain_[static_cast<std::size_t>(row) * stride] = -1;
  factor_ = plain_;
  inverse_.assign(static_cast<std::size_t>(rows_), 1.0);
  size_.assign(padded, 0.0);
  x_.assign(padded, 0.0);
  compliance_.assign(multiplier_.size(), infinity);
  dropped_.assign(multiplier_.size(), 0);
  eliminate(0);
  return true;
}

// W_jj = Σ_r (L⁻¹h)_r²/D_r: a forward substitution from the first dof of the point on.
void HeldBand::find_diagonal() {
  const int rows = ldlt_.rows(), w = ldlt_.half_width();
  diagonal_.assign(multiplier_.size(), 0.0);
  double* y = solution_.data();  // zero, and w zeros before it
  for (std::size_t j = 0; j < multiplier_.size(); ++j) {
    if (start_[j] == start_[j + 1]) continue;
    for (int e = start_[j]; e < start_[j + 1]; ++e)
      y[entry_[static_cast<std::size_t>(e)].in_S] = entry_[static_cast<std::size_t>(e)].value;
    const int first = entry_[static_cast<std::size_t>(start_[j])].in_S;
    double sum = 0;
    for (int r = first; r < rows; ++r) {
      const double* row = ldlt_.factor() + static_cast<std::size_t>(r) * static_cast<std::size_t>(2 * w + 1);
      for (int s = 0; s < w; ++s) y[r] -= row[s] * y[r - w + s];
      sum += y[r] * y[r] * row[2 * w];
    }
    diagonal_[j] = sum;
    std::fill(y + first, y + rows, 0.0);
  }
}

void HeldBand::multiply(const double* p, double* out) {
  double* right = right_.data();
  std::fill_n(right, right_.rows(), 0.0);
  for (std::size_t j = 0; j < multiplier_.size(); ++j)
    for (int e = start_[j]; p[j] != 0 && e < start_[j + 1]; ++e)
      right[entry_[static_cast<std::size_t>(e)].in_S] += entry_[static_cast<std::size_t>(e)].value * p[j];
  BandStep step;
  ldlt_.substitute_in(step, solution_.data());
  step.b = right;
  lane_kernels(1).band_step(step);
  for (std::size_t j = 0; j < multiplier_.size(); ++j) {
    out[j] = 0;
    for (int e = start_[j]; e < start_[j + 1]; ++e)
      out[j] += entry_[static_cast<std::size_t>(e)].value * solution_.data()[entry_[static_cast<std::size_t>(e)].in_S];
  }
}

void HeldBand::hold(const double* compliance) {
  const int first = first_change(compliance);
  if (first == rows_) return;
  renew(first);
  eliminate(first);
}

// The first column that differs from what is factorised; keeps the new c.
int HeldBand::first_change(const double* compliance) {
  int first = rows_, first_dropped = rows_;
  for (std::size_t j = 0; j < multiplier_.size(); ++j) {
    const int begins = start_[j] < start_[j + 1] ? entry_[static_cast<std::size_t>(start_[j])].row : multiplier_[j];
    // Its row of L is not known any more.
    if (dropped_[j]) first_dropped = std::min(first_dropped, begins);
    if (compliance[j] == compliance_[j]) continue;
    compliance_[j] = compliance[j];
    first = std::min(first, begins);
  }
  return first < rows_ ? std::min(first, first_dropped) : rows_;
}

// (1) from a column on, less what the columns before it take off.
void HeldBand::renew(int first) {
  const auto stride = static_cast<std::size_t>(width_ + 1);
  std::copy(plain_.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(first) * stride), plain_.end(),
            factor_.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(first) * stride));
  std::fill(size_.begin() + first, size_.end(), 0.0);
  for (std::size_t j = 0; j < multiplier_.size(); ++j) {
    if (multiplier_[j] < first) continue;
    dropped_[j] = 0;
    if (compliance_[j] == infinity) continue;
    *column(multiplier_[j]) = -compliance_[j];
    size_[static_cast<std::size_t>(multiplier_[j])] = compliance_[j];
    for (int e = start_[j]; e < start_[j + 1]; ++e) {
      const Entry& entry = entry_[static_cast<std::size_t>(e)];
      if (entry.row >= first) column(entry.row)[multiplier_[j] - entry.row] = entry.value;
    }
  }
  for (int k = std::max(0, first - width_); k < first; ++k) {
    const double* l = column(k);
    const double pivot = 1 / inverse_[static_cast<std::size_t>(k)];
    for (int s = first - k; s <= width_; ++s) {
      if (l[s] == 0) continue;
      const double v = l[s] * pivot;
      for (int t = s; t <= width_; ++t) column(k + s)[t - s] -= v * l[t];
      size_[static_cast<std::size_t>(k + s)] += std::abs(v * l[s]);
    }
  }
}

void HeldBand::eliminate(int first) {
  constexpr double lost = 64 * std::numeric_limits<double>::epsilon();
  const auto eliminate_one = kernels_for(width_).eliminate;
  for (int j = first; j < rows_; ++j) {
    double pivot = *column(j);
    if (const int point = point_[static_cast<std::size_t>(j)];
        point >= 0 && compliance_[static_cast<std::size_t>(point)] < infinity &&
        !(-pivot > lost * size_[static_cast<std::size_t>(j)])) {
      dropped_[static_cast<std::size_t>(point)] = 1;
      drop(j);
      pivot = -1;
    }
    inverse_[static_cast<std::size_t>(j)] = 1 / pivot;
    eliminate_one(column(j), 1 / pivot, size_.data() + j, width_);
  }
}

// As if nobody held it: its row of L and its column are gone.
void HeldBand::drop(int row) {
  for (int k = std::max(0, row - width_); k < row; ++k) column(k)[row - k] = 0;
  std::fill_n(column(row), width_ + 1, 0.0);
}

void HeldBand::solve(const double* r, double* p) {
  std::fill(x_.begin(), x_.end(), 0.0);
  int first = rows_;
  for (std::size_t j = 0; j < multiplier_.size(); ++j) {
    if (compliance_[j] == infinity || dropped_[j] || r[j] == 0) continue;
    x_[static_cast<std::size_t>(multiplier_[j])] = r[j];
    first = std::min(first, multiplier_[j]);
  }
  substitute(first);
  read_efforts(p);
}

void HeldBand::solve_column(int j, double* p) {
  std::fill(x_.begin(), x_.end(), 0.0);
  const auto point = static_cast<std::size_t>(j);
  for (int e = start_[point]; e < start_[point + 1]; ++e)
    x_[static_cast<std::size_t>(entry_[static_cast<std::size_t>(e)].row)] = -entry_[static_cast<std::size_t>(e)].value;
  substitute(start_[point] < start_[point + 1] ? entry_[static_cast<std::size_t>(start_[point])].row : rows_);
  read_efforts(p);
}

void HeldBand::substitute(int first) {
  kernels_for(width_).substitute(factor_.data(), inverse_.data(), x_.data(), first, rows_, width_);
}

void HeldBand::read_efforts(double* p) const {
  for (std::size_t j = 0; j < multiplier_.size(); ++j)
    p[j] = compliance_[j] < infinity && !dropped_[j] ? -x_[static_cast<std::size_t>(multiplier_[j])] : 0.0;
}

}  // namespace ricochet
