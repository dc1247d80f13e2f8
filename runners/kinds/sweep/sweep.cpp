#include "runners/kinds/sweep/sweep.hpp"

#include <algorithm>
#include <numbers>

#include "runners/kinds/single_study.hpp"
#include "runners/kinds/sweep/block_orders.hpp"
#include "runners/kinds/sweep/dynamics_tables.hpp"
#include "runners/kinds/sweep/sweep_study.hpp"
#include "runners/kinds/sweep/sweep_tables.hpp"
#include "runners/kinds/sweep/with_parameter.hpp"
#include "runners/kinds/tables_of_cases.hpp"
#include "runners/march/load_changes.hpp"
#include "runners/march/prepare_case.hpp"
#include "runners/store/record_values.hpp"

namespace ricochet {

Kind sweep_kind(RunSweep run, DeriveTables derive) {
  Kind kind;
  kind.format.settings = sweep_settings;
  kind.format.check_methods = check_sweep;
  kind.format.marches_another = some_value_possible;
  kind.format.complete = mark_sweep;
  kind.format.check_cases = check_values;
  kind.start = [run](const RunContext& context) {
    const auto checkpoints = std::make_shared<CheckpointStore>();
    CaseRunner runner;
    runner.open = [checkpoints](CheckpointStore opened, const std::atomic<bool>&) { *checkpoints = std::move(opened); };
    runner.run = [run, checkpoints, blocks = context.blocks, key = context.key, &registry = context.registry](
                     const StudyCase& study_case, const std::atomic<bool>& stop) {
      CaseRecord record = run(study_case, registry, CaseContext{*checkpoints, key(study_case), blocks}, stop);
      if (const double pulsation = forcing_pulsation(study_case.scene); pulsation > 0)
        add_doubts(record,
                   load_changes(study_case.scene, 2 * std::numbers::pi / pulsation / study_case.steps_per_period,
                                study_case.steps_per_period));
      return record;
    };
    runner.block = [marcher = std::make_shared<BlockMarcher>(context.registry)](
                       const StudyCase& study_case, const std::string& order,
                       const std::function<void(std::string)>& so_far,
                       const std::atomic<bool>& stop) { return marcher->march(study_case, order, so_far, stop); };
    return runner;
  };
  kind.tables = [derive](StudyResults& results) {
    const SweptColumns swept = swept_columns(results);
    for (CaseRecord& record : results.cases) describe_sweep(record, swept);
    collect_tables(results, derived_as_dynamics);
    derive(results);
  };
  kind.alone = single_study;
  kind.contradiction = [](const CaseRecord& record) {
    return measure(record, "orbits_lost").value_or(0) > 0 ? "the process of an orbit ended" : "";
  };
  return kind;
}

std::vector<MeasureInfo> orbit_measures() {
  using Of = MeasureInfo::Of;
  return {
      {"orbits", "1", "Orbits that were marched to the end of their kept periods.", Of::computation},
      {"starts", "1", "Cells of a grid that are starts, where others begin beyond a stop.", Of::computation},
      {"orbits_lost", "1", "Orbits that ended the process which marched them, twice.", Of::computation},
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
