#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <ricochet/measure/stability/structure_physics.hpp>
#include <ricochet/scene/clearances.hpp>

#include "runners/command/subcommand.hpp"
#include "runners/march/load_changes.hpp"
#include "runners/report/scene_sketch.hpp"
#include "runners/run/plan_cases.hpp"
#include "runners/study/body_keys.hpp"
#include "runners/table/in_order_met.hpp"
#include "runners/table/text.hpp"

namespace ricochet {
namespace {

using Group = std::vector<const PlannedCase*>;

// A mode is resolved by so many steps per period. The frequency of the mid-point rule is then off by (2π/20)²/12 = 0.8
// %.
constexpr double enough_steps = 20;
constexpr std::size_t most_structures = 3, most_modes = 3;

/// Coarsest and finest step of a study; one where all are the same.
std::vector<double> steps_of(const Group& group) {
  double coarsest = 0, finest = 0;
  for (const PlannedCase* one : group) {
    if (one->plan.finest_step <= 0) continue;
    coarsest = std::max(coarsest, one->plan.coarsest_step);
    finest = finest > 0 ? std::min(finest, one->plan.finest_step) : one->plan.finest_step;
  }
  if (coarsest == 0) return {};
  return coarsest == finest ? std::vector<double>{coarsest} : std::vector<double>{coarsest, finest};
}

/// Three digits and no exponent, up to a million.
std::string rounded(double value) {
  return value >= 1000 && value < 1e6 ? fmt::format("{:.0f}", value) : fmt::format("{:.3g}", value);
}

std::string resolved_text(const StructurePhysics& physics, double h) {
  const int count = physics.resolved(h, enough_steps);
  const auto all = static_cast<int>(physics.pulsations.size());
  if (count == 0) return fmt::format("h = {} resolves no mode", step_text(h));
  const std::string highest =
      rounded(physics.pulsations[static_cast<std::size_t>(count - 1)] / (2 * std::numbers::pi)) + " Hz";
  if (all == 1) return fmt::format("h = {} resolves it", step_text(h));
  if (count == all) return fmt::format("h = {} resolves all {} modes of this mesh, to {}", step_text(h), all, highest);
  return fmt::format("h = {} resolves mode{} of {}, to {}", step_text(h),
                     count == 1 ? " 1" : fmt::format("s 1 to {}", count), all, highest);
}

std::string modes_text(const StructurePhysics& physics, const std::vector<double>& steps) {
  const std::size_t shown = std::min(most_modes, physics.pulsations.size());
  std::vector<std::string> header = {"mode"}, hertz = {"frequency"}, pulsation = {"pulsation"},
                           damping = {"damping ratio"};
  std::vector<std::vector<std::string>> periods;
  bool damped = false;
  for (const double h : steps) periods.push_back({fmt::format("steps per period, h = {}", step_text(h))});
  for (std::size_t i = 0; i < shown; ++i) {
    const double omega = physics.pulsations[i];
    header.push_back(std::to_string(i + 1));
    hertz.push_back(omega > 0 ? rounded(omega / (2 * std::numbers::pi)) + " Hz" : "0 (rigid motion)");
    pulsation.push_back(omega > 0 ? fmt::format("{:.4g} rad/s", omega) : "");
    const std::optional<double> ratio = physics.damping_ratio(i);
    damped = damped || ratio;
    damping.push_back(
        !ratio ? "" : fmt::format("{} %", *ratio < 1 ? fmt::format("{:.2g}", 100 * *ratio) : rounded(100 * *ratio)));
    for (std::size_t s = 0; s < steps.size(); ++s)
      periods[s].push_back(omega > 0 ? rounded(2 * std::numbers::pi / omega / steps[s]) : "");
  }
  TextTable table(header);
  for (const auto& row : {hertz, pulsation}) table.add(row);
  if (damped) table.add(damping);
  for (const auto& row : periods) table.add(row);
  std::string text = table.text(4);
  if (steps.empty()) return text;
  text += fmt::format("    with {} steps per period or more,", enough_steps);
  for (std::size_t s = 0; s < steps.size(); ++s) text += (s > 0 ? "; " : " ") + resolved_text(physics, steps[s]);
  return text + "\n";
}

/// The first case of the first mass matrix, on the finest mesh it has.
const StudyCase& representative(const Group& group) {
  const PlannedCase* found = group.front();
  for (const PlannedCase* one : group)
    if (one->study_case->mass.name == found->study_case->mass.name &&
        one->study_case->elements > found->study_case->elements)
      found = one;
  return *found->study_case;
}

using Numbers = std::vector<report::SceneNumber>;

constexpr std::size_t most_entries = 12;
const std::vector<std::string> structure_places = {"/scene/structure/", "/scene/bodies/"};

/// What a scene says at the pointers that begin so: alone, or the entries of lists.
Numbers said_at(const Numbers& scene, const std::vector<std::string>& pointers, bool entries) {
  Numbers out;
  for (const report::SceneNumber& one : scene)
    if (one.entry == entries && std::any_of(pointers.begin(), pointers.end(), [&](const std::string& pointer) {
          return one.pointer.starts_with(pointer);
        }))
      out.push_back(one);
  return out;
}

/// What a clearance is to laws, which its entry does not say.
std::string clearance_text(const Json& clearance) {
  const int sides = clearance["sides"].get<int>();
  return fmt::format(
      ": the circle for compliant laws; for rigid ones {} sides, whose corners lie {:.2g} m ({:.2g} %) further", sides,
      polygon_error(clearance["radius"].get<double>(), sides), 100 * polygon_error(1, sides));
}

/// Each stop that has a name, and how stiff the structure is there (N/m).
std::string stops_text(const Json& stops, const Numbers& said, const std::vector<double>& stiffness) {
  std::string text;
  std::size_t row = 0;
  for (std::size_t i = 0; i < std::min(most_entries, said.size()); ++i) {
    text += fmt::format("    {}: {}", said[i].symbol, said[i].text);
    std::size_t rows = 1;
    if (const Json clearance = stops[i].value("clearance", Json()); !clearance.is_null()) {
      const int sides = clearance["sides"].get<int>();
      rows = static_cast<std::size_t>(sides % 2 == 0 ? sides / 2 : sides);
      text += clearance_text(clearance);
    }
    if (row < stiffness.size() && std::isfinite(stiffness[row])) {
      const auto [softest, stiffest] = std::minmax_element(stiffness.begin() + static_cast<std::ptrdiff_t>(row),
                                                           stiffness.begin() + static_cast<std::ptrdiff_t>(row + rows));
      text += fmt::format("; the structure has {:.4g}{} N/m there", *softest,
                          *stiffest > 1.001 * *softest ? fmt::format(" to {:.4g}", *stiffest) : "");
    }
    row += rows;
    text += "\n";
  }
  if (said.size() > most_entries) text += fmt::format("    and {} more stops\n", said.size() - most_entries);
  return text;
}

/// κ of the stiffest law of the study whose force is κ times the depth, N/m.
std::optional<double> stiffest_spring(const Group& group, const Registry& registry) {
  std::optional<double> out;
  for (const PlannedCase* one : group) {
    const MethodChoice& law = one->study_case->contact;
    const PluginManual* manual = registry.manual(Role::contact, law.name);
    if (!manual) continue;
    const std::vector<ParameterSpec>& declared = manual->parameters;
    const auto spring = std::find_if(declared.begin(), declared.end(), [](const ParameterSpec& spec) {
      return spec.role == ParameterRole::stiffness && spec.unit == "N/m";
    });
    if (spring == declared.end()) continue;
    if (const auto stiffness = value_of_role(declared, law.parameters, ParameterRole::stiffness))
      out = std::max(out.value_or(0), *stiffness);
  }
  return out;
}

/// R_ii κ: how much softer than its spring a stop would be without the residual flexibility of the modes.
std::string left_out_text(const StructurePhysics& physics, const Json& scene, std::optional<double> spring) {
  if (physics.left_out.empty() || !spring) return "";
  constexpr std::size_t most_points = 12;
  constexpr double percent = 100;
  const Json& stops = scene.at("stops");
  std::string text;
  for (std::size_t i = 0; i < std::min(most_points, physics.left_out.size()); ++i) {
    const std::string name =
        stops.is_array() && i < stops.size() ? stops[i]["name"].get<std::string>() : fmt::format("point {}", i + 1);
    const Json own = stops.is_array() && i < stops.size() ? stops[i].value("stiffness", Json()) : Json();
    const double kappa = own.is_number() ? own.get<double>() : *spring;
    text += fmt::format("{}{} {:.2g} %{}", i == 0 ? "" : ", ", name, percent * physics.left_out[i] * kappa,
                        own.is_number() ? fmt::format(" (of its own {:.4g} N/m)", kappa) : "");
  }
  if (physics.left_out.size() > most_points) text += fmt::format(" and {} more", physics.left_out.size() - most_points);
  return fmt::format("    what modes leave out times the stiffest spring, R κ with κ = {:.4g} N/m: {}\n", *spring,
                     text);
}

std::string structure_text(const Group& group, const StudyCase& one, const std::vector<double>& steps,
                           const Registry& registry) {
  const auto mass = registry.mass(one.mass.name)->make(one.mass.parameters);
  const auto answer = structure_physics(one.scene, one.elements, *mass);
  const auto* physics = std::get_if<StructurePhysics>(&answer);
  if (!physics) return "";
  const Numbers scene = report::scene_numbers({{"scene", one.scene_json}});
  Numbers values = said_at(scene, structure_places, false);
  // The first says what kind it is.
  std::erase_if(values, [](const report::SceneNumber& number) { return number.symbol.empty(); });
  for (const PhysicalNumber& number : physics->numbers)
    values.push_back(
        {number.symbol, fmt::format("{:.4g}{}{}", number.value, *number.unit == '\0' ? "" : " ", number.unit), ""});
  std::string text = "  " + physics->structure + ":" + (values.empty() ? "" : " " + report::in_a_line(values));
  text += std::holds_alternative<OscillatorSpec>(one.scene.structure) ? "\n"
          : std::holds_alternative<AssembledSpec>(one.scene.structure)
              ? fmt::format("; modes with mass {}\n", one.mass.name)
              : fmt::format("; modes with mass {} on {} elements\n", one.mass.name, physics->elements);
  const Numbers parts = said_at(scene, structure_places, true);
  for (std::size_t i = 0; i < std::min(most_entries, parts.size()); ++i)
    text += fmt::format("    {}: {}\n", parts[i].symbol, parts[i].text);
  if (parts.size() > most_entries) text += fmt::format("    and {} more parts\n", parts.size() - most_entries);
  for (const std::string& line : physics->details) text += "    " + line + "\n";
  text += left_out_text(*physics, one.scene_json, stiffest_spring(group, registry));
  if (physics->pulsations.empty())
    text += "    no frequencies: the structure has more dofs than plan finds modes of\n";
  else
    text += modes_text(*physics, steps);
  for (const std::string& line : coarse_tables(one.scene, physics->pulsations)) text += "    " + line + "\n";
  return text +
         stops_text(one.scene_json.at("stops"), said_at(scene, {"/scene/stops/"}, true), physics->point_stiffness);
}

}  // namespace

std::string physics_text(const std::vector<PlannedCase>& cases, const CasePlanner& planner, const Registry& registry) {
  InOrderMet<std::string, Group> met;
  for (const PlannedCase& one : cases) met[structures_of(one.study_case->scene_json).dump()].push_back(&one);
  const auto groups = std::move(met).list();
  std::string text;
  for (std::size_t g = 0; g < std::min(most_structures, groups.size()); ++g) {
    const Group& group = groups[g].second;
    const std::vector<double> steps = steps_of(group);
    const StudyCase& one = representative(group);
    text += planner.ask(one, [&] { return structure_text(group, one, steps, registry); });
  }
  if (groups.size() > most_structures)
    text += fmt::format("  and {} more structures\n", groups.size() - most_structures);
  return text + contacts_text(cases, planner, registry);
}

}  // namespace ricochet
