#include "tests/runners/workers/scripted_network.hpp"

#include <thread>
#include <utility>

namespace ricochet::tests {
namespace {

using Word = Message::Word;
using FateWhat = ScriptedNetwork::Fate::What;

double seconds_between(std::chrono::steady_clock::time_point a, std::chrono::steady_clock::time_point b) {
  return std::chrono::duration<double>(b - a).count();
}

}  // namespace

ScriptedNetwork::ScriptedNetwork(ScriptedWorld& world, std::uint32_t seed, std::vector<Fate> fates, double alive_every)
    : world_(world), alive_every_(alive_every), luck_(seed) {
  constexpr int paces[] = {1, 10, 100};
  for (const Fate& fate : fates) {
    Agent& agent = agents_.emplace_back();
    agent.fate = fate;
    agent.pace = paces[luck_() % std::size(paces)];
    HostFacts facts;
    facts.rank = static_cast<int>(agents_.size());
    facts.name = "machine " + std::to_string(facts.rank);
    agent.from_it.push_back(to_bytes(Message{.word = Word::facts, .content = to_bytes(facts)}));
  }
}

void ScriptedNetwork::send(int to, std::string bytes) {
  const std::lock_guard guard(mutex_);
  agents_.at(static_cast<std::size_t>(to) - 1).to_it.push_back(std::move(bytes));
  changed_.notify_all();
}

std::optional<Transport::Packet> ScriptedNetwork::receive(double) {
  // Nobody moves while nobody listens: a look now and then is soon enough.
  constexpr auto poll_interval = std::chrono::milliseconds(2);
  std::unique_lock lock(mutex_);
  if (stop_after_ >= 0 && stop_after_-- == 0) std::this_thread::sleep_for(std::chrono::duration<double>(stop_seconds_));
  for (;;) {
    look_at_the_clock();
    std::vector<std::pair<std::size_t, bool>> moves;  // of which agent; whether it hears, or is heard
    for (std::size_t i = 0; i < agents_.size(); ++i) {
      const Agent& agent = agents_[i];
      if (agent.dark) continue;
      const auto times = static_cast<std::size_t>(agent.pace);
      if (!agent.to_it.empty() && !agent.home) moves.insert(moves.end(), times, {i, true});
      if (!agent.from_it.empty()) moves.insert(moves.end(), times, {i, false});
    }
    if (moves.empty()) {
      if (changed_.wait_for(lock, poll_interval) == std::cv_status::timeout) return std::nullopt;
      continue;
    }
    const auto [i, hears] = moves[luck_() % moves.size()];
    Agent& agent = agents_[i];
    std::deque<std::string>& line = hears ? agent.to_it : agent.from_it;
    std::string bytes = std::move(line.front());
    line.pop_front();
    if (!hears) return Packet{static_cast<int>(i) + 1, std::move(bytes)};
    hear(agent, bytes);
    if (++agent.heard == agent.fate.after) meet_fate(agent);
  }
}

void ScriptedNetwork::hear(Agent& agent, const std::string& bytes) {
  const Message said = host_message(bytes);
  if (said.word == Word::leave) {
    agent.home = true;
    agent.workers.clear();
    agent.from_it.push_back(to_bytes(Message{.word = Word::gone}));
  }
  if (said.word == Word::start) agent.workers[said.worker] = std::make_unique<ScriptedWorker>(world_);
  const auto found = agent.workers.find(said.worker);
  if (found == agent.workers.end()) return;
  ScriptedWorker& worker = *found->second;
  if (said.word == Word::kill) worker.kill();
  if (said.word != Word::start && said.word != Word::kill) worker.send(said);
  pass_on(agent, said.worker, worker);
  if (worker.ended()) agent.workers.erase(found);
}

void ScriptedNetwork::pass_on(Agent& agent, std::uint32_t number, ScriptedWorker& worker) {
  for (Message message; worker.receive(message, 0) == Channel::Heard::message;) {
    message.worker = number;
    agent.from_it.push_back(to_bytes(message));
  }
  if (worker.ended())
    agent.from_it.push_back(
        to_bytes(Message{.word = Word::ended, .content = to_bytes(worker.end()), .worker = number}));
}

void ScriptedNetwork::meet_fate(Agent& agent) {
  if (agent.fate.what == FateWhat::vanishes || agent.fate.what == FateWhat::comes_back) {
    agent.dark = true;
    agent.since = Clock::now();
  }
  if (agent.fate.what == FateWhat::cut) {
    // What it says next does not come whole, and then nothing is left to say.
    if (agent.from_it.empty()) agent.from_it.push_back(to_bytes(Message{}));
    std::string& bytes = agent.from_it.front();
    bytes.resize(luck_() % bytes.size());
  }
  if (agent.fate.what == FateWhat::nonsense) {
    std::string bytes(luck_() % 60, '\0');
    for (char& one : bytes) one = static_cast<char>(luck_());
    agent.from_it.push_front(std::move(bytes));
  }
}

void ScriptedNetwork::look_at_the_clock() {
  const auto now = Clock::now();
  for (Agent& agent : agents_) {
    if (agent.dark && agent.fate.what == FateWhat::comes_back && seconds_between(agent.since, now) > agent.fate.absence)
      agent.dark = false;
    if (agent.dark || agent.home || seconds_between(agent.spoke, now) < alive_every_) continue;
    agent.spoke = now;
    agent.from_it.push_back(to_bytes(Message{}));
  }
}

ScriptedNetwork::Left ScriptedNetwork::left() {
  const std::lock_guard guard(mutex_);
  Left left;
  for (Agent& agent : agents_) {
    if (agent.fate.what != FateWhat::stays) continue;
    for (; !agent.to_it.empty(); agent.to_it.pop_front()) hear(agent, agent.to_it.front());
    left.workers += static_cast<int>(agent.workers.size());
    left.home += agent.home ? 1 : 0;
  }
  return left;
}

}  // namespace ricochet::tests
