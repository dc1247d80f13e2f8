#include "runners/kinds/continuation/continuation.hpp"

#include "runners/asks/kind_verbs.hpp"
#include "runners/kinds/all_kinds.hpp"
#include "runners/kinds/continuation/continuation_study.hpp"
#include "runners/kinds/continuation/continuation_tables.hpp"
#include "runners/kinds/continuation/page/page.hpp"
#include "runners/kinds/continuation/point_tables.hpp"
#include "runners/kinds/kind.hpp"
#include "runners/kinds/stored_study.hpp"
#include "runners/kinds/sweep/sweep.hpp"
#include "runners/kinds/sweep/with_parameter.hpp"
#include "runners/march/prepare_case.hpp"

namespace ricochet {
namespace {

std::vector<MeasureInfo> continuation_measures() {
  using Of = MeasureInfo::Of;
  return {{"branches", "1", "Branches that were followed.", Of::computation},
          {"pieces", "1", "Pieces or steps of all branches.", Of::computation},
          {"special_points", "1", "Special points on them, ends not counted."}};
}

StudyKind continuation_format() {
  StudyKind format;
  format.name = "continuation";
  format.text = "Each case follows periodic orbits, stable or not, along a parameter: folds, flips, first contacts.";
  format.keys = continuation_keys();
  format.settings = continuation_settings;
  format.check = check_continuation;
  format.check_methods = check_followed;
  format.marches_another = some_orbit_possible;
  format.complete = mark_sweep;
  format.check_cases = check_continued_cases;
  format.add_references = add_reference_cases;
  format.check_measure = asks::measures_alone(continuation_measures());
  format.verbs = {"points"};
  format.check_ask = check_points_ask;
  format.default_asks = [](const Json&) { return Json::array({{{"points", {"all"}}}}); };
  return format;
}

class ContinuationKind final : public Kind {
 public:
  ContinuationKind() : Kind(continuation_format(), continuation_measures()) {}
  CasePlan plan(const StudyCase& study_case, const Registry& registry) const override {
    return plan_continuation(study_case, registry);
  }
  CaseRunner start(const RunContext& context) const override {
    const auto checkpoints = std::make_shared<CheckpointStore>();
    CaseRunner runner;
    runner.open = [checkpoints](CheckpointStore opened, const std::atomic<bool>&) { *checkpoints = std::move(opened); };
    runner.run = [checkpoints, key = context.key, &registry = context.registry](const StudyCase& study_case,
                                                                                const std::atomic<bool>& stop) {
      CaseRecord record =
          run_continuation(study_case, registry, CaseContext{*checkpoints, key(study_case), nullptr}, stop);
      if (!study_case.of_reference) add_doubts(record, load_doubts(study_case));
      return record;
    };
    return runner;
  }
  Analysis analysis(StudyResults& results, const Choices& study) const override {
    const SweptColumns swept = swept_columns(results);
    describe_continuation(results.cases, swept);
    collect_tables(results, [](const std::string& table) { return table == special_points_type().name; });
    const auto points = std::make_shared<const PointAnalysis>(study);
    points->append_tables(results);
    return {report::continuation_page(points),
            {{"points", [points](const asks::Ask& ask, const asks::Evidence& evidence) {
                return points_ask(ask, evidence, *points);
              }}}};
  }
  bool has_points() const override { return true; }
  bool only_points() const override { return false; }
  int point(const StudyResults& results, const PointRequest& asked, std::ostream& out) const override {
    return solve_branch_point(results, asked, out);
  }
  nlohmann::ordered_json alone(const StudyResults& results, const CaseRecord& record) const override {
    return is_reference(record) ? nlohmann::ordered_json(nullptr) : single_study(results, record);
  }
};

}  // namespace

KindPointer continuation_kind() {
  return std::make_unique<ContinuationKind>();
}

}  // namespace ricochet
