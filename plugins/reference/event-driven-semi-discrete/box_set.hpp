#pragma once
#include "linear_structure.hpp"

namespace ricochet::reference {

/// The signs of p in lower ≤ y + (W + compliance) p ⊥ p ≤ upper. Throws Stopped where no p is found.
ContactSet box_set(const Eigen::MatrixXd& W, double compliance, const Eigen::VectorXd& y, const Eigen::VectorXd& lower,
                   const Eigen::VectorXd& upper);

}  // namespace ricochet::reference
