#pragma once
#include <ricochet/measure/contact/contact_instants.hpp>
#include <ricochet/measure/contact/stop_places.hpp>
#include <ricochet/measure/statistics/running_moments.hpp>
#include <vector>

namespace ricochet {

/// What pushes a point at its stops in an interval of time.
struct PushTotals {
  double impulse = 0;       ///< Σ I, N s
  double squares = 0;       ///< Σ Ω F², N² s
  double contact_time = 0;  ///< Σ Ω, s
  double peak = 0;          ///< largest F, N
  long long impacts = 0;

  void add(const PushTotals& other);
  /// Over the time in contact, N; 0 where that is 0.
  double mean_pushed() const { return contact_time > 0 ? impulse / contact_time : 0; }
  double rms_pushed() const { return contact_time > 0 ? std::sqrt(squares / contact_time) : 0; }
  /// Over all of `time`, N.
  double mean(double time) const { return impulse / time; }
  double rms(double time) const { return std::sqrt(squares / time); }
};

/// Displacements and forces of every stop over the parts of a window. Displacements are those that the bounds are put
/// on (StopPlaces), at whole steps.
class StopStatistics final : public ContactListener {
 public:
  StopStatistics(const Marcher& marcher, const WindowParts& window);

  /// A step is over.
  void see(const Marcher& marcher);
  void instant(const ContactInstant& one) override;

  const WindowParts& window() const { return window_; }
  /// Whether the integration reached the end of a part: no whole step is left before it.
  bool complete(int part) const { return seen_ + (1 - 1e-6) * h_ >= window_.begin(part + 1); }
  const RunningMoments& displacement(int point, int part) const { return places_[at(point, part)]; }
  const PushTotals& pushed(int point, StopSide side, int part) const {
    return pushes_[2 * at(point, part) + static_cast<std::size_t>(side)];
  }
  /// Over the whole window.
  RunningMoments displacement(int point) const;
  PushTotals pushed(int point, StopSide side) const;

 private:
  std::size_t at(int point, int part) const {
    return static_cast<std::size_t>(part) * static_cast<std::size_t>(stops_.count()) + static_cast<std::size_t>(point);
  }

  WindowParts window_;
  double h_, seen_ = 0;
  StopPlaces stops_;
  std::vector<RunningMoments> places_;  // parts × stops
  std::vector<PushTotals> pushes_;      // parts × stops × sides
};

}  // namespace ricochet
