#include <ricochet/contract/shortened.hpp>

namespace ricochet {

std::string shortened(std::string_view text) {
  std::size_t characters = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if ((static_cast<unsigned char>(text[i]) & 0xC0U) == 0x80U) continue;
    if (characters++ == longest_quoted) return std::string(text.substr(0, i)) + "…";
  }
  return std::string(text);
}

}  // namespace ricochet
