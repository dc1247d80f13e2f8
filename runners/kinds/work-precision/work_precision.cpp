#include "runners/kinds/work-precision/work_precision.hpp"

#include "runners/kinds/comparison/comparison.hpp"
#include "runners/kinds/comparison/comparison_answers.hpp"
#include "runners/kinds/comparison/comparison_tables.hpp"
#include "runners/kinds/comparison/run_comparison.hpp"
#include "runners/kinds/tables_of_cases.hpp"
#include "runners/kinds/trajectory/contact_rows.hpp"
#include "runners/kinds/trajectory/run_case.hpp"
#include "runners/kinds/trajectory/trajectory.hpp"
#include "runners/kinds/work-precision/page/page.hpp"
#include "runners/study/fields.hpp"

namespace ricochet {

Kind work_precision_kind() {
  using Of = MeasureInfo::Of;
  Kind kind;
  kind.format.name = "work-precision";
  kind.format.text = "Each case is compared with a reference and timed: error against processor time.";
  kind.format.keys = comparison_keys();
  kind.format.keys.push_back(keys::integer("repeats", {1, 1000, false, false}, 5, "How often each case is timed."));
  kind.format.settings = comparison_settings;
  kind.format.check = check_comparison;
  kind.plan = plan_case;
  kind.beside = seconds_beside;
  kind.march = run_case;
  kind.start = [](const RunContext& context) {
    CaseRunner runner = compare_cases(context);
    runner.time = [&registry = context.registry](const StudyCase& study_case,
                                                 const std::atomic<bool>& stop) -> std::optional<TimedMarch> {
      const double begun = thread_seconds();
      const auto marching = time_case(study_case, registry, stop);
      if (!marching) return std::nullopt;
      return TimedMarch{*marching, thread_seconds() - begun};
    };
    return runner;
  };
  kind.tables = [](StudyResults& results) {
    results.derived.push_back(errors_table(results));
    results.derived.push_back(orders_table(results));
    results.derived.push_back(order_verdicts_table(results.derived.back()));
    results.derived.push_back(order_runs_table(answers::Compared(results)));
    results.derived.push_back(work_precision_table(results));
    results.derived.push_back(precision_targets_table(results));
    describe_contact(results.cases);
    collect_tables(results);
  };
  kind.answers = [](const StudyResults& results) { return precision_answer(answers::Compared(results)); };
  kind.curve = curves_head();
  kind.outcome = errors_text;
  kind.measures = {
      {"timed_seconds", "s", "Processor time of the marching alone, nothing observed: median of the repeats.",
       Of::computation},
      {"timed_low", "s", "The fastest repeat.", Of::computation},
      {"timed_high", "s", "The slowest repeat.", Of::computation},
  };
  kind.alone = minimal_study;
  kind.page = report::work_precision_page;
  return kind;
}

}  // namespace ricochet
