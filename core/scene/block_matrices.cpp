#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <ricochet/contract/errors.hpp>
#include <ricochet/contract/said_format.hpp>
#include <ricochet/scene/basis/modal_basis.hpp>
#include <ricochet/scene/block_matrices.hpp>
#include <ricochet/scene/bodies.hpp>
#include <ricochet/scene/semi_discrete.hpp>
#include <ricochet/scene/structure/assembled_structure.hpp>
#include <stdexcept>

namespace ricochet {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Where the unknowns of each body stand among all: dofs in their order, or coordinates of its basis.
std::vector<std::vector<int>> unknowns_of(const JoinedBodies& bodies, const SemiDiscrete& problem) {
  std::vector<std::vector<int>> out;
  for (std::size_t b = 0; b < bodies.all.size(); ++b) {
    if (problem.basis) {
      out.push_back(problem.basis->parts[b].where);
      continue;
    }
    out.push_back(numbered_from(bodies.all[b].first, bodies.all[b].dofs()));
  }
  return out;
}

// Rows and columns of some unknowns.
SparseMatrix picked(const SparseMatrix& matrix, const std::vector<int>& unknowns) {
  SparseMatrix pick(static_cast<Index>(unknowns.size()), matrix.rows());
  for (std::size_t i = 0; i < unknowns.size(); ++i) pick.insert(static_cast<Index>(i), unknowns[i]) = 1;
  return pick * matrix * SparseMatrix(pick.transpose());
}

// Σ_k 2ζ_kω_k (Mφ_k)(Mφ_k)ᵀ over the elastic modes that have mass, φᵀMφ = 1, slowest first.
SparseMatrix by_modes(const SparseMatrix& K, const SparseMatrix& M, bool definite, const Damping& damping) {
  const LowestModes modes = lowest_modes(K, M, semidefinite_rank(M), definite);
  const MatrixXd weighed = M * modes.shapes;
  MatrixXd C = MatrixXd::Zero(K.rows(), K.cols());
  std::size_t elastic = 0;
  for (Index k = 0; k < modes.squares.size(); ++k)
    if (modes.squares[k] > 0)
      C += damping.rate(modes.squares[k], elastic++) * weighed.col(k) * weighed.col(k).transpose();
  return C.sparseView();
}

// A body as the mass strategy sees it alone.
SemiDiscrete alone(const JoinedBodies& bodies, std::size_t number, const SemiDiscrete& problem) {
  const JoinedBody& body = bodies.all[number];
  SemiDiscrete one;
  one.space = body.space;
  for (const int dof : problem.space.contact_dofs)
    if (body.has(dof)) one.space.contact_dofs.push_back(dof - body.first);
  if (problem.basis) one.basis = problem.basis->parts[number].basis;
  return one;
}

}  // namespace

