#include "runners/run/run_study.hpp"

#include <atomic>
#include <optional>

#include "runners/kinds/kind.hpp"
#include "runners/march/seconds.hpp"
#include "runners/march/study_identity.hpp"
#include "runners/report/report.hpp"
#include "runners/run/analysed_results.hpp"
#include "runners/run/asked_text.hpp"
#include "runners/run/environment.hpp"
#include "runners/run/merge_folders.hpp"
#include "runners/run/outputs.hpp"
#include "runners/run/study_runner.hpp"
#include "runners/run/waiting_line.hpp"
#include "runners/workers/allowed_processors.hpp"
#include "runners/workers/isolated_cases.hpp"

namespace ricochet {
namespace {

std::string render(const AnalysedResults& results) {
  return render_report(results.choices, page_of_study(results));
}

constexpr double short_run = 1;          // s
constexpr double of_each_case = 1.6e-3;  // s for its row, its curve, its share of tables and page

/// Whether all cases together are predicted to take less than a second. References are not foreseen.
bool is_short(const Study& study, const StudyRunner& here) {
  if (find_kind(study.kind)->works_beside()) return false;
  double seconds = of_each_case * static_cast<double>(study.cases.size());
  if (seconds >= short_run) return false;
  std::atomic<bool> long_enough{false};
  const WaitingLine waiting("planning cases");
  const double begun = thread_seconds();
  double planned = 0;  // one case of those that cost the same
  StudyRunner planner;
  planner.plan = [&](const StudyCase& one) {
    CasePlan plan = here.plan(one);
    planned += plan.predicted_seconds;
    if (seconds + planned + thread_seconds() - begun >= short_run) long_enough = true;
    return plan;
  };
  std::vector<PendingCase> cases;
  for (const StudyCase& one : study.cases)
    if (!one.excluded) cases.push_back({&one, 0, ""});
  predict_cases(planner, cases, 1, long_enough);
  for (const PendingCase& one : cases) seconds += one.predicted_seconds;
  return !long_enough && seconds < short_run;
}

}  // namespace

CasePlan plan_for(const std::string& kind, const StudyCase& study_case, const Registry& registry) {
  return find_kind(kind)->plan(study_case, registry);
}

int run_study(const Study& study, const Catalogue& catalogue, const Registry& registry, const RunOptions& options) {
  StudyRunner runner;
  runner.libraries = [&](const StudyCase& study_case) { return libraries_of(study_case, registry); };
  StudyIdentity identity(study, registry);
  const RunContext context{study, registry, [&](const StudyCase& one) { return identity.of(one); }};
  RunOptions shared = options;
  std::optional<IsolatedCases> workers;
  runner.plan = [&](const StudyCase& study_case) { return plan_for(study.kind, study_case, registry); };
  if (options.where == RunOptions::Where::here ||
      (options.where == RunOptions::Where::here_if_short && is_short(study, runner))) {
    shared.jobs = 1;
    runner.cases = find_kind(study.kind)->start(context);
  } else {
    const int jobs = options.jobs > 0 ? options.jobs : allowed_processors().count;
    workers.emplace(context, IsolationOptions{jobs, options.plugins, options.hosts});
    shared.jobs = workers->cases_at_once();
    runner.cases = workers->runner();
    runner.workers = workers->workers_in_words();
    runner.plan = [&](const StudyCase& study_case) {
      CasePlan plan;
      plan.predicted_seconds = workers->predicted_seconds(study_case);
      return plan;
    };
  }
  runner.arithmetic = arithmetic_digest();
  runner.environment = [&] { return describe_environment(catalogue.opened()); };
  runner.render = render;
  return run_study_with(runner, study, shared);
}

int merge_folders(const std::vector<std::filesystem::path>& folders, const std::filesystem::path& out,
                  const std::vector<std::filesystem::path>& plugins) {
  return merge_folders_with(render, folders, out, plugins, stdout);
}

void write_results(const AnalysedResults& results, const std::filesystem::path& folder) {
  write_outputs(folder, results, [&] { return render(results); });
}

int rebuild_report(const std::filesystem::path& folder, bool json) {
  return rebuild_report_with(render, folder, json);
}

}  // namespace ricochet
