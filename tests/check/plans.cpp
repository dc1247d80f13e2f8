// A plan in a file is checked as a plugin is: each fact that it declares, made wrong in turn, is caught.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "runners/check/checks.hpp"
#include "runners/plan_files/plan_file.hpp"
#include "tests/check/sound_schemes.hpp"
#include "tests/places.hpp"

using namespace ricochet;
using namespace ricochet::testing;
using Catch::Matchers::Contains;
using checking::CheckResult;
using checking::Finding;

namespace {

const std::filesystem::path plans = tests::places().source + "/plugins/plan_files";

Json plan_called(const char* name) {
  return read_plan_file(plans / (std::string(name) + ".json")).plan;
}

// A registry holds its entries.
struct Registered {
  Registry registry;
  const Entry<TimeScheme>& entry() const { return *registry.time(registry.names(Role::time).front()); }
};
Registered registered(Json plan) {
  Registered made;
  PlanSource source;
  source.file = "made-here.json";
  source.plan = std::move(plan);
  register_plan(source, made.registry);
  return made;
}

struct Case {
  const char* plan;
  const char* pointer;
  const char* value;  // as JSON
  const char* check;
  const char* words;
};

// The example of the page about plans, as it stands there.
Json example_of_the_page() {
  std::ifstream stream(tests::places().source + "/plugins/plan-files.md");
  const std::string page(std::istreambuf_iterator<char>(stream), {}), fence = "```";
  const std::size_t begin = page.find(fence + "json\n") + fence.size() + 5;
  return Json::parse(page.substr(begin, page.find(fence, begin) - begin));
}

void sound(const Json& plan) {
  const Registered made = registered(plan);
  const auto results = checking::check_scheme(made.entry(), {.child = false});
  std::string failing;
  for (const CheckResult& result : results)
    if (result.finding == Finding::fails) failing += text_of({result});
  INFO(plan.at("name"));
  CHECK(failing == "");
  // And the floating-point state.
  CHECK(results.size() == checking::scheme_checks().size() + 1);
}

}  // namespace

TEST_CASE("check: plans in files that declare what is true pass every check") {
  const char* name = GENERATE("bathe", "kane", "laursen-love", "moreau-jean", "newmark");
  Json plan = plan_called(name);
  // Their defaults alone, for the sake of time.
  if (plan.contains("parameters"))
    for (Json& parameter : plan["parameters"]) parameter["range"] = {parameter.at("default"), parameter.at("default")};
  sound(plan);
}

TEST_CASE("check: the example of the page about plans declares what is true, over all its parameters") {
  sound(example_of_the_page());
}

TEST_CASE("check: each fact that a plan in a file declares wrongly is caught") {
  const Case wrong = GENERATE(
      Case{"newmark", "/facts/order", "3", "order and start", "declares order 3"},
      Case{"bathe", "/facts/order", "1", "order and start", "declares order 1"},
      Case{"newmark", "/facts/stability_limit", "2.5", "stability limit", "the limit is larger, or there is none"},
      Case{"newmark", "/facts/stability_limit", "\"2*beta < gamma ? 1.1/sqrt(gamma/2-beta) : none\"", "stability limit",
           "spectral radius"},
      Case{"newmark", "/facts/needs_regular_mass", "true", "singular mass", "yet gives a plan for a kernel"},
      Case{"kane", "/facts/needs_regular_mass", "false", "singular mass", "yet refuses a kernel"},
      Case{"bathe", "/facts/restitution", "\"exact\"", "restitution", "declares its restitution exact, e = 0"},
      Case{"laursen-love", "/facts/restitution", "\"asymptotic\"", "restitution", "It should vanish"},
      Case{"moreau-jean", "/parameters/restitution/role", "\"stiffness\"", "restitution", "e = 0"},
      Case{"moreau-jean", "/facts/contact_order", "2", "order at contact", "declares order 2 at rigid stops"},
      Case{"newmark", "/facts/contact_never_gains", "true", "energy at contact",
           "declares that its energy never grows"},
      Case{"newmark", "/stages/0/load", "{\"0\": 1}", "loads", "a load spoils the order"},
      Case{"kane", "/energy/0/coefficient", "0.4", "energy", "grows in undamped free flight"},
      Case{"laursen-love", "/stages/0/work/displacement", "\"h*v\"", "work form", "does not close"});
  Json plan = plan_called(wrong.plan);
  plan[Json::json_pointer(wrong.pointer)] = Json::parse(wrong.value);
  const Registered made = registered(plan);
  const CheckResult result = one_check(checking::scheme_checks(), made.entry(), wrong.check);
  INFO(wrong.plan << " with " << wrong.pointer << " = " << wrong.value << "\n" << text_of({result}));
  CHECK(result.finding == Finding::fails);
  REQUIRE_FALSE(result.sentences.empty());
  CHECK_THAT(result.sentences.front(), Contains(wrong.words));
}

TEST_CASE("check: what a plan in a file may leave out of its manual is told, and is no failure") {
  Json plan = plan_called("newmark");
  for (const char* key : {"summary", "text", "source"}) plan.erase(key);
  const Registered made = registered(plan);
  const CheckResult result = one_check(checking::scheme_checks(), made.entry(), "manual");
  CHECK(result.finding == Finding::not_declared);
  CHECK_THAT(result.sentences.at(0), Contains("the manual has no text"));
}
