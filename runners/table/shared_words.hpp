#pragma once
#include <atomic>
#include <string>
#include <utility>

namespace ricochet {

/// A text that its copies share, as wide as a pointer. A thread that makes the same short text again and again (a
/// status, a class of motion) makes it once.
class SharedWords {
 public:
  explicit SharedWords(std::string text);
  SharedWords(const SharedWords& other) noexcept : body_(other.body_) {
    if (body_) body_->owners.fetch_add(1, std::memory_order_relaxed);
  }
  SharedWords(SharedWords&& other) noexcept : body_(std::exchange(other.body_, nullptr)) {}
  SharedWords& operator=(SharedWords other) noexcept {
    std::swap(body_, other.body_);
    return *this;
  }
  ~SharedWords() {
    if (body_ && body_->owners.fetch_sub(1, std::memory_order_acq_rel) == 1) delete body_;
  }

  /// Not of one that was moved from.
  const std::string& text() const { return body_->text; }
  friend bool operator==(const SharedWords& a, const SharedWords& b) {
    return a.body_ == b.body_ || a.text() == b.text();
  }

 private:
  struct Body {
    explicit Body(std::string words) : text(std::move(words)) {}
    const std::string text;
    std::atomic<long> owners{1};
  };
  SharedWords() = default;
  friend struct RecentWords;

  Body* body_ = nullptr;
};

}  // namespace ricochet
