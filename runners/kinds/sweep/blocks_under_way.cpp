#include "runners/kinds/sweep/blocks_under_way.hpp"

#include <chrono>

namespace ricochet {

BlocksUnderWay::BlocksUnderWay(BlockService& service, std::string case_id)
    : service_(service), case_id_(std::move(case_id)) {}

int BlocksUnderWay::begin(const std::string& order) {
  const int block = begun_++;
  under_way_[block] = service_.begin(case_id_, order, [inbox = inbox_, block](BlockStatus status) {
    const std::lock_guard guard(inbox->mutex);
    inbox->status.emplace_back(block, std::move(status));
    inbox->changed.notify_all();
  });
  return block;
}

std::optional<std::pair<int, BlockStatus>> BlocksUnderWay::next(double seconds) {
  std::unique_lock lock(inbox_->mutex);
  if (!inbox_->changed.wait_for(lock, std::chrono::duration<double>(seconds), [&] { return !inbox_->status.empty(); }))
    return std::nullopt;
  std::pair<int, BlockStatus> one = std::move(inbox_->status.front());
  inbox_->status.pop_front();
  if (one.second.what != BlockStatus::What::so_far) under_way_.erase(one.first);
  return one;
}

void BlocksUnderWay::stop() {
  for (const auto& [block, number] : under_way_) service_.stop(number);
}

}  // namespace ricochet
