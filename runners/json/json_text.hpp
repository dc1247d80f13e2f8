#pragma once
#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <ricochet/contract/errors.hpp>
#include <string>
#include <vector>

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

using Json = nlohmann::ordered_json;

/// A place in a text, both counted from 1, columns in characters (UTF-8).
struct TextPosition {
  int line = 1, column = 1;
};

/// The text is no JSON: pointer "", and where reading stopped.
class SyntaxError : public InputError {
 public:
  SyntaxError(TextPosition where, const std::string& message) : InputError("", message), where_(where) {}
  TextPosition where() const { return where_; }

 private:
  TextPosition where_;
};

/// Parses a JSON text (RFC 8259). Keys that begin with // (remarks) and $schema (for editors) are left out, at every
/// level. Throws SyntaxError (what is wrong, the line, a caret under the place) for what is no JSON. It throws the same
/// for a number that no double holds, and for nesting deeper than 100 levels. Throws InputError for a key given twice
/// in one object.
Json parse_json(const std::string& text);

/// Where the value of a JSON pointer stands in a valid JSON text: its key, or the element of a list. When the pointer
/// names nothing (a missing key), where its nearest ancestor stands. None of the whole document.
std::optional<TextPosition> locate(const std::string& text, const std::string& pointer);

/// Bytes of the largest text that is read.
inline constexpr std::size_t largest_text = std::size_t{32} << 20U;

/// A text file. Throws InputError, pointer "", where it cannot be read, is a folder or too large; `expected`: "a
/// study".
std::string read_text(const std::filesystem::path& file, const std::string& expected);
/// What an open file, a pipe or a terminal gives until its end. Throws InputError as read_text() does.
std::string read_to_end(int descriptor, const std::string& expected);

/// The error as a person reads it: "PLACE:LINE: at /json/pointer: what is wrong; what was expected", the line where
/// `text` is not empty.
std::string explained(const InputError& error, std::string place, const std::string& text);

/// `parent` + "/" + key, escaped as RFC 6901 asks.
std::string pointer_to(const std::string& parent, const std::string& key);
std::string pointer_to(const std::string& parent, std::size_t index);

/// The values of a field that may be a list.
template <class T>
std::vector<T> one_or_each(const Json& value) {
  if (value.is_array()) return value.get<std::vector<T>>();
  return {value.get<T>()};
}

/// A value as it is quoted in a message: its JSON, cut short when long.
std::string quote(const Json& value);

/// "; did you mean "X"?" or "", which it is too where the word itself is the nearest.
std::string did_you_mean(const std::string& word, const std::vector<std::string>& candidates);

/// "a", "b", "c". Of five or more in a row that differ in numbers alone the first and the last: "p1" … "p9".
std::string quoted_list(const std::vector<std::string>& words);

}  // namespace ricochet
