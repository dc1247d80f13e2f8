#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <ricochet/kernels/dense_solvers.hpp>
#include <ricochet/measure/statistics/effects.hpp>
#include <set>
#include <utility>

namespace ricochet {

namespace {

constexpr FactorMask bit(std::size_t factor) {
  return FactorMask{1} << factor;
}

}  // namespace

FactorialTable::FactorialTable(std::vector<std::size_t> levels) : levels_(std::move(levels)), strides_(levels_.size()) {
  for (std::size_t k = levels_.size(); k-- > 0;) {
    strides_[k] = size_;
    size_ *= levels_[k];
  }
}

std::size_t FactorialTable::index(const std::vector<std::size_t>& level) const {
  std::size_t cell = 0;
  for (std::size_t k = 0; k < factors(); ++k) cell += level[k] * strides_[k];
  return cell;
}

std::size_t FactorialTable::freedom(std::size_t order) const {
  // Coefficients of Π(1 + (n_i − 1) t) up to t^order.
  std::vector<std::size_t> terms(order + 1, 0);
  terms[0] = 1;
  for (const std::size_t n : levels_)
    for (std::size_t k = order; k > 0; --k) terms[k] += terms[k - 1] * (n - 1);
  std::size_t sum = 0;
  for (const std::size_t count : terms) sum += count;
  return sum;
}

FactorialTable::Weights FactorialTable::uniform() const {
  Weights out;
  for (const std::size_t n : levels_) out.emplace_back(n, 1 / static_cast<double>(n));
  return out;
}

/// The weighted mean over one factor of a tensor on the factors of `mask`.
std::vector<double> FactorialTable::contract(const std::vector<double>& tensor, FactorMask mask, std::size_t factor,
                                             const std::vector<double>& weights) const {
  std::size_t inner = 1;
  for (std::size_t k = factor + 1; k < factors(); ++k)
    if (mask & bit(k)) inner *= levels_[k];
  const std::size_t n = levels_[factor];
  std::vector<double> out(tensor.size() / n, 0);
  // Every mean adds the levels in their order, however many are worked out side by side.
  constexpr std::size_t together = 8;
  std::size_t at = 0;
  if (inner == 1)
    for (; at + together <= out.size(); at += together) {
      const double* first = tensor.data() + at * n;
      double sums[together] = {};
      for (std::size_t l = 0; l < n; ++l)
        for (std::size_t k = 0; k < together; ++k) sums[k] += weights[l] * first[k * n + l];
      std::copy_n(sums, together, out.begin() + static_cast<std::ptrdiff_t>(at));
    }
  for (; at < out.size(); at += inner)
    for (std::size_t l = 0; l < n; ++l) {
      const double weight = weights[l];
      const double* from = tensor.data() + at * n + l * inner;
      double* into = out.data() + at;
      for (std::size_t k = 0; k < inner; ++k) into[k] += weight * from[k];
    }
  return out;
}

/// f̄_u for every u, each from the smallest that holds one factor more.
std::vector<std::vector<double>> FactorialTable::means(std::vector<double> values, const Weights& weights) const {
  const FactorMask all = bit(factors()) - 1;
  std::vector<std::vector<double>> out(all + 1);
  out[all] = std::move(values);
  for (FactorMask mask = all; mask-- > 0;) {
    std::size_t least = factors();
    for (std::size_t k = 0; k < factors(); ++k)
      if (!(mask & bit(k)) && (least == factors() || levels_[k] < levels_[least])) least = k;
    out[mask] = contract(out[mask | bit(least)], mask | bit(least), least, weights[least]);
  }
  return out;
}

std::vector<double> FactorialTable::variances(const std::vector<double>& values, const Weights& weights) const {
  // Off the grand mean first, so that little cancels.
  double mean = 0;
  for (const double v : values) mean += v / static_cast<double>(size_);
  std::vector<double> centred = values;
  for (double& v : centred) v -= mean;
  auto tensors = means(std::move(centred), weights);
  std::vector<double> out(tensors.size());
  for (FactorMask mask = 0; mask < tensors.size(); ++mask) {
    std::vector<double> squares = std::move(tensors[mask]);
    for (double& v : squares) v *= v;
    FactorMask left = mask;
    for (std::size_t k = 0; k < factors(); ++k)
      if (left & bit(k)) {
        squares = contract(squares, left, k, weights[k]);
        left &= ~bit(k);
      }
    out[mask] = squares[0];
  }
  for (std::size_t k = 0; k < factors(); ++k)
    for (FactorMask mask = 0; mask < out.size(); ++mask)
      if (mask & bit(k)) out[mask] -= out[mask & ~bit(k)];
  out[0] = 0;
  for (double& v : out) v = std::max(v, 0.0);
  return out;
}

bool FactorialTable::fit_additive(const std::vector<double>& values, const std::vector<char>& known,
                                  std::vector<double>& fitted) const {
  // Unknowns: the value where every factor has its first level, then what every other level adds.
  std::vector<Eigen::Index> first;
  for (std::size_t k = 0, next = 1; k < factors(); next += levels_[k++] - 1)
    first.push_back(static_cast<Eigen::Index>(next));
  const auto unknowns = static_cast<Eigen::Index>(freedom(1));
  std::vector<Eigen::Index> row;
  const auto row_of = [&](std::size_t cell) {
    row.assign(1, 0);
    for (std::size_t k = 0; k < factors(); ++k)
      if (const std::size_t l = level(cell, k)) row.push_back(first[k] + static_cast<Eigen::Index>(l) - 1);
  };
  double mean = 0, count = 0;
  for (std::size_t cell = 0; cell < size_; ++cell)
    if (known[cell]) mean += values[cell], ++count;
  mean /= count;
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(unknowns, unknowns);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(unknowns);
  for (std::size_t cell = 0; cell < size_; ++cell) {
    if (!known[cell]) continue;
    row_of(cell);
    for (const Eigen::Index i : row) {
      right[i] += values[cell] - mean;
      for (const Eigen::Index j : row) normal(i, j) += 1;
    }
  }
  // Whole numbers: a singular matrix is so to round-off, a regular one far from it.
  const auto solved = regular_solve(normal, right);
  if (!solved) return false;
  const Eigen::VectorXd& solution = *solved;
  fitted.assign(size_, mean);
  for (std::size_t cell = 0; cell < size_; ++cell) {
    row_of(cell);
    for (const Eigen::Index i : row) fitted[cell] += solution[i];
  }
  return true;
}

void FactorialTable::fill_pairs(std::vector<double>& values, const std::vector<char>& known,
                                std::vector<double>& fitted) const {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const double enough = 1e-11 * (*high - *low);
  const Weights weights = uniform();
  const auto d = static_cast<double>(factors());
  // Σ_{|u| ≤ 2} f_u = Σ_{i<j} f̄_ij − (d − 2) Σ_i f̄_i + (d − 1)(d − 2)/2 f̄.
  const double factor_of_size[] = {0.5 * (d - 1) * (d - 2), 2 - d, 1};
  fitted.resize(size_);
  // Where each cell stands in the means over sets of two factors and fewer.
  std::vector<std::pair<FactorMask, std::vector<std::size_t>>> places;
  for (FactorMask mask = 0; mask < bit(factors()); ++mask) {
    if (std::popcount(mask) > 2) continue;
    std::vector<std::size_t> place(size_, 0);
    for (std::size_t cell = 0; cell < size_; ++cell)
      for (std::size_t k = 0; k < factors(); ++k)
        if (mask & bit(k)) place[cell] = place[cell] * levels_[k] + level(cell, k);
    places.emplace_back(mask, std::move(place));
  }
  for (int round = 0; round < 500; ++round) {
    const auto tensors = means(values, weights);
    std::fill(fitted.begin(), fitted.end(), 0);
    for (const auto& [mask, place] : places) {
      const double factor = factor_of_size[std::popcount(mask)];
      const std::vector<double>& tensor = tensors[mask];
      for (std::size_t cell = 0; cell < size_; ++cell) fitted[cell] += factor * tensor[place[cell]];
    }
    double moved = 0;
    for (std::size_t cell = 0; cell < size_; ++cell) {
      if (known[cell]) continue;
      moved = std::max(moved, std::abs(fitted[cell] - values[cell]));
      values[cell] = fitted[cell];
    }
    if (moved <= enough) return;
  }
}

namespace {

/// "time" of "time.beta" where there is such a column; else the column itself.
std::string role_of(const std::string& column, const std::vector<std::string>& columns) {
  const std::string prefix = column.substr(0, column.find('.'));
  return std::find(columns.begin(), columns.end(), prefix) == columns.end() ? column : prefix;
}

using CellRows = std::vector<std::vector<std::string>>;

std::size_t distinct(const CellRows& cells, const std::vector<std::size_t>& columns) {
  std::set<std::vector<std::string>> seen;
  for (const auto& cell : cells) {
    std::vector<std::string> key;
    for (const std::size_t k : columns) key.push_back(cell[k]);
    seen.insert(std::move(key));
  }
  return seen.size();
}

/// Whether the parameter does not exist, or does not take all its values, for every method.
bool nested(const CellRows& cells, std::size_t method, std::size_t parameter) {
  for (const auto& cell : cells)
    if (cell[parameter].empty()) return true;
  return distinct(cells, {method, parameter}) < distinct(cells, {method}) * distinct(cells, {parameter});
}

Factor factor_of(const std::string& name, const std::vector<std::size_t>& group,
                 const std::vector<std::string>& columns, const CellRows& cells) {
  Factor out{name, {}, {}};
  std::map<std::string, std::size_t> place;
  for (const auto& cell : cells) {
    std::string text = cell[group.front()];
    for (std::size_t k = 1; k < group.size(); ++k)
      if (const std::string& value = cell[group[k]]; !value.empty())
        text += fmt::format(", {} {}", columns[group[k]].substr(columns[group[k]].find('.') + 1), value);
    const auto [found, fresh] = place.emplace(text, out.levels.size());
    if (fresh) out.levels.push_back(text);
    out.level.push_back(found->second);
  }
  return out;
}

}  // namespace

FactorSet factors_of(const std::vector<std::string>& columns, const CellRows& cells) {
  std::vector<std::vector<std::size_t>> groups(columns.size());
  for (std::size_t k = 0; k < columns.size(); ++k)
    if (role_of(columns[k], columns) == columns[k]) groups[k].push_back(k);
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const std::string role = role_of(columns[k], columns);
    const auto method = static_cast<std::size_t>(std::find(columns.begin(), columns.end(), role) - columns.begin());
    if (method == k) continue;
    groups[nested(cells, method, k) ? method : k].push_back(k);
  }
  FactorSet out;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    if (groups[k].empty()) continue;
    out.factors.push_back(factor_of(columns[k], groups[k], columns, cells));
    const auto& levels = out.factors.back().levels;
    if (levels.size() == distinct(cells, {k})) continue;
    std::vector<std::string> names;
    for (std::size_t j = 1; j < groups[k].size(); ++j) names.push_back(columns[groups[k][j]]);
    out.notes.push_back(fmt::format("{0} stands for {0} with {1}, which {2} not vary freely beside it: {3}", columns[k],
                                    fmt::join(names, " and "), names.size() == 1 ? "does" : "do",
                                    fmt::join(levels, "; ")));
  }
  return out;
}

}  // namespace ricochet
