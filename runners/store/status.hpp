#pragma once
#include <array>
#include <ricochet/contract/worded.hpp>

namespace ricochet {

/// How a case ended: as asked; not run, as its methods do not apply; with a motion beyond all bounds; for want of a
/// result.
enum class Status : unsigned char { done, refused, diverged, failed };

inline constexpr std::array statuses = {Status::done, Status::refused, Status::diverged, Status::failed};

/// What stores and tables say.
constexpr std::array<const char*, 4> words_of(Status) {
  return {"done", "refused", "diverged", "failed"};
}

}  // namespace ricochet
