#pragma once
#include <optional>
#include <ricochet/measure/contact/stop_statistics.hpp>
#include <ricochet/measure/statistics/running_moments.hpp>
#include <string>
#include <vector>

#include "runners/study/fields.hpp"
#include "runners/study/study.hpp"

/// \file
/// What `outputs` of a trajectory asks for beside the measures of each case.
namespace ricochet {

struct AskedSpectrum {
  std::string of;      ///< a stop or a point
  bool force = false;  ///< of the force there, else of the displacement
};

struct AskedOutputs {
  bool any = false;
  WindowParts window;     ///< that of the study, else the whole run
  bool windowed = false;  ///< whether the study gives one
  std::optional<ShockRule> shocks;
  int classes = 10;  ///< of histograms of shocks
  std::vector<AskedSpectrum> spectra;
  double rate = 0, segment = 0;  ///< Hz, s
  int segment_samples() const;
};

/// The key itself.
Field outputs_key();

/// Throws InputError for spectra of what is not there, a rate that the steps do not reach, a segment that the window
/// does not hold, and observed measures of stops that the study does not ask for.
void check_outputs(const Json& study);

AskedOutputs asked_outputs(const StudyCase& study_case);

}  // namespace ricochet
