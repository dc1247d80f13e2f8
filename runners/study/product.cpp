#include "runners/study/product.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <ricochet/engine/cost_model.hpp>
#include <ricochet/scene/bodies.hpp>
#include <ricochet/scene/semi_discrete.hpp>
#include <ricochet/scene/structure/assembled_structure.hpp>

#include "runners/json/json_text.hpp"
#include "runners/plan_files/plan_file.hpp"
#include "runners/study/body_keys.hpp"
#include "runners/study/case_id.hpp"
#include "runners/study/check_object.hpp"

namespace ricochet {

void Product::refuse_above(std::size_t limit, const std::string& pointer) const {
  if (count() > static_cast<double>(limit))
    throw InputError(
        pointer,
        fmt::format(
            "the lists multiply to {:.10g} combinations; expected at most {}: shorten a list or split the study",
            count(), limit));
}

namespace {

std::uint64_t hash(const std::string& text) {
  std::uint64_t value = 14695981039346656037ULL;
  for (const char c : text) {
    value ^= static_cast<unsigned char>(c);
    value *= 1099511628211ULL;
  }
  // The last bytes reach the high digits of FNV-1a only weakly; this mixing (MurmurHash3, fmix64) spreads them.
  value ^= value >> 33U;
  value *= 0xff51afd7ed558ccdULL;
  value ^= value >> 33U;
  value *= 0xc4ceb9fe1a85ec53ULL;
  value ^= value >> 33U;
  return value;
}

}  // namespace

std::string CaseIds::next(const StudyCase& study_case, const std::string& kind) {
  // nlohmann::json keeps its keys sorted, whatever the order they were given in.
  nlohmann::json all;
  all["kind"] = kind;
  for (const auto& [axis, value] : study_case.axes) all["axes"][axis] = value;
  all["scene"] = study_case.scene_json;
  all["duration"] = study_case.duration;
  all["samples"] = study_case.samples;
  if (!study_case.settings.is_null()) all["settings"] = study_case.settings;
  std::string text = all.dump();
  while (true) {
    std::string id = id_of_today(fmt::format("{:016x}", hash(text)).substr(0, 10));
    const auto [known, fresh] = canonical_.emplace(id, text);
    if (fresh || known->second == text) return id;
    text += '#';
  }
}

namespace {

const Json* axis_value(const StudyCase& study_case, const std::string& axis) {
  for (const auto& [name, value] : study_case.axes)
    if (name == axis) return &value;
  return nullptr;
}

// A list means any of its elements, unless the axis itself has lists for values (positions of stops).
bool matches(const Json& wanted, const Json& value) {
  if (wanted == value) return true;
  return wanted.is_array() && std::find(wanted.begin(), wanted.end(), value) != wanted.end();
}

std::vector<Json> values_of(const Study& study, const std::string& axis) {
  std::vector<Json> values;
  for (const StudyCase& study_case : study.cases)
    if (const Json* value = axis_value(study_case, axis))
      if (std::find(values.begin(), values.end(), *value) == values.end()) values.push_back(*value);
  return values;
}

void check_value(const Study& study, const std::string& axis, const Json& wanted, const std::string& pointer) {
  const std::vector<Json> values = values_of(study, axis);
  if (std::find(values.begin(), values.end(), wanted) != values.end()) return;
  if (wanted.is_array()) {
    if (wanted.empty()) throw InputError(pointer, "an empty list matches nothing");
    for (std::size_t i = 0; i < wanted.size(); ++i) check_value(study, axis, wanted[i], pointer_to(pointer, i));
    return;
  }
  std::string there;
  std::vector<std::string> words;
  for (const Json& value : values) {
    there += (there.empty() ? "" : ", ") + quote(value);
    if (value.is_string()) words.push_back(value.get<std::string>());
  }
  const std::string hint = wanted.is_string() ? did_you_mean(wanted.get<std::string>(), words) : "";
  throw InputError(pointer, "no case has " + axis + " = " + quote(wanted) + hint + " (its values are " + there + ")");
}

void check_entry(const Study& study, const Json& entry, const std::string& pointer) {
  if (!entry.is_object())
    throw InputError(pointer, "expected an object {axis: value, …, \"why\": reason}, found " + quote(entry));
  std::vector<std::string> names = study.columns;
  names.emplace_back("why");
  for (const auto& [key, wanted] : entry.items()) {
    const std::string here = pointer_to(pointer, key);
    if (std::find(names.begin(), names.end(), key) == names.end())
      throw InputError(here, "\"" + shortened(key) + "\" is no axis of this study" + did_you_mean(key, names) +
                                 " (axes: " + quoted_list(study.columns) + ")");
    if (key != "why") check_value(study, key, wanted, here);
  }
  const auto why = entry.find("why");
  if (why == entry.end())
    throw InputError(pointer_to(pointer, "why"), "missing; an exclusion needs its reason, which the report shows");
  if (!why->is_string() || why->get<std::string>().find_first_not_of(" \t\n") == std::string::npos)
    throw InputError(pointer_to(pointer, "why"), "expected the reason as a text, found " + quote(*why));
  if (entry.size() == 1)
    throw InputError(pointer, "names no axis, which would exclude every case; expected at least one axis");
}

}  // namespace

void apply_excludes(const Json& excludes, Study& study) {
  if (!excludes.is_array())
    throw InputError("/exclude",
                     "expected a list of objects {axis: value, …, \"why\": reason}, found " + quote(excludes));
  for (std::size_t i = 0; i < excludes.size(); ++i) {
    const std::string pointer = pointer_to("/exclude", i);
    check_entry(study, excludes[i], pointer);
    bool any = false;
    for (StudyCase& study_case : study.cases) {
      bool all = true;
      for (const auto& [key, wanted] : excludes[i].items()) {
        if (key == "why") continue;
        const Json* value = axis_value(study_case, key);
        all = all && value && matches(wanted, *value);
      }
      if (all && !study_case.excluded) study_case.excluded = excludes[i].at("why").get<std::string>();
      any = any || all;
    }
    if (!any) throw InputError(pointer, "no case has all of these values together: the exclusion matches nothing");
  }
  if (std::all_of(study.cases.begin(), study.cases.end(),
                  [](const StudyCase& study_case) { return study_case.excluded.has_value(); }))
    throw InputError("/exclude", "every case is excluded; nothing would run");
}

namespace {

const char* role_phrase(Role role) {
  switch (role) {
    case Role::mass:
      return "mass strategy";
    case Role::contact:
      return "contact law";
    case Role::friction:
      return "friction law";
    case Role::time:
      return "time scheme";
    case Role::reference:
      break;
  }
  return "reference";
}

const PluginManual& require_method(Role role, const std::string& name, const std::string& pointer, Catalogue& catalogue,
                                   Registry& registry) {
  if (catalogue.require(role, name, registry)) return *registry.manual(role, name);
  std::vector<std::string> names = catalogue.names(role);
  for (const std::string& known : registry.names(role))
    if (std::find(names.begin(), names.end(), known) == names.end()) names.push_back(known);
  std::string message = std::string("no plugin provides the ") + role_phrase(role) + " \"" + shortened(name) + "\"" +
                        did_you_mean(name, names);
  message += names.empty() ? " (no " + std::string(role_phrase(role)) +
                                 " was found at all; `ricochet doctor` shows the plugin folders)"
                           : " (found: " + quoted_list(names) + ")";
  message += "; " + where_looked(catalogue);
  // The file is the fault, not the study, where one that cannot serve is meant for this method. Also where it tells
  // nothing of itself and no name is near.
  const Unusable* meant = catalogue.unusable_provider(role, name);
  std::vector<const Unusable*> suspects;
  for (const Unusable& file : catalogue.unusable())
    if (meant ? &file == meant : file.meant.empty()) suspects.push_back(&file);
  const bool near = !nearest_name(name, names).empty();
  if (suspects.empty()) throw MissingMethod(pointer, message, near);
  if (!meant && near)
    throw MissingMethod(pointer, message + "; `ricochet doctor` tells of plugin files that cannot serve", near);
  message =
      "at " + pointer + ": " + message +
      (suspects.size() == 1 ? "; this file was found and cannot serve:" : "; these files were found and cannot serve:");
  for (const Unusable* file : suspects) message += "\n  " + file->file.string() + ": " + file->reason;
  throw PluginError(message);
}

Json as_object(const Json& entry, const std::string& pointer) {
  if (entry.is_string()) return Json{{"name", entry}};
  if (!entry.is_object())
    throw InputError(pointer,
                     "expected the name of a method or an object {\"name\": …, parameters}, found " + quote(entry));
  return entry;
}

std::string name_of(const Json& entry, const std::string& pointer) {
  const auto name = entry.find("name");
  if (name == entry.end()) {
    for (const auto& [key, ignored] : entry.items())
      if (nearest_name(key, {"name"}) == "name")
        throw InputError(pointer_to(pointer, key), "unknown key \"" + shortened(key) + "\"; did you mean \"name\"?");
    throw InputError(pointer_to(pointer, "name"), "missing; a method needs the name of its plugin");
  }
  if (!name->is_string())
    throw InputError(pointer_to(pointer, "name"), "expected the name of one method, found " + quote(*name));
  return name->get<std::string>();
}

}  // namespace

MethodOptions read_methods(Role role, const Json& value, const std::string& pointer, Catalogue& catalogue,
                           Registry& registry, const std::filesystem::path& folder) {
  MethodOptions result;
  result.resolved = Json::array();
  const bool list = value.is_array();
  if (list && value.empty())
    throw InputError(pointer, "an empty list makes no cases; name at least one " + std::string(role_phrase(role)));
  const std::size_t count = list ? value.size() : 1;
  for (std::size_t i = 0; i < count; ++i) {
    const std::string here = list ? pointer_to(pointer, i) : pointer;
    const Json& given = list ? value[i] : value;
    Json entry = as_object(given, here);
    std::optional<PlanSource> plan;
    if (role == Role::time) plan = take_stated_plan(entry, here, folder, result.resolved, catalogue, registry);
    const std::string name = name_of(entry, here);
    const PluginManual& manual =
        require_method(role, name, given.is_object() ? pointer_to(here, "name") : here, catalogue, registry);
    std::vector<Axis> axes;
    Json complete = check_object(method_form(manual), entry, here, axes);
    std::shared_ptr<const std::string> content;
    if (plan) {
      content = std::make_shared<const std::string>(plan->plan.dump());
      complete["plan"] = std::move(plan->plan);
    }
    result.resolved.push_back(complete);

    Product product;
    for (const Axis& axis : axes) product.add(axis.values.size());
    product.refuse_above(largest_study, here);
    for (; !product.ended(); product.next()) {
      MethodOption option;
      option.choice.name = name;
      option.choice.plan = content;
      option.places.push_back(here);
      option.axes.emplace_back(role_name(role), name);
      Json scalars = complete;
      for (std::size_t a = 0; a < axes.size(); ++a) {
        const std::string key = axes[a].pointer.substr(here.size() + 1);
        scalars[key] = axes[a].values[product[a]];
        option.places.push_back(pointer_to(axes[a].pointer, product[a]));
      }
      for (const ParameterSpec& spec : manual.parameters) {
        option.axes.emplace_back(std::string(role_name(role)) + "." + spec.key, scalars[spec.key]);
        option.choice.parameters.set(spec.key, to_value(spec, scalars[spec.key]));
      }
      result.options.push_back(std::move(option));
    }
  }
  return result;
}

std::vector<std::optional<BasisSpec>> bases_of(const Json& mesh, const Json& scene, bool modal) {
  if (!mesh.contains("modes") && !mesh.contains("residual")) return {std::nullopt};
  if (!mesh.contains("modes") && !modal)
    throw InputError("/mesh/residual", "there is no mesh.modes whose residual it could be; expected modes too");
  std::vector<std::optional<BasisSpec>> bases;
  const Json counts = mesh.value("modes", Json(nullptr));
  for (const Json& modes : counts.is_array() ? counts : Json::array({counts}))
    for (const std::string& residual : one_or_each<std::string>(mesh.value("residual", Json("stops"))))
      if (modes.is_object()) {
        const std::vector<int> each = of_bodies(modes, scene, "/mesh/modes");
        if (std::find(each.begin(), each.end(), 0) != each.end())
          throw InputError("/mesh/modes", "says no number for one of the bodies; expected one for each");
        bases.push_back(BasisSpec{std::accumulate(each.begin(), each.end(), 0), residual == "stops", each});
      } else if (!modes.is_null())
        bases.push_back(BasisSpec{modes.get<int>(), residual == "stops"});
      else if (modal && residual != "stops")
        bases.push_back(BasisSpec{0, false});
      else if (std::find(bases.begin(), bases.end(), std::nullopt) == bases.end())
        bases.emplace_back();
  return bases;
}

void check_bases(const std::vector<std::optional<BasisSpec>>& bases, const Json& mesh, const StructureSpec& structure,
                 int coarsest) {
  const bool any = std::any_of(bases.begin(), bases.end(), [](const auto& basis) { return basis.has_value(); });
  const int dofs = any ? make_space(structure, coarsest).dofs : 0;
  if (any && bodies_of(structure)) return;  // told by the body that has fewer
  for (const std::optional<BasisSpec>& basis : bases) {
    if (!basis || basis->modes <= dofs) continue;
    const Json& counts = mesh.at("modes");
    std::string pointer = "/mesh/modes";
    for (std::size_t i = 0; counts.is_array() && i < counts.size(); ++i)
      if (counts[i] == basis->modes) pointer = pointer_to("/mesh/modes", i);
    throw InputError(
        pointer,
        fmt::format("{} modes; the structure has {} degrees of freedom{}", basis->modes, dofs,
                    std::holds_alternative<AssembledSpec>(structure) ? "" : fmt::format(" on {} elements", coarsest)));
  }
}

void check_size(const StructureSpec& structure) {
  constexpr int most_dofs = 100000;
  const auto* spec = std::get_if<AssembledSpec>(&structure);
  if (!spec || spec->structure->dofs() <= most_dofs) return;
  const int n = spec->structure->dofs();
  SemiDiscrete problem;
  const JoinedBodies* bodies = bodies_of(structure);
  problem.space = make_space(structure, bodies ? bodies->mesh : 1);
  problem.stiffness = spec->structure->stiffness;
  problem.inertia.mass = spec->structure->mass;
  problem.position = Eigen::VectorXd::Zero(n);
  problem.contact.resize(0, n);
  const double seconds = std::min(predict_cost(OperatorKind::band, problem, {}, 1).step_seconds,
                                  predict_cost(OperatorKind::sparse, problem, {}, 1).step_seconds);
  throw InputError("/scene/structure",
                   fmt::format("{} dofs without mesh.modes: a time integration takes {:.2g} s per step; "
                               "expected at most {}, or mesh.modes",
                               n, seconds, most_dofs));
}

}  // namespace ricochet
