#include "runners/march/prepare_case.hpp"

#include <catch2/catch.hpp>
#include <ricochet/loader/catalogue.hpp>

#include "runners/study/load_study.hpp"

using namespace ricochet;

namespace {

bool said_marginal(const std::string& mass, const std::string& time, double viscosity) {
  Catalogue catalogue(RICOCHET_PLUGIN_DIR, {}, {});
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
