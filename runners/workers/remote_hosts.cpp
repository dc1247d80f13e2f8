#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <stdexcept>
#include <utility>

#include "runners/march/seconds.hpp"
#include "runners/workers/machines.hpp"

namespace ricochet {
namespace {

using Word = Message::Word;
using SteadyClock = std::chrono::steady_clock;

constexpr double look_around = 0.25;  // s

}  // namespace

struct RemoteHosts::Inbox {
  std::mutex mutex;
  std::condition_variable changed;
  std::deque<Message> messages;
  std::optional<WorkerEnd> end;

  void put(Message message) {
    const std::lock_guard guard(mutex);
    messages.push_back(std::move(message));
    changed.notify_all();
  }
  /// The first end counts.
  void close(WorkerEnd why) {
    const std::lock_guard guard(mutex);
    if (!end) end = std::move(why);
    changed.notify_all();
  }
};

class RemoteHosts::RemoteWorker : public Worker {
 public:
  RemoteWorker(RemoteHosts& all, int rank, std::uint32_t number, std::shared_ptr<Inbox> inbox)
      : all_(all), rank_(rank), number_(number), inbox_(std::move(inbox)) {
    all_.tell(rank_, {.word = Word::start, .worker = number_});
  }
  ~RemoteWorker() override {
    kill();
    const std::lock_guard guard(all_.mutex_);
    all_.ranks_.at(rank_).workers.erase(number_);
  }

  bool send(const Message& message) override {
    {
      const std::lock_guard guard(inbox_->mutex);
      if (inbox_->end) return false;
    }
    Message told = message;
    told.worker = number_;
    all_.tell(rank_, told);
    return true;
  }

  Channel::Heard receive(Message& message, double seconds) override {
    std::unique_lock lock(inbox_->mutex);
    inbox_->changed.wait_for(lock, std::chrono::duration<double>(seconds),
                             [&] { return inbox_->end || !inbox_->messages.empty(); });
    if (!inbox_->messages.empty()) {
      message = std::move(inbox_->messages.front());
      inbox_->messages.pop_front();
      return Channel::Heard::message;
    }
    return inbox_->end ? Channel::Heard::gone : Channel::Heard::silence;
  }

  void kill() override { all_.tell(rank_, {.word = Word::kill, .worker = number_}); }

  WorkerEnd end() override {
    kill();
    std::unique_lock lock(inbox_->mutex);
    inbox_->changed.wait(lock, [&] { return inbox_->end.has_value(); });
    return *inbox_->end;
  }

 private:
  RemoteHosts& all_;
  const int rank_;
  const std::uint32_t number_;
  const std::shared_ptr<Inbox> inbox_;
};

class RemoteHosts::Host : public WorkerHost {
 public:
  Host(RemoteHosts& all, int rank, std::string name, int width, double memory)
      : all_(all), rank_(rank), name_(std::move(name)), width_(width), memory_(memory) {}

  std::string name() const override { return name_; }
  int width() const override { return width_; }
  double memory() const override { return memory_; }
  bool there() const override { return !all_.ranks_.at(rank_).lost; }

  std::unique_ptr<Worker> start() override {
    const auto inbox = std::make_shared<Inbox>();
    std::uint32_t number = 0;
    {
      const std::lock_guard guard(all_.mutex_);
      number = ++all_.born_;
      Rank& rank = all_.ranks_.at(rank_);
      rank.workers[number] = inbox;
      if (rank.lost) inbox->close({.cause = "its machine is lost", .host_lost = true});
    }
    return std::make_unique<RemoteWorker>(all_, rank_, number, inbox);
  }

