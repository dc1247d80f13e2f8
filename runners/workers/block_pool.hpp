#pragma once
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "runners/march/block_service.hpp"
#include "runners/workers/worker_messages.hpp"

namespace ricochet {

/// Blocks of all cases in one queue, in the order in which they came, and the threads that have them marched.
class BlockPool {
 public:
  struct Block {
    BlockRequest request;
    int owner = 0;            ///< the worker that asked for it
    std::uint32_t about = 0;  ///< its question
    std::function<void(BlockStatus)> tell;
  };
  /// Marches one block and tells what became of it, once; ends early when `stopping` becomes true.
  using March = std::function<void(const Block&, const std::function<bool()>& stopping)>;

  /// `width`: blocks at one time. Threads begin with the first block.
  BlockPool(int width, March march) : width_(width), march_(std::move(march)) {}
  /// Stops them all.
  ~BlockPool();
  BlockPool(const BlockPool&) = delete;
  BlockPool& operator=(const BlockPool&) = delete;

  void begin(Block block);
  /// Stops one: one that has not begun is told to be interrupted at once.
  void stop(int owner, std::uint32_t about);
  /// Stops all blocks of an owner that is gone.
  void forget(int owner);

 private:
  struct Marching {
    Marching(int of, std::uint32_t block) : owner(of), about(block) {}
    int owner;
    std::uint32_t about;
    std::atomic<bool> stop{false};
  };
  void work();

  const int width_;
  const March march_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Block> waiting_;
  std::list<Marching> marching_;
  std::vector<std::thread> threads_;
  int free_ = 0;  // threads without a block
  bool ended_ = false;
};

}  // namespace ricochet
