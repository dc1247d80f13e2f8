#include "runners/workers/key_claims.hpp"

#include <chrono>

namespace ricochet {

std::string KeyClaims::find(int owner, const std::string& key, const std::function<std::string()>& look,
                            const std::function<bool()>& stopping) {
  constexpr auto look_up = std::chrono::milliseconds(100);
  std::unique_lock lock(mutex_);
  for (;;) {
    lock.unlock();
    if (std::string found = look(); !found.empty()) return found;
    lock.lock();
    const auto claimed = owners_.find(key);
    if (claimed == owners_.end()) {
      owners_[key] = owner;
      return "";
    }
    if (claimed->second == owner || waiting_.count(claimed->second) != 0 || stopping()) return "";
    waiting_.insert(owner);
    changed_.wait_for(lock, look_up);
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

}  // namespace ricochet
