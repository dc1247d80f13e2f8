#include <ricochet/contract/plugin.hpp>

namespace {

using namespace ricochet;

/// Stops that are not there: p = 0, no rows of H, no box problem.
class None final : public ContactLaw {
 public:
  bool absent() const override { return true; }
  void prepare(int, std::span<const Parameters>) override {}
  void solve(ReducedProblem&) override {}
};

void register_none(Registry& registry) {
  registry.add_contact(
      {.name = "none",
       .summary = "no contact: the stops are ignored",
       .text = R"(The structure moves through its stops. What remains is the linear problem, which shows the mesh
          and the time scheme alone.)",
       .source = "—",
       .parameters = {},
       .words = "no stops"},
      [](const Parameters&) { return std::make_unique<None>(); });
}

}  // namespace

RICOCHET_PLUGIN(contact, none, register_none)
