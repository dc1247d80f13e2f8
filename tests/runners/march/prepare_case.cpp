#include "runners/march/prepare_case.hpp"

#include <catch2/catch.hpp>
#include <ricochet/loader/catalogue.hpp>

#include "runners/study/load_study.hpp"
#include "tests/marching.hpp"
#include "tests/places.hpp"

using namespace ricochet;
using namespace ricochet::testing;
using Catch::Matchers::Contains;

namespace {

std::string refusal_of(const Choice& time, double h) {
  // A bar of 8 lumped elements: its highest pulsation is 2c/ℓ cos(π/(4·8)) with one end held.
  SceneSpec scene;
  BarSpec bar;
  bar.length = 8;
  bar.EA = 4;
  scene.structure = bar;
  const auto problem = problem_of(scene, 8, {"lumped"});
  ProblemFacts facts;
  facts.dofs = problem->dofs();
  const auto plan_at = [&](double length) { return plan_of(time, length, facts); };
  return beyond_explicit_limit(problem, std::get<StepPlan>(plan_at(h)), h, plan_at).text;
}

}  // namespace

TEST_CASE("an explicit step beyond its limit is refused with the largest stable one, an implicit step never") {
  const Choice central{"central-difference"};
  const double highest = 4 * std::cos(M_PI / 32), limit = 2 / highest;
  CHECK(refusal_of(central, 0.999 * limit).empty());
  const std::string refused = refusal_of(central, 1.01 * limit);
  CHECK_THAT(refused, Contains("beyond the limit of an explicit scheme") && Contains("use a smaller step"));
  const auto at = refused.find("step there is ");
  REQUIRE(at != std::string::npos);
  // Five digits are printed, and a growth of 1e-6 per step counts as stable.
  CHECK(std::stod(refused.substr(at + 14)) == Approx(limit).epsilon(1e-4));
  CHECK(refusal_of({"newmark"}, 100 * limit).empty());
}

using namespace ricochet;

namespace {

bool said_marginal(const std::string& mass, const std::string& time, double viscosity) {
  Catalogue catalogue(tests::places().plugins, {}, {});
  Registry registry;
  Json study = Json::parse(R"({
    "name": "marginal", "kind": "trajectory",
    "scene": {
      "structure": {"type": "beam", "length": 1, "section": {"type": "given", "EI": 1, "rhoS": 1}},
      "stops": {"lower": -0.1, "upper": 0.1, "at": "tip"}
    },
    "mesh": {"elements": 4}, "step": 1e-3, "duration": 0.01
  })");
  study["scene"]["structure"]["damping"] = {{"stiffness", viscosity}};
  study["methods"] = {{"mass", mass}, {"contact", "signorini"}, {"time", Json::parse(time)}};
  const Study parsed = parse_study(study.dump(), catalogue, registry);
  const Prepared prepared = prepare_case(parsed.cases.at(0), registry);
  REQUIRE(prepared.program);
  return std::any_of(prepared.notes.begin(), prepared.notes.end(),
                     [](const std::string& note) { return note.starts_with("marginal:"); });
}

}  // namespace

TEST_CASE("a root of modulus one on what has neither mass nor viscosity is said before it marches") {
  const std::string keeps = R"({"name": "generalised-alpha", "rho_inf": 1})";
  CHECK(said_marginal("singular", keeps, 0));
  CHECK(said_marginal("singular", R"("newmark")", 0));
  CHECK_FALSE(said_marginal("singular", R"({"name": "generalised-alpha", "rho_inf": 0.8})", 0));
  CHECK_FALSE(said_marginal("singular", keeps, 1e-4));
  CHECK_FALSE(said_marginal("consistent", keeps, 0));
}
