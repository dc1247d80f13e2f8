#include "runners/kinds/continuation/first_orbit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <ricochet/contract/said_format.hpp>
#include <ricochet/measure/orbits/own_march.hpp>
#include <ricochet/measure/orbits/stepped_map.hpp>

#include "runners/kinds/kind.hpp"
#include "runners/kinds/stored_study.hpp"
#include "runners/kinds/sweep/orbit_rows.hpp"
#include "runners/store/atomic_file.hpp"
#include "runners/store/record_values.hpp"
#include "runners/store/store.hpp"

namespace ricochet {
namespace {

Eigen::VectorXd as_x(const PeriodicMap& map, const LaneState& state, int) {
  return map.vector().read(state);
}
Eigen::VectorXd as_x(const SteppedMap& map, const LaneState& state, int group) {
  return map.read(state, group);
}

// A point at which the last two contact sets differ; −1: not known.
int alternating_point(const PeriodicMap& map, const ShotOrbit& shot) {
  return shot.step < 0 ? -1 : map.sets().place(shot.row).point;
}
int alternating_point(const FollowedMap&, const ShotOrbit&) {
  return -1;
}

template <class Map>
OwnMarch own_march_of(Map& map, const Eigen::VectorXd& x, double parameter, const MapClock& clock) {
  return own_march(map, x, parameter, clock, 1);
}
// What is solved without steps is its own march.
OwnMarch own_march_of(ReferenceOrbits&, const Eigen::VectorXd&, double, const MapClock&) {
  return {};
}

template <class Map>
class OrbitSearch {
 public:
  OrbitSearch(Map& map, const OrbitStarts& starts, const WantedOrbit& orbit)
      : map_(map), starts_(starts), orbit_(orbit) {}

  FirstOrbit find() {
    FirstOrbit found;
    found.clock = clock(orbit_.symmetric == HalfMap::yes);
    if (found.clock.half && !starts_.no_image.empty()) throw Refusal{starts_.no_image};
    wait(found);
    if (!found.shot.found) throw Refusal{not_found(found.shot)};
    const int iterations = found.shot.iterations;
    if (!found.clock.half && may_be_image() && returns(found.shot.x, clock(true)) && use_half(found.shot.x, found))
      found.shot.iterations += iterations;
    if (const int sooner = repeats_after(found); sooner > 0)
      throw Refusal{said("the orbit found from {} at λ = {:g} repeats after {} period{}; expected period {}", from(),
                         orbit_.at, sooner, sooner == 1 ? "" : "s", orbit_.period)};
    check_march(found);
    return found;
  }

 private:
  // Whether the scheme's own march stays with the orbit for a period, in displacement and in velocity: to a millionth
  // of the gap, or to what the steps of its impacts explain. An impact is up to h late, some schemes take two steps of
  // it.
  void check_march(const FirstOrbit& found) {
    constexpr double late = 4;
    const OwnMarch own = own_march_of(map_, found.shot.x, orbit_.at, found.clock);
    const auto quiet = quiet_orbit(map_, found.shot.x, orbit_.at, found.clock);
    const Impacts impacts = impacts_of(map_.march(quiet.x, orbit_.at, quiet.clock));
    const double far = std::max(image_tolerance * starts_.gap, late * impacts.rebounds),
                 fast = far * std::max(map_.metric().pulsation(), impacts.pace);
    if (!own.end && own.displacement <= far && own.velocity <= fast) return;
    throw Refusal{
        said("no orbit at λ = {:g}: the scheme's own march leaves what was solved by {:.3g} m and {:.3g} "
             "m/s in a period; its impacts explain {:.3g} m and {:.3g} m/s{}",
             orbit_.at, own.displacement, own.velocity, far, fast, own.end ? "; " + text(own.end) : std::string())};
  }
  // What impacts that rebound make of a march; none do on pieces.
  struct Impacts {
    double rebounds = 0, placed = 0, pace = 0;  ///< FollowedMap::Image
  };
  static Impacts impacts_of(const MapMarch&) { return {}; }
  static Impacts impacts_of(const FollowedMap::Image& image) { return {image.rebounds, image.placed, image.pace}; }

