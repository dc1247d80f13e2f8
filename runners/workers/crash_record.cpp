#include "runners/workers/crash_record.hpp"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdlib>
#include <cstring>
#include <ricochet/contract/plugin_call.hpp>
#include <sstream>

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

}  // namespace ricochet
