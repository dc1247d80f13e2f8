#pragma once
#include "contact_modes.hpp"

namespace ricochet::reference {

/// The signs of p in lower ≤ y + (W + compliance) p ⊥ p ≤ upper. Throws Stopped where no p is found.
ContactSet box_set(const Eigen::MatrixXd& W, double compliance, const Eigen::VectorXd& y, const Eigen::VectorXd& lower,
                   const Eigen::VectorXd& upper);

/// What the contact points move against: massless modes alone, or mass.
struct ContactPoints {
  Eigen::MatrixXd reach;    ///< H Z, Z the massless modes
  Eigen::MatrixXd moving;   ///< H X of the oscillators with contact open
  bool massless = false;    ///< the massless modes carry every contact point
  Eigen::Index kernel = 0;  ///< massless modes

  /// `open`: the modes without contact. Throws Stopped where rigid stops have no unique motion: two points at one
  /// place, several points with inertia, a point that mass and massless modes carry together.
  ContactPoints(const LinearStructure& structure, const ContactModes& open);
};

}  // namespace ricochet::reference
