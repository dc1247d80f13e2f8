#include <catch2/catch.hpp>
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
  CHECK_THROWS_WITH(add_time(registry, manual("mine", {spec})),
                    Contains("default of parameter '" + spec.key + "' of 'mine'") && Contains(part));
  CHECK(registry.names(Role::time).empty());
}
