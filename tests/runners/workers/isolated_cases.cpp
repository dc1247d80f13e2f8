/// Cases in worker processes: the same results as in one process, whatever a plugin or another program does to the
/// workers.
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "runners/store/atomic_file.hpp"
#include "tests/places.hpp"
#include "tests/runners/same_tables.hpp"
#include "tests/runners/scratch_folder.hpp"
#include "tests/runners/workers/linger.hpp"
#include "tests/runners/workers/quick_studies.hpp"

using ricochet::tests::places;
using namespace quick_studies;
using namespace same_tables;
using Catch::Contains;
using Catch::Matchers::Matches;
namespace fs = std::filesystem;

namespace {

#ifdef RICOCHET_SANITIZED
constexpr bool sanitized = true;
#else
constexpr bool sanitized = false;
#endif

struct Ended {
  int code = 0;
  std::string out, messages;
};

std::string command_line(const ScratchFolder& scratch, const Json& study, const std::string& out,
                         const std::string& options) {
  write_text(scratch / (out + ".json"), study.dump());
  return "'" + places().command + "' run '" + (scratch / (out + ".json")).string() + "' --jobs 2 --out '" +
         (scratch / out).string() + "' " + options + " >'" + (scratch / "said").string() + "' 2>'" +
         (scratch / "told").string() + "' </dev/null";
}

Ended run(const ScratchFolder& scratch, const Json& study, const std::string& out, const std::string& options) {
  const int status = std::system(("RICOCHET_PLUGIN_PATH= " + command_line(scratch, study, out, options)).c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_text(scratch / "said"), read_text(scratch / "told")};
}

}  // namespace

TEST_CASE("workers: every kind of study has in them the tables that it has in one process") {
  const std::string kind =
      GENERATE("trajectory", "convergence", "work-precision", "stability", "bifurcation", "basins");
  CAPTURE(kind);
  const ScratchFolder scratch;
  const Json study = study_of(kind);
  const Ended here = run(scratch, study, "here", "--inline");
  INFO(here.messages);
  REQUIRE(here.code == 0);
  const Ended workers = run(scratch, study, "workers", "--isolate");
  INFO(workers.messages);
  CHECK(workers.code == 0);
  check_same(scratch / "here", scratch / "workers", kind == "work-precision");
}

TEST_CASE("workers: an orbit that ends its process twice is a failed row with the reason, and no other row changes") {
  const auto [how, cause] = GENERATE(table<std::string, std::string>({
      {"segv", "solve\\(\\): its process was ended twice by signal 11 \\(segmentation fault\\); it wrote: too deep.*"},
      {"abort", "solve\\(\\): its process was ended twice by signal 6 \\(aborted\\); it wrote: too deep for me"},
      {"exit", "solve\\(\\): its process was ended twice by exit code 7; it wrote: too deep for me"},
      {"kill", "solve\\(\\): its process was ended twice by signal 9 \\(killed\\); it wrote: too deep for me"},
      {"greedy",
       "solve\\(\\): its process was ended twice by want of memory: a worker may take [0-9.]+ GiB; it wrote: too deep "
       "for me"},
  }));
  CAPTURE(how);
  // The sanitizer's own memory goes beyond any limit: workers have none under it.
  if (how == "greedy" && sanitized) return;
  const ScratchFolder scratch;
  const std::string options = "--isolate --plugin '" + places().stumbling + "'";
  const Ended sound = run(scratch, stumbling("none", 7e-3), "sound", options);
  INFO(sound.messages);
  REQUIRE(sound.code == 0);
  const Ended ended = run(scratch, stumbling(how, 7e-3), "ended", options);
  INFO(ended.messages << ended.out);
  CHECK(ended.code == 3);
  CHECK_THAT(ended.out, Contains("the process of an orbit ended"));
  const Rows before = rows_of(scratch / "sound/values.csv"), after = rows_of(scratch / "ended/values.csv");
  REQUIRE(before.size() == after.size());
  std::size_t failed = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    std::map<std::string, std::string> was = before[i], is = after[i];
    for (const char* column : {"case", "contact.how"}) was[column] = is[column];
    if (is["status"] != "failed") {
      CHECK(was == is);
      continue;
    }
    ++failed;
    CHECK(is["start"] == was["start"]);
    CHECK_THAT(is["reason"], Matches("period [0-9]+: .*" + cause));
  }
  // Hard impacts are rare here: some orbits ended, most did not.
  CHECK(failed > 0);
  CHECK(failed < before.size() / 2);
}

