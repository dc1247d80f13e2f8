#include "runners/table/shared_words.hpp"

#include <array>
#include <functional>

namespace ricochet {

/// Short texts that a thread made lately, by their hash.
struct RecentWords {
  static constexpr std::size_t longest = 32;
  std::array<SharedWords, 64> made{};
};

SharedWords::SharedWords(std::string text) {
  if (text.size() > RecentWords::longest) {
    body_ = new Body(std::move(text));
    return;
  }
  thread_local RecentWords recent;
  SharedWords& same = recent.made[std::hash<std::string>{}(text) % recent.made.size()];
  if (!same.body_ || same.text() != text) {
    SharedWords fresh;
    fresh.body_ = new Body(std::move(text));
    same = std::move(fresh);
  }
  body_ = same.body_;
  body_->owners.fetch_add(1, std::memory_order_relaxed);
}

}  // namespace ricochet
