#include "runners/study/load_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <ricochet/scene/bodies.hpp>
#include <ricochet/scene/semi_discrete.hpp>

#include "runners/json/json_text.hpp"
#include "runners/study/axis_meaning.hpp"
#include "runners/study/body_keys.hpp"
#include "runners/study/case_axes.hpp"
#include "runners/study/check_object.hpp"
#include "runners/study/histories.hpp"
#include "runners/study/read_scene.hpp"
#include "runners/study/scene_keys.hpp"
#include "runners/study/study_kind.hpp"

namespace ricochet {
namespace {

/// Refuses a comparison of what has one level, or of what the study does not have.
void check_compare(const Study& study) {
  const auto asked = study.resolved.find("compare");
  if (asked == study.resolved.end()) return;
  const std::string name = asked->get<std::string>();
  if (name.empty() || name == "all") return;
  std::vector<std::string> varying, known = {"all"};
  const auto add = [](std::vector<std::string>& list, const std::string& one) {
    if (std::find(list.begin(), list.end(), one) == list.end()) list.push_back(one);
  };
  for (const std::string& column : study.columns) {
    add(known, axis_role(column));
    add(known, column);
    const auto value = [&](const StudyCase& one) {
      for (const auto& [axis, level] : one.axes)
        if (axis == column) return level;
      return Json(nullptr);
    };
    const Json first = study.cases.empty() ? Json(nullptr) : value(study.cases.front());
    if (std::all_of(study.cases.begin(), study.cases.end(), [&](const StudyCase& one) { return value(one) == first; }))
      continue;
    add(varying, axis_role(column));
    add(varying, column);
  }
  if (std::find(varying.begin(), varying.end(), name) != varying.end()) return;
  const std::string choices =
      varying.empty() ? "no choice varies" : fmt::format("expected one of {}", fmt::join(varying, ", "));
  if (std::find(known.begin(), known.end(), name) != known.end())
    throw InputError("/compare",
                     fmt::format("\"{}\" has one level in this study, so nothing is compared; {}", name, choices));
  const std::string nearest = nearest_name(name, varying);
  throw InputError("/compare", fmt::format("no choice of this study is called \"{}\"; {}{}", name, choices,
                                           nearest.empty() ? "" : fmt::format("; did you mean \"{}\"?", nearest)));
}

// More steps than any machine marches: beyond, the ratio is a slip of units.
constexpr double most_steps = 1e12;

void check_name(const std::string& name) {
  const auto allowed = [](unsigned char c) { return std::isalnum(c) || c == '-' || c == '_' || c == '.'; };
  if (name.empty() || name.size() > 100 || !std::isalnum(static_cast<unsigned char>(name[0])) ||
      !std::all_of(name.begin(), name.end(), allowed))
    throw InputError("/name",
                     "expected a name that can be a folder: 1 to 100 letters, digits, '-', '_' or '.', the first a "
                     "letter or a digit; found " +
                         quote(name));
}

std::string element_pointer(const Json& value, const std::string& pointer, std::size_t index) {
  return value.is_array() ? pointer_to(pointer, index) : pointer;
}

void check_steps(const Json& steps, double duration) {
  const std::vector<double> values = one_or_each<double>(steps);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::string pointer = element_pointer(steps, "/step", i);
    if (values[i] > duration)
      throw InputError(pointer, fmt::format("a step of {} s is longer than the duration of {} s", values[i], duration));
    if (duration / values[i] > most_steps)
      throw InputError(pointer, fmt::format("{} s in steps of {} s would take {:.3g} steps; expected at most {:g}",
                                            duration, values[i], duration / values[i], most_steps));
  }
}

// An oscillator has one dof whatever the mesh: its study need not speak of one. Any other must.
void require_mesh(const Json& study) {
  if (!study.is_object() || !study.contains("scene") || !has_structure(study.at("scene"), {"beam", "bar"})) return;
  if (!study.contains("mesh")) throw InputError("/mesh", "missing; this key is required");
  if (!study.at("mesh").contains("elements")) throw InputError("/mesh/elements", "missing; this key is required");
}

// References: plugins, or the method itself marched finer.
std::vector<MethodChoice> read_references(Json& resolved, const std::string& pointer, Catalogue& catalogue,
                                          Registry& registry) {
  if (!resolved.is_array()) resolved = Json::array({resolved});
  if (resolved.empty()) throw InputError(pointer, "an empty list; expected at least one reference");
  std::vector<MethodChoice> choices;
  Json complete = Json::array();
  for (std::size_t i = 0; i < resolved.size(); ++i) {
    const Json& entry = resolved[i];
    const std::string here = pointer_to(pointer, i);
    if (entry == marched_reference ||
        (entry.is_object() && entry.size() == 1 && entry.value("name", "") == marched_reference)) {
      choices.push_back({marched_reference, {}});
      complete.push_back(marched_reference);
    } else {
      if (entry.is_string() && !nearest_name(entry.get<std::string>(), {marched_reference}).empty())
        throw InputError(here, "no plugin provides the reference " + quote(entry) + "; did you mean \"" +
                                   std::string(marched_reference) + "\"?");
      const MethodOptions options = read_methods(Role::reference, entry, here, catalogue, registry);
      if (options.options.size() != 1) throw InputError(here, "a list of parameters; expected one reference");
      choices.push_back(options.options.front().choice);
      complete.push_back(options.resolved.front());
    }
    for (std::size_t j = 0; j < i; ++j)
      if (complete[j] == complete[i]) throw InputError(here, "repeats the reference " + quote(entry));
  }
  resolved = complete;
  return choices;
}

std::string column_of(const std::string& scene_pointer) {
  std::string column = scene_pointer.substr(std::string("/scene/").size());
  std::replace(column.begin(), column.end(), '/', '.');
  return column;
}

// Where the study says what the factory of a method points at: an element of a list, where one was chosen there.
std::string pointer_of_option(const MethodOption& option, const InputError& error) {
  const std::string& told = error.pointer();
  const std::size_t key = std::min(told.find('/', 1), told.size());
  const std::string at = option.places.front() + told.substr(0, key);
  for (const std::string& place : option.places)
    if (place.starts_with(at + "/")) return place + told.substr(key);
  return option.places.front() + told;
}

// Asks each contact law whether it may push back what lies beyond a stop. One of somebody else is not asked here: where
// it does not, the rows of its cases say so. Returns whether some law does. Throws InputError for parameters that do
// not go together.
bool ask_beyond(std::vector<MethodOption>& contacts, const Catalogue& catalogue, const Registry& registry) {
  constexpr double barely = 1e-12;  // m
  for (MethodOption& option : contacts) {
    const MethodChoice& choice = option.choice;
    option.starts_beyond = true;
    if (const std::string file = registry.file(Role::contact, choice.name); !file.empty() && catalogue.foreign(file))
      continue;
    try {
      const auto law = registry.contact(choice.name)->make(choice.parameters);
      const ForceBeyond beyond = force_beyond(*law, choice.parameters);
      option.starts_beyond = beyond && beyond(barely);
    } catch (const InputError& error) {
      throw InputError(pointer_of_option(option, error), error.what());
    } catch (...) {  // told in its rows
    }
  }
  return std::any_of(contacts.begin(), contacts.end(), [](const MethodOption& one) { return one.starts_beyond; });
}

// Reads and checks every scene that is marched; an offending value that came from a list is named with its place in the
// list. `beyond`: whether some law of the study lets it begin beyond a stop; `every_dof`: whether it marches all dofs.
std::vector<SceneOption> expand_scenes(const Json& scene, const std::vector<Axis>& axes, const MeshChoice& finest,
                                       bool beyond, const StudyKind& kind, const Json& settings, StudyFiles& files,
                                       double duration, bool every_dof) {
  std::vector<SceneOption> options;
  Product product;
  for (const Axis& axis : axes) product.add(axis.values.size());
  product.refuse_above(largest_study, "/scene");
  std::vector<Json::json_pointer> places;
  for (const Axis& axis : axes) places.emplace_back(axis.pointer.substr(std::string("/scene").size()));
  Json without = scene;  // the lists: each option would copy them
  for (const Json::json_pointer& place : places) without[place] = nullptr;
  for (; !product.ended(); product.next()) {
    SceneOption option;
    option.json = without;
    for (std::size_t a = 0; a < axes.size(); ++a) {
      const Json& value = axes[a].values[product[a]];
      option.json[places[a]] = value;
      option.axes.emplace_back(column_of(axes[a].pointer), value);
    }
    try {
      option.scene = on_mesh(read_scene(with_meshes(option.json, finest.of_bodies), &files), finest.elements);
      if (every_dof) check_size(option.scene.structure);
      files.add_digests(option.json);
      check_scene(option.scene, finest.elements, beyond ? anywhere_beyond() : ForceBeyond());
      if (duration > 0) check_tables(option.scene, duration);
    } catch (const InputError& error) {
      if (kind.marches_another) {
        StudyCase one;
        one.scene = option.scene;
        one.scene_json = option.json;
        one.elements = finest.elements;
        one.settings = settings;
        one.starts_beyond = beyond;
        if (kind.marches_another(one)) {
          options.push_back(std::move(option));
          continue;
        }
      }
      std::string pointer = pointer_in_bodies(pointer_in_study(option.scene.stops, error.pointer()), scene);
      for (std::size_t a = 0; a < axes.size(); ++a)
        if (pointer == axes[a].pointer || pointer.starts_with(axes[a].pointer + "/"))
          pointer.insert(axes[a].pointer.size(), "/" + std::to_string(product[a]));
      throw InputError(pointer, error.what());
    }
    options.push_back(std::move(option));
  }
  return options;
}

// Two entries that expand to the same method would run the same case twice.
void refuse_repeated(const std::vector<MethodOption>& options, Role role) {
  std::map<std::string, std::string> seen;
  for (const MethodOption& option : options) {
    std::string text;
    for (const auto& [key, value] : option.axes) text += (text.empty() ? "" : ", ") + key + " = " + quote(value);
    const auto [first, fresh] = seen.emplace(text, option.places.back());
    if (!fresh)
      throw InputError(option.places.back(), "gives the same " + std::string(role_name(role)) + " method as " +
                                                 first->second + " (" + text + "): the same case would run twice");
  }
}

// Whether some stop of the study has friction, in some of its cases.
bool has_friction(const Json& scene) {
  const Json& stops = scene.at("stops");
  return stops.is_array() && std::any_of(stops.begin(), stops.end(), [](const Json& stop) {
           return stop.contains("friction") && !stop.at("friction").is_null();
         });
}

// The methods of a study by role, which are then written out in it. A friction law that is not given is no axis.
std::vector<MethodOptions> read_roles(Json& given, bool rubs, Catalogue& catalogue, Registry& registry,
                                      const std::filesystem::path& folder) {
  std::vector<MethodOptions> methods;
  for (const Role role : marched_roles) {
    const std::string key = role_name(role);
    if (role == Role::friction && (!given.contains(key) || given[key].is_null())) {
      given.erase(key);
      MethodOptions& unsaid = methods.emplace_back();
      if (rubs) unsaid = read_methods(role, "coulomb", "/methods/" + key, catalogue, registry, folder);
      if (!rubs) unsaid.options.emplace_back();
      unsaid.options.front().axes.clear();
      continue;
    }
    if (role == Role::friction && !rubs)
      throw InputError("/methods/" + key, "no stop of the scene has friction; expected none, or a stop with friction");
    methods.push_back(read_methods(role, given[key], "/methods/" + key, catalogue, registry, folder));
    refuse_repeated(methods.back().options, role);
    given[key] = methods.back().resolved;
  }
  return methods;
}

// What a key of the study gives an axis, and whether it does: a kind may lack the key.
template <class Value>
std::vector<Value> values_of(const Json& resolved, const char* key, Value without) {
  return resolved.contains(key) ? one_or_each<Value>(resolved[key]) : std::vector<Value>{without};
}

// The study with every default, by its form alone.
Study begin_study(const Json& given, std::vector<Axis>& lists) {
  Study study;
  study.resolved = check_object(study_form(), given, "", lists);
  require_mesh(given);
  study.name = study.resolved["name"].get<std::string>();
  study.question = cut_short(study.resolved["question"].get<std::string>());
  study.kind = study.resolved["kind"].get<std::string>();
  check_name(study.name);
  std::erase_if(lists, [](const Axis& axis) { return !axis.pointer.starts_with("/scene/"); });
  return study;
}

void check_kind(const StudyKind& kind, const Json& resolved) {
  if (kind.check) kind.check(resolved);
  if (!kind.shows_points && resolved["scene"].contains("points"))
    throw InputError("/scene/points", "a study of kind " + kind.name + " shows no points; expected kind trajectory");
}

/// Combinations of lists in the scene with the axes beside it. Too many are refused where the longest list stands.
double count_cases(const std::vector<Axis>& lists, const std::vector<CaseAxis>& axes) {
  Product everything;
  std::size_t longest = 0;
  std::string pointer;
  const auto add = [&](std::size_t size, const std::string& where) {
    everything.add(size);
    if (size > longest) longest = size, pointer = where;
  };
  for (const Axis& list : lists) add(list.values.size(), list.pointer);
  for (const CaseAxis& axis : axes) add(axis.levels.size(), axis.pointer);
  everything.refuse_above(largest_study, pointer);
  return everything.count();
}

/// Whether anything in a scene is drawn.
bool has_random(const Json& scene) {
  if (!scene.is_structured()) return false;
  if (scene.is_object() && scene.contains("psd")) return true;
  return std::any_of(scene.begin(), scene.end(), [](const Json& one) { return has_random(one); });
}

void check_seeds(const std::vector<Axis>& lists, const Json& scene) {
  for (const Axis& list : lists)
    if (list.pointer == "/scene/seed" && list.values.size() > 1 && !has_random(scene))
      throw InputError(list.pointer, "seeds draw random loads (psd), and this scene has none: all would be one case");
}

}  // namespace

