#include "runners/workers/worker_messages.hpp"

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cereal/types/utility.hpp>
#include <cerrno>
#include <cstdint>
#include <cstring>

#include "runners/march/bytes.hpp"

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

namespace {

constexpr const char* message_mark = "message 2";

}  // namespace

template <class Archive>
void save(Archive& archive, const Cell& cell) {
  cell.visit([&](const auto& content) {
    using Content = std::decay_t<decltype(content)>;
    if constexpr (std::is_same_v<Content, std::monostate>)
      archive('n');
    else if constexpr (std::is_same_v<Content, bool>)
      archive('b', content);
    else if constexpr (std::is_same_v<Content, std::int64_t>)
      archive('i', content);
    else if constexpr (std::is_same_v<Content, double>)
      archive('d', content);
    else
      archive('s', content);
  });
}

template <class T, class Archive>
Cell cell_of(Archive& archive) {
  T content{};
  archive(content);
  return Cell(std::move(content));
}

template <class Archive>
void load(Archive& archive, Cell& cell) {
  char kind = 'n';
  archive(kind);
  if (kind == 'b') cell = cell_of<bool>(archive);
  if (kind == 'i') cell = cell_of<std::int64_t>(archive);
  if (kind == 'd') cell = cell_of<double>(archive);
  if (kind == 's') cell = cell_of<std::string>(archive);
}

template <class Archive>
void serialize(Archive& archive, Column& column) {
  archive(column.name, column.unit, column.text);
}

template <class Archive>
void save(Archive& archive, const Columns& columns) {
  archive(columns.get());
}

template <class Archive>
void load(Archive& archive, Columns& columns) {
  archive(columns.own());
}

template <class Archive>
void serialize(Archive& archive, Table& table) {
  archive(table.name, table.text, table.columns, table.rows);
}

template <class Archive>
void save(Archive& archive, const Series& series) {
  archive(series.get());
}

template <class Archive>
void load(Archive& archive, Series& series) {
  archive(series.own());
}

template <class Archive>
void serialize(Archive& archive, NumberTable& table) {
  archive(table.name, table.columns, table.values, table.words, table.exported, table.text);
}

template <class Archive>
void serialize(Archive& archive, Curve& curve) {
  archive(curve.names, curve.columns);
}

template <class Archive>
void serialize(Archive& archive, Mark& mark) {
  archive(mark.begin, mark.size, mark.unit);
}

template <class Archive>
void serialize(Archive& archive, Said& said) {
  archive(said.text, said.marks);
}

template <class Archive>
void serialize(Archive& archive, CaseRecord& record) {
  archive(record.id, record.status, record.reasons, record.excluded, record.steps, record.setup_seconds,
          record.run_seconds, record.measures, record.left_out, record.notes, record.operator_name, record.curve,
          record.tables, record.numbers, record.partial);
}

template <class Archive>
void serialize(Archive& archive, WorkerStudy& message) {
  archive(message.study, message.plugins, message.memory, message.width, message.arithmetic);
}

template <class Archive>
void serialize(Archive& archive, WorkerReady& message) {
  archive(message.identity, message.arithmetic, message.failure, message.pointer);
}

template <class Archive>
void serialize(Archive& archive, CaseOrder& message) {
  archive(message.id, message.budget, message.share);
}

template <class Archive>
void serialize(Archive& archive, BlockRequest& message) {
  archive(message.id, message.order, message.budget);
}

template <class Archive>
void serialize(Archive& archive, BlockStatus& message) {
  archive(message.what, message.content, message.share);
}

template <class Archive>
void serialize(Archive& archive, CaseAnswer& message) {
  archive(message.record, message.seconds, message.processor, message.found, message.error, message.pointer);
}

template <class Archive>
void serialize(Archive& archive, GivenUp& message) {
  archive(message.plugin, message.function, message.budget);
}

template <class Archive>
void serialize(Archive& archive, ShelfMessage& message) {
  archive(message.key, message.content);
}

std::string to_bytes(const WorkerStudy& message) {
  return packed(message, message_mark);
}
std::string to_bytes(const WorkerReady& message) {
  return packed(message, message_mark);
}
std::string to_bytes(const std::vector<CaseOrder>& message) {
  return packed(message, message_mark);
}
std::string to_bytes(const BlockRequest& message) {
  return packed(message, message_mark);
}
std::string to_bytes(const BlockStatus& message) {
  return packed(message, message_mark);
}
std::string to_bytes(const CaseAnswer& message) {
  return packed(message, message_mark);
}
std::string to_bytes(const GivenUp& message) {
  return packed(message, message_mark);
}
std::string to_bytes(const ShelfMessage& message) {
  return packed(message, message_mark);
}
std::string to_bytes(const CaseRecord& record) {
  return packed(record, message_mark);
}

template <class T>
T message_from(const std::string& bytes) {
  try {
    return unpacked<T>(bytes, message_mark);
  } catch (const std::exception& error) {
    // A length that is wrong asks for more memory than there is.
    throw NoMessage(error.what());
  }
}
template WorkerStudy message_from(const std::string&);
template WorkerReady message_from(const std::string&);
template std::vector<CaseOrder> message_from(const std::string&);
template BlockRequest message_from(const std::string&);
template BlockStatus message_from(const std::string&);
template CaseAnswer message_from(const std::string&);
template GivenUp message_from(const std::string&);
template ShelfMessage message_from(const std::string&);
template CaseRecord message_from(const std::string&);

}  // namespace ricochet
