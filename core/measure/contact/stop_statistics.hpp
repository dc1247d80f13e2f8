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

/// When contact is a shock: the force is above `force_above` (N). What is apart by less than `rest` (s) is one shock.
struct ShockRule {
  double force_above = 0, rest = 0;
};

/// A point is pushed at a stop by more than the force of the rule, once or several times.
struct Shock {
  int point = 0;
  StopSide side = StopSide::lower;
  double begin = 0;     ///< of its first instant above that force, s
  double peak_at = 0;   ///< when the force is largest, s
  double peak = 0;      ///< largest F, N
  double impulse = 0;   ///< Σ I from its first to its last such instant, N s
  double duration = 0;  ///< from the first to the end of the last, s
  double pushed = 0;    ///< Σ Ω of these instants, s
  double speed_in = 0;  ///< towards the stop, when the point last closed before it, m/s
  int rebounds = 0;     ///< how often the force rose above that of the rule
  bool open_end = false;
};

/// Shocks of a point on one side, or on both, that begin in the window.
struct ShockTotals {
  long long shocks = 0, rebounds = 0;
  double lasted = 0, pushed = 0;  ///< s: Σ duration, Σ pushed
  RunningMoments peaks;           ///< N

  void add(const Shock& shock);
  void add(const ShockTotals& other);
};

/// Finds shocks in the instants that an ImpactRecorder tells of. Beyond `most` of them the list ends, totals and peaks
/// go on.
class ShockRecorder final : public ContactListener {
 public:
  static constexpr std::size_t most_shocks = 100000;

  /// `window`: what totals are of, s.
  ShockRecorder(int points, const ShockRule& rule, const WindowParts& window, std::size_t most = most_shocks);

  void instant(const ContactInstant& one) override;
  /// To be called once, when the integration is over: shocks that are under way end. A step is h long.
  void finish(double time, double h);

  /// In the order in which they end; of equal ends in that of points.
  const std::vector<Shock>& shocks() const { return shocks_; }
  long long count() const { return count_; }
  const ShockTotals& totals(int point, StopSide side) const { return sides_[place(point, side)].totals; }
  /// The same of those that begin in one part of the window.
  const ShockTotals& totals(int point, StopSide side, int part) const {
    return sides_[place(point, side)].parts[static_cast<std::size_t>(part)];
  }
  /// Largest forces of the shocks that totals are of, both sides, N.
  const CountedValues& peaks(int point) const { return peaks_[static_cast<std::size_t>(point)]; }

 private:
  struct Side {
    Shock now;
    bool going = false;  // a shock is under way, or may go on
    bool above = false;  // whether the last instant was
    double last = 0;     // end of the last instant above the force
    double below = 0;    // Σ I of instants below it since
    ShockTotals totals;
    std::vector<ShockTotals> parts;
  };
  static std::size_t place(int point, StopSide side) {
    return 2 * static_cast<std::size_t>(point) + static_cast<std::size_t>(side);
  }
  void close(Side& side, bool open_end);

  ShockRule rule_;
  WindowParts window_;
  std::size_t most_;
  std::vector<Side> sides_;
  std::vector<CountedValues> peaks_;  // of each point
  std::vector<Shock> shocks_;
  long long count_ = 0;
};

}  // namespace ricochet