Study parse_study(const std::string& text, Catalogue& catalogue, Registry& registry,
                  const std::filesystem::path& folder) {
  std::vector<Axis> lists;
  const Json given = parse_json(text);
  Study study = begin_study(given, lists);
  Json& resolved = study.resolved;
  const StudyKind& kind = *find_study_kind(study.kind);
  StudyCase common;
  if (const auto duration = resolved.find("duration"); duration != resolved.end() && !duration->is_null())
    common.duration = duration->get<double>();
  common.samples = resolved.value("samples", 0);
  if (resolved.contains("step")) check_steps(resolved["step"], common.duration);
  // A kind without the key marches every step.
  const auto marches = values_of<std::string>(resolved, "march", "every-step");
  // One that is not given is none of the study's axes, and none of the study as it is kept.
  for (const char* key : {"march", "compare"})
    if (!given.contains(key)) resolved.erase(key);
  common.files = std::make_shared<StudyFiles>(folder, resolved["files"], resolved.value("outside", false));
  resolved.erase("files");
  check_kind(kind, resolved);
  check_seeds(lists, resolved["scene"]);
  const std::vector<MeshChoice> meshes = meshes_of(resolved["mesh"], resolved["scene"]);
  auto methods = read_roles(resolved["methods"], has_friction(resolved["scene"]), catalogue, registry, folder);
  std::vector<MethodChoice> references;
  if (resolved.contains("reference"))
    references = read_references(resolved["reference"], "/reference", catalogue, registry);
  if (!kind.add_references) common.references = references;
  common.settings = kind.settings(resolved);
  const bool modal = has_structure(resolved["scene"], {"modal"}) && !resolved["scene"].contains("bodies");
  const std::vector<std::optional<BasisSpec>> bases = bases_of(resolved["mesh"], resolved["scene"], modal);

  // Beside the scenes. A kind without a step goes through a range of them within each case (stability), or counts steps
  // per forcing period.
  std::vector<CaseAxis> axes = {
      method_axis(methods[0].options, &StudyCase::mass, "/methods/mass"),
      method_axis(methods[1].options, &StudyCase::contact, "/methods/contact"),
      method_axis(methods[2].options, &StudyCase::friction, "/methods/friction"),
      method_axis(methods[3].options, &StudyCase::time, "/methods/time"),
      mesh_axis(meshes, *common.files),
      plain_axis("step", resolved.contains("step"), values_of(resolved, "step", 0.0), &StudyCase::step),
      plain_axis("steps_per_period", resolved.contains("steps_per_period"), values_of(resolved, "steps_per_period", 0),
                 &StudyCase::steps_per_period),
      plain_axis("march", resolved.contains("march"), marches, &StudyCase::march),
      basis_axis(bases, resolved["mesh"], modal)};
  const double combinations = count_cases(lists, axes);

  const auto fewer = [](const MeshChoice& a, const MeshChoice& b) { return a.elements < b.elements; };
  const MeshChoice &finest = *std::max_element(meshes.begin(), meshes.end(), fewer),
                   &coarse = *std::min_element(meshes.begin(), meshes.end(), fewer);
  const std::vector<SceneOption> scenes = expand_scenes(
      resolved["scene"], lists, finest, ask_beyond(methods[1].options, catalogue, registry), kind, common.settings,
      *common.files, common.duration, std::find(bases.begin(), bases.end(), std::nullopt) != bases.end());
  for (const SceneOption& one : scenes) check_bases(bases, resolved["mesh"], one.scene.structure, coarse.elements);
  if (Json said = common.files->said(); !said.is_null())
    resolved["files"] = with_layout(std::move(said), scenes.front().scene);
  if (kind.check_methods)
    kind.check_methods(resolved, common.settings, registry, combinations,
                       make_space(scenes.front().scene.structure, coarse.elements).dofs);

  axes.insert(axes.begin(), scene_axis(scenes));
  add_cases(axes, common, kind, registry, study);
  apply_excludes(resolved["exclude"], study);
  if (kind.add_references) kind.add_references(references, study);
  if (kind.check_cases) kind.check_cases(study);
  check_compare(study);
  check_asks(study);
  study.axes = axis_meanings(study, registry);
  study.method_words = method_words(study, registry);
  return study;
}

Study load_study(const StudyText& study, Catalogue& catalogue, Registry& registry) {
  return parse_study(study.text, catalogue, registry, study.folder);
}

const StudyCase* find_case(const Study& study, const std::string& id) {
  const auto found =
      std::find_if(study.cases.begin(), study.cases.end(), [&](const StudyCase& one) { return one.id == id; });
  return found == study.cases.end() ? nullptr : &*found;
}

std::string explain(const InputError& error, const StudyText& study) {
  std::string text;
  try {
    if (!error.pointer().empty()) parse_json(text = study.text);
  } catch (const InputError& twice) {
    // A key given twice: the text can still be located in. Anything else has no line to tell.
    if (twice.pointer().empty()) text.clear();
  }
  return explained(error, study.place, text);
}

}  // namespace ricochet
