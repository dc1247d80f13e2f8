#include "runners/execution/run_study.hpp"

#include "runners/execution/environment.hpp"
#include "runners/execution/study_runner.hpp"
#include "runners/report/report.hpp"

namespace ricochet {

int run_study(const Study& study, const Catalogue& catalogue, const Registry& registry, const RunOptions& options) {
  StudyRunner runner;
  runner.plan = [&](const StudyCase& study_case) { return plan_case(study_case, registry); };
  runner.run = [&](const StudyCase& study_case, const std::atomic<bool>& stop) {
    return run_case(study_case, registry, stop);
  };
  runner.libraries = [&](const StudyCase& study_case) {
    return std::vector<std::filesystem::path>{registry.file(Role::mass, study_case.mass.name),
                                              registry.file(Role::contact, study_case.contact.name),
                                              registry.file(Role::time, study_case.time.name)};
  };
  runner.environment = [&] { return describe_environment(catalogue.opened()); };
  runner.render = render_report;
  return run_study_with(runner, study, options);
}

int rebuild_report(const std::filesystem::path& folder) {
  return rebuild_report_with(render_report, folder);
}

}  // namespace ricochet
