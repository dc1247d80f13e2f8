#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <ricochet/contract/errors.hpp>
#include <ricochet/scene/files/text_file.hpp>
#include <string>
#include <utility>
#include <vector>

namespace ricochet {
namespace {

constexpr char blanks = ' ';  // any number of blanks and tabs between two cells

bool all_numbers(const std::vector<std::string>& cells) {
  return std::all_of(cells.begin(), cells.end(), [](const std::string& cell) { return finite_number(cell); });
}

/// Whether a comma may as well stand between thousands: "1,234", and not "0,234" or "12,34".
bool maybe_thousands(const std::string& cell) {
  const std::size_t begin = cell.find_first_not_of("+-"), comma = cell.find(',');
  constexpr std::size_t digits = 3;
  return begin != std::string::npos && comma > begin && comma - begin <= digits && cell[begin] != '0' &&
         cell.size() == comma + 1 + digits && cell.find_first_not_of("0123456789", comma + 1) == std::string::npos;
}

/// Where the unit of "t [s]" or "t (s)" begins; the length of the name where it has none.
std::size_t unit_begin(const std::string& column) {
  const char close = column.empty() ? '\0' : column.back();
  if (close != ']' && close != ')') return column.size();
  const std::size_t open = column.rfind(close == ']' ? '[' : '(');
  return open == std::string::npos || open == 0 ? column.size() : open;
}

class TableReader {
 public:
  TableReader(std::string_view content, const std::string& name) : lines_(content, name) { table_.name = name; }

  CsvFile read() {
    while (const auto line = lines_.next()) {
      if (trimmed(*line).empty()) continue;
      if (is_comment(*line)) {
        ++comments_;
        if (table_.columns.empty()) remark_ = *line;
        continue;
      }
      if (!table_.columns.empty())
        add_row(*line);
      else if (!says_separator(*line))
        read_header(*line);
    }
    if (table_.columns.empty()) throw FileError(lines_.name() + " is empty; expected a header of columns");
    take_decimal_commas();
    say_what_was_met();
    return std::move(table_);
  }

 private:
  /// "sep=;", as a spreadsheet writes it.
  bool says_separator(std::string_view line) {
    constexpr std::string_view key = "sep=";
    if (!line.starts_with(key) || line.size() != key.size() + 1) return false;
    separator_ = line.back();
    return true;
  }

  static char separator_of(std::string_view header) {
    bool quoted = false;
    std::string open;  // what stands outside quotes
    for (const char c : header) {
      quoted = quoted != (c == '"');
      if (!quoted && c != '"') open += c;
    }
    for (const char one : {';', ',', '\t'})
      if (trimmed(open).find(one) != std::string_view::npos) return one;
    return words_of(open).size() > 1 ? blanks : ',';
  }

  void read_header(std::string_view line) {
    if (separator_ == '\0') separator_ = separator_of(line);
    std::vector<std::string> cells = joined_units(cells_of(line));
    if (all_numbers(cells)) {
      if (!remark_) lines_.fail("numbers alone; expected a header of names before them, as t,a");
      // The header stands in a comment, as NumPy writes it.
      const std::string_view remark = trimmed(trimmed(*remark_).substr(1));
      const std::vector<std::string> names = joined_units(cells_of(remark));
      if (names.size() != cells.size() || all_numbers(names))
        lines_.fail(fmt::format("numbers alone; expected a header of {} names before them", cells.size()));
      table_.notes.push_back(fmt::format("{}: the header is the comment \"{}\"", lines_.name(), shortened(*remark_)));
      --comments_;
      take_header(names);
      add_row(line);
      return;
    }
    take_header(std::move(cells));
  }

  void take_header(std::vector<std::string> cells) {
    for (auto cell = cells.begin(); cell != cells.end(); ++cell)
      if (std::find(cells.begin(), cell, *cell) != cell)
        lines_.fail(fmt::format("column \"{}\" stands a second time", shortened(*cell)));
    table_.columns = std::move(cells);
  }

