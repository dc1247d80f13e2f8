#pragma once
#include <chrono>
#include <cstdio>
#include <string_view>

/// \file
/// What a person reads while a command runs. A failure is let be: a closed terminal or a full log must not cost a run.
namespace ricochet {

/// Writes plain_text() of a text, and flushes.
void say(std::FILE* out, std::string_view text);

/// Writes a terminal's line anew, plain_text() of it; "" erases it.
void say_in_place(std::FILE* out, std::string_view line);

/// How long such a line stands at the least.
inline constexpr std::chrono::milliseconds redrawn_every{200};

bool is_terminal(std::FILE* out);

}  // namespace ricochet
