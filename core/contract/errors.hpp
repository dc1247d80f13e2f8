#pragma once
#include <ricochet/contract/said.hpp>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace ricochet {

/// The caller's input is wrong: where (JSON pointer), what is wrong, what was expected.
/// The runner adds file and line, prints it, and ends with exit code 2 before anything runs.
class InputError : public std::runtime_error {
 public:
  InputError(std::string pointer, const std::string& message)
      : std::runtime_error(message), pointer_(std::move(pointer)) {}
  /// JSON pointer (RFC 6901) of the offending value, "" for the whole document.
  const std::string& pointer() const { return pointer_; }

 private:
  std::string pointer_;
};

/// A combination of methods that does not apply, as a value: one sentence a person can act on.
/// It becomes a row of the table with status `refused`, never a crash and never a changed parameter.
struct Refusal {
  Said sentence;
};

/// A plugin that is missing or does not fit (exit code 4); the message names the file.
class PluginError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The candidate nearest to `word` in edit distance (Damerau–Levenshtein, adjacent swaps count one), or "" when none is
/// closer than half of the word.
std::string nearest_name(std::string_view word, const std::vector<std::string>& candidates);

/// A text of the caller as a message quotes it: whole, or its first `longest_quoted` characters and "…". A character is
/// one of UTF-8, and is not cut.
inline constexpr std::size_t longest_quoted = 80;
std::string shortened(std::string_view text);

/// What a text of somebody else takes at most where it is stored or shown, in bytes: of an exception, a refusal, a
/// manual, a question.
inline constexpr std::size_t longest_text = 2000;
/// The text, or its beginning and "…": together at most `longest_text` bytes. No character is cut.
std::string cut_short(std::string_view text);
/// The same of the text in one line: its lines without blanks around them, joined by "; ".
std::string one_line(std::string_view text);

}  // namespace ricochet
