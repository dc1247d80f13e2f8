#include "runners/run/run_study.hpp"

#include <fmt/format.h>

#include <optional>
#include <set>
#include <thread>

#include "runners/kinds/basins/run_basins.hpp"
#include "runners/kinds/bifurcation/run_bifurcation.hpp"
#include "runners/kinds/comparison/run_comparison.hpp"
#include "runners/kinds/stability/run_stability.hpp"
#include "runners/report/report.hpp"
#include "runners/run/environment.hpp"
#include "runners/run/study_runner.hpp"
#include "runners/store/fingerprint.hpp"
#include "runners/study/field.hpp"

namespace ricochet {
namespace {

// A study none of whose scenes has a reference is told so before anything runs.
void require_reference(const Study& study, References& references, const MotionShelf& shelf,
                       const std::atomic<bool>& stop) {
  std::set<std::string> scenes, refusals;
  for (const StudyCase& one : study.cases) {
    if (one.excluded || !scenes.insert(one.scene_json.dump()).second) continue;
    if (shelf.failed && shelf.failed(one.id)) return;
    std::optional<CaseScope> named;
    if (shelf.ticket) named.emplace(shelf.ticket(one));
    try {
      const ReferenceSet set = references.of(one, stop);
      if (!set.applicable.empty()) return;
      refusals.insert(set.refusals.begin(), set.refusals.end());
    } catch (const Interrupted&) {
      throw;
    } catch (const InputError&) {
      throw;
    } catch (...) {
      return;  // a method or a reference that fails is told in the rows of its cases
    }
  }
  if (refusals.empty()) return;
  throw InputError("/reference", fmt::format("no reference applies to this scene: {}; \"{}\" applies wherever the "
                                             "methods march",
                                             fmt::join(refusals, "; "), marched_reference));
}

}  // namespace

CasePlan plan_for(const std::string& kind, const StudyCase& study_case, const Registry& registry) {
  if (kind == "bifurcation") return plan_bifurcation(study_case, registry);
  if (kind == "basins") return plan_basins(study_case, registry);
  return kind == "stability" ? plan_stability(study_case, registry) : plan_case(study_case, registry);
}

int run_study(const Study& study, const Catalogue& catalogue, const Registry& registry, const RunOptions& options) {
  StudyRunner runner;
  runner.plan = [&](const StudyCase& study_case) { return plan_for(study.kind, study_case, registry); };
  runner.run = [&](const StudyCase& study_case, const std::atomic<bool>& stop) {
    return run_case(study_case, registry, stop);
  };
  std::unique_ptr<References> references;
  if (study.resolved.contains("reference")) {
    runner.open = [&](MotionShelf shelf, const std::atomic<bool>& stop) {
      if (!references) references = std::make_unique<References>(study, registry, shelf);
      require_reference(study, *references, shelf, stop);
    };
    runner.run = [&](const StudyCase& study_case, const std::atomic<bool>& stop) {
      return run_comparison(study_case, registry, *references, stop);
    };
  }
  if (study.kind == "stability")
    runner.run = [&](const StudyCase& study_case, const std::atomic<bool>& stop) {
      return run_stability(study_case, registry, stop);
    };
  MotionShelf shelf;
  if (study.kind == "bifurcation" || study.kind == "basins") {
    runner.open = [&](MotionShelf opened, const std::atomic<bool>&) { shelf = std::move(opened); };
    runner.run = [&](const StudyCase& study_case, const std::atomic<bool>& stop) {
      Fingerprints fingerprints(study.kind, program_hash());
      const int processors = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
      const int jobs = options.jobs > 0 ? options.jobs : processors, cases = static_cast<int>(study.cases.size());
      const CaseDesk desk{shelf, fingerprints.of(study_case, runner.libraries(study_case)), std::max(1, jobs / cases)};
      return study.kind == "basins" ? run_basins(study_case, registry, desk, stop)
                                    : run_bifurcation(study_case, registry, desk, stop);
    };
  }
  if (study.resolved.contains("repeats"))
    runner.time = [&](const StudyCase& study_case, const std::atomic<bool>& stop) {
      return time_case(study_case, registry, stop);
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
