#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <memory>
#include <new>
#include <ricochet/loader/child.hpp>
#include <system_error>
#include <utility>

namespace ricochet {
namespace {

using Clock = std::chrono::steady_clock;

// What the child sends: a tag, the length of a text, the text; then the tag of what came afterwards.
constexpr char tag_value = 'v', tag_exception = 'e', tag_afterwards = 'a';
constexpr std::size_t head = 1 + sizeof(std::uint64_t);

// Of the child.
constexpr int message_end = 3;
CallNote* shared_note = nullptr;
bool is_afterwards = false;
std::uint64_t memory_allowed = 0;  // beside what the parent had

bool send(const char* data, std::size_t size) {
  while (size > 0) {
    const ssize_t written = ::write(message_end, data, size);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    data += written;
    size -= static_cast<std::size_t>(written);
  }
  return true;
}

// Before all handlers of the parent: what it would tidy up at its end is not this child's. Those of libraries that were
// opened here came before.
extern "C" void ricochet_child_exit(int code, void*) {
  if (is_afterwards) send(&tag_afterwards, 1);
  ::_exit(is_afterwards ? 0 : code);
}

void out_of_memory() {
  shared_note->memory_exceeded = memory_allowed;
  ::_exit(1);
}

void limit_memory(double bytes) {
  if (bytes <= 0) return;
  memory_allowed = static_cast<std::uint64_t>(bytes);
  long pages = 0;
  if (std::FILE* const file = std::fopen("/proc/self/statm", "r")) {
    if (std::fscanf(file, "%ld", &pages) != 1) pages = 0;
    std::fclose(file);
  }
  limit_address_space(bytes + static_cast<double>(pages) * static_cast<double>(::sysconf(_SC_PAGESIZE)));
  std::set_new_handler(out_of_memory);
}

// Signals as a new process has them, and no descriptor of the parent.
void start_anew(int message, int said) {
  for (int signal = 1; signal < NSIG; ++signal) ::signal(signal, SIG_DFL);
  sigset_t none;
  ::sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  ::dup2(::open("/dev/null", O_RDONLY), STDIN_FILENO);
  for (const int stream : {STDOUT_FILENO, STDERR_FILENO}) ::dup2(said, stream);
  ::dup2(message, message_end);
  ::close_range(message_end + 1, ~0U, 0);
}

[[noreturn]] void be_the_child(const ChildWork& child, CallNote* note, int message, int said) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  const rlimit no_core = {0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
  start_anew(message, said);
  shared_note = note;
  note_plugin_calls(note);
  limit_memory(child.memory);
  ForeignCode::allow();
  ::on_exit(ricochet_child_exit, nullptr);
  char tag = tag_value;
  std::string text;
  try {
    text = child.work();
  } catch (const std::exception& error) {
    tag = tag_exception;
    text = error.what();
  } catch (...) {
    tag = tag_exception;
    text = "an exception that says nothing";
  }
  std::fflush(nullptr);
  std::cout.flush();
  const std::uint64_t size = text.size();
  if (!send(&tag, 1) || !send(reinterpret_cast<const char*>(&size), sizeof size) || !send(text.data(), text.size()))
    ::_exit(1);
  if (tag == tag_value && child.afterwards) {
    is_afterwards = true;
    child.afterwards();
    std::exit(0);
  }
  ::_exit(0);
}

/// The parent's view: what came through the pipes so far, and whether the child has ended.
class Watch {
 public:
  Watch(pid_t child, int message, int said) : child_(child), message_pipe_(message), said_pipe_(said) {
    for (const int pipe : {message, said}) ::fcntl(pipe, F_SETFL, O_NONBLOCK);
  }
  ~Watch() {
    ::close(message_pipe_);
    ::close(said_pipe_);
  }
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;

