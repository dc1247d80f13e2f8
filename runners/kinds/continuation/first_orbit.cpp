#include "runners/kinds/continuation/first_orbit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "runners/kinds/continuation/stored_orbit.hpp"
#include "runners/kinds/kind.hpp"

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
int alternating_point(const SteppedMap&, const ShotOrbit&) {
  return -1;
}

template <class Map>
class OrbitSearch {
 public:
  OrbitSearch(ContinuedMap& continued, Map& map, int steps, const WantedOrbit& orbit, double& round_off)
      : continued_(continued), map_(map), steps_(steps), orbit_(orbit), round_off_(round_off) {}

  FirstOrbit find() {
    FirstOrbit found;
    found.clock = {steps_, orbit_.period, orbit_.symmetric == HalfMap::yes};
    std::string reason;
    const int scene = continued_.scene_at(orbit_.at, orbit_.from == OrbitSource::state, reason);
    if (scene >= 0) group_ = continued_.scenes()[scene].group;
    if (scene < 0) {
      found.why = reason;
    } else if (orbit_.from == OrbitSource::free) {
      if (const auto x = free_orbit(map_, orbit_.at, found.clock)) found.shot = solve(*x, found.clock);
    } else if (orbit_.from == OrbitSource::stored) {
      try {
        const LaneState state = stored_orbit(orbit_, continued_.program(scene), steps_);
        found.shot = solve(as_x(map_, state, group_), found.clock);
      } catch (const PointRefused& refused) {
        found.why = refused.what();
      }
    } else {
      wait(scene, found);
    }
    if (!found.why.empty()) return found;
    if (found.shot.found && !found.clock.half) use_image(found);
    if (const int sooner = found.shot.found ? repeats_after(found) : 0; sooner > 0)
      found.why = fmt::format("the orbit found from {} at λ = {:g} repeats after {} period{}; expected period {}",
                              from(), orbit_.at, sooner, sooner == 1 ? "" : "s", orbit_.period);
    if (!found.shot.found) found.why = not_found(found.shot);
    // Where impacts are placed so badly every motion is near to an orbit.
    constexpr double largest_rebounds = 0.01;  // of the gap
    const double placed = found.why.empty() ? rebounds_of(map_.march(found.shot.x, orbit_.at, found.clock)) : 0;
    if (placed > largest_rebounds * continued_.gap())
      found.why = fmt::format(
          "impacts that rebound are placed to {:.3g} m alone at λ = {:g}, more than a hundredth of the gap: give more "
          "steps per period",
          placed, orbit_.at);
    return found;
  }

 private:
  ShotOrbit solve(const Eigen::VectorXd& x, const MapClock& clock) {
    round_off_ = std::max(round_off_, round_off_of_map(map_, x, orbit_.at, clock));
    return shoot(map_, x, orbit_.at, clock, round_offs * round_off_);
  }

  bool may_be_image() const {
    return orbit_.symmetric == HalfMap::automatic && continued_.no_image().empty() && orbit_.period % 2 != 0;
  }

  void wait(int scene, FirstOrbit& found) {
    std::vector<int> waits = {std::max(1, orbit_.periods)};
    for (const int periods : {3, 10, 30, 100})
      if (periods < orbit_.periods) waits.push_back(periods);
    for (const int periods : waits) {
      LaneEnd end;
      const auto state = settle(continued_.program(scene), steps_, periods, end);
      if (!state) {
        found.why = fmt::format("the transient stopped: {}", text(end));
        return;
      }
      const Eigen::VectorXd x = as_x(map_, *state, group_);
      ShotOrbit shot = solve(x, found.clock);
      if (!shot.found && may_be_image()) {
        MapClock half = found.clock;
        half.half = true;
        if (ShotOrbit image = solve(x, half); image.found) {
          shot = std::move(image);
          found.clock = half;
        }
      }
      if (shot.found || periods == waits.front()) found.shot = std::move(shot);
      if (found.shot.found) return;
    }
  }

  void use_image(FirstOrbit& found) {
    if (!may_be_image()) return;
    MapClock half = found.clock;
    half.half = true;
    if (!returns(found.shot.x, half)) return;
    ShotOrbit image = solve(found.shot.x, half);
    if (!image.found) return;
    image.iterations += found.shot.iterations;
    found.shot = std::move(image);
    found.clock = half;
  }

  // Whether the map brings an orbit back to itself: to a millionth of the gap, or to what its impacts are placed to.
  bool returns(const Eigen::VectorXd& x, const MapClock& clock) const {
    const auto made = map_.march(x, orbit_.at, clock);
    return !made.end &&
           map_.metric().size(made.image - x) <= std::max(image_tolerance * continued_.gap(), rebounds_of(made));
  }
  static double rebounds_of(const MapMarch&) { return 0; }
  static double rebounds_of(const SteppedMap::Image& image) { return image.rebounds; }

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
    if (orbit_.from == OrbitSource::free && shot.x.size() == 0) return "the motion without contact is in resonance";
    std::string why = fmt::format(
        "no orbit of period {} within {} iterations from {} at λ = {:g}; nearest return {:.3g} m "
        "after {} period{}",
        orbit_.period, shot.iterations, from(), orbit_.at, shot.nearest, orbit_.periods,
        orbit_.periods == 1 ? "" : "s");
    if (shot.end) why += "; " + text(shot.end);
    if (const int point = alternating_point(map_, shot); point >= 0)
      why += fmt::format("; residuals alternate between two contact sets (step {} of {}, point {})", shot.step + 1,
                         steps_, point + 1);
    return why;
  }

  ContinuedMap& continued_;
  Map& map_;
  int steps_, group_ = 0;
  const WantedOrbit& orbit_;
  double& round_off_;
};

}  // namespace

template <class Map>
FirstOrbit first_orbit(ContinuedMap& continued, Map& map, int steps_per_period, const WantedOrbit& orbit,
                       double& round_off) {
  return OrbitSearch<Map>(continued, map, steps_per_period, orbit, round_off).find();
}

template FirstOrbit first_orbit(ContinuedMap&, PeriodicMap&, int, const WantedOrbit&, double&);
template FirstOrbit first_orbit(ContinuedMap&, SteppedMap&, int, const WantedOrbit&, double&);

}  // namespace ricochet
