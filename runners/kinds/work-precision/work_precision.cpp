#include "runners/kinds/all_kinds.hpp"
#include "runners/kinds/comparison/comparison.hpp"
#include "runners/kinds/comparison/comparison_answers.hpp"
#include "runners/kinds/comparison/comparison_tables.hpp"
#include "runners/kinds/work-precision/page/page.hpp"
#include "runners/study/fields.hpp"

namespace ricochet {

namespace {

std::vector<Field> work_precision_keys() {
  std::vector<Field> keys = comparison_keys();
  keys.push_back(keys::integer("repeats", {1, 1000, false, false}, 5, "How often each case is timed."));
  return keys;
}

std::vector<MeasureInfo> timed_measures() {
  using Of = MeasureInfo::Of;
  return {
      {"timed_seconds", "s", "Processor time of the marching alone, nothing observed: median of the repeats.",
       Of::computation},
      {"timed_low", "s", "The fastest repeat.", Of::computation},
      {"timed_high", "s", "The slowest repeat.", Of::computation},
  };
}

class WorkPrecisionKind final : public ComparisonKind {
 public:
  WorkPrecisionKind()
      : ComparisonKind("work-precision",
                       "Each case is compared with a reference and timed: error against processor time.",
                       work_precision_keys(), timed_measures(), {"order", "cheapest"}, default_cheapest_asks) {}
  CaseRunner start(const RunContext& context) const override {
    CaseRunner runner = ComparisonKind::start(context);
    runner.time = [&registry = context.registry](const StudyCase& study_case,
                                                 const std::atomic<bool>& stop) -> std::optional<TimedMarch> {
      const double begun = thread_seconds();
      const auto marching = time_case(study_case, registry, stop);
      if (!marching) return std::nullopt;
      return TimedMarch{*marching, thread_seconds() - begun};
    };
    return runner;
  }
  Analysis analysis(StudyResults& results, const Choices& study) const override {
    put_tables(results, study, [](const StudyResults& of) -> std::vector<Table> {
      return {work_precision_table(of), precision_targets_table(of)};
    });
    return {report::work_precision_page(), {{"order", order_ask}, {"cheapest", cheapest_ask}}};
  }
};

}  // namespace

KindPointer work_precision_kind() {
  return std::make_unique<WorkPrecisionKind>();
}

}  // namespace ricochet
