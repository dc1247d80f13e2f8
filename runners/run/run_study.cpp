#include "runners/run/run_study.hpp"

#include <optional>

#include "runners/kinds/kind.hpp"
#include "runners/march/arithmetic_digest.hpp"
#include "runners/march/study_identity.hpp"
#include "runners/process/isolated_cases.hpp"
#include "runners/report/report.hpp"
#include "runners/run/allowed_processors.hpp"
#include "runners/run/environment.hpp"
#include "runners/run/merge_folders.hpp"
#include "runners/run/study_runner.hpp"

namespace ricochet {
namespace {

std::string render(const StudyResults& results) {
  return render_report(results, page_of(results.kind));
}

}  // namespace

CasePlan plan_for(const std::string& kind, const StudyCase& study_case, const Registry& registry) {
  return find_kind(kind)->plan(study_case, registry);
}

int run_study(const Study& study, const Catalogue& catalogue, const Registry& registry, const RunOptions& options) {
  StudyRunner runner;
  runner.libraries = [&](const StudyCase& study_case) { return libraries_of(study_case, registry); };
  StudyIdentity identity(study, registry);
  const RunContext context{study, registry, [&](const StudyCase& one) { return identity.of(one); },
                           options.jobs > 0 ? options.jobs : allowed_processors().count};
  std::optional<IsolatedCases> isolated;
  if (options.isolate) {
    isolated.emplace(context, IsolationOptions{options.plugins, options.hosts});
    runner.cases = isolated->runner();
    runner.crew = isolated->crew();
    runner.plan = [&](const StudyCase& study_case) {
      CasePlan plan;
      plan.predicted_seconds = isolated->predicted_seconds(study_case);
      return plan;
    };
  } else {
    runner.cases = find_kind(study.kind)->start(context);
    runner.plan = [&](const StudyCase& study_case) { return plan_for(study.kind, study_case, registry); };
  }
  runner.arithmetic = arithmetic_digest();
  runner.environment = [&] { return describe_environment(catalogue.opened()); };
  runner.render = render;
  RunOptions shared = options;
  if (isolated) shared.jobs = isolated->cases_at_once();
  return run_study_with(runner, study, shared);
}

int merge_folders(const std::vector<std::filesystem::path>& folders, const std::filesystem::path& out,
                  const std::vector<std::filesystem::path>& plugins) {
  return merge_folders_with(render, folders, out, plugins, stdout);
}

int rebuild_report(const std::filesystem::path& folder) {
  return rebuild_report_with(render, folder);
}

}  // namespace ricochet
