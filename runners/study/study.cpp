#include "runners/study/study.hpp"

#include <fmt/format.h>

#include <charconv>

namespace ricochet {
namespace {

/// 0 where the text is no positive number.
int counted_from(std::string_view text) {
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size() && number > 0 ? number : 0;
}

}  // namespace

std::string StudyPart::text() const {
  return whole() ? "the whole study" : fmt::format("part {} of {}", number, of);
}

std::optional<StudyPart> part_from(std::string_view text) {
  const std::size_t slash = text.find('/');
  if (slash == std::string_view::npos) return std::nullopt;
  const StudyPart part{counted_from(text.substr(0, slash)), counted_from(text.substr(slash + 1))};
  if (part.number == 0 || part.of == 0 || part.number > part.of) return std::nullopt;
  return part;
}

}  // namespace ricochet
