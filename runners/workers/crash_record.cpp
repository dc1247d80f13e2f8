#include "runners/workers/crash_record.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <ricochet/contract/plugin_call.hpp>
#include <sstream>
#include <thread>

#include "runners/march/seconds.hpp"

namespace ricochet {

std::optional<CrashRecord> parse_crash_record(const std::string& text) {
  std::istringstream stream(text);
  CrashRecord record;
  for (std::string line; std::getline(stream, line);) {
    const std::size_t at = line.find('\t');
    if (at == std::string::npos) continue;
    const std::string key = line.substr(0, at), value = line.substr(at + 1);
    if (key == "plugin") record.plugin = value;
    if (key == "function") record.function = value;
    if (key == "ended") record.ended = value;
  }
  // "ended" comes last: a record without it was cut short.
  if (record.ended.empty()) return std::nullopt;
  return record;
}

namespace {

struct Ending {
  int signal;
  const char* text;
};
constexpr std::array<Ending, 5> kEndings = {{{SIGSEGV, "signal 11 (segmentation fault)"},
                                             {SIGBUS, "signal 7 (bus error)"},
                                             {SIGFPE, "signal 8 (arithmetic exception)"},
                                             {SIGILL, "signal 4 (illegal instruction)"},
                                             {SIGABRT, "signal 6 (abort)"}}};
static_assert(SIGSEGV == 11 && SIGBUS == 7 && SIGFPE == 8 && SIGILL == 4 && SIGABRT == 6);
constexpr int kSomeFailed = 3;

// Everything below is read by signal handlers: nothing allocates, locks or has a destructor.
std::array<struct sigaction, kEndings.size()> former;
std::array<char, 4096> record_file{};
std::atomic<bool> armed{false}, taken{false};

// Text put together and written without the heap.
class Line {
 public:
  Line& operator<<(const char* text) {
    while (text && *text != '\0' && length_ < text_.size()) text_[length_++] = *text++;
    return *this;
  }
  void write_to(int descriptor) const {
    std::size_t done = 0;
    while (done < length_) {
      const ssize_t written = ::write(descriptor, text_.data() + done, length_ - done);
      if (written <= 0) return;
      done += static_cast<std::size_t>(written);
    }
  }

 private:
  std::array<char, 3072> text_{};
  std::size_t length_ = 0;
};

Line& operator<<(Line& line, const PluginIdentity& plugin) {
  line << plugin.role.c_str() << " '" << plugin.name.c_str() << "'";
  return plugin.file.empty() ? line : line << " (" << plugin.file.c_str() << ")";
}

void ended_by(const char* ended) {
  const PluginCall call = current_plugin_call();
  const int descriptor = ::open(record_file.data(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor < 0) return;
  Line content;
  if (call.plugin) {
    content << "plugin\t" << *call.plugin;
    content << "\nfunction\t" << call.function << "\n";
  }
  content << "ended\t" << ended << "\n";
  content.write_to(descriptor);
  ::close(descriptor);
}

extern "C" void on_crash(int signal) {
  if (taken.exchange(true))
    for (;;) ::pause();  // another thread is saying what happened, and ends the program
  for (std::size_t i = 0; i < kEndings.size(); ++i) {
    ::sigaction(kEndings[i].signal, &former[i], nullptr);
    if (kEndings[i].signal == signal) ended_by(kEndings[i].text);
  }
  ::raise(signal);  // held back until this handler returns
}

// exit() runs this in the thread that called it.
extern "C" void on_exit_called() {
  if (!armed || !current_plugin_call().plugin || taken.exchange(true)) return;
  ended_by("a call of exit()");
  ::_exit(kSomeFailed);
}

void watch_exits() {
  static const bool once = std::atexit(on_exit_called) == 0 && std::at_quick_exit(on_exit_called) == 0;
  static_cast<void>(once);
}

}  // namespace

CrashGuard::CrashGuard(const std::filesystem::path& file) {
  const std::string name = file.string();
  record_file.fill('\0');
  std::memcpy(record_file.data(), name.data(), std::min(name.size(), record_file.size() - 1));
  current_plugin_call();  // this thread's copy exists before a handler asks for it
  watch_exits();
  taken = false;
  for (std::size_t i = 0; i < kEndings.size(); ++i) {
    struct sigaction action {};
    action.sa_handler = on_crash;
    action.sa_flags = SA_ONSTACK;
    ::sigaction(kEndings[i].signal, &action, &former[i]);
  }
  armed = true;
}

CrashGuard::~CrashGuard() {
  armed = false;
  for (std::size_t i = 0; i < kEndings.size(); ++i) ::sigaction(kEndings[i].signal, &former[i], nullptr);
}

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
