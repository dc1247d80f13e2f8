#pragma once
#include <ricochet/scene/assembly.hpp>
#include <ricochet/scene/semi_discrete.hpp>

#include "tests/benchmarks/siconos_beam.hpp"

namespace ricochet::benchmarks {

/// The matrices of a beam shaken at its clamp, for a solver that knows nothing of Ricochet.
inline ShakenBeam shaken_beam(const SemiDiscrete& problem) {
  ShakenBeam beam;
  beam.M = dense_mass(problem.inertia);
  beam.K = problem.stiffness;
  beam.H = problem.contact;
  beam.viscosity = problem.damping.stiffness;
  beam.support_shape = problem.support_shape;
  beam.translation = Eigen::VectorXd::Zero(problem.dofs());
  const auto places = dof_places(problem.space);
  for (int i = 0; i < problem.dofs(); ++i) beam.translation[i] = places[static_cast<std::size_t>(i)].slope ? 0 : 1;
  beam.tip = Eigen::MatrixXd(problem.tip).row(0);
  beam.lower = problem.lower;
  beam.upper = problem.upper;
  beam.position = problem.position;
  beam.velocity = problem.velocity;
  beam.amplitude = problem.support.amplitude;
  beam.pulsation = problem.support.pulsation;
  return beam;
}

}  // namespace ricochet::benchmarks
