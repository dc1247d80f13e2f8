// A spring at the stops that does to its process what RICOCHET_TEST_UNRULY says, "MOMENT WHAT": as it is loaded, as it
// registers, in solve(), or as the process ends.
#include <signal.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <ricochet/contract/plugin.hpp>
#include <stdexcept>
#include <string>
#include <thread>

using namespace ricochet;

namespace {

[[noreturn]] void forever() {
  for (;;) ::pause();
}

void be_deaf() {
  sigset_t all;
  sigfillset(&all);
  ::sigprocmask(SIG_BLOCK, &all, nullptr);
  for (int one = 1; one < NSIG; ++one) ::signal(one, SIG_IGN);
}

// A process that holds all that its parent held, for longer than any test may take.
void leave_a_process() {
  constexpr unsigned hours = 10000;
  if (::fork() != 0) return;
  if (const char* file = std::getenv("RICOCHET_TEST_LEFT")) {
    if (std::FILE* const left = std::fopen(file, "a")) {
      std::fprintf(left, "%d\n", ::getpid());
      std::fclose(left);
    }
  }
  ::sleep(hours);
  ::_exit(0);
}

std::atomic<bool> solving = false;

void do_it(const std::string& what) {
  static bool once = false;
  if (what == "segv") ::raise(SIGSEGV);
  if (what == "abort") std::abort();
  if (what == "exit") std::exit(0);
  if (what == "_exit") ::_exit(0);
  if (what == "kill") ::raise(SIGKILL);
  if (what == "loop") forever();
  if (what == "stop") ::raise(SIGSTOP);
  if (what == "deaf") {
    be_deaf();
    for (;;) {
    }
  }
  if (what == "print") {
    std::puts("printed");
    std::cout << "streamed" << std::endl;
  }
  if (what == "clear") ::clearenv();
  if (what == "close")
    for (int one = 3; one < 64; ++one) ::close(one);
  if (what == "junk")
    for (int one = 3; one < 64; ++one)
      if (::write(one, "\xa5\xa5\xa5\xa5\xa5\xa5\xa5\xa5\xa5\xa5\xa5\xa5", 12) < 0) continue;
  if (what == "leak") {
    constexpr std::size_t piece = std::size_t{1} << 26;
    for (;;) static_cast<void>(*new volatile char[piece]);
  }
  if (what == "long") throw std::runtime_error(std::string(5000000, 'L'));
  if (what == "accents") {
    std::string text;
    while (text.size() < 5000000) text += "é";
    throw std::runtime_error(text);
  }
  if (once) return;
  once = true;
  if (what == "fork") leave_a_process();
  if (what == "thread")
    std::thread([] {
      ::usleep(300000);
      ::raise(SIGSEGV);
    }).detach();
  if (what == "waiting-thread")  // until the first solve(), however long a worker takes to open its study
    std::thread([] {
      while (!solving) ::usleep(1000);
      ::raise(SIGSEGV);
    }).detach();
  if (what == "second") {  // only the process that comes first is spared
    const char* file = std::getenv("RICOCHET_TEST_LEFT");
    if (::access(file, F_OK) == 0) ::raise(SIGSEGV);
    std::fclose(std::fopen(file, "w"));
  }
}

void at(const std::string& moment) {
  static const std::string wanted = std::getenv("RICOCHET_TEST_UNRULY") ? std::getenv("RICOCHET_TEST_UNRULY") : "";
  if (wanted.starts_with(moment + " ")) do_it(wanted.substr(moment.size() + 1));
}

struct Life {
  Life() { at("load"); }
  ~Life() { at("end"); }
} life;

class Unruly final : public ContactLaw {
 public:
  std::optional<Evaluation> reads() const override { return Evaluation::implicit_end; }
  void prepare(int, std::span<const Parameters>) override {}
  void solve(ReducedProblem& problem) override {
    constexpr double stiffness = 1e5;  // N/m
    solving = true;
    at("solve");
    for (const int lane : problem.touched) {
      LaneProblem one = problem.lane(lane);
      for (int i = 0; i < one.points; ++i) {
        const double pushed = 1 + one.reach * one.delassus->column(i)[i] * stiffness;
        const double below = one.lower[i] - one.free[i], above = one.free[i] - one.upper[i];
        one.effort[i] = below > 0 ? stiffness * below / pushed : above > 0 ? -stiffness * above / pushed : 0;
      }
      problem.outcome[lane] = {.converged = true, .iterations = 1};
    }
  }
  double potential(const StopState& state) const override {
    constexpr double stiffness = 1e5;
    return state.depth > 0 ? stiffness * state.depth * state.depth / 2 : 0;
  }
};

void register_all(Registry& registry) {
  at("register");
  registry.add_contact({.name = "unruly",
                        .summary = "a spring that ends its process",
                        .text = "It is a penalty of 1e5 N/m.",
                        .source = "none",
                        .parameters = {}},
                       [](const Parameters&) { return std::make_unique<Unruly>(); });
}

}  // namespace

RICOCHET_PLUGIN(contact, unruly, register_all)
