#pragma once
#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>

namespace ricochet {

/// The first fault of a text that is no JSON.
struct JsonFault {
  std::size_t at = 0;   ///< byte
  std::string message;  ///< "a comma is missing after 2.0e11"
};

/// What the parser says of a text that it refuses, at the token where it stopped. The usual slips are told in plainer
/// words: a comma missing or trailing, other quotes, comments, bare words, numbers with units.
JsonFault json_fault(const std::string& text, const nlohmann::json::parse_error& error);

/// The line of a text in which a byte stands, cut around it where long, and a caret under the byte: two lines,
/// indented.
std::string shown_line(const std::string& text, std::size_t at);

}  // namespace ricochet
