#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "runners/workers/worker.hpp"

namespace ricochet {

/// Carries bytes between the processes of a run on several machines, numbered 0 … size − 1 (its ranks): whole, and in
/// order between any two of them. A rank may vanish without a word.
class Transport {
 public:
  struct Packet {
    int from = 0;
    std::string bytes;
  };

  virtual ~Transport() = default;
  virtual int rank() const = 0;
  virtual int size() const = 0;
  /// Does not wait for the other side. May be called from any thread.
  virtual void send(int to, std::string bytes) = 0;
  /// The next packet, from whomever; nothing where none came for so long. From one thread.
  virtual std::optional<Packet> receive(double seconds) = 0;
};

// What the coordinator (rank 0) and the agents of the other machines send each other, as bytes of this kind of
// machine.

/// The machine of an agent, told once, before anything else.
struct HostFacts {
  std::string name;
  int rank = 0;
  int processors = 1, online = 1;   ///< that it may keep busy, and that the machine has
  std::string limit;                ///< what allows fewer, "" where nothing does
  double memory = 0;                ///< bytes free; 0: nobody says
  std::string program, arithmetic;  ///< hash and digest
  std::string failure;              ///< why it cannot serve; "" where it can
};

std::string to_bytes(const Message& message);
std::string to_bytes(const HostFacts& facts);
std::string to_bytes(const WorkerEnd& end);
/// Throw std::runtime_error for other bytes. What a Message carries is not looked at.
Message host_message(const std::string& bytes);
HostFacts host_facts(const std::string& bytes);
WorkerEnd worker_end(const std::string& bytes);

}  // namespace ricochet
