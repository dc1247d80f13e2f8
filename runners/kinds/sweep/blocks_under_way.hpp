#pragma once
#include <condition_variable>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "runners/march/block_service.hpp"

namespace ricochet {

/// The blocks of one case that other processes march, and what was heard of them. Those that are left at the end are
/// asked to stop.
class BlocksUnderWay {
 public:
  BlocksUnderWay(BlockService& service, std::string case_id);
  ~BlocksUnderWay() { stop(); }
  BlocksUnderWay(const BlocksUnderWay&) = delete;
  BlocksUnderWay& operator=(const BlocksUnderWay&) = delete;

  int begin(const std::string& order);
  /// Blocks of which there is still something to hear.
  std::size_t count() const { return under_way_.size(); }
  /// Whether another one may begin: one more than this case may count on waits for a process that is free.
  bool room() const { return count() <= static_cast<std::size_t>(service_.share()); }
  /// The next status, of the block of this number; nothing where so many seconds brought none.
  std::optional<std::pair<int, BlockStatus>> next(double seconds);
  void stop();

 private:
  // Outlives this object: what is told late is told to nobody.
  struct Inbox {
    std::mutex mutex;
    std::condition_variable changed;
    std::deque<std::pair<int, BlockStatus>> status;
  };

  BlockService& service_;
  const std::string case_id_;
  std::shared_ptr<Inbox> inbox_ = std::make_shared<Inbox>();
  std::map<int, int> under_way_;  // numbers of the service, by ours
  int begun_ = 0;
};

}  // namespace ricochet
