#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <ricochet/contract/errors.hpp>
#include <ricochet/scene/files/text_file.hpp>
#include <set>

namespace ricochet {
namespace {

constexpr std::size_t longest_line = 64 * 1024;
constexpr double gibibyte = 1024.0 * 1024 * 1024;

bool is_blank(char c) {
  return c == ' ' || c == '\t';
}

std::uintmax_t file_limit() {
  const char* given = std::getenv("RICOCHET_FILE_LIMIT");
  const auto asked = given ? whole_number(given) : std::nullopt;
  return asked ? static_cast<std::uintmax_t>(*asked) : std::uintmax_t{2} << 30U;
}

std::string missing_text(const std::filesystem::path& folder, const std::string& name) {
  constexpr std::size_t most_names = 12;
  std::vector<std::string> names;
  std::error_code error;
  const std::filesystem::path inside = (folder / name).parent_path();
  for (auto item = std::filesystem::directory_iterator(inside, error);
       !error && item != std::filesystem::directory_iterator(); item.increment(error))
    names.push_back(item->path().filename().string());
  std::sort(names.begin(), names.end());
  const std::string nearest = nearest_name(std::filesystem::path(name).filename().string(), names);
  if (names.empty()) return fmt::format("\"{}\": no such file, and no other in its folder", shortened(name));
  const bool more = names.size() > most_names;
  if (more) names.resize(most_names);
  return fmt::format("\"{}\": no such file; there are {}{}{}", shortened(name), fmt::join(names, ", "),
                     more ? ", …" : "", nearest.empty() ? "" : fmt::format("; did you mean \"{}\"?", nearest));
}

}  // namespace

TextLines::TextLines(std::string_view content, std::string name) : content_(content), name_(std::move(name)) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (content_.starts_with(byte_order_mark)) content_.remove_prefix(byte_order_mark.size());
}

std::optional<std::string_view> TextLines::next() {
  if (content_.empty()) return std::nullopt;
  ++line_;
  const std::size_t end = std::min(content_.find('\n'), content_.size());
  if (end > longest_line) fail(fmt::format("{} bytes long; expected at most {}", end, longest_line));
  std::string_view line = content_.substr(0, end);
  content_.remove_prefix(std::min(end + 1, content_.size()));
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

void TextLines::fail(const std::string& what) const {
  fail_at(line_, what);
}

void TextLines::fail_at(long line, const std::string& what) const {
  throw FileError(fmt::format("{}, line {}: {}", name_, line, what));
}

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  for (std::size_t i = 0; i < line.size();) {
    while (i < line.size() && is_blank(line[i])) ++i;
    const std::size_t begin = i;
    while (i < line.size() && !is_blank(line[i])) ++i;
    if (i > begin) words.push_back(line.substr(begin, i - begin));
  }
  return words;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

std::optional<double> finite_number(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<long long> whole_number(std::string_view text) {
  long long value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < 0) return std::nullopt;
  return value;
}

std::string read_file(const std::filesystem::path& folder, const std::string& name) {
  const std::filesystem::path file = folder / name;
  std::error_code error;
  if (!std::filesystem::exists(file, error)) throw FileError(missing_text(folder, name));
  if (!std::filesystem::is_regular_file(file, error))
    throw FileError(fmt::format("\"{}\" is no file; expected one that can be read", shortened(name)));
  const std::uintmax_t size = std::filesystem::file_size(file, error), limit = file_limit();
  if (error) throw FileError(fmt::format("\"{}\" cannot be read: {}", shortened(name), error.message()));
  if (size > limit)
    throw FileError(fmt::format("\"{}\" has {:.2g} GB; the limit is {:.2g} GiB (RICOCHET_FILE_LIMIT, bytes)",
                                shortened(name), static_cast<double>(size) / 1e9,
                                static_cast<double>(limit) / gibibyte));
  std::string content(size, '\0');
  std::ifstream stream(file, std::ios::binary);
  if (!stream.read(content.data(), static_cast<std::streamsize>(size)))
    throw FileError(fmt::format("\"{}\" cannot be read", shortened(name)));
  return content;
}

namespace {

std::vector<std::string> cells_of(std::string_view line, const TextLines& lines) {
  if (line.find('"') != std::string_view::npos) lines.fail("a quote; expected cells without quotes");
  std::vector<std::string> cells;
  while (true) {
    const std::size_t end = std::min(line.find(','), line.size());
    cells.emplace_back(trimmed(line.substr(0, end)));
    if (end == line.size()) return cells;
    line.remove_prefix(end + 1);
  }
}

}  // namespace

std::size_t CsvFile::column(const std::string& key) const {
  const auto found = std::find(columns.begin(), columns.end(), key);
  if (found != columns.end()) return static_cast<std::size_t>(found - columns.begin());
  std::string nearest = nearest_name(key, columns);
  constexpr std::size_t shortest = 3;
  for (const std::string& one : columns)  // an abbreviation is nearer than any other word
    if (one.size() >= shortest && key.starts_with(one)) nearest = one;
  throw FileError(fmt::format("{} has no column \"{}\"; there are {}{}", name, key, fmt::join(columns, ","),
                              nearest.empty() ? "" : fmt::format(": did you mean {}?", nearest)));
}

void CsvFile::fail(const Row& row, const std::string& what) const {
  throw FileError(fmt::format("{}, line {}: {}", name, row.line, what));
}

double CsvFile::number(const Row& row, std::size_t column) const {
  if (const auto value = finite_number(row.cells[column])) return *value;
  fail(row, fmt::format("\"{}\" for {}; expected a finite number", shortened(row.cells[column]), columns[column]));
}

CsvFile read_csv(std::string_view content, const std::string& name) {
  TextLines lines(content, name);
  CsvFile table;
  table.name = name;
  while (const auto line = lines.next()) {
    if (trimmed(*line).empty()) continue;
    std::vector<std::string> cells = cells_of(*line, lines);
    if (table.columns.empty()) {
      for (std::size_t i = 0; i < cells.size(); ++i)
        if (std::find(cells.begin(), cells.begin() + static_cast<std::ptrdiff_t>(i), cells[i]) !=
            cells.begin() + static_cast<std::ptrdiff_t>(i))
          lines.fail(fmt::format("column \"{}\" stands a second time", shortened(cells[i])));
      table.columns = std::move(cells);
      continue;
    }
    if (cells.size() != table.columns.size())
      lines.fail(fmt::format("{} cells; expected {}, as in the header", cells.size(), table.columns.size()));
    table.rows.push_back({lines.line(), std::move(cells)});
  }
  if (table.columns.empty()) throw FileError(name + " is empty; expected a header of columns");
  return table;
}

namespace {

/// Names are words of a study and of tables.
bool is_name(std::string_view text) {
  constexpr std::size_t longest = 64;
  return !text.empty() && text.size() <= longest && std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return c > ' ' && c != ',' && c != '"' && c != '/';
  });
}

