#pragma once
#include <vector>

#include "linear_structure.hpp"

/// \file
/// The semi-discrete problem while its contact set stays as it is: linear, with constant coefficients, hence a sum of
/// modes. One ContactModes per set; nothing in it depends on when or how the set is entered.
namespace ricochet::reference {

/// What ends a phase when it falls below zero: a gap of an open point, the force or the depth of a closed one.
struct Watch {
  int point = 0;
  int sign = 0;         ///< of the force that acts there, or would
  bool closed = false;  ///< false: the gap
};

/// w = X q + Re(D e),  q in three kinds: oscillators q'' + 2δq' + λq = Re(f e), first-order modes z' = s z + g e (real
/// ones, or complex ones of which real and imaginary part take a column each), and what follows at once, in D.
struct ContactModes {
  Eigen::MatrixXd shapes;                      ///< X, n × columns
  Signals offset;                              ///< D, n rows
  Eigen::VectorXd rates;                       ///< the fastest rate of each column, 1/s
  std::vector<LinearMode> oscillators;         ///< the first columns
  Signals oscillator_force;                    ///< f
  Eigen::MatrixXd oscillator_reader;           ///< XᵀM: q = XᵀM(w − D)
  std::vector<Complex> relaxations;            ///< s
  std::vector<bool> single;                    ///< of each s: real, one column
  Eigen::MatrixXcd relaxation_force;           ///< g; columns: 0, σ₁, −σ₁, σ₂, −σ₂, …
  Eigen::MatrixXcd place_reader, rate_reader;  ///< z = P(w − D) + R(w' − D')
  std::vector<Watch> watches;
  Eigen::MatrixXd watch_place, watch_rate;  ///< value = A q + B q' + Re(c e)
  Signals watch_signal;                     ///< c
  Eigen::VectorXd watch_steady;             ///< bound of the second derivative of what harmonic forces impose

  Eigen::Index columns() const { return shapes.cols(); }
};

ContactModes contact_modes(const LinearStructure& structure, const ContactSet& set);

/// The signs of p in lower ≤ y + (W + compliance) p ⊥ p ≤ upper. Throws Stopped where no p is found.
ContactSet box_set(const Eigen::MatrixXd& W, double compliance, const Eigen::VectorXd& y, const Eigen::VectorXd& lower,
                   const Eigen::VectorXd& upper);

/// What the contact points move against: massless modes alone, or mass.
struct ContactPoints {
  Eigen::MatrixXd reach;    ///< H Z, Z the massless modes
  Eigen::MatrixXd moving;   ///< H X of the oscillators with contact open
  bool massless = false;    ///< the massless modes carry every contact point
  Eigen::Index kernel = 0;  ///< massless modes

  /// `open`: the modes without contact. Throws Stopped for rigid stops without unique motion: two points at one place,
  /// several with inertia, one that mass and massless modes carry together.
  ContactPoints(const LinearStructure& structure, const ContactModes& open);
};

}  // namespace ricochet::reference