  MapClock clock(bool half) const { return {starts_.steps_per_period, orbit_.period, half}; }

  ShotOrbit solve(const Eigen::VectorXd& x, const MapClock& clock) {
    return shoot(map_, x, orbit_.at, clock, starts_.tolerance(x, clock));
  }

  bool may_be_image() const {
    return orbit_.symmetric == HalfMap::automatic && starts_.no_image.empty() && orbit_.period % 2 != 0;
  }

  // Solves by half the period, where an orbit is found so.
  bool use_half(const Eigen::VectorXd& x, FirstOrbit& found) {
    ShotOrbit image = solve(x, clock(true));
    if (image.found) found = {std::move(image), clock(true), ""};
    return found.clock.half;
  }

  void wait(FirstOrbit& found) {
    std::vector<int> waits = {std::max(1, orbit_.periods)};
    if (orbit_.from == OrbitSource::rest || orbit_.from == OrbitSource::state)
      for (const int periods : {3, 10, 30, 100})
        if (periods < orbit_.periods) waits.push_back(periods);
    for (const int periods : waits) {
      const Eigen::VectorXd x = starts_.state(periods, found.clock);
      ShotOrbit shot = solve(x, found.clock);
      if (!shot.found && may_be_image() && use_half(x, found)) return;
      if (shot.found || periods == waits.front()) found.shot = std::move(shot);
      if (found.shot.found) return;
    }
  }

  // Whether the map brings an orbit back to itself: to a millionth of the gap, or to what placed impacts leave.
  bool returns(const Eigen::VectorXd& x, const MapClock& clock) const {
    const auto quiet = quiet_orbit(map_, x, orbit_.at, clock);
    const auto made = map_.march(quiet.x, orbit_.at, quiet.clock);
    return !made.end &&
           map_.metric().size(made.image - quiet.x) <= std::max(image_tolerance * starts_.gap, impacts_of(made).placed);
  }

  // The divisor of the period after which the orbit is back already; 0: none.
  int repeats_after(const FirstOrbit& found) const {
    MapClock clock = found.clock;
    for (clock.period = 1; clock.period < orbit_.period; ++clock.period)
      if (orbit_.period % clock.period == 0 && returns(found.shot.x, clock)) return clock.period;
    return 0;
  }

  const char* from() const {
    return orbit_.from == OrbitSource::state  ? "the scene's state"
           : orbit_.from == OrbitSource::free ? "the motion without contact"
           : orbit_.from == OrbitSource::rest ? "rest"
                                              : "the stored orbit";
  }

  std::string not_found(const ShotOrbit& shot) const {
    std::string why = fmt::format(
        "no orbit of period {} within {} iterations from {} at λ = {:g}; nearest return {:.3g} m "
        "after {} period{}",
        orbit_.period, shot.iterations, from(), orbit_.at, shot.nearest, orbit_.periods,
        orbit_.periods == 1 ? "" : "s");
    if (shot.end) why += "; " + text(shot.end);
    if (const int point = alternating_point(map_, shot); point >= 0)
      why += fmt::format("; residuals alternate between two contact sets (step {} of {}, point {})", shot.step + 1,
                         starts_.steps_per_period, point + 1);
    return why;
  }

