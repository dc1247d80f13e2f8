#pragma once
#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>
#include <set>
#include <string>

namespace ricochet {

/// Lets one worker compute what others look for under the same key (a reference), while they wait for it. Nobody waits
/// for one that waits itself: then both compute it, to the same bits.
class KeyClaims {
 public:
  /// What `look` finds; "" where this owner is to compute it. Waits while another one does.
  std::string find(int owner, const std::string& key, const std::function<std::string()>& look,
                   const std::function<bool()>& stopping);
  /// Something is kept under the key.
  void kept(const std::string& key);
  /// The owner's case has ended: nobody waits for it any more.
  void release(int owner);

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<std::string, int> owners_;
  std::set<int> waiting_;
};

}  // namespace ricochet
