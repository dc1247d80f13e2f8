#pragma once
#include <pthread.h>

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

/// \file
/// Which case each thread works for, and what it asks of a plugin at this moment: for the messages of a crash, and for
/// the thread that watches over calls that never return.
namespace ricochet {

/// A case under way. Once given up, whatever still runs for it never touches the store again.
class CaseTicket {
 public:
  /// `fingerprint` tells whether the case is still the same in a later run; `budget` in s, infinite without one.
  CaseTicket(std::string case_id, std::string case_fingerprint, double seconds)
      : id(std::move(case_id)), fingerprint(std::move(case_fingerprint)), budget(seconds) {}
  const std::string id, fingerprint;
  const double budget;

  /// Takes the case away from its threads. False, and nothing changes, while one of them uses the store, and once it is
  /// closed.
  bool give_up();
  /// The case has come back and is about to be recorded: it can no longer be given up. Only in its turn at the store.
  void close() { closed_ = true; }
  bool closed() const { return closed_; }
  bool given_up() const { return given_up_; }
  /// The case's turn at the store, for as long as the lock lives. For a case that was given up it never comes: the
  /// thread stays here until the program ends.
  std::unique_lock<std::mutex> turn();

 private:
  std::mutex store_;
  std::atomic<bool> given_up_{false}, closed_{false};
};
using TicketPointer = std::shared_ptr<CaseTicket>;

/// This thread works for a case as long as the scope lives; scopes nest. The thread gets a stack of its own for signal
/// handlers, so that an overflow of its stack can be told.
class CaseScope {
 public:
  explicit CaseScope(TicketPointer ticket);
  ~CaseScope();
  CaseScope(const CaseScope&) = delete;
  CaseScope& operator=(const CaseScope&) = delete;

 private:
  TicketPointer before_;
  bool first_ = false;
};

/// The case that this thread works for; null for none. To be handed to threads that help it.
TicketPointer current_ticket();
/// The same, for signal handlers.
const CaseTicket* ticket_in_handler();
/// The turn at the store of the case that this thread works for; an empty lock without a case.
std::unique_lock<std::mutex> store_turn();

/// A thread that works for a case, as it was found at one moment.
struct SeenThread {
  pthread_t thread{};
  TicketPointer ticket, outermost;  ///< of the innermost scope, and of the one that the thread entered first
  double processor_seconds = 0;
  unsigned long long serial = 0;       ///< of its call; 0: it is in no plugin's function
  std::string role, plugin, function;  ///< "contact", "contact 'x' (file)", "solve"
};

/// Asks every thread that works for a case. What a thread said last stands until it answers again.
std::vector<SeenThread> look_at_threads();

}  // namespace ricochet
