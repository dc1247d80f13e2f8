#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cctype>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <ricochet/loader/child.hpp>
#include <stdexcept>

namespace ricochet {
namespace {

using Clock = std::chrono::steady_clock;

// What the child sends: a tag, then text up to the end; for `call` role, name, file and function, each with its '\0'.
constexpr char tag_value = 'v', tag_exception = 'e', tag_call = 'c';

int pipe_end = -1;  // of the child
alignas(16) char handler_stack[64 * 1024];

// Safe in a signal handler.
bool send(const char* data, std::size_t size) {
  while (size > 0) {
    const ssize_t written = ::write(pipe_end, data, size);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    data += written;
    size -= static_cast<std::size_t>(written);
  }
  return true;
}
void send_with_end(const char* text) {
  send(text, std::strlen(text) + 1);
}

void send_call() {
  const PluginCall& call = current_plugin_call();
  if (!call.plugin) return;
  send(&tag_call, 1);
  send_with_end(call.plugin->role.c_str());
  send_with_end(call.plugin->name.c_str());
  send_with_end(call.plugin->file.c_str());
  send_with_end(call.function);
}

// The handler is reset on entry: raised again, the signal ends the child as it would have.
extern "C" void ricochet_child_signal(int signal) {
  send_call();
  ::raise(signal);
}
// Before all handlers of the parent: what it would tidy up at its end is not this child's.
extern "C" void ricochet_child_exit(int code, void*) {
  send_call();
  ::_exit(code);
}

void catch_signals() {
  stack_t stack = {};
  stack.ss_sp = handler_stack;
  stack.ss_size = sizeof handler_stack;
  ::sigaltstack(&stack, nullptr);
  struct sigaction action = {};
  action.sa_handler = ricochet_child_signal;
  action.sa_flags = static_cast<int>(SA_RESETHAND | SA_ONSTACK | SA_NODEFER);
  ::sigemptyset(&action.sa_mask);
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGALRM}) ::sigaction(signal, &action, nullptr);
  for (const int signal : {SIGINT, SIGTERM, SIGPIPE}) ::signal(signal, SIG_DFL);
  sigset_t none;
  ::sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
}

[[noreturn]] void be_the_child(const std::function<std::string()>& work, int write_end) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  const rlimit no_core = {0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
  if (const int nowhere = ::open("/dev/null", O_RDWR | O_CLOEXEC); nowhere >= 0)
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) ::dup2(nowhere, stream);
  pipe_end = write_end;
  catch_signals();
  ::on_exit(ricochet_child_exit, nullptr);
  char tag = tag_value;
  std::string text;
  try {
    text = work();
  } catch (const std::exception& error) {
    tag = tag_exception;
    text = error.what();
  } catch (...) {
    tag = tag_exception;
    text = "an exception that says nothing";
  }
  ::_exit(send(&tag, 1) && send(text.data(), text.size()) ? 0 : 1);
}

/// The parent's view: what came through the pipe so far, and whether the child has ended.
class Watch {
 public:
  Watch(pid_t child, int pipe) : child_(child), pipe_(pipe) { ::fcntl(pipe, F_SETFL, O_NONBLOCK); }

  /// Reads until the child has ended; false when the limit came first. The pipe alone does not tell: another child that
  /// was begun meanwhile may hold it open.
  bool until(Clock::time_point limit) {
    constexpr int beat = 10;  // ms
    for (; !ended_; drain()) {
      if (Clock::now() >= limit) return false;
      pollfd wait = {pipe_, POLLIN, 0};
      if (open_)
        ::poll(&wait, 1, beat);
      else
        ::usleep(1000);
      const pid_t found = ::waitpid(child_, &status_, WNOHANG);
      ended_ = found == child_ || (found < 0 && errno != EINTR);
    }
    return true;
  }
  void kill() {
    ::kill(child_, SIGKILL);
    while (::waitpid(child_, &status_, 0) < 0 && errno == EINTR) {
    }
    drain();
  }
  const std::string& message() const { return message_; }
  int status() const { return status_; }

