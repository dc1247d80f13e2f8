/// Plugins that end the program or never return: each in a child process, in one case of nine.
#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <functional>
#include <optional>
#include <ricochet/contract/plugin_call.hpp>

#include "runners/march/case_watch.hpp"
#include "runners/march/crash_record.hpp"
#include "runners/store/store.hpp"
#include "runners/store/store_error.hpp"
#include "tests/runners/run/fake_study.hpp"

using namespace ricochet;
using Catch::Contains;

namespace {

constexpr int kCases = 9;
const std::string kBad = "0000abc004";
const PluginIdentity kPlugin{"contact", "crashes", "/there/contact-crashes.so"};

[[gnu::noinline]] int overflow(int depth) {
  volatile int room[1000] = {};
  room[depth % 1000] = depth;
  return depth < 0 ? 0 : overflow(depth + 1) + room[7];
}

void misbehave(const std::string& how) {
  if (how == "segv") *static_cast<volatile int*>(nullptr) = 1;
  if (how == "fpe") ::raise(SIGFPE);
  if (how == "abort") std::abort();
  if (how == "exit") std::exit(0);
  if (how == "quick_exit") std::quick_exit(7);
  if (how == "overflow") static_cast<void>(overflow(1));
  if (how == "loop")
    for (volatile bool go = true; go;) {
    }
  if (how == "sleep")
    for (;;) ::pause();
}

/// One bad plugin: what it does, in which function, in which case; "" for a plugin that was mended since.
struct Bad {
  std::string how, function = "solve";
  double budget = 0;  ///< s, of every case; 0: none
  bool in_plugin = true;
  std::string library = "version 1";
  int jobs = 1;
  StudyPart part = {};
};

Study nine_cases(const Bad& bad) {
  Study study = fake_study(kCases);
  study.resolved["scene"] = Json::object();
  if (bad.budget > 0)
    for (StudyCase& one : study.cases) one.settings = {{"budget", bad.budget}};
  return study;
}

int run_here(const Bad& bad, const ScratchFolder& scratch, bool fresh = false) {
  FakeRun fake(scratch);
  StudyRunner& runner = fake.runner;
  const auto call = [&](const StudyCase& one, const char* function) {
    if (one.id != kBad || bad.function != function) return;
    std::optional<PluginCallScope> scope;
    if (bad.in_plugin) scope.emplace(kPlugin, function);
    write_text(scratch / "inside", "");
    misbehave(bad.how);
  };
  runner.plan = [&](const StudyCase& one) {
    call(one, "plan");
    return CasePlan{};
  };
  runner.cases.run = [&](const StudyCase& one, const std::atomic<bool>& stop) {
    ::usleep(10000);
    if (stop) throw Interrupted{};
    call(one, "solve");
    return fake_result(one);
  };
  runner.cases.open = [&](const MotionShelf& shelf, const std::atomic<bool>&) {
    const Study study = nine_cases(bad);
    if (shelf.failed(kBad)) return;
    const CaseScope blamed(shelf.ticket(*find_case(study, kBad)));
    call(*find_case(study, kBad), "open");
  };
  runner.cases.time = nullptr;
  write_text(scratch / "plugin.so", bad.library);
  runner.libraries = [&](const StudyCase&) { return std::vector<std::filesystem::path>{scratch / "plugin.so"}; };
  runner.out = std::fopen((scratch / "out.txt").c_str(), "w");
  runner.messages = stderr;
  return run_study_with(runner, nine_cases(bad),
                        {.out = scratch / "out", .jobs = bad.jobs, .fresh = fresh, .part = bad.part});
}

struct Ended {
  int code = 0;  ///< the exit code, or minus the signal
  std::string messages;
};

bool wait_for(const std::function<bool()>& condition) {
  constexpr int tries = 20000;
  for (int i = 0; i < tries; ++i) {
    if (condition()) return true;
    ::usleep(10000);
  }
  return false;
}

/// A run in a process of its own, which is sent SIGINT when `interrupt` comes true, where there is one.
Ended run(const Bad& bad, const ScratchFolder& scratch, const std::function<bool()>& interrupt = nullptr,
          bool fresh = false) {
  const pid_t child = ::fork();
  if (child == 0) {
    for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGINT, SIGTERM}) ::signal(signal, SIG_DFL);
    const int descriptor = ::open((scratch / "messages").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    ::dup2(descriptor, STDOUT_FILENO);
    ::dup2(descriptor, STDERR_FILENO);
    ::alarm(240);  // a run that hangs after all, on a loaded machine
    ::_exit(run_here(bad, scratch, fresh));
  }
  if (interrupt && wait_for(interrupt)) ::kill(child, SIGINT);
  int status = 0;
  ::waitpid(child, &status, 0);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status), read_text(scratch / "messages")};
}

