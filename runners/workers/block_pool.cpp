#include "runners/workers/block_pool.hpp"

#include <algorithm>

namespace ricochet {

BlockPool::~BlockPool() {
  {
    const std::lock_guard guard(mutex_);
    ended_ = true;
    waiting_.clear();
    for (Marching& one : marching_) one.stop = true;
  }
  changed_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void BlockPool::begin(Block block) {
  const std::lock_guard guard(mutex_);
  waiting_.push_back(std::move(block));
  if (static_cast<int>(waiting_.size()) > free_ && static_cast<int>(threads_.size()) < width_) {
    ++free_;
    threads_.emplace_back([this] { work(); });
  }
  changed_.notify_one();
}

void BlockPool::stop(int owner, std::uint32_t about) {
  std::function<void(BlockStatus)> tell;
  {
    const std::lock_guard guard(mutex_);
    const auto found = std::find_if(waiting_.begin(), waiting_.end(),
                                    [&](const Block& one) { return one.owner == owner && one.about == about; });
    if (found != waiting_.end()) {
      tell = std::move(found->tell);
      waiting_.erase(found);
    }
    for (Marching& one : marching_)
      if (one.owner == owner && one.about == about) one.stop = true;
  }
  if (tell) tell({BlockStatus::What::interrupted, ""});
}

void BlockPool::forget(int owner) {
  const std::lock_guard guard(mutex_);
  std::erase_if(waiting_, [&](const Block& one) { return one.owner == owner; });
  for (Marching& one : marching_)
    if (one.owner == owner) one.stop = true;
}

void BlockPool::work() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [&] { return ended_ || !waiting_.empty(); });
    if (ended_) return;
    const Block block = std::move(waiting_.front());
    waiting_.pop_front();
    --free_;
    Marching& marching = marching_.emplace_back(block.owner, block.about);
    const auto place = std::prev(marching_.end());
    lock.unlock();
    march_(block, [&] { return marching.stop.load(); });
    lock.lock();
    marching_.erase(place);
    ++free_;
  }
}

}  // namespace ricochet
