#include "runners/workers/worker_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <ricochet/engine/cost_model.hpp>
#include <ricochet/loader/child.hpp>
#include <ricochet/loader/library.hpp>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <vector>

#include "runners/march/prepare_case.hpp"
#include "runners/store/fingerprint.hpp"
#include "runners/table/text.hpp"

namespace ricochet {

const std::string& worker_program() {
  static const std::string program = program_file().string();
  return program;
}

std::vector<std::string> worker_environment() {
  constexpr std::array<std::string_view, 5> of_launchers = {"OMPI_", "PMIX_", "PMI_", "MPI_LOCAL", "OPAL_"};
  std::vector<std::string> variables;
  for (char** one = environ; one && *one; ++one)
    if (const std::string_view text = *one; std::none_of(of_launchers.begin(), of_launchers.end(),
                                                         [&](std::string_view head) { return text.starts_with(head); }))
      variables.emplace_back(text);
  // A worker is one thread: those of a BLAS would wait beside it, as many as there are processors, in every worker.
  for (const std::string_view name : {"OPENBLAS_NUM_THREADS=", "OMP_NUM_THREADS="})
    if (std::none_of(variables.begin(), variables.end(), [&](const auto& one) { return one.starts_with(name); }))
      variables.push_back(std::string(name) + "1");
  return variables;
}

sigset_t coordinator_signals() {
  sigset_t set;
  sigemptyset(&set);
  for (const int one : signals_of_coordinator) sigaddset(&set, one);
  return set;
}

namespace {

constexpr std::size_t kept_of_stderr = 2000;

[[noreturn]] void fail(const char* what) {
  throw RunError(fmt::format("no worker process can be started: {}: {}", what, std::strerror(errno)));
}

bool names(const std::string& place, const std::filesystem::path& library) {
  return place.find(library.string()) != std::string::npos;
}

std::string ended_by(int status) {
  return WIFEXITED(status) ? fmt::format("exit code {}", WEXITSTATUS(status)) : signal_in_words(WTERMSIG(status));
}

}  // namespace

std::string machine_name() {
  std::array<char, 256> text{};
  return ::gethostname(text.data(), text.size() - 1) == 0 ? text.data() : "?";
}

double free_memory() {
  const double free = available_memory();
  return std::isfinite(free) ? free : 0;
}

double memory_for_each(double free, int workers) {
  constexpr double least = 2.0 * (1 << 30);
  return free > 0 ? std::max(least, free / workers) : 0;
}

std::string WorkerEnd::sentence(const std::string& times) const {
  // Of what came before the end only a third-party function is told: it may have left damage behind.
  std::vector<std::string> others;
  bool told = in_call;
  for (const auto& library : described_libraries()) {
    others.push_back(library.string());
    told = told || names(place, library);
  }
  std::string text = told ? place : "";
  const std::string often = times.empty() ? "" : " " + times;
  text += silent ? fmt::format("its process {} and was killed{}",
                               stopped ? "was stopped by a signal" : "did not answer any more", often)
                 : fmt::format("its process was ended{} by {}", often, cause);
  if (!told && !others.empty()) text += fmt::format("; third-party libraries in it: {}", fmt::join(others, ", "));
  if (!last_lines.empty()) text += fmt::format("; it wrote: {}", last_lines);
  return text;
}

bool WorkerEnd::in_third_party() const {
  const auto libraries = described_libraries();
  return in_call && std::any_of(libraries.begin(), libraries.end(), [&](const auto& one) { return names(place, one); });
}

WorkerProcess::WorkerProcess() {
  std::array<int, 2> sockets{}, errors{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, sockets.data()) != 0) fail("socketpair");
  channel_ = std::make_unique<Channel>(sockets[0]);
  // The worker's own numbers are below those of what it gets.
  const int its_channel = duplicated_from(kWorkerNote + 1, sockets[1]);
  if (its_channel < 0) fail("socketpair");
  if (::pipe2(errors.data(), O_CLOEXEC) != 0) {
    ::close(its_channel);
    fail("pipe");
  }
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_adddup2(&actions, errors[1], STDERR_FILENO);
  ::posix_spawn_file_actions_adddup2(&actions, its_channel, kWorkerChannel);
  ::posix_spawn_file_actions_adddup2(&actions, note_.descriptor(), kWorkerNote);
  ::posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  // A worker has nothing to say on stdout; what a plugin prints there joins its stderr.
  ::posix_spawn_file_actions_adddup2(&actions, STDERR_FILENO, STDOUT_FILENO);
  // Ctrl-C in a terminal is for this process, which tells its workers to stop.
  posix_spawnattr_t attributes;
  ::posix_spawnattr_init(&attributes);
  ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK);
  ::posix_spawnattr_setpgroup(&attributes, 0);
  const sigset_t not_for_it = coordinator_signals();
  ::posix_spawnattr_setsigmask(&attributes, &not_for_it);
  std::string name = "ricochet", command = "worker";
  std::array<char*, 3> arguments = {name.data(), command.data(), nullptr};
  std::vector<std::string> variables = worker_environment();
  std::vector<char*> environment;
  for (std::string& one : variables) environment.push_back(one.data());
  environment.push_back(nullptr);
  const int error =
      ::posix_spawn(&pid_, worker_program().c_str(), &actions, &attributes, arguments.data(), environment.data());
  ::posix_spawn_file_actions_destroy(&actions);
  ::posix_spawnattr_destroy(&attributes);
  ::close(its_channel);
  ::close(errors[1]);
  if (error != 0) {
    ::close(errors[0]);
    pid_ = -1;
    ended_ = true;
    errno = error;
    fail(worker_program().c_str());
  }
  try {
    listener_ = std::thread([this, descriptor = errors[0]] { pass_on_stderr(descriptor); });
  } catch (const std::system_error&) {
    ::close(errors[0]);
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
    ended_ = true;
    errno = EAGAIN;
    fail("a thread, for which memory or the limit of processes is too small");
  }
}

