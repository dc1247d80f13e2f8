#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <ricochet/measure/energy/energy_audit.hpp>
#include <ricochet/measure/stability/plan_restitution.hpp>

#include "runners/check/scheme_checks.hpp"

namespace ricochet::checking {
namespace {

constexpr double mass = 2, fall = 0.5;
constexpr int phases = 5;

StepPlan contact_plan(const Scheme& scheme, double h) {
  return plan_of(scheme, h, {1, 0, false, true});
}
Verdict no_measure() {
  return not_declared("no impact measure: rigid laws are refused");
}

// The velocity that the scheme keeps, of one mass.
double own_velocity(const Marcher& marcher) {
  const LaneState state = marcher.lane_state(0);
  const std::vector<double>& weights = marcher.program().plan.velocity.slots;
  double speed = 0;
  for (std::size_t j = 0; j < weights.size(); ++j) speed += weights[j] * state.slots[j];
  return marcher.program().model->to_nodal(Eigen::VectorXd::Constant(1, speed))[0];
}

// A free mass falls with 1 m/s on a stop at 0 and leaves it.
struct Bounce {
  double after = 0;   // m/s, by the positions of the last step
  double gained = 0;  // m/s, of the velocity that the scheme itself keeps
  double lowest = 0, impulse = 0;
  long long impacts = 0;
};
Bounce bounce(const Scheme& scheme, double h, int phase, std::unique_ptr<ContactLaw> law, int steps) {
  const ProblemPointer problem = discretised(oscillator_scene(
      {.mass = mass, .stiffness = 0, .position = fall + h * (phase + 0.37) / phases, .velocity = -1, .stop = true}));
  Marcher marcher = marcher_of(scheme, problem, h, std::move(law));
  EnergyAudit audit(marcher);
  marcher.start(&audit);
  Bounce result;
  double last = marcher.position(0)[0];
  for (int n = 0; n < steps; ++n) {
    marcher.march(1, &audit);
    const double now = marcher.position(0)[0];
    if (n == 1) result.gained = -own_velocity(marcher);
    result.after = (now - last) / h;
    result.lowest = std::min(result.lowest, now);
    last = now;
  }
  if (!marcher.status(0).running) throw std::runtime_error("a bouncing mass stopped: " + text(marcher.status(0).end));
  result.gained += own_velocity(marcher);
  result.impulse = audit.contact(0).impulse;
  result.impacts = audit.contact(0).impacts;
  return result;
}

// An oscillator (1 kg, 2 rad/s about `rest`) above a stop at 0: w between its first impact and the next.
struct OscillatorBounce {
  static constexpr double omega = 2;
  double rest = 0.2, impact = 0, speed = 0;  // s, and m/s towards the stop
  double after(double t, double e) const {
    const double s = omega * (t - impact);
    return rest - rest * std::cos(s) + e * speed / omega * std::sin(s);
  }
  // Let go at rest at `height`.
  static OscillatorBounce from_rest(double height) {
    OscillatorBounce bounce;
    const double a = height - bounce.rest;
    bounce.impact = std::acos(-bounce.rest / a) / omega;
    bounce.speed = a * omega * std::sin(omega * bounce.impact);
    return bounce;
  }
  SceneSpec scene(double position, double velocity) const {
    SceneSpec scene = oscillator_scene(
        {.mass = 1, .stiffness = omega * omega, .position = position, .velocity = velocity, .stop = true});
    scene.load = Formula(rest * omega * omega);
    return scene;
  }
};

// Errors of displacements between the impact and the next one, the mean over phases.
std::vector<double> errors_after_impact(const Scheme& scheme, const std::vector<double>& steps, double e) {
  std::vector<double> errors;
  for (const double h : steps) {
    double sum = 0;
    for (int phase = 0; phase < phases; ++phase) {
      const double height = 0.7 + 1.3 * h * (phase + 0.37) / phases;
      const OscillatorBounce exact = OscillatorBounce::from_rest(height);
      Marcher marcher = marcher_of(scheme, discretised(exact.scene(height, 0)), h, rigid_stops());
      marcher.start();
      double worst = 0;
      while (marcher.time() < exact.impact + 0.4) {
        marcher.march(1);
        if (marcher.time() > exact.impact + 0.15)
          worst = std::max(worst, std::abs(marcher.position(0)[0] - exact.after(marcher.time(), e)));
      }
      sum += worst / phases;
    }
    errors.push_back(sum);
  }
  return errors;
}

/// A start at a stop, or a share of a step's way from it, and what the integration then errs by.
struct StopStart {
  const char* what;
  double away;      // in steps of the way h |v|
  double velocity;  // m/s, away from the stop
  double rest;      // of the oscillator, m: below the stop, it is pressed
};
constexpr std::array<StopStart, 5> stop_starts = {{{"on the stop, moving in", 0, -1, 0.2},
                                                   {"half a step from the stop, moving in", 0.5, -1, 0.2},
                                                   {"a step from the stop, moving in", 1, -1, 0.2},
                                                   {"on the stop, moving away, pressed", 0, 1, -0.2},
                                                   {"on the stop, at rest, pressed", 0, 0, -0.2}}};
struct StopStartErrors {
  double displacement = 0;         // largest until 0.4 s, m
  std::optional<double> lost = 0;  // of what stops and scheme took, J; none where no balance is known
};
StopStartErrors errors_after_start(const Scheme& scheme, const StopStart& start, double h, double e) {
  const OscillatorBounce exact{.rest = start.rest, .impact = 0, .speed = start.velocity};
  const bool rests = start.velocity == 0, comes = start.velocity < 0;
  Marcher marcher = marcher_of(
      scheme, discretised(exact.scene(start.away * h * std::abs(start.velocity), start.velocity)), h, rigid_stops());
  EnergyAudit audit(marcher);
  marcher.start(&audit);
  StopStartErrors errors;
  while (marcher.time() < 0.4) {
    marcher.march(1, &audit);
    const double t = marcher.time(), rebound = comes ? -e : 1;
    const double place = rests ? 0 : exact.after(t, rebound);
    errors.displacement = std::max(errors.displacement, std::abs(marcher.position(0)[0] - place));
  }
  if (!marcher.status(0).running)
    throw std::runtime_error(std::string(start.what) + ": the integration stopped: " + text(marcher.status(0).end));
  errors.lost = std::nullopt;
  if (audit.balances())
    errors.lost = std::abs(audit.lost_at_stops(0) + audit.totals(0).work_of_scheme - (comes ? 0.5 * (1 - e * e) : 0));
  return errors;
}

std::vector<double> contact_steps(const StepPlan& plan) {
  double h = 0.02;
  if (plan.facts.stability_limit) h = std::min(h, 0.2 * *plan.facts.stability_limit);
  return {h, h / 2, h / 4, h / 8, h / 16};
}

std::string range_text(const RestitutionRange& range) {
  return fmt::format("{:.4g} to {:.4g} over the phases of the impact, mean {:.4g}", range.least, range.most,
                     range.mean);
}

const char* word(Restitution restitution) {
  return restitution == Restitution::exact ? "exact" : "asymptotic";
}

}  // namespace

Verdict rigid_stops_hold(const Scheme& scheme) {
  const double h = 0.05;
  const StepPlan plan = contact_plan(scheme, h);
  if (!measures(plan)) return no_measure();
  if (!plan_restitution(plan, h))
    return fails("declares an impact measure that no effort can move: its weight of z, or S, has nothing of M");
  double lowest = 0;
  for (int phase = 0; phase < phases; ++phase) {
    const Bounce of = bounce(scheme, h, phase, rigid_stops(), 40);
    lowest = std::min(lowest, of.lowest);
    if (of.impacts == 0) return fails("a mass that falls on a rigid stop passes through it: no effort is ever found");
  }
  // A measure that averages positions lets the mass pass by the way of a step or so.
  if (!(-lowest <= 2 * h))
    return fails(
        fmt::format("a mass that comes with 1 m/s passes a rigid stop by {:.2g} steps of its way", -lowest / h));
  return fine(fmt::format("passes the stop by {:.2g} of a step's way at most", -lowest / h));
}

Verdict restitution_as_declared(const Scheme& scheme) {
  const double h = 0.05;
  const StepPlan plan = contact_plan(scheme, h);
  if (!measures(plan)) return no_measure();
  const auto range = restitution_range(plan, h);
  if (!range) return not_applicable("no effort can move the impact measure");
  const double e = declared_restitution(scheme);
  const Restitution declared = plan.facts.restitution;
  if (declared == Restitution::ignored) return not_declared("ignored; measured " + range_text(*range));
  if (declared == Restitution::exact && !(std::abs(range->least - e) <= 1e-9 && std::abs(range->most - e) <= 1e-9))
    return fails(
        fmt::format("declares its restitution exact, e = {:g}; a free mass rebounds with {}", e, range_text(*range)));
  const std::vector<double> steps = contact_steps(plan), errors = errors_after_impact(scheme, steps, e);
  if (!(errors.back() <= 0.5 * errors.front() && errors.back() <= 0.02))
    return fails(
        fmt::format("declares its restitution {}, e = {:g}. After one bounce of an oscillator the error is {:.2g} m at "
                    "h = {:g} s and {:.2g} m at {:g} s. It should vanish. A free mass rebounds with {}",
                    word(declared), e, errors.front(), steps.front(), errors.back(), steps.back(), range_text(*range)));
  return fine(fmt::format("{}, e = {:g}: a free mass rebounds with {}", word(declared), e, range_text(*range)));
}

// As h → 0 a start at a stop does what the motion does. One that moves in rebounds with e v. Stops and scheme take ½ m
// v² (1 − e²).
Verdict start_at_a_stop(const Scheme& scheme) {
  const StepPlan plan = contact_plan(scheme, 0.01);
  if (!measures(plan)) return no_measure();
  if (plan.facts.restitution == Restitution::ignored) return not_declared("restitution ignored");
  const double e = declared_restitution(scheme);
  const std::vector<double> steps = contact_steps(plan);
  double least = HUGE_VAL;
  for (const StopStart& start : stop_starts) {
    std::vector<double> errors;
    double first_lost = 0, last_lost = 0;
    for (const double h : steps) {
      const StopStartErrors of = errors_after_start(scheme, start, h, e);
      errors.push_back(of.displacement);
      last_lost = of.lost.value_or(0);
      if (h == steps.front()) first_lost = last_lost;
    }
    constexpr double round_off = 1e-10;  // of some hundred steps
    // What is pressed may yield by its way in a step.
    const double way = steps.back() * steps.back();
    if (!(errors.back() <= std::max({round_off, way, 0.5 * errors.front()}) && errors.back() <= 0.02))
      return fails(fmt::format(
          "a start {}: the error is {:.2g} m at h = {:g} s and {:.2g} m at {:g} s, where it should vanish (e = {:g})",
          start.what, errors.front(), steps.front(), errors.back(), steps.back(), e));
    if (!(last_lost <= std::max({round_off, way, 0.5 * first_lost}) && last_lost <= 0.02))
      return fails(
          fmt::format("a start {}: what stops and scheme take is wrong by {:.2g} J at h = {:g} s and {:.2g} J at {:g} "
                      "s. What they take should tend to m v² (1 − e²)/2 (e = {:g})",
                      start.what, first_lost, steps.front(), last_lost, steps.back(), e));
    if (start.velocity == 0) continue;  // it errs by its way in a step at most: no order
    const MeasuredOrder measured = measured_order(steps, errors, 0.5);
    if (!measured.exact) least = std::min(least, measured.order);
  }
  return fine(std::isfinite(least) ? fmt::format("order {:.2f} at least, over {} starts", least, stop_starts.size())
                                   : fmt::format("exact, over {} starts", stop_starts.size()));
}

Verdict contact_order_as_declared(const Scheme& scheme) {
  const StepPlan plan = contact_plan(scheme, 0.01);
  if (!measures(plan)) return no_measure();
  const auto range = restitution_range(plan, 0.01);
  const bool known = plan.facts.restitution != Restitution::ignored;
  if (!plan.facts.contact_order && !known) return not_declared("not known");
  const std::vector<double> steps = contact_steps(plan);
  const double e = known ? declared_restitution(scheme) : range ? range->mean : 0;
  const MeasuredOrder measured = measured_order(steps, errors_after_impact(scheme, steps, e), 0.5);
  if (!plan.facts.contact_order) return not_declared(fmt::format("not known; measured {:.2f}", measured.order));
  constexpr double irregular = 0.35;  // impacts fall anywhere in a step
  if (!measured.exact && !(measured.order >= *plan.facts.contact_order - irregular))
    return fails(
        fmt::format("declares order {:g} at rigid stops; after one bounce of an oscillator it is {:.2f} (error "
                    "{:.2g} m at the finest of 5 steps)",
                    *plan.facts.contact_order, measured.order, measured.finest));
  return fine(fmt::format("declared {:g}, measured {:.2f}", *plan.facts.contact_order, measured.order));
}

Verdict impulse_is_momentum(const Scheme& scheme) {
  const double h = 0.05;
  const StepPlan plan = contact_plan(scheme, h);
  std::vector<std::pair<std::string, std::function<std::unique_ptr<ContactLaw>()>>> laws;
  if (measures(plan)) laws.emplace_back("rigid stops", rigid_stops);
  for (const Evaluation evaluation : {Evaluation::implicit_end, Evaluation::averaged, Evaluation::explicit_start})
    if (std::any_of(plan.stages.begin(), plan.stages.end(),
                    [&](const Stage& stage) { return stage.at(evaluation).has_value(); }))
      laws.emplace_back(std::string("springs, ") + evaluation_word(evaluation),
                        [evaluation] { return springs(evaluation, 50); });
  if (laws.empty()) return not_declared("no measure of contact at all");
  for (const auto& [name, law] : laws)
    for (int phase = 0; phase < phases; ++phase) {
      const Bounce of = bounce(scheme, h, phase, law(), 60);
      const double change = mass * of.gained;
      if (!(std::abs(change - of.impulse) <= 1e-8 * mass))
        return fails(fmt::format("{}: the efforts of one bounce sum up to {:.8g} N s, the momentum changes by {:.8g}",
                                 name, of.impulse, change));
      if (!(of.after >= -1e-6))
        return fails(
            fmt::format("{}: a mass that falls with 1 m/s still falls with {:.3g} m/s at the end", name, -of.after));
    }
  return fine(fmt::format("of one bounce on {}", laws.size() == 1 ? laws.front().first : "rigid stops and springs"));
}

namespace {

// The share of a step that its instants of contact last, on a rigid stop: Σ Ω/h.
double contact_of_step(const Scheme& scheme, double h) {
  const SceneSpec scene = oscillator_scene({.mass = mass, .stiffness = 8, .damping = 8, .stop = true});
  const Marcher marcher = marcher_of(scheme, discretised(scene), h, rigid_stops());
  double sum = 0;
  for (const StageProgram& stage : marcher.program().stages)
    if (stage.reads_contact && stage.closes_instant) sum += stage.lasts;
  return sum / h;
}

}  // namespace

// A force is what an instant gives over how long it lasts. In a step that is closed throughout it is the load where the
// instants fill the step. Exactly, or as h → 0.
Verdict force_at_rest(const Scheme& scheme) {
  constexpr double load = 10, coarse = 0.05, fine_step = coarse / 4;  // N, s
  if (!measures(plan_of(scheme, coarse, {1, 0, true, true}))) return no_measure();
  const double first = contact_of_step(scheme, coarse), second = contact_of_step(scheme, fine_step);
  const double error = std::abs(second - 1);
  if (!(error <= std::max(1e-6, 0.5 * std::abs(first - 1))))
    return fails(
        fmt::format("a mass that {:g} N press on a rigid stop has a contact force of {:.6g} N at rest: contact lasts "
                    "{:.4g} of a step that is closed throughout, at h = {:g} s. The weights of its efforts should add "
                    "up to what 1 N of a load is",
                    load, load / second, second, fine_step));
  return fine(fmt::format("{:.6g} N under a load of {:g} N", load / second, load));
}

}  // namespace ricochet::checking
