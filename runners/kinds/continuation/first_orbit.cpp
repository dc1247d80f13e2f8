#include "runners/kinds/continuation/first_orbit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "runners/kinds/continuation/stored_orbit.hpp"
#include "runners/kinds/kind.hpp"

namespace ricochet {
namespace {

// Of the gap: an orbit this near to its own image is solved as one.
constexpr double image_tolerance = 1e-6;

class OrbitSearch {
 public:
  OrbitSearch(ContinuedMap& continued, PeriodicMap& map, int steps, const WantedOrbit& orbit, double& round_off)
      : continued_(continued), map_(map), steps_(steps), orbit_(orbit), round_off_(round_off) {}

  FirstOrbit find() {
    FirstOrbit found;
    found.clock = {steps_, orbit_.period, orbit_.symmetric == HalfMap::yes};
    std::string reason;
    const int scene = continued_.scene_at(orbit_.at, orbit_.from == OrbitSource::state, reason);
    if (scene < 0) {
      found.why = reason;
    } else if (orbit_.from == OrbitSource::free) {
      if (const auto x = free_orbit(map_, orbit_.at, found.clock)) found.shot = solve(*x, found.clock);
    } else if (orbit_.from == OrbitSource::stored) {
      try {
        const LaneState state = stored_orbit(orbit_, continued_.program(scene), steps_);
        found.shot = solve(map_.vector().read(state), found.clock);
      } catch (const PointRefused& refused) {
        found.why = refused.what();
      }
    } else {
      wait(scene, found);
    }
    if (!found.why.empty()) return found;
    if (found.shot.found && !found.clock.half) use_image(found);
    if (!found.shot.found) found.why = not_found(found.shot);
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
      const Eigen::VectorXd x = map_.vector().read(*state);
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
    const MapMarch made = map_.march(found.shot.x, orbit_.at, half);
    if (made.end || map_.metric().size(made.image - found.shot.x) > image_tolerance * continued_.gap()) return;
    ShotOrbit image = solve(found.shot.x, half);
    if (!image.found) return;
    image.iterations += found.shot.iterations;
    found.shot = std::move(image);
    found.clock = half;
  }

  std::string not_found(const ShotOrbit& shot) const {
    if (orbit_.from == OrbitSource::free && shot.x.size() == 0) return "the motion without contact is in resonance";
    const char* from = orbit_.from == OrbitSource::state  ? "the scene's state"
                       : orbit_.from == OrbitSource::free ? "the motion without contact"
                       : orbit_.from == OrbitSource::rest ? "rest"
                                                          : "the stored orbit";
    std::string why = fmt::format(
        "no orbit of period {} within {} iterations from {} at λ = {:g}; nearest return {:.3g} m "
        "after {} period{}",
        orbit_.period, shot.iterations, from, orbit_.at, shot.nearest, orbit_.periods, orbit_.periods == 1 ? "" : "s");
    if (shot.end) why += "; " + text(shot.end);
    if (shot.step >= 0)
      why += fmt::format("; residuals alternate between two contact sets (step {} of {}, point {})", shot.step + 1,
                         steps_, map_.sets().place(shot.row).point + 1);
    return why;
  }

  ContinuedMap& continued_;
  PeriodicMap& map_;
  int steps_;
  const WantedOrbit& orbit_;
  double& round_off_;
};

}  // namespace

FirstOrbit first_orbit(ContinuedMap& continued, PeriodicMap& map, int steps_per_period, const WantedOrbit& orbit,
                       double& round_off) {
  return OrbitSearch(continued, map, steps_per_period, orbit, round_off).find();
}

}  // namespace ricochet
