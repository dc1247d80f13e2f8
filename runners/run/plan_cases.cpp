#include "runners/run/plan_cases.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <ricochet/contract/contact_law.hpp>
#include <ricochet/loader/child.hpp>
#include <ricochet/measure/stability/contact_spring.hpp>
#include <set>

#include "runners/march/prepare_case.hpp"
#include "runners/march/seconds.hpp"
#include "runners/run/run_study.hpp"
#include "runners/store/fingerprint.hpp"
#include "runners/table/table.hpp"
#include "runners/table/text.hpp"

namespace ricochet {
namespace {

using Json = nlohmann::ordered_json;
using Method = std::pair<std::string, std::string>;  // role, name

// A large mesh may take its time; a plugin that is not done by then never is.
constexpr double longest_plan = 60;

std::array<Method, 3> methods_of(const StudyCase& study_case) {
  return {Method{role_name(Role::mass), study_case.mass.name},
          Method{role_name(Role::contact), study_case.contact.name},
          Method{role_name(Role::time), study_case.time.name}};
}

std::string to_text(const CasePlan& plan) {
  return Json{{"refusal", plan.refusal},
              {"operator", plan.operator_name},
              {"steps", plan.steps},
              {"seconds", plan.predicted_seconds},
              {"left_out", plan.left_out},
              {"notes", plan.notes},
              {"coarsest", plan.coarsest_step},
              {"finest", plan.finest_step},
              {"chain", plan.chain_seconds},
              {"bytes", plan.bytes}}
      .dump(-1, ' ', false, Json::error_handler_t::replace);
}

CasePlan from_text(const Json& json) {
  CasePlan plan;
  json.at("refusal").get_to(plan.refusal);
  json.at("operator").get_to(plan.operator_name);
  json.at("steps").get_to(plan.steps);
  // JSON has no infinity: a cost that cannot be told is null.
  if (json.at("seconds").is_number()) json.at("seconds").get_to(plan.predicted_seconds);
  json.at("left_out").get_to(plan.left_out);
  json.at("notes").get_to(plan.notes);
  json.at("coarsest").get_to(plan.coarsest_step);
  json.at("finest").get_to(plan.finest_step);
  if (json.at("chain").is_number()) json.at("chain").get_to(plan.chain_seconds);
  if (json.at("bytes").is_number()) json.at("bytes").get_to(plan.bytes);
  return plan;
}

}  // namespace

bool CasePlanner::uses_foreign(const StudyCase& study_case) const {
  for (const auto& [role, name] : {std::pair(Role::mass, study_case.mass.name),
                                   {Role::contact, study_case.contact.name},
                                   {Role::time, study_case.time.name}})
    if (const std::string file = registry_.file(role, name); !file.empty() && catalogue_.foreign(file)) return true;
  return false;
}

PlanOutcome CasePlanner::plan(const StudyCase& study_case) {
  const double begin = thread_seconds();
  PlanOutcome outcome = planned(study_case);
  outcome.seconds = thread_seconds() - begin;
  return outcome;
}

PlanOutcome CasePlanner::planned(const StudyCase& study_case) {
  if (uses_foreign(study_case)) return plan_in_child(study_case);
  try {
    return {.plan = plan_for(study_.kind, study_case, registry_), .failure = ""};
  } catch (const InputError&) {
    throw;
  } catch (const std::bad_alloc&) {
    return {.plan = {}, .failure = "not enough memory"};
  } catch (const std::exception& error) {
    return {.plan = {}, .failure = error.what()};
  }
}

std::string CasePlanner::ask(const StudyCase& study_case, const std::function<std::string()>& question) const {
  if (uses_foreign(study_case)) {
    const ChildOutcome outcome = run_in_child(question, longest_plan);
    return outcome.ok() ? outcome.text : "";
  }
  try {
    return question();
  } catch (const std::exception&) {
    return "";
  }
}

PlanOutcome CasePlanner::plan_in_child(const StudyCase& study_case) {
  for (const Method& method : methods_of(study_case))
    if (const auto found = endless_.find(method); found != endless_.end())
      return {.plan = {}, .failure = found->second};
  const ChildOutcome outcome = run_in_child(
      [&] {
        try {
          return to_text(plan_for(study_.kind, study_case, registry_));
        } catch (const InputError& error) {
          return Json{{"pointer", error.pointer()}, {"wrong", error.what()}}.dump(-1, ' ', false,
                                                                                  Json::error_handler_t::replace);
        }
      },
      longest_plan);
  if (!outcome.ok()) {
    const std::string sentence = outcome.sentence();
    if (outcome.end == ChildOutcome::End::timeout && !outcome.function.empty())
      endless_[{outcome.plugin.role, outcome.plugin.name}] =
          sentence + " in case " + study_case.id + "; not tried again";
    return {.plan = {}, .failure = sentence};
  }
  const Json json = Json::parse(outcome.text);
  if (json.contains("wrong")) throw InputError(json["pointer"].get<std::string>(), json["wrong"].get<std::string>());
  return {.plan = from_text(json), .failure = ""};
}

namespace {

constexpr std::size_t most_contact_lines = 8;
constexpr int most_dofs = 240;           // of a dense problem of eigenvalues
constexpr int phases = 8;                // of the instant at which a contact begins within a step
constexpr double longest_contact = 2e4;  // steps that are marched

std::optional<double> stiffness_of(const StudyCase& one, const Registry& registry) {
  const auto law = make_law(one, registry);
  if (law->absent() || !law->reads() || law->changes_problem()) return std::nullopt;
  law->prepare(1, {&one.contact.parameters, 1});
  const auto stiffness = constant_stiffness(*law);
  return stiffness && *stiffness > 0 ? stiffness : std::nullopt;
}

std::optional<ContactSpring> spring_of(const StudyCase& one, double stiffness, const Registry& registry) {
  if (const auto* oscillator = std::get_if<OscillatorSpec>(&one.scene.structure))
    return ContactSpring{stiffness, oscillator->mass,
                         std::sqrt((oscillator->stiffness + stiffness) / oscillator->mass)};
  SceneSpec scene = one.scene;
  scene.initial = {};
  try {
    const auto law = make_law(one, registry);
    const auto built = discretise(scene, one.elements, *make_mass(one, registry), law.get(), &one.contact.parameters);
    const auto* problem = std::get_if<SemiDiscrete>(&built);
    return problem && problem->dofs() <= most_dofs ? contact_spring(*problem, stiffness) : std::nullopt;
  } catch (const InputError&) {  // a value of the scene that none of its orbits has
    return std::nullopt;
  }
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

/// The energy that is left of one bounce, least and most over the instants at which it begins; nothing where it cannot
/// be marched, or does not leave.
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

std::string line_of(const StudyCase& one, double h, const Registry& registry) {
  const auto stiffness = stiffness_of(one, registry);
  if (!stiffness) return "";
  const auto spring = spring_of(one, *stiffness, registry);
  if (!spring) return "";
  const double half = std::numbers::pi / spring->pulsation;
  const double steps = half / h;
  std::string text = fmt::format("    {}; {}, h = {} s: half a period lasts {}: {} steps",
                                 law_text(one.contact, *stiffness), one.time.name, Cell(h).text(), duration_text(half),
                                 steps >= 1000 ? fmt::format("{:.0f}", steps) : fmt::format("{:.3g}", steps));
  if (!std::holds_alternative<OscillatorSpec>(one.scene.structure))
    text += fmt::format(" ({:.3g} kg move)", spring->mass);
  if (const auto left = left_by(one, *spring, h, registry))
    text += "; a bounce " + loss_text(left->first, left->second);
  return text + "\n";
}

}  // namespace

std::string contacts_text(const std::vector<PlannedCase>& cases, const CasePlanner& planner, const Registry& registry) {
  std::set<std::string> met;
  std::string text;
  std::size_t told = 0, more = 0;
  for (const PlannedCase& planned : cases) {
    const StudyCase& one = *planned.study_case;
    for (const double h : {planned.plan.coarsest_step, planned.plan.finest_step}) {
      if (h <= 0) continue;
      const std::string key = one.scene_json.at("structure").dump() + content_of(one.contact).dump() +
                              content_of(one.time).dump() + Cell(h).text();
      if (!met.insert(key).second) continue;
      if (told == most_contact_lines) {
        more += stiffness_of(one, registry).has_value();
        continue;
      }
      const std::string line = planner.ask(one, [&] { return line_of(one, h, registry); });
      text += line;
      told += !line.empty();
    }
  }
  if (text.empty()) return text;
  if (more > 0) text += fmt::format("    and {} more contacts\n", more);
  return "  contacts, a mass against the law's spring:\n" + text;
}

}  // namespace ricochet
