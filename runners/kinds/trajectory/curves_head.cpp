#include "runners/kinds/trajectory/curves_head.hpp"

namespace ricochet {

Table curves_head() {
  return {"curves",
          "One sample of the motion of one case; the name of the file is the case.",
          {{"t", "s", "Time of the sample."},
           {"tip_displacement", "m", "Absolute displacement of the tip, the motion of the support included."},
           {"tip_velocity", "m/s", "Absolute velocity of the tip, the mean over the last sub-step."},
           {"kinetic", "J", "Kinetic energy ½vᵀMv in the frame of the clamp, where the scheme's velocity stands."},
           {"elastic", "J", "Elastic energy ½qᵀKq."},
           {"contact", "J", "Energy that the springs at the stops store; 0 where they are rigid."},
           {"energy", "J", "The common mechanical energy: kinetic, elastic and contact."},
           {"scheme_energy", "J", "The scheme's own discrete energy; the common one where it declares none."},
           {"contact_force", "N", "Sum of the contact efforts over the points at the last step, positive upwards."},
           {"penetration", "m", "Distance by which a contact point is past its stop, the largest over the points."},
           {"active", "1", "Number of contact points that are closed."},
           {"contact_force_total", "N",
            "Sum of the forces at the contact points by magnitude at the last step: those of opposite stops do not "
            "cancel."},
           {"contact_force_peak", "N", "Largest force of one contact point since the sample before, from every step."},
           {"tip_displacement_low", "m", "Smallest displacement of the tip since the sample before, from every step."},
           {"tip_displacement_high", "m", "Largest displacement of the tip since the sample before."},
           {"penetration_peak", "m", "Largest penetration since the sample before, from every step."}},
          {}};
}

}  // namespace ricochet
