#include "tests/runners/mpi/launch.hpp"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <sstream>

#include "tests/places.hpp"

using ricochet::tests::places;

namespace launch {
namespace {

namespace fs = std::filesystem;

bool there(const std::string& command) {
  return std::system(("PATH=$PATH:/usr/sbin command -v " + command + " >/dev/null 2>&1").c_str()) == 0;
}

bool skip(const std::string& why) {
  std::cout << "skipped: " << why << std::endl;
  return true;
}

/// Of /proc/PID/cmdline, words apart by spaces.
std::string command_line_of(const fs::path& process) {
  std::string text = read_text(process / "cmdline");
  std::replace(text.begin(), text.end(), '\0', ' ');
  return text;
}

}  // namespace

int Ended::told(const std::string& word) const {
  int count = 0;
  for (std::size_t at = messages.find(word); at != std::string::npos; at = messages.find(word, at + 1)) ++count;
  return count;
}

bool without_mpi() {
  if (std::string(places().ranks).empty()) return skip("this build has no ricochet-mpi (-DRICOCHET_MPI=ON)");
  if (!there("mpirun")) return skip("there is no mpirun here (tests/run.sh installs openmpi-bin)");
  return false;
}

bool without_slurm() {
  if (without_mpi()) return true;
  if (::geteuid() != 0) return skip("the daemons of Slurm and munge are started by root alone");
  for (const char* one : {"slurmctld", "slurmd", "srun", "munged"})
    if (!there(one)) return skip(std::string("there is no ") + one + " here (tests/run.sh installs it)");
  return false;
}

std::string run_words(const ScratchFolder& scratch, const quick_studies::Json& study, const std::string& out) {
  write_text(scratch / (out + ".json"), study.dump());
  return "run '" + (scratch / (out + ".json")).string() + "' --jobs 2 --out '" + (scratch / out).string() + "'";
}

std::string program(const std::string& words) {
  return "'" + places().command + "' " + words;
}

std::string ranks_program() {
  return places().ranks;
}

std::string mpirun(const std::string& words) {
  return "env OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 mpirun --oversubscribe --bind-to none " + words;
}

std::string ranks(int count, const std::string& words, const std::string& launcher) {
  return mpirun(launcher + " -n " + std::to_string(count) + " '" + places().ranks + "' " + words);
}

UnderWay::UnderWay(const ScratchFolder& scratch, const std::string& line) : scratch_(scratch) {
  const std::string whole = "exec env RICOCHET_PLUGIN_PATH= " + line + " >'" + (scratch / "said").string() + "' 2>'" +
                            (scratch / "told").string() + "' </dev/null";
  process_ = ::fork();
  if (process_ != 0) return;
  ::setsid();
  ::execl("/bin/sh", "sh", "-c", whole.c_str(), nullptr);
  ::_exit(127);
}

UnderWay::~UnderWay() {
  if (process_ <= 0) return;
  ::kill(-process_, SIGKILL);
  ::waitpid(process_, &status_, 0);
}

bool UnderWay::ended() const {
  siginfo_t info{};
  return ::waitid(P_PID, static_cast<id_t>(process_), &info, WEXITED | WNOHANG | WNOWAIT) == 0 && info.si_pid != 0;
}

// mpirun waits for ever where a rank of it is killed before all are there: nothing of the program is left then. How
// long it takes to begin one says nothing.
void UnderWay::give_up_a_launcher() {
  if (command_line_of("/proc/" + std::to_string(process_)).find("mpirun") == std::string::npos) return;
  constexpr int looks = 200, enough = 100;  // per look, ms
  for (int idle = 0; !ended() && idle < looks; ::usleep(1000 * enough)) {
    idle = below("ricochet").empty() && seen_ ? idle + 1 : 0;
  }
  if (!ended()) ::kill(-process_, SIGKILL);
}

Ended UnderWay::finish(int signal) {
  if (signal != 0) ::kill(process_, signal);
  give_up_a_launcher();
  // Half of the time that a test has: who hangs is ended, and what it told is to be read.
  constexpr int looks = 180000, between = 5;  // ms
  for (int i = 0; i < looks && !ended(); ++i) ::usleep(1000 * between);
  if (!ended()) ::kill(-process_, SIGKILL);
  ::waitpid(process_, &status_, 0);
  process_ = -1;
  return {WIFEXITED(status_) ? WEXITSTATUS(status_) : -WTERMSIG(status_), read_text(scratch_ / "said"),
          read_text(scratch_ / "told")};
}

std::vector<pid_t> UnderWay::below(const std::string& words) const {
  std::vector<pid_t> found = processes(words);
  std::erase_if(found, [&](pid_t one) {
    if (one == process_) return true;
    while (one > 1 && one != process_) one = parent_of(one);
    return one != process_;
  });
  seen_ = seen_ || !found.empty();
  return found;
}

std::vector<pid_t> ranks_below(const UnderWay& run, int rank) {
  const std::string word = "OMPI_COMM_WORLD_RANK=";
  std::vector<pid_t> found = run.below("ricochet-mpi");
  std::erase_if(found, [&](pid_t one) {
    const std::string environment = read_text("/proc/" + std::to_string(one) + "/environ");
    const std::size_t at = environment.find(word);
    if (at == std::string::npos) return true;
    const int number = std::atoi(environment.c_str() + at + word.size());
    return rank < 0 ? number == 0 : number != rank;
  });
  return found;
}

pid_t parent_of(pid_t process) {
  const std::string text = read_text("/proc/" + std::to_string(process) + "/stat");
  std::istringstream rest(text.substr(std::min(text.size(), text.rfind(')') + 1)));
  char state = ' ';
  pid_t parent = 0;
  rest >> state >> parent;
  return parent;
}

std::vector<pid_t> processes(const std::string& words) {
  std::vector<pid_t> found;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator("/proc", error)) {
    const std::string name = entry.path().filename().string();
    if (name.find_first_not_of("0123456789") == std::string::npos &&
        command_line_of(entry.path()).find(words) != std::string::npos)
      found.push_back(static_cast<pid_t>(std::stol(name)));
  }
  return found;
}

Ended to_its_end(const ScratchFolder& scratch, const std::string& line) {
  return UnderWay(scratch, line).finish();
}

}  // namespace launch