 private:
  void drain() {
    char part[4096];
    for (;;) {
      const ssize_t size = ::read(pipe_, part, sizeof part);
      if (size > 0) {
        message_.append(part, static_cast<std::size_t>(size));
        continue;
      }
      if (size < 0 && errno == EINTR) continue;
      if (size == 0) open_ = false;
      return;
    }
  }
  pid_t child_;
  int pipe_, status_ = 0;
  bool ended_ = false, open_ = true;
  std::string message_;
};

void read_call(const std::string& message, ChildOutcome& outcome) {
  std::string* const fields[] = {&outcome.plugin.role, &outcome.plugin.name, &outcome.plugin.file, &outcome.function};
  std::size_t at = 1;
  for (std::string* field : fields) {
    const std::size_t end = std::min(message.find('\0', at), message.size());
    *field = message.substr(std::min(at, end), end - std::min(at, end));
    at = end + 1;
  }
}

std::string signal_text(int signal) {
  const char* known = ::strsignal(signal);
  std::string text = known ? known : "unknown";
  text[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(text[0])));
  return text;
}

}  // namespace

std::string ChildOutcome::cause() const {
  switch (end) {
    case End::value:
      return "";
    case End::exception:
      return text;
    case End::signal:
      return fmt::format("ended by signal {} ({})", number, signal_text(number));
    case End::exit:
      return fmt::format("ended the process with exit code {}", number);
    case End::timeout:
      break;
  }
  return fmt::format("did not end within {:g} s", limit);
}

std::string ChildOutcome::sentence() const {
  if (function.empty()) return cause();
  return "plugin " + plugin.text() + ", " + function + "(): " + cause();
}

ChildOutcome run_in_child(const std::function<std::string()>& work, double seconds,
                          const std::function<void()>& waits) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0)
    throw std::runtime_error(fmt::format("no pipe to a child process can be had: {}", std::strerror(errno)));
  // What is buffered is written once, by this process.
  std::cout.flush();
  std::fflush(nullptr);
  const pid_t child = ::fork();
  if (child < 0) {
    const int error = errno;
    ::close(ends[0]);
    ::close(ends[1]);
    throw std::runtime_error(fmt::format("no child process can be had: {}", std::strerror(error)));
  }
  if (child == 0) be_the_child(work, ends[1]);
  ::close(ends[1]);

  const auto from_now = [](double s) {
    return Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(s));
  };
  Watch watch(child, ends[0]);
  constexpr double long_wait = 3;  // s
  const Clock::time_point limit = from_now(seconds);
  bool in_time = waits && seconds > long_wait && watch.until(from_now(long_wait));
  if (!in_time && waits && seconds > long_wait) waits();
  in_time = in_time || watch.until(limit);
  if (!in_time) {
    // First asked what it does, then ended whatever it does.
    constexpr double patience = 3;  // s, which a child that shares its processor may need to answer
    ::kill(child, SIGALRM);
    if (!watch.until(from_now(patience))) watch.kill();
  }
  ::close(ends[0]);
  const std::string& message = watch.message();
  const int status = watch.status();

  ChildOutcome outcome;
  const char tag = message.empty() ? '\0' : message.front();
  if (tag == tag_call) read_call(message, outcome);
  if (!in_time) {
    outcome.end = ChildOutcome::End::timeout;
    outcome.limit = seconds;
  } else if (WIFSIGNALED(status)) {
    outcome.end = ChildOutcome::End::signal;
    outcome.number = WTERMSIG(status);
  } else if (tag == tag_value || tag == tag_exception) {
    outcome.end = tag == tag_value ? ChildOutcome::End::value : ChildOutcome::End::exception;
    outcome.text = message.substr(1);
  } else {
    outcome.end = ChildOutcome::End::exit;
    outcome.number = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  return outcome;
}

}  // namespace ricochet