  Map& map_;
  const OrbitStarts& starts_;
  const WantedOrbit& orbit_;
};

// The state at t = 0 of the forcing of an orbit that a bifurcation study keeps, marched on from where its kept periods
// began. `program` has one lane, at that value. Throws PointRefused where the study keeps no such orbit, or one of
// another mesh, step or operator.
LaneState stored_orbit(const WantedOrbit& orbit, Program program, int steps_per_period) {
  StudyResults results;
  try {
    results = read_store(orbit.study);
  } catch (const StoreError& error) {
    throw PointRefused(error.what());
  }
  if (results.kind != "bifurcation")
    throw PointRefused(fmt::format("{} holds a study of kind {}; expected bifurcation", orbit.study, results.kind));
  const CaseRecord& record = find_case(results, orbit.case_id);
  const auto entry = find_entry(record, orbit.parameter.value_or(orbit.at), orbit.start);
  if (!entry)
    throw PointRefused(fmt::format("the case {} of {} keeps no orbit from \"{}\" at {:g}", record.id, orbit.study,
                                   orbit.start, orbit.parameter.value_or(orbit.at)));
  const auto steps = axis(record, "steps_per_period").number();
  Marcher marcher(std::move(program));
  const LaneState like = marcher.lane_state(0);
  if (!steps || *steps != steps_per_period || record.operator_name != operator_name(marcher.program().kind) ||
      entry->slots.size() != like.slots.size() || entry->efforts.size() != like.efforts.size())
    throw PointRefused(
        fmt::format("the orbit of case {} has another step, mesh or operator; expected {} steps per "
                    "period and the operator {}",
                    record.id, steps_per_period, operator_name(marcher.program().kind)));
  const double turns = results.study.value("phase", 0.0) / (2 * std::numbers::pi);
  const auto strobe = std::llround((turns - std::floor(turns)) * steps_per_period) % steps_per_period;
  marcher.set_clock(strobe + 1);
  marcher.set_lane(0, LaneSpec(marcher.program().lanes[0]), *entry);
  marcher.march(steps_per_period - strobe - 1);
  return marcher.lane_state(0);
}

}  // namespace

template <class Map>
FirstOrbit first_orbit(Map& map, const OrbitStarts& starts, const WantedOrbit& orbit) try {
  return OrbitSearch<Map>(map, starts, orbit).find();
} catch (const Refusal& refusal) {
  return {{}, {}, refusal.sentence.text};
}

template <class Map>
FirstOrbit first_orbit(ContinuedMap& continued, Map& map, int steps_per_period, const WantedOrbit& orbit,
                       double& round_off) {
  std::string reason;
  const int scene = continued.scene_at(orbit.at, orbit.from == OrbitSource::state, reason);
  if (scene < 0) return {{}, {}, reason};
  const auto state = [&](int periods, const MapClock& clock) -> Eigen::VectorXd {
    if (orbit.from == OrbitSource::free) {
      if (const auto x = free_orbit(map, orbit.at, clock)) return *x;
      throw Refusal{"the motion without contact is in resonance"};
    }
    const int group = continued.scenes()[scene].group;
    if (orbit.from == OrbitSource::stored) try {
        return as_x(map, stored_orbit(orbit, continued.program(scene), steps_per_period), group);
      } catch (const PointRefused& refused) {
        throw Refusal{refused.what()};
      }
    LaneEnd end;
    if (const auto settled = settle(continued.program(scene), steps_per_period, periods, end))
      return as_x(map, *settled, group);
    throw Refusal{said("the transient stopped: {}", text(end))};
  };
  const auto tolerance = [&](const Eigen::VectorXd& x, const MapClock& clock) {
    round_off = std::max(round_off, round_off_of_map(map, x, orbit.at, clock));
    return round_offs * round_off;
  };
  return first_orbit(map, {steps_per_period, continued.gap(), continued.no_image(), state, tolerance}, orbit);
}

template FirstOrbit first_orbit(ReferenceOrbits&, const OrbitStarts&, const WantedOrbit&);
template FirstOrbit first_orbit(ContinuedMap&, PeriodicMap&, int, const WantedOrbit&, double&);
template FirstOrbit first_orbit(ContinuedMap&, SteppedMap&, int, const WantedOrbit&, double&);

}  // namespace ricochet
