#include "runners/table/plain_output.hpp"

#include <string_view>

#include "runners/table/text.hpp"

namespace ricochet {
namespace {

/// The bytes of a text without the beginning of a character that is not whole yet.
std::size_t whole(std::string_view text) {
  constexpr std::size_t longest = 4;
  for (std::size_t back = 1; back <= longest && back <= text.size(); ++back) {
    const auto byte = static_cast<unsigned char>(text[text.size() - back]);
    if ((byte & 0xC0U) == 0x80U) continue;
    const std::size_t length = byte >= 0xF0 ? 4 : byte >= 0xE0 ? 3 : byte >= 0xC0 ? 2 : 1;
    return length > back ? text.size() - back : text.size();
  }
  return text.size();
}

}  // namespace

PlainOutput::PlainOutput(std::ostream& stream) : stream_(stream), target_(stream.rdbuf()) {
  const std::ios::iostate state = stream.rdstate();
  stream_.rdbuf(this);
  stream_.clear(state);
}

PlainOutput::~PlainOutput() {
  hand_on(kept_.size());
  const std::ios::iostate state = stream_.rdstate();
  stream_.rdbuf(target_);
  stream_.clear(state);
}

bool PlainOutput::hand_on(std::size_t count) {
  const std::string text = plain_text(std::string_view(kept_).substr(0, count));
  kept_.erase(0, count);
  const auto size = static_cast<std::streamsize>(text.size());
  return target_->sputn(text.data(), size) == size;
}

PlainOutput::int_type PlainOutput::overflow(int_type c) {
  if (traits_type::eq_int_type(c, traits_type::eof())) return traits_type::not_eof(c);
  kept_ += traits_type::to_char_type(c);
  return hand_on(whole(kept_)) ? c : traits_type::eof();
}

std::streamsize PlainOutput::xsputn(const char* text, std::streamsize count) {
  kept_.append(text, static_cast<std::size_t>(count));
  return hand_on(whole(kept_)) ? count : 0;
}

int PlainOutput::sync() {
  const bool handed = hand_on(whole(kept_));
  return handed && target_->pubsync() == 0 ? 0 : -1;
}

}  // namespace ricochet
