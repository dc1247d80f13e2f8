#include "runners/workers/call_watch.hpp"

#include <fmt/format.h>
#include <signal.h>

#include <algorithm>
#include <cerrno>
#include <ctime>
#include <ricochet/contract/plugin_call.hpp>
#include <thread>

#include "runners/march/seconds.hpp"

namespace ricochet {
namespace {

// Ignored by default, and used by nothing else here.
constexpr int ask_signal = SIGURG;
constexpr double asleep_share = 0.1;  // of the time that passes counts for a thread that only waits
constexpr std::size_t handler_stack = 65536;

// What a signal handler may do to copy a text.
void copy(const char* from, char* to, std::size_t size) {
  std::size_t length = 0;
  for (; from && from[length] != '\0' && length + 1 < size; ++length) to[length] = from[length];
  to[length] = '\0';
}

}  // namespace

// What the thread says of itself, all of one moment; its own while it owes an answer.
struct CallWatch::Answer {
  const PluginCall* call = nullptr;  // found beforehand: a handler may not be the first to ask for it
  std::atomic<unsigned> asked{0}, answered{0};
  unsigned long long serial = 0;
  double processor_seconds = 0;
  char role[32] = {}, function[32] = {}, name[256] = {}, file[1024] = {};
};

void CallWatch::on_question(int) {
  const int error = errno;
  Answer* const answer = asked_.load(std::memory_order_acquire);
  // A signal from another process is no question.
  if (!answer || answer->asked.load(std::memory_order_acquire) == answer->answered.load(std::memory_order_relaxed))
    return;
  const PluginCall call = *answer->call;
  timespec now{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  answer->processor_seconds = static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
  answer->serial = call.plugin ? call.serial : 0;
  if (call.plugin) {
    copy(call.plugin->role.c_str(), answer->role, sizeof answer->role);
    copy(call.plugin->name.c_str(), answer->name, sizeof answer->name);
    copy(call.plugin->file.c_str(), answer->file, sizeof answer->file);
    copy(call.function, answer->function, sizeof answer->function);
  }
  answer->answered.fetch_add(1, std::memory_order_release);
  errno = error;
}

CallWatch::CallWatch() : answer_(std::make_unique<Answer>()), thread_(::pthread_self()) {
  answer_->call = &current_plugin_call();
  asked_ = answer_.get();
  struct sigaction action {};
  action.sa_handler = on_question;
  action.sa_flags = SA_RESTART | SA_ONSTACK;
  ::sigaction(ask_signal, &action, nullptr);
}

CallWatch::~CallWatch() {
  asked_ = nullptr;
}

bool CallWatch::answered() const {
  return answer_->answered.load(std::memory_order_acquire) == answer_->asked.load(std::memory_order_relaxed);
}

void CallWatch::note_answer() {
  processor_ = answer_->processor_seconds;
  if (answer_->serial == serial_) return;
  serial_ = answer_->serial;
  const PluginIdentity plugin{answer_->role, answer_->name, answer_->file};
  call_ = {.role = plugin.role, .plugin = plugin.text(), .function = answer_->function};
  seen_ = std::chrono::steady_clock::now();
  processor_then_ = processor_;
}

std::optional<LongCall> CallWatch::overdue() {
  using std::chrono::steady_clock;
  // A thread that still owes an answer is not asked again: it may be writing it.
  if (answered()) {
    answer_->asked.fetch_add(1, std::memory_order_release);
    ::pthread_kill(thread_, ask_signal);
  }
  const auto late = steady_clock::now() + std::chrono::milliseconds(50);
  while (!answered() && steady_clock::now() < late) std::this_thread::sleep_for(std::chrono::microseconds(200));
  if (answered()) note_answer();
  if (serial_ == 0) return std::nullopt;
  LongCall call = call_;
  call.seconds = seconds_since(seen_);
  call.counted_seconds = std::max(processor_ - processor_then_, asleep_share * call.seconds);
  return call;
}

std::string LongCall::text() const {
  return fmt::format("plugin {}, {}() has not returned for {:.0f} s", plugin, function, seconds);
}

HandlerStack::HandlerStack() {
  stack_t present{};
  if (::sigaltstack(nullptr, &present) != 0 || (present.ss_flags & SS_DISABLE) == 0) return;
  memory_ = std::make_unique<char[]>(handler_stack);
  stack_t mine{};
  mine.ss_sp = memory_.get();
  mine.ss_size = handler_stack;
  ::sigaltstack(&mine, nullptr);
}

HandlerStack::~HandlerStack() {
  if (!memory_) return;
  stack_t none{};
  none.ss_flags = SS_DISABLE;
  ::sigaltstack(&none, nullptr);
}

}  // namespace ricochet
