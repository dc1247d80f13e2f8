#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <ricochet/contract/said_format.hpp>
#include <stdexcept>
#include <string_view>

namespace ricochet {
namespace {

bool is_number(const fmt::basic_format_arg<fmt::format_context>& argument) {
  return fmt::visit_format_arg(
      [](const auto& value) {
        using T = std::decay_t<decltype(value)>;
        return std::is_arithmetic_v<T> && !std::is_same_v<T, bool> && !std::is_same_v<T, char>;
      },
      argument);
}

}  // namespace

Said said_of(fmt::string_view format, fmt::format_args arguments, const Said* const* texts) {
  const std::string_view all(format.data(), format.size());
  Said out;
  int next = 0;
  for (std::size_t at = 0; at < all.size();) {
    const char c = all[at];
    if (c != '{' && c != '}') {
      out.text += c;
      ++at;
      continue;
    }
    if (at + 1 < all.size() && all[at + 1] == c) {  // a brace that is written twice stands for itself
      out.text += c;
      at += 2;
      continue;
    }
    const std::size_t end = all.find('}', at);
    if (c == '}' || end == std::string_view::npos) throw std::logic_error("a format with a lone brace");
    const std::string_view field = all.substr(at + 1, end - at - 1);
    const std::size_t colon = std::min(field.find(':'), field.size());
    int number = 0;
    if (colon == 0)
      number = next++;
    else if (std::from_chars(field.data(), field.data() + colon, number).ptr != field.data() + colon)
      throw std::logic_error("a format with a named argument");
    const auto argument = arguments.get(number);
    if (const Said* const text = texts[number]) {
      out += *text;
    } else {
      const std::string piece =
          fmt::vformat("{" + std::string(field.substr(colon)) + "}", fmt::format_args(&argument, 1));
      if (is_number(argument)) out.marks.push_back({out.text.size(), piece.size()});
      out.text += piece;
    }
    at = end + 1;
  }
  return out;
}

}  // namespace ricochet
