#include "runners/run/plan_cases.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <charconv>
#include <exception>
#include <limits>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <ricochet/loader/child.hpp>
#include <set>

#include "runners/json/json_text.hpp"
#include "runners/kinds/kind.hpp"
#include "runners/march/prepare_case.hpp"
#include "runners/march/seconds.hpp"
#include "runners/run/on_threads.hpp"
#include "runners/run/run_study.hpp"
#include "runners/store/fingerprint.hpp"
#include "runners/table/text.hpp"

namespace ricochet {
namespace {

using Method = std::pair<std::string, std::string>;  // role, name

// A large mesh may take its time; a plugin that is not done by then never is.
constexpr double longest_plan = 60;

std::vector<Method> named_methods(const StudyCase& study_case) {
  std::vector<Method> all;
  for (const auto& [role, method] : methods_of(study_case)) all.emplace_back(role_name(role), method->name);
  return all;
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
              {"trial", plan.trial_seconds},
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
  json.at("trial").get_to(plan.trial_seconds);
  if (json.at("bytes").is_number()) json.at("bytes").get_to(plan.bytes);
  return plan;
}

}  // namespace

bool CasePlanner::uses_foreign(const StudyCase& study_case) const {
  std::vector<std::pair<Role, std::string>> used;
  for (const auto& [role, method] : methods_of(study_case)) used.emplace_back(role, method->name);
  for (const MethodChoice& reference : study_case.references) used.emplace_back(Role::reference, reference.name);
  return std::any_of(used.begin(), used.end(),
                     [&](const auto& one) { return catalogue_.foreign(registry_.file(one.first, one.second)); });
}

PlanOutcome CasePlanner::plan(const StudyCase& study_case) {
  const double begin = thread_seconds();
  PlanOutcome outcome = planned(study_case);
  outcome.seconds = thread_seconds() - begin;
  return outcome;
}

std::vector<PlanOutcome> CasePlanner::plan_all(const std::vector<StudyCase>& cases, int at_once,
                                               const std::function<void(std::size_t)>& done) {
  std::vector<PlanOutcome> outcomes(cases.size());
  std::atomic<std::size_t> next{0}, planned{0};
  std::atomic<bool> stop{false};
  std::mutex failing;
  std::map<std::size_t, std::exception_ptr> failures;
  const auto plan_one = [&](std::size_t i) {
    try {
      outcomes[i] = plan(cases[i]);
      done(++planned);
    } catch (...) {
      const std::lock_guard guard(failing);
      failures[i] = std::current_exception();
      stop = true;
    }
  };
  std::vector<char> foreign(cases.size(), 0);
  on_threads(at_once, [&] {
    for (std::size_t i = next++; i < cases.size() && !stop; i = next++) {
      if (cases[i].excluded) continue;
      foreign[i] = uses_foreign(cases[i]) ? 1 : 0;
      if (foreign[i] == 0) plan_one(i);
    }
  });
  // A process is not forked while others of its threads are at work.
  for (std::size_t i = 0; i < cases.size() && !stop; ++i)
    if (foreign[i] != 0) plan_one(i);
  if (!failures.empty()) std::rethrow_exception(failures.begin()->second);
  return outcomes;
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
  for (const Method& method : named_methods(study_case))
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
      // A budget is what a case may take at all; a child takes some of a second to begin.
      std::min(longest_plan, std::max(1.0, budget_of(study_case))));
  if (!outcome.ok()) {
    const std::string sentence = outcome.sentence();
    if (outcome.end == ChildOutcome::End::timeout && outcome.call.serial != 0)
      endless_[{outcome.call.plugin.role, outcome.call.plugin.name}] =
          sentence + " in case " + study_case.id + "; not tried again";
    return {.plan = {}, .failure = sentence};
  }
  const Json json = Json::parse(outcome.text);
  if (json.contains("wrong")) throw InputError(json["pointer"].get<std::string>(), json["wrong"].get<std::string>());
  return {.plan = from_text(json), .failure = ""};
}

namespace {

// Processor time of a run that is no case's: the program and its plugins opened, the report written. And of each case:
// its fingerprint, its row in the store, its share of tables and page; and of each byte of its results, which are
// stored, read and written.
constexpr double each_run = 0.15, each_case = 1.6e-3, each_byte = 2.5e-8;

double seconds_around(const CasePlan& plan) {
  return each_case + each_byte * plan.bytes;
}

double modelled_step(const CasePlan& plan) {
  return plan.steps > 0 ? plan.predicted_seconds / static_cast<double>(plan.steps) : 0;
}

}  // namespace

Forecast forecast(const Study& study, std::vector<PlannedCase>& cases, const Registry& registry) {
  const Kind& kind = *find_kind(study.kind);
  Forecast found;
  std::map<const StudyCase*, double> steps;
  std::set<std::string> alike;
  for (PlannedCase& one : cases) {
    steps[one.study_case] = modelled_step(one.plan);
    // Prepared by the run, which plans one of cases that are alike once more.
    const double again = alike.insert(cost_key(*one.study_case)).second ? one.plan_seconds : 0,
                 set_up = again + std::max(0.0, one.plan_seconds - one.plan.trial_seconds);
    const double chain = one.plan.chain_seconds > 0 ? one.plan.chain_seconds : one.plan.predicted_seconds;
    found.chain = std::max(found.chain, chain + set_up + seconds_around(one.plan));
    found.bytes += one.plan.bytes;
    found.seconds += seconds_around(one.plan);
    one.plan.predicted_seconds += set_up;
    found.seconds += one.plan.predicted_seconds;
  }
  if (kind.works_beside()) {
    ForecastContext context{study, registry, {}, [&](const StudyCase& one) {
                              const auto step = steps.find(&one);
                              return step == steps.end() ? 0 : step->second;
                            }};
    for (const PlannedCase& one : cases) context.cases.push_back(one.study_case);
    // It asks methods that may be anybody's: one that goes wrong is told in the rows of its cases.
    const ChildOutcome beside =
        run_in_child([&] { return fmt::format("{}", kind.beside(context)); }, std::numeric_limits<double>::infinity());
    if (beside.ok()) std::from_chars(beside.text.data(), beside.text.data() + beside.text.size(), found.beside);
    found.seconds += found.beside;
  }
  found.fixed = each_run;
  found.seconds += each_run;
  return found;
}

double Forecast::on(int processors) const {
  return std::min(seconds, fixed + beside + std::max(work() / processors, chain));
}

namespace {

void add_form(const Json& value, std::string& text) {
  if (value.is_number()) {
    text += value.get<double>() == 0 ? "0" : "1";
  } else if (value.is_string()) {
    text += '"' + value.get_ref<const std::string&>() + '"';
  } else if (value.is_structured()) {
    text += value.is_object() ? '{' : '[';
    for (const Json& one : value) {
      add_form(one, text);
      text += ',';
    }
    text += value.is_object() ? '}' : ']';
  } else {
    text += value.dump();
  }
}

std::string text_of(const MethodChoice& method) {
  return content_of(method).dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

std::string cost_key(const StudyCase& study_case) {
  // The keys of a scene are complete and in one order: its values tell it.
  std::string key;
  add_form(study_case.scene_json, key);
  for (const MethodChoice* method : {&study_case.mass, &study_case.contact, &study_case.time}) key += text_of(*method);
  for (const MethodChoice& reference : study_case.references) key += text_of(reference);
  return key +
         fmt::format("{}/{}/{}/{}/{}/{}/", study_case.elements, study_case.step, study_case.steps_per_period,
                     study_case.duration, study_case.samples, study_case.march) +
         study_case.settings.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace ricochet