  /// Of names between blanks, "t [s]" is one.
  std::vector<std::string> joined_units(std::vector<std::string> cells) const {
    if (separator_ != blanks) return cells;
    std::vector<std::string> out;
    for (std::string& cell : cells)
      if (!out.empty() && (cell.starts_with('[') || cell.starts_with('(')))
        out.back() += " " + cell;
      else
        out.push_back(std::move(cell));
    return out;
  }

  std::vector<std::string> cells_of(std::string_view line) {
    std::vector<std::string> cells;
    if (separator_ == blanks) line = trimmed(line);
    const auto skip = [&] {
      while (!line.empty() && line.front() != separator_ && (line.front() == ' ' || line.front() == '\t'))
        line.remove_prefix(1);
    };
    while (true) {
      skip();
      std::string cell;
      if (line.starts_with('"')) {
        cell = quoted_cell(line);
        skip();
      } else {
        const std::size_t end =
            std::min(separator_ == blanks ? line.find_first_of(" \t") : line.find(separator_), line.size());
        cell = trimmed(line.substr(0, end));
        if (cell.find('"') != std::string::npos) lines_.fail("a quote within a cell; expected it round the whole cell");
        line.remove_prefix(end);
      }
      cells.push_back(std::move(cell));
      if (separator_ == blanks) line = trimmed(line);
      if (line.empty()) return cells;
      if (separator_ == blanks) continue;
      if (line.front() != separator_) lines_.fail("text behind a quoted cell; expected the next cell");
      line.remove_prefix(1);
    }
  }

  /// Takes it from the line. A quote within is two.
  std::string quoted_cell(std::string_view& line) {
    std::string cell;
    for (std::size_t at = 1; at < line.size(); ++at) {
      if (line[at] != '"') {
        cell += line[at];
      } else if (at + 1 < line.size() && line[at + 1] == '"') {
        cell += line[at++];
      } else {
        line.remove_prefix(at + 1);
        quoted_ = true;
        return std::string(trimmed(cell));
      }
    }
    lines_.fail("a quote that is not closed in its line");
  }

  void add_row(std::string_view line) {
    std::vector<std::string> cells = cells_of(line);
    if (cells.size() != table_.columns.size()) {
      const long here = lines_.line();
      lines_.fail_at(here, fmt::format("{} cell{}; expected {}, as in the header{}", cells.size(),
                                       cells.size() == 1 ? "" : "s", table_.columns.size(), cause(line, cells)));
    }
    table_.rows.push_back({lines_.line(), std::move(cells)});
  }

  /// Why a row has not as many cells as the header; "" where that is not known. Reads on.
  std::string cause(std::string_view line, const std::vector<std::string>& cells) {
    const std::size_t columns = table_.columns.size();
    if (separator_ == ',' && cells.size() > columns && cells.size() <= 2 * columns && all_numbers(cells))
      return ": these are decimal commas; expected points, or semicolons between cells";
    for (const auto& [one, word] : {std::pair(';', "semicolons"), {'\t', "tabs"}, {',', "commas"}})
      if (one != separator_ && separator_ != blanks && columns > 1 &&
          static_cast<std::size_t>(std::count(line.begin(), line.end(), one)) + 1 == columns)
        return fmt::format(": {} separate cells here; expected what separates the header", word);
    const auto numbers = [](std::string_view text) {
      const std::vector<std::string_view> words = words_of(text);
      const auto number = [](std::string_view word) { return finite_number(word).has_value(); };
      return std::all_of(words.begin(), words.end(), number) ? words.size() : 0;
    };
    if (separator_ != blanks && columns > 1 && numbers(line) == columns)
      return ": blanks separate cells here; expected what separates the header";
    constexpr int lines_of_text = 6;
    std::optional<std::string_view> next = line;
    for (int k = 0; k < lines_of_text && next && table_.rows.empty(); ++k, next = lines_.next())
      if (numbers(*next) > 2)
        return ": text, then numbers without a header; of an AT2 table give both, as \"NPTS= 1559, DT= 0.02 SEC\"";
    return "";
  }

