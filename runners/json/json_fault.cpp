#include "runners/json/json_fault.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string_view>
#include <vector>

#include "runners/table/plain_text.hpp"

namespace ricochet {
namespace {

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}
bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == '$';
}

/// Reads a JSON text and throws the first fault.
class Reader {
 public:
  explicit Reader(const std::string& text) : text_(text) {}

  void read() {
    if (text_.starts_with("\xEF\xBB\xBF")) i_ = 3;
    skip();
    value("the text", "");
    skip();
    if (i_ < text_.size()) fail(i_, fmt::format("something follows the end of the text: {}", token(i_)));
  }

 private:
  [[noreturn]] static void fail(std::size_t at, std::string message) { throw JsonFault{at, std::move(message)}; }

  char here() const { return i_ < text_.size() ? text_[i_] : '\0'; }
  bool at(std::string_view what) const { return text_.compare(i_, what.size(), what) == 0; }

  /// What stands at a place, for a message: a word, a number, a text, or one character.
  std::string token(std::size_t from) const {
    constexpr std::size_t longest = 40;
    std::size_t end = from;
    if (end < text_.size() && text_[end] == '"') {
      end = std::min(text_.find_first_of("\"\n", end + 1), text_.size());
      if (end < text_.size() && text_[end] == '"') ++end;
    } else {
      while (end < text_.size() && (is_letter(text_[end]) || is_digit(text_[end]) ||
                                    std::string_view("+-.").find(text_[end]) != std::string_view::npos))
        ++end;
      if (end == from) ++end;
      while (end < text_.size() && (static_cast<unsigned char>(text_[end]) & 0xC0U) == 0x80U) ++end;
    }
    if (end - from <= longest) return text_.substr(from, end - from);
    std::size_t cut = from + longest;
    while (cut > from && (static_cast<unsigned char>(text_[cut]) & 0xC0U) == 0x80U) --cut;
    return text_.substr(from, cut - from) + "…";
  }

