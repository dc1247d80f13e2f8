#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <ricochet/contract/errors.hpp>
#include <ricochet/contract/registry.hpp>

using namespace ricochet;
using Catch::Matchers::Contains;

namespace {

struct NoMass : MassStrategy {
  InertiaOrRefusal build(const FiniteElementSpace&) const override { return Refusal{"a stand-in"}; }
};
struct NoLaw : ContactLaw {
  void prepare(int, std::span<const Parameters>) override {}
  void solve(ReducedProblem&) override {}
};
struct NoScheme : TimeScheme {
  PlanOrRefusal plan(double, const ProblemFacts&) const override { return Refusal{"a stand-in"}; }
};

PluginManual manual(const std::string& name, std::vector<ParameterSpec> parameters = {}) {
  return {name, "A stand-in.", "Registered by the tests.", "none", std::move(parameters)};
}
void add_time(Registry& registry, PluginManual text) {
  registry.add_time(std::move(text), [](const Parameters&) { return std::make_unique<NoScheme>(); });
}

}  // namespace

TEST_CASE("a fresh registry knows no method") {
  const Registry registry;
  for (const Role role : all_roles) {
    CHECK(registry.names(role).empty());
    CHECK(registry.manual(role, "anything") == nullptr);
    CHECK(registry.file(role, "anything").empty());
  }
}

TEST_CASE("a method is found under its role and name only, with its manual, maker and file") {
  Registry registry;
  registry.set_current_file("here.so");
  registry.add_mass(manual("one"), [](const Parameters&) { return std::make_unique<NoMass>(); });
  registry.set_current_file("");
  registry.add_contact(manual("one"), [](const Parameters&) { return std::make_unique<NoLaw>(); });
  add_time(registry, manual("two"));
  CHECK(registry.file(Role::mass, "one") == "here.so");
  CHECK(registry.file(Role::contact, "one").empty());
  CHECK(registry.mass("one")->make({}) != nullptr);
  CHECK(registry.time("one") == nullptr);
  CHECK(registry.mass("two") == nullptr);
  CHECK(registry.manual(Role::time, "two")->summary == "A stand-in.");
  CHECK(registry.names(Role::mass) == std::vector<std::string>{"one"});
  add_time(registry, manual("alpha"));
  CHECK(registry.names(Role::time) == std::vector<std::string>{"alpha", "two"});
}

TEST_CASE("a time scheme may be one function of its parameters, the step and the problem") {
  Registry registry;
  registry.add_time(manual("function"), [](const Parameters& p, double h, const ProblemFacts& facts) -> PlanOrRefusal {
    return Refusal{p.word("name") + " " + std::to_string(h > 0.5) + " " + std::to_string(facts.dofs)};
  });
  const auto scheme = registry.time("function")->make(Parameters({{"name", std::string("mine")}}));
  CHECK(std::get<Refusal>(scheme->plan(1, {7, 0, false, false})).sentence.text == "mine 1 7");
  CHECK(std::get<Refusal>(scheme->plan(0.25, {3, 0, false, false})).sentence.text == "mine 0 3");
}

TEST_CASE("a name is registered once for each role") {
  Registry registry;
  add_time(registry, manual("mine"));
  CHECK_THROWS_AS(add_time(registry, manual("mine")), PluginError);
  CHECK_THROWS_WITH(add_time(registry, manual("mine")), Contains("time plugin 'mine' is registered twice"));
  CHECK(registry.names(Role::time).size() == 1);
}

TEST_CASE("names are lower case, digits and hyphens") {
  const std::string name = GENERATE("", "Mine", "my_own", "my own", "naïve", "a/b", "a.b");
  Registry registry;
  CHECK_THROWS_WITH(add_time(registry, manual(name)), Contains("'" + name + "'") && Contains("a-z, 0-9 and '-'"));
  CHECK(registry.names(Role::time).empty());
}

TEST_CASE("a default that its own declaration refuses is a fault of the plugin") {
  Registry registry;
  const auto [spec, part] = GENERATE(table<ParameterSpec, std::string>(
      {{real_parameter("beta", "1", 0.75, {0, 0.5}, "β."), "0.75 is outside [0, 0.5]"},
       {integer_parameter("count", 9, {1, 4}, "N."), "9 is outside [1, 4]"},
       {word_parameter("space", {"P0", "P1"}, "P2", "Space."), "expected one of \"P0\", \"P1\""}}));
  CHECK_THROWS_WITH(
      add_time(registry, manual("mine", {spec})),
      Contains("'mine' declares the parameter '" + spec.key + "' with a default that does not fit") && Contains(part));
  CHECK(registry.names(Role::time).empty());
}