void check_only_bad_failed(const ScratchFolder& scratch, const std::string& reason) {
  const StudyResults results = read_store(scratch / "out");
  REQUIRE(results.cases.size() == kCases);
  for (const CaseRecord& record : results.cases) {
    INFO(record.id << ": " << record.reason);
    CHECK(record.status == (record.id == kBad ? "failed" : "done"));
    if (record.id != kBad) continue;
    CHECK_THAT(record.reason, Contains(reason));
    CHECK(record.axes.size() == 2);
  }
  CHECK(std::filesystem::exists(scratch / "out/failures" / (kBad + ".json")));
  CHECK_THAT(read_text(scratch / "out/cases.csv"), Contains(kBad) && Contains("failed"));
  CHECK_FALSE(std::filesystem::exists(scratch / "out/crash.txt"));
}

}  // namespace

TEST_CASE("bad plugins: one that ends the program is named, and the next run keeps its case as failed and goes on") {
  const auto [how, signal, words] = GENERATE(table<std::string, int, std::string>({
      {"segv", SIGSEGV, "signal 11 (segmentation fault)"},
      {"overflow", SIGSEGV, "signal 11 (segmentation fault)"},
      {"abort", SIGABRT, "signal 6 (abort)"},
      {"fpe", SIGFPE, "signal 8 (arithmetic exception)"},
      {"exit", 0, "a call of exit()"},
      {"quick_exit", 0, "a call of exit()"},
  }));
  const auto [function, jobs] = GENERATE(table<std::string, int>({{"solve", 1}, {"solve", 3}, {"plan", 2}}));
  CAPTURE(how, function, jobs);
  const ScratchFolder scratch;
  Bad bad{how, function};
  bad.jobs = jobs;
  const Ended first = run(bad, scratch);
  CHECK(first.code == (signal != 0 ? -signal : 3));
  CHECK_THAT(first.messages, Contains("ricochet: plugin contact 'crashes' (/there/contact-crashes.so), " + function +
                                      "(): ended by " + words + " in case " + kBad + "; run the same command again"));
  const Ended second = run(bad, scratch);
  INFO(second.messages);
  CHECK(second.code == 3);
  CHECK_THAT(second.messages, Contains("case " + kBad + " is kept as failed: plugin contact 'crashes'"));
  check_only_bad_failed(scratch, "plugin contact 'crashes' (/there/contact-crashes.so) ended the program by " + words +
                                     " in " + function + "() (an earlier run)");
  const Ended third = run(bad, scratch);
  CHECK(third.code == 3);
  CHECK_THAT(third.messages, Contains("0 to run"));

  // Another plugin, or --fresh: the case runs again.
  bad.library = "version 2";
  bad.how = "";
  CHECK(run(bad, scratch).code == 0);
  bad.how = how;
  CHECK(run(bad, scratch, nullptr, true).code == first.code);
}

TEST_CASE("bad plugins: a crash of a plugin that is rebuilt before the next run is forgotten") {
  const ScratchFolder scratch;
  Bad bad{"segv"};
  REQUIRE(run(bad, scratch).code == -SIGSEGV);
  bad.library = "version 2";
  bad.how = "";
  const Ended second = run(bad, scratch);
  CHECK(second.code == 0);
  CHECK_THAT(second.messages, !Contains("kept as failed"));
}

TEST_CASE("bad plugins: a crash outside of any plugin names the case and blames nobody") {
  const ScratchFolder scratch;
  Bad bad{"segv"};
  bad.in_plugin = false;
  const Ended first = run(bad, scratch);
  CHECK(first.code == -SIGSEGV);
  CHECK_THAT(first.messages,
             Contains("ricochet: ended by signal 11 (segmentation fault) in case " + kBad + ", outside of any"));
  CHECK(run(bad, scratch).code == 3);
  check_only_bad_failed(scratch, "outside of any plugin's function");
}