  void skip() {
    while (i_ < text_.size() && std::string_view(" \t\r\n").find(text_[i_]) != std::string_view::npos) ++i_;
    if (at("//") || at("/*") || here() == '#')
      fail(i_, R"(comments are no JSON; write them as a key that begins with //, as in "//": "why")");
  }

  void refuse_quotes() const {
    if (here() == '\'') fail(i_, "texts stand in double quotes (\"), not in single ones");
    for (const char* quotes : {"“", "”", "„", "«", "»", "‘", "’"})
      if (at(quotes)) fail(i_, fmt::format("texts stand in straight double quotes (\"), not in {}", quotes));
  }

  /// `what`: what the value is of, "\"step\""; `before`: the comma after which it is expected, "" for none.
  void value(const std::string& what, const std::string& before) {
    const char c = here();
    if (i_ >= text_.size()) ended();
    if (c == '{') return object();
    if (c == '[') return list();
    if (c == '"') return string();
    refuse_quotes();
    if (is_digit(c) || c == '-' || c == '+' || c == '.') return number();
    if (is_letter(c)) return word();
    if (c == '}' || c == ']' || c == ',' || c == ':')
      fail(i_, before.empty() ? fmt::format("a value is missing for {}", what) : before);
    fail(i_, fmt::format("expected a value for {}, found {}", what, token(i_)));
  }

  void word() {
    const std::string word = token(i_);
    for (const std::string_view known : {"true", "false", "null"}) {
      if (word == known) {
        i_ += known.size();
        return;
      }
      const bool same = word.size() == known.size() && std::equal(word.begin(), word.end(), known.begin(),
                                                                  [](char a, char b) { return (a | 0x20) == b; });
      if (same) fail(i_, fmt::format("{} is written in small letters: {}", word, known));
    }
    if (word == "None" || word == "nil") fail(i_, fmt::format("{} is no JSON; write null", word));
    no_number(word);
    fail(i_, fmt::format("a text stands in double quotes: \"{}\"", word));
  }

  /// NaN and infinity, however they are spelled.
  void no_number(const std::string& word) const {
    std::string small;
    for (const char c : word)
      if (c != '-' && c != '+') small += static_cast<char>(c | 0x20);
    if (small == "nan" || small == "inf" || small == "infinity")
      fail(i_, fmt::format("{} is no JSON number; write a number, or null where none is meant", word));
  }

  void number() {
    const std::size_t begin = i_;
    const auto digits = [&] {
      const std::size_t first = i_;
      while (is_digit(here())) ++i_;
      return i_ > first;
    };
    if (here() == '+') fail(i_, fmt::format("a number has no sign + before it: {}", token(begin).substr(1)));
    if (here() == '-') ++i_;
    if (is_letter(here())) {
      i_ = begin;
      no_number(token(begin));
      fail(begin, fmt::format("{} is no number", token(begin)));
    }
    if (here() == '.')
      fail(begin, fmt::format("a number begins with a digit: {}0{}", begin < i_ ? "-" : "", token(i_)));
    const bool zero = here() == '0';
    const std::size_t first = i_;
    if (!digits()) fail(begin, fmt::format("{} is no number", token(begin)));
    if (zero && i_ - first > 1)
      fail(begin, fmt::format("{} begins with a needless 0, which JSON does not allow", token(begin)));
    if (here() == '.') {
      ++i_;
      if (!digits()) fail(begin, fmt::format("a digit is missing after the decimal point of {}", token(begin)));
    }
    if (here() == 'e' || here() == 'E') {
      ++i_;
      if (here() == '+' || here() == '-') ++i_;
      if (!digits()) fail(begin, fmt::format("a digit is missing in the exponent of {}", token(begin)));
    }
    if (is_letter(here()) || here() == '.')
      fail(begin, fmt::format("{} is no number; units are not written: every number is in SI units", token(begin)));
  }

  void string() {
    const std::size_t begin = i_++;
    while (here() != '"') {
      if (i_ >= text_.size() || here() == '\n')
        fail(begin, fmt::format("this text is not closed: a \" is missing after {}", token(begin)));
      if (static_cast<unsigned char>(here()) < 0x20)
        fail(i_, "a text may not contain a tab or another control character; write \\t for a tab");
      if (here() == '\\') {
        ++i_;
        const bool hex = here() == 'u' && i_ + 4 < text_.size() &&
                         std::all_of(text_.begin() + static_cast<std::ptrdiff_t>(i_) + 1,
                                     text_.begin() + static_cast<std::ptrdiff_t>(i_) + 5,
                                     [](char c) { return std::isxdigit(static_cast<unsigned char>(c)) != 0; });
        if (!hex && std::string_view("\"\\/bfnrt").find(here()) == std::string_view::npos)
          fail(i_ - 1,
               fmt::format("\\{} means nothing in a text; a backslash is written \\\\", token(i_).substr(0, 1)));
      }
      ++i_;
    }
    ++i_;
  }

  /// After a value inside of an object or a list that `open` begins: its end, or a comma and what must follow. True:
  /// the end.
  bool ends(std::size_t open, std::size_t value_begin, char close, const char* next) {
    const std::size_t value_end = i_;
    skip();
    if (i_ >= text_.size()) ended();
    if (here() == close) {
      ++i_;
      return true;
    }
    if (here() == ',') {
      const std::size_t comma = i_++;
      skip();
      if (here() == close) fail(comma, fmt::format("a trailing comma: {} must follow it, or it goes", next));
      if (here() == ',') fail(i_, "two commas: a value is missing between them, or one goes");
      // "0,4" as a member: what follows is no key.
      if (close == '}' && is_digit(here()) && comma == value_end && i_ == comma + 1 && is_digit(text_[value_end - 1])) {
        const std::string whole = text_.substr(value_begin, value_end - value_begin), part = token(i_);
        fail(comma, fmt::format("{0},{1}: a decimal point is meant, {0}.{1}", whole, part));
      }
      return false;
    }
    refuse_quotes();
    if (here() == '}' || here() == ']')
      fail(i_,
           fmt::format("{} closes what {} of line {} opened; expected {}", here(), text_[open], line_of(open), close));
    if (here() == '"' || here() == '{' || here() == '[' || here() == '-' || is_digit(here()) || is_letter(here()))
      fail(value_end, fmt::format("a comma is missing after {}", last(value_begin, value_end)));
    fail(i_, fmt::format("expected a comma or {}, found {}", close, token(i_)));
  }

  /// A value that was read, for a message: itself, or how it ends.
  std::string last(std::size_t begin, std::size_t end) const {
    const char opening = text_[begin];
    if (opening == '{' || opening == '[')
      return fmt::format("the {} that closes line {}", text_[end - 1], line_of(begin));
    return token(begin);
  }

  int line_of(std::size_t at) const {
    return 1 + static_cast<int>(std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
  }

  [[noreturn]] void ended() const {
    const std::size_t end = text_.find_last_not_of(" \t\r\n") + 1;
    if (open_.empty()) fail(end, "the text ends where a value is expected");
    const std::size_t open = open_.back();
    fail(end, fmt::format("the text ends before the {} of line {} is closed", text_[open], line_of(open)));
  }

  void object() {
    const std::size_t open = i_++;
    open_.push_back(open);
    skip();
    if (here() == '}') {
      ++i_;
      open_.pop_back();
      return;
    }
    for (bool end = false; !end;) {
      const std::size_t key_begin = i_;
      if (i_ >= text_.size()) ended();
      refuse_quotes();
      if (here() != '"') {
        if (is_letter(here())) fail(i_, fmt::format("a key stands in double quotes: \"{}\"", token(i_)));
        fail(i_, fmt::format("expected a key in double quotes, found {}", token(i_)));
      }
      string();
      const std::string key = token(key_begin);
      const std::size_t key_end = i_;
      skip();
      if (i_ >= text_.size()) ended();
      if (here() == '=') fail(i_, fmt::format("a colon, not =, stands after {}", key));
      if (here() != ':') fail(key_end, fmt::format("a colon is missing after {}", key));
      ++i_;
      skip();
      const std::size_t value_begin = i_;
      value(key, "");
      end = ends(open, value_begin, '}', "another key");
    }
    open_.pop_back();
  }

  void list() {
    const std::size_t open = i_++;
    open_.push_back(open);
    skip();
    if (here() == ']') {
      ++i_;
      open_.pop_back();
      return;
    }
    for (bool end = false; !end;) {
      const std::size_t value_begin = i_;
      value("the list", "expected a value of the list");
      end = ends(open, value_begin, ']', "another value");
    }
    open_.pop_back();
  }

  const std::string& text_;
  std::size_t i_ = 0;
  std::vector<std::size_t> open_;
};

}  // namespace

std::optional<JsonFault> find_json_fault(const std::string& text) {
  try {
    Reader(text).read();
  } catch (const JsonFault& fault) {
    return fault;
  }
  return std::nullopt;
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
