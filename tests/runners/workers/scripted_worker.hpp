#pragma once
#include <array>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "runners/workers/worker_messages.hpp"

/// \file
/// Workers that say what a worker says, and compute nothing.
namespace ricochet::tests {

/// What all scripts of one run share: what workers call themselves, and which of their units of work end them once.
struct ScriptedWorld {
  std::string identity, arithmetic;
  double crashes = 0;  ///< share of the units whose first attempt ends its worker

  /// Where this attempt at a unit ends its worker.
  enum class Ends { never, at_its_beginning, at_its_middle, at_its_end };
  Ends ends(const std::string& unit) {
    const std::lock_guard guard(mutex);
    if (!begun.insert(unit).second || !std::bernoulli_distribution(crashes)(luck)) return Ends::never;
    return std::array{Ends::at_its_beginning, Ends::at_its_middle, Ends::at_its_end}[luck() % 3];
  }

  std::mutex mutex;
  std::mt19937 luck;
  std::set<std::string> begun;
};

/// The row that a scripted worker makes of a case: everything that its blocks and what is shared gave it.
CaseRecord scripted_row(const std::string& id);

/// Runs cases that look for something shared, and keep it where it is missing. They have three blocks marched at one
/// time and a fourth that begins where these ended. Then they show what they have, and end. A block that is lost is
/// begun once more. It speaks when it is spoken to.
class ScriptedWorker : public Worker {
 public:
  explicit ScriptedWorker(ScriptedWorld& world) : world_(world) {}
  bool send(const Message& message) override;
  Channel::Heard receive(Message& message, double seconds) override;
  void kill() override;
  WorkerEnd end() override;
  bool ended();

 private:
  void hear(const Message& message);
  void begin_case(const Message& order);
  void begin_block(const std::string& order);
  void hear_block(const Message& message);
  void march(const Message& order);
  void end_with(const std::string& cause);
  void say(Message::Word word, std::string content, std::uint32_t about);

  ScriptedWorld& world_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Message> said_;
  std::string end_;  ///< its cause; "" while it lives
  // The case under way.
  std::string id_;  ///< "" where there is none
  ScriptedWorld::Ends ends_ = ScriptedWorld::Ends::never;
  std::uint32_t order_ = 0, asked_ = 0;
  std::map<std::uint32_t, std::string> questions_;  ///< about → "find" or "keep"
  std::map<std::uint32_t, std::string> blocks_;     ///< about → order of the block
  std::set<std::string> lost_;                      ///< orders of blocks that were
  std::map<std::string, std::string> parts_;        ///< order of the block → its answer
};

}  // namespace ricochet::tests