  void take_decimal_commas() {
    if (separator_ == ',') return;
    const CsvFile::Row *comma = nullptr, *point = nullptr;
    bool sure = false;
    for (CsvFile::Row& row : table_.rows)
      for (std::string& cell : row.cells) {
        if (const auto text = pointed(cell)) {
          if (!comma) comma = &row;
          sure = sure || !maybe_thousands(cell);
          cell = *text;
        } else if (!point && cell.find('.') != std::string::npos && finite_number(cell)) {
          point = &row;
        }
      }
    if (!comma) return;
    if (point)
      lines_.fail_at(std::max(comma->line, point->line),
                     fmt::format("decimal commas (line {}) and points (line {}) in one table; expected one of them",
                                 comma->line, point->line));
    if (!sure) lines_.fail_at(comma->line, "commas before three digits; expected a decimal point, and no thousands");
    table_.notes.push_back(lines_.name() + ": decimal commas are read as points");
  }

  void say_what_was_met() {
    const auto say = [&](const std::string& what) { table_.notes.push_back(lines_.name() + ": " + what); };
    table_.notes.insert(table_.notes.begin(), lines_.notes().begin(), lines_.notes().end());
    if (separator_ != ',')
      say(fmt::format("{} separate its cells", separator_ == ';'      ? std::string("semicolons")
                                               : separator_ == '\t'   ? std::string("tabs")
                                               : separator_ == blanks ? std::string("blanks")
                                                                      : fmt::format("\"{}\"", separator_)));
    if (comments_ > 0) say(fmt::format("comments are left out (lines: {})", comments_));
    if (quoted_) say("its cells are in quotes");
    long count = 0;
    std::string first;
    for (std::size_t c = 0; c < table_.columns.size(); ++c) {
      // A column of numbers: elsewhere 1D2 may be a name.
      const auto number = [&](const CsvFile::Row& row) { return finite_number(row.cells[c]).has_value(); };
      if (!std::all_of(table_.rows.begin(), table_.rows.end(), number)) continue;
      for (const CsvFile::Row& row : table_.rows)
        if (!plain_number(row.cells[c]) && count++ == 0) first = row.cells[c];
    }
    if (count > 0) say(fmt::format("exponents of Fortran are read, as {} (cells: {})", shortened(first), count));
  }

  TextLines lines_;
  CsvFile table_;
  char separator_ = '\0';
  bool quoted_ = false;
  long comments_ = 0;
  std::optional<std::string_view> remark_;  // the last comment before the header
};

}  // namespace

std::size_t CsvFile::column(const std::string& key) const {
  const auto found = std::find(columns.begin(), columns.end(), key);
  if (found != columns.end()) return static_cast<std::size_t>(found - columns.begin());
  std::vector<std::size_t> same;
  std::string nearest = nearest_name(key, columns);
  constexpr std::size_t shortest = 3;
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const std::string& one = columns[c];
    if (unit_begin(one) < one.size() && trimmed(std::string_view(one).substr(0, unit_begin(one))) == key)
      same.push_back(c);
    // An abbreviation is nearer than any other word.
    if (one.size() >= shortest && key.starts_with(one)) nearest = one;
  }
  if (same.size() == 1) return same.front();
  throw FileError(fmt::format("{} has {} column \"{}\"; there are {}{}", name, same.empty() ? "no" : "more than one",
                              shortened(key), shortened(fmt::format("{}", fmt::join(columns, ","))),
                              nearest.empty() ? "" : fmt::format(": did you mean {}?", nearest)));
}

std::string CsvFile::unit(std::size_t column) const {
  const std::string& one = columns[column];
  const std::size_t begin = unit_begin(one);
  return begin == one.size() ? ""
                             : std::string(trimmed(std::string_view(one).substr(begin + 1, one.size() - begin - 2)));
}

void CsvFile::fail(const Row& row, const std::string& what) const {
  throw FileError(fmt::format("{}, line {}: {}", name, row.line, what));
}

double CsvFile::number(const Row& row, std::size_t column) const {
  if (const auto value = finite_number(row.cells[column])) return *value;
  fail(row, no_number(row.cells[column], columns[column]));
}

CsvFile read_csv(std::string_view content, const std::string& name) {
  return TableReader(content, name).read();
}

}  // namespace ricochet
