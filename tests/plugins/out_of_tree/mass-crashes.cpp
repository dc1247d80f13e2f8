// A mass strategy that ends the program, never returns, or throws what is no exception in build(); else it applies to
// nothing.
#include "misbehave.hpp"

namespace {

using namespace ricochet;

class Crashes final : public MassStrategy {
 public:
  explicit Crashes(std::string how) : how_(std::move(how)) {}
  InertiaOrRefusal build(const FiniteElementSpace&) const override {
    misbehave(how_);
    return Refusal{"it applies to nothing"};
  }

 private:
  std::string how_;
};

void register_all(Registry& registry) {
  registry.add_mass({.name = "crashes",
                     .summary = "a mass strategy that ends the program",
                     .text = "It does what it is told to.",
                     .source = "none",
                     .parameters = {misdeed_parameter()}},
                    [](const Parameters& p) { return std::make_unique<Crashes>(p.word("how")); });
}

}  // namespace

RICOCHET_PLUGIN(mass, crashes, register_all)
