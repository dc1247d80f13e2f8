#include "runners/workers/machines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstring>
#include <map>
#include <ricochet/contract/errors.hpp>
#include <stdexcept>
#include <thread>

#include "runners/march/bytes.hpp"
#include "runners/march/study_identity.hpp"
#include "runners/store/fingerprint.hpp"
#include "runners/workers/allowed_processors.hpp"
#include "runners/workers/worker_process.hpp"

namespace ricochet {
namespace {

using Word = Message::Word;

constexpr int coordinator = 0;

/// A worker of this machine, and the thread that listens to it.
class AgentWorker {
 public:
  AgentWorker(Transport& transport, std::uint32_t number, const std::function<std::unique_ptr<Worker>()>& start)
      : transport_(transport), number_(number) {
    try {
      worker_ = start();
    } catch (const std::exception& error) {
      tell_end({.cause = error.what()});
      return;
    }
    listener_ = std::thread([this] { listen(); });
  }
  ~AgentWorker() {
    if (worker_) worker_->kill();
    if (listener_.joinable()) listener_.join();
  }
  AgentWorker(const AgentWorker&) = delete;
  AgentWorker& operator=(const AgentWorker&) = delete;

  void send(const Message& message) {
    if (worker_) worker_->send(message);
  }
  void kill() {
    if (worker_) worker_->kill();
  }
  bool ended() const { return ended_; }

 private:
  void listen() {
    constexpr double long_time = 1e6;
    Message message;
    for (;;) {
      const Channel::Heard heard = worker_->receive(message, long_time);
      if (heard == Channel::Heard::gone) break;
      // What an agent says of its workers is not theirs to say.
      if (heard != Channel::Heard::message || message.word == Word::ended) continue;
      message.worker = number_;
      transport_.send(coordinator, to_bytes(message));
    }
    tell_end(worker_->end());
  }
  void tell_end(const WorkerEnd& end) {
    transport_.send(coordinator, to_bytes(Message{.word = Word::ended, .content = to_bytes(end), .worker = number_}));
    ended_ = true;
  }

