#pragma once
#include <optional>
#include <ricochet/engine/marcher.hpp>
#include <ricochet/measure/contact/stop_contacts.hpp>
#include <ricochet/measure/contact/stop_places.hpp>
#include <ricochet/measure/contact/stop_statistics.hpp>
#include <ricochet/measure/statistics/running_moments.hpp>
#include <ricochet/measure/statistics/spectra.hpp>
#include <string>
#include <vector>

#include "runners/study/fields.hpp"
#include "runners/study/study.hpp"
#include "runners/table/number_type.hpp"

/// \file
/// What `outputs` of a trajectory asks for beside the measures of each case, and what takes it as the case marches.
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

/// Throws InputError for spectra of what is not there and for a rate that the steps do not reach. Also for a segment
/// that the window does not hold, and for observed measures of stops that the study does not ask for.
void check_outputs(const Json& study);

AskedOutputs asked_outputs(const StudyCase& study_case);

/// A spectrum as one lane marches. Displacements are sampled at k/rate, straight between steps. A force is its impulse
/// over 1/rate divided by that, so that an impact of any shortness keeps its momentum; positive upwards.
class SpectrumTaker final : public ContactListener {
 public:
  SpectrumTaker(const Marcher& marcher, const AskedOutputs& asked, const AskedSpectrum& of);

  /// A step is over.
  void see(const Marcher& marcher);
  void instant(const ContactInstant& one) override;
  void finish(double time);

  bool reads_steps() const { return !of_.force; }
  const AskedSpectrum& of() const { return of_; }
  const WelchSpectrum& spectrum() const { return spectrum_; }

 private:
  void flush(double until);

  AskedSpectrum of_;
  WindowParts window_;
  double rate_;
  double place(const Marcher& marcher, const double* position, double t) const;

  StopPlaces stops_;
  RowReadings points_;
  int stop_ = -1, point_ = -1;  // one of both is read
  WelchSpectrum spectrum_;
  long long next_ = 0, last_;      // samples: the next one, and the last of the window
  double before_ = 0, value_ = 0;  // when the step before ended, and what was read there
  std::vector<double> bins_;       // impulses of the samples to come, N s
};

/// What `outputs`, and a window over stops that have names, ask of an integration. The recorder, whose contacts tell it
/// of instants, looks at a step before it. Every step of the window is shown to it where it reads displacements.
class OutputWatch final : public StepObserver {
 public:
  OutputWatch(const StudyCase& study_case, const Marcher& marcher, StopContacts& contacts);
  OutputWatch(const OutputWatch&) = delete;

  /// Whether it has anything to look at.
  bool any() const { return statistics_ || !spectra_.empty(); }
  void stage_solved(const Marcher&, const StageView&) override {}
  void step_done(Marcher& marcher) override;
  void interval(Marcher& marcher, const StepInterval& steps) override;
  void finish(const Marcher& marcher);

  const AskedOutputs& asked() const { return asked_; }
  const StopStatistics* statistics() const { return statistics_ ? &*statistics_ : nullptr; }
  const ShockRecorder* shocks() const { return shocks_ ? &*shocks_ : nullptr; }
  const std::vector<SpectrumTaker>& spectra() const { return spectra_; }

 private:
  void ask(const Marcher& marcher);

  AskedOutputs asked_;
  bool reads_steps_ = false;
  std::optional<StopStatistics> statistics_;
  std::optional<ShockRecorder> shocks_;
  std::vector<SpectrumTaker> spectra_;
};

/// Where a place is within its clearance, at equal fractions of the window, on whole steps.
class OrbitTaker final : public StepObserver {
 public:
  static constexpr int most_samples = 2000;  ///< of each clearance

  OrbitTaker(const Marcher& marcher, const WindowParts& window, long long steps);

  /// Whether there is any clearance.
  bool any() const { return !stops_.empty(); }
  void stage_solved(const Marcher&, const StageView&) override {}
  void step_done(Marcher& marcher) override;
  NumberTable finish() const;

 private:
  long long step_of(long long k) const { return from_ + (to_ - from_) * k / count_; }

  StopList list_;
  StopPlaces places_;
  std::vector<int> stops_;
  long long from_ = 0, to_ = 0, count_ = 1, next_ = 0;
  std::vector<double> t_, values_;  // of each sample u₁, u₂ of each clearance
};

/// Columns of `orbits`.
struct OrbitColumns {
  const Series *stop = nullptr, *t = nullptr, *first = nullptr, *second = nullptr, *radius = nullptr;
};
const NumberType<OrbitColumns>& orbits_type();

}  // namespace ricochet
