// A rigid law at one stop point, in closed form. It does what no plugin may do once a point would pass its stop by more
// than `beyond` in one step. Along a parameter that happens at the hard impacts only.
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ricochet/contract/plugin.hpp>
#include <vector>

using namespace ricochet;

namespace {

[[gnu::noinline]] int overflow(int depth) {
  volatile int room[1000] = {};
  room[depth % 1000] = depth;
  return depth < 0 ? 0 : overflow(depth + 1) + room[7];
}

void linger() {
  static const char* const held = std::getenv("RICOCHET_TEST_HELD");
  constexpr useconds_t pause = 50000;
  if (held && ::access(held, F_OK) == 0) ::usleep(pause);
}

void misbehave(const std::string& how) {
  if (how == "none") return;
  if (how == "linger") return linger();
  std::fputs("too deep for me\n", stderr);
  if (how == "segv") ::raise(SIGSEGV);
  if (how == "abort") std::abort();
  if (how == "exit") ::_exit(7);
  if (how == "leave") std::exit(0);
  if (how == "overflow") static_cast<void>(overflow(1));
  if (how == "kill") ::kill(::getpid(), SIGKILL);
  if (how == "greedy") {
    constexpr std::size_t piece = std::size_t{1} << 28;
    for (std::vector<char*> all;;) all.push_back(new char[piece]);
  }
  if (how == "sleep")
    for (;;) ::pause();
}

class Stumbles final : public ContactLaw {
 public:
  Stumbles(std::string how, double beyond) : how_(std::move(how)), beyond_(beyond) {}
  void prepare(int, std::span<const Parameters>) override {}
  bool closed_form(int points) const override { return points == 1; }
  void solve(ReducedProblem& problem) override {
    const double pushed = problem.reach * problem.delassus->column(0)[0];
    for (const int lane : problem.touched) {
      const auto l = static_cast<std::size_t>(lane);
      const double above = problem.free[l] - problem.upper[l], below = problem.lower[l] - problem.free[l];
      if (std::max(above, below) > beyond_) misbehave(how_);
      problem.effort[l] = above > 0 ? -above / pushed : (below > 0 ? below / pushed : 0);
    }
  }

 private:
  const std::string how_;
  const double beyond_;
};

void register_all(Registry& registry) {
  registry.add_contact(
      {.name = "stumbles",
       .summary = "a rigid law that stumbles",
       .text = "It keeps one point within its stops, as long as it is not asked for too much.",
       .source = "none",
       .parameters = {word_parameter(
                          "how",
                          {"none", "segv", "abort", "exit", "leave", "overflow", "kill", "greedy", "sleep", "linger"},
                          "none", "what it does that no plugin may do"),
                      real_parameter("beyond", "m", 1e9, {.low = 0}, "the depth of a step from which it does so")}},
      [](const Parameters& p) { return std::make_unique<Stumbles>(p.word("how"), p.real("beyond")); });
}

}  // namespace

RICOCHET_PLUGIN(contact, stumbles, register_all)