TEST_CASE("bad plugins: after a kill nothing is failed, and what was under way is told and runs again") {
  const ScratchFolder scratch;
  Bad bad{"sleep"};
  const pid_t child = ::fork();
  if (child == 0) ::_exit(run_here(bad, scratch));
  const auto stored = [&]() -> std::size_t {
    try {
      return read_store(scratch / "out").cases.size();
    } catch (const StoreError&) {
      return 0;  // not there yet, or not yet whole
    }
  };
  REQUIRE(wait_for([&] { return stored() == 4 && std::filesystem::exists(scratch / "inside"); }));
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  bad.how = "";
  const Ended second = run(bad, scratch);
  CHECK(second.code == 0);
  CHECK_THAT(second.messages, Contains("an earlier run ended while " + kBad + " was under way: run again"));
  CHECK(read_store(scratch / "out").cases.size() == kCases);
}

TEST_CASE("bad plugins: one that never returns is failed once the budget is spent, and the others go on") {
  const std::string how = GENERATE("loop", "sleep"), function = GENERATE("solve", "plan");
  if (how == "sleep" && function == "plan") return;
  CAPTURE(how, function);
  const ScratchFolder scratch;
  Bad bad{how, function, 0.5};
  bad.jobs = 2;
  const Ended only = run(bad, scratch);
  INFO(only.messages);
  CHECK(only.code == 3);
  check_only_bad_failed(scratch, "plugin contact 'crashes' (/there/contact-crashes.so) did not return from " +
                                     function + "() within the budget of 0.5 s");
}

TEST_CASE("bad plugins: a part is not kept from its cases by one of another part") {
  const std::string function = GENERATE("plan", "open"), how = GENERATE("loop", "segv");
  CAPTURE(function, how);
  int without = 0;
  for (int number = 1; number <= 3; ++number) {
    const ScratchFolder scratch;
    Bad bad{how, function, how == "loop" ? 0.5 : 0};
    bad.part = {number, 3};
    Ended ended = run(bad, scratch);
    if (how == "segv") {
      CHECK(ended.code == -SIGSEGV);
      ended = run(bad, scratch);
    }
    INFO(ended.messages);
    const StudyResults results = read_store(scratch / "out");
    CHECK(results.cases.size() == kCases / 3);
    const bool own = std::any_of(results.cases.begin(), results.cases.end(),
                                 [](const CaseRecord& record) { return record.id == kBad; });
    without += own ? 0 : 1;
    for (const CaseRecord& record : results.cases) CHECK(record.status == (record.id == kBad ? "failed" : "done"));
    CHECK(ended.code == (own ? 3 : 0));
  }
  CHECK(without == 2);
}

TEST_CASE("bad plugins: Ctrl-C names the call that never returns, keeps what is finished, and ends with 130") {
  const std::string function = GENERATE("solve", "plan");
  CAPTURE(function);
  const ScratchFolder scratch;
  Bad bad{"loop", function};
  const Ended only = run(bad, scratch, [&] { return std::filesystem::exists(scratch / "inside"); });
  INFO(only.messages);
  CHECK(only.code == 130);
  CHECK_THAT(only.messages, Contains("case " + kBad +
                                     " is left where it is: plugin contact 'crashes' "
                                     "(/there/contact-crashes.so), " +
                                     function + "() has not returned for ") &&
                                Contains("interrupted: "));
  CHECK(read_store(scratch / "out").cases.size() == (function == "solve" ? 4 : 0));
  bad.how = "";
  CHECK(run(bad, scratch).code == 0);
}

TEST_CASE("bad plugins: a call that takes long is told by case, plugin and function") {
  const ScratchFolder scratch;
  const Bad bad{"sleep"};
  const Ended only = run(bad, scratch, [&] {
    return read_text(scratch / "messages").find("solve() has not returned for") != std::string::npos;
  });
  CHECK(only.code == 130);
  CHECK_THAT(only.messages, Contains("waiting for case " + kBad) && Contains("plugin contact 'crashes'") &&
                                Contains("solve() has not returned for"));
  CHECK_THAT(only.messages, !Contains(" left\n"));
}
