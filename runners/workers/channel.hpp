#pragma once
#include <cstdint>
#include <mutex>
#include <string>

namespace ricochet {

/// What one process says to another: a word, and bytes whose meaning belongs to it.
struct Message {
  enum class Word : char {
    // to a worker
    study = 'S',   ///< WorkerStudy: opens it; answered by `ready`
    plan = 'p',    ///< a case: predicts its cost; answered by `planned`
    run = 'r',     ///< a case: answered by `ran`
    time = 't',    ///< a case: answered by `timed`
    block = 'b',   ///< BlockRequest: marches a block of a case; answered by `block_status`
    stop = 'x',    ///< ends what is under way; answered by `interrupted`
    answer = 'a',  ///< to what the worker asked
    // from a worker
    ready = 'R',
    planned = 'P',
    ran = 'D',
    timed = 'T',
    block_status = 'B',  ///< BlockStatus; once or more often, the last one tells what became of it
    interrupted = 'I',
    given_up = 'G',  ///< GivenUp: a call that did not return; the worker ends
    find = 'f',      ///< asks for what the store keeps under a key
    keep = 'k',      ///< asks to keep something there
    show = 'w',      ///< shows a case under way; not answered
    failed = 'q',    ///< asks whether a case has failed
    march = 'm',     ///< BlockRequest: asks to have a block marched; answered by `block_status`
    cancel = 'c',    ///< stops the block of that question; not answered
    alive = '.',     ///< now and then; not answered
  };
  Word word = Word::alive;
  std::string content = {};
  std::uint32_t about = 0;  ///< which question it asks or answers; those of one side differ
};

/// One end of a stream socket that carries messages, whole and in order. Either side may go at any moment.
class Channel {
 public:
  /// Takes the descriptor over.
  explicit Channel(int descriptor) : descriptor_(descriptor) {}
  ~Channel();
  Channel(const Channel&) = delete;
  Channel& operator=(const Channel&) = delete;

  /// False where the other side is gone. May be called from several threads.
  bool send(const Message& message);
  enum class Heard {
    message,
    silence,  ///< nothing came for so long
    gone      ///< the other side, or what came is no message
  };
  /// The next message. From one thread.
  Heard receive(Message& message, double seconds = 1e6);
  int descriptor() const { return descriptor_; }

 private:
  const int descriptor_;
  std::mutex sending_;
};

}  // namespace ricochet
