#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ricochet/contract/errors.hpp>
#include <ricochet/kernels/block.hpp>
#include <ricochet/kernels/sparse_factor.hpp>
#include <ricochet/kernels/sparse_ldlt.hpp>
#include <ricochet/scene/bodies.hpp>
#include <ricochet/scene/files/text_file.hpp>
#include <ricochet/scene/structure/assembled_structure.hpp>
#include <ricochet/scene/structure/given_dofs.hpp>
#include <ricochet/scene/structure/node_layout.hpp>

namespace ricochet {
namespace {

void check_symmetry(const FileMatrix& read, const std::string& name, const DofTable& table,
                    std::vector<std::string>& notes) {
  if (read.asymmetry == 0) return;
  const auto dof = [&](int number) { return table.dofs[static_cast<std::size_t>(number) - 1].text(); };
  if (read.asymmetry > most_asymmetry)
    throw FileError(fmt::format(
        "{} is not symmetric: entries {}, {} and {}, {} ({}, {}) are {:.12g} and {:.12g}. They differ by {:.3g}, "
        "{:.2g} of the largest entry; expected at most {:g}; {}",
        name, read.row, read.column, read.column, read.row, dof(read.row), dof(read.column), read.there, read.across,
        std::abs(read.there - read.across), read.asymmetry, most_asymmetry, not_treated));
  notes.push_back(
      fmt::format("{} is symmetric to {:.1e} of its largest entry (at most {:g}): the mean of both triangles is used",
                  name, read.asymmetry, most_asymmetry));
}

/// ℓ T A T, T = 1/ℓ on displacements and 1 on rotations.
SparseMatrix in_metres(SparseMatrix matrix, const DofTable& table, double unit) {
  if (unit == 1) return matrix;
  Eigen::VectorXd scale(matrix.rows());
  for (const DofName& one : table.dofs) {
    if (!one.translation() && !one.rotation())
      throw FileError(
          fmt::format("{}: the component {} of dof {} has no known unit; with length_unit {:g} expected ux, "
                      "uy, uz, rx, ry or rz",
                      table.name, one.component, one.dof, unit));
    scale[one.dof - 1] = one.translation() ? 1 / unit : 1.0;
  }
  SparseMatrix scaled = scale.asDiagonal() * matrix * scale.asDiagonal();
  scaled *= unit;
  return scaled;
}

/// Rows and columns of a matrix, in this order.
SparseMatrix picked(const SparseMatrix& matrix, const std::vector<int>& rows, const std::vector<int>& columns) {
  std::vector<int> place(static_cast<std::size_t>(matrix.rows()), -1);
  for (std::size_t i = 0; i < rows.size(); ++i) place[static_cast<std::size_t>(rows[i])] = static_cast<int>(i);
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t j = 0; j < columns.size(); ++j)
    for (SparseMatrix::InnerIterator it(matrix, columns[j]); it; ++it)
      if (const int row = place[static_cast<std::size_t>(it.row())]; row >= 0)
        entries.emplace_back(row, static_cast<int>(j), it.value());
  SparseMatrix out(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(columns.size()));
  out.setFromTriplets(entries.begin(), entries.end());
  return out;
}

Eigen::VectorXd row_sizes(const SparseMatrix& matrix) {
  Eigen::VectorXd size = Eigen::VectorXd::Zero(matrix.rows());
  for (int j = 0; j < matrix.outerSize(); ++j)
    for (SparseMatrix::InnerIterator it(matrix, j); it; ++it)
      size[it.row()] = std::max(size[it.row()], std::abs(it.value()));
  return size;
}

/// The most negative pivot of A + 1e-11 of its own scale, in the units of A, and its row; nothing where none is.
struct NegativePivot {
  int row;
  double value;
};
std::optional<NegativePivot> negative_pivot(const SparseMatrix& matrix) {
  constexpr double round_off = 1e-11;
  const Eigen::VectorXd sizes = row_sizes(matrix);
  std::optional<NegativePivot> worst;
  const auto take = [&](int row, double value) {
    if (value < 0 && (!worst || value < worst->value)) worst = NegativePivot{row, value};
  };
  // A semidefinite matrix has no entry beside a diagonal that is not positive.
  const Eigen::VectorXd diagonal = matrix.diagonal();
  for (int i = 0; i < sizes.size(); ++i)
    if (diagonal[i] <= 0 && sizes[i] > 0) take(i, diagonal[i] < 0 ? diagonal[i] : -sizes[i]);
  if (worst) return worst;
  Eigen::VectorXd scale = diagonal;
  for (double& one : scale) one = one > 0 ? 1 / std::sqrt(one) : 1.0;
  SparseMatrix shift(matrix.rows(), matrix.cols());
  shift.setIdentity();
  const SparseMatrix scaled = SparseMatrix(scale.asDiagonal() * matrix * scale.asDiagonal()) + round_off * shift;
  SparseLdlt ldlt;
  if (!ldlt.factorise(scaled)) return std::nullopt;
  for (int i = 0; i < ldlt.size(); ++i) {
    const int row = ldlt.order()[static_cast<std::size_t>(i)];
    take(row, ldlt.pivot()[static_cast<std::size_t>(i)] / (scale[row] * scale[row]));
  }
  return worst;
}

/// Whether the slowest motion has an energy that is round-off of its own terms. The motion is found by inverse
/// iteration with a factor of K. A pivot that vanishes may come out as one of either sign.
template <class Solve>
bool moves_rigidly(const SparseMatrix& stiffness, Solve&& solve) {
  constexpr int iterations = 4;
  constexpr double round_off = 1e-15;
  Eigen::VectorXd x(stiffness.rows());
  for (Eigen::Index i = 0; i < x.size(); ++i) x[i] = 1 + 0.5 * std::sin(1.7 * static_cast<double>(i));
  for (int k = 0; k < iterations; ++k) {
    solve(x.data());
    x.normalize();
  }
  const double terms = x.cwiseAbs().dot(SparseMatrix(stiffness.cwiseAbs()) * x.cwiseAbs());
  return x.dot(stiffness * x) <= round_off * terms;
}

class StructureMaker {
 public:
  explicit StructureMaker(const AssembledFiles& files) : files_(files) {
    out_.stiffness_name = files.stiffness_name;
    out_.mass_name = files.mass_name;
    out_.table_name = files.table.name;
  }

