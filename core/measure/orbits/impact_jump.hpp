#pragma once
#include <Eigen/Core>
#include <memory>
#include <optional>
#include <ricochet/engine/marcher.hpp>
#include <vector>

namespace ricochet {

/// The jump of tangent columns at impacts with inertia. Where a contact point has mass, the derivative of a fixed-step
/// impact is not that of the motion, at any step. The step at which the point is met does not move with the orbit.
/// Tangents are therefore held free through an impact, of at most three steps of contact. When it is over the exact
/// jump is put on them, with δt = −H δq⁻/w⁻ the shift of the impact's time:
///
///     δq⁺ = δq⁻ + (v⁻ − v⁺) δt
///     δv⁺ = δv⁻ + (a⁻ − a⁺) δt − (1+e) r [H δv⁻ + (H a⁻ + φ'') δt],        (1+e) r = (v⁻ − v⁺)/w⁻
///
/// The speed of the point is w = Hv + φ'. The orbit's v± and a± come from its displacements before and after, carried
/// to the time of the impact. The coefficient e is what the plan restitutes to a free mass, or the stop's own. The jump
/// is second-order accurate in h on regular masses.
///
/// A contact that lasts longer is a point that comes to rest: at the end of chattering, or at once. Where it is and how
/// fast then depends on nothing that was before, so with A the points that rest now
///
///     δq ← P δq,  δv ← P δv,      P = I − M⁻¹H_Aᵀ (H_A M⁻¹H_Aᵀ)⁻¹ H_A
///
/// which is the limit of the jumps above along a chattering sequence, as (a⁻ − a⁺) δt cancels there. From there on the
/// derivative of the step with its contact set is right. It is continuous where the point leaves, as the effort is zero
/// then. That limit is of e > 0: a structure whose point sticks where it lands has untold jumps. An oscillator keeps
/// nothing: its orbit is superstable. An impact with e = 0 whose point leaves at once ends one direction only,
/// H δq⁺ = 0. When the point leaves still depends on when it came.
///
/// An impact has no jump where the jump of the last one could not be put on yet. Two points that meet their stops
/// together have none either. Both count as untold, unless the point comes to rest after at most ten steps of flight.
///
/// A fixed step has its impact up to h late, so that an orbit jumps by h|v⁺ − v⁻| where its impact goes from one step
/// to the next. An orbit that is `placed` does not: after an impact its state becomes the one that an impact at t*
/// leads to,
///
///     q ← q + Δq + Δv τ + Δa τ²/2,  v ← v + Δv + Δa τ,      τ = t − t*
///     Δq = q⁻ − q⁺,  Δv = v⁻ − (1+e) r w⁻ − v⁺
///
/// with q⁺ and v⁺ of the marched orbit carried back to t*, and Δa the free acceleration of (Δq, Δv). Its impacts are
/// second-order accurate in h, and what it comes to depends on where it began without a jump of first order.
///
/// Points whose impact the step does not resolve (resolved_points(): the mass of one node of a beam) are not looked at.
/// They meet their stop like points without mass: the motion after it is the step's own, and so is its derivative.
/// Source: Müller (1995), Chaos, Solitons & Fractals 5, 1671–1681; saltation of Leine and Nijmeijer (2004), §7.
class ImpactJump final : public StepObserver {
 public:
  /// Whether the orbit itself is left as the steps make it, or placed too.
  enum class Orbit { as_marched, placed };

  /// Looks at rigid contact points whose mass is not zero and whose impacts the step resolves, and has the marcher hold
  /// the tangents there. Without tangents only orbits that are placed are looked at.
  explicit ImpactJump(Marcher& marcher, Orbit orbit = Orbit::as_marched);
  ~ImpactJump();

  /// Whether there is anything to do; otherwise the integration need not be observed.
  bool needed() const { return needed_; }
  /// Tangent columns were replaced (orthonormalised): their past is not theirs any more.
  void columns_replaced();
  /// Jumps put on lane's columns so far.
  int applied(int lane) const;
  /// Directions of the state that no longer depend on what was before. They are two for each of the most points that
  /// rested together, else one where an impact without rebound was met.
  int lost(int lane) const;
  /// Impacts and rests so far whose effect on the columns is not known.
  int untold(int lane) const;

  void stage_solved(const Marcher& marcher, const StageView& view) override;
  void step_done(Marcher& marcher) override;

 private:
  struct Past;
  struct Impact;
  struct Lane;
  void watch(const Marcher& marcher, Lane& lane, int index, int point, int side, double time);
  void finish(Marcher& marcher, Lane& lane, int index);
  void place(Marcher& marcher, Lane& lane, int index, double since) const;
  struct Moved;
  void put(const Marcher& marcher, const Moved& by, double since, LaneState& state) const;
  Eigen::VectorXd lost_speed(const Marcher& marcher, const Impact& impact, const Eigen::VectorXd& after) const;
  void hold(Marcher& marcher, Lane& lane, int index);

  bool needed_ = false, places_ = false;
  double offset_ = 0;                               // of velocity slots, in steps
  std::vector<std::optional<double>> restitution_;  // of each point
  std::vector<bool> massive_;
  std::vector<std::unique_ptr<Lane>> lanes_;
  struct Inverse;
  std::unique_ptr<Inverse> inverse_mass_;
};

/// For each contact point of the problem, whether it has inertia: no displacement in Ker M moves it.
std::vector<bool> points_with_mass(const SemiDiscrete& problem);

/// For each contact point, what a plan restitutes there to a free mass: by its gates with the stop's own e where it has
/// one. None where plan_restitution() knows none.
std::vector<std::optional<double>> point_restitutions(const Program& program);

/// For each contact point, whether it has inertia and a rigid law throws it back with a share `least` of its speed.
std::vector<bool> thrown_points(const Program& program, double least);

/// For each contact point, whether a step of h follows the motion that an impulse on it leaves. It does where
/// H (M + h²K)⁻¹ Hᵀ is within a hundredth of its limit H M⁻¹ Hᵀ for h → 0 (taken at h/1000). For an oscillator: hω ≤
/// 0.1.
std::vector<bool> resolved_points(const SemiDiscrete& problem, double h);

/// Whether rigid stops are met at whole steps. A gate then finds the point at its stop, and the velocity jumps by a
/// rule that knows no position. The step is linear between two orbits with the same gates. Their impacts do not move
/// with them as they do in the motion. Two orbits closer than a step's way stay together, or part at once where one
/// gate differs.
bool stops_met_at_steps(const Program& program);

/// Whether neither tangents nor a twin nearby say anything of the motion once there are impacts. Then stops are met at
/// steps, by a mass whose impacts ImpactJump does not look at.
bool tangents_miss_impacts(const Program& program);

/// Whether a twin says nothing of the motion once there are impacts: stops are met at steps by a mass. Where a program
/// has no tangents at all, nothing is left that does.
bool twins_miss_impacts(const Program& program);

}  // namespace ricochet
