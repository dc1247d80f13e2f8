#include <unistd.h>

#include <array>
#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <ricochet/loader/child.hpp>
#include <thread>
#include <vector>

using namespace ricochet;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;
using End = ChildOutcome::End;

namespace {

constexpr double long_enough = 600;  // s: no child here needs a second of a processor
// Until then a child has begun, whatever else the machine does.
constexpr double soon = 1;

const PluginIdentity mine{"time", "mine", "here.so"}, first{"mass", "first", ""};

ChildOutcome asked(const std::function<void()>& act, double seconds = long_enough) {
  return run_in_child(
      [&] {
        const PluginCallScope scope(mine, "plan");
        act();
        return std::string("came back");
      },
      seconds);
}

[[gnu::noinline]] int overflow(int depth) {
  volatile char frame[4096];
  frame[0] = static_cast<char>(depth);
  return depth == -1 ? frame[0] : overflow(depth + 1) + frame[0];
}

}  // namespace

TEST_CASE("a child's value comes back, whatever its size and bytes") {
  const std::string text =
      GENERATE(std::string(), std::string("sound"), std::string("a\0b", 3), std::string(1 << 20, 'x'));
  const ChildOutcome outcome = run_in_child([&] { return text; }, long_enough);
  CHECK(outcome.ok());
  CHECK(outcome.text == text);
  CHECK(outcome.cause().empty());
}

TEST_CASE("what a child throws comes back as its text") {
  const ChildOutcome thrown =
      run_in_child([]() -> std::string { throw std::runtime_error("no licence"); }, long_enough);
  CHECK(thrown.end == End::exception);
  CHECK(thrown.sentence() == "no licence");
  const ChildOutcome odd = run_in_child([]() -> std::string { throw 42; }, long_enough);
  CHECK(odd.end == End::exception);
  CHECK(odd.sentence() == "an exception that says nothing");
}

TEST_CASE("a child that does not return says which plugin's function it was in") {
  const std::string place = "plugin time 'mine' (here.so), plan(): ";
  SECTION("a signal") {
    const auto [number, name] = GENERATE(table<int, std::string>({{SIGSEGV, "segmentation fault"},
                                                                  {SIGABRT, "aborted"},
                                                                  {SIGFPE, "floating point exception"},
                                                                  {SIGKILL, "killed"}}));
    const ChildOutcome outcome = asked([signal = number] { ::raise(signal); });
    CHECK(outcome.end == End::signal);
    CHECK(outcome.number == number);
    CHECK(outcome.sentence() == place + "ended by signal " + std::to_string(number) + " (" + name + ")");
  }
  SECTION("a stack that overflows") {
    const ChildOutcome outcome = asked([] { overflow(0); });
    CHECK(outcome.sentence() == place + "ended by signal 11 (segmentation fault)");
  }
  SECTION("an exit, whatever code it gives") {
    const int code = GENERATE(0, 7);
    const bool at_once = GENERATE(false, true);
    const ChildOutcome outcome = asked([&] { at_once ? ::_exit(code) : std::exit(code); });
    CHECK(outcome.end == End::exit);
    CHECK(outcome.sentence() == place + "ended the process with exit code " + std::to_string(code));
  }
  SECTION("a loop without end") {
    const ChildOutcome outcome = asked(
        [] {
          for (std::atomic<int> k = 0;; ++k) {
          }
        },
        soon);
    CHECK(outcome.end == End::timeout);
    CHECK(outcome.sentence() == place + "did not end within 1 s");
  }
  SECTION("a loop that no signal ends") {
    const ChildOutcome outcome = asked(
        [] {
          for (int one = 1; one < NSIG; ++one) std::signal(one, SIG_IGN);
          sigset_t all;
          sigfillset(&all);
          ::sigprocmask(SIG_BLOCK, &all, nullptr);
          for (;;) ::pause();
        },
        soon);
    CHECK(outcome.sentence() == place + "did not end within 1 s");
  }
}

TEST_CASE("outside of a plugin's function a child's end names none") {
  const ChildOutcome outcome = run_in_child([]() -> std::string { std::abort(); }, long_enough);
  CHECK(outcome.sentence() == "ended by signal 6 (aborted)");
  CHECK(outcome.call.function.empty());
}

TEST_CASE("a child that ends after a plugin's function has returned names it as the last one") {
  const ChildOutcome outcome = run_in_child(
      []() -> std::string {
        {
          const PluginCallScope outer(first, "build");
          const PluginCallScope inner(mine, "plan");
        }
        std::abort();
      },
      long_enough);
  // Of calls within calls the outer one is under way again.
  CHECK(outcome.sentence() == "plugin mass 'first', after build(): ended by signal 6 (aborted)");
  CHECK(outcome.call.serial == 0);
}