TEST_CASE("a default that is not finite, and a range with nothing in it, are faults of the plugin") {
  Registry registry;
  constexpr double infinite = std::numeric_limits<double>::infinity(), none = std::numeric_limits<double>::quiet_NaN();
  const auto [spec, part] = GENERATE_COPY(table<ParameterSpec, std::string>(
      {{real_parameter("beta", "1", infinite, {}, "β."), "a default that is not finite"},
       {real_parameter("beta", "1", -infinite, {}, "β."), "a default that is not finite"},
       {real_parameter("beta", "1", none, {}, "β."), "a default that is not finite"},
       {real_parameter("beta", "1", std::nullopt, {1, 0}, "β."), "whose range [1, 0] is empty"},
       {real_parameter("beta", "1", std::nullopt, {.low = 1, .high = 1, .low_open = true}, "β."),
        "whose range ]1, 1] is empty"},
       {real_parameter("beta", "1", std::nullopt, {none, 1}, "β."), "is empty"},
       {integer_parameter("count", std::nullopt, {4, 1}, "N."), "whose range [4, 1] is empty"}}));
  CHECK_THROWS_WITH(add_time(registry, manual("mine", {spec})),
                    Contains("'mine' declares the parameter '" + spec.key + "'") && Contains(part));
  CHECK(registry.names(Role::time).empty());
  CHECK_NOTHROW(add_time(registry, manual("mine", {real_parameter("beta", "1", 1.0, {1, 1}, "β.")})));
}

TEST_CASE("a parameter that no study could write is a fault of the plugin") {
  Registry registry;
  const auto real = [](const std::string& key) { return real_parameter(key, "1", 0.5, {0, 1}, "x."); };
  using Parameters_ = std::vector<ParameterSpec>;
  const auto restitution = [&](const std::string& key) { return with_role(real(key), ParameterRole::restitution); };
  const auto [parameters, part] = GENERATE_COPY(table<Parameters_, std::string>({
      {{real("name")}, "the parameter 'name', a key that every method has already"},
      {{real("file")}, "the parameter 'file', a key that every method has already"},
      {{real("")}, "the parameter ''; keys begin with a letter"},
      {{real("has space")}, "the parameter 'has space'; keys begin with a letter"},
      {{real("Beta")}, "the parameter 'Beta'; keys"},
      {{real("2nd")}, "the parameter '2nd'; keys"},
      {{real("a-b")}, "the parameter 'a-b'; keys"},
      {{real("beta"), real("gamma"), real("beta")}, "the parameter 'beta' twice"},
      {{word_parameter("space", {}, std::nullopt, "x.")}, "'space' without any word to choose from"},
      {{word_parameter("space", {"P0", "P1", "P0"}, "P0", "x.")}, "'space' with the word 'P0' twice"},
      {{word_parameter("space", {"P0", ""}, "P0", "x.")}, "'space' with an empty word"},
      {{restitution("e"), restitution("f")}, "the parameter 'f' in the role of 'e'"},
      {{with_role(word_parameter("e", {"no", "yes"}, "no", "x."), ParameterRole::restitution)},
       "'e' in a role that only a number can have"},
  }));
  CHECK_THROWS_AS(add_time(registry, manual("mine", parameters)), PluginError);
  CHECK_THROWS_WITH(add_time(registry, manual("mine", parameters)),
                    Contains("the time plugin 'mine' declares ") && Contains(part));
  CHECK(registry.names(Role::time).empty());
}

TEST_CASE("keys that a study can write are taken") {
  Registry registry;
  add_time(registry,
           manual("mine", {real_parameter("a", "1", 0.5, {0, 1}, "x."),
                           with_role(real_parameter("e_2", "1", 0.5, {0, 1}, "x."), ParameterRole::restitution),
                           with_role(real_parameter("k", "1", 0.5, {0, 1}, "x."), ParameterRole::stiffness)}));
  CHECK(registry.manual(Role::time, "mine")->parameters.size() == 3);
}
