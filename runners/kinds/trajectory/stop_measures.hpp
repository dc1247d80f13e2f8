#pragma once
#include <optional>
#include <ricochet/measure/contact/friction_watch.hpp>
#include <ricochet/measure/contact/impact_recorder.hpp>
#include <ricochet/measure/contact/stop_statistics.hpp>
#include <string>
#include <vector>

#include "runners/store/record.hpp"

/// \file
/// Measures of one stop that has a name: "impulse[bar-a]". They are measures like any other.
namespace ricochet {

/// Their names without the stop: impulse, impacts, peak_force, …
const std::vector<std::string>& measures_of_stops();

/// What such a measure means, or the confidence of one; null for any other name.
const MeasureInfo* stop_measure_info(const std::string& name);

/// What is known of one stop, or of one of its sides.
struct StopReading {
  StopTotals run;     ///< over the whole run
  double window = 0;  ///< s: how long what follows was looked at
  std::optional<RunningMoments> displacement;
  std::optional<PushTotals> pushed;
  std::optional<ShockTotals> shocks;
  std::optional<double> wear_power;  ///< W
  double rubbed_over = 0;            ///< s: how long friction was looked at
  std::optional<FrictionTotals> friction;
  bool friction_works = false;  ///< whether its heat and drift are known
};

/// Measures of a stop, and their confidences, that are sizes of a force while it acts. Of a point with mass that a
/// rigid law throws back they have no limit: the force is the impulse over the step.
std::vector<std::string> forces_while_they_act(const std::string& stop);

/// Adds the measures of a stop, those that are known.
void put_stop_measures(CaseRecord& record, const std::string& stop, const StopReading& reading);

/// Those of them that are columns of stops.csv beside its first ones: name, unit, text; and their cells.
std::vector<Column> stop_reading_columns(const StopReading& known);
Row stop_reading_cells(const StopReading& reading);
/// All of them.
std::vector<Column> all_stop_reading_columns();

/// Throws InputError where `observe` of a study names a stop that its scene has not. Also where it names a measure of a
/// stop that the study does not ask for.
void check_observed_stops(const nlohmann::ordered_json& study);
/// The same of one measure, at `pointer`.
void check_stop_measure(const nlohmann::ordered_json& study, const std::string& measure, const std::string& pointer);

/// Adds the levels of one spectrum as measures and as rows of third_octaves.csv.
void put_third_octaves(CaseRecord& record, Table& table, const std::string& of, bool force,
                       const std::vector<double>& density, double spacing);
/// That table without rows.
Table third_octaves_head();

}  // namespace ricochet
