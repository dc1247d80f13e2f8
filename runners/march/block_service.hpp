#pragma once
#include <functional>
#include <string>

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

}  // namespace ricochet
