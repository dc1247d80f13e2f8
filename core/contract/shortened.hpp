#pragma once
#include <string>
#include <string_view>

namespace ricochet {

/// A text of the caller as a message quotes it: whole, or its first `longest_quoted` characters and "…". A character is
/// one of UTF-8, and is not cut.
inline constexpr std::size_t longest_quoted = 80;
std::string shortened(std::string_view text);

}  // namespace ricochet