  Transport& transport_;
  const std::uint32_t number_;
  std::unique_ptr<Worker> worker_;
  std::thread listener_;
  std::atomic<bool> ended_{false};
};

}  // namespace

bool serve_as_agent(Transport& transport, const HostFacts& facts,
                    const std::function<std::unique_ptr<Worker>()>& start_worker, double silence) {
  transport.send(coordinator, to_bytes(Message{.word = Word::facts, .content = to_bytes(facts)}));
  std::map<std::uint32_t, std::unique_ptr<AgentWorker>> workers;
  auto told = std::chrono::steady_clock::now(), heard = told;
  for (;;) {
    const auto packet = transport.receive(alive_every / 4);
    const auto now = std::chrono::steady_clock::now();
    if (std::chrono::duration<double>(now - told).count() > alive_every) {
      told = now;
      transport.send(coordinator, to_bytes(Message{}));
      std::erase_if(workers, [](const auto& one) { return one.second->ended(); });
    }
    if (packet) heard = now;
    if (std::chrono::duration<double>(now - heard).count() > silence) return false;
    if (!packet) continue;
    const Message said = host_message(packet->bytes);
    if (said.word == Word::leave) {
      workers.clear();
      transport.send(coordinator, to_bytes(Message{.word = Word::gone}));
      return true;
    }
    if (said.word == Word::start) {
      workers[said.worker] = std::make_unique<AgentWorker>(transport, said.worker, start_worker);
      continue;
    }
    const auto found = workers.find(said.worker);
    if (found == workers.end()) continue;
    if (said.word == Word::kill)
      found->second->kill();
    else
      found->second->send(said);
  }
}

namespace {

std::string place(const HostFacts& one) {
  return fmt::format("rank {} on {}", one.rank, one.name);
}

}  // namespace

HostFacts facts_of_this_machine(int rank) {
  HostFacts facts;
  facts.rank = rank;
  try {
    facts.name = machine_name();
    const AllowedProcessors processors = allowed_processors();
    facts.processors = processors.count;
    facts.online = processors.online;
    facts.limit = processors.limit;
    facts.memory = free_memory();
    facts.program = program_hash();
    facts.arithmetic = arithmetic_digest();
  } catch (const std::exception& error) {
    facts.failure = error.what();
  }
  return facts;
}

std::vector<int> workers_of(const std::vector<HostFacts>& machines) {
  std::map<std::string, int> asked;
  for (const HostFacts& one : machines) asked[one.name] += one.processors;
  std::vector<int> workers;
  for (const HostFacts& one : machines) {
    const int all = asked[one.name];
    workers.push_back(all <= one.online ? one.processors : std::max(1, one.processors * one.online / all));
  }
  return workers;
}

std::string objections(const std::vector<HostFacts>& machines) {
  std::string text;
  const HostFacts& own = machines.front();
  for (const HostFacts& one : machines) {
    if (!one.failure.empty())
      text += fmt::format("{}: {}\n", place(one), one.failure);
    else if (one.program != own.program)
      text +=
          fmt::format("{} has another program than {}: all ranks must start the same build\n", place(one), own.name);
    else if (one.arithmetic != own.arithmetic)
      text += fmt::format(
          "{} computes other last digits than {} (another processor or C library): a study's results come from one "
          "arithmetic; ask for nodes of one kind (Slurm: --constraint)\n",
          place(one), own.name);
  }
  return text;
}

std::string oddities(const std::vector<HostFacts>& machines, const std::vector<int>& workers) {
  std::map<std::string, int> together;
  for (std::size_t i = 0; i < machines.size(); ++i) together[machines[i].name] += workers[i];
  std::string text;
  for (const HostFacts& one : machines)
    if (one.processors < one.online && one.limit.find("affinity") != std::string::npos &&
        together[one.name] < one.online)
      text += fmt::format(
          "{} may use {} of {} processors ({}); mpirun binds its ranks: start it with --bind-to none, one rank for "
          "each machine\n",
          place(one), one.processors, one.online, one.limit);
  return text;
}

std::string words_of(const std::vector<HostFacts>& machines, const std::vector<int>& workers) {
  std::map<std::string, int> together;
  std::vector<std::string> names;
  int all = 0;
  for (std::size_t i = 0; i < machines.size(); ++i) {
    if (together.count(machines[i].name) == 0) names.push_back(machines[i].name);
    together[machines[i].name] += workers[i];
    all += workers[i];
  }
  constexpr std::size_t named = 6;
  std::string list;
  for (std::size_t i = 0; i < std::min(named, names.size()); ++i)
    list += fmt::format("{}{} {}", i == 0 ? "" : ", ", names[i], together[names[i]]);
  if (names.size() > named) list += ", …";
  return fmt::format("{} worker{} on {} machine{}, {} rank{}: {}", all, all == 1 ? "" : "s", names.size(),
                     names.size() == 1 ? "" : "s", machines.size(), machines.size() == 1 ? "" : "s", list);
}

std::vector<std::shared_ptr<WorkerHost>> hosts_of(RemoteHosts& remote, const std::vector<HostFacts>& machines,
                                                  int jobs) {
  std::map<std::string, int> together;
  const std::vector<int> found = workers_of(machines);
  const auto width = [&](std::size_t i) { return jobs > 0 ? jobs : found[i]; };
  for (std::size_t i = 0; i < machines.size(); ++i) together[machines[i].name] += width(i);
  std::vector<std::shared_ptr<WorkerHost>> hosts;
  for (std::size_t i = 0; i < machines.size(); ++i) {
    const double memory = memory_for_each(machines[i].memory, together[machines[i].name]);
    if (i == 0)
      hosts.push_back(std::make_shared<LocalHost>(width(i), memory));
    else
      hosts.push_back(remote.host(machines[i].rank, width(i), memory));
  }
  return hosts;
}

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
  archive(end.cause, end.place, end.in_call, end.last_lines, end.no_memory, end.silent, end.stopped, end.host_lost);
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