TEST_CASE("workers: a case that ends its process twice is failed, and the others are done, in every run") {
  const auto [how, cause] = GENERATE(table<std::string, std::string>({{"segv", "signal 11 (segmentation fault)"},
                                                                      {"overflow", "signal 11 (segmentation fault)"},
                                                                      {"leave", "a call of exit()"}}));
  CAPTURE(how);
  if (how == "overflow" && sanitized) return;
  const ScratchFolder scratch;
  Json study = study_of("trajectory");
  study["methods"]["mass"] = "consistent";
  study["methods"]["contact"] = Json::parse(R"(["signorini", {"name": "stumbles", "beyond": 0}])");
  study["methods"]["contact"][1]["how"] = how;
  const Ended first = run(scratch, study, "out", "--plugin '" + places().stumbling + "'");
  INFO(first.messages << first.out);
  CHECK(first.code == 3);
  const Rows rows = rows_of(scratch / "out/cases.csv");
  REQUIRE(rows.size() == 4);
  for (const auto& row : rows) {
    const bool bad = row.at("contact") == "stumbles";
    CHECK(row.at("status") == (bad ? "failed" : "done"));
    if (bad)
      CHECK_THAT(row.at("reason"),
                 Contains("plugin contact 'stumbles'") && Contains("solve(): its process was ended twice by " + cause));
  }
  const Ended second = run(scratch, study, "out", "--plugin '" + places().stumbling + "'");
  CHECK(second.code == 3);
  CHECK_THAT(second.messages, Contains("0 to run"));
}

TEST_CASE("workers: of hundreds of small cases, which travel together, those that end their process alone are failed") {
  const ScratchFolder scratch;
  Json study = Json::parse(R"({"name": "small", "kind": "trajectory", "step": 0.01, "duration": 0.2, "scene": {
    "structure": {"type": "oscillator", "mass": 1}, "stops": {"lower": -0.1, "upper": 0.1}, "initial": {}},
    "methods": {"mass": "consistent", "contact": {"name": "stumbles"}, "time": "moreau-jean"}})");
  study["scene"]["structure"]["stiffness"] = {10, 11, 12};
  for (int i = 1; i <= 100; ++i) study["scene"]["initial"]["velocity"].push_back(0.05 * i);
  study["methods"]["contact"]["beyond"] = 4.9;  // at velocity level: m/s
  const std::string options = "--plugin '" + places().stumbling + "'";
  const Ended here = run(scratch, study, "here", "--inline " + options);
  INFO(here.messages);
  REQUIRE(here.code == 0);
  study["methods"]["contact"]["how"] = "segv";
  const Ended workers = run(scratch, study, "workers", options);
  INFO(workers.messages << workers.out);
  CHECK(workers.code == 3);
  const Rows sound = rows_of(scratch / "here/cases.csv"), rows = rows_of(scratch / "workers/cases.csv");
  REQUIRE(sound.size() == 300);
  REQUIRE(rows.size() == 300);
  std::size_t failed = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    std::map<std::string, std::string> was = sound[i];
    for (const char* column : {"case", "contact.how"}) was[column] = rows[i].at(column);
    if (rows[i].at("status") != "failed") {
      CHECK(was == rows[i]);
      continue;
    }
    ++failed;
    CHECK(was.at("initial.velocity") == rows[i].at("initial.velocity"));
    CHECK_THAT(rows[i].at("reason"), Contains("its process was ended twice by signal 11"));
  }
  CHECK(failed > 0);
  CHECK(failed < 10);
}

TEST_CASE("workers: a call that never returns costs its case the budget") {
  const ScratchFolder scratch;
  // The first touch never returns: what comes before it is a small part of the budget on any machine.
  Json study = stumbling("sleep", 0);
  study["budget"] = 1;
  const Ended ended = run(scratch, study, "out", "--isolate --plugin '" + places().stumbling + "'");
  INFO(ended.messages);
  CHECK(ended.code == 3);
  const Rows rows = rows_of(scratch / "out/cases.csv");
  REQUIRE(rows.size() == 1);
  CHECK_THAT(rows[0].at("reason"), Contains("did not return from solve() within the budget of 1 s"));
}