  /// Reads until the child has ended, or until it has sent its value where `until_sent`; false when the limit came
  /// first. The pipes alone do not tell: another process may hold them open.
  bool wait(Clock::time_point limit, bool until_sent) {
    constexpr int beat = 10;  // ms
    for (;; drain()) {
      if (ended_ || (until_sent && sent())) return true;
      if (Clock::now() >= limit) return false;
      pollfd wait[] = {{message_open_ ? message_pipe_ : -1, POLLIN, 0}, {said_open_ ? said_pipe_ : -1, POLLIN, 0}};
      if (message_open_ || said_open_)
        ::poll(wait, 2, beat);
      else
        ::usleep(1000);
      siginfo_t info{};
      const int found = ::waitid(P_PID, static_cast<id_t>(child_), &info, WEXITED | WNOHANG | WNOWAIT);
      if ((found == 0 && info.si_pid == child_) || (found < 0 && errno != EINTR)) reap();
    }
  }
  void kill() {
    ::kill(child_, SIGKILL);
    if (!ended_) reap();
    drain();
  }
  /// All of its value or exception is there.
  bool sent() const { return message_.size() >= head && message_.size() - head >= text_size(); }
  char tag() const { return sent() ? message_.front() : '\0'; }
  std::string text() const { return message_.substr(head, text_size()); }
  bool came_back_afterwards() const {
    return sent() && message_.size() > head + text_size() && message_[head + text_size()] == tag_afterwards;
  }
  int status() const { return status_; }

 private:
  std::uint64_t text_size() const {
    std::uint64_t size = 0;
    std::memcpy(&size, message_.data() + 1, sizeof size);
    return size;
  }
  // Its number is its own and its group's as long as nobody has asked for its status.
  void reap() {
    siginfo_t info{};
    while (::waitid(P_PID, static_cast<id_t>(child_), &info, WEXITED | WNOWAIT) < 0 && errno == EINTR) {
    }
    ::kill(-child_, SIGKILL);
    while (::waitpid(child_, &status_, 0) < 0 && errno == EINTR) {
    }
    ended_ = true;
  }
  // Up to so many bytes: somebody may write without end.
  template <class Take>
  static void drain(int pipe, bool& open, Take take) {
    constexpr std::size_t most = 1U << 20U;
    char part[4096];
    for (std::size_t all = 0; open && all < most;) {
      const ssize_t size = ::read(pipe, part, sizeof part);
      if (size < 0 && errno == EINTR) continue;
      if (size == 0) open = false;
      if (size <= 0) return;
      take(part, static_cast<std::size_t>(size));
      all += static_cast<std::size_t>(size);
    }
  }
  void drain() {
    drain(message_pipe_, message_open_, [&](const char* part, std::size_t size) { message_.append(part, size); });
    drain(said_pipe_, said_open_,
          [](const char* part, std::size_t size) { std::cerr.write(part, static_cast<std::streamsize>(size)); });
  }
  const pid_t child_;
  const int message_pipe_, said_pipe_;
  int status_ = 0;
  bool ended_ = false, message_open_ = true, said_open_ = true;
  std::string message_;
};

std::string ended_in_words(int status) {
  if (WIFSIGNALED(status)) return "ended by " + signal_in_words(WTERMSIG(status));
  return fmt::format("ended the process with exit code {}", WIFEXITED(status) ? WEXITSTATUS(status) : -1);
}

std::string late_in_words(double seconds) {
  return fmt::format("did not end within {:g} s", seconds);
}

/// Memory that a child shares with this process.
using SharedNote = std::unique_ptr<CallNote, void (*)(CallNote*)>;
SharedNote new_note() {
  void* const memory = ::mmap(nullptr, sizeof(CallNote), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED)
    throw std::system_error(errno, std::generic_category(), "no memory for a child process can be had");
  return {new (memory) CallNote, [](CallNote* note) { ::munmap(note, sizeof *note); }};
}

[[noreturn]] void no_pipe() {
  throw std::system_error(errno, std::generic_category(), "no pipe to a child process can be had");
}

struct Pipe {
  int read = -1, write = -1;
  Pipe() {
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) no_pipe();
    read = ends[0];
    // The child's own numbers are below.
    write = duplicated_from(message_end + 1, ends[1]);
    if (write < 0) {
      ::close(read);
      no_pipe();
    }
  }
  ~Pipe() {
    if (write >= 0) ::close(write);
    if (read >= 0) ::close(read);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  int take_read() { return std::exchange(read, -1); }
};

Clock::time_point from_now(double seconds) {
  constexpr double a_year = 3.2e7;
  return Clock::now() +
         std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(std::min(seconds, a_year)));
}

void judge(const Watch& watch, ChildOutcome& outcome, const CallNote& note) {
  const int status = watch.status();
  outcome.call = note.seen();
  if (const std::uint64_t memory = note.memory_exceeded) {
    outcome.end = ChildOutcome::End::memory;
    outcome.limit = static_cast<double>(memory);
  } else if (WIFSIGNALED(status)) {
    outcome.end = ChildOutcome::End::signal;
    outcome.number = WTERMSIG(status);
  } else {
    outcome.end = ChildOutcome::End::exit;
    outcome.number = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
}

}  // namespace

std::uint64_t limit_address_space([[maybe_unused]] double bytes) {
  rlimit limit{};
  ::getrlimit(RLIMIT_AS, &limit);
#ifndef RICOCHET_SANITIZED
  if (bytes > 0) {
    limit.rlim_cur = std::min(limit.rlim_max, static_cast<rlim_t>(bytes));
    limit.rlim_max = limit.rlim_cur;
    ::setrlimit(RLIMIT_AS, &limit);
  }
#endif
  return limit.rlim_cur;
}

int duplicated_from(int least, int descriptor) {
  const int number = ::fcntl(descriptor, F_DUPFD_CLOEXEC, least);
  const int error = errno;
  ::close(descriptor);
  errno = error;
  return number;
}

std::string signal_in_words(int signal) {
  const char* known = ::strsignal(signal);
  std::string text = known ? known : "unknown";
  text[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(text[0])));
  return fmt::format("signal {} ({})", signal, text);
}

