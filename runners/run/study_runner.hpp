#pragma once
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "runners/kinds/kind.hpp"
#include "runners/run/analysed_results.hpp"
#include "runners/run/run_study.hpp"
#include "runners/store/store.hpp"
#include "runners/study/study.hpp"

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
int rebuild_report_with(const RenderReport& render, const std::filesystem::path& folder, bool json = false);

/// A pending case, its predicted cost, and what tells whether it is still the same in a later run.
struct PendingCase {
  const StudyCase* study_case = nullptr;
  double predicted_seconds = 0;
  std::string fingerprint;
};

/// What run_cases() reports.
struct CaseEvents {
  /// Cases begin, one after the other: before any of their code runs, in the thread that will run them.
  std::function<void(std::span<const PendingCase>)> begins;
  /// A case ended, in the thread that ran it; `next`, where not null, is the one that begun behind it and runs now.
  std::function<void(const CaseRecord&, const PendingCase* next)> finished;
};

/// Times the finished cases that have no time yet, one at a time, `repeats` rounds in turn. Adds the measures
/// timed_seconds (median), timed_low and timed_high (smallest and largest). Adds a note when other programs took more
/// than a tenth of the time. Ends early when `stop` becomes true, then without any time. Returns the records to save.
std::vector<CaseRecord> time_cases(const StudyRunner& runner, const Study& study, const StudyResults& results,
                                   int repeats, const std::atomic<bool>& stop);

/// Runs the cases, so many at once, longest predicted first so that all end together. Cases that cost little travel to
/// a worker together: 50 ms of predicted work, and no more than leaves each worker four times as much. Ends early when
/// `stop` becomes true. An exception of an event sets `stop` and is thrown once all cases under way are back. Returns
/// the number of cases that finished.
int run_cases(const StudyRunner& runner, std::vector<PendingCase> pending, int at_once, std::atomic<bool>& stop,
              const CaseEvents& events);

/// Predicts the cost of the cases.
void predict_cases(const StudyRunner& runner, std::vector<PendingCase>& pending, int at_once,
                   const std::atomic<bool>& stop);

/// What a progress line says; times in seconds.
struct ProgressState {
  int done = 0, total = 0;  ///< cases
  double work_done = 0;     ///< s of work, includes what the cases in flight have taken
  double work_total = 0;
  double elapsed = 0;
  std::string waits_for;  ///< a case that takes far longer than predicted; then no time is promised
};

/// What a case costs, learnt from those that finished: a × its predicted seconds + b. The constant b is for being a
/// case at all (its rows are written, its report is drawn). Least squares of relative errors. Until anything is known:
/// as predicted, and a little.
class CaseCost {
 public:
  CaseCost();
  void add(double predicted, double measured);
  /// Seconds of `cases` cases that were predicted to take so long together.
  double seconds(double predicted, int cases = 1) const;

 private:
  void note(double predicted, double measured, double weight);
  double w_ = 0, wx_ = 0, wy_ = 0, wxx_ = 0, wxy_ = 0;
};

/// Fraction of the work done, in [0, 1]; by cases where no cost was predicted.
double progress_fraction(const ProgressState& state);

/// "12/48 cases, 25 %, 3.1 cases/s, 12 s left"; no time below a second is told.
std::string progress_text(const ProgressState& state);

/// "[######------] " and the text, at most `width` characters.
std::string progress_bar(const ProgressState& state, int width);

/// Tells a person how far a run is. On a terminal it is a bar redrawn in place five times a second, otherwise a plain
/// line now and then. Safe from several threads; nothing else may print to `out` while it lives.
class Progress {
 public:
  /// `elsewhere`: told the same every few seconds, by a thread of its own; must not throw.
  Progress(std::FILE* out, bool terminal, int total, double predicted_seconds, const std::atomic<bool>& stop,
           std::function<void(const std::string&)> elsewhere = {});
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void started(const std::string& id, double predicted_seconds);
  void finished(const std::string& id);
  /// The call of a plugin's function that a case waits for, "" for none: said where it takes far longer than predicted.
  void waiting(const std::string& id, const std::string& call);

 private:
  using Clock = std::chrono::steady_clock;
  struct InFlight {
    Clock::time_point since;
    double predicted;
  };
  ProgressState state() const;
  std::string overdue() const;
  void draw();
  void erase();
  void refresh();

  std::FILE* out_;
  bool terminal_;
  const std::atomic<bool>& stop_;
  int done_ = 0, total_;
  double waiting_;       // predicted s of the cases that have not begun
  double measured_ = 0;  // s that the finished ones took
  CaseCost cost_;
  const std::function<void(const std::string&)> elsewhere_;
  Clock::time_point begin_ = Clock::now(), last_line_ = begin_, told_elsewhere_ = begin_;
  std::map<std::string, InFlight> in_flight_;
  std::map<std::string, std::string> calls_;
  bool ended_ = false, stop_told_ = false;
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::thread refresher_;
};

// What a run says of its folder, beside progress and answer.

/// What became of results of other versions of the study, and of another arithmetic: lines, or "".
std::string versions_text(const Store& store);

/// Why a folder that holds `held` is not gone on with as `wanted`.
std::string other_part_text(const std::filesystem::path& folder, const std::string& study, const StudyPart& held,
                            const StudyPart& wanted);

/// How much of an interrupted run is kept, and how it goes on.
std::string interrupted_text(const std::filesystem::path& folder, const StudyResults& results);

/// The exit code of a run that was interrupted, of the shell's own convention: 128 + SIGINT.
inline constexpr int kInterrupted = 130;

/// While it lives, SIGINT, SIGTERM, SIGUSR1 (which schedulers send before a time limit) and SIGHUP (the terminal
/// closes) set `requested()` instead of ending the program. A second SIGINT or SIGTERM ends it at once with code 130. A
/// SIGHUP that was ignored stays so. SIGXFSZ is ignored, so that a file size limit is an error of the write that meets
/// it. The former handlers come back at the end. One at a time per process.
class StopSignal {
 public:
  StopSignal();
  ~StopSignal();
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;
  /// Also set by the program itself when going on makes no sense.
  std::atomic<bool>& requested() const;
};

}  // namespace ricochet
