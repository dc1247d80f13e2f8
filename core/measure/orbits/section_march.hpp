#pragma once
#include <cstdint>
#include <optional>
#include <ricochet/engine/compile.hpp>
#include <ricochet/engine/marcher.hpp>
#include <ricochet/measure/orbits/recurrence.hpp>
#include <ricochet/measure/orbits/regime.hpp>
#include <string>
#include <vector>

/// \file
/// Orbits of a periodically forced scene, read once per forcing period. Many march at a time, one per lane; each is
/// replaced by the next as it ends. The clock of the integration runs over one period and is turned back. So the
/// strobed map is autonomous: an orbit does not depend on how many periods were marched before, nor in which lane.
namespace ricochet {

/// Where the points of a section are taken.
enum class SectionKind {
  strobe,    ///< at one phase of the forcing
  impact,    ///< where a contact begins
  extremum,  ///< where the tip turns back
};

/// How long orbits are followed, and what is read of them.
struct SectionPlan {
  double pulsation = 0;      ///< ω of the forcing, rad/s
  int steps_per_period = 0;  ///< even, 8 or more; h = 2π/(ω · steps)
  int strobe = 0;            ///< step of the period at which the strobe stands, 0 … steps_per_period − 1
  int transient = 300;       ///< periods that are not kept, at least; each kept one is read at its end
  int at_most = 2000;        ///< and at most, while the orbit is not settled
  int keep = 300;            ///< periods that are kept
  SectionKind section = SectionKind::strobe;
  double tolerance = 1e-6;  ///< of settling, in units of `scale` (displacement) and ω·scale (velocity)
  double scale = 1;         ///< m

  /// What the readings of an orbit are measured in: displacement, velocity, and the same half a period before.
  std::vector<double> reading_scale() const { return {scale, pulsation * scale, scale, pulsation * scale}; }
};

/// Readings of the tip at a strobe, absolute: (x, v) there, and (−x, −v) half a period before. The latter belong to the
/// image of the orbit under x → −x, t → t + T/2. The velocity is the central difference over two steps.
struct SectionPoint {
  double displacement = 0, velocity = 0, opposite_displacement = 0, opposite_velocity = 0;
};

/// A contact that begins: ωt in [0, 2π), the side (0 lower, 1 upper), the speed at which the point closes (m/s). Then
/// the row of H that closes, of several at once the first. Last t (s) since the orbit's own beginning, counted from a
/// whole period of the forcing.
struct ImpactPoint {
  double phase = 0;
  std::int64_t side = 0;  ///< as wide as the others: no padding, the bytes of equal impacts are equal
  double speed = 0;
  std::int64_t point = 0;
  double time = 0;
};

/// A contact that has begun and may be over at once. Then it is an impact that rebounds, and its instant is one of the
/// step's. One that lasts is not.
struct BriefContact {
  std::int64_t point = -1;  ///< row of H; −1: none
  std::int64_t steps = 0;   ///< that it has lasted
  double before = 0;        ///< velocity of the point when it began, m/s
};
/// Most steps without effort after which a point that pushes the same stop again has not left it. A hop so short is the
/// scheme's, or a load vanishes for an instant.
constexpr int longest_loose = 3;
/// Steps that a contact without a duration of its own may last in a scheme.
constexpr int briefest_contact = 3;

/// An orbit, on its way or complete. Plain data: what is needed to go on is in it.
struct Orbit {
  enum class Stage { transient, keep, complete, stopped };
  int task = 0;  ///< which orbit it is, for its owner
  Stage stage = Stage::transient;
  int transient_periods = 0, kept_periods = 0;
  bool settled = false;
  LaneEnd end;            ///< of a stopped one
  std::string end_words;  ///< what ended its process, where that was the cause; else ""
  int stopped_period = 0;
  Settling settling;
  SectionSeries readings;             ///< per kept period: the strobed point without the sawtooth of single steps
  std::vector<SectionPoint> strobed;  ///< per kept period
  std::vector<SectionPoint> points;   ///< of the other sections; empty for a strobe
  std::vector<ImpactPoint> impacts;   ///< of the last 64 kept periods
  std::vector<int> impact_counts;     ///< per kept period; contact that is there when they begin is none
  long long contact_steps = 0;        ///< of the kept periods
  int most_on_a_side = 0;             ///< impacts on one side in one period, the most
  bool closed[2] = {false, false};
  /// Per row of H and side (2 row + side), the step at which the point last pushed its stop. Steps of the kept periods
  /// count from 1 on. Empty once one has arrived.
  std::vector<std::int64_t> pushed;
  bool arrived = false;  ///< a point came to its stop in the kept periods, after more than longest_loose steps
  bool rests = false;    ///< of a complete one: stops were touched all the time, and no point arrived at one
  /// Contacts of the kept periods that lasted, more than briefest_contact steps, of points with mass that a rigid law
  /// throws back with a share of their speed.
  long long lasting = 0;
  /// The largest sum of |v₊ − v₋| over one of the kept periods (m/s). It counts contacts of at most briefest_contact
  /// steps that leave with a tenth of their speed or more.
  /// A step h places their instants to within h, which moves what follows by up to h times this.
  double rebounds = 0;
  double rebounds_so_far = 0;  ///< in the present period
  BriefContact brief[2];       ///< per side
  /// Of a complete one of which only its end is left (keep_end): its class and period, without evidence.
  std::optional<RegimeVerdict> verdict;
  LaneSpec lane;
  LaneState entry;  ///< when the kept periods began, one step after a strobe
  LaneState now;    ///< the latest one
};

/// Why a stopped orbit stopped, in words.
std::string end_text(const Orbit& orbit);

/// A block of lanes that march orbits.
class SectionMarch {
 public:
  /// The lanes of the program are places; they are idle until load().
  SectionMarch(Program program, const SectionPlan& plan);
  ~SectionMarch();

