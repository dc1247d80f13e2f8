#include <algorithm>
#include <cctype>
#include <ricochet/contract/errors.hpp>

namespace ricochet {
namespace {

// Optimal string alignment distance: insertions, deletions, substitutions and swaps of neighbours cost one each.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  const std::size_t columns = b.size() + 1;
  std::vector<std::size_t> before(columns), last(columns), row(columns);
  for (std::size_t j = 0; j < columns; ++j) last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j < columns; ++j) {
      const std::size_t substitution = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, substitution});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) row[j] = std::min(row[j], before[j - 2] + 1);
    }
    std::swap(before, last);
    std::swap(last, row);
  }
  return last[b.size()];
}

}  // namespace

std::string nearest_name(std::string_view word, const std::vector<std::string>& candidates) {
  std::string best;
  std::size_t best_distance = std::max<std::size_t>(1, word.size() / 2) + 1;
  for (const std::string& candidate : candidates) {
    std::size_t distance = edit_distance(word, candidate);
    // An end is what a person types when in a hurry ("newmark-dumont" for "newmark-dumont-paoli").
    if (word.size() >= 3 && (candidate.starts_with(word) || candidate.ends_with(word)))
      distance = std::min<std::size_t>(distance, 1);
    // A letter is near every other one: only its other case is meant.
    const auto lower = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
    if (word.size() == 1 && (candidate.size() != 1 || lower(candidate[0]) != lower(word[0]))) continue;
    if (distance < best_distance) {
      best = candidate;
      best_distance = distance;
    }
  }
  return best;
}

std::string shortened(std::string_view text) {
  std::size_t characters = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if ((static_cast<unsigned char>(text[i]) & 0xC0U) == 0x80U) continue;
    if (characters++ == longest_quoted) return std::string(text.substr(0, i)) + "…";
  }
  return std::string(text);
}

std::string cut_short(std::string_view text) {
  constexpr std::string_view more = "…";
  if (text.size() <= longest_text) return std::string(text);
  std::size_t end = longest_text - more.size();
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;
  return std::string(text.substr(0, end)) + std::string(more);
}

std::string one_line(std::string_view text) {
  constexpr std::string_view blanks = " \t\r\n";
  std::string out;
  while (!text.empty()) {
    std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), line.size() + 1));
    const std::size_t begin = line.find_first_not_of(blanks);
    if (begin == std::string_view::npos) continue;
    line = line.substr(begin, line.find_last_not_of(blanks) + 1 - begin);
    if (!out.empty()) out += "; ";
    out += line;
  }
  return cut_short(out);
}

}  // namespace ricochet
