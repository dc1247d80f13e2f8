#pragma once
#include <Eigen/Core>
#include <ricochet/contract/mass_strategy.hpp>

#include "runners/check/checks.hpp"

/// \file
/// Displacement spaces on which masses are checked: a beam or a bar of unit length and, where it is even, of unit
/// density. Each end is fixed or free. Stops are nowhere, at the free ends, or at all nodes.
namespace ricochet::checking {

using Mass = Subject<MassStrategy>;

struct SpaceBench {
  enum class Stops { none, ends, nodes };
  bool beam = false;
  int elements = 6;
  bool left_fixed = false, right_fixed = false;
  bool point_mass = false;  ///< 0.3 kg in the middle
  Stops stops = Stops::none;
  bool pinned = false;  ///< the displacement of a beam is held at a node at a third of its length, too
  /// Elements of unlike lengths, from 0.6 to 1.4 of the mean, and two halves of unlike section, of 1 and 2.5 kg/m.
  bool uneven = false;
  bool mirrored = false;       ///< what is uneven, seen from the other end
  bool rotary = false;         ///< the sections of a beam resist rotation, with 2e-3 and 6e-3 kg m
  bool point_inertia = false;  ///< 0.05 kg m² on the rotation in the middle of a beam
};
/// Where stops may stand.
std::vector<SpaceBench::Stops> stops_of(bool no_free_end);
FiniteElementSpace unit_space(const SpaceBench& bench);
/// "a beam of 6 elements, fixed at its left end".
std::string space_text(const SpaceBench& bench);
/// kg of its elements, and kg m² that they resist a rotation with by their sections alone.
double mass_of(const FiniteElementSpace& space);
double rotary_of(const FiniteElementSpace& space);
/// One mass of 1 kg without elements.
FiniteElementSpace oscillator_space();

/// What the strategy builds; throws Refused.
Inertia built(const Mass& mass, const FiniteElementSpace& space);
InertiaOrRefusal ask_mass(const Mass& mass, const FiniteElementSpace& space);
/// M, formed where it is factored. Throws std::runtime_error where sizes do not fit or numbers are none.
Eigen::MatrixXd dense(const Inertia& inertia, const FiniteElementSpace& space);
/// K of EI = 1 or EA = 1.
Eigen::MatrixXd unit_stiffness(const FiniteElementSpace& space);
/// The spaces (of beams and bars, with any stops) that the strategy does not refuse. `accepted_pinned`: those of beams
/// with a support between their ends.
std::vector<SpaceBench> accepted(const Mass& mass, int elements);
std::vector<SpaceBench> accepted_pinned(const Mass& mass, int elements);

// What is looked at in a mass strategy.

Verdict some_structure_is_accepted(const Mass& mass);
Verdict matrix_is_symmetric(const Mass& mass);
Verdict matrix_is_semidefinite(const Mass& mass);
Verdict kernel_as_declared(const Mass& mass);
Verdict total_mass_is_right(const Mass& mass);
Verdict ends_are_treated_alike(const Mass& mass);
Verdict frequencies_converge(const Mass& mass);
Verdict rotations_have_their_inertia(const Mass& mass);

const std::vector<Check<MassStrategy>>& mass_checks();

}  // namespace ricochet::checking