  int places() const { return marcher_.lanes(); }
  bool idle(int place) const { return !orbits_[static_cast<std::size_t>(place)]; }
  /// Puts an orbit in an idle place; it goes on from orbit.now.
  void load(int place, Orbit orbit);
  /// Marches one forcing period. Orbits that completed or stopped are taken out and returned, with `now` their last
  /// state.
  std::vector<Orbit> period();
  /// Copies of the orbits on their way, `now` up to date.
  std::vector<Orbit> running() const;
  const Marcher& marcher() const { return marcher_; }

 private:
  class Watch;
  struct Reading {
    std::vector<double> before, at, after;  // tips per lane
  };
  void read_tips(std::vector<double>& tips) const;
  void march_to(int step, bool watched);
  /// Whether the transient is over; then the next period is kept.
  void end_transient(int place, Orbit& orbit) const;
  void complete(Orbit& orbit) const;
  void close_period(int place, Orbit& orbit, const SectionPoint& point, double smoothed);

  Marcher marcher_;
  SectionPlan plan_;
  std::vector<std::optional<Orbit>> orbits_;
  std::unique_ptr<Watch> watch_;
  Reading strobe_, opposite_;
};

/// What starts orbits: one period from t = 0 under the start rule of the scheme, up to one step after the strobe that
/// follows. `states` and `ends` per lane; there is no end where the lane still runs.
struct StartedOrbits {
  std::vector<LaneState> states;
  std::vector<LaneEnd> ends;
};
StartedOrbits start_orbits(Program program, const SectionPlan& plan);

/// Gives a lane a random initial state between the stops, the same for the same seed and number, relative to the clamp.
/// It is a sum of the three slowest modes of the free structure, shapes with a positive tip. Tip amplitudes are uniform
/// in [−1, 1] times the distance to the stops, times 1, ½, ¼ by mode; velocities are the same times ω_k. One factor
/// brings all back where a contact point would stand beyond 0.95 of its distance. Without stops the distance is the
/// support's amplitude, or 1 m.
void set_random_state(LaneSpec& lane, const SemiDiscrete& problem, std::uint64_t seed, int number);

}  // namespace ricochet
