#include "runners/json/json_fault.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <ricochet/contract/errors.hpp>
#include <string_view>

#include "runners/table/plain_text.hpp"

namespace ricochet {
namespace {

/// A string, a run of letters, digits and signs, or one character. Empty at the end of the text.
struct Token {
  std::size_t begin = 0, end = 0;
};

bool in_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
         std::string_view("+-._$").find(c) != std::string_view::npos;
}

Token token_after(const std::string& text, std::size_t from) {
  const std::size_t begin = std::min(text.find_first_not_of(" \t\r\n", from), text.size());
  std::size_t end = begin;
  if (end < text.size() && text[end] == '"') {
    for (++end; end < text.size() && text[end] != '"' && text[end] != '\n';) end += text[end] == '\\' ? 2 : 1;
    return {begin, std::min(end + 1, text.size())};
  }
  while (end < text.size() && in_word(text[end])) ++end;
  if (end == begin && end < text.size()) ++end;
  while (end < text.size() && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) ++end;
  return {begin, end};
}

/// What the parser found and expected, without its rule, the position and what it read.
std::string words_of(const nlohmann::json::parse_error& error) {
  const std::string what = error.what();
  const std::size_t dash = what.find(" - "), read = what.find("; last read: "), expected = what.rfind("; expected ");
  if (dash == std::string::npos) return what;
  const std::size_t begin = dash + std::string_view(" - ").size();
  if (read == std::string::npos) return what.substr(begin);
  return what.substr(begin, read - begin) +
         (expected != std::string::npos && expected > read ? what.substr(expected) : "");
}

}  // namespace

JsonFault json_fault(const std::string& text, const nlohmann::json::parse_error& error) {
  Token before, found = token_after(text, text.starts_with("\xEF\xBB\xBF") ? 3 : 0);
  while (found.end < error.byte && found.begin < text.size()) {
    before = found;
    found = token_after(text, before.end);
  }
  const auto shown = [&](Token token) { return shortened(text.substr(token.begin, token.end - token.begin)); };
  const std::string words = words_of(error), token = shown(found);
  const char first = token.empty() ? '\0' : token.front(), last = before.end > 0 ? text[before.end - 1] : ',';
  const bool number = std::string_view("+-.0123456789").find(first) != std::string_view::npos;
  const bool word = number || in_word(first), follows = std::string_view("{[:,").find(last) == std::string_view::npos;
  if (token.empty()) return {before.end, words};
  if (words.find("UTF-8") != std::string::npos)
    return {error.byte - 1, "this byte is no UTF-8; save the file as UTF-8"};
  if (first == '/' || first == '#')
    return {found.begin, R"(comments are no JSON; write them as a key that begins with //, as in "//": "why")"};
  for (const char* quotes : {"'", "“", "”", "„", "«", "»", "‘", "’"})
    if (token.starts_with(quotes))
      return {found.begin, fmt::format("texts stand in straight double quotes (\"), not in {}", quotes)};
  if ((first == '}' || first == ']') && last == ',' && before.end > 0)
    return {before.begin,
            fmt::format("a trailing comma: another {} must follow it, or it goes", first == '}' ? "key" : "value")};
  if ((words.ends_with("expected '}'") || words.ends_with("expected ']'")) && follows &&
      (word || first == '"' || first == '{' || first == '['))
    return {before.end, fmt::format("a comma is missing after {}", shown(before))};
  if (word && std::string_view(error.what()).find("object key") != std::string_view::npos)
    return {found.begin,
            number ? fmt::format("a key stands in double quotes, found {}; a decimal point is no comma", token)
                   : fmt::format("a key stands in double quotes: \"{}\"", token)};
  if (number && !follows)
    return {found.begin, fmt::format("{} is no number of JSON, as 0.5 and -2e-3 are; units are not written", token)};
  if (word && !follows)
    return {found.begin,
            fmt::format("a text stands in double quotes: \"{}\"; else write a number, true, false or null", token)};
  if (first == '"' && words.find("U+000A") != std::string::npos)
    return {found.begin, "this text is not closed: a \" is missing"};
  return {first == '"' && words.starts_with("invalid") ? error.byte - 1 : found.begin, words};
}

std::string shown_line(const std::string& text, std::size_t at) {
  constexpr std::size_t around = 50;
  at = std::min(at, text.size());
  // The end of a text that ends its last line is shown behind that line.
  while (at > 0 && at == text.size() && text[at - 1] == '\n') --at;
  const std::size_t before = at == 0 ? std::string::npos : text.rfind('\n', at - 1);
  std::size_t begin = before == std::string::npos ? 0 : before + 1;
  std::size_t end = std::min(text.find_first_of("\r\n", at), text.size());
  const auto inside = [&](std::size_t i) {
    return i < text.size() && (static_cast<unsigned char>(text[i]) & 0xC0U) == 0x80U;
  };
  std::string left, right;
  if (at - begin > around) {
    for (begin = at - around; inside(begin);) ++begin;
    left = "…";
  }
  if (end - at > around) {
    for (end = at + around; inside(end);) --end;
    right = "…";
  }
  std::string line = left + text.substr(begin, end - begin) + right;
  std::replace(line.begin(), line.end(), '\t', ' ');
  const std::string head = left + text.substr(begin, at - begin);
  return "  " + line + "\n  " + std::string(shown_width(head), ' ') + "^";
}

}  // namespace ricochet
