#include <ricochet/algebra/sparse_substitution.hpp>

namespace ricochet {

SparseSubstitution::SparseSubstitution(const SparseLdlt& ldlt, const std::vector<int>& order, int known, int wanted)
    : upper_start_(ldlt.start()), upper_index_(ldlt.row()), upper_(ldlt.value()) {
  const auto rows = static_cast<std::size_t>(ldlt.size());
  for (std::size_t j = 0; j < rows; ++j) {
    const int unknown = order[static_cast<std::size_t>(ldlt.order()[j])];
    inverse_.push_back(1 / ldlt.pivot()[j]);
    from_.push_back(unknown < known ? unknown : -1);
    to_.push_back(unknown < wanted ? unknown : -1);
  }
  lower_start_.assign(rows + 1, 0);
  for (const int i : upper_index_) ++lower_start_[static_cast<std::size_t>(i) + 1];
  for (std::size_t i = 0; i < rows; ++i) lower_start_[i + 1] += lower_start_[i];
  lower_index_.resize(upper_index_.size());
  lower_.resize(upper_.size());
  std::vector<int> next(lower_start_.begin(), lower_start_.end() - 1);
  for (std::size_t j = 0; j < rows; ++j)
    for (int e = upper_start_[j]; e < upper_start_[j + 1]; ++e) {
      const auto from = static_cast<std::size_t>(e);
      const auto to = static_cast<std::size_t>(next[static_cast<std::size_t>(upper_index_[from])]++);
      lower_index_[to] = static_cast<int>(j);
      lower_[to] = upper_[from];
    }
}

SparseStep SparseSubstitution::step() const {
  SparseStep step;
  step.rows = rows();
  step.lower = {lower_start_.data(), lower_index_.data(), lower_.data()};
  step.upper = {upper_start_.data(), upper_index_.data(), upper_.data()};
  step.inverse = inverse_.data();
  step.from = from_.data();
  step.to = to_.data();
  return step;
}

}  // namespace ricochet
