#pragma once
#include <cstdint>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <vector>

#include "runners/march/case_context.hpp"
#include "runners/store/record.hpp"

namespace ricochet {

/// Each side of a run says that it is alive so often, and takes the other for lost after such a silence, s.
constexpr double alive_every = 1, lost_after = 60;

/// What one process says to another: a word, and bytes whose meaning belongs to it. Between machines it also says which
/// worker it is for, or from.
struct Message {
  enum class Word : char {
    // to a worker
    study = 'S',   ///< WorkerStudy: opens it; answered by `ready`
    plan = 'p',    ///< cases: predicts their cost; each answered by `planned`, in order
    run = 'r',     ///< cases: each answered by `ran`, in order
    time = 't',    ///< cases: each answered by `timed`, in order
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
    // between the coordinator and the agent of a machine, about it or one of its workers
    facts = 'F',  ///< agent: HostFacts
    start = 's',  ///< coordinator: starts the worker of that number
    kill = 'K',   ///< coordinator
    ended = 'e',  ///< agent: WorkerEnd
    leave = 'l',  ///< coordinator: ends the agent; its last word to it
    gone = 'g',   ///< agent: it has heard so, and its workers are no more; its last word
  };
  Word word = Word::alive;
  std::string content = {};
  std::uint32_t about = 0;   ///< which question it asks or answers; those of one side differ
  std::uint32_t worker = 0;  ///< of an agent's machine; 0: none of them. Left out between a worker and its machine
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

// What coordinator and worker send each other, as bytes of this machine: both are the same program.

/// What a worker opens before anything else.
struct WorkerStudy {
  std::string study;                 ///< resolved, as JSON
  std::vector<std::string> plugins;  ///< libraries beside the program's own
  double memory = 0;                 ///< bytes of address space that it may take; 0: no limit
  int width = 1;                     ///< blocks that are marched at one time, by all workers together
  std::string arithmetic;            ///< digest of the coordinator's
};

/// That it did, and with what: equal for equal programs, plugins and studies.
struct WorkerReady {
  std::string identity, arithmetic;
  std::string failure, pointer;  ///< why it could not, and where in the study; "" where it could
};

/// One case to be planned, run or timed.
struct CaseOrder {
  std::string id;
  double budget = 0;  ///< s that a call of a plugin's function may last
  int share = 1;      ///< see BlockService
};

/// A block of a case, to be marched by another worker than the one that runs the case.
struct BlockRequest {
  std::string id, order;
  double budget = 0;  ///< s that a call of a plugin's function may last; set by the coordinator
};

/// What became of it: a value, or what was thrown.
struct CaseAnswer {
  CaseRecord record;           ///< of a run, without axes
  double seconds = 0;          ///< predicted or timed
  double processor = 0;        ///< s that the timing took in all
  bool found = false;          ///< whether there is a time
  std::string error, pointer;  ///< of an exception; `record` is then empty
};

/// A call of a plugin's function that did not return.
struct GivenUp {
  std::string plugin, function;
  double budget = 0;
};

/// A key of the store with what is to be kept there; or a question, without.
struct ShelfMessage {
  std::string key, content;
};

std::string to_bytes(const WorkerStudy& message);
std::string to_bytes(const WorkerReady& message);
std::string to_bytes(const std::vector<CaseOrder>& message);
std::string to_bytes(const BlockRequest& message);
std::string to_bytes(const BlockStatus& message);
std::string to_bytes(const CaseAnswer& message);
std::string to_bytes(const GivenUp& message);
std::string to_bytes(const ShelfMessage& message);
std::string to_bytes(const CaseRecord& record);

/// Bytes that are no message: whoever sent them is not to be believed any more.
class NoMessage : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The message that these bytes are. Throws NoMessage for others.
template <class T>
T message_from(const std::string& bytes);
extern template WorkerStudy message_from(const std::string&);
extern template WorkerReady message_from(const std::string&);
extern template std::vector<CaseOrder> message_from(const std::string&);
extern template BlockRequest message_from(const std::string&);
extern template BlockStatus message_from(const std::string&);
extern template CaseAnswer message_from(const std::string&);
extern template GivenUp message_from(const std::string&);
extern template ShelfMessage message_from(const std::string&);
extern template CaseRecord message_from(const std::string&);

/// How a worker ended.
struct WorkerEnd {
  std::string cause = {};       ///< "signal 11 (segmentation fault)", "exit code 7"
  std::string place = {};       ///< of a plugin's function, SeenCall::place()
  bool in_call = false;         ///< it was under way, not the last one before
  std::string last_lines = {};  ///< of its stderr, "|" between two
  bool no_memory = false;       ///< it wanted more memory than it may take
  bool silent = false;          ///< it said nothing for too long, and was killed for that
  bool stopped = false;         ///< a signal had stopped it in a plugin's function
  bool host_lost = false;       ///< the machine it was on is gone: no fault of its own

  /// "plugin contact 'x' (x.so), solve(): its process was ended by signal 11 (segmentation fault); it wrote: …". Where
  /// no function was under way the third-party libraries of the study are named.
  /// `times`: put behind the verb, "twice".
  std::string sentence(const std::string& times = "") const;
  /// Whether a function of a third-party library was under way.
  bool in_third_party() const;
};

/// A process that marches, here or on another machine. One thread talks to it; kill() may come from another one.
class Worker {
 public:
  virtual ~Worker() = default;
  /// False where it is gone.
  virtual bool send(const Message& message) = 0;
  /// Its next message.
  virtual Channel::Heard receive(Message& message, double seconds) = 0;
  virtual void kill() = 0;
  /// Whether a signal stopped its process in a plugin's function, as far as this machine can see.
  virtual bool stopped() { return false; }
  /// Waits until it has ended. Once.
  virtual WorkerEnd end() = 0;
};

/// A machine on which workers can be started. May be used from any thread.
class WorkerHost {
 public:
  virtual ~WorkerHost() = default;
  virtual std::string name() const = 0;
  /// Workers that it may keep busy at one time.
  virtual int width() const = 0;
  /// Bytes of address space for each of them; 0: no limit.
  virtual double memory() const = 0;
  /// Whether workers can still be started there.
  virtual bool there() const = 0;
  /// Throws RunError where no process can be had.
  virtual std::unique_ptr<Worker> start() = 0;
};

}  // namespace ricochet
