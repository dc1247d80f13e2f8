#pragma once
#include <atomic>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <vector>

#include "runners/kinds/kind.hpp"
#include "runners/run/outputs.hpp"
#include "runners/run/run_study.hpp"

namespace ricochet {

/// What a run of a study asks of the rest of the program; run_study() gives the real ones.
struct StudyRunner {
  std::function<CasePlan(const StudyCase&)> plan;
  CaseRunner cases;
  std::function<std::vector<std::filesystem::path>(const StudyCase&)>
      libraries;  ///< of its three methods; "" when in-process
  std::function<Environment()> environment;
  std::string workers;     ///< who marches: "4 workers on 2 machines"; "": this process
  std::string arithmetic;  ///< digest of this process's, kept with each case; "": not known
  RenderReport render;
  std::FILE* out = stdout;       ///< the summary
  std::FILE* messages = stderr;  ///< progress and errors
};

/// run_study() with its collaborators given.
int run_study_with(const StudyRunner& runner, const Study& study, const RunOptions& options);

/// rebuild_report() with the report's author given.
int rebuild_report_with(const RenderReport& render, const std::filesystem::path& folder);

/// A pending case, its predicted cost, and what tells whether it is still the same in a later run.
struct PendingCase {
  const StudyCase* study_case = nullptr;
  double predicted_seconds = 0;
  std::string fingerprint;
};

/// What run_cases() reports.
struct CaseEvents {
  /// A case begins: before any of its code runs, in the thread that will run it. Not for one that `finished` named.
  std::function<void(const PendingCase&)> begins;
  /// A case ended, in the thread that ran it; `next`, where not null, begins now.
  std::function<void(const CaseRecord&, const PendingCase* next)> finished;
};

/// Times the finished cases that have no time yet, one at a time, `repeats` rounds in turn: measures timed_seconds
/// (median), timed_low and timed_high (smallest and largest), and a note when other programs took the processor
/// meanwhile. Ends early when `stop` becomes true, then without any time. Returns the records to save.
std::vector<CaseRecord> time_cases(const StudyRunner& runner, const Study& study, const StudyResults& results,
                                   int repeats, const std::atomic<bool>& stop);

/// Runs the cases, so many at once, longest predicted first so that all end together. Ends early when `stop` becomes
/// true. An exception of an event sets `stop` and is thrown once all cases under way are back. Returns the number of
/// cases that finished.
int run_cases(const StudyRunner& runner, std::vector<PendingCase> pending, int at_once, std::atomic<bool>& stop,
              const CaseEvents& events);

/// Predicts the cost of the cases.
void predict_cases(const StudyRunner& runner, std::vector<PendingCase>& pending, int at_once,
                   const std::atomic<bool>& stop);

}  // namespace ricochet
