// What a third-party library does to its process, seen from outside: what each command prints and ends with.
#include <signal.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>

#include "tests/places.hpp"
#include "tests/runners/command/said.hpp"
#include "tests/runners/same_tables.hpp"
#include "tests/runners/scratch_folder.hpp"
#include "tests/runners/variable.hpp"
#include "tests/runners/workers/quick_studies.hpp"

using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;
using ricochet::tests::places;
namespace fs = std::filesystem;

namespace {

const std::string library = places().unruly + "/contact-unruly.so";

CommandOutput in_shell(const ScratchFolder& here, const std::string& line) {
  const std::string out = (here / ".out").string(), err = (here / ".err").string();
  const int status = std::system(
      ("cd '" + here.path().string() + "' && (" + line + ") >'" + out + "' 2>'" + err + "' </dev/null").c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_text(out), read_text(err)};
}

/// The command in a folder, with the unruly library beside its own.
CommandOutput unruly(const ScratchFolder& here, const std::string& words, const std::string& does = "") {
  const Variable wish("RICOCHET_TEST_UNRULY", does), left("RICOCHET_TEST_LEFT", (here / "left").string());
  return in_shell(here, "RICOCHET_PLUGIN_PATH='" + places().unruly + "' '" + places().command + "' " + words);
}

/// Two cases of the unruly law and two of another one, of some 100 steps each.
quick_studies::Json small_study(const std::string& law = "unruly") {
  return quick_studies::Json::parse(R"({
    "name": "small", "question": "Does it go on?", "kind": "trajectory",
    "scene": {"structure": {"type": "oscillator", "mass": 1, "stiffness": 1, "damping": 0.01,
                            "force": {"amplitude": 1, "pulsation": 2.2, "phase": 0}},
              "stops": {"lower": -0.1, "upper": 0.1}, "initial": {"displacement": 0, "velocity": 1}},
    "methods": {"mass": "consistent", "contact": [")" +
                                    law + R"(", {"name": "penalty", "stiffness": 1e5}],
                "time": "newmark-dumont-paoli"},
    "step": [1e-2, 5e-3], "duration": 1, "samples": 20, "budget": 2})");
}

CommandOutput run_unruly(const ScratchFolder& here, const std::string& does, const std::string& options = "") {
  write_text(here / "small.json", small_study().dump());
  return unruly(here, "run small.json --jobs 2 --table --fresh --out out " + options, does);
}

same_tables::Rows cases_of(const ScratchFolder& here) {
  return same_tables::rows_of(here / "out/cases.csv");
}

/// Rows of other laws are done, those of the unruly one are as told.
void check_rows(const ScratchFolder& here, const std::string& status, const std::string& reason) {
  const auto rows = cases_of(here);
  REQUIRE(rows.size() == 4);
  for (const auto& row : rows) {
    const bool bad = row.at("contact") == "unruly";
    CHECK(row.at("status") == (bad ? status : "done"));
    if (bad && !reason.empty()) CHECK_THAT(row.at("reason"), Contains(reason));
  }
}

}  // namespace

TEST_CASE("unruly: what a library prints is on stderr, and what a command prints alone on stdout") {
  const std::string words =
      GENERATE(as<std::string>{}, "list", "schema", "describe unruly", "doctor", "run small.json --table --fresh",
               "plan small.json --cases", "check " + places().unruly + "/contact-unruly.so");
  const std::string moment = GENERATE("load", "register", "end");
  CAPTURE(words, moment);
  const ScratchFolder here;
  write_text(here / "small.json", small_study().dump());
  const auto without_times = [](std::string text) {
    // Durations, dates and what depends on them.
    return std::regex_replace(text, std::regex("[0-9.:-]+(e-?[0-9]+)?( ms| µs| s|T[0-9:]+Z)?|\\s+"), "");
  };
  const CommandOutput quiet = unruly(here, words), loud = unruly(here, words, moment + " print");
  INFO(loud.err);
  CHECK(loud.code == quiet.code);
  CHECK(without_times(loud.out) == without_times(quiet.out));
  CHECK_THAT(loud.err, Contains("printed") && Contains("streamed"));
}

