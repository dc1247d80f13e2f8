#pragma once
#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <type_traits>

namespace ricochet {

/// An enumeration whose values have words, which tables hold. words_of(Enum) gives them in the order of the values,
/// which count from 0.
template <class Enum>
concept Worded = std::is_enum_v<Enum> && requires(Enum value) {
  words_of(value).size();
};

template <Worded Enum>
constexpr const char* word(Enum value) {
  return words_of(value)[static_cast<std::size_t>(value)];
}

/// The value of a word; none of any other.
template <Worded Enum>
constexpr std::optional<Enum> of_word(std::string_view said) {
  const auto words = words_of(Enum{});
  for (std::size_t k = 0; k < words.size(); ++k)
    if (said == words[k]) return static_cast<Enum>(k);
  return std::nullopt;
}

}  // namespace ricochet
