// The errors that asks name.
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "runners/asks/kind_verbs.hpp"
#include "runners/json/json_text.hpp"
#include "runners/kinds/comparison/comparison.hpp"
#include "runners/kinds/comparison/comparison_answers.hpp"

namespace ricochet {

std::string short_error_words(const std::string& error) {
  const std::string words = error_words(error), plain = "the error of ", the = "the ";
  const std::string rest = words.substr(words.starts_with(plain) ? plain.size() : 0);
  return rest.starts_with(the) ? rest.substr(the.size()) : rest;
}

std::vector<std::string> reference_words(const Cases& cases) {
  std::size_t of_the_mesh = 0, of_rigid_stops = 0, done = 0;
  for (const CaseRecord* one : cases) {
    if (one->status != Status::done) continue;
    ++done;
    of_the_mesh += measure(*one, "reference_of_mesh").value_or(0) > 0 ? 1 : 0;
    of_rigid_stops += measure(*one, "reference_of_law").value_or(1) > 0 ? 0 : 1;
  }
  std::vector<std::string> out;
  if (of_rigid_stops > 0)
    out.push_back(fmt::format("Errors{} are against rigid stops: what the springs of the law add is in them.",
                              of_rigid_stops < done ? fmt::format(" of {} of {} cases", of_rigid_stops, done) : ""));
  if (of_the_mesh > 0)
    out.emplace_back("Errors are against the same mesh and mass: the error of the mesh is not in them.");
  return out;
}

std::string error_name(std::string asked) {
  if (asked.starts_with("error.")) asked.erase(0, 6);
  std::replace(asked.begin(), asked.end(), '_', '-');
  return asked;
}

void check_error_ask(const Study& study, const Json& keys, const std::string& pointer) {
  const asks::Ask ask = asks::ask_at(keys, pointer);
  asks::refuse_stops(ask);
  const std::string error = error_name(ask.subject());
  const auto computed = study.resolved.at("errors").get<std::vector<std::string>>();
  const auto among = [&](const std::vector<std::string>& list) {
    return std::find(list.begin(), list.end(), error) != list.end();
  };
  if (!among(computed))
    throw InputError(pointer, (among(error_names())
                                   ? fmt::format("{} is no error of this study; add it to \"errors\", or ask one of {}",
                                                 quote(error), quoted_list(computed))
                                   : fmt::format("no error is called {}; expected one of {}", quote(ask.subject()),
                                                 quoted_list(computed))) +
                                  did_you_mean(error, computed));
  if (ask.verb->name != std::string("order")) return;
  std::set<double> steps;
  std::set<int> meshes;
  for (const StudyCase& one : study.cases) {
    steps.insert(one.step);
    meshes.insert(one.elements);
  }
  constexpr std::size_t least = 3;
  if (steps.size() < least && meshes.size() < least)
    throw InputError(pointer,
                     fmt::format("an order shows from three steps or three meshes on; this study has {} and {}",
                                 steps.size(), meshes.size()));
}

Json default_order_asks(const Json& resolved) {
  constexpr std::size_t least = 3;
  const auto levels = [](const Json& value) { return value.is_array() ? value.size() : 1; };
  const Json elements = resolved.contains("mesh") ? resolved["mesh"].value("elements", Json(1)) : Json(1);
  const bool sizes = !resolved.contains("step") || levels(resolved["step"]) >= least || levels(elements) >= least;
  Json out = Json::array();
  for (const Json& error : resolved.contains("errors") ? resolved["errors"] : Json(error_names()))
    out.push_back(sizes ? Json({{"order", error}}) : Json({{"value", "error." + error.get<std::string>()}}));
  return out;
}

Json default_cheapest_asks(const Json& resolved) {
  const Json errors = resolved.contains("errors") ? resolved["errors"] : Json(error_names());
  const bool largest = std::find(errors.begin(), errors.end(), "tip-linf") != errors.end();
  const Json error = largest || errors.empty() ? Json("tip-linf") : errors.front();
  constexpr double per_cent = 0.01, per_mille = 0.001;
  Json out = Json::array();
  for (const double share : {per_cent, per_mille}) out.push_back({{"cheapest", error}, {"within", share}});
  if (const Json compare = resolved.contains("compare") ? resolved["compare"] : Json();
      compare.is_string() && compare != "all")
    out.push_back({{"effect", compare}, {"on", "timed_seconds"}});
  return out;
}

}  // namespace ricochet
