#pragma once
#include <Eigen/Core>
#include <functional>
#include <memory>
#include <ricochet/contract/errors.hpp>
#include <string>
#include <variant>
#include <vector>

/// \file
/// A reference: the motion itself, found by another road than time stepping, with an estimate of how well it is known.
/// Everything that a study compares is a SampledMotion. What a scheme marched and what a reference knows are read at
/// the same times and places, and only then subtracted.
namespace ricochet {

/// Times (s, increasing, from 0) and places (m, inside ]0, L[, increasing; empty for an oscillator) where a motion is
/// looked at.
struct SampleGrid {
  std::vector<double> times, places;
  std::vector<double> weights;  ///< quadrature weights of the places (m): Σ w f(x) ≈ ∫f dx
};

/// The beginning or the end of contact on one side: a phase during which at least one point of that stop is touched.
/// Contact that is there at t = 0 has an end, but no beginning. Its points lie beyond their stop at the start, or on it
/// without moving into it.
struct ContactEvent {
  double time = 0;      ///< s
  int side = -1;        ///< −1 lower stop, +1 upper stop
  bool begins = true;   ///< impact, or release
  double velocity = 0;  ///< of the tip just before, absolute, m/s; 0 for a release
};

/// A motion read on a SampleGrid. Vectors over times have its size; fields are times × places, one time after another.
struct SampledMotion {
  std::vector<double> tip;           ///< absolute, m
  std::vector<double> tip_velocity;  ///< absolute, m/s
  std::vector<double> energy;   ///< ½∫ρS w_t² + ½∫EI w_xx² (+ potential of a compliant law), w = u − φ, J
  std::vector<double> impulse;  ///< ∫₀ᵗ Σp, signed (positive where the lower stop pushes), N s
  std::vector<double> displacement;  ///< u, absolute, m
  std::vector<double> strain;        ///< beam: w_xx, 1/m; bar: w_x
  std::vector<double> velocity;      ///< u_t, absolute, m/s
  std::vector<ContactEvent> events;  ///< in order of time
};

/// The semi-discrete problem that the methods march (see semi_discrete.hpp), dense, for references that are exact in
/// time on the same mesh.  M w'' + C w' + K w = F − φ'' s + Hᵀp,  lower − φ ≤ H w ≤ upper − φ.
struct DiscreteProblem {
  Eigen::MatrixXd mass, stiffness;     ///< n × n; mass may be singular
  Eigen::MatrixXd contact;             ///< H, m × n
  Eigen::VectorXd lower, upper;        ///< absolute, ±∞ where absent
  Eigen::VectorXd support_shape;       ///< s
  Eigen::VectorXd position, velocity;  ///< of w at t = 0
  Eigen::VectorXd load_constant;       ///< F where it does not depend on t
  Eigen::RowVectorXd tip;              ///< the tip's row
  Eigen::MatrixXd places, strains;     ///< rows that give w and its strain at the places of the grid
};

/// What a reference may read of the scene, in SI units.
struct ReferenceProblem {
  std::string structure;                         ///< "beam", "bar", "oscillator"
  double length = 0;                             ///< m; 0 for an oscillator
  double stiffness = 0;                          ///< beam EI (N m²), bar EA (N), oscillator k (N/m)
  double inertia = 0;                            ///< beam ρS, bar ρA (kg/m), oscillator m (kg)
  double damping_stiffness = 0;                  ///< α (s) of C = αK + ηM
  double damping_mass = 0;                       ///< η (1/s); an oscillator's c is ηm
  bool left_fixed = false, right_fixed = false;  ///< bar and beam: displacement imposed there
  /// A beam with supports, sections, masses, tension or a foundation of its own; else it is clamped and uniform.
  bool other_beam = false;
  double support_amplitude = 0, support_pulsation = 0, support_phase = 0;  ///< φ = A sin(ωt + ψ)
  double force_amplitude = 0, force_pulsation = 0, force_phase = 0;        ///< oscillator: F cos(ωt + ψ), N
  bool load_zero = true, load_constant = true;  ///< of the distributed load f(x,t) (N/m; oscillator: N)
  std::function<double(double x, double t)> load;
  std::function<double(double x)> displacement, velocity;  ///< absolute, at t = 0
  bool projected = false;                        ///< the initial state of the mesh is projected: not the formulas above
  bool stops_at_tip = false;                     ///< one point, the tip
  bool stops_at_nodes = false;                   ///< all nodes: the whole structure in the limit
  std::vector<double> stop_places;               ///< x of the contact points on this mesh, m; none: no stops
  std::function<double(double x)> lower, upper;  ///< absolute, m; ±∞ where absent
  bool contact_absent = false;                   ///< the contact law is none
  double contact_stiffness = 0;                  ///< N/m of a compliant linear law; 0: rigid
  bool contact_nonlinear = false;                ///< compliant, and no constant stiffness says how
  double restitution = 0;                        ///< e of the scheme, where it has one
  const DiscreteProblem* discrete = nullptr;     ///< for references of the semi-discrete problem, else null
};

/// What a reference found.
struct ReferenceMotion {
  SampledMotion motion;
  /// The same motion at a coarser setting of the reference itself (half the modes, a looser tolerance). The gap of the
  /// two is how well it is known. Empty vectors where the reference is a closed form.
  SampledMotion coarser;
  std::string how;                 ///< one sentence: what was computed, with which settings
  std::vector<std::string> notes;  ///< what a reader should know
};

using ReferenceOrRefusal = std::variant<ReferenceMotion, Refusal>;

/// The motion as a map: from a state x at t = 0 to that at a later time. State x is relative to the support, so that x
/// → −x goes with the opposite support. Not to be shared between threads.
class ReferenceMap {
 public:
  struct Image {
    Eigen::VectorXd state;
    Eigen::MatrixXd derivative;  ///< ∂state/∂x, size × size, impacts and releases included; empty where not asked for
    std::string stopped;         ///< why there is no state, one clause; "" where there is one
    int impacts = 0;             ///< on the way
  };
  virtual ~ReferenceMap() = default;
  virtual int size() const = 0;
  /// The initial state of the scene.
  virtual Eigen::VectorXd start() const = 0;
  /// Weights w: Σ (wᵢxᵢ)² is the mean square over x of the displacement, and of the velocity over ω; m².
  virtual Eigen::VectorXd weights() const = 0;
  /// Displacement and velocity of the tip at t = 0, absolute; m, m/s.
  virtual std::pair<double, double> tip(const Eigen::VectorXd& x) const = 0;
  /// The state `span` seconds later.
  virtual Image march(const Eigen::VectorXd& x, double span, bool derivative) = 0;
};
using ReferenceMapOrRefusal = std::variant<std::unique_ptr<ReferenceMap>, Refusal>;

/// A reference solver, a plugin of role `reference`.
class ReferenceSolver {
 public:
  virtual ~ReferenceSolver() = default;
  /// Whether it needs ReferenceProblem::discrete (then it is computed per mesh and mass, else once per scene).
  virtual bool of_the_mesh() const { return false; }
  /// The motion on the grid, or a sentence that says why this scene has no such reference.
  virtual ReferenceOrRefusal solve(const ReferenceProblem& problem, const SampleGrid& grid) const = 0;
  /// The motion as a map, or a sentence that says why this scene has none. The problem need not outlive it.
  virtual ReferenceMapOrRefusal map(const ReferenceProblem&) const {
    return Refusal{"it gives motions, and no map of states that orbits could be solved with"};
  }
};

}  // namespace ricochet
