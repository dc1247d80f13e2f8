// What the schemes cannot do they refuse, with the cause and the remedy.
#include "tests/refusals.hpp"

#include <algorithm>
#include <limits>

#include "tests/plugins/time/family.hpp"

using namespace ricochet;
using namespace ricochet::testing;
using Catch::Matchers::Contains;

namespace {

std::string refusal_of(const std::string& velocity, const Choice& time, double alpha = 1e-4) {
  const Choice mass{"singular", {{"velocity", velocity}}};
  auto result = compiled(problem_of(compared_beam(alpha), 6, mass), {mass, {"signorini"}, time}, 1e-4);
  const auto* refused = std::get_if<Refusal>(&result);
  return refused ? refused->sentence.text : std::string();
}

}  // namespace

TEST_CASE("schemes that need inertia at the contact point refuse a singular mass and say what to take") {
  struct Row {
    Choice time;
    std::string cause, remedy;
  };
  const std::vector<Row> rows = {
      {scheme("central-difference"), "inverse of the mass, which is singular", "use a lumped mass, or an implicit"},
      {scheme("noh-bathe"), "inverse of the mass, which is singular", "use a lumped mass, or an implicit"},
      {scheme("cd-lagrange"), "inverse of the mass, which is singular", "use a lumped mass, or an implicit"},
      {scheme("carpenter-taylor-katona"), "kernel of a singular mass", "Use beta ≥ 0.25 of newmark-dumont-paoli"},
      {scheme("paoli-schatzman", {{"restitution", 0.8}}), "kernel of a singular mass",
       "Use beta ≥ 0.25 of newmark-dumont-paoli"},
      {scheme("newmark", {{"beta", 0.2}}), "kernel of a singular mass", "use beta ≥ gamma/2"},
      {scheme("contact-stabilised-newmark"), "metric of the mass, which is singular",
       "use a regular mass, or midpoint"},
      {scheme("laursen-chawla"), "contact point without mass", "Use a regular mass, or midpoint"},
      {scheme("kane", {{"beta", 0.3}, {"gamma", 0.6}}), "inverse of the mass, which is singular",
       "use beta = 0.25 with gamma = 0.5, or a regular mass"},
      {scheme("moreau-jean", {{"restitution", 0.8}}), "restitution = 0.8", "use restitution 0, or a regular mass"},
      {scheme("moreau-jean"), "theta = 0.5", "use theta > 0.5, or a regular mass"}};
  for (const Row& row : rows)
    for (const char* velocity : {"P1", "P0"}) {
      INFO(label(row.time) << " on " << velocity);
      const std::string sentence = refusal_of(velocity, row.time);
      CHECK_THAT(sentence, names_cause_and_remedy() && Contains(row.cause) && Contains(row.remedy));
      CHECK(plan_made(row.time, 1e-4).facts.needs_regular_mass);
    }
}

TEST_CASE("the remedy that a refusal names is taken without another refusal") {
  for (const Choice& time :
       {scheme("midpoint"), scheme("kane"), scheme("newmark", {{"beta", 0.25}}),
        scheme("newmark-dumont-paoli", {{"beta", 0.25}}), scheme("moreau-jean", {{"theta", 0.6}}), scheme("hht-alpha"),
        scheme("wbz-alpha"), scheme("generalised-alpha"), scheme("bathe"), scheme("sdirk")}) {
    INFO(label(time));
    CHECK(refusal_of("P1", time).empty());
    CHECK(refusal_of("P0", time).empty());
    CHECK_FALSE(plan_made(time, 1e-4, {12, 3, true, true}).facts.needs_regular_mass);
  }
}

TEST_CASE("central differences have nothing that a rigid law could act on, and name a law") {
  const Choice mass{"lumped"};
  auto result = compiled(problem_of(compared_beam(0), 6, mass), {mass, {"signorini"}, {"central-difference"}}, 1e-5);
  REQUIRE(std::holds_alternative<Refusal>(result));
  CHECK_THAT(std::get<Refusal>(result).sentence.text,
             names_cause_and_remedy() && Contains("no impact measure") && Contains("use a penalty"));
}

TEST_CASE("a parameter of a scheme beyond its range is refused by name, its ends are not") {
  struct Row {
    const char *name, *key;
    std::vector<ParameterValue> inside, outside;
  };
  const double inf = std::numeric_limits<double>::infinity();
  const std::vector<Row> rows = {
      {"hht-alpha", "alpha", {-1.0 / 3, 0.0}, {-0.34, 1e-9, inf}},
      {"hht-alpha", "contact", {std::string("end"), std::string("weighted")}, {std::string("whole")}},
      {"wbz-alpha", "rho_inf", {0.0, 1.0}, {-1e-9, 1.1}},
      {"generalised-alpha", "rho_inf", {0.0, 1.0}, {-1e-9, 1.1}},
      {"generalised-alpha", "contact", {std::string("end"), std::string("weighted")}, {std::string("")}},
      {"bathe", "rho_inf", {0.0, 1.0}, {-0.1, 1.0001}},
      {"bathe", "split", {0.0, 0.5, 0.999}, {-0.1, 1.0}},
      {"midpoint", "constraint", {std::string("end"), std::string("middle")}, {std::string("start")}},
      {"kane", "gamma", {0.5, 1.0}, {0.49, 1.01}},
      {"contact-stabilised-newmark",
       "velocity",
       {std::string("original"), std::string("corrected")},
       {std::string("improved")}},
      {"paoli-schatzman", "restitution", {0.0, 1.0}, {-0.1, 1.1}},
      {"cd-lagrange", "restitution", {0.0, 1.0}, {-0.1, 1.1}},
      {"moreau-jean", "restitution", {0.0, 1.0}, {-0.1, 1.1}},
      {"moreau-jean", "theta", {0.5, 1.0}, {0.4, 1.1}},
      {"noh-bathe", "split", {0.54, 0.99}, {0.5, 1.0}},
      {"sdirk", "order", {2LL, 3LL}, {1LL, 4LL, 2.5}}};
  for (const Row& row : rows) {
    const PluginManual* manual = registry().manual(Role::time, row.name);
    REQUIRE(manual);
    const auto spec = std::find_if(manual->parameters.begin(), manual->parameters.end(),
                                   [&](const ParameterSpec& one) { return one.key == row.key; });
    REQUIRE(spec != manual->parameters.end());
    INFO(row.name << " " << row.key);
    for (const ParameterValue& value : row.inside) CHECK_FALSE(check_parameter(*spec, value));
    for (const ParameterValue& value : row.outside) {
      const auto sentence = check_parameter(*spec, value);
      REQUIRE(sentence);
      CHECK_FALSE(sentence->empty());
    }
  }
}