ModalBasis join_bases(const JoinedBodies& bodies, const SemiDiscrete& problem, const SparseMatrix& mass,
                      const SparseRows& rows, const BasisSpec& spec) {
  ModalBasis out;
  int statics = 0;
  for (std::size_t b = 0; b < bodies.all.size(); ++b) {
    const JoinedBody& body = bodies.all[b];
    BasisSpec own = spec;
    own.of_bodies.clear();
    if (!spec.of_bodies.empty()) own.modes = spec.of_bodies[b];
    const SparseMatrix K = problem.stiffness.block(body.first, body.first, body.dofs(), body.dofs()),
                       M = mass.block(body.first, body.first, body.dofs(), body.dofs());
    ModalBasis::Part& part = out.parts.emplace_back();
    part.first = body.first;
    part.mass = M;
    part.contact = rows.middleCols(body.first, body.dofs());
    try {
      part.basis = std::make_shared<const ModalBasis>(modal_basis(K, M, part.contact, body.held, own));
    } catch (const InputError& error) {
      throw InputError(error.pointer(), fmt::format("body {}: {}", body.name, error.what()));
    }
    out.modes += part.basis->modes;
    statics += part.basis->dofs() - part.basis->modes;
  }
  const Index all = out.modes + statics, points = rows.rows();
  out.shapes = MatrixXd::Zero(problem.space.dofs, all);
  out.stiffness = VectorXd::Zero(all);
  out.squares = VectorXd::Zero(out.modes);
  out.at_points = MatrixXd::Zero(points, all);
  out.left_out = out.flexibility = VectorXd::Zero(points);
  MatrixEntries entries;
  int mode = 0, beside = out.modes;
  for (ModalBasis::Part& part : out.parts) {
    const ModalBasis& own = *part.basis;
    out.squares.segment(mode, own.modes) = own.squares;
    for (int k = 0; k < own.dofs(); ++k) {
      const int at = k < own.modes ? mode++ : beside++;
      part.where.push_back(at);
      out.shapes.col(at).segment(part.first, own.shapes.rows()) = own.shapes.col(k);
      out.stiffness[at] = own.stiffness[k];
      out.at_points.col(at) = own.at_points.col(k);
    }
    add_block(own.mass, part.where, part.where, entries);
    out.left_out += own.left_out;
    out.flexibility += own.flexibility;
  }
  out.mass = sparse_matrix(all, all, entries);
  return out;
}

InertiaOrRefusal join_masses(const JoinedBodies& bodies, const SemiDiscrete& problem, const MassOfBody& build) {
  std::vector<Inertia> masses;
  for (std::size_t b = 0; b < bodies.all.size(); ++b) {
    const SemiDiscrete one = alone(bodies, b, problem);
    // A point mass has nothing to spread: it is what every strategy leaves it.
    if (std::holds_alternative<OscillatorSpec>(bodies.all[b].alone.structure)) {
      masses.emplace_back().mass = one.basis ? one.basis->mass : consistent_mass(one.space);
      continue;
    }
    InertiaOrRefusal built = build(one);
    if (const auto* refusal = std::get_if<Refusal>(&built))
      return Refusal{said("body {}: {}", bodies.all[b].name, refusal->sentence)};
    masses.push_back(std::get<Inertia>(std::move(built)));
  }
  const auto assembled = [](const Inertia& one) { return one.assembled(); };
  if (!std::all_of(masses.begin(), masses.end(), assembled))
    for (std::size_t b = 0; b < masses.size(); ++b)
      if (masses[b].assembled() && masses[b].kernel_dimension > 0)
        return Refusal{
            said("body {}: its mass is singular and those of other bodies are not kept as matrices: use "
                 "the mass consistent",
                 bodies.all[b].name)};
  return join_inertias(masses, unknowns_of(bodies, problem),
                       problem.basis ? problem.basis->dofs() : problem.space.dofs);
}

SparseMatrix join_dampings(const JoinedBodies& bodies, const SemiDiscrete& problem) {
  const std::vector<std::vector<int>> unknowns = unknowns_of(bodies, problem);
  const Index size = problem.stiffness.rows();
  MatrixEntries entries;
  for (std::size_t b = 0; b < bodies.all.size(); ++b) {
    const JoinedBody& body = bodies.all[b];
    const Damping damping = damping_of(body.alone.structure);
    const SparseMatrix K = picked(problem.stiffness, unknowns[b]);
    const ModalBasis* basis = problem.basis ? problem.basis->parts[b].basis.get() : nullptr;
    SparseMatrix M = basis ? basis->mass : consistent_mass(body.space), C;
    if (problem.inertia.assembled()) M = picked(problem.inertia.mass, unknowns[b]);
    if (damping.matrix)
      C = basis ? SparseMatrix((basis->shapes.transpose() * (*damping.matrix * basis->shapes)).eval().sparseView())
                : *damping.matrix;
    else if (damping.by_modes())
      C = by_modes(K, M, body.held, damping);
    else
      C = damping.stiffness * K + damping.mass * M;
    add_block(C, unknowns[b], unknowns[b], entries);
  }
  return sparse_matrix(size, size, entries);
}

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
