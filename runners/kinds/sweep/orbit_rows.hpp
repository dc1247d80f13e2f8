#pragma once
#include <algorithm>
#include <optional>
#include <ricochet/measure/orbits/judge_orbit.hpp>
#include <ricochet/measure/stability/equivalent_viscosity.hpp>
#include <ricochet/measure/stability/linear_response.hpp>
#include <string>
#include <utility>
#include <vector>

#include "runners/kinds/sweep/orbit_exponents.hpp"
#include "runners/kinds/sweep/sweep_tables.hpp"
#include "runners/store/record.hpp"

namespace ricochet {

/// One row of values.csv in the making.
struct OrbitView {
  double value = 0;       ///< of the parameter
  std::size_t start = 0;  ///< which of the case's starts
  std::string refusal;    ///< why there is no orbit
  const Orbit* orbit = nullptr;
  int scene = -1, group = -1;
  const SemiDiscrete* problem = nullptr;  ///< of that group
  std::string marginal;                   ///< what the stability analysis says of roots that are the scheme's
  std::optional<EquivalentViscosity> viscosity;
  OrbitExponents exponents;
  JudgedOrbit judged;
  bool complete() const { return orbit && orbit->stage == Orbit::Stage::complete; }
};

/// What the section's settings say, for the scenes of a case. The unit of displacements is half the gap between the
/// stops (the distance to the one there is; the amplitude without any).
SectionPlan section_plan(const StudyCase& study_case, const ForcedScenes& scenes);

/// α_eq of the scheme on the undamped structure of a group.
std::optional<EquivalentViscosity> numerical_viscosity(const ForcedScenes& scenes, int group,
                                                       const StudyCase& study_case, const Registry& registry);

/// Classifies an orbit, where it is complete, from its readings and exponents.
void judge(OrbitView& view, const SectionPlan& plan);

/// Status (done, refused, diverged, failed) and reason of a value, as of a case.
std::pair<Status, std::string> status_of(const OrbitView& view);
std::pair<Status, std::string> status_of(const Orbit& orbit);

/// Neighbours in a row of motions that are of different classes, those that are not known passed over.
std::vector<std::pair<std::size_t, std::size_t>> class_changes(const std::vector<std::optional<MotionClass>>& row);

/// Tables `values` and `bifurcations`, numbers `points` and `impacts`. Views are sorted by start, then by value.
void add_orbit_tables(CaseRecord& record, const std::vector<OrbitView>& views, const std::vector<std::string>& starts,
                      int exponents, const SectionPlan& plan);

/// Measures of the case as a whole: shares of regimes, impacts per period, the largest exponent.
void add_shares(CaseRecord& record, const std::vector<OrbitView>& views);

/// One more row of `bifurcations`: where the motion without contact grazes a stop.
void add_grazing_row(CaseRecord& record, const Grazing& grazing);

/// The most numbers that the entries of one case may take; beyond, none are kept.
constexpr std::size_t most_entry_numbers = 2000000;

/// Numbers `entries` (not exported): parameter, start, index, value. They are the state of each complete orbit when its
/// kept periods began; "ricochet point" marches these again. A state begins with three counts: of slots, efforts and
/// fastest speeds. Their values follow one after the other, then what the law remembers (see LaneState). Absent, with a
/// note, where they would take too much room.
void add_entries(CaseRecord& record, const std::vector<OrbitView>& views, const std::vector<std::string>& starts);

/// A column of a table of numbers in the rows of one orbit; empty where the case keeps none.
template <class Columns>
std::vector<double> orbit_numbers(const CaseRecord& record, const NumberType<Columns>& type,
                                  const Series* Columns::*column, double parameter, const std::string& start) {
  std::vector<double> found;
  const NumberTable* table = type.find(record.numbers);
  const auto* starts = table ? table->words_of(start_name) : nullptr;
  const Columns of = table ? type.read(*table) : Columns();
  if (!starts || !of.parameter || !of.start || !(of.*column)) return found;
  const auto index = static_cast<double>(std::find(starts->begin(), starts->end(), start) - starts->begin());
  const std::vector<double>&parameters = of.parameter->get(), &froms = of.start->get(), &values = (of.*column)->get();
  for (std::size_t row = 0; row < table->rows(); ++row)
    if (parameters[row] == parameter && froms[row] == index) found.push_back(values[row]);
  return found;
}

/// The entry of one orbit of a stored case; none where the case keeps none. Throws std::runtime_error for numbers that
/// add_entries() did not write.
std::optional<LaneState> find_entry(const CaseRecord& record, double parameter, const std::string& start);

/// Numbers `portraits`: a few periods of the tip of each complete orbit, marched again from where its kept periods
/// began. Absent, with a note, where there are more orbits than a report can hold.
void add_portraits(CaseRecord& record, const ForcedScenes& scenes, const std::vector<OrbitView>& views,
                   const SectionPlan& plan);

}  // namespace ricochet
