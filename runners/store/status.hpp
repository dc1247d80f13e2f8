#pragma once
#include <array>
#include <optional>
#include <string_view>

namespace ricochet {

/// How a case ended: as asked; not run, as its methods do not apply; with a motion beyond all bounds; for want of a
/// result.
enum class Status : unsigned char { done, refused, diverged, failed };

inline constexpr std::array statuses = {Status::done, Status::refused, Status::diverged, Status::failed};

/// "done", "refused", "diverged", "failed": what stores and tables say.
constexpr const char* word(Status status) {
  constexpr std::array words = {"done", "refused", "diverged", "failed"};
  return words[static_cast<std::size_t>(status)];
}

/// That of a word; none of any other.
constexpr std::optional<Status> status_of_word(std::string_view said) {
  for (const Status one : statuses)
    if (said == word(one)) return one;
  return std::nullopt;
}

}  // namespace ricochet
