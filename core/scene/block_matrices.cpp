#include <algorithm>
#include <numeric>
#include <ricochet/scene/block_matrices.hpp>
#include <stdexcept>

namespace ricochet {

using Eigen::Index;

void add_block(const SparseMatrix& block, const std::vector<int>& rows, const std::vector<int>& columns,
               MatrixEntries& entries) {
  for (Index j = 0; j < block.outerSize(); ++j)
    for (SparseMatrix::InnerIterator it(block, j); it; ++it)
      entries.emplace_back(rows[static_cast<std::size_t>(it.row())], columns[static_cast<std::size_t>(j)], it.value());
}

SparseMatrix sparse_matrix(Index rows, Index columns, const MatrixEntries& entries) {
  SparseMatrix out(rows, columns);
  out.setFromTriplets(entries.begin(), entries.end());
  return out;
}

std::vector<int> numbered_from(int first, Index count) {
  std::vector<int> out(static_cast<std::size_t>(count));
  std::iota(out.begin(), out.end(), first);
  return out;
}

namespace {

MassFactors factors_of(const Inertia& inertia) {
  if (!inertia.assembled()) return mass_factors(inertia);
  if (inertia.kernel_dimension > 0) throw std::logic_error("a singular mass matrix beside masses in factors");
  return {inertia.mass, inertia.mass};
}

// Numbers of the rows of each B among all rows, in the order of the first unknown that each touches.
std::vector<std::vector<int>> velocity_numbers(const std::vector<MassFactors>& factors,
                                               const std::vector<std::vector<int>>& unknowns) {
  struct Velocity {
    int first;
    std::size_t part, row;
  };
  std::vector<Velocity> all;
  std::vector<std::vector<int>> numbers(factors.size());
  for (std::size_t k = 0; k < factors.size(); ++k) {
    const Eigen::SparseMatrix<double, Eigen::RowMajor> rows = factors[k].coupling;
    numbers[k].resize(static_cast<std::size_t>(rows.rows()));
    for (Index i = 0; i < rows.rows(); ++i) {
      const Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator first(rows, i);
      all.push_back({first ? unknowns[k][static_cast<std::size_t>(first.col())] : 0, k, static_cast<std::size_t>(i)});
    }
  }
  std::stable_sort(all.begin(), all.end(), [](const Velocity& a, const Velocity& b) { return a.first < b.first; });
  for (std::size_t i = 0; i < all.size(); ++i) numbers[all[i].part][all[i].row] = static_cast<int>(i);
  return numbers;
}

}  // namespace

Inertia join_inertias(const std::vector<Inertia>& parts, const std::vector<std::vector<int>>& unknowns, Index size) {
  Inertia out;
  for (const Inertia& one : parts) out.kernel_dimension += one.kernel_dimension;
  const auto every = [&](auto&& is) { return std::all_of(parts.begin(), parts.end(), is); };
  const auto joined = [&](SparseMatrix Inertia::*form) {
    MatrixEntries entries;
    for (std::size_t k = 0; k < parts.size(); ++k) add_block(parts[k].*form, unknowns[k], unknowns[k], entries);
    return sparse_matrix(size, size, entries);
  };
  if (every([](const Inertia& one) { return one.assembled(); })) {
    out.mass = joined(&Inertia::mass);
    return out;
  }
  if (every([](const Inertia& one) { return one.inverted(); })) {
    out.inverse = joined(&Inertia::inverse);
    return out;
  }
  std::vector<MassFactors> factors;
  for (const Inertia& one : parts) factors.push_back(factors_of(one));
  const auto numbers = velocity_numbers(factors, unknowns);
  MatrixEntries coupling, velocity;
  Index count = 0;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    add_block(factors[k].coupling, numbers[k], unknowns[k], coupling);
    add_block(factors[k].velocity_mass, numbers[k], numbers[k], velocity);
    count += factors[k].coupling.rows();
  }
  out.coupling = sparse_matrix(count, size, coupling);
  out.velocity_mass = sparse_matrix(count, count, velocity);
  return out;
}

}  // namespace ricochet
