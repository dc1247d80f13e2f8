#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <numbers>
#include <ricochet/scene/semi_discrete.hpp>
#include <set>

#include "runners/json/json_text.hpp"
#include "runners/kinds/sweep/forcing.hpp"
#include "runners/kinds/sweep/sweep.hpp"
#include "runners/kinds/sweep/with_parameter.hpp"
#include "runners/march/load_changes.hpp"
#include "runners/study/check_object.hpp"
#include "runners/table/text.hpp"

namespace ricochet {
namespace {

// Bytes of one row: sections, what else each value and start keeps (at most 64 impacts, a portrait), a cell with its
// own section.
constexpr double point_row = 7 * 8, orbit_rows = 64 * 5 * 8 + 200 * 5 * 8, cell_row = 1000, cell_point_row = 6 * 8;

std::vector<double> values_between(const Json& range, const std::string& pointer) {
  const auto from = range.at("from").get<double>(), to = range.at("to").get<double>();
  const auto count = range.at("count").get<std::size_t>();
  if (!(from < to))
    throw InputError(pointer_to(pointer, "from"),
                     fmt::format("the range from {} to {} is empty; expected from < to", from, to));
  const auto last = static_cast<double>(count - 1);
  std::vector<double> exact, rounded;
  for (std::size_t i = 0; i < count; ++i) {
    const auto at = static_cast<double>(i);
    double value = i == 0 ? from : i + 1 == count ? to : from * ((last - at) / last) + to * (at / last);
    exact.push_back(value);
    if (i > 0 && i + 1 < count) {
      value = to_digits(value, 12);
      if (std::abs(value) < 1e-12 * std::max(std::abs(from), std::abs(to))) value = 0;
    }
    rounded.push_back(value);
  }
  const auto repeats = [](const std::vector<double>& values) {
    return std::adjacent_find(values.begin(), values.end(), std::greater_equal<>()) != values.end();
  };
  if (!repeats(rounded)) return rounded;
  if (repeats(exact))
    throw InputError(pointer_to(pointer, "count"),
                     fmt::format("{} values do not fit between {} and {}", count, from, to));
  return exact;
}

Json swept(const Json& given, const std::string& pointer) {
  std::vector<double> values;
  if (given.contains("values")) {
    values = given["values"].get<std::vector<double>>();
    std::sort(values.begin(), values.end());
  } else {
    values = values_between(given, pointer);
  }
  return {{"pointer", given.at("pointer")}, {"values", values}};
}

// Pointers of the settings and where the study writes them.
std::vector<std::pair<std::string, std::string>> pointers_of(const Json& settings) {
  std::vector<std::pair<std::string, std::string>> pointers;
  if (settings.contains("parameter"))
    pointers.emplace_back(settings["parameter"]["pointer"].get<std::string>(), "/parameter/pointer");
  else
    for (std::size_t i = 0; i < settings.at("axes").size(); ++i)
      pointers.emplace_back(settings["axes"][i]["pointer"].get<std::string>(),
                            pointer_to(pointer_to("/axes", i), "pointer"));
  return pointers;
}

// The entries of a role that are named "/methods/ROLE/…" by a pointer; "" when it names none.
std::string role_of(const std::string& pointer) {
  for (const Role role : marched_roles)
    if (const std::string start = std::string("/methods/") + role_name(role) + "/"; pointer.starts_with(start))
      return role_name(role);
  return "";
}

const ParameterSpec* parameter_of(const Registry& registry, const std::string& role, const std::string& method,
                                  const std::string& pointer) {
  for (const Role known : marched_roles) {
    if (role != role_name(known)) continue;
    if (const PluginManual* manual = registry.manual(known, method))
      for (const ParameterSpec& spec : manual->parameters)
        if (pointer == "/methods/" + role + "/" + spec.key && spec.type == ParameterSpec::Type::real) return &spec;
  }
  return nullptr;
}

std::vector<std::string> method_scalars(const Json& methods, const Registry& registry) {
  std::vector<std::string> pointers;
  for (const Role role : marched_roles)
    for (const Json& entry : methods.value(role_name(role), Json::array()))
      for (const ParameterSpec& spec : registry.manual(role, entry.at("name").get<std::string>())->parameters) {
        const std::string pointer = std::string("/methods/") + role_name(role) + "/" + spec.key;
        if (spec.type == ParameterSpec::Type::real &&
            std::find(pointers.begin(), pointers.end(), pointer) == pointers.end())
          pointers.push_back(pointer);
      }
  return pointers;
}

void refuse_list(const Json& list, const std::string& pointer, const std::string& where) {
  if (list.is_array())
    throw InputError(where, fmt::format("{} is a list, an axis of this study; expected one number there, the parameter "
                                        "takes its own values",
                                        pointer));
}

void check_pointer(const Json& resolved, const std::string& pointer, const std::string& where,
                   const Registry& registry) {
  std::vector<std::string> names = scene_scalars(resolved.at("scene"));
  for (const std::string& name : method_scalars(resolved.at("methods"), registry)) names.push_back(name);
  if (std::find(names.begin(), names.end(), pointer) == names.end()) {
    std::string all;
    for (const std::string& name : names) all += (all.empty() ? "" : ", ") + name;
    throw InputError(where, quote(Json(pointer)) +
                                " names no number of the scene and no real parameter of the methods" +
                                did_you_mean(pointer, names) + " (numbers of this study: " + all + ")");
  }
  const std::string role = role_of(pointer);
  if (role.empty()) {
    const Json::json_pointer there(pointer);
    if (!resolved.contains(there)) return;  // its default
    const Json& value = resolved.at(there);
    refuse_list(value, pointer, where);
    if (value.is_null())
      throw InputError(where, fmt::format("{} is null, no stop is there; expected one to move", pointer));
    return;
  }
  const std::string key = pointer.substr(pointer.rfind('/') + 1);
  for (const Json& entry : resolved.at("methods").at(role))
    if (const auto found = entry.find(key); found != entry.end()) refuse_list(*found, pointer, where);
}

void check_memory(const Json& settings, double cases) {
  const auto keep = settings.at("keep").get<double>();
  double bytes = 0;
  std::string what, where, advice;
  if (settings.contains("parameter")) {
    const auto values = static_cast<double>(settings["parameter"]["values"].size());
    const auto starts = static_cast<double>(starts_of(settings).size());
    bytes = cases * values * starts * (keep * point_row + orbit_rows);
    what = fmt::format("{:g} case{} × {:g} values × {:g} start{} × {:g} kept periods", cases, cases == 1 ? "" : "s",
                       values, starts, starts == 1 ? "" : "s", keep);
    where = "/keep";
    advice = "keep fewer periods, take fewer values or starts, or split the study";
  } else {
    const auto columns = static_cast<double>(settings.at("axes")[0]["values"].size());
    const auto rows = static_cast<double>(settings["axes"][1]["values"].size());
    bytes = cases * columns * rows * (cell_row + std::min(keep, 64.0) * cell_point_row);
    what = fmt::format("{:g} case{} × {:g} × {:g} cells", cases, cases == 1 ? "" : "s", columns, rows);
    where = "/axes";
    advice = "take a coarser grid or split the study";
  }
  if (bytes > largest_results)
    throw InputError(where, fmt::format("{} would need about {:.3g} GB of memory; expected at most {:g} GB: {}", what,
                                        1e-9 * bytes, 1e-9 * largest_results, advice));
}

}  // namespace

Json sweep_settings(const Json& resolved) {
  Json settings = Json::object();
  if (resolved.contains("parameter")) {
    settings["parameter"] = swept(resolved["parameter"], "/parameter");
    settings["start"] = resolved.at("start");
  } else {
    settings["axes"] = Json::array();
    for (std::size_t i = 0; i < resolved.at("axes").size(); ++i)
      settings["axes"].push_back(swept(resolved["axes"][i], pointer_to("/axes", i)));
  }
  for (const char* key : {"transient", "keep", "section", "phase"}) settings[key] = resolved.at(key);
  settings["exponents"] = resolved.value("exponents", 0);
  settings["refine"] = resolved.at("refine");
  if (!resolved.at("budget").is_null()) settings["budget"] = resolved["budget"];
  return settings;
}

void check_swept_pointer(const Json& resolved, const std::string& pointer, const std::string& where,
                         const Registry& registry) {
  check_pointer(resolved, pointer, where, registry);
}

void check_sweep(const Json& resolved, const Json& settings, const Registry& registry, double cases, int dofs) {
  const auto pointers = pointers_of(settings);
  for (std::size_t i = 0; i < pointers.size(); ++i) {
    check_pointer(resolved, pointers[i].first, pointers[i].second, registry);
    for (std::size_t j = 0; j < i; ++j)
      if (pointers[j].first == pointers[i].first)
        throw InputError(pointers[i].second, fmt::format("repeats {} of {}; expected two different axes",
                                                         pointers[i].first, pointers[j].second));
  }
  if (settings.contains("start") && pointers.front().first.starts_with("/scene/initial/"))
    for (std::size_t i = 0; i < settings["start"].size(); ++i)
      if (settings["start"][i] != "state")
        throw InputError(pointer_to("/start", i),
                         fmt::format("the parameter {} is read by the start \"state\" alone, found {}",
                                     pointers.front().first, quote(settings["start"][i])));
  const auto periods = settings.at("transient").at("periods").get<long long>();
  const auto at_most = settings["transient"].at("at_most").get<long long>();
  if (at_most < periods)
    throw InputError("/transient/at_most", fmt::format("at most {} periods, of which {} are always marched; expected "
                                                       "at_most ≥ periods",
                                                       at_most, periods));
  const auto exponents = settings.at("exponents").get<int>();
  if (exponents > 2 * dofs)
    throw InputError("/exponents", fmt::format("{} exponents of a state of {} components (2 × {} dofs); expected at "
                                               "most {}",
                                               exponents, 2 * dofs, dofs, 2 * dofs));
  check_memory(settings, cases);
}

void mark_sweep(const Json& settings, const Registry& registry, StudyCase& study_case) {
  for (const auto& [pointer, where] : pointers_of(settings)) {
    const std::string role = role_of(pointer);
    if (role.empty()) continue;
    const std::string key = pointer.substr(pointer.rfind('/') + 1);
    const auto marched =
        std::find_if(marched_roles.begin(), marched_roles.end(), [&](Role one) { return role == role_name(one); });
    const MethodChoice& method = method_of(study_case, *marched);
    const ParameterSpec* spec = parameter_of(registry, role, method.name, pointer);
    if (!spec) {
      if (!study_case.excluded)
        study_case.excluded =
            fmt::format("the {} method \"{}\" has no real parameter \"{}\" to go through", role, method.name, key);
      continue;
    }
    study_case.swept.emplace_back(pointer, *spec);
    for (auto& [name, value] : study_case.axes)
      if (name == role + "." + key) value = "swept";
  }
}

namespace {

// The axes of the grid, or the parameter.
std::vector<GridAxis> swept_axes(const Json& settings) {
  if (settings.contains("axes")) return grid_axes(settings);
  return {{settings.at("parameter").at("pointer").get<std::string>(), parameter_values(settings)}};
}

/// So many of the numbers 0 to size − 1, evenly, the first and the last among them.
std::vector<std::size_t> spread(std::size_t size, std::size_t most) {
  std::vector<std::size_t> out;
  const std::size_t count = std::min(size, std::max<std::size_t>(most, 3));
  for (std::size_t k = 0; k < count; ++k) out.push_back(count == 1 ? 0 : k * (size - 1) / (count - 1));
  return out;
}

using PlaceVisit = std::function<bool(const std::vector<std::pair<std::string, double>>&)>;

// `visit` sees the places that the axes go through; true ends the walk, and is returned. Of more than `most` places it
// sees a coarse grid, then each value of an axis with the first, the middle and the last of the other.
bool any_place(const std::vector<GridAxis>& axes, std::size_t most, const PlaceVisit& visit) {
  if (axes.empty()) return visit({});
  const GridAxis &x = axes.front(), &y = axes.back();
  const std::size_t along = x.values.size(), across = axes.size() == 1 ? 1 : y.values.size();
  const auto at = [&](std::size_t i, std::size_t j) {
    if (axes.size() == 1) return visit({{x.pointer, x.values[i]}});
    return visit({{x.pointer, x.values[i]}, {y.pointer, y.values[j]}});
  };
  const auto any = [&](const std::vector<std::size_t>& rows, const std::vector<std::size_t>& columns) {
    return std::any_of(rows.begin(), rows.end(), [&](std::size_t i) {
      return std::any_of(columns.begin(), columns.end(), [&](std::size_t j) { return at(i, j); });
    });
  };
  if (along <= most && across <= most / along) return any(spread(along, along), spread(across, across));
  if (across == 1) return any(spread(along, most), {0});
  const auto side = static_cast<std::size_t>(std::sqrt(static_cast<double>(most) / 2));
  constexpr std::size_t lines = 3;
  return any(spread(along, side), spread(across, side)) ||
         any(spread(along, most / 4 / lines), spread(across, lines)) ||
         any(spread(along, lines), spread(across, most / 4 / lines));
}

// Places that one study is looked at, at most: a check takes up to 0.3 ms.
constexpr std::size_t most_places = 2000;

// Where no orbit begins in the case's own initial state, that is not looked at.
StudyCase as_it_starts(const StudyCase& study_case) {
  const bool grid = study_case.settings.contains("axes");
  return grid || any_start(starts_of(study_case.settings), true) ? study_case : at_rest(study_case);
}

}  // namespace

bool some_value_possible(const StudyCase& study_case) {
  std::vector<GridAxis> axes = swept_axes(study_case.settings);
  std::erase_if(axes, [](const GridAxis& axis) { return !axis.pointer.starts_with("/scene/"); });
  const StudyCase one = as_it_starts(study_case);
  const auto possible = [&](const std::vector<std::pair<std::string, double>>& place) {
    try {
      if (place.empty()) check_scene(one.scene, one.elements, one.starts_beyond ? anywhere_beyond() : ForceBeyond());
      with_parameters(one, place);
      return true;
    } catch (const InputError&) {
      return false;
    }
  };
  return any_place(axes, most_places, possible);
}

std::vector<Said> load_doubts(const StudyCase& study_case) {
  std::vector<GridAxis> axes;
  if (const Json& settings = study_case.settings;
      settings.contains("axes") || settings.at("parameter").contains("values"))
    axes = swept_axes(settings);
  else
    axes = {{settings.at("parameter").at("pointer").get<std::string>(),
             {settings.at("parameter").at("from").get<double>(), settings.at("parameter").at("to").get<double>()}}};
  std::vector<std::pair<std::string, double>> first, last;
  for (const GridAxis& axis : axes) {
    first.emplace_back(axis.pointer, axis.values.front());
    last.emplace_back(axis.pointer, axis.values.back());
  }
  const StudyCase still = at_rest(study_case);
  for (std::vector<std::pair<std::string, double>> place : {first, last}) {
    std::erase_if(place, [](const auto& value) { return names_initial_state(value.first); });
    try {
      const SceneSpec scene = with_parameters(still, place).scene;
      const double pulsation = forcing_pulsation(scene);
      if (!(pulsation > 0)) continue;
      const double step = 2 * std::numbers::pi / pulsation / study_case.steps_per_period;
      if (auto found = load_changes(scene, step, study_case.steps_per_period); !found.empty()) return found;
    } catch (const InputError&) {  // a value that no orbit has
    }
  }
  return {};
}

void check_values(const Study& study) {
  std::set<std::string> seen;
  std::optional<InputError> first;
  bool same = true, any = false, possible = false, unforced = false;
  double places = 0, looked = 0;  // of cases that differ
  // Of very many cases some, evenly.
  constexpr std::size_t most_cases = 1000;
  const std::vector<std::size_t> looked_at = spread(study.cases.size(), most_cases);
  const std::size_t most = std::max<std::size_t>(1, most_places / std::max<std::size_t>(1, looked_at.size()));
  any = std::any_of(study.cases.begin(), study.cases.end(), [](const StudyCase& one) { return !one.excluded; });
  for (const std::size_t number : looked_at) {
    const StudyCase& one = study.cases[number];
    if (one.excluded) continue;
    const Json& settings = one.settings;
    const bool strobe = settings.at("section") == "strobe";
    const std::vector<GridAxis> axes = swept_axes(settings);
    std::string key = one.scene_json.dump() + std::to_string(one.elements) + (one.starts_beyond ? " beyond" : "");
    for (const GridAxis& axis : axes)
      if (!role_of(axis.pointer).empty()) key += one.mass.name + " " + one.contact.name + " " + one.time.name;
    if (!seen.insert(key).second) continue;
    const StudyCase started = as_it_starts(one);
    double grid = 1;
    for (const GridAxis& axis : axes) grid *= static_cast<double>(axis.values.size());
    places += grid;
    const bool runs = any_place(axes, most, [&](const std::vector<std::pair<std::string, double>>& place) {
      ++looked;
      try {
        const StudyCase at = with_parameters(started, place);
        possible = true;
        if (!strobe || is_forced(at.scene)) return true;
        unforced = true;
      } catch (const InputError& error) {
        if (first && (first->pointer() != error.pointer() || std::string(first->what()) != error.what())) same = false;
        if (!first) first = error;
      }
      return false;
    });
    if (runs) return;
  }
  if (!any) throw InputError("/exclude", "every case is excluded; nothing would run");
  if (unforced)
    throw InputError("/section",
                     "a strobe reads once per forcing period, and nothing is forced at any value (amplitude 0); "
                     "expected a forcing, or the section \"impact\" or \"extremum\"");
  if (possible || !first) return;
  throw InputError(
      first->pointer(),
      same ? std::string(first->what())
           : fmt::format("{}; the first: {}",
                         looked < places ? fmt::format("none of {:.0f} values, taken evenly among {:.0f}, is possible",
                                                       looked, places)
                                         : "no value is possible",
                         first->what()));
}

}  // namespace ricochet
