#include "runners/execution/case_watch.hpp"

#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <array>
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

struct Slot {
  pthread_t thread{};
  clockid_t clock{};
  const PluginCall* call = nullptr;  // found beforehand: a handler may not be the first to ask for a thread's variable
  TicketPointer ticket, outermost;
  unsigned asked = 0;
  std::atomic<unsigned> answered{0};
  unsigned long long serial = 0;
  FixedText<32> role, function;
  FixedText<256> name;
  FixedText<1024> file;
};

std::mutex slots_mutex;
std::list<Slot>& slots() {
  static std::list<Slot>* const all = new std::list<Slot>;  // threads given up may outlive everything else
  return *all;
}
constinit thread_local Slot* my_slot = nullptr;
constinit thread_local const CaseTicket* my_ticket = nullptr;

extern "C" void answer(int) {
  Slot* const slot = my_slot;
  if (!slot) return;
  const PluginCall call = *slot->call;
  slot->serial = call.plugin ? call.serial : 0;
  if (call.plugin) {
    slot->role.set(call.plugin->role.c_str());
    slot->name.set(call.plugin->name.c_str());
    slot->file.set(call.plugin->file.c_str());
    slot->function.set(call.function);
  }
  slot->answered.fetch_add(1, std::memory_order_release);
}

void listen_to_questions() {
  static const bool once = [] {
    struct sigaction action {};
    action.sa_handler = answer;
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
  ::pthread_getcpuclockid(slot.thread, &slot.clock);
  slot.call = &current_plugin_call();
  my_slot = &slot;
}

void leave_thread() {
  const std::lock_guard guard(slots_mutex);
  Slot* const slot = std::exchange(my_slot, nullptr);
  slots().remove_if([&](const Slot& one) { return &one == slot; });
}

double seconds_of(clockid_t clock) {
  timespec now{};
  return ::clock_gettime(clock, &now) == 0 ? static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec)
                                           : 0;
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
  const auto answered = [](const Slot& slot) { return slot.answered.load(std::memory_order_acquire) == slot.asked; };
  for (Slot& slot : slots())
    // One that still owes an answer is not asked again: it may be writing it.
    if (slot.ticket && answered(slot)) {
      ++slot.asked;
      ::pthread_kill(slot.thread, kAsk);
    }
  const auto give_up = steady_clock::now() + std::chrono::milliseconds(50);
  while (!std::all_of(slots().begin(), slots().end(), answered) && steady_clock::now() < give_up)
    std::this_thread::sleep_for(std::chrono::microseconds(200));
  std::vector<SeenThread> seen;
  for (const Slot& slot : slots()) {
    if (!slot.ticket || !answered(slot)) continue;
    SeenThread& one = seen.emplace_back();
    one.thread = slot.thread;
    one.ticket = slot.ticket;
    one.outermost = slot.outermost;
    one.processor_seconds = seconds_of(slot.clock);
    one.serial = slot.serial;
    if (slot.serial == 0) continue;
    const PluginIdentity plugin{slot.role.text.data(), slot.name.text.data(), slot.file.text.data()};
    one.role = plugin.role;
    one.plugin = plugin.text();
    one.function = slot.function.text.data();
  }
  return seen;
}

}  // namespace ricochet
