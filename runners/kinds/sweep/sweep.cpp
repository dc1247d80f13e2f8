#include "runners/kinds/sweep/sweep.hpp"

#include "runners/asks/kind_verbs.hpp"
#include "runners/kinds/kind.hpp"
#include "runners/kinds/stored_study.hpp"
#include "runners/kinds/sweep/block_orders.hpp"
#include "runners/kinds/sweep/diagram_tables.hpp"
#include "runners/kinds/sweep/sweep_tables.hpp"
#include "runners/kinds/sweep/with_parameter.hpp"
#include "runners/march/prepare_case.hpp"
#include "runners/store/record_values.hpp"
#include "runners/study/fields.hpp"

namespace ricochet {

std::vector<Field> orbit_keys() {
  using namespace keys;
  ObjectForm transient;
  transient.fields = {
      integer("periods", {1, 100000000, false, false}, 300, "Forcing periods before the first reading."),
      integer("at_most", {1, 100000000, false, false}, 2000,
              "Periods after which an orbit is read though it has not settled.")};
  return {object("transient", Json::object(), "Forcing periods until an orbit has settled.", transient),
          integer("keep", {16, 10000000, false, false}, 300, "Forcing periods that are read."),
          word("section", {"strobe", "impact", "extremum"}, "strobe",
               "When the state is read: each forcing period, at impacts, or at extrema of the tip."),
          single(real("phase", "rad", any, 0.0, "Phase of the forcing at which the strobe reads."))};
}

ObjectForm swept_range(const char* what) {
  using namespace keys;
  ObjectForm keys;
  keys.fields = {single(real("from", "as the parameter", any, std::nullopt, "First value.")),
                 single(real("to", "as the parameter", any, std::nullopt, "Last value.")),
                 integer("count", {2, 1000000, false, false}, std::nullopt, what)};
  return keys;
}

Field swept_pointer() {
  using namespace keys;
  return of_form(
      Field::Form::text, "pointer", std::nullopt,
      "Pointer to a number of the scene (\"/scene/support/amplitude\"; a formula is multiplied by the value) or to a "
      "real parameter of a method (\"/methods/contact/stiffness\").");
}

namespace {

StudyKind sweep_format(const char* name, const char* text, std::vector<Field> keys, std::vector<std::string> verbs,
                       std::function<void(const Study&, const Json&, const std::string&)> check_ask,
                       std::function<Json(const Json&)> default_asks) {
  StudyKind format;
  format.check_measure = asks::measures_alone(orbit_measures());
  format.name = name;
  format.text = text;
  format.keys = std::move(keys);
  format.settings = sweep_settings;
  format.check_methods = check_sweep;
  format.marches_another = some_value_possible;
  format.complete = mark_sweep;
  format.check_cases = check_values;
  format.verbs = std::move(verbs);
  format.check_ask = std::move(check_ask);
  format.default_asks = std::move(default_asks);
  return format;
}

}  // namespace

SweepKind::SweepKind(const char* name, const char* text, std::vector<Field> keys, std::vector<std::string> verbs,
                     std::function<void(const Study&, const Json&, const std::string&)> check_ask,
                     std::function<Json(const Json&)> default_asks, std::vector<MeasureInfo> of_cases)
    : Kind(sweep_format(name, text, std::move(keys), std::move(verbs), std::move(check_ask), std::move(default_asks)),
           std::move(of_cases)) {}

CaseRunner SweepKind::start(const RunContext& context) const {
  const auto checkpoints = std::make_shared<CheckpointStore>();
  CaseRunner runner;
  runner.open = [checkpoints](CheckpointStore opened, const std::atomic<bool>&) { *checkpoints = std::move(opened); };
  runner.run = [this, checkpoints, blocks = context.blocks, key = context.key, &registry = context.registry](
                   const StudyCase& study_case, const std::atomic<bool>& stop) {
    CaseRecord record = run(study_case, registry, CaseContext{*checkpoints, key(study_case), blocks}, stop);
    add_doubts(record, load_doubts(study_case));
    return record;
  };
  runner.block = [marcher = std::make_shared<BlockMarcher>(context.registry)](
                     const StudyCase& study_case, const std::string& order,
                     const std::function<void(std::string)>& so_far,
                     const std::atomic<bool>& stop) { return marcher->march(study_case, order, so_far, stop); };
  return runner;
}

Analysis SweepKind::analysis(StudyResults& results, const Choices&) const {
  const SweptColumns swept = swept_columns(results);
  describe_sweep(results.cases, swept);
  collect_tables(results, derived_as_dynamics);
  return derive(results);
}

std::string SweepKind::contradiction(const CaseRecord& record) const {
  return measure(record, "orbits_lost").value_or(0) > 0 ? "the process of an orbit ended" : "";
}

nlohmann::ordered_json SweepKind::alone(const StudyResults& results, const CaseRecord& record) const {
  return single_study(results, record);
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
      {"confidence.largest_exponent", "1/s", "Half the 95 % interval of that exponent, by its kept periods.",
       Of::computation},
      {"exponent_seconds", "s", "Processor time of the exponents.", Of::computation},
      {"lane_steps_per_second", "1/s", "Steps of single orbits per second of processor time, exponents not counted.",
       Of::computation},
  };
}

}  // namespace ricochet
