#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <ricochet/contract/abi.hpp>
#include <vector>

#define RICOCHET_TEXT_(x) #x
#define RICOCHET_TEXT(x) RICOCHET_TEXT_(x)

namespace ricochet {
namespace {

// "ricochet_abi__contract_1__eigen_3_4" → {"contract", "1"}, {"eigen", "3.4"}
std::vector<std::pair<std::string, std::string>> fields(std::string_view tag) {
  std::vector<std::pair<std::string, std::string>> result;
  std::size_t at = tag.find("__");
  while (at != std::string_view::npos) {
    const std::size_t next = tag.find("__", at + 2);
    const std::string_view field = tag.substr(at + 2, next == std::string_view::npos ? next : next - at - 2);
    const std::size_t split = field.find('_');
    std::string value(split == std::string_view::npos ? "" : field.substr(split + 1));
    for (char& c : value)
      if (c == '_') c = '.';
    result.emplace_back(std::string(field.substr(0, split)), std::move(value));
    at = next;
  }
  return result;
}

}  // namespace

std::string abi_tag() {
  return RICOCHET_TEXT(RICOCHET_ABI_SYMBOL);
}

std::optional<std::string> abi_mismatch(std::string_view plugin_tag) {
  const auto expected = fields(abi_tag()), found = fields(plugin_tag);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const std::string value = i < found.size() && found[i].first == expected[i].first ? found[i].second : "nothing";
    if (value != expected[i].second) return expected[i].first + ": expected " + expected[i].second + ", found " + value;
  }
  if (found.size() > expected.size()) return found[expected.size()].first + ": a field that this program does not know";
  return std::nullopt;
}

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
