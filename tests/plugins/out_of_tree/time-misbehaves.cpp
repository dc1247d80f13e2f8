// A scheme that goes wrong in the way that its parameter says, each way in the function where it can.
#include <atomic>
#include <cstdlib>
#include <limits>
#include <stdexcept>

#include "misbehave.hpp"
#include "stand_in.hpp"

namespace {

using namespace ricochet;

[[noreturn]] void never_return() {
  for (std::atomic<int> k = 0;; ++k) {
  }
}

class Misbehaves final : public TimeScheme {
 public:
  explicit Misbehaves(std::string how) : how_(std::move(how)) {
    if (how_ == "throw-in-constructor") throw std::runtime_error("no licence");
  }
  PlanOrRefusal plan(double h, const ProblemFacts&) const override {
    if (how_ == "throw") throw std::runtime_error("my plan failed");
    if (how_ == "throw-int") throw 42;
    if (how_ == "crash") misbehave("segv");
    if (how_ == "exit") std::exit(7);
    if (how_ == "hang") never_return();
    if (how_ == "empty-refusal") return Refusal{""};
    // A ball without forces: v stays, q ← q + h v.
    StepPlan plan;
    plan.slots = {"q", "v"};
    plan.initial = {{1, 0}, {0, 1}};
    plan.velocity = {.slots = {0, 1}};
    plan.stages.resize(1);
    plan.stages[0].update = {{.slots = {1, h}}, {.slots = {0, 1}}};
    if (how_ == "ill-formed") plan.stages[0].update.pop_back();
    if (how_ == "not-a-number") plan.velocity.slots[1] = std::numeric_limits<double>::quiet_NaN();
    return plan;
  }

 private:
  std::string how_;
};

void register_all(Registry& registry) {
  registry.add_time({.name = "misbehaves",
                     .summary = "A scheme that goes wrong.",
                     .text = "It goes wrong as told.",
                     .source = "none",
                     .parameters = {word_parameter("how",
                                                   {"no-object", "throw-in-constructor", "throw", "throw-int", "crash",
                                                    "exit", "hang", "empty-refusal", "ill-formed", "not-a-number"},
                                                   "ill-formed", "the way")}},
                    [](const Parameters& p) {
                      return p.word("how") == "no-object" ? nullptr : std::make_unique<Misbehaves>(p.word("how"));
                    });
}

}  // namespace

RICOCHET_PLUGIN(time, misbehaves, register_all)
