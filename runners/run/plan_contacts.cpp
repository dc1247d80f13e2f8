#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <ricochet/contract/contact_law.hpp>
#include <ricochet/measure/stability/linear_response.hpp>
#include <ricochet/scene/basis/modal_basis.hpp>
#include <ricochet/scene/clearances.hpp>
#include <set>

#include "runners/march/prepare_case.hpp"
#include "runners/run/plan_cases.hpp"
#include "runners/store/fingerprint.hpp"
#include "runners/study/body_keys.hpp"
#include "runners/table/table.hpp"
#include "runners/table/text.hpp"

namespace ricochet {

std::string step_text(double h) {
  constexpr std::size_t longest = 7;
  const std::string text = Cell(h).text();
  return (text.size() > longest ? fmt::format("{:.4g}", h) : text) + " s";
}
namespace {

constexpr std::size_t most_contact_lines = 8;
constexpr int phases = 8;                // of the instant at which a contact begins within a step
constexpr double longest_contact = 2e4;  // steps that are marched

StudyCase with_stiffness(StudyCase one, const std::string& key, double stiffness) {
  one.contact.parameters.set(key, stiffness);
  return one;
}

std::optional<double> stiffness_of(const StudyCase& one, const Registry& registry) {
  const auto law = make_law(one, registry);
  if (law->absent() || !law->reads() || law->changes_problem()) return std::nullopt;
  law->prepare(1, {&one.contact.parameters, 1});
  const auto stiffness = constant_stiffness(*law);
  return stiffness && *stiffness > 0 ? stiffness : std::nullopt;
}

/// A spring that some stops have.
struct StopSpring {
  std::string stop;      ///< whose own it is; empty: of all that have none of their own
  int point = -1;        ///< of it; -1: the last one
  double stiffness = 0;  ///< κ, N/m
};

// The law's κ, then that of each stop with its own; several stops of one κ are told by the first.
std::vector<StopSpring> springs_of(const StudyCase& one, const Registry& registry) {
  const auto law = make_law(one, registry);
  const std::string key = law->parameter_of(ParameterRole::stiffness);
  const std::vector<NamedStop> stops = law->reads() ? with_circles(one.scene.stops).named : one.scene.stops.named;
  std::vector<StopSpring> out;
  int others = stops.empty() ? 1 : 0, last = -1;
  for (std::size_t i = 0; i < stops.size(); ++i)
    if (!stops[i].own.stiffness || key.empty()) {
      ++others;
      last = static_cast<int>(i);
    }
  const bool apart = others < static_cast<int>(stops.size());
  if (others > 0)
    if (const auto stiffness = stiffness_of(one, registry)) out.push_back({"", apart ? last : -1, *stiffness});
  for (std::size_t i = 0; apart && law->per_point() && i < stops.size(); ++i) {
    if (!stops[i].own.stiffness) continue;
    const StudyCase own = with_stiffness(one, key, *stops[i].own.stiffness);
    if (const auto stiffness = stiffness_of(own, registry))
      out.push_back({stops[i].name, static_cast<int>(i), *stiffness});
  }
  return out;
}

// With what the contact law changes; nothing where a value of the scene is missing that only orbits have.
std::optional<SemiDiscrete> problem_of(const StudyCase& one, const Registry& registry) {
  SceneSpec scene = one.scene;
  scene.initial = {};
  try {
    const auto law = make_law(one, registry);
    auto built = discretise(scene, one.elements, *make_mass(one, registry), law.get(), &one.contact.parameters);
    if (auto* problem = std::get_if<SemiDiscrete>(&built)) return std::move(*problem);
  } catch (const InputError&) {
  }
  return std::nullopt;
}

std::optional<ContactSpring> spring_of(const StudyCase& one, const StopSpring& stop, const Registry& registry) {
  const double stiffness = stop.stiffness;
  if (const auto* oscillator = std::get_if<OscillatorSpec>(&one.scene.structure))
    return ContactSpring{stiffness, oscillator->mass,
                         std::sqrt((oscillator->stiffness + stiffness) / oscillator->mass)};
  const auto problem = problem_of(one, registry);
  return problem ? contact_spring(*problem, stiffness, stop.point) : std::nullopt;
}

// A free mass that meets the law at one metre per second.
StudyCase bounce(const StudyCase& one, const ContactSpring& spring, double h, double share) {
  StudyCase thrown = one;
  thrown.scene = SceneSpec{};
  OscillatorSpec free;
  free.mass = spring.stiffness / (spring.pulsation * spring.pulsation);
  thrown.scene.structure = free;
  thrown.scene.stops.lower = Formula(0.0);
  thrown.scene.stops.place = StopsSpec::Place::tip;
  thrown.scene.initial.displacement = Formula((2 + share) * h);
  thrown.scene.initial.velocity = Formula(-1.0);
  thrown.elements = 1;
  thrown.step = h;
  thrown.steps_per_period = 0;
  return thrown;
}

/// The share of its energy that is left after one bounce, least and most over the instants at which it begins. Nothing
/// where it cannot be marched, or does not leave.
std::optional<std::pair<double, double>> left_by(const StudyCase& one, const ContactSpring& spring, double h,
                                                 const Registry& registry) {
  const double steps = std::numbers::pi / (spring.pulsation * h);
  if (steps > longest_contact) return std::nullopt;
  double least = HUGE_VAL, most = 0;
  for (int k = 0; k < phases; ++k) {
    StudyCase thrown = bounce(one, spring, h, (k + 0.5) / phases);
    thrown.duration = h * (2 * steps + 40);
    Prepared prepared = prepare_case(thrown, registry);
    if (!prepared.program) return std::nullopt;
    Marcher marcher(std::move(*prepared.program));
    marcher.start();
    double before = marcher.tip(0), speed = 0;
    for (long long n = marcher.step(); n < prepared.steps; ++n) {
      marcher.march(1);
      const double now = marcher.tip(0);
      speed = (now - before) / h;
      if (speed > 0 && before > 0) break;
      before = now;
    }
    if (!marcher.status(0).running || !(speed > 0 && before > 0)) return std::nullopt;
    least = std::min(least, speed * speed);
    most = std::max(most, speed * speed);
  }
  return std::pair(least, most);
}

std::string loss_percent(double share) {
  return fmt::format("{:.2g}", 100 * share);
}

// "4.1 %", "2.8 to 5.3 %", a gain said as one.
std::string loss_text(double least_left, double most_left) {
  constexpr double round_off = 1e-9;
  const double low = 1 - most_left, high = 1 - least_left;
  if (std::abs(low) < round_off && std::abs(high) < round_off) return "keeps its energy";
  if (low >= -round_off)
    return loss_percent(low) == loss_percent(high)
               ? fmt::format("loses {} % of its energy", loss_percent(high))
               : fmt::format("loses {} to {} % of its energy", loss_percent(std::max(0.0, low)), loss_percent(high));
  if (high <= round_off)
    return loss_percent(low) == loss_percent(high)
               ? fmt::format("gains {} % of its energy", loss_percent(-low))
               : fmt::format("gains {} to {} % of its energy", loss_percent(std::max(0.0, -high)), loss_percent(-low));
  return fmt::format("keeps its energy within {} %", loss_percent(std::max(-low, high)));
}

// "penalty of 1e+06 N/m, implicit": the law with the words among its parameters.
std::string law_text(const MethodChoice& law, double stiffness) {
  std::string text = fmt::format("{} of {:.4g} N/m", law.name, stiffness);
  for (const auto& [key, value] : law.parameters.values())
    if (const auto* word = std::get_if<std::string>(&value)) text += ", " + *word;
  return text;
}

// R κ: what the modes leave out of the flexibility at the stop, against its spring.
std::string left_out_text(const StudyCase& one, const StopSpring& stop, const Registry& registry) {
  if (!one.scene.basis) return "";
  const auto problem = problem_of(one, registry);
  if (!problem || !problem->basis || problem->points() == 0) return "";
  const int point = stop.point < 0 ? problem->points() - 1 : stop.point;
  return fmt::format("; the modes leave out {:.2g} of its depth, Rκ", problem->basis->left_out[point] * stop.stiffness);
}

std::string steps_text(double steps) {
  return steps >= 1000 ? fmt::format("{:.0f}", steps) : fmt::format("{:.3g}", steps);
}

std::string line_of(const StudyCase& given, const StopSpring& stop, double h, const Registry& registry) {
  StudyCase one = given;
  if (!stop.stop.empty())
    one = with_stiffness(given, make_law(given, registry)->parameter_of(ParameterRole::stiffness), stop.stiffness);
  const auto spring = spring_of(one, stop, registry);
  if (!spring) return "";
  const double half = std::numbers::pi / spring->pulsation;
  const double steps = half / h;
  std::string text = fmt::format(
      "    {}{}; {}, h = {}: half a period lasts {}: {} steps", stop.stop.empty() ? "" : "stop " + stop.stop + ", ",
      law_text(one.contact, stop.stiffness), one.time.name, step_text(h), duration_text(half), steps_text(steps));
  if (!std::holds_alternative<OscillatorSpec>(one.scene.structure))
    text += fmt::format(" ({:.3g} kg move)", spring->mass);
  text += left_out_text(one, stop, registry);
  if (const auto left = left_by(one, *spring, h, registry))
    text += "; a bounce " + loss_text(left->first, left->second);
  return text + "\n";
}

double give_way_of(const StudyCase& one, const Registry& registry) {
  const auto make = friction_maker(one, registry);
  return make ? make()->gives_way() : 0;
}

// How the structure swings on a friction law that gives way, along the first tangent of each stop that is no circle.
std::string swings_of(const StudyCase& one, double h, const Registry& registry) {
  const double gives_way = give_way_of(one, registry);
  if (!(gives_way > 0)) return "";
  const auto problem = problem_of(one, registry);
  std::string text;
  for (const RubbingPoint& point : problem ? problem->rubbing : std::vector<RubbingPoint>{}) {
    if (point.round) continue;
    const Eigen::VectorXd along = Eigen::MatrixXd(problem->rubbed.rows).row(point.row).transpose();
    const auto spring = contact_spring(*problem, 1 / gives_way, along);
    if (!spring) continue;
    const double swing = 2 * std::numbers::pi / spring->pulsation;
    text += fmt::format("    stop {}, {} of {:.4g} N/m, h = {}: held, it swings in {}, undamped: {} steps\n",
                        problem->stops[static_cast<std::size_t>(point.point)], one.friction.name, 1 / gives_way,
                        step_text(h), duration_text(swing), steps_text(swing / h));
  }
  return text;
}

std::string lines_of(const StudyCase& one, double h, const Registry& registry) {
  std::string text;
  for (const StopSpring& stop : springs_of(one, registry)) text += line_of(one, stop, h, registry);
  return text;
}

}  // namespace

namespace {

// Of a law of tables, what its first millimetre gives, against the weight of what it moves: a slip of units is seen.
std::string table_line(const StudyCase& one, const Registry& registry) {
  const auto& values = one.contact.parameters.values();
  if (std::none_of(values.begin(), values.end(),
                   [](const auto& value) { return std::holds_alternative<ParameterTable>(value.second); }))
    return "";
  const auto law = make_law(one, registry);
  if (law->absent() || !law->reads() || law->changes_problem()) return "";
  law->prepare(1, {&one.contact.parameters, 1});
  constexpr double millimetre = 1e-3, gravity = 9.81;
  const double stored = law->potential({.depth = millimetre}), force = stored / millimetre;
  const auto spring = spring_of(one, {"", -1, 2 * stored / (millimetre * millimetre)}, registry);
  std::string text = fmt::format("    {}: {:.3g} N over the first mm of depth, in the mean", one.contact.name, force);
  if (spring && force < gravity * spring->mass)
    text += fmt::format("; less than {:.3g} N, the weight of the {:.3g} kg that move: are its rows in m and N?",
                        gravity * spring->mass, spring->mass);
  return text + "\n";
}

}  // namespace

std::string contacts_text(const std::vector<PlannedCase>& cases, const CasePlanner& planner, const Registry& registry) {
  std::set<std::string> met;
  std::string text;
  std::size_t told = 0, more = 0;
  for (const PlannedCase& planned : cases) {
    const StudyCase& one = *planned.study_case;
    const std::string structures = structures_of(one.scene_json).dump(), law = content_of(one.contact).dump();
    const auto say = [&](const std::string& key, const auto& any, const auto& lines) {
      if (!met.insert(key).second) return;
      if (told == most_contact_lines) {
        more += any();
        return;
      }
      const std::string line = planner.ask(one, lines);
      text += line;
      told += !line.empty();
    };
    if (told < most_contact_lines && met.insert(structures + law).second)
      text += planner.ask(one, [&] { return table_line(one, registry); });
    for (const double h : {planned.plan.coarsest_step, planned.plan.finest_step}) {
      if (h <= 0) continue;
      const std::string scene = structures + Cell(h).text();
      say(
          scene + law + content_of(one.time).dump(), [&] { return !springs_of(one, registry).empty(); },
          [&] { return lines_of(one, h, registry); });
      if (!one.friction.name.empty())
        say(
            scene + "friction" + content_of(one.friction).dump(), [&] { return give_way_of(one, registry) > 0; },
            [&] { return swings_of(one, h, registry); });
    }
  }
  if (text.empty()) return text;
  if (more > 0) text += fmt::format("    and {} more contacts\n", more);
  return "  contacts, a mass against the law's spring:\n" + text;
}

}  // namespace ricochet
