#include "runners/store/record.hpp"

namespace ricochet {

const std::vector<MeasureInfo>& trajectory_measures() {
  static const std::vector<MeasureInfo> measures = {
      {"scheme_energy_start", "J", "The scheme's own discrete energy after its start rule, where it declares one."},
      {"scheme_energy_end", "J", "The scheme's own discrete energy after the last step."},
      {"energy_start", "J",
       "The common mechanical energy ½vᵀMv + ½qᵀKq plus the contact potential, where the scheme's velocity stands: at "
       "t = 0, "
       "or in the middle of the first sub-step where the velocity is a mean over it."},
      {"energy_end", "J",
       "The common mechanical energy at the end of the last step, or in the middle of its last sub-step."},
      {"energy_ratio", "1", "Common energy at the end divided by that at the start."},
      {"largest_step_gain", "J",
       "Largest increase of the scheme's own energy (the common one where none is declared) over one step, beyond the "
       "work of the loads."},
      {"drift_per_impact", "J",
       "Change of energy that damping and loads do not explain, divided by the number of impacts."},
      {"work_of_damping", "J", "Energy taken out by the viscous forces over the run."},
      {"work_of_loads", "J",
       "Energy brought in by the distributed load and by the moving support over the run, in the frame of the clamp."},
      {"dissipated_at_contact", "J",
       "Energy taken out by the contact efforts over the run, less what springs at the stops still store."},
      {"balance_residual", "J",
       "What the balance of the scheme's own energy fails to close by: change − loads + damping + losses that the "
       "scheme "
       "declares − work of the stops; "
       "round-off × steps "
       "where the scheme has an exact balance."},
      {"projection_energy", "J",
       "Energy after minus before the projection of the initial state on the constraint of a singular mass."},
      {"kernel_energy", "J",
       "Energy of the initial state in the kernel of a singular mass, which no inertia holds: lost or left ringing at "
       "any step, 0 after projection."},
      {"deepest_penetration", "m", "Largest distance by which a contact point passed its stop."},
      {"impacts", "1", "Number of times that contact began: no active point in one sub-step, some in the next."},
      {"active_set_changes", "1", "Number of sub-steps at which the set of closed contact points changed."},
      {"impulse", "N s",
       "Momentum that the contact efforts give, summed by magnitude over the contact points; what an effort of each "
       "stage is "
       "worth follows from the scheme's plan."},
      {"complementarity_residual", "m or m/s",
       "Largest complementarity residual of the contact problem over the run, in units of the measure (position or "
       "velocity)."},
      {"law_iterations", "1", "Most iterations that one solve of the contact law took."},
      {"dissipated_by_law", "J",
       "Energy that a compliant law itself took out over the run, by the power that it reports: the share of a damper "
       "in what is dissipated at contact."},
      {"dissipated_by_scheme", "J",
       "Energy that the scheme itself took out over the run, apart from damping and stops: numerical damping, where "
       "the "
       "scheme declares its losses."},
      {"first_impact", "s", "Time at which a contact point first closed."},
      {"first_release", "s", "Time at which a contact point first opened again."},
      {"tip_displacement_end", "m", "Absolute displacement of the tip at the end of the run."},
      {"microseconds_per_step", "µs",
       "Processor time of the marching, energy audit of every step included, divided by the number of steps."},
  };
  return measures;
}

const std::vector<MeasureInfo>& further_measures() {
  static const std::vector<MeasureInfo> measures = {
      {"horizon", "s", "Time up to which the motion is compared with its reference."},
      {"reference_of_mesh", "1",
       "1 where the reference has the case's own mesh, so that the error is the time scheme's; 0 where it has none."},
      {"declared_order", "1", "Order in the step that the scheme declares for such a run."},
      {"error.tip-linf", "m", "Largest difference of the tip's displacement from the reference, over the samples."},
      {"error.tip-l2", "m", "Root mean square over time of the difference of the tip's displacement."},
      {"error.displacement-l2", "m^3/2",
       "Root mean square over time of the L² norm along x of the difference of the displacement."},
      {"error.displacement-h2", "m^-1/2",
       "Root mean square over time of the L² norm of the difference of the curvature (a bar: of the strain)."},
      {"error.velocity-l2", "m^3/2/s", "Root mean square over time of the L² norm of the difference of the velocity."},
      {"error.energy", "J", "Mean over time of the modulus of the difference of the mechanical energy."},
      {"error.impact-times", "s",
       "Largest distance from an impact of the reference to the nearest impact on the same side."},
      {"error.impulse", "N s",
       "Largest difference of the impulse so far: the contact force in the dual norm of W^{1,1}."},
      {"timed_seconds", "s", "Processor time of the marching alone, nothing observed: median of the repeats."},
      {"timed_low", "s", "The fastest repeat."},
      {"timed_high", "s", "The slowest repeat."},
      {"limit_predicted", "s", "Largest stable step of the range, from the plan alone."},
      {"limit_observed", "s", "Largest stable step of the range, found by marching and bisection."},
      {"largest_radius", "1", "Largest spectral radius of the step over the range."},
      {"agreement", "1", "Observed over predicted step limit."},
      {"contradictions", "1",
       "Steps of the range at which spectrum and march disagree without contact: an error of the method."},
      {"orbits", "1", "Orbits that were marched to the end of their kept periods."},
      {"share_periodic", "1", "Share of these orbits that repeat, contact-free ones not counted."},
      {"share_chaotic", "1", "Share of these orbits that are chaotic."},
      {"impacts_per_period", "1", "Impacts in one forcing period, mean over these orbits."},
      {"largest_exponent", "1/s", "Largest Lyapunov exponent among these orbits."},
      {"exponent_seconds", "s", "Processor time of the exponents."},
      {"lane_steps_per_second", "1/s", "Steps of single orbits per second of processor time, exponents not counted."},
  };
  return measures;
}

const MeasureInfo* measure_info(const std::string& name) {
  for (const auto* list : {&trajectory_measures(), &further_measures()})
    for (const MeasureInfo& info : *list)
      if (name == info.name) return &info;
  return nullptr;
}

}  // namespace ricochet
