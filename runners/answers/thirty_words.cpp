#include "runners/answers/thirty_words.hpp"

#include <algorithm>
#include <iterator>
#include <sstream>

namespace ricochet::answers {
namespace {

/// Without " (…)".
std::string without_brackets(std::string text) {
  for (std::size_t open; (open = text.find(" (")) != std::string::npos;) {
    std::size_t close = open + 1;
    int depth = 0;
    do {
      depth += text[close] == '(' ? 1 : text[close] == ')' ? -1 : 0;
      ++close;
    } while (depth > 0 && close < text.size());
    if (depth > 0) return text;
    text.erase(open, close - open);
  }
  return text;
}

/// A reason, then ever less of it.
std::vector<std::string> ever_shorter(const std::string& reason) {
  std::vector<std::string> out{reason, without_brackets(reason)};
  for (std::string rest = out.back();;) {
    std::size_t last = std::string::npos;
    for (const char* end : {". ", "; ", ": ", ", "})
      if (const std::size_t at = rest.rfind(end); at != std::string::npos && (last == std::string::npos || at > last))
        last = at;
    if (last == std::string::npos) return out;
    rest.resize(last);
    out.push_back(rest);
  }
}

}  // namespace

std::ptrdiff_t words_in(const std::string& sentence) {
  std::istringstream words(sentence);
  return std::distance(std::istream_iterator<std::string>(words), {});
}

bool fits(const std::string& sentence) {
  constexpr std::ptrdiff_t most = 30;
  return words_in(sentence) <= most;
}

std::string in_thirty_words(std::string must, const std::vector<std::vector<std::string>>& rest) {
  for (const std::vector<std::string>& part : rest)
    for (const std::string& wording : part)
      if (fits(must + wording)) {
        must += wording;
        break;
      }
  return must + ".";
}

std::string with_reason(const std::string& must, const std::string& reason, const std::string& ending) {
  std::string told;
  for (const std::string& shown : ever_shorter(reason)) {
    const bool has_numbers = std::any_of(shown.begin(), shown.end(), [](char c) { return c >= '0' && c <= '9'; });
    told = must + (shown.empty() ? "" : ": " + shown) + (has_numbers ? ending : "");
    if (fits(told)) break;
  }
  return told.ends_with('.') ? told : told + ".";
}

}  // namespace ricochet::answers