TEST_CASE("unruly: static destructors that end the process, or never end, change no exit code and are told") {
  const auto [what, told] = GENERATE(table<std::string, std::string>({{"segv", "ended by signal 11"},
                                                                      {"abort", "ended by signal 6"},
                                                                      {"_exit", "ended the process with exit code 0"},
                                                                      {"deaf", "did not end within 3 s"}}));
  const std::string words = GENERATE("list", "run small.json --fresh", "run small.json --fresh --inline");
  if (what == "deaf" && words != "list") return;  // it is waited for
  CAPTURE(what, words);
  const ScratchFolder here;
  write_text(here / "small.json", small_study().dump());
  const CommandOutput ended = unruly(here, words, "end " + what);
  INFO(ended.err);
  CHECK(ended.code == 0);
  CHECK_THAT(ended.err, Contains(library + ": its static destructors: " + told));
}

TEST_CASE("unruly: a library that ends the process which loads it is told by list, and the others serve") {
  const auto [what, told] =
      GENERATE(table<std::string, std::string>({{"segv", "ended by signal 11 (segmentation fault)"},
                                                {"abort", "ended by signal 6 (aborted)"},
                                                {"kill", "ended by signal 9 (killed)"},
                                                {"_exit", "ended the process with exit code 0"},
                                                {"close", "ended the process with exit code 1"},
                                                {"junk", "ended the process with exit code 0"},
                                                {"leak", "took more than the 4 GiB of memory that it may take"}}));
  const std::string moment = GENERATE("load", "register");
  CAPTURE(what, moment);
#ifdef RICOCHET_SANITIZED
  if (what == "leak") return;
#endif
  if (what == "leak" && moment == "load") return;  // seconds each
  const ScratchFolder here;
  const CommandOutput listed = unruly(here, "list contact", moment + " " + what);
  CHECK(listed.code == 4);
  CHECK_THAT(listed.out,
             Contains("cannot be used: " + library + ": " + told + " while it was loaded") && Contains("signorini"));
}

TEST_CASE("unruly: an environment that is cleared, a thread that crashes later, a process that stays") {
  const std::string moment = GENERATE("load", "register");
  const std::string what = GENERATE("clear", "thread", "fork");
  CAPTURE(moment, what);
  const ScratchFolder here;
  const CommandOutput listed = unruly(here, "list", moment + " " + what);
  CHECK(listed.code == 0);
  CHECK_THAT(listed.out, Contains("unruly"));
  const CommandOutput ran = run_unruly(here, moment + " " + what);
  INFO(ran.out << ran.err);
  // A worker whose thread crashes is lost, whether it has opened the study, runs a case or is done by then.
  CHECK((ran.code == 0 || (what == "thread" && (ran.code == 3 || ran.code == 4))));
  if (ran.code == 0) check_rows(here, "done", "");
  if (ran.code == 4) CHECK_THAT(ran.err, Contains("third-party libraries in it: " + library));
}

TEST_CASE("unruly: a library that crashes where it is loaded once more is named, with exit code 4") {
  const ScratchFolder here;
  const CommandOutput ran = run_unruly(here, "register second");
  INFO(ran.out << ran.err);
  CHECK(ran.code == 4);
  CHECK_THAT(ran.err, Contains("plugin contact 'unruly' (" + library + "), load(): ") &&
                          Contains("signal 11 (segmentation fault)"));
  CHECK_THAT(ran.err, !Contains("internal error"));
}

TEST_CASE("unruly: whatever ends a worker in a law, its case is failed and the law is named") {
  const auto [what, told] =
      GENERATE(table<std::string, std::string>({{"kill", "its process was ended twice by signal 9 (killed)"},
                                                {"_exit", "its process was ended twice by exit code 0"},
                                                {"exit", "its process was ended twice by a call of exit()"},
                                                {"deaf", "did not return from solve() within the budget of 2 s"}}));
  CAPTURE(what);
  const ScratchFolder here;
  const CommandOutput ran = run_unruly(here, "solve " + what);
  INFO(ran.out << ran.err);
  CHECK(ran.code == 3);
  check_rows(here, "failed", told);
  check_rows(here, "failed", "plugin contact 'unruly' (" + library + ")");
}

