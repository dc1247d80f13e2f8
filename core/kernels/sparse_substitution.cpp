#include <algorithm>
#include <ricochet/kernels/sparse_substitution.hpp>

namespace ricochet {
namespace {

// Rows below the columns from `first` to `last`. Those of a column are among those of its parent, or are the parent.
struct Below {
  const int* begin;
  const int* end;
  long size() const { return end - begin; }
};
Below below(const SparseLdlt& ldlt, int column) {
  const auto j = static_cast<std::size_t>(column);
  return {ldlt.row().data() + ldlt.start()[j], ldlt.row().data() + ldlt.start()[j + 1]};
}

// Whether column `next` joins columns from `first` to the one before it: it is the parent of that one, and what zeros
// the block then has is little beside its entries.
bool joins(const SparseLdlt& ldlt, int first, int next, long& entries) {
  constexpr double most = 0.12;
  constexpr long few = 8;
  const Below last = below(ldlt, next - 1), own = below(ldlt, next);
  if (last.size() == 0 || *last.begin != next) return false;
  const long columns = next + 1 - first, kept = entries + own.size();
  const long all = columns * own.size() + columns * (columns - 1) / 2, zeros = all - kept;
  if (static_cast<double>(zeros) > std::max<double>(few, most * static_cast<double>(all))) return false;
  entries = kept;
  return true;
}

}  // namespace

SparseSubstitution::SparseSubstitution(const SparseLdlt& ldlt, const std::vector<int>& order, int known, int wanted) {
  const int rows = ldlt.size();
  inverse_.reserve(static_cast<std::size_t>(rows));
  for (std::size_t j = 0; j < static_cast<std::size_t>(rows); ++j) {
    const int unknown = order[static_cast<std::size_t>(ldlt.order()[j])];
    inverse_.push_back(1 / ldlt.pivot()[j]);
    from_.push_back(unknown < known ? unknown : -1);
    to_.push_back(unknown < wanted ? unknown : -1);
  }
  value_.reserve(static_cast<std::size_t>(ldlt.factor_entries()) * 5 / 4);
  for (int first = 0; first < rows;) {
    int end = first + 1;
    long entries = below(ldlt, first).size();
    while (end < rows && end - first < SparseBlocks::widest && joins(ldlt, first, end, entries)) ++end;
    add_block(ldlt, first, end);
    first = end;
  }
  value_.shrink_to_fit();
}

void SparseSubstitution::add_block(const SparseLdlt& ldlt, int first, int end) {
  const auto columns = static_cast<std::size_t>(end - first);
  const std::size_t own = (columns * (columns - 1) / 2 + 3) / 4 * 4;
  const Below rows = below(ldlt, end - 1);
  const auto fours = static_cast<std::size_t>((rows.size() + 3) / 4);
  const std::size_t at = value_.size();
  value_.resize(at + own + 4 * columns * fours, 0.0);
  for (std::size_t c = 0; c < columns; ++c) {
    const int column = first + static_cast<int>(c);
    const double* value = ldlt.value().data() + ldlt.start()[static_cast<std::size_t>(column)];
    const int* place = rows.begin;
    for (const int* row = below(ldlt, column).begin; row != below(ldlt, column).end; ++row, ++value) {
      if (*row < end) {
        const auto i = static_cast<std::size_t>(*row - first);
        value_[at + i * (i - 1) / 2 + c] = *value;
        continue;
      }
      while (*place < *row) ++place;
      const auto i = static_cast<std::size_t>(place - rows.begin);
      value_[at + own + i / 4 * 4 * columns + 4 * c + i % 4] = *value;
    }
  }
  index_.insert(index_.end(), rows.begin, rows.end);
  index_.resize(index_.size() + 4 * fours - static_cast<std::size_t>(rows.size()), ldlt.size());
  column_.push_back(end);
  below_.push_back(below_.back() + static_cast<int>(fours));
}

SparseStep SparseSubstitution::step_from(const std::vector<int>& from) const {
  SparseStep step;
  step.L.rows = rows();
  step.L.blocks = static_cast<int>(column_.size()) - 1;
  step.L.column = column_.data();
  step.L.below = below_.data();
  step.L.index = index_.data();
  step.L.value = value_.data();
  step.L.inverse = inverse_.data();
  step.from = from.data();
  step.to = to_.data();
  return step;
}

}  // namespace ricochet