namespace {

/// A run in a process of its own.
class Running {
 public:
  Running(const ScratchFolder& scratch, const Json& study, const std::string& out,
          const std::string& options = std::string("--isolate") + lingering::plugin)
      : out_(scratch / out) {
    const std::string line = "exec env RICOCHET_PLUGIN_PATH= " + command_line(scratch, study, out, options);
    process_ = ::fork();
    if (process_ != 0) return;
    ::setpgid(0, 0);
    ::execl("/bin/sh", "sh", "-c", line.c_str(), nullptr);
    ::_exit(127);
  }
  ~Running() {
    if (process_ > 0) finish(SIGKILL);
  }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  bool ended() { return process_ < 0 || ::waitpid(process_, &status_, WNOHANG) == process_; }
  pid_t process() const { return process_; }
  /// Its workers.
  std::vector<pid_t> children() const {
    std::istringstream text(
        read_text("/proc/" + std::to_string(process_) + "/task/" + std::to_string(process_) + "/children"));
    std::vector<pid_t> all;
    for (pid_t one = 0; text >> one;) all.push_back(one);
    // Those that threads of it began.
    std::error_code gone;
    for (const auto& thread : fs::directory_iterator("/proc/" + std::to_string(process_) + "/task", gone)) {
      std::istringstream more(read_text(thread.path() / "children"));
      for (pid_t one = 0; more >> one;)
        if (std::find(all.begin(), all.end(), one) == all.end()) all.push_back(one);
    }
    return all;
  }
  /// Its workers while they march; none where it ended.
  std::vector<pid_t> marching() {
    std::vector<pid_t> all;
    lingering::comes_true([&] {
      if (lingering::marches(out_)) all = children();
      return !all.empty() || ended();
    });
    return all;
  }
  /// Sends a signal and waits; the exit code, or minus the signal.
  int finish(int signal = 0) {
    if (signal != 0) ::kill(process_, signal);
    ::waitpid(process_, &status_, 0);
    process_ = -1;
    return WIFEXITED(status_) ? WEXITSTATUS(status_) : -WTERMSIG(status_);
  }

 private:
  fs::path out_;
  pid_t process_ = -1;
  int status_ = 0;
};

}  // namespace

TEST_CASE("workers: a call that never returns is told by case, plugin and function, and Ctrl-C ends the run") {
  const ScratchFolder scratch;
  Json study = study_of("trajectory");
  study["methods"]["mass"] = "consistent";
  study["methods"]["contact"] = Json::parse(R"(["signorini", {"name": "stumbles", "how": "sleep", "beyond": 0}])");
  Running running(scratch, study, "out", "--plugin '" + places().stumbling + "'");
  const auto told = [&] { return read_text(scratch / "told"); };
  lingering::comes_true([&] { return told().find("solve() has not returned for") != std::string::npos; });
  CHECK_THAT(told(), Contains("waiting for case") && Contains("plugin contact 'stumbles'"));
  CHECK(running.finish(SIGINT) == 130);
  CHECK_THAT(told(), Contains("interrupted: 2 of 4"));
}

TEST_CASE("workers: one that another program kills costs nothing but time") {
  const ScratchFolder scratch;
  const Json study = lingering::study();
  REQUIRE(run(scratch, study, "here", std::string("--inline") + lingering::plugin).code == 0);
  for (std::size_t which = 0; which < 4; ++which) {
    CAPTURE(which);
    const std::string out = "killed-" + std::to_string(which);
    const lingering::Held held;
    Running running(scratch, study, out);
    const std::vector<pid_t> children = running.marching();
    REQUIRE_FALSE(children.empty());
    CHECK(::kill(children[which % children.size()], SIGKILL) == 0);
    held.let_go();
    CHECK(running.finish() == 0);
    check_same(scratch / "here", scratch / out);
  }
}