TEST_CASE("unruly: a law that stops its process is waited for once, for as long as a call may last") {
  const ScratchFolder here;
  const auto begun = std::chrono::steady_clock::now();
  const CommandOutput ran = run_unruly(here, "solve stop");
  INFO(ran.out << ran.err);
  CHECK(ran.code == 3);
  check_rows(here, "failed",
             "plugin contact 'unruly' (" + library +
                 "), solve(): its process was stopped by a signal and was killed");
  // Two such cases with a budget of 2 s each; a silent process is waited for 60 s, twice.
  CHECK(std::chrono::steady_clock::now() - begun < std::chrono::seconds(60));
}

TEST_CASE("unruly: a thread that crashes outside of any function is told with the libraries that may have begun it") {
  const ScratchFolder here;
  // Longer than a thread takes to see it march.
  quick_studies::Json study = small_study();
  study["methods"]["contact"] = "unruly";
  study["step"] = 1e-6;
  study["duration"] = 10;
  study["budget"] = 60;
  write_text(here / "small.json", study.dump());
  const CommandOutput ran = unruly(here, "run small.json --jobs 1 --out out", "register waiting-thread");
  INFO(ran.out << ran.err);
  CHECK(ran.code == 3);
  const auto rows = cases_of(here);
  REQUIRE(rows.size() == 1);
  CHECK_THAT(rows[0].at("reason"), Contains("its process was ended twice by signal 11") && Contains(library));
}

TEST_CASE("unruly: a law that takes all memory is failed with memory as the cause, by the limit of its worker") {
#ifndef RICOCHET_SANITIZED
  const ScratchFolder here;
  write_text(here / "small.json", small_study().dump());
  const Variable does("RICOCHET_TEST_UNRULY", std::string("solve leak"));
  const CommandOutput ran = in_shell(here, "ulimit -v 1000000; RICOCHET_PLUGIN_PATH='" + places().unruly + "' '" +
                                               places().command + "' run small.json --jobs 2 --out out");
  INFO(ran.out << ran.err);
  CHECK(ran.code == 3);
  check_rows(here, "failed",
             "plugin contact 'unruly' (" + library +
                 "), solve(): its process was ended twice by want of memory: a worker may take 977 MiB");
#endif
}

TEST_CASE("a run with little memory ends, and says so where it is not enough") {
#ifndef RICOCHET_SANITIZED
  const int kilobytes = GENERATE(40000, 60000, 80000, 90000, 100000, 110000, 120000, 150000);
  const bool cut = GENERATE(false, true);
  CAPTURE(kilobytes, cut);
  const ScratchFolder here;
  write_text(here / "small.json", (cut ? quick_studies::study_of("bifurcation") : small_study("signorini")).dump());
  const CommandOutput ran = in_shell(here, "ulimit -v " + std::to_string(kilobytes) + "; RICOCHET_PLUGIN_PATH= '" +
                                               places().command + "' run small.json --isolate --jobs 2");
  INFO(ran.out << ran.err);
  // Below what the program itself needs the loader of the system ends it.
  CHECK((ran.code == 0 || ran.code == 3 || ran.code == 5 || ran.code == 127));
  if (ran.code == 3 || ran.code == 5) CHECK_THAT(ran.out + ran.err, Contains("memory"));
  CHECK_THAT(ran.err, !Contains("internal error") && !Contains("another program") && !Contains("terminate called"));
#endif
}

TEST_CASE("unruly: a process that a law leaves behind keeps no run waiting") {
  const ScratchFolder here;
  const CommandOutput ran = run_unruly(here, "solve fork");
  INFO(ran.out << ran.err);
  CHECK(ran.code == 0);
  check_rows(here, "done", "");
  std::ifstream left(here / "left");
  // Its group ended with the worker.
  for (int process = 0; left >> process;)
    while (::kill(process, 0) == 0) ::usleep(1000);
}

