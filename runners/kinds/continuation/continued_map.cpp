#include "runners/kinds/continuation/continued_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <ricochet/contract/said_format.hpp>
#include <ricochet/measure/orbits/impact_jump.hpp>
#include <ricochet/measure/orbits/multipliers.hpp>

#include "runners/kinds/sweep/with_parameter.hpp"

namespace ricochet {
namespace {

constexpr double round_off = 1e-12;

double gap_of(const LaneSpec& lane) {
  double gap = std::numeric_limits<double>::infinity();
  for (Eigen::Index i = 0; i < lane.lower.size(); ++i) {
    const double lower = lane.lower[i], upper = lane.upper[i];
    if (std::isfinite(lower) && std::isfinite(upper))
      gap = std::min(gap, std::abs(upper - lower) / 2);
    else if (std::isfinite(lower) || std::isfinite(upper))
      gap = std::min(gap, std::abs(std::isfinite(lower) ? lower : upper));
  }
  if (std::isfinite(gap) && gap > 0) return gap;
  return lane.amplitude != 0 ? std::abs(lane.amplitude) : 1;
}

// Whether a formula stands there, which the parameter multiplies.
bool is_formula(const Json& scene, const std::string& pointer) {
  const Json::json_pointer there(pointer.substr(std::string("/scene").size()));
  if (!scene.contains(there) || !scene.at(there).is_string()) return false;
  const Formula formula(scene.at(there).get<std::string>(), pointer);
  return formula.uses_x() || formula.uses_t();
}

// A load that is not its own image half a period later, with the sign changed: where it is seen, in words.
std::string not_odd(const SemiDiscrete& problem, double period) {
  const bool loaded = problem.load && !problem.load->absent();
  constexpr int phases = 16;
  constexpr double tolerance = 1e-9;
  Eigen::VectorXd now = Eigen::VectorXd::Zero(problem.dofs()), later = now;
  double largest = 0, worst = 0, when = 0;
  for (int k = 0; k < phases; ++k) {
    const double t = period * (k + 0.37) / (2 * phases);
    const auto lifts = [&](double at) -> Eigen::VectorXd {
      return problem.motions.at_points * problem.motions.values(at, false);
    };
    if (!problem.motions.empty()) {
      const Eigen::VectorXd one = lifts(t), other = lifts(t + period / 2);
      if ((one + other).cwiseAbs().maxCoeff() > tolerance * one.cwiseAbs().maxCoeff())
        return fmt::format("motions at t = {:.4g} s are not minus those half a period later", t);
    }
    if (!loaded) continue;
    problem.load->assemble(t, now.data());
    problem.load->assemble(t + period / 2, later.data());
    largest = std::max(largest, now.cwiseAbs().maxCoeff());
    if (const double sum = (now + later).cwiseAbs().maxCoeff(); sum > worst) worst = sum, when = t;
  }
  if (worst <= tolerance * largest) return "";
  return fmt::format("the load at t = {:.4g} s is not minus the one half a period later", when);
}

}  // namespace

bool is_length(const std::string& pointer) {
  const bool stop =
      pointer.starts_with("/scene/stops/") &&
      (pointer.ends_with("/lower") || pointer.ends_with("/upper") || pointer.ends_with("/clearance/radius"));
  return stop || pointer == "/scene/support/amplitude" || pointer.ends_with("/displacement/amplitude");
}

ContinuedMap::ContinuedMap(const StudyCase& study_case, const Registry& registry, const ContinuationPlan& plan)
    : case_(study_case), plan_(plan), scenes_(study_case, registry) {
  for (const WantedOrbit& orbit : plan.orbits) {
    std::string reason;
    const int scene = scene_at(orbit.at, orbit.from == OrbitSource::state, reason);
    if (scene >= 0) {
      reference_ = scene;
      reference_at_ = orbit.at;
      break;
    }
    if (refusal_.empty()) refusal_ = said("at {:g}: {}", orbit.at, reason);
  }
  if (reference_ < 0) return;
  refusal_ = {};
  gap_ = gap_of(scenes_[reference_].lane);
  if (!is_length(plan.pointer) || is_formula(study_case.scene_json, plan.pointer)) {
    const double value = std::max(std::abs(plan.from), std::abs(plan.to));
    metres_ = value > 0 ? gap_ / value : gap_;
  }
  check_class(reference_);
  if (refusal_.empty()) check_ends();
  std::string reason;
  for (const double end : {from_, to_})
    if (refusal_.empty()) check_class(scene_at(end, false, reason));
  check_image(reference_);
  if (refusal_.empty()) check_kernel(reference_);
  const bool images = std::any_of(plan.orbits.begin(), plan.orbits.end(),
                                  [](const WantedOrbit& one) { return one.symmetric == HalfMap::yes; });
  if (refusal_.empty() && images) refusal_ = no_image_;
  if (refusal_.empty() && plan.follow == Follow::pieces && !no_pieces_.empty())
    refusal_ = no_pieces_ + ": follow with steps";
  if (refusal_.empty() && !by_pieces()) check_tangents();
}

int ContinuedMap::scene_at(double value, bool own_state, std::string& reason) {
  const int scene = scenes_.add(plan_.pointer, value, own_state);
  reason = scenes_[scene].refusal.text;
  return reason.empty() ? scene : -1;
}

Program ContinuedMap::program(int scene) const {
  return scenes_.program(scenes_[scene].group, {scenes_[scene].lane});
}

// Whether the frozen derivative is that of the motion.
void ContinuedMap::check_class(int scene) {
  const Program program = this->program(scene);
  constexpr double rebounds_above = 1e-6;
  double e = 0;
  bool too_fast = tangents_miss_impacts(program);
  // Only a point with mass is thrown back.
  const std::vector<bool> thrown_back = thrown_points(program, rebounds_above);
  const bool thrown = std::find(thrown_back.begin(), thrown_back.end(), true) != thrown_back.end();
  if (thrown) {
    const std::vector<bool> resolved = resolved_points(*program.problem, program.h);
    const std::vector<std::optional<double>> restitutions = point_restitutions(program);
    for (std::size_t i = 0; i < resolved.size(); ++i) {
      if (!thrown_back[i]) continue;
      e = std::max(e, std::abs(restitutions[i].value_or(0)));
      too_fast = too_fast || !resolved[i];
    }
  }
  if (too_fast) {
    refusal_ = fmt::format(
        "stops are met at whole steps by a mass that a step of {:.4g} s does not resolve: the map has jumps. It jumps "
        "where the step of an impact changes, and its derivative is not the motion's. Use a position-level scheme, a "
        "singular mass, or bifurcation",
        program.h);
    return;
  }
  rebounds_ = rebounds_ || thrown || stops_met_at_steps(program);
  if (thrown)
    no_pieces_ =
        fmt::format("the stops give back {:.3g} of the speed: the map jumps where the step of an impact changes", e);
  else if (const auto reason = SetSteps::refusal(program))
    no_pieces_ = "a step is not affine between changes of contact: " + *reason;
}

// Whether the steps have tangent columns.
void ContinuedMap::check_tangents() {
  try {
    stepped_map(reference_at_);
    scenes_.program(scenes_[reference_].group, {scenes_[reference_].lane}, 1);
  } catch (const Refusal& refusal) {
    refusal_ = refusal.sentence;
  }
}

void ContinuedMap::check_kernel(int scene) {
  const Program program = this->program(scene);
  if (SetSteps::refusal(program) || program.problem->inertia.kernel_dimension == 0) return;
  // A root that is a multiplier 1 of the map, as ±1 is: P(x) = x has no orbit that stands alone.
  const SetSteps sets(program);
  constexpr double near = 1e-7, one = 1e-6;
  std::vector<std::complex<double>> roots = multipliers_of(sets[0].state.topRows(sets.state_size()));
  bool alone = std::none_of(roots.begin(), roots.end(), [](const std::complex<double>& root) {
    return std::abs(std::abs(root) - 1) < near && std::abs(root.imag()) < near;
  });
  const bool half = no_image_.empty();
  for (const std::complex<double>& multiplier :
       after_steps(massless_roots(program, sets), case_.steps_per_period / (half ? 2 : 1), half ? -1 : 1))
    alone = alone && std::abs(multiplier - 1.0) > one;
  if (!alone)
    refusal_ =
        "the step has a root of modulus 1 on displacements without mass, so that no orbit stands alone. Use another "
        "weight of the scheme with damping of the stiffness, or a regular mass";
}

// An end of the range, or the last value on the way to it from the first orbit at which the scene is possible.
double ContinuedMap::possible_end(double end, std::string& impossible) {
  std::string reason;
  if (scene_at(end, false, reason) >= 0) return end;
  impossible = fmt::format("at {:g}: {}", end, reason);
  double possible = reference_at_;
  constexpr int halvings = 30;
  for (int k = 0; k < halvings; ++k) {
    const double between = 0.5 * (possible + end);
    (scene_at(between, false, reason) >= 0 ? possible : end) = between;
  }
  return possible;
}

// Whether the parameter enters by amplitude and stops alone, and affinely.
void ContinuedMap::check_ends() {
  from_ = possible_end(plan_.from, impossible_[0]);
  to_ = possible_end(plan_.to, impossible_[1]);
  std::string reason;
  const double between = 0.5 * (from_ + to_);
  const int low = scene_at(from_, false, reason), high = scene_at(to_, false, reason),
            middle = scene_at(between, false, reason);
  if (low < 0 || high < 0 || !(from_ < to_)) {
    refusal_ = impossible_[impossible_[0].empty()] + "; expected a range in which the scene is possible";
    return;
  }
  const bool one_group =
      middle >= 0 && scenes_[low].group == scenes_[high].group && scenes_[middle].group == scenes_[low].group;
  bool affine = one_group || (middle >= 0 && affine_loads(low, middle, high));
  if (affine) lanes_ = affine_lane(scenes_[low].lane, from_, scenes_[high].lane, to_);
  affine = affine && lanes_ && passes_through(*lanes_, scenes_[middle].lane, between);
  if (!affine && no_pieces_.empty()) no_pieces_ = plan_.pointer + " does not enter linearly";
  if (!affine) lanes_.reset();
  origin_ = low;
  moves_loads_ = !one_group;
}

// Whether three scenes have the same steps, and loads on a line: at the ends of the range, and half way between.
bool ContinuedMap::affine_loads(int low, int middle, int high) {
  if (!no_pieces_.empty()) return false;
  const Program first = program(low), second = program(high), between = program(middle);
  if (!first.load || !second.load || !between.load || first.h != second.h) return false;
  const SetSteps one(first), other(second);
  if (one.state_size() != other.state_size() || one[0].state != other[0].state || one[0].drive != other[0].drive)
    return false;
  const auto dofs = static_cast<Eigen::Index>(first.problem->dofs());
  Eigen::VectorXd a = Eigen::VectorXd::Zero(dofs), b = a, c = a;
  constexpr int samples = 16;
  for (int k = 0; k < samples; ++k) {
    const double t = (k + 0.37) * first.h * case_.steps_per_period / samples;
    first.problem->load->assemble(t, a.data());
    between.problem->load->assemble(t, b.data());
    second.problem->load->assemble(t, c.data());
    if ((0.5 * (a + c) - b).cwiseAbs().maxCoeff() > round_off * (a.cwiseAbs() + c.cwiseAbs()).maxCoeff()) return false;
  }
  return true;
}

void ContinuedMap::check_image(int scene) {
  const ForcedScene& one = scenes_[scene];
  if (case_.steps_per_period % 2 != 0) {
    no_image_ =
        fmt::format("the scene is not its own image: {} steps per period are an odd number", case_.steps_per_period);
    return;
  }
  for (const double at : {from_, to_, reference_at_}) {
    const LaneSpec lane = lanes_ ? lanes_->lane(at) : one.lane;
    for (Eigen::Index i = 0; i < lane.lower.size(); ++i) {
      const double differ = std::abs(lane.lower[i] + lane.upper[i]);
      if (!(differ <= round_off * gap_) && no_image_.empty())
        no_image_ =
            std::isfinite(differ)
                ? fmt::format("the scene is not its own image: lower and upper stops differ by {:.3g} m", differ)
                : std::string("the scene is not its own image: it has a stop on one side alone");
    }
  }
  if (const std::string load = not_odd(scenes_.problem(one.group), 2 * std::numbers::pi / one.pulsation);
      no_image_.empty() && !load.empty())
    no_image_ = "the scene is not its own image: " + load;
}

std::unique_ptr<PeriodicMap> ContinuedMap::map() {
  AffineLoad load;
  if (moves_loads_) {
    load.other = to_;
    load.program = [this](double value) {
      std::string reason;
      const int scene = scene_at(value, false, reason);
      if (scene < 0) throw Refusal{reason};
      return program(scene);
    };
  }
  return std::make_unique<PeriodicMap>(program(origin_), *lanes_, units(), std::move(load));
}

SteppedMap ContinuedMap::stepped_map(double at) {
  const auto make = [this](double value, int tangents) {
    // Lanes that are affine in the parameter need no scene of their own.
    if (lanes_ && !moves_loads_ && value >= from_ && value <= to_) {
      const int group = scenes_[origin_].group;
      return SteppedMap::Scene{scenes_.program(group, {lanes_->lane(value)}, tangents), group};
    }
    const auto [place, added] = marched_.try_emplace(value, -1);
    if (added) {
      std::string reason;
      place->second = scene_at(value, false, reason);
    }
    if (place->second < 0) throw Refusal{scenes_[scenes_.count() - 1].refusal};
    const ForcedScene& scene = scenes_[place->second];
    return SteppedMap::Scene{scenes_.program(scene.group, {scene.lane}, tangents), scene.group};
  };
  const auto carry = [this](const LaneState& state, int from, int to) { return scenes_.carry(state, from, to); };
  return {make, carry, at, units(), rebounds_};
}

}  // namespace ricochet
