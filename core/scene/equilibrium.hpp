#pragma once
#include <Eigen/Core>
#include <ricochet/contract/contact_law.hpp>

namespace ricochet {

struct SemiDiscrete;

/// A structure at rest under its load and its stops:
///
///     K q = F + Gᵀ p,     p the force of the contact law at G q + lift, at rest
///
/// of a rigid law lower ≤ G q + lift ≤ upper ⊥ p. Where K is singular, as the limit of K + εD, D its diagonal: stops
/// that push hold the rigid motions.
struct Equilibrium {
  Eigen::VectorXd position;  ///< q, n
  Eigen::VectorXd pushed;    ///< Gᵀ p, n
};

/// `load` F (n), `lift` (m): what supports move the contact points by, less the motion of their stops. `law`: prepared
/// for one lane; null: no stops. Throws InputError at /scene/initial/equilibrium where nothing balances the load, or
/// the law finds no force.
Equilibrium equilibrium(const SemiDiscrete& problem, const Eigen::VectorXd& load, const Eigen::VectorXd& lift,
                        ContactLaw* law);

}  // namespace ricochet
