#pragma once
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <map>
#include <mutex>
#include <string>
#include <thread>

namespace ricochet {

/// What a progress line says; times in seconds, work in predicted seconds.
struct ProgressState {
  int done = 0, total = 0;  ///< cases
  double work_done = 0;     ///< includes the cases in flight
  double work_total = 0;
  double elapsed = 0;
  std::string waits_for;  ///< a case that takes far longer than predicted; then no time is promised
};

/// Fraction of the work done, in [0, 1]; by cases where no cost was predicted.
double progress_fraction(const ProgressState& state);

/// "12/48 cases, 25 %, 3.1 cases/s, 12 s left".
std::string progress_text(const ProgressState& state);

/// "[######------] " and the text, at most `width` characters.
std::string progress_bar(const ProgressState& state, int width);

/// Tells a person how far a run is: on a terminal a bar redrawn in place five times a second, otherwise a plain line
/// now and then. Safe from several threads; nothing else may print to `out` while it lives, except through note().
class Progress {
 public:
  Progress(std::FILE* out, bool terminal, int total, double predicted_seconds, const std::atomic<bool>& stop);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void started(const std::string& id, double predicted_seconds);
  void finished(const std::string& id);
  /// Cases that sit in a plugin's function, and in which: said where they take far longer than predicted.
  void waiting(std::map<std::string, std::string> calls);
  /// A line of its own, the bar below it.
  void note(const std::string& line);

 private:
  using Clock = std::chrono::steady_clock;
  struct InFlight {
    Clock::time_point since;
    double predicted;
  };
  ProgressState state() const;
  std::string overdue(double slowness) const;
  void draw();
  void erase();
  void refresh();

  std::FILE* out_;
  bool terminal_;
  const std::atomic<bool>& stop_;
  int done_ = 0, total_;
  double work_done_ = 0, work_total_, measured_ = 0;
  Clock::time_point begin_ = Clock::now(), last_line_ = begin_;
  std::map<std::string, InFlight> in_flight_;
  std::map<std::string, std::string> calls_;
  bool ended_ = false, stop_told_ = false;
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::thread refresher_;
};

}  // namespace ricochet
