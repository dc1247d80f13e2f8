#pragma once
#include <string>
#include <vector>

#include "runners/store/record.hpp"

/// \file
/// Levels of spectra in thirds of octaves, as measures: "third_octave_force_63Hz[bar-a]", "…_displacement_…[mid]".
namespace ricochet {

/// Their names without the stop or point, of all bands from 0.1 Hz to 20 kHz.
const std::vector<std::string>& octave_measures();

/// What such a measure means; null for any other name.
const MeasureInfo* octave_measure_info(const std::string& name);

/// Throws InputError at `pointer` where a study asks for no spectrum of that, or where its spectra have no such band.
/// `measure`, `of`: the name and what stands in its brackets. False for any other name.
bool check_observed_octave(const nlohmann::ordered_json& study, const std::string& measure, const std::string& of,
                           const std::string& pointer);

/// Adds the levels of one spectrum as measures and as rows of third_octaves.csv.
void put_third_octaves(CaseRecord& record, Table& table, const std::string& of, bool force,
                       const std::vector<double>& density, double spacing);
/// That table without rows.
Table third_octaves_head();

}  // namespace ricochet
