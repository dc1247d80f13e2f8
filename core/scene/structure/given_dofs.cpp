#include <algorithm>
#include <numeric>
#include <ricochet/kernels/band_ldlt.hpp>
#include <ricochet/scene/structure/given_dofs.hpp>

namespace ricochet {
namespace {

constexpr double round_off = 1e-6;  // files may have seven digits

int direction_of(const DofName& dof) {
  if (dof.rotation()) return 3;
  return dof.translation() ? dof.component[1] - 'x' : -1;
}

Eigen::VectorXd translation(const DofTable& table, int axis) {
  Eigen::VectorXd u = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(table.dofs.size()));
  for (const DofName& dof : table.dofs)
    if (direction_of(dof) == axis) u[dof.dof - 1] = 1;
  return u;
}

// ω × r about an axis, and ω itself.
Eigen::VectorXd rotation(const DofTable& table, int axis, double unit) {
  std::array<double, 3> centre{};
  for (const DofName& dof : table.dofs)
    for (std::size_t k = 0; k < 3; ++k) centre[k] += dof.place[k] / static_cast<double>(table.dofs.size());
  const int next = (axis + 1) % 3, last = (axis + 2) % 3;
  Eigen::VectorXd u = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(table.dofs.size()));
  for (const DofName& dof : table.dofs) {
    const auto arm = [&](int k) {
      return unit * (dof.place[static_cast<std::size_t>(k)] - centre[static_cast<std::size_t>(k)]);
    };
    const int direction = direction_of(dof);
    if (direction == next) u[dof.dof - 1] = -arm(last);
    if (direction == last) u[dof.dof - 1] = arm(next);
    if (direction == 3 && dof.component[1] - 'x' == axis) u[dof.dof - 1] = 1;
  }
  return u;
}

// Whether K resists u in a row.
class Resistance {
 public:
  Resistance(const SparseMatrix& stiffness, const Eigen::VectorXd& u)
      : force_(stiffness * u), terms_(SparseMatrix(stiffness.cwiseAbs()) * u.cwiseAbs()) {}
  bool in(int row) const { return std::abs(force_[row]) > round_off * terms_[row]; }

 private:
  Eigen::VectorXd force_, terms_;
};

}  // namespace

std::vector<int> dof_directions(const DofTable& table, const std::vector<int>& order) {
  std::vector<int> out;
  for (const int dof : order) out.push_back(direction_of(table.dofs[static_cast<std::size_t>(dof)]));
  return out;
}

Eigen::MatrixXd rigid_motions(const DofTable& table, const SparseMatrix& stiffness, double unit,
                              const std::vector<int>& order) {
  std::vector<Eigen::VectorXd> found;
  std::vector<bool> grounded(table.dofs.size(), false);
  for (int axis = 0; axis < 3; ++axis) {
    found.push_back(translation(table, axis));
    const Resistance resistance(stiffness, found.back());
    for (const int row : order)
      if (resistance.in(row)) grounded[static_cast<std::size_t>(row)] = true;
  }
  for (int axis = 0; axis < 3; ++axis) {
    Eigen::VectorXd turned = rotation(table, axis, unit);
    const Resistance resistance(stiffness, turned);
    bool free = true;
    for (const int row : order) free = free && (grounded[static_cast<std::size_t>(row)] || !resistance.in(row));
    if (free) found.push_back(std::move(turned));
  }
  Eigen::MatrixXd out(static_cast<Eigen::Index>(order.size()), 0);
  for (const Eigen::VectorXd& one : found) {
    Eigen::VectorXd column(out.rows());
    for (std::size_t i = 0; i < order.size(); ++i) column[static_cast<Eigen::Index>(i)] = one[order[i]];
    if (column.isZero(0)) continue;
    out.conservativeResize(Eigen::NoChange, out.cols() + 1);
    out.rightCols(1) = column;
  }
  return out;
}

