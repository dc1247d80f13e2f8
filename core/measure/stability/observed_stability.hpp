#pragma once
#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <ricochet/contract/contact_law.hpp>
#include <ricochet/contract/worded.hpp>
#include <ricochet/measure/stability/stability.hpp>
#include <ricochet/scene/semi_discrete.hpp>
#include <string>
#include <variant>
#include <vector>

/// \file
/// Stability observed by marching: what the spectra of stability.hpp predict, and what they cannot see. The latter are
/// contacts that open and close, energy that a rigid impact makes, and laws that do not converge.
namespace ricochet {

/// What an integration of a horizon did.
enum class Behaviour {
  stable,
  linear_growth,  ///< amplitudes grow like the number of steps: a double root on the unit circle
  growing,        ///< amplitudes grow geometrically, or energy appears that nothing gave
  diverged,       ///< the lane was stopped
  failed          ///< the contact law did not converge
};
constexpr std::array<const char*, 5> words_of(Behaviour) {
  return {"stable", "marginal", "unstable", "diverged", "failed"};
}

/// Whether a march of any length stays within bounds that grow no faster than the number of its steps.
constexpr bool stays_bounded(Behaviour behaviour) {
  return behaviour == Behaviour::stable || behaviour == Behaviour::linear_growth;
}

struct ObservedCell {
  Behaviour behaviour = Behaviour::stable;
  long long steps = 0;            ///< made
  long long first_bad_step = -1;  ///< where it showed; −1: never
  double growth = 0;              ///< of amplitudes, per step, where they grow geometrically
  double gain = 0;                ///< largest energy that nothing gave, over all that was given
  long long impacts = 0;          ///< times that a contact point closed
  bool touched = false;           ///< whether one was closed at any step, from the start too
  /// Changes of the active set for each time that contact began anywhere; 2: it closes and opens.
  double changes_per_impact = 0;
  /// Share of the contact force's power above a quarter of the step frequency, the mean left out. It is taken over
  /// windows of 1024 steps that begin at an impact. A force that lasts one step has ½, one that alternates 1.
  double fast_share = 0;
  std::string cause;  ///< one sentence, "" when stable
  bool stable() const { return stays_bounded(behaviour); }
  /// The active set flickers: over 0.75 of the power is fast, or over 20 changes for each time that contact began.
  bool chatters() const { return fast_share > 0.75 || changes_per_impact > 20; }
};
using ObservedOrRefusal = std::variant<ObservedCell, Refusal>;

struct Horizon {
  long long steps = 3000;
  std::function<bool()> go_on;  ///< asked now and then; false ends the integration early
};

/// The structure alone, without loads, stops and support motion, from `start` (where empty: from the scene's own
/// state). Growth is read from the squared K- and M-norms of every slot, the largest in each third of the horizon. It
/// grows where the last has 4 times the first and 1.5 times the second. In 3000 steps a growth of 3.5e-4 per step
/// shows. An integration that the energy bound stops is made again without it. Energy that swells and falls again is no
/// limit: high modes do so at a step far beyond their period.
ObservedOrRefusal observe_free(const std::shared_ptr<const SemiDiscrete>& problem, const StepPlan& plan, double h,
                               const Excitation& start, const Horizon& horizon);

/// The scene itself, impacts and loads included. It grows where at some step the energy exceeds all that the initial
/// state and the loads gave by as much again. The energy is the scheme's own where it has one, plus that of the springs
/// of compliant laws. It also grows where the common energy is a thousand times that and grows on to the end, by thirds
/// as above. `law` makes one for each integration.
ObservedOrRefusal observe_scene(const std::shared_ptr<const SemiDiscrete>& problem, const StepPlan& plan, double h,
                                const std::function<std::unique_ptr<ContactLaw>()>& law, const Parameters& parameters,
                                const Horizon& horizon);

/// The step between the last stable of `steps` (increasing) and the first unstable one after it, to 1 %.
struct ObservedLimit {
  std::optional<double> step;
  double half = 0;           ///< s: the limit lies within step ± half
  bool below_range = false;  ///< the first step is unstable already
  bool returns = false;      ///< a larger step of the range is stable again
};

/// `known`: what was observed at each of `steps` (none: refused). Marches more cells for the bisection, and, where the
/// first step is unstable and `below` says so, for a search below it.
ObservedLimit observed_limit(const std::vector<double>& steps, const std::vector<std::optional<ObservedCell>>& known,
                             const std::function<std::optional<ObservedCell>(double h)>& observe, bool below = true);

/// Power of a real signal of 2^k samples above a quarter of the sampling frequency, over its power without the mean. 0
/// for a constant.
double fast_power_share(std::vector<double> signal);

}  // namespace ricochet
