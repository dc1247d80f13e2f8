#include "runners/execution/study_runner.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <mutex>
#include <thread>

#include "runners/execution/derive.hpp"
#include "runners/execution/environment.hpp"
#include "runners/execution/progress.hpp"
#include "runners/execution/say.hpp"
#include "runners/execution/stop_signal.hpp"
#include "runners/execution/summary.hpp"
#include "runners/store/atomic_file.hpp"
#include "runners/store/fingerprint.hpp"
#include "runners/store/store.hpp"
#include "runners/store/store_error.hpp"

namespace ricochet {
namespace {

constexpr int kStoreUnusable = 5, kInterrupted = 130;

StudyResults header(const Study& study) {
  StudyResults results;
  results.study = study.resolved;
  results.name = study.name;
  results.question = study.question;
  results.kind = study.kind;
  results.columns = study.columns;
  results.expected_cases = static_cast<int>(study.cases.size());
  return results;
}

CaseRecord excluded_record(const StudyCase& study_case) {
  CaseRecord record;
  record.id = study_case.id;
  record.axes = study_case.axes;
  record.status = "refused";
  record.reason = "excluded: " + *study_case.excluded;
  return record;
}

/// A prediction that cannot be made says nothing about the case: running it will.
double predicted_seconds(const StudyRunner& runner, const StudyCase& study_case) {
  try {
    return std::max(0.0, runner.plan(study_case).predicted_seconds);
  } catch (const std::exception&) {
    return 0;
  }
}

std::vector<ExpectedCase> expected_cases(const StudyRunner& runner, const Study& study) {
  Fingerprints fingerprints(study.kind, program_hash());
  std::vector<ExpectedCase> expected;
  for (const StudyCase& study_case : study.cases)
    expected.push_back({study_case.id, fingerprints.of(study_case, runner.libraries(study_case))});
  return expected;
}

/// Splits what is missing: excluded cases get their record, the others wait. Returns the ids that are new.
std::set<std::string> find_missing(const StudyRunner& runner, const Study& study, const std::set<std::string>& kept,
                                   std::vector<CaseRecord>& excluded, std::vector<PendingCase>& pending) {
  std::set<std::string> missing;
  for (const StudyCase& study_case : study.cases) {
    if (kept.count(study_case.id) != 0 || !missing.insert(study_case.id).second) continue;
    if (study_case.excluded)
      excluded.push_back(excluded_record(study_case));
    else
      pending.push_back({&study_case, predicted_seconds(runner, study_case)});
  }
  return missing;
}

int interrupted(const StudyRunner& runner, const Store& store, const std::filesystem::path& folder) {
  const StudyResults results = store.load();
  const auto under_way =
      std::count_if(results.cases.begin(), results.cases.end(), [](const CaseRecord& one) { return one.partial; });
  say(runner.messages,
      fmt::format(
          "interrupted: {} of {} cases are finished{} and kept in {}. Run the same command again to go on; \"ricochet "
          "report {}\" shows what is there\n",
          results.cases.size() - static_cast<std::size_t>(under_way), results.expected_cases,
          under_way > 0 ? fmt::format(", {} under way,", under_way) : "", folder.string(), folder.string()));
  return kInterrupted;
}

/// What a long case has so far goes to the store, and to the report: it can be looked at while the run goes on.
void show_partial(const StudyRunner& runner, Store& store, const std::filesystem::path& folder,
                  const CaseRecord& record) {
  // Cases on several threads share the folder: one page at a time, and none waits for another's.
  static std::mutex page;
  store.save_partial(record);
  const std::unique_lock lock(page, std::try_to_lock);
  if (lock) write_file(folder / "report.html", runner.render(with_tables(store.load())));
}

int run_in(const StudyRunner& runner, const Study& study, const RunOptions& options,
           const std::filesystem::path& folder) {
  const auto begin = std::chrono::steady_clock::now();
  const StopSignal signals;
  std::atomic<bool>& stop = signals.requested();
  Store store(folder, options.fresh);
  const std::set<std::string> kept = store.begin(header(study), expected_cases(runner, study));
  if (runner.open)
    runner.open({[&](const std::string& key) { return store.motion(key); },
                 [&](const std::string& key, const std::string& content) { store.save_motion(key, content); },
                 [&](const CaseRecord& record) { show_partial(runner, store, folder, record); }},
                stop);
  std::vector<CaseRecord> excluded;
  std::vector<PendingCase> pending;
  std::set<std::string> missing = find_missing(runner, study, kept, excluded, pending);
  if (!missing.empty()) {
    const Environment now = runner.environment();
    store.save_environment(kept.empty() ? now : merge_environments(now, store.load().environment));
  }
  if (!excluded.empty()) store.save(excluded);

  const int processors = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  const int jobs = options.jobs > 0 ? options.jobs : processors;
  const std::size_t running = pending.size();
  say(runner.messages, fmt::format("{}: {} case{}, {} finished before, {} to run{}\n", study.name, study.cases.size(),
                                   study.cases.size() == 1 ? "" : "s", kept.size(), running,
                                   running > 0 ? fmt::format(" on {} thread{}", jobs, jobs == 1 ? "" : "s") : ""));
  int ran = 0;
  if (running > 0) {
    double work = 0;
    for (const PendingCase& one : pending) work += one.predicted_seconds;
    Progress progress(runner.messages, ::isatty(::fileno(runner.messages)) != 0, static_cast<int>(running), work, stop);
    ran = run_cases(
        runner, std::move(pending), jobs, stop,
        [&](const PendingCase& one) { progress.started(one.study_case->id, one.predicted_seconds); },
        [&](const CaseRecord& record) {
          store.save({&record, 1});
          progress.finished(record.id);
        });
  }
  if (ran < static_cast<int>(running)) return interrupted(runner, store, folder);

  if (runner.time) {
    const std::vector<CaseRecord> timed =
        time_cases(runner, study, store.load(), study.resolved.value("repeats", 1), stop);
    if (stop) return interrupted(runner, store, folder);
    store.save(timed);
    for (const CaseRecord& record : timed) missing.insert(record.id);
  }

  const StudyResults results = with_tables(store.load());
  write_outputs(folder, results, runner.render, &missing);
  const int code = results_exit_code(results);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  say(runner.out,
      fmt::format("{}\n{} ({} run now in {}, {} kept)\nreport: {}\n", case_table(results), totals_text(results),
                  missing.size(), duration_text(seconds), kept.size(), (folder / "report.html").string()));
  if (code != 0)
    say(runner.out,
        fmt::format(
            "exit code {}: some cases diverged or failed, the others are usable; {} holds a study of each alone\n",
            code, (folder / "failures").string()));
  return code;
}

}  // namespace

int run_study_with(const StudyRunner& runner, const Study& study, const RunOptions& options) {
  const std::filesystem::path folder =
      options.out.empty() ? std::filesystem::path("results") / study.name : options.out;
  try {
    return run_in(runner, study, options, folder);
  } catch (const Interrupted&) {
    return kInterrupted;
  } catch (const StoreError& error) {
    say(runner.messages, fmt::format("error: {}\n", error.what()));
    return kStoreUnusable;
  }
}

int rebuild_report_with(const RenderReport& render, const std::filesystem::path& folder) {
  try {
    const StudyResults results = with_tables(read_store(folder));
    write_outputs(folder, results, render);
    say(stdout, fmt::format("{}\nreport: {}\n", totals_text(results), (folder / "report.html").string()));
    return 0;
  } catch (const StoreError& error) {
    say(stderr, fmt::format("error: {}\n", error.what()));
    return kStoreUnusable;
  }
}

int export_tables(const std::filesystem::path& folder, const std::filesystem::path& to) {
  try {
    write_tables(to, with_tables(read_store(folder)));
    say(stdout, fmt::format("tables: {}\n", to.string()));
    return 0;
  } catch (const StoreError& error) {
    say(stderr, fmt::format("error: {}\n", error.what()));
    return kStoreUnusable;
  }
}

}  // namespace ricochet