TranslatedMass translated_mass(const DofTable& table, const SparseMatrix& mass) {
  TranslatedMass out;
  const Eigen::VectorXd diagonal = mass.diagonal();
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::VectorXd u = translation(table, axis);
    out.whole[static_cast<std::size_t>(axis)] = u.dot(mass * u);
    out.diagonal[static_cast<std::size_t>(axis)] = u.dot(diagonal);
  }
  return out;
}

namespace {

class BandOrder {
 public:
  explicit BandOrder(const SparseMatrix& pattern) : next_(static_cast<std::size_t>(pattern.rows())) {
    for (int j = 0; j < pattern.outerSize(); ++j)
      for (SparseMatrix::InnerIterator it(pattern, j); it; ++it)
        if (it.row() != it.col()) next_[static_cast<std::size_t>(j)].push_back(static_cast<int>(it.row()));
    for (auto& list : next_)
      std::sort(list.begin(), list.end(),
                [&](int a, int b) { return std::pair(degree(a), a) < std::pair(degree(b), b); });
    level_.assign(next_.size(), -1);
  }

  std::vector<int> find() {
    std::vector<int> order;
    std::vector<bool> done(next_.size(), false);
    for (std::size_t i = 0; i < next_.size(); ++i) {
      if (done[i]) continue;
      const std::vector<int> component = walk(end_of(static_cast<int>(i)));
      for (const int row : component) done[static_cast<std::size_t>(row)] = true;
      order.insert(order.end(), component.begin(), component.end());
    }
    std::reverse(order.begin(), order.end());
    return order;
  }

 private:
  std::size_t degree(int row) const { return next_[static_cast<std::size_t>(row)].size(); }

  /// Breadth first, neighbours of few neighbours first; levels as they are met.
  std::vector<int> walk(int from) {
    // Nodes of other components keep what they have: none.
    for (const int row : walked_) level_[static_cast<std::size_t>(row)] = -1;
    std::vector<int> met = {from};
    level_[static_cast<std::size_t>(from)] = 0;
    for (std::size_t k = 0; k < met.size(); ++k)
      for (const int other : next_[static_cast<std::size_t>(met[k])])
        if (level_[static_cast<std::size_t>(other)] < 0) {
          level_[static_cast<std::size_t>(other)] = level_[static_cast<std::size_t>(met[k])] + 1;
          met.push_back(other);
        }
    walked_ = met;
    return met;
  }

  /// A node from which the levels are as many as can be found by going to the far end again and again.
  int end_of(int from) {
    int depth = -1;
    while (true) {
      const std::vector<int> met = walk(from);
      const int deepest = level_[static_cast<std::size_t>(met.back())];
      if (deepest <= depth) return from;
      depth = deepest;
      int best = met.back();
      for (const int row : met)
        if (level_[static_cast<std::size_t>(row)] == deepest && degree(row) < degree(best)) best = row;
      from = best;
    }
  }

  std::vector<std::vector<int>> next_;
  std::vector<int> level_, walked_;
};

int width_of(const SparseMatrix& pattern, const std::vector<int>& order) {
  std::vector<int> place(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) place[static_cast<std::size_t>(order[i])] = static_cast<int>(i);
  int width = 0;
  for (int j = 0; j < pattern.outerSize(); ++j)
    for (SparseMatrix::InnerIterator it(pattern, j); it; ++it)
      width = std::max(width, std::abs(place[static_cast<std::size_t>(it.row())] - place[static_cast<std::size_t>(j)]));
  return width;
}

}  // namespace

std::vector<int> narrow_order(const SparseMatrix& pattern) {
  std::vector<int> given(static_cast<std::size_t>(pattern.rows()));
  std::iota(given.begin(), given.end(), 0);
  std::vector<int> found = BandOrder(pattern).find();
  return width_of(pattern, found) < width_of(pattern, given) ? found : given;
}

}  // namespace ricochet
