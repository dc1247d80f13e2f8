#include "runners/kinds/sweep/sweep.hpp"

#include <algorithm>

#include "runners/kinds/sweep/dynamics_tables.hpp"
#include "runners/kinds/sweep/sweep_study.hpp"
#include "runners/kinds/sweep/sweep_tables.hpp"
#include "runners/kinds/tables_of_cases.hpp"
#include "runners/kinds/trajectory/minimal_study.hpp"

namespace ricochet {
namespace {

/// The study of one case of a sweep alone: its own methods, mesh and steps per period, the study's parameter and keys.
nlohmann::ordered_json single_sweep(const StudyResults& results, const CaseRecord& record) {
  nlohmann::ordered_json study = minimal_study(results, record);
  study["kind"] = results.kind;
  study.erase("step");
  for (const auto& [name, value] : record.axes) {
    const std::string role = name.substr(0, name.find('.'));
    if (name == "steps_per_period") {
      study["steps_per_period"] = value;
    } else if (name != "elements" && !study["methods"].contains(role)) {
      // An axis of the scene stays one: the case keeps its id.
      std::string place = "/" + name;
      std::replace(place.begin(), place.end(), '.', '/');
      study["scene"][nlohmann::ordered_json::json_pointer(place)] = nlohmann::ordered_json::array({value});
    } else if (value == "swept") {
      // The parameter is one of the method's: the study has a number there, which it replaces.
      const std::string key = name.substr(role.size() + 1);
      for (const auto& method : results.study.at("methods").at(role))
        if (method.at("name") == study["methods"][role].at("name") && method.contains(key))
          study["methods"][role][key] = method[key];
    }
  }
  study["scene"].erase("steps_per_period");
  for (const auto& [key, value] : results.study.items())
    if (!study.contains(key) && key != "exclude") study[key] = value;
  return study;
}

}  // namespace

Kind sweep_kind(RunSweep run) {
  Kind kind;
  kind.format.settings = sweep_settings;
  kind.format.check_methods = check_sweep;
  kind.format.complete = mark_sweep;
  kind.format.check_cases = check_values;
  kind.start = [run](const RunContext& context) {
    const auto shelf = std::make_shared<MotionShelf>();
    const int workers = std::max(1, context.jobs / static_cast<int>(context.study.cases.size()));
    CaseRunner runner;
    runner.open = [shelf](MotionShelf opened, const std::atomic<bool>&) { *shelf = std::move(opened); };
    runner.run = [run, shelf, workers, key = context.key, &registry = context.registry](const StudyCase& study_case,
                                                                                        const std::atomic<bool>& stop) {
      return run(study_case, registry, CaseDesk{*shelf, key(study_case), workers}, stop);
    };
    return runner;
  };
  kind.tables = [](StudyResults& results) {
    const SweptColumns swept = swept_columns(results);
    for (CaseRecord& record : results.cases) describe_sweep(record, swept);
    collect_tables(results, derived_as_dynamics);
    derive_dynamics(results);
  };
  kind.alone = single_sweep;
  return kind;
}

std::vector<MeasureInfo> orbit_measures() {
  using Of = MeasureInfo::Of;
  return {
      {"orbits", "1", "Orbits that were marched to the end of their kept periods.", Of::computation},
      {"share_periodic", "1", "Share of these orbits that repeat, contact-free ones not counted."},
      {"share_chaotic", "1", "Share of these orbits that are chaotic."},
      {"impacts_per_period", "1", "Impacts in one forcing period, mean over these orbits."},
      {"largest_exponent", "1/s", "Largest Lyapunov exponent among these orbits."},
      {"exponent_seconds", "s", "Processor time of the exponents.", Of::computation},
      {"lane_steps_per_second", "1/s", "Steps of single orbits per second of processor time, exponents not counted.",
       Of::computation},
  };
}

}  // namespace ricochet
