#pragma once
#include <map>
#include <optional>
#include <ricochet/measure/statistics/refinement.hpp>
#include <string>
#include <utility>
#include <vector>

#include "runners/answers/numbers_in_words.hpp"
#include "runners/report/choices.hpp"

namespace ricochet::answers {

/// Differences below this share of a measure's scale are said not to matter: T.
inline constexpr double tolerance = 0.01;

/// A case with its value over the scale of its measure.
struct Valued {
  const CaseRecord* record = nullptr;
  double value = 0;
};

/// One method, what it gave at each step and mesh, and what that comes to.
struct Method {
  Cases cases;                             ///< all, whatever became of them
  std::vector<Valued> done;                ///< those with a value
  const CaseRecord* finest = nullptr;      ///< finest mesh, then finest step, with a value
  std::optional<Limit> step, mesh, limit;  ///< along each refinement at the finest of the other; over both
  double half = 0;                         ///< half the interval of the finest value itself, or of its mean
  bool gains = false;                      ///< of a measure of energy: whether it makes energy
  /// By step and elements (1 where there is none). Of random loads the mean over their seeds.
  std::map<std::pair<double, double>, double> grid;

  const CaseRecord& first() const { return *cases.front(); }
  std::optional<double> at(double h, double elements) const;
};

/// What ends above this many times the energy that the motion could have gains.
inline constexpr double gains_above = 1.02;

/// The limits of all methods in one measure.
struct MeasureLimits {
  MeasureWords words;
  std::vector<Method> methods;  ///< in the study's order
  std::vector<const Method*> with_limit() const;
  /// Those of with_limit() that do not gain: a difference of one that does says how far it grew.
  std::vector<const Method*> without_gain() const;
};

/// Energy at the end over the most that there can be: the measure itself, or what is left in the case of a measure that
/// is a share of the energy brought in. Nothing of other measures.
std::optional<double> energy_kept(const MeasureWords& words, const CaseRecord& record);

/// A measure over its scale where that belongs to the case: a share of 1 or of the energy that was brought in.
std::optional<double> scaled_value(const MeasureWords& words, const CaseRecord& record);

/// Whether the finest of these cases says that no step approaches the measure: what coarser ones have is no limit then.
bool without_limit(const Choices& study, const Cases& cases, const std::string& measure);

/// What no value of it exceeds: `most`, and 1 of a share of the energy that was brought in. Of what has a scale, as the
/// tip at the end has the largest tip, what does not exceed that of any of these cases does not grow without bound.
std::optional<double> bound_of(const MeasureWords& words, bool share, const Cases& cases);

/// Of the cases given, all of one study; seeds are draws of one method. `conservative`: the truth of the measure and
/// its direction hold.
MeasureLimits limits_of(const Choices& study, const std::string& measure, bool conservative, const Cases& cases);

/// Whether loads in time, supports or stops in motion worked in a case: steady loads have a potential.
bool is_driven(const CaseRecord& record);

/// How the values of these cases err: saw-toothed where a rigid law throws points back, where friction changes between
/// stick and slip, or where the number of impacts changes with the step.
Errors errors_of(const Cases& cases);

/// Whether a column is none of methods, steps and meshes. Seeds and ways to march are among those that are.
bool is_of_scene(const std::string& column);

/// Whether nothing but contact and the method changes energies: no case is driven or damped.
bool keeps_energy(const StudyResults& results);
/// The same of some of its cases.
bool keeps_energy(const StudyResults& results, const Cases& cases);

/// The tier of each method that has a limit, 1 the best, or the least where no direction is better; 0 of those that
/// grow, gain energy or belong to none. None of methods in several scenes, and of more than 120.
std::vector<std::size_t> tier_places(const Choices& study, const MeasureLimits& limits);

/// What differences are shares of, one number for all methods that are compared. It is 1 where the measure is a share
/// (of 1, or of the energy brought in). Else it is the largest magnitude of the scale measure, or, without one, of the
/// values themselves. 0 where nothing differs from zero.
double scale_of(const MeasureWords& words, const std::vector<const Method*>& methods);

/// The difference of two methods as it goes with the refinement: what moves both alike cancels.
struct Difference {
  const Method *high = nullptr, *low = nullptr;
  double value = 0;                   ///< ≥ 0, at the finest step and mesh that both have
  std::optional<double> uncertainty;  ///< nothing at a single step and mesh
};
/// Of the two methods that are farthest apart by their limits.
Difference farthest(const std::vector<const Method*>& methods);
Difference paired(const Method& high, const Method& low);

/// Whether a difference matters: |D| − u > T; does not: |D| + u ≤ T; is open, without u too.
enum class Matters { yes, no, open };
constexpr std::array<const char*, 3> words_of(Matters) {
  return {"matters", "does not matter", "open"};
}

/// One choice in one combination of all others.
struct ChoiceRow {
  const CaseRecord* combination = nullptr;  ///< a case of it
  std::size_t levels = 0;
  double difference = 0;                   ///< over the scale
  std::optional<double> uncertainty = {};  ///< over the scale
  std::string most = {}, least = {};       ///< levels at the ends
  Matters matters() const;
};

/// One choice over all combinations.
struct ChoiceEffect {
  std::string choice;
  std::vector<ChoiceRow> rows;
};

/// What these columns of a choice move, over all combinations of the others. What gains energy is left out; the scale
/// is one for all methods of a scene.
ChoiceEffect choice_effect(const Choices& study, const MeasureLimits& limits, const std::string& choice,
                           const std::vector<std::string>& own);
/// Every choice that varies, in the study's order, with those asked for by one of their columns first.
std::vector<ChoiceEffect> choice_effects(const Choices& study, const MeasureLimits& limits);

}  // namespace ricochet::answers
