#include "runners/json/json_text.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <functional>
#include <memory>
#include <ricochet/contract/errors.hpp>
#include <set>
#include <sstream>
#include <string_view>

#include "runners/table/text.hpp"

namespace ricochet {
namespace {

/// A string, a run of letters, digits and signs, or one character. Empty at the end of the text.
struct Token {
  std::size_t begin = 0, end = 0;
};

[[noreturn]] void cannot_be_read() {
  throw InputError("", std::string("cannot be read: ") + std::strerror(errno));
}

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

namespace {

constexpr std::size_t deepest = 100;

TextPosition position_of(const std::string& text, std::size_t offset) {
  TextPosition where;
  for (std::size_t i = 0; i < std::min(offset, text.size()); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    if (byte == '\n') {
      ++where.line;
      where.column = 1;
    } else if ((byte & 0xC0U) != 0x80U) {
      ++where.column;
    }
  }
  return where;
}

// What is said to readers and to editors alone.
bool is_remark(const std::string& key) {
  return key.starts_with("//") || key == "$schema";
}

// One past the closing quote of the string that opens at `begin`.
std::size_t string_end(const std::string& text, std::size_t begin) {
  std::size_t i = begin + 1;
  while (i < text.size() && text[i] != '"') i += text[i] == '\\' ? 2 : 1;
  return std::min(i + 1, text.size());
}

struct Open {
  bool object = false;
  std::string pointer;
  std::size_t index = 0;  // next element of a list
  bool key_next = false;  // the next string of an object is a key
  std::string member;     // pointer of the member being read
  std::set<std::string> keys;
};

// Walks a valid JSON text and tells each member (at its key) and each list element. `visit` returns false to stop.
// An explicit stack: the depth of the text is the user's.
void scan(const std::string& text, const std::function<bool(const std::string&, std::size_t, bool)>& visit) {
  std::vector<Open> stack;
  const auto value_pointer = [&](std::size_t offset, bool& go_on) -> std::string {
    if (stack.empty()) return "";
    Open& top = stack.back();
    if (top.object) return top.member;
    const std::string pointer = pointer_to(top.pointer, top.index++);
    go_on = visit(pointer, offset, false);
    return pointer;
  };
  bool go_on = true;
  for (std::size_t i = 0; i < text.size() && go_on;) {
    const char c = text[i];
    if (c == '{' || c == '[') {
      Open open;
      open.pointer = value_pointer(i, go_on);
      open.object = open.key_next = c == '{';
      stack.push_back(std::move(open));
      ++i;
    } else if (c == '}' || c == ']') {
      stack.pop_back();
      ++i;
    } else if (c == ',') {
      stack.back().key_next = stack.back().object;
      ++i;
    } else if (c == '"') {
      const std::size_t end = string_end(text, i);
      if (!stack.empty() && stack.back().key_next) {
        Open& top = stack.back();
        const auto key = Json::parse(text.substr(i, end - i)).get<std::string>();
        top.member = pointer_to(top.pointer, key);
        top.key_next = false;
        go_on = visit(top.member, i, !top.keys.insert(key).second && !is_remark(key));
      } else {
        value_pointer(i, go_on);
      }
      i = end;
    } else if (c == '-' || (c >= '0' && c <= '9') || c == 't' || c == 'f' || c == 'n') {
      value_pointer(i, go_on);
      while (i < text.size() && std::string_view(",]} \t\r\n").find(text[i]) == std::string_view::npos) ++i;
    } else {
      ++i;
    }
  }
}

std::size_t depth(const std::string& text, std::size_t& offset) {
  std::size_t now = 0, most = 0;
  for (std::size_t i = 0; i < text.size();) {
    if (text[i] == '"') {
      i = string_end(text, i);
      continue;
    }
    if (text[i] == '{' || text[i] == '[') {
      if (++now > most) {
        most = now;
        offset = i;
      }
      if (most > deepest) return most;
    } else if ((text[i] == '}' || text[i] == ']') && now > 0) {
      --now;
    }
    ++i;
  }
  return most;
}

// UTF-16 has a zero in every other byte of what people write, or begins with a mark.
bool is_utf16(const std::string& text) {
  return text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF") || text.find('\0') < 4;
}

[[noreturn]] void refuse_text(const std::string& text, const Json::parse_error& error) {
  if (text.find_first_not_of(" \t\r\n") == std::string::npos)
    throw SyntaxError({}, "the file is empty; expected a study, a JSON object");
  if (is_utf16(text)) throw SyntaxError({}, "not valid JSON: the file is UTF-16; save it as UTF-8");
  const JsonFault fault = json_fault(text, error);
  throw SyntaxError(position_of(text, fault.at),
                    "not valid JSON: " + fault.message + "\n" + shown_line(text, fault.at));
}

void drop_remarks(Json& value) {
  if (value.is_object()) {
    for (auto member = value.begin(); member != value.end();)
      member = is_remark(member.key()) ? value.erase(member) : std::next(member);
  }
  if (value.is_structured())
    for (Json& inside : value) drop_remarks(inside);
}

}  // namespace

std::string pointer_to(const std::string& parent, const std::string& key) {
  std::string result = parent + "/";
  for (const char c : key) {
    if (c == '~')
      result += "~0";
    else if (c == '/')
      result += "~1";
    else
      result += c;
  }
  return result;
}

std::string pointer_to(const std::string& parent, std::size_t index) {
  return parent + "/" + std::to_string(index);
}

std::string quote(const Json& value) {
  return shortened(value.dump(-1, ' ', false, Json::error_handler_t::replace));
}

Json parse_json(const std::string& text) {
  std::size_t deep_at = 0;
  if (depth(text, deep_at) > deepest)
    throw SyntaxError(position_of(text, deep_at), "nested deeper than " + std::to_string(deepest) + " levels");
  Json result;
  try {
    result = Json::parse(text);
  } catch (const Json::parse_error& error) {
    refuse_text(text, error);
  } catch (const Json::out_of_range& error) {
    const std::string what = error.what();
    const auto open = what.find('\''), close = what.rfind('\'');
    const std::string number = open < close ? what.substr(open + 1, close - open - 1) : "";
    throw SyntaxError(position_of(text, number.empty() ? 0 : text.find(number)),
                      "the number " + shortened(number) + " is too large for a double");
  }
  std::string twice;
  scan(text, [&](const std::string& pointer, std::size_t, bool repeated) {
    if (repeated) twice = pointer;
    return !repeated;
  });
  if (!twice.empty()) throw InputError(twice, "this key is given twice in the same object");
  drop_remarks(result);
  return result;
}

std::optional<TextPosition> locate(const std::string& text, const std::string& pointer) {
  std::size_t longest = 0, offset = 0;
  bool found = false;
  scan(text, [&](const std::string& here, std::size_t at, bool) {
    const bool ancestor =
        pointer.compare(0, here.size(), here) == 0 && (pointer.size() == here.size() || pointer[here.size()] == '/');
    // ≥: of a key given twice, the second one.
    if (ancestor && here.size() >= longest) {
      longest = here.size();
      offset = at;
      found = true;
    }
    return true;
  });
  if (!found && pointer.empty()) return std::nullopt;
  // The whole document holds a key that is missing at the top.
  if (!found) offset = text.find_first_not_of(" \t\r\n");
  if (offset == std::string::npos) return std::nullopt;
  return position_of(text, offset);
}

std::string read_text(const std::filesystem::path& file, const std::string& expected) {
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored))
    throw InputError("", "is a folder; expected " + expected + ", a JSON file");
  // Opening a pipe waits for who writes to it, and a device may have no end.
  if (std::filesystem::exists(file, ignored) && !std::filesystem::is_regular_file(file, ignored))
    throw InputError("", "is a pipe, a socket or a device; expected " + expected + ", a JSON file");
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) cannot_be_read();
  const std::unique_ptr<const int, void (*)(const int*)> closing(&descriptor, [](const int* one) { ::close(*one); });
  return read_to_end(descriptor, expected);
}

