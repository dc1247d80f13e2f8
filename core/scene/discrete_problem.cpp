#include <Eigen/Cholesky>
#include <ricochet/scene/assembly.hpp>
#include <ricochet/scene/discrete_problem.hpp>

namespace ricochet {
namespace {

// By LLᵀ, where dense_mass() takes LDLᵀ: stored errors have the last digits of this one.
Eigen::MatrixXd marched_mass(const Inertia& inertia) {
  if (inertia.assembled()) return Eigen::MatrixXd(inertia.mass);
  const MassFactors factors = mass_factors(inertia);
  const Eigen::MatrixXd B = factors.coupling, C = factors.velocity_mass;
  return B.transpose() * C.llt().solve(B);
}

}  // namespace

SparseRows place_rows(const SemiDiscrete& problem, const std::vector<double>& places) {
  if (!problem.space.given) return problem.on_unknowns(displacement_rows(problem.space, places));
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t i = 0; i < places.size(); ++i)
    for (SparseRows::InnerIterator it(problem.tip, 0); it; ++it)
      entries.emplace_back(static_cast<int>(i), static_cast<int>(it.col()), it.value());
  SparseRows rows(static_cast<Eigen::Index>(places.size()), problem.dofs());
  rows.setFromTriplets(entries.begin(), entries.end());
  return rows;
}

SparseRows strain_rows(const SemiDiscrete& problem, const std::vector<double>& places) {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t i = 0; i < places.size(); ++i)
    for (const auto& [dof, value] : strain_row(problem.space, places[i]))
      entries.emplace_back(static_cast<int>(i), dof, value);
  SparseRows rows(static_cast<Eigen::Index>(places.size()), problem.space.dofs);
  rows.setFromTriplets(entries.begin(), entries.end());
  return problem.on_unknowns(std::move(rows));
}

DiscreteProblem discrete_problem(const SemiDiscrete& problem, const std::vector<double>& places) {
  DiscreteProblem discrete;
  discrete.mass = marched_mass(problem.inertia);
  discrete.stiffness = problem.stiffness;
  discrete.contact = problem.measured();
  discrete.lower = problem.lower;
  discrete.upper = problem.upper;
  discrete.support_shape = problem.support_shape;
  discrete.position = problem.position;
  discrete.velocity = problem.velocity;
  discrete.load_constant = Eigen::VectorXd::Zero(problem.dofs());
  if (!problem.load->absent()) problem.load->assemble(0, discrete.load_constant.data());
  discrete.tip = Eigen::MatrixXd(problem.tip).row(0);
  discrete.places = Eigen::MatrixXd(place_rows(problem, places));
  discrete.strains = Eigen::MatrixXd(strain_rows(problem, places));
  return discrete;
}

}  // namespace ricochet
