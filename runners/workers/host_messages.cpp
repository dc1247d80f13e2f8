#include "runners/workers/host_messages.hpp"

#include <array>
#include <cstring>
#include <stdexcept>

#include "runners/march/bytes.hpp"

namespace ricochet {
namespace {

constexpr const char* host_mark = "host 3";
constexpr std::array<char, 8> machine_mark = {'h', 'o', 's', 't', ' ', '4', ':', ' '};

// What stands before a message's own bytes, which are as they came.
struct HostHead {
  std::array<char, 8> mark = machine_mark;
  std::uint32_t worker = 0, about = 0;
  char word = '.';
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

std::string to_bytes(const Message& message) {
  HostHead head;
  head.worker = message.worker;
  head.about = message.about;
  head.word = static_cast<char>(message.word);
  std::string bytes(sizeof(head), '\0');
  std::memcpy(bytes.data(), &head, sizeof(head));
  return bytes + message.content;
}
std::string to_bytes(const HostFacts& facts) {
  return to_bytes(facts, host_mark);
}
std::string to_bytes(const WorkerEnd& end) {
  return to_bytes(end, host_mark);
}
Message host_message(const std::string& bytes) {
  HostHead head;
  if (bytes.size() < sizeof(head)) throw std::runtime_error("a message between machines is cut short");
  std::memcpy(&head, bytes.data(), sizeof(head));
  if (head.mark != machine_mark) throw std::runtime_error("a message between machines says nothing that is known");
  return {static_cast<Message::Word>(head.word), bytes.substr(sizeof(head)), head.about, head.worker};
}
HostFacts host_facts(const std::string& bytes) {
  return from_bytes<HostFacts>(bytes, host_mark);
}
WorkerEnd worker_end(const std::string& bytes) {
  return from_bytes<WorkerEnd>(bytes, host_mark);
}

}  // namespace ricochet