  AssembledStructure make() {
    check_symmetry(files_.stiffness, files_.stiffness_name, files_.table, out_.notes);
    check_symmetry(files_.mass, files_.mass_name, files_.table, out_.notes);
    const SparseMatrix K = in_metres(files_.stiffness.matrix, files_.table, files_.length_unit),
                       M = in_metres(files_.mass.matrix, files_.table, files_.length_unit);
    list_dofs(K, M);
    out_.links = linked_nodes(out_.nodes, K);
    out_.stiffness = picked(K, free_, free_);
    out_.mass = picked(M, free_, free_);
    out_.half_width = std::max(half_bandwidth(out_.stiffness), half_bandwidth(out_.mass));
    check_matrices();
    const TranslatedMass carried = translated_mass(files_.table, M);
    out_.dofs_known = {.mass = {},
                       .stiffness = {},
                       .direction = dof_directions(files_.table, free_),
                       .rigid = rigid_motions(files_.table, K, files_.length_unit, free_),
                       .translated = carried.whole,
                       .diagonal = carried.diagonal};
    find_static_modes(picked(K, free_, held_), picked(M, free_, held_));
    add_influences();
    if (!files_.damping_name.empty()) take_damping();
    return std::move(out_);
  }

 private:
  const DofName& dof(int index) const { return files_.table.dofs[static_cast<std::size_t>(index)]; }
  std::string dof_text(int row) const {
    const DofName& one = out_.names[static_cast<std::size_t>(row)];
    return fmt::format("dof {} ({})", one.dof, one.text());
  }

