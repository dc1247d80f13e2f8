#pragma once
#include <complex>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <ricochet/contract/contact_law.hpp>
#include <ricochet/contract/step_plan.hpp>
#include <ricochet/measure/stability/step_map.hpp>
#include <ricochet/scene/semi_discrete.hpp>
#include <string>
#include <variant>
#include <vector>

/// \file
/// Stability predicted from the plan alone, before anything runs. It is the spectral radius of one step, with the
/// contact open and with points held closed on both sides.
namespace ricochet {

struct StructureModes;
class RootCollector;

/// Growth per step below which a step counts as stable. A double root is known to the square root of round-off only.
/// 10⁶ steps of such a growth are needed to see it.
constexpr double growth_tolerance = 1e-6;

/// What the contact law is while its set of closed points does not change.
struct LinearLaw {
  bool absent = false;                   ///< no contact at all
  std::optional<Evaluation> evaluation;  ///< of a compliant law; absent: rigid
  std::optional<double> stiffness;       ///< κ, N/m; a compliant law without has no linear step
  std::vector<double> own = {};          ///< κ of each point, N/m, where stops have their own; else empty
};
/// Prepares the law for `points` contact points and reads its linearisation. `stops`: what these have of their own.
LinearLaw linear_law(ContactLaw& law, int points, const Parameters& parameters,
                     const std::vector<StopParameters>& stops = {});

/// Points that are closed together.
struct ClosedSet {
  std::string name;  ///< "the tip", "x = 0.75 m", "all 20 points"
  std::vector<int> points;
};

/// Where a root lives: on motions without mass, on points that contact holds, or on a mode.
enum class RootPlace { kernel, held_points, mode };

/// A root of modulus one where the motion itself is damped, or has no inertia.
struct MarginalRoot {
  std::complex<double> value;
  RootPlace place = RootPlace::mode;
  std::string where;       ///< the same in words: "mode 40 of 40 (1.43e5 rad/s)"
  bool defective = false;  ///< what it multiplies grows linearly
  int count = 1;           ///< how many times
};
/// "root −1", "roots ±i", "roots of modulus 1 at ±104.5°".
std::string root_text(std::complex<double> root);

/// One step's spectrum with a contact set that stays.
struct StepSpectrum {
  std::string contact;          ///< "open", or the closed set
  double radius = 0;            ///< max |r|
  std::complex<double> root;    ///< the root of that modulus
  double pulsation = 0;         ///< rad/s, of the structure's mode that takes the largest part in it; 0: none does
  bool on_kernel = false;       ///< the motion has no mass: it lies in Ker M
  std::string mode;             ///< the same in words: "mode 40 of 40 (1.43e5 rad/s)", "the kernel of the mass"
  bool grows_linearly = false;  ///< a defective root on the unit circle
  std::vector<MarginalRoot> marginal_roots;
  /// The same in words, the first of them; "" when there is none.
  std::string marginal;
  bool stable() const { return radius <= 1 + growth_tolerance; }
};
using SpectrumOrRefusal = std::variant<StepSpectrum, Refusal>;

/// How much of a spectrum is wanted: the radius alone (of closed sets: of the first unstable one), or everything.
enum class Detail { radius, full };

/// A state in which every mode has the same energy (1 J), half of it elastic and half kinetic, and signs that do not
/// repeat. Ker M moves as q' = −q/α, or by half of itself in a step where that is slower; Ker K rests. Where the modes
/// are not known: displacements of about 1 m that do not repeat, at rest.
struct Excitation {
  Eigen::VectorXd position, velocity;
};

/// Spectra of the steps of any plan on one semi-discrete problem and one law.
///
/// Open: per mode of M φ = μ K φ, hence exact up to the modes' own accuracy, whatever the step. Closed and rigid: per
/// mode of the structure held at the points, and the scheme's recursion at the points. Closed and compliant: dense, in
/// the coordinates of the open modes. Only as many directions of Ker M as there are closed points feel the spring. The
/// others stay modes. A root r of modulus one is physical where the mode itself neither decays nor lacks inertia.
class StabilityPredictor {
 public:
  StabilityPredictor(std::shared_ptr<const SemiDiscrete> problem, LinearLaw law);
  ~StabilityPredictor();
  StabilityPredictor(StabilityPredictor&&) noexcept;

  /// Refused above 1200 dofs, where modes cost more than marching.
  SpectrumOrRefusal open(const StepPlan& plan, double h, Detail detail = Detail::full) const;
  /// Closed sets that are looked at: each point alone where there are at most 20 (else the tip and the middle one),
  /// and all together. Of a clearance each side alone (of many the first and the middle one), and a corner of two. The
  /// corner holds what all of them would. Empty without contact, above 160 dofs, and for laws without a constant
  /// stiffness: notes() say which.
  const std::vector<ClosedSet>& sets() const { return sets_; }
  SpectrumOrRefusal closed(const StepPlan& plan, double h, const ClosedSet& set, Detail detail = Detail::full) const;
  /// The set with the largest radius; of stable sets the first that has marginal roots.
  SpectrumOrRefusal worst_closed(const StepPlan& plan, double h, Detail detail = Detail::full) const;

  /// Of the free structure, or of the one held at the points of `set` (rigid).
  Excitation excitation(double h) const;
  Excitation excitation(const ClosedSet& set, double h) const;

  /// First pulsation of the structure, contact open (rad/s); 0 where not known.
  double first_pulsation() const;
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  void choose_sets();
  void choose_around(const std::vector<int>& points, const std::function<std::string(int)>& where);
  const StructureModes& held_at(const ClosedSet& set) const;
  Excitation excite(const StructureModes& modes, double h) const;
  std::optional<Refusal> add_modes(RootCollector& found, const StepPlan& plan, const StructureModes& modes,
                                   int first) const;
  SpectrumOrRefusal held(const StepPlan& plan, double h, const ClosedSet& set, Detail detail) const;
  SpectrumOrRefusal dense(const StepPlan& plan, double h, const ClosedSet& set, Detail detail) const;

  std::shared_ptr<const SemiDiscrete> problem_;
  LinearLaw law_;
  std::unique_ptr<StructureModes> modes_;
  mutable std::map<std::vector<int>, std::unique_ptr<StructureModes>> held_modes_;  // by points, once asked for
  std::vector<ClosedSet> sets_;
  std::vector<std::string> notes_;
};

/// The largest step up to which every smaller one is stable.
struct StepLimit {
  std::optional<double> step;          ///< s; none: every step of the range is stable, or none is
  std::optional<StepSpectrum> beyond;  ///< just above the limit: what sets it
  bool below_range = false;            ///< the limit (or the search for it) lies below the range
};

/// First crossing of the radius along `steps` (increasing), then bisection to a relative 1e-6. Where the first step is
/// unstable, the search goes on downwards over six decades. Refused steps count as unknown and are passed over.
StepLimit step_limit(const std::function<SpectrumOrRefusal(double h)>& spectrum, const std::vector<double>& steps);

}  // namespace ricochet