// The least number from 1 that no row has.
long long first_missing(const CsvFile& file, std::size_t dof) {
  std::set<long long> known;
  for (const CsvFile::Row& row : file.rows)
    if (const auto number = whole_number(row.cells[dof])) known.insert(*number);
  long long missing = 1;
  while (known.count(missing) != 0) ++missing;
  return missing;
}

}  // namespace

DofTable read_dof_table(std::string_view content, const std::string& name) {
  const CsvFile file = read_csv(content, name);
  const std::size_t dof = file.column("dof"), node = file.column("node"), component = file.column("component"),
                    held = file.column("held");
  const std::array<std::size_t, 3> axes = {file.column("x"), file.column("y"), file.column("z")};
  const std::size_t count = file.rows.size();
  DofTable table;
  table.name = name;
  table.dofs.resize(count);
  std::map<std::pair<std::string, std::string>, int> known;
  std::map<std::string, const DofName*> nodes;
  for (const CsvFile::Row& row : file.rows) {
    const auto number = whole_number(row.cells[dof]);
    if (!number || *number < 1)
      file.fail(row, fmt::format("\"{}\" for dof; expected a whole number from 1", shortened(row.cells[dof])));
    if (static_cast<std::size_t>(*number) > count)
      file.fail(row, fmt::format("dof {} of a table of {}; expected 1 to {}, each once: {} is missing", *number, count,
                                 count, first_missing(file, dof)));
    DofName& one = table.dofs[static_cast<std::size_t>(*number) - 1];
    if (one.dof != 0) file.fail(row, fmt::format("dof {} stands a second time", *number));
    one.dof = static_cast<int>(*number);
    one.node = row.cells[node];
    one.component = row.cells[component];
    one.held = row.cells[held];
    for (const auto& [text, what] : {std::pair(&one.node, "node"), {&one.component, "component"}})
      if (!is_name(*text))
        file.fail(row, fmt::format("\"{}\" for {}; expected a word without spaces", shortened(*text), what));
    if (!one.held.empty() && !is_name(one.held))
      file.fail(row,
                fmt::format("\"{}\" for held; expected nothing, fixed or the name of a support", shortened(one.held)));
    for (std::size_t axis = 0; axis < axes.size(); ++axis) one.place[axis] = file.number(row, axes[axis]);
    const auto [first, fresh] = known.emplace(std::pair(one.node, one.component), one.dof);
    if (!fresh) file.fail(row, fmt::format("{} is dof {} and dof {}", one.text(), first->second, one.dof));
    const auto [other, new_node] = nodes.emplace(one.node, &one);
    if (!new_node && other->second->place != one.place)
      file.fail(row, fmt::format("node {} has two places; expected the same x, y, z in its rows", one.node));
  }
  // Each number is at most the count and stands once: none is missing.
  if (count == 0) throw FileError(name + " has no dofs; expected one row per row of the matrices");
  return table;
}

}  // namespace ricochet
