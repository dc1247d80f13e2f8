#pragma once
#include <cstdio>
#include <string_view>

namespace ricochet {

/// Writes text for a person and flushes. A failure is let be: a closed terminal or a full log must not cost a run.
inline void say(std::FILE* out, std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), out);
  std::fflush(out);
}

}  // namespace ricochet