WorkerProcess::~WorkerProcess() {
  if (!ended_) {
    kill();
    end();
  }
}

void WorkerProcess::kill() {
  if (stopped()) killed_stopped_ = true;
  const std::lock_guard guard(mutex_);
  if (!ended_) ::kill(pid_, SIGKILL);
}

bool WorkerProcess::stopped() {
  siginfo_t info{};
  const std::lock_guard guard(mutex_);
  return !ended_ && note_.note().seen().serial != 0 &&
         ::waitid(P_PID, static_cast<id_t>(pid_), &info, WSTOPPED | WNOHANG | WNOWAIT) == 0 && info.si_pid == pid_;
}

WorkerEnd WorkerProcess::end() {
  WorkerEnd found;
  int status = 0;
  siginfo_t info{};
  while (::waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOWAIT) < 0 && errno == EINTR) {
  }
  {
    // From here on its number, and that of the group of what it began, may be others'.
    const std::lock_guard guard(mutex_);
    ::kill(-pid_, SIGKILL);
    while (::waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
    }
    ended_ = true;
  }
  listener_.join();
  const CallNote& note = note_.note();
  found.cause = ended_by(status);
  if (note.exit_called) found.cause = "a call of exit()";
  const std::uint64_t most = note.memory_exceeded;
  found.no_memory = most != 0;
  if (found.no_memory)
    found.cause = fmt::format("want of memory: a worker may take {}", bytes_in_words(static_cast<double>(most)));
  const SeenCall call = note.seen();
  found.place = call.place();
  found.in_call = call.serial != 0;
  found.stopped = killed_stopped_;
  const std::lock_guard guard(mutex_);
  found.last_lines = last_lines_;
  while (found.last_lines.ends_with('\n')) found.last_lines.pop_back();
  std::replace(found.last_lines.begin(), found.last_lines.end(), '\n', '|');
  return found;
}

bool WorkerProcess::has_ended() const {
  siginfo_t info{};
  return ::waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOHANG | WNOWAIT) == 0 && info.si_pid == pid_;
}

Channel::Heard WorkerProcess::receive(Message& message, double seconds) {
  constexpr double beat = 0.25;
  for (;; seconds -= beat) {
    if (const auto heard = channel_->receive(message, std::min(seconds, beat)); heard != Channel::Heard::silence)
      return heard;
    if (has_ended())  // what it said before stands
      return channel_->receive(message, 0) == Channel::Heard::message ? Channel::Heard::message : Channel::Heard::gone;
    if (seconds <= beat) return Channel::Heard::silence;
  }
}

void WorkerProcess::pass_on_stderr(int descriptor) {
  constexpr int beat = 50;                        // ms
  constexpr std::size_t most_afterwards = 65536;  // of what others say who hold the descriptor
  std::array<char, 4096> part{};
  std::size_t afterwards = 0;
  for (ssize_t got = 0; afterwards < most_afterwards;) {
    pollfd wait{descriptor, POLLIN, 0};
    const bool last = ended_;
    if (::poll(&wait, 1, beat) == 0) {
      if (last) break;
      continue;
    }
    got = ::read(descriptor, part.data(), part.size());
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) break;
    if (last) afterwards += static_cast<std::size_t>(got);
    const std::string_view text(part.data(), static_cast<std::size_t>(got));
    const std::string shown = plain_text(text);
    std::fwrite(shown.data(), 1, shown.size(), stderr);
    const std::lock_guard guard(mutex_);
    last_lines_ += text;
    if (last_lines_.size() > kept_of_stderr) {
      last_lines_.erase(0, last_lines_.size() - kept_of_stderr);
      // Whole lines, where there are any.
      if (const std::size_t line = last_lines_.find('\n'); line + 1 < last_lines_.size())
        last_lines_.erase(0, line + 1);
    }
  }
  ::close(descriptor);
}

}  // namespace ricochet
