#include <algorithm>
#include <chrono>
#include <set>
#include <string>
#include <system_error>

#include "runners/march/prepare_case.hpp"
#include "runners/workers/isolated_cases.hpp"

namespace ricochet {

std::string KeyClaims::find(int owner, const std::string& key, const std::function<std::string()>& stored,
                            const std::function<bool()>& stopping) {
  constexpr auto poll_interval = std::chrono::milliseconds(100);
  std::unique_lock lock(mutex_);
  for (;;) {
    lock.unlock();
    if (std::string found = stored(); !found.empty()) return found;
    lock.lock();
    const auto claimed = owners_.find(key);
    if (claimed == owners_.end()) {
      owners_[key] = owner;
      return "";
    }
    if (claimed->second == owner || waiting_.count(claimed->second) != 0 || stopping()) return "";
    waiting_.insert(owner);
    changed_.wait_for(lock, poll_interval);
    waiting_.erase(owner);
  }
}

void KeyClaims::kept(const std::string& key) {
  const std::lock_guard guard(mutex_);
  owners_.erase(key);
  changed_.notify_all();
}

void KeyClaims::release(int owner) {
  const std::lock_guard guard(mutex_);
  std::erase_if(owners_, [&](const auto& claimed) { return claimed.second == owner; });
  changed_.notify_all();
}

WorkerPlaces::WorkerPlaces(std::vector<std::shared_ptr<WorkerHost>> hosts) {
  for (auto& host : hosts) {
    width_ += host->width();
    places_.push_back({std::move(host)});
  }
}

int WorkerPlaces::machines() const {
  std::set<std::string> names;
  for (const Place& one : places_) names.insert(one.host->name());
  return static_cast<int>(names.size());
}

WorkerPlaces::Taken WorkerPlaces::take(Where where) {
  const std::lock_guard guard(mutex_);
  const std::size_t at = where == Where::here ? 0 : roomiest();
  Place& place = places_[at];
  Taken taken{nullptr, where == Where::here ? Slot() : Slot(*this, at)};
  if (where == Where::anywhere) ++place.at_work;
  if (!place.idle.empty()) {
    taken.member = std::move(place.idle.back());
    place.idle.pop_back();
  } else {
    taken.member = std::make_shared<Member>();
    taken.member->host = place.host;
    taken.member->number = ++born_;
    taken.member->place = at;
  }
  return taken;
}

void WorkerPlaces::give_back(MemberPointer member) {
  const std::lock_guard guard(mutex_);
  Place& place = places_[member->place];
  if (place.host->there()) place.idle.push_back(std::move(member));
}

void WorkerPlaces::leave(std::size_t place) {
  const std::lock_guard guard(mutex_);
  --places_[place].at_work;
}

std::size_t WorkerPlaces::roomiest() const {
  const auto room = [&](std::size_t at) { return places_[at].host->width() - places_[at].at_work; };
  std::size_t best = 0;
  for (std::size_t at = 1; at < places_.size(); ++at)
    if (places_[at].host->there() && room(at) > room(best)) best = at;
  return best;
}

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
  if (static_cast<int>(waiting_.size()) > free_ && static_cast<int>(threads_.size()) < width_) try {
      threads_.emplace_back([this] { work(); });
      ++free_;
    } catch (const std::system_error&) {
      // No room for another one: those that are there take the block in their turn.
      if (threads_.empty()) throw RunError("not enough memory: no thread for a block can be started");
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
  std::unique_lock lock(mutex_);
  std::erase_if(waiting_, [&](const Block& one) { return one.owner == owner; });
  for (Marching& one : marching_)
    if (one.owner == owner) one.stop = true;
  // What they tell of a case, and keep for it, goes to who may be gone once the case has ended.
  came_back_.wait(lock, [&] {
    return std::none_of(marching_.begin(), marching_.end(), [&](const Marching& one) { return one.owner == owner; });
  });
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
    came_back_.notify_all();
    ++free_;
  }
}

}  // namespace ricochet
