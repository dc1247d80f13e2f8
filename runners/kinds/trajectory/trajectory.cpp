#include "runners/kinds/trajectory/trajectory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "runners/answers/limits.hpp"
#include "runners/answers/uncertainty.hpp"
#include "runners/json/json_text.hpp"
#include "runners/kinds/all_kinds.hpp"
#include "runners/kinds/kind.hpp"
#include "runners/kinds/trajectory/energy_tables.hpp"
#include "runners/kinds/trajectory/outputs.hpp"
#include "runners/kinds/trajectory/page/page.hpp"
#include "runners/kinds/trajectory/stop_measures.hpp"
#include "runners/kinds/trajectory/stop_tables.hpp"
#include "runners/kinds/trajectory/window_means.hpp"
#include "runners/store/record_values.hpp"
#include "runners/store/snapshots.hpp"
#include "runners/study/axis_meaning.hpp"
#include "runners/study/body_keys.hpp"
#include "runners/study/check_object.hpp"
#include "runners/study/fields.hpp"

namespace ricochet {
namespace {

using Of = MeasureInfo::Of;

std::vector<MeasureInfo> energy_measures() {
  return {
      {"scheme_energy_start", "J", "The scheme's own discrete energy after its start rule, where it declares one.",
       Of::motion, true, "energy_brought_in"},
      {"scheme_energy_end", "J", "The scheme's own discrete energy after the last step.", Of::motion, true,
       "energy_brought_in"},
      {"energy_start", "J",
       "The common mechanical energy of the initial state, at t = 0: ½vᵀMv + ½qᵀKq, the contact potential, and the "
       "potential of steady loads. These last three together are 0 where they are lowest: at rest under the loads.",
       Of::motion, true, "energy_brought_in"},
      {"energy_end", "J",
       "The common mechanical energy at the end of the last step, or in the middle of its last sub-step.", Of::motion,
       false, "energy_brought_in"},
      {"energy_ratio", "1",
       "Common energy at the end divided by that at the start; none where that is 0 or of the size of round-off.",
       Of::motion, true},
      {"energy_brought_in", "J",
       "The largest mechanical energy that the motion could have: the common energy at the start, and the most that "
       "loads and supports in motion had brought in, beyond what they took, at any sample of the run. Steady loads "
       "bring nothing in: their potential is in the energy.",
       Of::motion, true},
      {"energy_left", "1", "Common energy at the end divided by the energy that was brought in.", Of::motion, false,
       "1"},
      {"largest_step_gain", "J",
       "Largest increase over one step of the scheme's own energy, or of the common one, beyond the work of the loads. "
       "Of an exact balance it is by the works of each step; the energy confirms it every sixteen steps.",
       Of::motion, false, "energy_brought_in"},
      {"drift_per_impact", "J",
       "Change of energy that damping and loads do not explain, divided by the number of impacts.", Of::motion, true,
       "energy_brought_in"},
      {"work_of_damping", "J", "Energy taken out by the viscous forces over the run.", Of::motion, false,
       "energy_brought_in"},
      {"work_of_loads", "J",
       "Energy brought in by the distributed load and by the moving support over the run, in the frame of the clamp.",
       Of::motion, true},
      {"work_of_steady_loads", "J", "Of that what loads that do not depend on time gave: what their potential fell by.",
       Of::motion, true},
      {"dissipated_at_contact", "J",
       "Energy taken out by the contact efforts over the run, less what springs at the stops still store. Friction is "
       "apart.",
       Of::motion, false, "energy_brought_in"},
      {"stored_at_stops", "J", "Energy that springs at the stops hold at the end beyond that at the start.", Of::motion,
       true, "energy_brought_in"},
      {"balance_residual", "J",
       "What the balance of the scheme's own energy fails to close by. It is change − loads + damping + losses that "
       "the "
       "scheme declares − work of the stops: round-off × steps where the balance is exact.",
       Of::motion, false, "energy_brought_in"},
      {"projection_energy", "J",
       "Energy after minus before the projection of the initial state on the constraint of a singular mass.",
       Of::motion, true, "energy_brought_in"},
      {"kernel_energy", "J",
       "Energy of the initial state in the kernel of a singular mass, which no inertia holds. It is lost or left "
       "ringing at any step, and 0 after projection.",
       Of::motion, true, "energy_brought_in"},
  };
}

std::vector<MeasureInfo> contact_measures() {
  return {
      {"deepest_penetration", "m", "Largest distance by which a contact point passed its stop.", Of::motion, false,
       "largest_tip_displacement"},
      {"impacts", "1",
       "Number of times that a contact point closed, summed over the points; each is a row of impacts.csv. Contact "
       "that is there from the start is none."},
      {"contact_instants", "1", "Number of instants of contact (sub-steps) at which some point was closed.", Of::motion,
       true},
      {"active_set_changes", "1", "Number of sub-steps at which the set of closed contact points changed.", Of::motion,
       true},
      {"impulse", "N s",
       "Momentum that the contact efforts give, summed by magnitude over the contact points. What an effort of each "
       "stage is worth follows from the scheme's plan."},
      {"peak_contact_force", "N",
       "Largest force at one contact point over the run, from every step. Blank where a rigid law has thrown back a "
       "point with mass: that force is the impulse over a step or two, and has no limit."},
      {"contact_time",
       "s",
       "Time in contact, summed over the contact points.",
       Of::motion,
       true,
       "",
       {},
       false,
       "impacts"},
      {"contact_force_mean", "N",
       "Mean of the contact force over the study's window, summed over the points, of a clearance along its first "
       "component. Times the window it is the impulse. The instants of a step count by the momentum that an effort of "
       "each gives."},
      {"contact_force_deviation", "N", "Standard deviation of the contact force from that mean, over the window."},
      {"window_power", "W", "Energy lost at the stops in a second: mean over the parts of the study's window."},
      {"confidence.window_power", "W", "Half the 95 % interval of that mean (stationary block bootstrap of the parts).",
       Of::computation},
      {"window_force", "N",
       "Momentum that the stops give in a second, summed by magnitude over the points: such a mean."},
      {"confidence.window_force", "N", "Half the 95 % interval of that mean.", Of::computation},
      {"window_impact_rate", "1/s", "How often a contact point closes in a second: such a mean."},
      {"confidence.window_impact_rate", "1/s", "Half the 95 % interval of that mean.", Of::computation},
      {"window_tip_rms", "m", "Root mean square of the displacement of the tip over the window.", Of::motion, false,
       "largest_tip_displacement"},
      {"confidence.window_tip_rms", "m", "Half its 95 % interval, by the squares of the parts.", Of::computation},
      {"complementarity_residual", "m or m/s",
       "Largest complementarity residual of the contact problem over the run, in units of the measure (position or "
       "velocity).",
       Of::motion, true},
      {"law_iterations", "1", "Most iterations that one solve of the contact law took."},
  };
}

/// What law and scheme took, and the motion and the march as a whole.
std::vector<MeasureInfo> run_measures() {
  return {
      {"dissipated_by_law", "J",
       "Energy that a compliant law itself took out over the run, by the power that it reports. It is the share of a "
       "damper in what is dissipated at contact.",
       Of::motion, false, "energy_brought_in"},
      {"dissipated_by_scheme", "J",
       "Energy that the scheme itself took out over the run, apart from damping and stops: numerical damping, where "
       "the scheme declares its losses.",
       Of::motion, false, "energy_brought_in"},
      {"first_impact", "s", "Time of the first impact.", Of::motion, true, "", {}, false, "1"},
      {"first_release", "s", "Time at which a contact point first opened again.", Of::motion, true, "", {}, false, "1"},
      {"tip_displacement_end", "m",
       "Displacement of the tip at the end of the run: absolute, unless scene.frame is supports.", Of::motion, false,
       "largest_tip_displacement"},
      {"largest_tip_displacement", "m", "Largest displacement of the tip, in size, over the steps of the run.",
       Of::motion, true},
      {"smallest_gap", "m", "Smallest distance from a contact point of the undeformed structure to a stop of its own.",
       Of::motion, true},
      {contact_steps_measure, "1",
       "Steps in half a period of the mode that the compliant law's spring has at the point hit hardest.",
       Of::computation, true},
      {"steps_visited", "1",
       "Steps that were marched; the others were left out, since contact changed in none of them.", Of::computation},
      {"microseconds_per_step", "µs",
       "Processor time of the marching, the audit of energies and contact included, divided by the number of steps.",
       Of::computation},
  };
}

/// Of cases in which something rubs.
std::vector<MeasureInfo> friction_measures() {
  std::vector<MeasureInfo> measures = {
      {"dissipated_by_friction", "J",
       "Energy taken out by friction over the run, less what springs along the surfaces still store.", Of::motion,
       false, "energy_brought_in"},
      {"friction_residual", "1", "Largest residual of friction over the run, over the largest effort.", Of::motion,
       true},
      {"friction_turns", "1", "Most turns between contact and friction that one stage took.", Of::computation},
  };
  for (MeasureInfo& measure : measures) measure.where_met = true;
  return measures;
}

std::vector<MeasureInfo> trajectory_measures() {
  std::vector<MeasureInfo> all = energy_measures();
  for (const std::vector<MeasureInfo>& more : {contact_measures(), run_measures(), friction_measures()})
    all.insert(all.end(), more.begin(), more.end());
  return all;
}

/// How answers speak of them.
std::vector<MeasureInfo> with_readings(std::vector<MeasureInfo> measures) {
  constexpr int more = 1, less = -1, neither = 0;
  const std::map<std::string, MeasureInfo::Reading> readings = {
      {"energy_left", {"the energy left", more, 1.0}},
      {"energy_ratio", {"the energy left", more, 1.0}},
      {"dissipated_at_contact", {"energy lost at the stops", less, 0.0}},
      {"dissipated_by_friction", {"energy lost by friction", less, 0.0}},
      {"largest_step_gain", {"largest energy gain of one step", less, std::nullopt, true}},
      {"contact_force_deviation", {"deviation of the force", less, std::nullopt, true}},
      {"contact_force_mean", {"mean force", neither}},
      {"peak_contact_force", {"peak force", neither}},
      {"tip_displacement_end", {"the tip at the end", neither}},
      {"deepest_penetration", {"deepest penetration", neither}},
      {"window_power", {"power lost at the stops", neither}},
      {"window_force", {"force on the stops", neither}},
      {"window_impact_rate", {"impacts per second", neither}},
      {"window_tip_rms", {"root mean square of the tip", neither}},
      {"contact_time", {"time in contact", neither}},
      {"active_set_changes", {"switches of contact", neither}},
      {"balance_residual", {"residual of the energy balance", less, std::nullopt, true}},
  };
  for (MeasureInfo& measure : measures) {
    if (const auto found = readings.find(measure.name); found != readings.end()) measure.reading = found->second;
    // What steps sample of half a period.
    if (measure.name == std::string_view("peak_contact_force") ||
        measure.name == std::string_view("deepest_penetration"))
      measure.floor = contact_steps_measure;
  }
  return measures;
}

std::string signed_percent(double ratio) {
  const double percent = 100 * ratio;
  constexpr double tenth = 0.05, double_noise = 1e-13;  // percent
  if (std::abs(percent) < double_noise) return "unchanged";
  const char* sign = percent < 0 ? "−" : "+";
  const double size = std::abs(percent);
  return size < tenth ? fmt::format("{}{:.1e} %", sign, size) : fmt::format("{}{:.1f} %", sign, size);
}

}  // namespace

std::string energies_text(const CaseRecord& record) {
  std::vector<std::string> parts;
  auto start = measure(record, "energy_start");
  auto end = measure(record, "energy_end");
  if (start && end) {
    std::string text = fmt::format("energy {:.4g} J → {:.4g} J", *start, *end);
    const auto brought_in = measure(record, "energy_brought_in"), left = measure(record, "energy_left");
    if (brought_in && *brought_in > *start)
      text += fmt::format(", {:.4g} J brought in by loads", *brought_in - *start);
    else if (left)
      text += fmt::format(" ({})", signed_percent(*left - 1));
    parts.push_back(text);
  }
  if (const auto impacts = measure(record, "impacts"))
    parts.push_back(fmt::format("{:.0f} impact{}", *impacts, *impacts == 1 ? "" : "s"));
  if (const auto cost = measure(record, "microseconds_per_step")) parts.push_back(fmt::format("{:.3g} µs/step", *cost));
  return fmt::format("{}", fmt::join(parts, ", "));
}

namespace {

Field window_key() {
  using namespace keys;
  ObjectForm window;
  window.fields = {single(real("from", "s", non_negative, std::nullopt, "Begin.")),
                   single(real("to", "s", positive, std::nullopt, "End.")),
                   optional(integer("parts", {WindowMeans::fewest_parts, 100000, false, false}, std::nullopt,
                                    "Equal parts, for means; null: none."))};
  return object("window", Json(nullptr), "Where the contact force is measured; null: nowhere.", window);
}

Field snapshots_key() {
  return keys::optional(keys::integer("snapshots", {1, Snapshots::most_instants, false, false}, std::nullopt,
                                      "Instants of each film; null: none."));
}

void check_window(const Json& study) {
  const auto window = study.find("window");
  if (window == study.end() || window->is_null()) return;
  const double from = (*window)["from"].get<double>(), to = (*window)["to"].get<double>();
  if (to <= from || to > study["duration"].get<double>())
    throw InputError("/window/to",
                     fmt::format("a window from {} to {} s in a run of {} s; expected from < to ≤ duration", from, to,
                                 study["duration"].get<double>()));
}

std::vector<std::string> measure_names(const std::vector<MeasureInfo>& measures) {
  std::vector<std::string> names = {"status"};
  for (const MeasureInfo& info : measures) names.emplace_back(info.name);
  return names;
}

/// Where loads in time bring energy in, what is left of it at the end says little: what went at the stops is asked for.
std::vector<std::string> observed_energies(const StudyResults& results) {
  const bool driven = std::any_of(results.cases.begin(), results.cases.end(),
                                  [](const CaseRecord& record) { return answers::is_driven(record); });
  const auto any_has = [&](const char* name) {
    return std::any_of(results.cases.begin(), results.cases.end(),
                       [&](const CaseRecord& record) { return measure(record, name).has_value(); });
  };
  // Paths of a chaotic motion part; its means do not.
  if (any_has("window_tip_rms")) return {"window_tip_rms", "window_force", "window_impact_rate", "window_power"};
  std::vector<std::string> names = {driven ? "dissipated_at_contact" : "energy_left"};
  if (any_has("dissipated_by_friction")) names.emplace_back("dissipated_by_friction");
  names.insert(names.end(), {"impulse", "tip_displacement_end"});
  return names;
}

// Names of the points of a study, or of their fields: "mid_moment".
std::vector<std::string> point_names(const Json& study, bool fields) {
  std::vector<std::string> names;
  if (!study.contains("scene") || !study.at("scene").contains("points")) return names;
  for (const auto& point : study.at("scene").at("points")) {
    const auto name = point.at("name").get<std::string>();
    if (!fields) names.push_back(name);
    const Json asked = point.value("fields", Json::array());
    for (const char* field : {"moment", "shear"})
      if (fields && std::find(asked.begin(), asked.end(), field) != asked.end()) names.push_back(name + "_" + field);
  }
  return names;
}

StudyKind trajectory_format(const std::vector<MeasureInfo>& measures) {
  StudyKind format;
  format.name = "trajectory";
  format.text = "Each case integrates its scene once.";
  format.shows_points = true;
  format.keys = {keys::step(),
                 keys::duration(),
                 keys::samples(),
                 keys::march("auto"),
                 keys::optional(window_key()),
                 snapshots_key(),
                 outputs_key(),
                 keys::budget(),
                 keys::observe(measure_names(measures))};
  format.keys.back().of_each = measures_of_stops();
  format.check = [](const Json& study) {
    check_window(study);
    check_outputs(study);
    check_observed_stops(study);
  };
  // A measure of stops may stand without a name, for all of them.
  std::vector<std::string> names = measure_names(measures);
  for (const std::string& one : measures_of_stops()) names.push_back(one);
  format.check_measure = [observe = format.keys.back(), names](const Json& study, const std::string& measure,
                                                               const std::string& pointer) {
    const bool of_stops = std::find(observe.of_each.begin(), observe.of_each.end(), measure) != observe.of_each.end();
    const Json& stops = study.at("scene").at("stops");
    if (of_stops && stops.is_array() && !stops.empty()) {
      check_stop_measure(study, measure + "[" + stops.front().at("name").get<std::string>() + "]", pointer);
      return;
    }
    std::vector<Axis> none;
    ObjectForm form;
    form.fields = {observe};
    try {
      check_object(form, {{"observe", measure}}, "", none);
    } catch (const InputError& error) {
      if (of_stops)
        throw InputError(pointer, quote(measure) +
                                      " is of stops with names; write the stops of the scene as a list, "
                                      "each with a name");
      const std::string near = did_you_mean(measure, names);
      throw InputError(pointer, near.empty() ? error.what() : "no measure is called " + quote(measure) + near);
    }
    check_stop_measure(study, measure, pointer);
  };
  format.settings = [](const nlohmann::ordered_json& resolved) {
    return given_settings(resolved, {"window", "snapshots", "outputs", "budget"});
  };
  return format;
}

class TrajectoryKind final : public Kind {
 public:
  explicit TrajectoryKind(const std::vector<MeasureInfo>& of_cases) : Kind(trajectory_format(of_cases), of_cases) {}
  CasePlan plan(const StudyCase& study_case, const Registry& registry) const override {
    return plan_case(study_case, registry);
  }
  CaseRunner start(const RunContext& context) const override {
    CaseRunner runner;
    runner.run = [&registry = context.registry](const StudyCase& study_case, const std::atomic<bool>& stop) {
      return run_case(study_case, registry, stop);
    };
    return runner;
  }
  bool marches_once() const override { return true; }
  CaseRecord march(const StudyCase& study_case, const Registry& registry,
                   const std::atomic<bool>& stop) const override {
    return run_case(study_case, registry, stop);
  }
  Analysis analysis(StudyResults& results, const Choices& study) const override {
    describe_contact(results.cases);
    collect_tables(results);
    for (Table table : {energy_ends_table(results), energy_ledger_table(results), answers::uncertainty_table(study)})
      if (!table.rows.empty()) results.derived.push_back(std::move(table));
    return {report::trajectory_page()};
  }
  std::vector<std::string> observed(const StudyResults& results) const override { return observed_energies(results); }
  Table curve(const StudyResults& results) const override {
    return curves_head(point_names(results.study, false), point_names(results.study, true));
  }
  std::string outcome(const CaseRecord& record) const override { return energies_text(record); }
  bool measures_stand() const override { return true; }
  nlohmann::ordered_json alone(const StudyResults& results, const CaseRecord& record) const override {
    return minimal_study(results, record);
  }
};

}  // namespace

KindPointer trajectory_kind() {
  return std::make_unique<TrajectoryKind>(with_readings(trajectory_measures()));
}

namespace {

// "support.amplitude" → "/support/amplitude".
Json::json_pointer scene_pointer(std::string column) {
  std::replace(column.begin(), column.end(), '.', '/');
  return Json::json_pointer("/" + column);
}

}  // namespace

Json minimal_study(const StudyResults& results, const CaseRecord& record) {
  Json scene = results.study.at("scene"), methods = Json::object();
  for (const std::string& role : method_roles())
    if (results.study.at("methods").contains(role)) methods[role] = Json::object();
  Json mesh = {{"elements", 1}}, step, march;
  for (const auto& [column, value] : record.axes) {
    const std::string role = column.substr(0, column.find('.'));
    if (column == "elements" || column == "modes" || column == residual_axis) {
      const std::string key = column == residual_axis ? "residual" : column;
      if (!value.is_null()) mesh[key] = column == residual_axis ? value : said_of_mesh(results.study, key, value);
    } else if (column == "step")
      step = value;
    else if (column == "march")
      march = value;
    else if (is_method_role(role))
      methods[role][column == role ? "name" : column.substr(role.size() + 1)] = value;
    else
      scene[scene_pointer(column)] = value;
  }
  // A scheme that the study states itself goes along.
  const Json::json_pointer times("/methods/time");
  if (results.study.contains(times) && results.study.at(times).is_array())
    for (const Json& method : results.study.at(times))
      if (method.is_object() && method.contains("plan") && method.at("name") == methods["time"].value("name", ""))
        methods["time"]["plan"] = method.at("plan");
  Json study = {{"name", fmt::format("{}-{}", results.name, record.id)},
                {"question", fmt::format("Why did this case of {} end as {}? {}", results.name, word(record.status),
                                         record.reason())},
                {"kind", "trajectory"},
                {"scene", scene},
                {"mesh", mesh},
                {"methods", methods},
                {"step", step}};
  for (const char* key : {"duration", "samples", "window", "snapshots", "outputs", "budget"})
    if (const auto found = results.study.find(key); found != results.study.end() && !found->is_null())
      study[key] = *found;
  if (!march.is_null()) study["march"] = march;
  return study;
}

}  // namespace ricochet