TEST_CASE("unruly: long texts of exceptions are cut where they are stored, between two characters") {
  const auto [what, letter] = GENERATE(table<std::string, std::string>({{"long", "L"}, {"accents", "é"}}));
  const ScratchFolder here;
  const CommandOutput ran = run_unruly(here, "solve " + what);
  CHECK(ran.code == 3);
  for (const auto& row : cases_of(here))
    if (row.at("contact") == "unruly") {
      const std::string reason = row.at("reason");
      CHECK(reason.size() < 2500);
      CHECK_THAT(reason, Contains(letter + letter + "…"));
    }
  CHECK(ran.out.size() < 20000);
  CHECK(fs::file_size(here / "out/report.html") < 4000000);
}

TEST_CASE("unruly: a point or a case is marched in a child as well") {
  const ScratchFolder here;
  REQUIRE(run_unruly(here, "").code == 0);
  const auto rows = cases_of(here);
  std::string id;
  for (const auto& row : rows)
    if (row.at("contact") == "unruly") id = row.at("case");
  const CommandOutput quiet = unruly(here, "case out " + id), loud = unruly(here, "case out " + id, "load print");
  CHECK(quiet.code == 0);
  CHECK(loud.code == 0);
  CHECK_THAT(loud.out, !Contains("printed") && Contains("case " + id));
  const CommandOutput ended = unruly(here, "case out " + id, "solve kill");
  CHECK(ended.code == 3);
  CHECK_THAT(ended.err, Contains("plugin contact 'unruly' (" + library + "), solve(): ended by signal 9 (killed)"));
  const CommandOutput wrong = unruly(here, "case out c99");
  CHECK(wrong.code == 2);
}

TEST_CASE("an output that cannot be written is exit code 5, whatever the command") {
  const std::string words = GENERATE(as<std::string>{}, "list", "schema", "doctor", "describe signorini", "help",
                                     "--version", "run small.json --fresh", "run small.json --fresh --table",
                                     "plan small.json", "report out", "status out");
  const std::string where = GENERATE(">/dev/full", ">&-");
  CAPTURE(words, where);
  const ScratchFolder here;
  write_text(here / "small.json", small_study("signorini").dump());
  REQUIRE(unruly(here, "run small.json --out out").code == 0);
  CHECK(unruly(here, words + " " + where).code == 5);
}

TEST_CASE("what is no file is refused at once, wherever a file is asked for") {
  const ScratchFolder here;
  write_text(here / "small.json", small_study("signorini").dump());
  REQUIRE(unruly(here, "run small.json --out out").code == 0);
  const std::string what = GENERATE("pipe", "socket", "folder", "device");
  CAPTURE(what);
  const auto put = [&](const std::string& name) {
    const fs::path file = here / name;
    fs::remove_all(file);
    if (what == "pipe") REQUIRE(::mkfifo(file.c_str(), 0600) == 0);
    if (what == "folder") fs::create_directory(file);
    if (what == "device") fs::create_symlink("/dev/zero", file);
    if (what == "socket") {
      const int end = ::socket(AF_UNIX, SOCK_STREAM, 0);
      sockaddr_un name_of{};
      name_of.sun_family = AF_UNIX;
      file.string().copy(name_of.sun_path, sizeof name_of.sun_path - 1);
      REQUIRE(::bind(end, reinterpret_cast<const sockaddr*>(&name_of), sizeof name_of) == 0);
      ::close(end);
    }
  };
  put("study.json");
  CHECK(unruly(here, "run study.json").code == 2);
  CHECK(unruly(here, "plan study.json").code == 2);
  put("plan.json");
  CHECK(unruly(here, "describe plan.json").code != 0);
  CHECK(unruly(here, "list --plugin plan.json").code == 4);
  put("lib.so");
  CHECK(unruly(here, "list --plugin lib.so").code == 4);
  put("out/results.sqlite");
  for (const std::string words : {"run small.json --out out", "run small.json --out out --fresh", "report out",
                                  "status out", "export out --to csv", "case out c1"})
    CHECK(unruly(here, words).code == 5);
}
