#include "runners/workers/channel.hpp"

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>

namespace ricochet {
namespace {

// What stands before the bytes.
struct Head {
  std::uint64_t size = 0;
  std::uint32_t about = 0;
  char word = '.';
};
constexpr double within_a_message = 60;  // s
// More than any message is: a length beyond it was not written by this program.
constexpr std::uint64_t most_bytes = std::uint64_t{1} << 36;

bool send_all(int descriptor, const char* bytes, std::size_t count) {
  while (count > 0) {
    const ssize_t sent = ::send(descriptor, bytes, count, MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) return false;
    bytes += sent;
    count -= static_cast<std::size_t>(sent);
  }
  return true;
}

bool wait_for(int descriptor, double seconds) {
  constexpr double longest = 1e6;
  pollfd one{descriptor, POLLIN, 0};
  for (;;) {
    const int ready = ::poll(&one, 1, static_cast<int>(1e3 * std::min(seconds, longest)));
    if (ready > 0) return true;
    if (ready == 0 || errno != EINTR) return false;
  }
}

bool receive_all(int descriptor, char* bytes, std::size_t count) {
  while (count > 0) {
    if (!wait_for(descriptor, within_a_message)) return false;
    const ssize_t got = ::recv(descriptor, bytes, count, 0);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    bytes += got;
    count -= static_cast<std::size_t>(got);
  }
  return true;
}

}  // namespace

Channel::~Channel() {
  ::close(descriptor_);
}

bool Channel::send(const Message& message) {
  std::array<char, sizeof(Head)> bytes{};
  const Head head{message.content.size(), message.about, static_cast<char>(message.word)};
  std::memcpy(bytes.data(), &head, sizeof(head));
  const std::lock_guard guard(sending_);
  return send_all(descriptor_, bytes.data(), bytes.size()) &&
         send_all(descriptor_, message.content.data(), message.content.size());
}

Channel::Heard Channel::receive(Message& message, double seconds) {
  if (!wait_for(descriptor_, seconds)) return Heard::silence;
  std::array<char, sizeof(Head)> bytes{};
  if (!receive_all(descriptor_, bytes.data(), bytes.size())) return Heard::gone;
  Head head;
  std::memcpy(&head, bytes.data(), sizeof(head));
  if (head.size > most_bytes) return Heard::gone;
  message.word = static_cast<Message::Word>(head.word);
  message.about = head.about;
  message.content.resize(head.size);
  return receive_all(descriptor_, message.content.data(), message.content.size()) ? Heard::message : Heard::gone;
}

}  // namespace ricochet
