#include "runners/run/forecast.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "runners/kinds/kind.hpp"
#include "runners/store/fingerprint.hpp"

namespace ricochet {
namespace {

// Processor time of a run that is no case's: the program and its plugins opened, the report written; and of each case:
// its fingerprint, its row in the store, its curve, its share of tables and page.
constexpr double each_run = 0.15, each_case = 1.6e-3;

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
    const double set_up = (alike.insert(cost_key(*one.study_case)).second ? 2 : 1) * one.plan_seconds;
    const double chain = one.plan.chain_seconds > 0 ? one.plan.chain_seconds : one.plan.predicted_seconds;
    found.chain = std::max(found.chain, chain + set_up);
    found.bytes += one.plan.bytes;
    one.plan.predicted_seconds += set_up;
    found.seconds += one.plan.predicted_seconds;
  }
  if (kind.works_beside()) {
    ForecastContext context{study, registry, {}, [&](const StudyCase& one) {
                              const auto step = steps.find(&one);
                              return step == steps.end() ? 0 : step->second;
                            }};
    for (const PlannedCase& one : cases) context.cases.push_back(one.study_case);
    found.beside = kind.beside(context);
    found.seconds += found.beside;
  }
  found.seconds += each_run + each_case * static_cast<double>(cases.size());
  return found;
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
