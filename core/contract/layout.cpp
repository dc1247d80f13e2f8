#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <ricochet/contract/layout.hpp>

namespace ricochet {

std::optional<std::string> layout_mismatch(const Layout& plugin) {
  struct Expected {
    const char *name, *type;
    std::uint64_t size;
  };
#define RICOCHET_EXPECTED_(name, ...) {#name, #__VA_ARGS__, sizeof(__VA_ARGS__)},
  static constexpr Expected expected[] = {RICOCHET_LAYOUTS(RICOCHET_EXPECTED_)};
#undef RICOCHET_EXPECTED_
  for (const auto& [name, type, size] : expected) {
    const auto found = plugin.find(name);
    if (found != plugin.end() && found->second == size) continue;
    const std::string_view text(type);
    const std::string_view own = "ricochet::";
    return fmt::format("layout: {}: expected {} bytes, found {}", text.starts_with(own) ? std::string_view(name) : text,
                       size, found == plugin.end() ? "nothing" : fmt::format("{}", found->second));
  }
  for (const auto& type : plugin) {
    const auto is_it = [&](const Expected& one) { return one.name == type.first; };
    if (std::none_of(std::begin(expected), std::end(expected), is_it))
      return fmt::format("layout: {}: a type that this program does not know", type.first);
  }
  return std::nullopt;
}

}  // namespace ricochet
