#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <map>
#include <ricochet/contract/errors.hpp>
#include <ricochet/scene/files/text_file.hpp>
#include <set>

namespace ricochet {
namespace {

constexpr std::size_t longest_line = 64 * 1024;
constexpr double mebibyte = 1024.0 * 1024;

bool is_blank(char c) {
  return c == ' ' || c == '\t';
}

/// UTF-8 of UTF-16 that begins with its byte order mark; what is no character is U+FFFD.
std::string utf8_of(std::string_view bytes) {
  constexpr std::uint32_t replacement = 0xFFFD, high = 0xD800, low = 0xDC00, past = 0xE000;
  const bool little = bytes[0] == '\xFF';
  const auto unit = [&](std::size_t at) {
    const auto first = static_cast<unsigned char>(bytes[at]), second = static_cast<unsigned char>(bytes[at + 1]);
    return static_cast<std::uint32_t>(little ? second << 8U | first : first << 8U | second);
  };
  std::string out;
  for (std::size_t at = 2; at < bytes.size(); at += 2) {
    std::uint32_t code = at + 1 < bytes.size() ? unit(at) : replacement;
    if (code >= high && code < past) {
      const std::uint32_t next = at + 3 < bytes.size() ? unit(at + 2) : 0;
      const bool pair = code < low && next >= low && next < past;
      code = pair ? 0x10000 + ((code - high) << 10U) + (next - low) : replacement;
      if (pair) at += 2;
    }
    const auto tail = [&](unsigned shift) { out += static_cast<char>(0x80U | ((code >> shift) & 0x3FU)); };
    if (code < 0x80) {
      out += static_cast<char>(code);
    } else if (code < 0x800) {
      out += static_cast<char>(0xC0U | code >> 6U);
      tail(0);
    } else if (code < 0x10000) {
      out += static_cast<char>(0xE0U | code >> 12U);
      tail(6), tail(0);
    } else {
      out += static_cast<char>(0xF0U | code >> 18U);
      tail(12), tail(6), tail(0);
    }
  }
  return out;
}

std::uintmax_t file_limit() {
  const char* given = std::getenv("RICOCHET_FILE_LIMIT");
  if (!given || !*given) return std::uintmax_t{256} << 20U;
  const auto asked = whole_number(given);
  if (!asked)
    throw FileError(fmt::format("the environment has RICOCHET_FILE_LIMIT=\"{}\"; expected a whole number of bytes",
                                shortened(given)));
  return static_cast<std::uintmax_t>(*asked);
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
  if (content_.starts_with("\xFF\xFE") || content_.starts_with("\xFE\xFF")) {
    content_ = decoded_ = utf8_of(content_);
    notes_.push_back(name_ + " is read as UTF-16");
  }
  if (content_.find('\0') != std::string_view::npos)
    throw FileError(name_ + " has zero bytes: it is UTF-16 without a byte order mark, or no text; expected UTF-8");
}

std::optional<std::string_view> TextLines::next() {
  if (content_.empty()) return std::nullopt;
  ++line_;
  const std::size_t end = std::min(content_.find_first_of("\r\n"), content_.size());
  if (end > longest_line) fail(fmt::format("{} bytes long; expected at most {}", end, longest_line));
  const std::string_view line = content_.substr(0, end);
  const bool two = content_.substr(end).starts_with("\r\n");
  content_.remove_prefix(std::min(end + (two ? 2 : 1), content_.size()));
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

bool is_comment(std::string_view line) {
  line = trimmed(line);
  return line.starts_with('#') || line.starts_with('%');
}

std::optional<double> plain_number(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<double> fortran_number(std::string_view text) {
  constexpr std::size_t longest = 64;
  if (text.empty() || text.size() > longest) return std::nullopt;
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  const std::size_t begin = text[0] == '+' || text[0] == '-' ? 1 : 0;
  std::size_t end = begin;
  while (end < text.size() && (is_digit(text[end]) || text[end] == '.')) ++end;
  if (end == begin || end == text.size()) return std::nullopt;
  const std::string_view mantissa = text.substr(0, end);
  std::string_view exponent = text.substr(end);
  if (exponent[0] == 'D' || exponent[0] == 'd')
    exponent.remove_prefix(1);
  else if ((exponent[0] != '+' && exponent[0] != '-') || mantissa.find('.') == std::string_view::npos)
    return std::nullopt;  // without a letter, 1+6 may be anything
  if (exponent.starts_with('+')) exponent.remove_prefix(1);
  if (exponent.empty() || !(exponent[0] == '-' || is_digit(exponent[0]))) return std::nullopt;
  return plain_number(std::string(mantissa) + "e" + std::string(exponent));
}

std::optional<double> finite_number(std::string_view text) {
  const auto plain = plain_number(text);
  return plain ? plain : fortran_number(text);
}

std::optional<std::string> pointed(std::string_view text) {
  const std::size_t comma = text.find(',');
  if (comma == std::string_view::npos) return std::nullopt;
  std::string number(text);
  number[comma] = '.';
  return finite_number(number) ? std::optional(number) : std::nullopt;
}

std::string no_number(std::string_view text, const std::string& of) {
  const std::string said = "\"" + shortened(text) + "\"" + (of.empty() ? "" : " for " + shortened(of));
  if (pointed(text)) return said + " has a decimal comma; expected a point";
  if (!text.empty() && text.find_first_not_of('*') == std::string_view::npos)
    return said + " is a number too long for its field in Fortran; expected a finite number";
  return said + "; expected a finite number";
}

std::optional<long long> whole_number(std::string_view text) {
  long long value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < 0) return std::nullopt;
  return value;
}

bool lies_within(const std::filesystem::path& folder, const std::filesystem::path& file) {
  std::error_code error;
  const std::filesystem::path inner = std::filesystem::weakly_canonical(file, error);
  if (error) return false;
  const std::filesystem::path outer = std::filesystem::weakly_canonical(folder, error);
  if (error) return false;
  return std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end()).first == outer.end();
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
    throw FileError(fmt::format("\"{}\" has {:.4g} MiB; the limit is {:.4g} MiB (RICOCHET_FILE_LIMIT, bytes)",
                                shortened(name), static_cast<double>(size) / mebibyte,
                                static_cast<double>(limit) / mebibyte));
  std::string content(size, '\0');
  std::ifstream stream(file, std::ios::binary);
  if (!stream.read(content.data(), static_cast<std::streamsize>(size)))
    throw FileError(fmt::format("\"{}\" cannot be read", shortened(name)));
  return content;
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
  table.notes = file.notes;
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
    // A column of 0 and 1 is a common way to say it, and 0 no name of a support.
    if (!one.held.empty() && (!is_name(one.held) || one.held == "0"))
      file.fail(row, fmt::format("\"{}\" for held; expected nothing where it is free, fixed or the name of a support",
                                 shortened(one.held)));
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
