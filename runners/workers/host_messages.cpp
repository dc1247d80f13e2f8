#include "runners/workers/host_messages.hpp"

#include <cstring>
#include <stdexcept>
#include <string_view>

#include "runners/march/bytes.hpp"

namespace ricochet {
namespace {

constexpr const char* host_mark = "host 3";
constexpr std::string_view known_words = "f.smkelg";

// What stands before a message's own bytes, which are as they came.
struct HostHead {
  std::uint32_t worker = 0, about = 0;
  char what = '.', word = '.';
};

}  // namespace

template <class Archive>
void serialize(Archive& archive, HostFacts& facts) {
  archive(facts.name, facts.rank, facts.processors, facts.online, facts.limit, facts.memory, facts.program,
          facts.arithmetic, facts.failure);
}

template <class Archive>
void serialize(Archive& archive, WorkerEnd& end) {
  archive(end.cause, end.plugin, end.function, end.last_lines, end.silent, end.host_lost);
}

std::string to_bytes(const HostMessage& message) {
  HostHead head;
  head.worker = message.worker;
  head.about = message.message.about;
  head.what = static_cast<char>(message.what);
  head.word = static_cast<char>(message.message.word);
  std::string bytes(sizeof(head), '\0');
  std::memcpy(bytes.data(), &head, sizeof(head));
  return bytes + message.message.content;
}
std::string to_bytes(const HostFacts& facts) {
  return to_bytes(facts, host_mark);
}
std::string to_bytes(const WorkerEnd& end) {
  return to_bytes(end, host_mark);
}
HostMessage host_message(const std::string& bytes) {
  HostHead head;
  if (bytes.size() < sizeof(head)) throw std::runtime_error("a message between machines is cut short");
  std::memcpy(&head, bytes.data(), sizeof(head));
  if (known_words.find(head.what) == std::string_view::npos)
    throw std::runtime_error("a message between machines says nothing that is known");
  HostMessage message{static_cast<HostMessage::What>(head.what), head.worker, {}};
  message.message = {static_cast<Message::Word>(head.word), bytes.substr(sizeof(head)), head.about};
  return message;
}
HostFacts host_facts(const std::string& bytes) {
  return from_bytes<HostFacts>(bytes, host_mark);
}
WorkerEnd worker_end(const std::string& bytes) {
  return from_bytes<WorkerEnd>(bytes, host_mark);
}

}  // namespace ricochet