  void list_dofs(const SparseMatrix& K, const SparseMatrix& M) {
    out_.where.resize(files_.table.dofs.size());
    for (const DofName& one : files_.table.dofs) {
      AssembledStructure::Node& node = out_.nodes[one.node];
      node.dofs[one.component] = one.dof;
      for (std::size_t axis = 0; axis < 3; ++axis) node.place[axis] = files_.length_unit * one.place[axis];
      if (one.held.empty()) {
        free_.push_back(one.dof - 1);
        continue;
      }
      held_.push_back(one.dof - 1);
      if (one.held == "fixed") continue;
      auto found = std::find(out_.supports.begin(), out_.supports.end(), one.held);
      if (found == out_.supports.end()) found = out_.supports.insert(found, one.held);
      if (!one.rotation())
        out_.where[static_cast<std::size_t>(one.dof) - 1].support = static_cast<int>(found - out_.supports.begin());
    }
    out_.held_dofs = static_cast<int>(held_.size());
    if (free_.empty())
      throw FileError(fmt::format("{} holds all of its {} dofs; expected one that can move", files_.table.name,
                                  files_.table.dofs.size()));
    const SparseMatrix pattern = picked(K, free_, free_).cwiseAbs() + SparseMatrix(picked(M, free_, free_).cwiseAbs());
    std::vector<int> order;
    for (const int row : narrow_order(pattern)) order.push_back(free_[static_cast<std::size_t>(row)]);
    free_ = std::move(order);
    for (std::size_t i = 0; i < free_.size(); ++i) {
      DofName one = dof(free_[i]);
      for (double& x : one.place) x *= files_.length_unit;
      out_.names.push_back(one);
      out_.where[static_cast<std::size_t>(free_[i])].free = static_cast<int>(i);
    }
  }

  void check_matrices() {
    const Eigen::VectorXd stiff = row_sizes(out_.stiffness), heavy = row_sizes(out_.mass);
    for (int i = 0; i < stiff.size(); ++i)
      if (stiff[i] == 0 && heavy[i] == 0)
        throw FileError(fmt::format("nothing holds or moves {}: its rows of {} and {} are zero", dof_text(i),
                                    files_.stiffness_name, files_.mass_name));
    if (semidefinite_rank(out_.mass) < out_.dofs())
      check_pivots(out_.mass, files_.mass_name, "a mass is positive semidefinite");
    if (half_bandwidth(out_.stiffness) > narrow_band) out_.factor = SparseFactor::of(out_.stiffness);
    if (out_.factor && out_.factor->positive()) {
      Block work(out_.dofs() + 1, 1);
      out_.definite = !moves_rigidly(out_.stiffness, [&](double* x) { out_.factor->solve(x, x, work.data()); });
      if (out_.definite) return;
    }
    out_.factor.reset();
    check_pivots(out_.stiffness, files_.stiffness_name, "expected a structure in stable equilibrium");
    SparseLdlt ldlt;
    out_.definite =
        ldlt.factorise(out_.stiffness) && !moves_rigidly(out_.stiffness, [&](double* x) { ldlt.solve(x, x); });
    if (out_.definite) return;
    const double sigma = (heavy.maxCoeff() > 0 && stiff.maxCoeff() > 0) ? stiff.maxCoeff() / heavy.maxCoeff() : 1.0;
    if (!ldlt.factorise(out_.stiffness + sigma * out_.mass))
      throw FileError(fmt::format("{} and {} have a motion that neither holds nor moves: {}", files_.stiffness_name,
                                  files_.mass_name, ldlt.reason()));
  }

  /// Refuses a negative pivot, unless it is round-off of the largest. Rows whose diagonal is that round-off become 0.
  void check_pivots(SparseMatrix& matrix, const std::string& name, const char* why) {
    constexpr double round_off = 1e-12;
    const Eigen::VectorXd diagonal = matrix.diagonal();
    const double largest = diagonal.maxCoeff();
    const auto first = negative_pivot(matrix);
    for (auto found = first; found;) {
      if (!(largest > 0 && -found->value <= round_off * largest))
        throw FileError(fmt::format("{} has a negative pivot {:.3g} at {}, beyond {:g} of the largest: {}", name,
                                    found->value, dof_text(found->row), -round_off, why));
      const Eigen::Index entries = matrix.nonZeros();
      matrix.prune([&](Eigen::Index i, Eigen::Index j, double) { return diagonal[i] > 0 && diagonal[j] > 0; });
      found = matrix.nonZeros() < entries ? negative_pivot(matrix) : std::nullopt;
    }
    if (first)
      out_.notes.push_back(fmt::format("{} has a negative pivot {:.3g} at {}, {:.1e} of the largest: taken for 0", name,
                                       first->value, dof_text(first->row), first->value / largest));
  }

