// What plans make of friction: known roots of efforts that hold, and why a plan has none.
#include <catch2/catch.hpp>
#include <ricochet/contract/friction_facts.hpp>

#include "tests/marching.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

FrictionFacts facts_of(const Choice& time, const std::optional<Evaluation>& evaluation = {}) {
  ProblemFacts problem;
  problem.dofs = 1;
  problem.contact = true;
  const PlanOrRefusal plan = plan_of(time, 1e-3, problem);
  REQUIRE(std::holds_alternative<StepPlan>(plan));
  return friction_facts(derive(std::get<StepPlan>(plan)), evaluation);
}

}  // namespace

TEST_CASE("friction: a held point forgets a disturbance by the root that its scheme has", "[friction]") {
  const auto root = [](const Choice& time, const std::optional<Evaluation>& evaluation = {}) {
    INFO(time.name);
    const FrictionFacts facts = facts_of(time, evaluation);
    CHECK(facts.why_none == "");
    CHECK(facts.rings == "");
    return facts.held_root;
  };
  // Roots of the recursion of efforts, by hand. The last efforts are off by 1e-12, and known to 1e-16.
  const auto near = [](double value) { return Approx(value).margin(1e-4); };
  for (const char* name : {"moreau-jean", "newmark-dumont-paoli", "cd-lagrange", "paoli-schatzman"})
    CHECK(root({name}) == near(0));
  CHECK(root({"generalised-alpha", {{"rho_inf", 0.8}}}) == near(-0.636363636));
  CHECK(root({"generalised-alpha", {{"rho_inf", 0.0}}}) == near(1.0 / 3));
  CHECK(root({"newmark", {{"gamma", 0.6}, {"beta", 0.3025}}}) == near(-0.4 / 0.6));
  CHECK(root({"bathe", {{"rho_inf", 0.8}}}, Evaluation::averaged) == near(0.8));
}

TEST_CASE("friction: a scheme that alternates held efforts for ever is refused with its factor", "[friction]") {
  const FrictionFacts facts = facts_of({"newmark"});
  CHECK(facts.held_root == Approx(-1).margin(1e-9));
  CHECK(facts.rings == "it alternates the effort of a point that sticks (by the factor -1 a step)");
}