TEST_CASE("workers: a data file that changes under way ends the run and is named, put back it costs nothing") {
  const ScratchFolder scratch;
  const std::string table = "t,F\n0,0\n0.1,5\n0.2,5\n";
  // It stays pressed to the end, so that it lingers in hundreds of steps: a mass that bounces does in three.
  write_text(scratch / "force.csv", table);
  const Json study = Json::parse(R"({
    "name": "pushed", "kind": "trajectory",
    "scene": {"structure": {"type": "oscillator", "mass": 2, "stiffness": 100}, "stops": {"lower": -0.01},
              "load": [{"force": {"file": "force.csv", "value": "F", "factor": -1, "after": "hold"}}]},
    "methods": {"mass": "consistent", "contact": {"name": "stumbles", "how": "linger", "beyond": 0},
                "time": "moreau-jean"},
    "step": [1e-3, 5e-4, 2.5e-4, 2e-4], "duration": 0.4, "samples": 20})");
  REQUIRE(run(scratch, study, "here", std::string("--inline") + lingering::plugin).code == 0);
  const lingering::Held held;
  Running running(scratch, study, "out");
  // Small cases travel together: one worker may have all of them, and another none.
  const std::vector<pid_t> children = running.marching();
  REQUIRE_FALSE(children.empty());
  write_text(scratch / "force.csv", table + "0.3,6\n");
  for (const pid_t one : children) CHECK(::kill(one, SIGKILL) == 0);
  held.let_go();
  CHECK(running.finish() == 5);
  CHECK_THAT(read_text(scratch / "told"), Contains("force.csv has changed since the run began"));
  for (const auto& row : rows_of(scratch / "out/cases.csv")) CHECK(row.at("status") == "done");
  write_text(scratch / "force.csv", table);
  REQUIRE(run(scratch, study, "out", std::string("--isolate") + lingering::plugin).code == 0);
  check_same(scratch / "here", scratch / "out");
}

TEST_CASE("workers: a scheduler's warning reaches them as well, from their first moment on, and ends none of them") {
  const int signal = GENERATE(SIGUSR1, SIGTERM, SIGINT, SIGHUP);
  CAPTURE(signal);
  const ScratchFolder scratch;
  // An hour of orbits, which is stopped. Another plugin would be asked for plans in children that are no workers.
  Json study = longer();
  study["parameter"]["count"] = 401;
  study["steps_per_period"] = 400000;
  Running running(scratch, study, "out", "--isolate");
  std::set<pid_t> warned;
  constexpr int looks = 400;
  for (int look = 0; look < looks && !running.ended(); look += warned.empty() ? 0 : 1) {
    for (const pid_t one : running.children())
      if (::kill(one, signal) == 0) warned.insert(one);
    ::usleep(500);
  }
  REQUIRE_FALSE(running.ended());
  // One that is lost would have another in its place.
  for (const pid_t one : running.children()) warned.erase(one);
  CHECK(warned.empty());
  CHECK(running.finish(SIGINT) == 130);
}

TEST_CASE("workers: a run that is stopped or killed goes on to the same tables, and leaves no worker behind") {
  const int signal = GENERATE(SIGINT, SIGTERM, SIGUSR1, SIGKILL);
  CAPTURE(signal);
  const ScratchFolder scratch;
  const Json study = lingering::study();
  // For all signals once.
  static const ScratchFolder undisturbed;
  if (!fs::exists(undisturbed / "here"))
    REQUIRE(run(undisturbed, study, "here", std::string("--inline") + lingering::plugin).code == 0);
  std::vector<pid_t> children;
  {
    const lingering::Held held;
    Running running(scratch, study, "out");
    children = running.marching();
    REQUIRE_FALSE(running.ended());
    CHECK(running.finish(signal) == (signal == SIGKILL ? -SIGKILL : 130));
  }
  CHECK_FALSE(children.empty());
  CHECK(lingering::comes_true(
      [&] { return std::none_of(children.begin(), children.end(), [](pid_t one) { return ::kill(one, 0) == 0; }); }));
  const Ended again = run(scratch, study, "out", std::string("--isolate") + lingering::plugin);
  INFO(again.messages);
  CHECK(again.code == 0);
  if (signal == SIGKILL)
    CHECK_THAT(again.messages, Matches("[^]*an earlier run ended while .* under way: run again[^]*"));
  check_same(undisturbed / "here", scratch / "out");
  const Ended kept = run(scratch, study, "out", std::string("--inline") + lingering::plugin);
  CHECK_THAT(kept.messages, Contains("0 to run"));
}
