#include <fmt/format.h>

#include <algorithm>
#include <ricochet/contract/errors.hpp>
#include <ricochet/scene/basis/lowest_modes.hpp>
#include <ricochet/scene/block_matrices.hpp>
#include <ricochet/scene/bodies.hpp>
#include <ricochet/scene/semi_discrete.hpp>
#include <ricochet/scene/structure/assembled_structure.hpp>

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
                      const BasisSpec& spec) {
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
    part.contact = problem.contact.middleCols(body.first, body.dofs());
    try {
      part.basis = std::make_shared<const ModalBasis>(modal_basis(K, M, part.contact, body.held, own));
    } catch (const InputError& error) {
      throw InputError(error.pointer(), fmt::format("body {}: {}", body.name, error.what()));
    }
    out.modes += part.basis->modes;
    statics += part.basis->dofs() - part.basis->modes;
  }
  const Index all = out.modes + statics, points = problem.contact.rows();
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
      return Refusal{fmt::format("body {}: {}", bodies.all[b].name, refusal->sentence)};
    masses.push_back(std::get<Inertia>(std::move(built)));
  }
  const auto assembled = [](const Inertia& one) { return one.assembled(); };
  if (!std::all_of(masses.begin(), masses.end(), assembled))
    for (std::size_t b = 0; b < masses.size(); ++b)
      if (masses[b].assembled() && masses[b].kernel_dimension > 0)
        return Refusal{
            fmt::format("body {}: its mass is singular and those of other bodies are not kept as matrices: use "
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

}  // namespace ricochet
