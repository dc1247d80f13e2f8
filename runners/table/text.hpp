#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runners/table/table.hpp"

/// \file
/// Tables as CSV after RFC 4180, numbers in the shortest digits that read back as the same double.
namespace ricochet {

/// A text as it may be shown: UTF-8, what is none as U+FFFD, control characters and marks of direction by their
/// numbers, <U+001B>. Line breaks and tabs stay.
std::string plain_text(std::string_view text);
/// Whether a text may be shown as it is.
bool is_plain(std::string_view text);

/// The shortest decimal text that reads back as the same double; "" when not finite (no NaN reaches a row).
std::string csv_number(double value);

/// The same, behind what `text` holds.
void append_csv_number(double value, std::string& text);

/// A field, plain_text() of it: in double quotes, with inner quotes doubled, when it holds a comma, a quote or a line
/// break.
std::string csv_field(std::string_view text);

/// A cell as a field, quoted where it must be.
std::string csv_cell(const Cell& cell);

/// One line of fields already quoted, ending in '\n'.
std::string csv_line(const std::vector<std::string>& fields);

/// The names of the columns, quoted where they must be.
std::vector<std::string> csv_head(const std::vector<Column>& columns);

/// The whole table: its columns, then one line per row; empty fields for nothing.
std::string table_csv(const Table& table);

/// The number that a text is, a + before it allowed; nothing where it is no number, or one that no double holds.
std::optional<double> number_in(std::string_view text);

/// Puts `with` in the place of each `what` of a text, from its beginning on.
void replace_all(std::string& text, std::string_view what, std::string_view with);

/// A text between single quotes, as one word of a shell whatever stands in it.
std::string shell_quoted(std::string text);

/// A number rounded to so many significant digits.
double to_digits(double value, int digits);
/// A text of a number with a minus sign as it is printed.
std::string with_minus(std::string text);
/// `digits` significant digits, at least as many as a whole number below 1e5 has; exponents short: "1.2e-5".
std::string short_number(double value, int digits = 4);
/// The same of a value above 0 rounded down: of what must not be exceeded.
std::string short_number_down(double value, int digits);
/// 0.5 as "½", 0.25 as "¼", 0.75 as "¾"; else short_number().
std::string fraction_text(double value);

// What a terminal shows: tables and spans of time as plain text.

/// Characters shown, for UTF-8 text without combining marks.
std::size_t shown_width(const std::string& text);

/// Plain text in aligned columns; the last column is not padded, and empty columns are left out.
class TextTable {
 public:
  explicit TextTable(std::vector<std::string> header) : rows_{std::move(header)} {}
  /// One cell per column of the header.
  void add(std::vector<std::string> cells) { rows_.push_back(std::move(cells)); }
  /// Each line starts with `indent` blanks.
  std::string text(std::size_t indent = 0) const;

 private:
  std::vector<std::vector<std::string>> rows_;
};

/// A span of time in two digits, in whole seconds or in whole minutes, never in scientific notation. Examples: "2.4
/// ms", "8.4 s", "42 s", "3 min 05 s", "2 h 10 min".
std::string duration_text(double seconds);

/// A number of bytes in two digits: "950 B", "25 kB", "1.2 GB".
std::string size_text(double bytes);

/// 32 hexadecimal digits of the SHA-1 of `content` (as a version 5 UUID: 122 bits of it). Tells contents apart; no
/// security is claimed.
std::string content_hash(std::string_view content);

}  // namespace ricochet
