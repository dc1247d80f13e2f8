#pragma once
#include <cstddef>
#include <optional>
#include <string>

namespace ricochet {

/// The first thing in a text that is no JSON, in the words of somebody who writes studies by hand.
struct JsonFault {
  std::size_t at = 0;   ///< byte
  std::string message;  ///< "a comma is missing after 2.0e11"
};

/// Nothing for JSON (RFC 8259) that is nested no deeper than the stack allows; of texts that are no UTF-8 nothing is
/// said.
std::optional<JsonFault> find_json_fault(const std::string& text);

/// The line of a text in which a byte stands, cut around it where long, and a caret under the byte: two lines,
/// indented.
std::string shown_line(const std::string& text, std::size_t at);

}  // namespace ricochet