std::string read_to_end(int descriptor, const std::string& expected) {
  // Files of /proc have no size to ask for.
  std::string text, piece(std::size_t{1} << 16U, '\0');
  for (;;) {
    const ssize_t got = ::read(descriptor, piece.data(), piece.size());
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) cannot_be_read();
    if (got == 0) return text;
    text.append(piece, 0, static_cast<std::size_t>(got));
    if (text.size() > largest_text)
      throw InputError("",
                       fmt::format("has more than {} MiB; expected {}, a JSON file", largest_text >> 20U, expected));
  }
}

std::string explained(const InputError& error, std::string place, const std::string& text) {
  if (const auto* syntax = dynamic_cast<const SyntaxError*>(&error))
    return fmt::format("{}:{}:{}: {}", place, syntax->where().line, syntax->where().column, error.what());
  if (error.pointer().empty()) return place + ": " + error.what();
  if (!text.empty())
    if (const auto where = locate(text, error.pointer())) place += ":" + std::to_string(where->line);
  return place + ": at " + shortened(error.pointer()) + ": " + error.what();
}

std::string did_you_mean(const std::string& word, const std::vector<std::string>& candidates) {
  const std::string nearest = nearest_name(word, candidates);
  return nearest.empty() || nearest == word ? std::string() : "; did you mean \"" + shortened(nearest) + "\"?";
}

namespace {

/// Equal for names that differ in numbers alone: "third_octave_force_63Hz".
std::string without_digits(const std::string& name) {
  std::string out;
  for (const char c : name)
    if (std::isdigit(static_cast<unsigned char>(c)) == 0 && c != '.') out += c;
  return out;
}

}  // namespace

std::string quoted_list(const std::vector<std::string>& words) {
  constexpr std::size_t few = 4;
  const auto quoted = [](const std::string& word) { return "\"" + shortened(word) + "\""; };
  std::string result;
  for (std::size_t k = 0; k < words.size();) {
    const std::string family = without_digits(words[k]);
    std::size_t end = k + 1;
    while (end < words.size() && words[end] != words[k] && without_digits(words[end]) == family) ++end;
    const bool run = !family.empty() && end - k > few;
    if (!run) end = k + 1;
    result += (result.empty() ? "" : ", ") + quoted(words[k]) + (run ? " … " + quoted(words[end - 1]) : "");
    k = end;
  }
  return result;
}

}  // namespace ricochet
