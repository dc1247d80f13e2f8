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

}  // namespace ricochet