  // 1 on the displacements that a support holds.
  Eigen::VectorXd held_by(Eigen::Index support) const {
    Eigen::VectorXd moved = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(held_.size()));
    for (std::size_t i = 0; i < held_.size(); ++i)
      if (out_.where[static_cast<std::size_t>(held_[i])].support == support) moved[static_cast<Eigen::Index>(i)] = 1;
    return moved;
  }

  void take_damping() {
    check_symmetry(files_.damping, files_.damping_name, files_.table, out_.notes);
    const SparseMatrix C = in_metres(files_.damping.matrix, files_.table, files_.length_unit);
    out_.damping = picked(C, free_, free_);
    const SparseMatrix across = picked(C, free_, held_);
    constexpr double negligible = 1e-12;
    for (Eigen::Index j = 0; j < out_.static_modes.cols(); ++j) {
      const Eigen::VectorXd own = out_.damping * out_.static_modes.col(j), all = own + across * held_by(j);
      if (all.norm() > negligible * own.norm())
        out_.notes.push_back(
            fmt::format("{} damps the static mode of the support {} by {:.2g} of its own force: it is "
                        "left out, as C acts on relative velocities",
                        files_.damping_name, out_.supports[static_cast<std::size_t>(j)], all.norm() / own.norm()));
    }
  }

  void find_static_modes(const SparseMatrix& K_held, const SparseMatrix& M_held) {
    const auto n = static_cast<Eigen::Index>(free_.size()), r = static_cast<Eigen::Index>(out_.supports.size());
    out_.static_modes = out_.support_loads = Eigen::MatrixXd::Zero(n, r);
    if (r == 0) return;
    SparseLdlt ldlt;
    if (!ldlt.factorise(out_.stiffness))
      throw FileError(
          fmt::format("{} does not hold the free dofs, so the support {} has no static mode; expected its "
                      "dofs fixed, or a structure without rigid motion",
                      files_.stiffness_name, out_.supports.front()));
    for (Eigen::Index j = 0; j < r; ++j) {
      const Eigen::VectorXd moved = held_by(j), right = -(K_held * moved);
      Eigen::VectorXd mode(n), step(n);
      ldlt.solve(right.data(), mode.data());
      // One refinement: the residual of a slender structure is then round-off of its own entries.
      const Eigen::VectorXd residual = right - out_.stiffness * mode;
      ldlt.solve(residual.data(), step.data());
      mode += step;
      out_.static_modes.col(j) = mode;
      out_.support_loads.col(j) = out_.mass * mode + M_held * moved;
    }
  }

  void add_influences() {
    for (const AssembledFiles::Influence& one : files_.influences) {
      if (std::find(out_.supports.begin(), out_.supports.end(), one.support) != out_.supports.end())
        throw FileError(fmt::format("{} holds dofs by the support {}, whose static mode is computed; expected no {}",
                                    files_.table.name, one.support, one.file));
      Eigen::VectorXd mode = Eigen::VectorXd::Zero(out_.dofs());
      for (const auto& [number, value] : one.values) {
        const int row = out_.where[static_cast<std::size_t>(number) - 1].free;
        if (row < 0 && value != 0)
          throw FileError(fmt::format("{}: dof {} ({}) is held, and would follow by {:.6g}; expected 0", one.file,
                                      number, dof(number - 1).text(), value));
        // Rotations are per unit of length.
        if (row >= 0) mode[row] = dof(number - 1).rotation() ? value / files_.length_unit : value;
      }
      const Eigen::Index r = out_.static_modes.cols();
      out_.static_modes.conservativeResize(out_.dofs(), r + 1);
      out_.support_loads.conservativeResize(out_.dofs(), r + 1);
      out_.static_modes.col(r) = mode;
      out_.support_loads.col(r) = out_.mass * mode;
      out_.supports.push_back(one.support);
    }
  }

  const AssembledFiles& files_;
  AssembledStructure out_;
  std::vector<int> free_, held_;  // of the table, from 0
};

}  // namespace

AssembledStructure assemble_structure(const AssembledFiles& files) {
  return StructureMaker(files).make();
}

}  // namespace ricochet
