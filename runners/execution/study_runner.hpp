#pragma once
#include <atomic>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <vector>

#include "runners/execution/outputs.hpp"
#include "runners/execution/references.hpp"
#include "runners/execution/run_case.hpp"
#include "runners/execution/run_study.hpp"

namespace ricochet {

/// What a run of a study asks of the rest of the program; run_study() gives the real ones.
struct StudyRunner {
  std::function<CasePlan(const StudyCase&)> plan;
  std::function<CaseRecord(const StudyCase&, const std::atomic<bool>& stop)> run;
  std::function<std::vector<std::filesystem::path>(const StudyCase&)>
      libraries;  ///< of its three methods; "" when in-process
  std::function<Environment()> environment;
  RenderReport render;
  /// Called once, when the store is open and before any case runs; throws InputError for what only shows then.
  std::function<void(MotionShelf, const std::atomic<bool>& stop)> open;
  /// Processor seconds of one case's marching, alone; none: cases of this kind are not timed apart.
  std::function<std::optional<double>(const StudyCase&, const std::atomic<bool>& stop)> time;
  std::FILE* out = stdout;       ///< the summary
  std::FILE* messages = stderr;  ///< progress and errors
};

/// run_study() with its collaborators given.
int run_study_with(const StudyRunner& runner, const Study& study, const RunOptions& options);

/// rebuild_report() with the report's author given.
int rebuild_report_with(const RenderReport& render, const std::filesystem::path& folder);

/// Runs one case and makes a record of whatever happens: what it throws becomes status `failed`. Lets Interrupted
/// through.
CaseRecord run_guarded(const StudyRunner& runner, const StudyCase& study_case, const std::atomic<bool>& stop);

/// A pending case and its predicted cost.
struct PendingCase {
  const StudyCase* study_case = nullptr;
  double predicted_seconds = 0;
};

/// Times the finished cases that have no time yet, one at a time on this thread, `repeats` rounds in turn: measures
/// timed_seconds (median), timed_low and timed_high (smallest and largest), and a note when other programs took the
/// processor meanwhile. Ends early when `stop` becomes true, then without any time. Returns the records to save.
std::vector<CaseRecord> time_cases(const StudyRunner& runner, const Study& study, const StudyResults& results,
                                   int repeats, const std::atomic<bool>& stop);

/// Runs the cases on `jobs` threads, longest predicted first so that all threads end together, and calls `finished` for
/// each record, in the thread that made it. Ends early when `stop` becomes true. An exception of `finished` sets `stop`
/// and is thrown once all threads are back. Returns the number of cases that finished.
int run_cases(const StudyRunner& runner, std::vector<PendingCase> pending, int jobs, std::atomic<bool>& stop,
              const std::function<void(const PendingCase&)>& started,
              const std::function<void(const CaseRecord&)>& finished);

}  // namespace ricochet
