#include <unistd.h>

#include <array>
#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <csignal>
#include <cstdlib>
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

const PluginIdentity mine{"time", "mine", "here.so"};

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
    // Nothing is left to say anything after SIGKILL.
    CHECK(outcome.sentence() ==
          (number == SIGKILL ? "" : place) + "ended by signal " + std::to_string(number) + " (" + name + ")");
  }
  SECTION("a stack that overflows") {
    const ChildOutcome outcome = asked([] { overflow(0); });
    CHECK(outcome.sentence() == place + "ended by signal 11 (segmentation fault)");
  }
  SECTION("an exit, whatever code it gives") {
    const int code = GENERATE(0, 7);
    const ChildOutcome outcome = asked([&] { std::exit(code); });
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
          std::signal(SIGALRM, SIG_IGN);
          for (;;) ::pause();
        },
        soon);
    CHECK(outcome.sentence() == "did not end within 1 s");
  }
}

TEST_CASE("outside of a plugin's function a child's end names none") {
  const ChildOutcome outcome = run_in_child([]() -> std::string { std::abort(); }, long_enough);
  CHECK(outcome.sentence() == "ended by signal 6 (aborted)");
  CHECK(outcome.function.empty());
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
