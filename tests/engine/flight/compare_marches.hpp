#pragma once
// An integration that leaves out steps beside the same integration of every step, by all that is read of it. How far
// round-off may carry two equal motions apart a twin says that begins 1e-12 beside, and the same integration with
// another operator.
#include <fmt/format.h>

#include <ricochet/engine/flight/flight.hpp>
#include <ricochet/measure/contact/impact_recorder.hpp>

#include "tests/marching.hpp"

namespace ricochet::testing {

struct Ending {
  Eigen::VectorXd position;
  long long contact_steps = 0, impacts = 0, visited = 0;
  double impulse = 0, loads = 0, damping = 0, scheme = 0;
  double contact = 0, law = 0, gain = 0, deepest = 0, normal = 0, time = 0;
  bool running = false, balances = false;
  double first = 0;
  std::vector<Impact> rows;
  void add(const StopTotals& stop) {
    impulse += stop.impulse;
    normal += stop.normal_work;
    time += stop.contact_time;
  }
};

inline Ending march_to_end(Program program, long long steps) {
  Marcher marcher(std::move(program));
  EnergyAudit audit(marcher);
  // An audit of a scheme without an energy sees every step.
  const bool audited = !marcher.program().plan.energy.empty();
  ImpactRecorder recorder(marcher);
  const Observers observers{audited ? &audit : nullptr, &recorder};
  marcher.start(observers);
  marcher.march(steps - marcher.step(), observers);
  recorder.finish(marcher);
  Ending ending;
  ending.position = marcher.position(0);
  ending.impacts = recorder.count(0);
  ending.visited = marcher.steps_visited();
  ending.loads = audit.totals(0).work_of_loads;
  ending.damping = audit.totals(0).work_of_damping;
  ending.scheme = audit.totals(0).work_of_scheme;
  ending.contact = audit.totals(0).work_of_contact;
  ending.law = audit.totals(0).work_of_law;
  ending.gain = audit.totals(0).largest_step_gain;
  ending.deepest = audit.contact(0).deepest_penetration;
  for (int point = 0; point < marcher.program().problem->points(); ++point)
    for (const StopSide side : {StopSide::lower, StopSide::upper}) ending.add(recorder.totals(0, point, side));
  ending.running = marcher.status(0).running;
  ending.contact_steps = audited ? audit.contact(0).contact_steps : std::llround(ending.time / marcher.program().h);
  const StepPlan& plan = marcher.program().plan;
  ending.balances = !plan.energy.empty() && std::all_of(plan.stages.begin(), plan.stages.end(),
                                                        [](const Stage& stage) { return stage.work.has_value(); });
  ending.first = audit.totals(0).first.common();
  ending.rows = recorder.impacts(0);
  return ending;
}

inline CompileOptions modal_options(MarchWay way, long long steps) {
  CompileOptions chosen;
  chosen.kind = OperatorKind::modal;
  chosen.march = way;
  chosen.expected_steps = steps;
  return chosen;
}

// Of a parameter without a default, something that suits most.
inline Choice with_values(const PluginManual& manual) {
  Choice choice{manual.name, {}};
  for (const ParameterSpec& spec : manual.parameters) {
    if (!spec.fallback && spec.type == ParameterSpec::Type::table)
      choice.values[spec.key] = ParameterTable{{0, 0}, {1, 1e4}};
    if (spec.fallback || spec.type != ParameterSpec::Type::real) continue;
    choice.values[spec.key] = spec.range.high < 10 ? 0.5 : 1e4;
  }
  return choice;
}

struct Compared {
  bool flew = false, alike = true;
  std::string cause, apart;
  long long steps = 0, visited = 0, contact_steps = 0;
};

// `spoil`: what the flights are told of the stops, moved away by so much (m): an integration that misses contacts.
inline Compared compare(const SceneSpec& scene, int elements, const Methods& methods, double h, long long steps,
                        double spoil = 0) {
  Compared result;
  const auto law = make(registry().contact(methods.contact.name), methods.contact);
  auto discrete = discretise(scene, elements, *make(registry().mass(methods.mass.name), methods.mass), law.get());
  if (const auto* refusal = std::get_if<Refusal>(&discrete)) {
    result.cause = refusal->sentence.text;
    return result;
  }
  const auto problem = std::make_shared<const SemiDiscrete>(std::move(std::get<SemiDiscrete>(discrete)));
  auto flown = compiled(problem, methods, h, modal_options(MarchWay::flights, steps));
  if (const auto* refusal = std::get_if<Refusal>(&flown)) {
    result.cause = refusal->sentence.text;
    return result;
  }
  result.flew = true;
  Program& program = std::get<Program>(flown);
  if (spoil != 0) {
    const LaneSpec lane = program.lanes.front();
    program.lanes.front().lower.array() -= spoil;
    program.lanes.front().upper.array() += spoil;
    program.flight = std::make_shared<Flight>(program, 0, steps);
    program.lanes.front() = lane;
  }
  const Ending one = march_to_end(std::move(program), steps);
  auto every = compiled(problem, methods, h, modal_options(MarchWay::every_step, steps));
  const Ending other = march_to_end(std::move(std::get<Program>(every)), steps);
  const auto march_beside = [&](double apart) {
    const auto beside = [apart](const LaneSpec& lane) {
      LaneSpec twin = lane;
      twin.position *= 1 + apart;
      twin.velocity *= 1 + apart;
      twin.amplitude *= 1 + apart;
      return std::vector<LaneSpec>{twin};
    };
    auto made = compiled(problem, methods, h, modal_options(MarchWay::every_step, steps), beside);
    return march_to_end(std::move(std::get<Program>(made)), steps);
  };
  const Ending twin = march_beside(1e-12);
  result.steps = steps;
  result.visited = one.visited;
  result.contact_steps = one.contact_steps;
  const double size = other.position.lpNorm<Eigen::Infinity>();
  // The same integration with the round-off of another operator.
  CompileOptions band = modal_options(MarchWay::every_step, steps);
  band.kind = OperatorKind::band;
  auto third = compiled(problem, methods, h, band);
  // Damping by modes has no other operator: a twin then.
  auto* const by_band = std::get_if<Program>(&third);
  const Ending rounded = by_band ? march_to_end(std::move(*by_band), steps) : march_beside(-1e-13);
  const double open = std::max((twin.position - other.position).lpNorm<Eigen::Infinity>(),
                               (rounded.position - other.position).lpNorm<Eigen::Infinity>());
  const double apart = (one.position - other.position).lpNorm<Eigen::Infinity>();
  const auto differ = [&](const std::string& what, double a, double b) {
    result.alike = false;
    result.apart += fmt::format("{}: {:.10g} flown, {:.10g} marched; ", what, a, b);
  };
  if (one.running != other.running) differ("running", one.running, other.running);
  // Where the twin is far the motion has forgotten its start: then nothing is to be compared.
  if (open > 1e-4 * size || !other.running) return result;
  if (apart > 30 * open + 1e-11 * size) differ("end", apart, open);
  const auto as_often = [](const Ending& a, const Ending& b) {
    return a.contact_steps == b.contact_steps && a.impacts == b.impacts;
  };
  // A point at rest may be let go for a step by round-off: more twins, where their number differs, say whether it is.
  const auto round_off_chooses = [&] {
    for (const double beside : {-1e-12, 5e-13, -5e-13, 2e-12, -2e-12, 1e-13, -1e-13, 3e-12})
      if (!as_often(march_beside(beside), other)) return true;
    return false;
  };
  if (twin.contact_steps == other.contact_steps && rounded.contact_steps == other.contact_steps &&
      !as_often(one, other) && !round_off_chooses()) {
    if (one.contact_steps != other.contact_steps)
      differ("contact steps", static_cast<double>(one.contact_steps), static_cast<double>(other.contact_steps));
    if (one.impacts != other.impacts)
      differ("impacts", static_cast<double>(one.impacts), static_cast<double>(other.impacts));
  }
  const auto same = [&](const char* what, double Ending::*value, double scale) {
    const double floor =
        30 * std::max(std::abs(twin.*value - other.*value), std::abs(rounded.*value - other.*value)) + 1e-9 * scale;
    if (std::abs(one.*value - other.*value) > floor) differ(what, one.*value, other.*value);
  };
  const double energies = std::abs(other.loads) + std::abs(other.damping) + std::abs(other.scheme);
  same("impulse", &Ending::impulse, std::abs(other.impulse));
  same("work of loads", &Ending::loads, energies);
  same("work of damping", &Ending::damping, energies);
  same("work of the scheme", &Ending::scheme, energies);
  same("work of contact", &Ending::contact, energies);
  same("work of the law", &Ending::law, energies);
  same("deepest penetration", &Ending::deepest, other.deepest + 1e-6);
  same("normal work", &Ending::normal, other.normal);
  // Else a step's gain is not known of its works.
  if (other.balances) same("largest gain", &Ending::gain, energies + other.first);
  for (std::size_t i = 0; i < std::min(one.rows.size(), other.rows.size()) && result.alike && i < 5; ++i) {
    if (i >= rounded.rows.size()) break;
    const Impact &a = one.rows[i], &b = other.rows[i], &c = rounded.rows[i];
    const auto near = [&](double Impact::*value) {
      const double x = a.*value, y = b.*value, floor = 30 * std::abs(c.*value - y);
      return (std::isnan(x) && std::isnan(y)) || std::isnan(floor) ||
             std::abs(x - y) <= 1e-5 * (1e-3 + std::abs(y)) + floor;
    };
    bool equal = a.point == b.point;
    for (double Impact::*value : {&Impact::time, &Impact::speed_in, &Impact::speed_out, &Impact::impulse,
                                  &Impact::peak_force, &Impact::duration})
      equal = equal && near(value);
    if (!equal) differ(fmt::format("impact {}", i), a.impulse, b.impulse);
  }
  return result;
}

}  // namespace ricochet::testing
