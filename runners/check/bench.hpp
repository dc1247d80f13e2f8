#pragma once
#include <functional>
#include <memory>
#include <ricochet/contract/mass_strategy.hpp>
#include <ricochet/contract/reference.hpp>
#include <ricochet/contract/step_plan.hpp>
#include <ricochet/engine/marcher.hpp>
#include <ricochet/scene/semi_discrete.hpp>
#include <string>
#include <vector>

#include "runners/check/checks.hpp"

/// \file
/// What plugins are checked on: masses, laws and scenes of the checks themselves. A method never answers for the faults
/// of another.
namespace ricochet::checking {

using Scheme = Subject<TimeScheme>;
using ProblemPointer = std::shared_ptr<const SemiDiscrete>;

/// Masses: the consistent one; a bar's lumped one whose free ends carry nothing.
std::unique_ptr<MassStrategy> consistent_bench_mass();
std::unique_ptr<MassStrategy> massless_ends();

/// Rigid stops.
std::unique_ptr<ContactLaw> rigid_stops();
/// p = κ(lower − g)₊ − κ(g − upper)₊.
std::unique_ptr<ContactLaw> springs(Evaluation evaluation, double stiffness);
/// p = κ(lower − g) − ηu, whatever the sign: a spring and a dashpot that never let go, for one point. `conserving`:
/// κ acts on the mean of g and g⁻, which is the discrete gradient of its energy.
std::unique_ptr<ContactLaw> glued_spring(Evaluation evaluation, double stiffness, double damping);
std::unique_ptr<ContactLaw> no_contact();

/// One mass of 2 kg on 8 N/m (2 rad/s). The checks use it free, damped (0.4 N s/m), loaded 3 cos(1.3 t + 0.4) N, or on
/// a support 0.2 sin(1.7 t + 0.3) m.
struct OscillatorBench {
  double mass = 2, stiffness = 8, damping = 0, force = 0, support = 0;
  double position = 0, velocity = 0;  ///< absolute, m and m/s
  bool stop = false;                  ///< a lower stop at 0
};
SceneSpec oscillator_scene(const OscillatorBench& bench);

/// A bar (L = EA = ρA = 1, fixed at its far end) and a cantilever (L = EI = ρS = 1), thrown at stops.
struct StructureBench {
  bool beam = false;
  double damping = 0;       ///< α, s
  bool load = false;        ///< moving with x and t
  bool support = false;     ///< the clamp of the beam, or the bar's end, moves
  bool stops = false;       ///< both sides of the tip
  bool everywhere = false;  ///< at all nodes
};
SceneSpec structure_scene(const StructureBench& bench);

/// Throws what discretise() throws, and Refused.
ProblemPointer discretised(const SceneSpec& scene, int elements, const MassStrategy& mass, ContactLaw* law = nullptr);
/// The consistent mass, and as many elements as the structure allows of `elements`.
ProblemPointer discretised(const SceneSpec& scene, int elements = 4);

/// Largest and smallest pulsation of the structure, rad/s.
struct Pulsations {
  double least = 0, most = 0;
};
Pulsations pulsations(const SemiDiscrete& problem);
/// A step of `share` of the slowest period, or less where the scheme is not stable there.
double sound_step(const Scheme& scheme, const SemiDiscrete& problem, double share);

/// The plan of the scheme; throws Refused where it refuses, after looking at how.
StepPlan plan_of(const Scheme& scheme, double h, const ProblemFacts& facts);
PlanOrRefusal ask_plan(const Scheme& scheme, double h, const ProblemFacts& facts);

/// A marcher of the plan; `lanes` empty: the scene's own. Throws std::runtime_error where it does not compile.
Marcher marcher_of(const ProblemPointer& problem, StepPlan plan, double h, std::unique_ptr<ContactLaw> law,
                   std::vector<LaneSpec> lanes = {}, OperatorKind kind = OperatorKind::band);
/// The same from the scheme.
Marcher marcher_of(const Scheme& scheme, const ProblemPointer& problem, double h, std::unique_ptr<ContactLaw> law,
                   std::vector<LaneSpec> lanes = {}, OperatorKind kind = OperatorKind::band);

/// e of the method: the value of the parameter that restitutes, or 0.
double declared_restitution(const Scheme& scheme);

/// m w'' + c w' + k w = constant + Σ (a cos ωt + b sin ωt), in closed form, for c² < 4mk.
class HarmonicMotion {
 public:
  struct Term {
    double cosine = 0, sine = 0, pulsation = 0;
  };
  /// From w and w' at time `start`.
  HarmonicMotion(double m, double c, double k, double constant, std::vector<Term> terms, double w, double v,
                 double start = 0);
  double displacement(double t) const;
  double velocity(double t) const;

 private:
  double decay_, ringing_, rest_, start_;
  std::vector<Term> response_;
  double along_ = 0, across_ = 0;  // of the free part
};

/// The slope of log error over log h through the last three pairs, and whether errors are round-off already.
struct MeasuredOrder {
  double order = 0;
  double finest = 0;  ///< error at the smallest step
  bool exact = false;
};
/// `scale`: of the motion; errors below 1e-11 of it are no longer told from round-off.
MeasuredOrder measured_order(const std::vector<double>& steps, const std::vector<double>& errors, double scale);

using Reference = Subject<ReferenceSolver>;

/// A scene that a reference is asked about, with the matrices of a mesh for those that need them.
struct ReferenceScene {
  std::string name;
  ReferenceProblem problem;
  SampleGrid grid;
  double tip = 0;                       ///< where it is, m
  std::function<double(double)> exact;  ///< its displacement where a closed form is known here, else empty
  std::shared_ptr<const DiscreteProblem> discrete;
};

/// A free oscillator, a forced one, a bouncing one, a bar on its stop, a cantilever against a stop.
std::vector<ReferenceScene> reference_scenes();

}  // namespace ricochet::checking
