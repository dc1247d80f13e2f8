#pragma once
#include <algorithm>
#include <chrono>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>

#include "runners/march/seconds.hpp"
#include "runners/store/record.hpp"
#include "runners/study/study.hpp"

namespace ricochet {

/// What is heard of a block that another process marches.
struct BlockStatus {
  enum class What : char {
    so_far,       ///< content: what would be lost with its process
    done,         ///< content: the answer
    interrupted,  ///< it was asked to stop; what it had was told before
    failed,       ///< content: why it cannot be marched
    gave_up,      ///< content: which call did not return within the budget of the case
    lost          ///< content: how its process ended, for one that does so a second time
  };
  What what = What::so_far;
  std::string content;
  int share = 0;  ///< see BlockService, from now on; 0: as before
};

/// Marches blocks of cases in other processes. May be used from any thread.
class BlockService {
 public:
  virtual ~BlockService() = default;
  /// Blocks that are marched at one time, over the whole run.
  virtual int width() const = 0;
  /// Of these, those that a case may count on: fewer where other cases are under way or wait. Changes as they end.
  virtual int share() const = 0;
  /// Begins a block of a case and returns its number. `heard` is told what it has so far, and in the end, once, what
  /// became of it; by another thread.
  virtual int begin(const std::string& case_id, const std::string& order, std::function<void(BlockStatus)> heard) = 0;
  /// Asks a block to stop; what becomes of it is still told.
  virtual void stop(int block) = 0;
};

/// What outlives the program of a case under way and of what cases share: find(key) gives what keep(key, content) once
/// stored, or "".
struct CheckpointStore {
  std::function<std::string(const std::string& key)> find;
  std::function<void(const std::string& key, const std::string& content)> keep;
  /// Shows what a case under way has so far; empty where nobody looks.
  std::function<void(const CaseRecord&)> show;
  /// Whether a case has failed: nothing is computed with its methods for others.
  std::function<bool(const std::string& id)> failed;
  /// Told which call of a plugin's function a case waits for, in words; "" once it no longer does.
  std::function<void(const std::string& id, const std::string& call)> waiting = {};
};

/// What `read` makes of what is kept under the key. Nothing where nothing is kept, or where it is not whole or of
/// another version. It is then computed again: it is stored to save time alone.
template <class T>
std::optional<T> recall(const CheckpointStore& checkpoints, const std::string& key,
                        T (*read)(const std::string& bytes)) {
  const std::string bytes = checkpoints.find ? checkpoints.find(key) : "";
  if (bytes.empty()) return std::nullopt;
  try {
    return read(bytes);
  } catch (const std::runtime_error&) {
    return std::nullopt;
  }
}

/// Where a case keeps what would be lost if it were killed, and says how far it is.
struct CaseContext {
  CheckpointStore checkpoints;     ///< bytes by key; empty bytes forget a key
  std::string key;                 ///< of this case and everything its results depend on
  BlockService* blocks = nullptr;  ///< other processes that march for it; null: it marches itself
};

/// When a long case shows what it has so far: every 20 s. It does so less often where showing would take over a
/// twentieth of the time.
class PartialPace {
 public:
  bool due() const { return seconds_since(shown_) >= std::max(interval, 20 * cost_); }
  /// Calls `show` and notes what it took.
  template <class Show>
  void take(Show show) {
    const auto begin = Clock::now();
    show();
    cost_ = seconds_since(begin);
    shown_ = Clock::now();
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr double interval = 20;  // s
  Clock::time_point shown_ = Clock::now();
  double cost_ = 0;  // s
};

}  // namespace ricochet
