#pragma once
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdio>
#include <mutex>
#include <string>
#include <thread>

namespace ricochet {

/// Says what a person waits for: "reading tube.json, 3 s". On a terminal it is a line that comes after half a second,
/// counts its seconds and is erased at the end. Elsewhere it is one line after ten seconds. Both count from the last
/// such line, or from the program's begin. Nothing else may be said while it lives.
class WaitingLine {
 public:
  explicit WaitingLine(std::string what, std::FILE* out = stderr);
  /// `terminal` as it is told here, for tests.
  WaitingLine(std::string what, std::FILE* out, bool terminal, std::chrono::milliseconds after);
  ~WaitingLine();
  WaitingLine(const WaitingLine&) = delete;
  WaitingLine& operator=(const WaitingLine&) = delete;

  /// How many parts of it are done.
  void done(std::size_t parts, std::size_t of) {
    of_ = of;
    parts_ = parts;
  }

 private:
  void tell();
  std::string text() const;

  const std::string what_;
  std::FILE* const out_;
  const bool terminal_;
  const std::chrono::milliseconds after_;
  const std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  std::atomic<std::size_t> parts_{0}, of_{0};
  std::mutex mutex_;
  std::condition_variable wake_;
  bool ended_ = false, told_ = false;
  std::thread teller_;
};

}  // namespace ricochet
