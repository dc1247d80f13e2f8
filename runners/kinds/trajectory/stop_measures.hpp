#pragma once
#include <ricochet/measure/contact/impact_recorder.hpp>
#include <string>
#include <vector>

#include "runners/store/record.hpp"

/// \file
/// Measures of one stop that has a name: "impulse[bar-a]". They are measures like any other.
namespace ricochet {

/// Their names without the stop: impulse, impacts, peak_force, rms_force, contact_time.
const std::vector<std::string>& measures_of_stops();

/// What such a measure means; null for any other name.
const MeasureInfo* stop_measure_info(const std::string& name);

/// Adds those of a stop: the totals of both its sides.
void put_stop_measures(CaseRecord& record, const std::string& stop, const StopTotals& lower, const StopTotals& upper);

/// Throws InputError where `observe` of a study names a stop that its scene has not.
void check_observed_stops(const nlohmann::ordered_json& study);

}  // namespace ricochet