TEST_CASE("the last of many plugins and functions is named, however many came before") {
  static std::vector<PluginIdentity> many;
  static std::vector<std::string> functions;
  for (int k = 0; k < 100; ++k) {
    many.push_back({"time", "p" + std::to_string(k), ""});
    functions.push_back("f" + std::to_string(k));
  }
  const std::size_t last = GENERATE(0, 7, 8, 31, 32, 99);
  const ChildOutcome outcome = run_in_child(
      [&]() -> std::string {
        for (std::size_t k = 0; k <= last; ++k) const PluginCallScope scope(many[k], functions[k].c_str());
        const PluginCallScope again(many[last / 2], functions[last / 2].c_str());
        std::abort();
      },
      long_enough);
  const std::string number = std::to_string(last / 2);
  CHECK(outcome.sentence() == "plugin time 'p" + number + "', f" + number + "(): ended by signal 6 (aborted)");
}

TEST_CASE("a child that takes too much memory is told as such") {
#ifndef RICOCHET_SANITIZED
  constexpr double allowed = 64 << 20;
  const ChildOutcome outcome = run_in_child({.work = []() -> std::string {
                                               const PluginCallScope scope(mine, "solve");
                                               for (std::vector<char*> all;;) all.push_back(new char[1 << 20]);
                                             },
                                             .seconds = long_enough,
                                             .memory = allowed});
  CHECK(outcome.end == End::memory);
  CHECK(outcome.sentence() ==
        "plugin time 'mine' (here.so), solve(): took more than the 64 MiB of memory that it may take");
#endif
}

TEST_CASE("what a child leaves running, or does to descriptors, keeps nobody waiting") {
  SECTION("a process that it began") {
    const ChildOutcome outcome = run_in_child(
        [] {
          const pid_t left = ::fork();
          if (left == 0)
            for (;;) ::pause();
          return std::to_string(left);
        },
        long_enough);
    REQUIRE(outcome.ok());
    // It is of the child's group, which ends with it. Init may take its time to take note.
    const pid_t left = std::stoi(outcome.text);
    while (::kill(left, 0) == 0) ::usleep(1000);
  }
  SECTION("descriptors of this process") {
    int ends[2];
    REQUIRE(::pipe(ends) == 0);
    const ChildOutcome outcome = run_in_child(
        [&] {
          const bool there = ::write(ends[1], "x", 1) == 1;
          for (int one = 3; one < 1000; ++one) ::close(one);
          return std::string(there ? "there" : "not there");
        },
        long_enough);
    CHECK_FALSE(outcome.ok());  // its own way to say something is closed as well
    ::close(ends[1]);
    char one = 0;
    CHECK(::read(ends[0], &one, 1) == 0);
    ::close(ends[0]);
  }
}

TEST_CASE("what comes after a child's value is told apart from it") {
  const auto after = [](std::function<void()> act) {
    return run_in_child({.work = [] { return std::string("value"); }, .seconds = long_enough, .afterwards = act});
  };
  const ChildOutcome well = after([] {});
  CHECK(well.text == "value");
  CHECK(well.afterwards.empty());
  const ChildOutcome ended = after([] { ::raise(SIGSEGV); });
  CHECK(ended.text == "value");
  CHECK(ended.afterwards == "ended by signal 11 (segmentation fault)");
  const ChildOutcome left = after([] { ::_exit(4); });
  CHECK(left.afterwards == "ended the process with exit code 4");
  const ChildOutcome late = after([] {
    for (;;) ::pause();
  });
  CHECK(late.text == "value");
  CHECK(late.afterwards == "did not end within 3 s");
}

TEST_CASE("what a child does to its process is not done to this one") {
  static int value = 1;
  static bool tidied = false;
  std::atexit([] { tidied = true; });
  std::cout << "" << std::flush;
  const ChildOutcome outcome = run_in_child(
      [] {
        value = 2;
        std::cout << "a plugin's chatter\n" << std::flush;
        return std::string("done");
      },
      long_enough);
  CHECK(outcome.ok());
  CHECK(value == 1);
  CHECK_FALSE(tidied);
}

TEST_CASE("children are waited for from several threads at once") {
  std::vector<std::thread> threads;
  std::array<std::string, 8> texts;
  for (std::size_t k = 0; k < texts.size(); ++k)
    threads.emplace_back([&, k] { texts[k] = run_in_child([k] { return std::to_string(k); }, long_enough).text; });
  for (std::thread& thread : threads) thread.join();
  for (std::size_t k = 0; k < texts.size(); ++k) CHECK(texts[k] == std::to_string(k));
}
