#pragma once
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <thread>

#include "runners/store/store.hpp"
#include "runners/study/study.hpp"

namespace ricochet {

/// What a progress line says; times in seconds.
struct ProgressState {
  int done = 0, total = 0;  ///< cases
  double work_done = 0;     ///< s of work, includes what the cases in flight have taken
  double work_total = 0;
  double elapsed = 0;
  std::string waits_for;  ///< a case that takes far longer than predicted; then no time is promised
};

/// What a case costs, learnt from those that finished: a predicted seconds and b, for being a case at all (its rows are
/// written, its report is drawn). Least squares of relative errors; until anything is known, as predicted and a little.
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

/// Tells a person how far a run is: on a terminal a bar redrawn in place five times a second, otherwise a plain line
/// now and then. Safe from several threads; nothing else may print to `out` while it lives.
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

}  // namespace ricochet
