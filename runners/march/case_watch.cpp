#include "runners/march/case_watch.hpp"

#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <ctime>
#include <list>
#include <ricochet/contract/plugin_call.hpp>
#include <thread>
#include <utility>

namespace ricochet {
namespace {

// Ignored by default, and used by nothing here: a late one harms nobody.
constexpr int kAsk = SIGURG;

// Text that a signal handler may write.
template <std::size_t size>
struct FixedText {
  std::array<char, size> text{};
  void set(const char* from) {
    std::size_t length = 0;
    for (; from && from[length] != '\0' && length + 1 < size; ++length) text[length] = from[length];
    text[length] = '\0';
  }
};

// What a thread says of itself, all of one moment.
struct Answer {
  const CaseTicket* ticket = nullptr;
  double processor_seconds = 0;
  unsigned long long serial = 0;
  FixedText<32> role, function;
  FixedText<256> name;
  FixedText<1024> file;
};

struct Slot {
  pthread_t thread{};
  const PluginCall* call = nullptr;  // found beforehand: a handler may not be the first to ask for a thread's variable
  TicketPointer ticket, outermost;
  std::atomic<unsigned> asked{0}, answered{0};
  Answer answer;    // the thread's own while it owes one
  SeenThread last;  // and what is known of it
  bool known = false;
};

std::mutex slots_mutex;
std::list<Slot>& slots() {
  static std::list<Slot>* const all = new std::list<Slot>;  // threads given up may outlive everything else
  return *all;
}
constinit thread_local Slot* my_slot = nullptr;
constinit thread_local const CaseTicket* my_ticket = nullptr;

extern "C" void on_question(int) {
  Slot* const slot = my_slot;
  // A signal that a stranger sends is no question.
  if (!slot || slot->asked.load(std::memory_order_acquire) == slot->answered.load(std::memory_order_relaxed)) return;
  const int error = errno;
  const PluginCall call = *slot->call;
  Answer& answer = slot->answer;
  answer.ticket = my_ticket;
  timespec now{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  answer.processor_seconds = static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
  answer.serial = call.plugin ? call.serial : 0;
  if (call.plugin) {
    answer.role.set(call.plugin->role.c_str());
    answer.name.set(call.plugin->name.c_str());
    answer.file.set(call.plugin->file.c_str());
    answer.function.set(call.function);
  }
  slot->answered.fetch_add(1, std::memory_order_release);
  errno = error;
}

void listen_to_questions() {
  static const bool once = [] {
    struct sigaction action {};
    action.sa_handler = on_question;
    action.sa_flags = SA_RESTART | SA_ONSTACK;
    return ::sigaction(kAsk, &action, nullptr) == 0;
  }();
  static_cast<void>(once);
}

/// Room for signal handlers where the thread's own stack has run out.
class HandlerStack {
 public:
  HandlerStack() {
    stack_t present{};
    if (::sigaltstack(nullptr, &present) != 0 || (present.ss_flags & SS_DISABLE) == 0) return;
    memory_ = std::make_unique<char[]>(size);
    stack_t mine{};
    mine.ss_sp = memory_.get();
    mine.ss_size = size;
    ::sigaltstack(&mine, nullptr);
  }
  ~HandlerStack() {
    if (!memory_) return;
    stack_t none{};
    none.ss_flags = SS_DISABLE;
    ::sigaltstack(&none, nullptr);
  }
  HandlerStack(const HandlerStack&) = delete;
  HandlerStack& operator=(const HandlerStack&) = delete;

 private:
  static constexpr std::size_t size = 65536;
  std::unique_ptr<char[]> memory_;
};

void enter_thread() {
  static thread_local HandlerStack stack;
  const std::lock_guard guard(slots_mutex);
  Slot& slot = slots().emplace_back();
  slot.thread = ::pthread_self();
  slot.call = &current_plugin_call();
  my_slot = &slot;
}

void leave_thread() {
  const std::lock_guard guard(slots_mutex);
  Slot* const slot = std::exchange(my_slot, nullptr);
  slots().remove_if([&](const Slot& one) { return &one == slot; });
}

bool answered(const Slot& slot) {
  return slot.answered.load(std::memory_order_acquire) == slot.asked.load(std::memory_order_relaxed);
}

// Takes note of an answer; what was said in an earlier case is none.
void note_answer(Slot& slot) {
  const Answer& said = slot.answer;
  slot.known = slot.asked > 0 && slot.ticket && said.ticket == slot.ticket.get();
  if (!slot.known) return;
  SeenThread& seen = slot.last = SeenThread{};
  seen.thread = slot.thread;
  seen.ticket = slot.ticket;
  seen.outermost = slot.outermost;
  seen.processor_seconds = said.processor_seconds;
  seen.serial = said.serial;
  if (said.serial == 0) return;
  const PluginIdentity plugin{said.role.text.data(), said.name.text.data(), said.file.text.data()};
  seen.role = plugin.role;
  seen.plugin = plugin.text();
  seen.function = said.function.text.data();
}

}  // namespace

bool CaseTicket::give_up() {
  const std::unique_lock lock(store_, std::try_to_lock);
  if (!lock || closed_) return false;
  given_up_ = true;
  return true;
}

std::unique_lock<std::mutex> CaseTicket::turn() {
  std::unique_lock lock(store_);
  while (given_up_) {
    lock.unlock();
    ::pause();
    lock.lock();
  }
  return lock;
}

CaseScope::CaseScope(TicketPointer ticket) {
  first_ = my_slot == nullptr;
  if (first_) enter_thread();
  const std::lock_guard guard(slots_mutex);
  my_ticket = ticket.get();
  if (first_) my_slot->outermost = ticket;
  before_ = std::exchange(my_slot->ticket, std::move(ticket));
}

CaseScope::~CaseScope() {
  {
    const std::lock_guard guard(slots_mutex);
    my_ticket = before_.get();
    my_slot->ticket = std::move(before_);
  }
  if (first_) leave_thread();
}

TicketPointer current_ticket() {
  return my_slot ? my_slot->ticket : nullptr;  // only this thread changes it
}

const CaseTicket* ticket_in_handler() {
  return my_ticket;
}

std::unique_lock<std::mutex> store_turn() {
  const TicketPointer ticket = current_ticket();
  return ticket ? ticket->turn() : std::unique_lock<std::mutex>();
}

std::vector<SeenThread> look_at_threads() {
  using std::chrono::steady_clock;
  listen_to_questions();
  const std::lock_guard guard(slots_mutex);
  for (Slot& slot : slots())
    // One that still owes an answer is not asked again: it may be writing it. Its last one stands, on a machine that is
    // so loaded that a thread does not come to its turn.
    if (slot.ticket && answered(slot)) {
      note_answer(slot);
      slot.asked.fetch_add(1, std::memory_order_release);
      ::pthread_kill(slot.thread, kAsk);
    }
  const auto late = steady_clock::now() + std::chrono::milliseconds(50);
  while (!std::all_of(slots().begin(), slots().end(), answered) && steady_clock::now() < late)
    std::this_thread::sleep_for(std::chrono::microseconds(200));
  std::vector<SeenThread> seen;
  for (Slot& slot : slots()) {
    if (!slot.ticket) continue;
    if (answered(slot)) note_answer(slot);
    if (slot.known && slot.last.ticket == slot.ticket) seen.push_back(slot.last);
  }
  return seen;
}

}  // namespace ricochet