std::string bytes_in_words(double bytes) {
  constexpr double mebi = 1U << 20U, gibi = 1U << 30U;
  return bytes >= gibi ? fmt::format("{:.3g} GiB", bytes / gibi) : fmt::format("{:.0f} MiB", bytes / mebi);
}

std::string ChildOutcome::cause() const {
  switch (end) {
    case End::value:
      return "";
    case End::exception:
      return text;
    case End::signal:
      return "ended by " + signal_in_words(number);
    case End::exit:
      return fmt::format("ended the process with exit code {}", number);
    case End::memory:
      return fmt::format("took more than the {} of memory that it may take", bytes_in_words(limit));
    case End::timeout:
      break;
  }
  return late_in_words(limit);
}

std::string ChildOutcome::sentence() const {
  return call.place() + cause();
}

ChildOutcome run_in_child(const ChildWork& child) {
  constexpr double afterwards = 3, long_wait = 3;  // s
  Pipe message, said;
  const SharedNote note = new_note();
  // What is buffered is written once, by this process.
  std::cout.flush();
  std::fflush(nullptr);
  const pid_t process = ::fork();
  if (process < 0) throw std::system_error(errno, std::generic_category(), "no child process can be had");
  if (process == 0) be_the_child(child, note.get(), message.write, said.write);
  ::setpgid(process, process);
  Watch watch(process, message.take_read(), said.take_read());
  ::close(std::exchange(message.write, -1));
  ::close(std::exchange(said.write, -1));

  ChildOutcome outcome;
  const Clock::time_point limit = from_now(child.seconds);
  if (child.waits && child.seconds > long_wait && !watch.wait(from_now(long_wait), true)) child.waits();
  const bool in_time = watch.wait(limit, true);
  const bool ends = in_time && watch.wait(from_now(afterwards), false);
  if (!ends) watch.kill();
  const char tag = watch.tag();
  if (!in_time) {
    outcome.end = ChildOutcome::End::timeout;
    outcome.limit = child.seconds;
    outcome.call = note->seen();
  } else if (tag == tag_value || tag == tag_exception) {
    outcome.end = tag == tag_value ? ChildOutcome::End::value : ChildOutcome::End::exception;
    outcome.text = watch.text();
    if (tag == tag_value && child.afterwards && !watch.came_back_afterwards())
      outcome.afterwards = ends ? ended_in_words(watch.status()) : late_in_words(afterwards);
  } else {
    judge(watch, outcome, *note);
  }
  return outcome;
}

ChildOutcome run_in_child(const std::function<std::string()>& work, double seconds,
                          const std::function<void()>& waits) {
  return run_in_child({.work = work, .seconds = seconds, .waits = waits});
}

namespace {
std::atomic<bool> foreign_code_may_run{true};
}  // namespace

ForeignCode::InChildrenAlone::InChildrenAlone() {
  foreign_code_may_run = false;
}
ForeignCode::InChildrenAlone::~InChildrenAlone() {
  foreign_code_may_run = true;
}
bool ForeignCode::may_run() {
  return foreign_code_may_run;
}
void ForeignCode::allow() {
  foreign_code_may_run = true;
}

}  // namespace ricochet