 private:
  RemoteHosts& all_;
  const int rank_;
  const std::string name_;
  const int width_;
  const double memory_;
};

RemoteHosts::RemoteHosts(Transport& transport, TellLost lost, double silence)
    : transport_(transport), lost_(std::move(lost)), silence_(silence) {
  for (int rank = 1; rank < transport.size(); ++rank) ranks_[rank];
  listener_ = std::thread([this] { listen(); });
}

RemoteHosts::~RemoteHosts() {
  dismiss();
  ending_ = true;
  listener_.join();
}

bool RemoteHosts::dismiss() {
  std::unique_lock lock(mutex_);
  if (!leaving_.exchange(true))
    for (const auto& [number, rank] : ranks_)
      if (!rank.lost) tell(number, {.word = Word::leave});
  changed_.wait(lock, [this] {
    return std::all_of(ranks_.begin(), ranks_.end(),
                       [](const auto& one) { return one.second.lost || one.second.gone; });
  });
  return std::none_of(ranks_.begin(), ranks_.end(), [](const auto& one) { return one.second.lost.load(); });
}

void RemoteHosts::tell(int rank, const Message& message) {
  transport_.send(rank, to_bytes(message));
}

void RemoteHosts::listen() {
  auto told = SteadyClock::now();
  while (!ending_) {
    if (auto packet = transport_.receive(look_around)) hear(std::move(*packet));
    look_for_lost();
    if (seconds_since(told) < alive_every) continue;
    told = SteadyClock::now();
    say_alive();
  }
}

void RemoteHosts::say_alive() {
  const std::lock_guard guard(mutex_);
  if (leaving_) return;
  for (const auto& [number, rank] : ranks_)
    if (!rank.lost) tell(number, {});
}

void RemoteHosts::hear(Transport::Packet packet) {
  const auto found = ranks_.find(packet.from);
  if (found == ranks_.end()) return;
  Rank& rank = found->second;
  if (rank.lost) return;  // its work was given to others
  rank.silent = 0;
  try {
    hear(rank, host_message(packet.bytes));
  } catch (const std::runtime_error&) {
    lose(rank, "says what this program does not understand (another build?)");
  }
}

void RemoteHosts::hear(Rank& rank, Message said) {
  if (said.word == Word::facts) {
    const std::lock_guard guard(mutex_);
    rank.facts = host_facts(said.content);
    changed_.notify_all();
    return;
  }
  if (said.word == Word::gone) {
    if (!leaving_) throw std::runtime_error("an agent went that nobody had sent home");
    const std::lock_guard guard(mutex_);
    rank.gone = true;
    changed_.notify_all();
    return;
  }
  std::shared_ptr<Inbox> inbox;
  {
    const std::lock_guard guard(mutex_);
    const auto found = rank.workers.find(said.worker);
    if (found == rank.workers.end()) return;
    inbox = found->second;
  }
  if (said.word == Word::ended)
    inbox->close(worker_end(said.content));
  else
    inbox->put(std::move(said));
}

void RemoteHosts::look_for_lost() {
  // Between two checks lies one receive(). A longer time passed while this process was stopped: what others said
  // meanwhile is still to be heard.
  const double passed = std::min({seconds_since(looked_), 2 * look_around, silence_ / 4});
  looked_ = SteadyClock::now();
  for (auto& [number, rank] : ranks_) {
    // Facts are waited for elsewhere.
    if (rank.lost || rank.gone || !(rank.facts || leaving_)) continue;
    rank.silent += passed;
    if (rank.silent >= silence_) lose(rank, "does not answer any more");
  }
}

void RemoteHosts::lose(Rank& rank, const std::string& why) {
  {
    const std::lock_guard guard(mutex_);
    rank.why = why;
    rank.lost = true;
    for (const auto& [worker, inbox] : rank.workers) inbox->close({.cause = "its machine is lost", .host_lost = true});
    changed_.notify_all();
  }
  if (rank.facts) lost_(*rank.facts, why);
}

std::vector<HostFacts> RemoteHosts::facts() {
  std::vector<HostFacts> all;
  std::unique_lock lock(mutex_);
  for (auto& [number, rank] : ranks_) {
    changed_.wait_for(lock, std::chrono::duration<double>(silence_),
                      [&one = rank] { return one.facts.has_value() || one.lost; });
    if (!rank.facts && !rank.lost) {
      lock.unlock();
      lose(rank, "does not answer");
      lock.lock();
    }
    if (!rank.facts) throw std::runtime_error(fmt::format("rank {} {}", number, rank.why));
    all.push_back(*rank.facts);
  }
  return all;
}

std::shared_ptr<WorkerHost> RemoteHosts::host(int rank, int width, double memory) {
  const std::lock_guard guard(mutex_);
  return std::make_shared<Host>(*this, rank, ranks_.at(rank).facts.value().name, width, memory);
}

}  // namespace ricochet
