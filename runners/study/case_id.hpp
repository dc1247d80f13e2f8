#pragma once
#include <string>
#include <string_view>

namespace ricochet {

/// The id of a case: "c" and ten hexadecimal digits. No reader of tables takes it for a number or a missing value, as
/// "0168126827", "57593e5944" and other ids of earlier programs, which were the digits alone.
inline constexpr char case_letter = 'c';

/// Whether a text is an id of earlier programs.
bool is_former_id(std::string_view id);

/// The id of today of the case that had this one; others as they are.
std::string id_of_today(std::string id);

/// The id that earlier programs gave the case; others as they are.
std::string former_id(std::string id);

/// Whether a person who writes `asked` may mean the case: its id, or the beginning of it, with or without the letter.
bool begins_id(std::string_view id, std::string_view asked);

}  // namespace ricochet
