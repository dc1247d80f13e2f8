// A law that ends the program, never returns, or throws what is no exception: in prepare() or in solve().
#include "misbehave.hpp"

namespace {

using namespace ricochet;

class Crashes final : public ContactLaw {
 public:
  Crashes(std::string how, std::string where) : how_(std::move(how)), where_(std::move(where)) {}
  void prepare(int, std::span<const Parameters>) override {
    if (where_ == "prepare") misbehave(how_);
  }
  void solve(ReducedProblem&) override {
    if (where_ == "solve") misbehave(how_);
  }

 private:
  std::string how_, where_;
};

void register_all(Registry& registry) {
  registry.add_contact(
      {.name = "crashes",
       .summary = "a law that ends the program",
       .text = "It never pushes, and does what it is told to.",
       .source = "none",
       .parameters = {misdeed_parameter(), word_parameter("where", {"prepare", "solve"}, "solve", "the function")}},
      [](const Parameters& p) { return std::make_unique<Crashes>(p.word("how"), p.word("where")); });
}

}  // namespace

RICOCHET_PLUGIN(contact, crashes, register_all)
