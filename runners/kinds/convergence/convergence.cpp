#include "runners/kinds/convergence/convergence.hpp"

#include "runners/kinds/comparison/comparison.hpp"
#include "runners/kinds/comparison/comparison_answers.hpp"
#include "runners/kinds/comparison/comparison_tables.hpp"
#include "runners/kinds/comparison/page/page.hpp"
#include "runners/kinds/tables_of_cases.hpp"
#include "runners/kinds/trajectory/contact_rows.hpp"
#include "runners/kinds/trajectory/run_case.hpp"
#include "runners/kinds/trajectory/trajectory.hpp"

namespace ricochet {

Kind convergence_kind() {
  Kind kind;
  kind.format.name = "convergence";
  kind.format.text = "Each case is compared with a reference, and orders are fitted to the errors.";
  kind.format.keys = comparison_keys();
  kind.format.settings = comparison_settings;
  kind.format.check = check_comparison;
  kind.plan = plan_case;
  kind.beside = seconds_beside;
  kind.march = run_case;
  kind.start = compare_cases;
  kind.tables = [](StudyResults& results) {
    results.derived.push_back(errors_table(results));
    results.derived.push_back(orders_table(results));
    results.derived.push_back(order_verdicts_table(results.derived.back()));
    results.derived.push_back(order_runs_table(answers::Compared(results)));
    describe_contact(results.cases);
    collect_tables(results);
  };
  kind.answers = [](const StudyResults& results) { return orders_answer(answers::Compared(results)); };
  kind.curve = curves_head();
  kind.outcome = errors_text;
  kind.measures = comparison_measures();
  kind.alone = minimal_study;
  kind.page = report::comparison_page;
  return kind;
}

}  // namespace ricochet
