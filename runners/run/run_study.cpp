#include "runners/run/run_study.hpp"

#include <mutex>

#include "runners/kinds/kind.hpp"
#include "runners/march/arithmetic_digest.hpp"
#include "runners/report/report.hpp"
#include "runners/run/allowed_processors.hpp"
#include "runners/run/environment.hpp"
#include "runners/run/study_runner.hpp"
#include "runners/store/fingerprint.hpp"

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
  runner.plan = [&](const StudyCase& study_case) { return plan_for(study.kind, study_case, registry); };
  runner.libraries = [&](const StudyCase& study_case) {
    return std::vector<std::filesystem::path>{registry.file(Role::mass, study_case.mass.name),
                                              registry.file(Role::contact, study_case.contact.name),
                                              registry.file(Role::time, study_case.time.name)};
  };
  // Each library is read and hashed once in a run; cases of several threads ask.
  Fingerprints fingerprints(study.kind, program_hash());
  std::mutex asked;
  const auto key = [&](const StudyCase& study_case) {
    const std::lock_guard guard(asked);
    return fingerprints.of(study_case, runner.libraries(study_case));
  };
  const int jobs = options.jobs > 0 ? options.jobs : allowed_processors().count;
  runner.cases = find_kind(study.kind)->start({study, registry, key, jobs});
  runner.arithmetic = arithmetic_digest();
  runner.environment = [&] { return describe_environment(catalogue.opened()); };
  runner.render = render;
  return run_study_with(runner, study, options);
}

int rebuild_report(const std::filesystem::path& folder) {
  return rebuild_report_with(render, folder);
}

}  // namespace ricochet
