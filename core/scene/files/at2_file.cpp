#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <optional>
#include <ricochet/contract/errors.hpp>
#include <ricochet/scene/files/text_file.hpp>
#include <string>
#include <vector>

namespace ricochet {
namespace {

/// Words of a line in capitals, separated by anything but digits, letters, signs and points.
std::vector<std::string> capital_words(std::string_view line) {
  std::vector<std::string> words(1);
  for (const char c : line) {
    const auto sign = static_cast<unsigned char>(c);
    if (std::isalnum(sign) != 0 || c == '.' || c == '+' || c == '-')
      words.back() += static_cast<char>(std::toupper(sign));
    else if (!words.back().empty())
      words.emplace_back();
  }
  if (words.back().empty()) words.pop_back();
  return words;
}

/// The number behind a word, "DT= .01"; nothing where none is.
std::optional<double> number_behind(const std::vector<std::string>& words, const std::string& key) {
  const auto at = std::find(words.begin(), words.end(), key);
  return at == words.end() || at + 1 == words.end() ? std::nullopt : finite_number(*(at + 1));
}

/// "UNITS OF G", "UNITS: G": what follows; "" where no unit is told.
std::string unit_in(std::string_view line) {
  std::string capitals;
  for (const char c : line) capitals += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  const std::size_t at = capitals.find("UNITS");
  if (at == std::string::npos) return "";
  std::string_view rest = trimmed(std::string_view(capitals).substr(at + std::string_view("UNITS").size()));
  for (const std::string_view before : {"OF ", ":", "="})
    if (rest.starts_with(before)) rest = trimmed(rest.substr(before.size()));
  return std::string(rest.substr(0, std::min(rest.find_first_of(" \t,"), rest.size())));
}

}  // namespace

std::optional<At2File> read_at2(std::string_view content, const std::string& name) {
  constexpr int most_lines = 6;
  constexpr double most_values = 1e8;
  TextLines lines(content, name);
  At2File out;
  out.notes = lines.notes();
  std::optional<double> count, step;
  while (!count && !step) {
    const auto line = lines.next();
    if (!line || lines.line() > most_lines) return std::nullopt;
    const std::vector<std::string> words = capital_words(*line);
    if (std::string unit = unit_in(*line); !unit.empty()) out.unit = std::move(unit);
    const auto has = [&](const char* key) { return std::find(words.begin(), words.end(), key) != words.end(); };
    if (!has("NPTS")) continue;
    count = number_behind(words, "NPTS");
    step = number_behind(words, "DT");
    // Earlier files: "1559  0.0200  NPTS, DT".
    if (!count && !step && has("DT") && words.size() > 3) {
      count = finite_number(words[0]);
      step = finite_number(words[1]);
    }
    // A table may have such a column.
    if (!count && !step) return std::nullopt;
    if (!step || !(*step > 0)) lines.fail("an AT2 table without dt; give it beside NPTS, as DT= 0.02 SEC");
    if (!count || !(*count >= 2) || *count > most_values || *count != static_cast<double>(static_cast<long>(*count)))
      lines.fail("an AT2 table without its number of values; give it beside DT, as NPTS= 1559");
  }
  out.step = *step;
  const auto expected = static_cast<std::size_t>(*count);
  while (const auto line = lines.next())
    for (const std::string_view word : words_of(*line)) {
      const auto value = finite_number(word);
      if (!value) lines.fail(no_number(word));
      if (out.values.size() == expected) lines.fail(fmt::format("a value after the {} that NPTS says", expected));
      out.values.push_back(*value);
    }
  if (out.values.size() < expected)
    lines.fail(fmt::format("end of file after {} values; NPTS says {}", out.values.size(), expected));
  out.notes.push_back(fmt::format("{} is read as AT2: {} values{}, dt {:g} s, the first at t = 0", name, expected,
                                  out.unit.empty() ? "" : " in " + shortened(out.unit), out.step));
  return out;
}

}  // namespace ricochet
