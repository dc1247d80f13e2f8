#pragma once
#include <optional>
#include <string>

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

}  // namespace ricochet
