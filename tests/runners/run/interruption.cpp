/// Runs that end before their time: each in a child process, which is this program again with a hidden test.
#include <SQLiteCpp/SQLiteCpp.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <functional>

#include "runners/store/atomic_file.hpp"
#include "runners/store/record_values.hpp"
#include "runners/store/store.hpp"
#include "runners/table/text.hpp"
#include "tests/runners/run/fake_study.hpp"

using namespace ricochet;

namespace interruption_tests {
using Catch::Contains;

namespace {

constexpr int kCases = 12;
constexpr const char* kChildTest = "child process of the interruption tests";

/// What the child does with its cases.
///   quick:    all of them, at once
///   hang:     finishes five, then waits in the sixth until it is asked to stop
///   stubborn: the same, but deaf to the request
///   large:    a million samples each
///   report:   small cases, a large report
Study child_study(const std::string& scenario) {
  Study study = fake_study(kCases);
  if (scenario == "large")
    for (StudyCase& one : study.cases) one.samples = 1000000;
  return study;
}

int child_run(const std::string& scenario, const std::filesystem::path& out) {
  std::atomic<int> begun{0};
  FakeRun fake(out.parent_path());  // the parent's folder: a killed child removes nothing
  StudyRunner runner = fake.runner;
  runner.cases.run = [&](const StudyCase& one, const std::atomic<bool>& stop) {
    constexpr int before = 5;
    if ((scenario == "hang" || scenario == "stubborn") && ++begun > before)
      for (;;) {
        if (stop && scenario == "hang") throw Interrupted{};
        ::usleep(1000);
      }
    return fake_result(one);
  };
  if (scenario == "report") runner.render = [](const StudyResults&) { return std::string(4000000, 'x'); };
  return run_study_with(runner, child_study(scenario), {out, 1, false});
}

/// The child: started at once, its messages in `messages`.
class Child {
 public:
  Child(const std::string& scenario, const std::filesystem::path& out, const std::filesystem::path& messages,
        rlim_t file_limit = RLIM_INFINITY)
      : messages_(messages) {
    ::setenv("RICOCHET_TEST_SCENARIO", scenario.c_str(), 1);
    ::setenv("RICOCHET_TEST_OUT", out.c_str(), 1);
    std::string program = "/proc/self/exe", test = kChildTest;
    process_ = ::fork();
    if (process_ != 0) return;
    const int descriptor = ::open(messages.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    ::dup2(descriptor, STDOUT_FILENO);
    ::dup2(descriptor, STDERR_FILENO);
    if (file_limit != RLIM_INFINITY) {
      const rlimit limit{file_limit, file_limit};
      ::setrlimit(RLIMIT_FSIZE, &limit);
    }
    ::execl(program.c_str(), program.c_str(), test.c_str(), nullptr);
    ::_exit(127);
  }
  ~Child() {
    if (process_ <= 0) return;
    ::kill(process_, SIGKILL);
    ::waitpid(process_, nullptr, 0);
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  pid_t process() const { return process_; }
  void send(int signal) const { ::kill(process_, signal); }
  /// Whether no signal waits for it: those that were sent have been handled, or are about to be.
  bool heard() const {
    std::istringstream status(read_text("/proc/" + std::to_string(process_) + "/status"));
    bool none = true;
    for (std::string line; std::getline(status, line);)
      if (line.starts_with("SigPnd:") || line.starts_with("ShdPnd:"))
        none = none && line.find_first_not_of("0\t ", 7) == std::string::npos;
    return none;
  }
  std::string messages() const { return read_text(messages_); }
  /// The exit code, or minus the signal that ended it.
  int wait() {
    int status = 0;
    ::waitpid(process_, &status, 0);
    process_ = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }

 private:
  pid_t process_ = 0;
  std::filesystem::path messages_;
};

/// Waits until `condition`, which another process makes true; gives up after ten minutes, which only a hung child
/// needs.
bool wait_for(const std::function<bool()>& condition) {
  constexpr int tries = 120000;
  for (int i = 0; i < tries; ++i) {
    if (condition()) return true;
    ::usleep(5000);
  }
  return false;
}

std::size_t stored(const std::filesystem::path& out) {
  try {
    return read_store(out).cases.size();
  } catch (const StoreError&) {
    return 0;
  }
}

std::string integrity(const std::filesystem::path& out) {
  SQLite::Database database(out / "results.sqlite", SQLite::OPEN_READWRITE);
  return database.execAndGet("PRAGMA integrity_check").getString();
}

/// Every row of every table of results, without the environment.
std::string everything(const std::filesystem::path& out) {
  const StudyResults results = read_store(out);
  std::string text = results.study.dump() + table_csv(cases_table(results)) + table_csv(left_out_table(results)) +
                     table_csv(notes_table(results));
  for (const CaseRecord& record : results.cases) text += record.id + curve_csv(record.curve);
  return text;
}

/// Ends the interrupted run in `out` in this process; it must equal a run that nothing interrupted.
void resume_and_compare(const ScratchFolder& scratch, const std::filesystem::path& out, int missing) {
  FakeRun run(scratch);
  REQUIRE(run(child_study("quick"), {out, 1, false}) == 0);
  CHECK(run.runs == missing);
  REQUIRE(run(child_study("quick"), {scratch / "uninterrupted", 1, false}) == 0);
  CHECK((everything(out) == everything(scratch / "uninterrupted")));
  CHECK((read_text(out / "cases.csv") == read_text(scratch / "uninterrupted/cases.csv")));
  CHECK(integrity(out) == "ok");
}

bool no_part_files(const std::filesystem::path& out) {
  for (const auto& entry : std::filesystem::recursive_directory_iterator(out))
    if (entry.path().string().find(".part-") != std::string::npos) return false;
  return true;
}

}  // namespace

TEST_CASE(kChildTest, "[.]") {
  const char* scenario = std::getenv("RICOCHET_TEST_SCENARIO");
  const char* out = std::getenv("RICOCHET_TEST_OUT");
  if (scenario == nullptr || out == nullptr) return;  // listed and run as a test: nothing to do
  std::exit(child_run(scenario, out));
}

TEST_CASE(
    "interruption: after kill -9 every finished case is kept, and resuming gives what an uninterrupted run gives") {
  const ScratchFolder scratch;
  const auto out = scratch / "out";
  Child child("hang", out, scratch / "messages");
  REQUIRE(wait_for([&] { return stored(out) == 5; }));
  child.send(SIGKILL);
  CHECK(child.wait() == -SIGKILL);
  CHECK(stored(out) == 5);
  resume_and_compare(scratch, out, kCases - 5);
}

TEST_CASE("interruption: kill -9 at any moment leaves a sound store") {
  for (const int delay_us : {0, 500, 3000, 9000}) {
    const ScratchFolder scratch;
    const auto out = scratch / "out";
    Child child("quick", out, scratch / "messages");
    REQUIRE(wait_for([&] { return std::filesystem::exists(out / "results.sqlite"); }));
    ::usleep(static_cast<useconds_t>(delay_us));
    child.send(SIGKILL);
    child.wait();
    const int kept = static_cast<int>(stored(out));
    resume_and_compare(scratch, out, kCases - kept);
    CHECK(no_part_files(out));
  }
}

TEST_CASE("interruption: Ctrl-C keeps what is finished, says how to resume, and exits with 130") {
  const int signal = GENERATE(SIGINT, SIGTERM, SIGUSR1, SIGHUP);
  const ScratchFolder scratch;
  const auto out = scratch / "out";
  Child child("hang", out, scratch / "messages");
  REQUIRE(wait_for([&] { return stored(out) == 5; }));
  child.send(signal);
  CHECK(child.wait() == 130);
  CHECK_THAT(child.messages(), Contains("interrupted: 5 of 12 cases") && Contains("Run the same command again"));
  CHECK_FALSE(std::filesystem::exists(out / "report.html"));
  CHECK_FALSE(std::filesystem::exists(out / "results.lock"));
  resume_and_compare(scratch, out, kCases - 5);
}

TEST_CASE("interruption: a second Ctrl-C ends at once") {
  const ScratchFolder scratch;
  const auto out = scratch / "out";
  Child child("stubborn", out, scratch / "messages");
  REQUIRE(wait_for([&] { return stored(out) == 5; }));
  child.send(SIGINT);
  REQUIRE(wait_for([&] { return child.messages().find("stopping") != std::string::npos; }));
  child.send(SIGINT);
  CHECK(child.wait() == 130);
  resume_and_compare(scratch, out, kCases - 5);
}

TEST_CASE("interruption: a scheduler's warning may come twice, and an order to stop after it is the first") {
  const ScratchFolder scratch;
  const auto out = scratch / "out";
  Child child("stubborn", out, scratch / "messages");
  REQUIRE(wait_for([&] { return stored(out) == 5; }));
  child.send(SIGUSR1);
  REQUIRE(wait_for([&] { return child.messages().find("stopping") != std::string::npos; }));
  child.send(SIGUSR1);
  REQUIRE(wait_for([&] { return child.heard(); }));
  child.send(SIGTERM);
  REQUIRE(wait_for([&] { return child.heard(); }));
  CHECK(::waitpid(child.process(), nullptr, WNOHANG) == 0);
  child.send(SIGTERM);
  CHECK(child.wait() == 130);
  resume_and_compare(scratch, out, kCases - 5);
}

TEST_CASE("interruption: a run under nohup outlives its terminal") {
  struct sigaction ignored {
  }, before{};
  ignored.sa_handler = SIG_IGN;
  ::sigaction(SIGHUP, &ignored, &before);
  {
    const StopSignal stop;
    ::raise(SIGHUP);
    CHECK_FALSE(stop.requested());
  }
  struct sigaction after {};
  ::sigaction(SIGHUP, &before, &after);
  CHECK(after.sa_handler == SIG_IGN);
}

TEST_CASE("interruption: a second run on the same folder is refused and names the first") {
  const ScratchFolder scratch;
  const auto out = scratch / "out";
  Child child("hang", out, scratch / "messages");
  REQUIRE(wait_for([&] { return stored(out) == 5; }));
  FakeRun run(scratch);
  CHECK(run(child_study("quick"), {out, 1, false}) == 5);
  CHECK(run.runs == 0);
  CHECK_THAT(run.messages, Contains("another run is using this folder") &&
                               Contains("process " + std::to_string(child.process())) && Contains("--out"));
  CHECK(run(child_study("quick"), {out, 1, true}) == 5);  // --fresh must not pull the store from under the first
  CHECK(stored(out) == 5);
  child.send(SIGINT);
  CHECK(child.wait() == 130);
  resume_and_compare(scratch, out, kCases - 5);
}

TEST_CASE("interruption: a store that may not grow keeps its finished cases and says so") {
  const ScratchFolder scratch;
  const auto out = scratch / "out";
  // Room for two cases of two million doubles each, not for three.
  constexpr rlim_t limit = 40000000;
  Child child("large", out, scratch / "messages", limit);
  CHECK(child.wait() == 5);
  CHECK_THAT(child.messages(), Contains("ricochet: ") && Contains("results.sqlite") && Contains("File too large") &&
                                   Contains("run the same command again"));
  CHECK(stored(out) == 2);
  CHECK(integrity(out) == "ok");
  CHECK_FALSE(std::filesystem::exists(out / "cases.csv"));
  resume_and_compare(scratch, out, kCases);  // the cases of this study are small: others than those stored
}

TEST_CASE("interruption: a report that cannot be written leaves the old one, and the store is complete") {
  const ScratchFolder scratch;
  const auto out = scratch / "out";
  std::filesystem::create_directory(out);
  write_text(out / "report.html", "old");
  constexpr rlim_t limit = 1000000;  // the store is far smaller, the report larger
  Child child("report", out, scratch / "messages", limit);
  CHECK(child.wait() == 5);
  CHECK_THAT(child.messages(), Contains("report.html: cannot be written"));
  CHECK(read_text(out / "report.html") == "old");
  CHECK(no_part_files(out));
  resume_and_compare(scratch, out, 0);
}

TEST_CASE("interruption: a full disk") {
  const ScratchFolder scratch;
  const auto disk = scratch / "disk";
  std::filesystem::create_directory(disk);
  if (::mount("tmpfs", disk.c_str(), "tmpfs", 0, "size=40m") != 0) {
    WARN("not tested: this process may not mount a small file system");
    return;
  }
  {
    Child child("large", disk / "out", scratch / "messages");
    CHECK(child.wait() == 5);
    CHECK_THAT(child.messages(),
               Contains("results.sqlite") && Contains("the disk is full") && Contains("run the same command again"));
    CHECK(stored(disk / "out") >= 1);
    CHECK(integrity(disk / "out") == "ok");
    CHECK(no_part_files(disk / "out"));
  }
  CHECK(::umount(disk.c_str()) == 0);
}

}  // namespace interruption_tests
