#pragma once
#include <fmt/core.h>

#include <algorithm>
#include <ricochet/contract/said.hpp>
#include <type_traits>

// Without a spec of its own. What it calls is in fmt/core.h whole: a plugin that includes no more of fmt is loaded.
template <>
struct fmt::formatter<ricochet::Said> {
  constexpr auto parse(fmt::format_parse_context& context) { return context.begin(); }
  template <class Context>
  auto format(const ricochet::Said& said, Context& context) const {
    return std::copy(said.text.begin(), said.text.end(), context.out());
  }
};

namespace ricochet {

/// What said() does, without its types. `texts`: an argument that is a Said, else null.
Said said_of(fmt::string_view format, fmt::format_args arguments, const Said* const* texts);

/// A text as fmt::format() makes it. Numbers among the arguments, and those of a Said among them, have their marks.
/// Fields: {}, {:spec}, {n}, {n:spec}; a spec has no field of its own.
template <class... Arguments>
Said said(fmt::format_string<const Arguments&...> format, const Arguments&... arguments) {
  [[maybe_unused]] const auto text = [](const auto& one) -> const Said* {
    if constexpr (std::is_same_v<std::decay_t<decltype(one)>, Said>)
      return &one;
    else
      return nullptr;
  };
  const Said* const texts[] = {text(arguments)..., nullptr};
  return said_of(format, fmt::make_format_args(arguments...), texts);
}

}  // namespace ricochet
