#pragma once
#include <condition_variable>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "runners/kinds/sweep/block_orders.hpp"
#include "runners/march/prepare_case.hpp"

namespace ricochet::testing {

/// Workers that march blocks of one case, as threads. The bytes that they hear and say are those that worker processes
/// send each other.
class BlockThreads : public BlockService {
 public:
  BlockThreads(const StudyCase& study_case, const Registry& registry, int workers)
      : study_case_(study_case), registry_(registry), width_(workers) {
    for (int i = 0; i < workers; ++i) threads_.emplace_back([this] { work(); });
  }
  ~BlockThreads() override {
    {
      const std::lock_guard guard(mutex_);
      ended_ = true;
      for (auto& [number, flag] : stops_) *flag = true;
    }
    changed_.notify_all();
    for (std::thread& one : threads_) one.join();
  }

  int width() const override { return width_; }
  int share() const override { return width_; }
  int begin(const std::string&, const std::string& order, std::function<void(BlockStatus)> heard) override {
    const std::lock_guard guard(mutex_);
    const int number = ++begun_;
    stops_[number] = std::make_shared<std::atomic<bool>>(false);
    waiting_.push_back({order, std::move(heard), stops_[number]});
    changed_.notify_one();
    return number;
  }
  void stop(int block) override {
    const std::lock_guard guard(mutex_);
    if (const auto found = stops_.find(block); found != stops_.end()) *found->second = true;
  }

 private:
  struct Block {
    std::string order;
    std::function<void(BlockStatus)> heard;
    std::shared_ptr<std::atomic<bool>> stop;
  };
  void work() {
    using What = BlockStatus::What;
    BlockMarcher marcher(registry_);
    for (;;) {
      Block block;
      {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return ended_ || !waiting_.empty(); });
        if (ended_) return;
        block = std::move(waiting_.front());
        waiting_.pop_front();
      }
      try {
        std::string answer = marcher.march(
            study_case_, block.order,
            [&](std::string bytes) {
              block.heard({What::so_far, std::move(bytes)});
            },
            *block.stop);
        block.heard({What::done, std::move(answer)});
      } catch (const Interrupted&) {
        block.heard({What::interrupted, ""});
      } catch (const std::exception& error) {
        block.heard({What::failed, error.what()});
      }
    }
  }

  const StudyCase& study_case_;
  const Registry& registry_;
  const int width_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Block> waiting_;
  std::map<int, std::shared_ptr<std::atomic<bool>>> stops_;
  std::vector<std::thread> threads_;
  int begun_ = 0;
  bool ended_ = false;
};

}  // namespace ricochet::testing
