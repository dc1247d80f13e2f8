// A scheme without C++. What a plan says in formulas is the step that a plugin writes in numbers. Whatever is wrong
// with it is told with its place.
#include <catch2/catch.hpp>
#include <cmath>
#include <ricochet/loader/catalogue.hpp>
#include <thread>

#include "runners/json/json_text.hpp"
#include "runners/plan_files/plan_file.hpp"
#include "tests/places.hpp"
#include "tests/runners/plan_files/step_numbers.hpp"
#include "tests/runners/scratch_folder.hpp"

using namespace ricochet;
using namespace ricochet::tests;

namespace {

const std::filesystem::path plans = std::filesystem::path(places().source) / "plugins/plan_files";

Parameters complete(const PluginManual& manual, const std::map<std::string, double>& values) {
  Parameters result;
  for (const ParameterSpec& spec : manual.parameters) {
    const auto given = values.find(spec.key);
    if (given != values.end())
      result.set(spec.key, given->second);
    else
      result.set(spec.key, *spec.fallback);
  }
  return result;
}

Registry registered(const std::filesystem::path& file) {
  Registry registry;
  register_plan(read_plan_file(file), registry);
  return registry;
}

PlanOrRefusal plan_of(const Registry& registry, const std::string& name, const std::map<std::string, double>& values,
                      double h, const ProblemFacts& facts) {
  const auto* entry = registry.time(name);
  REQUIRE(entry);
  return entry->make(complete(entry->manual, values))->plan(h, facts);
}

Registry plugins() {
  Catalogue catalogue(places().plugins, {}, {});
  Registry registry;
  catalogue.open_all(registry);
  return registry;
}

// The whole step, or the sentence of the refusal, is that of the plugin to the last bit.
void require_twins(const std::string& file, const std::string& name, const std::string& twin,
                   const std::vector<std::map<std::string, double>>& choices) {
  const Registry stated = registered(plans / file), compiled = plugins();
  for (const double h : {1e-2, 3.1e-5, 0.7e-7})
    for (const auto& values : choices)
      for (const int kernel : {0, 3}) {
        ProblemFacts facts;
        facts.dofs = 20;
        facts.mass_kernel_dimension = kernel;
        facts.damped = facts.contact = true;
        const PlanOrRefusal mine = plan_of(stated, name, values, h, facts);
        const PlanOrRefusal theirs = plan_of(compiled, twin, values, h, facts);
        REQUIRE(mine.index() == theirs.index());
        if (const auto* refusal = std::get_if<Refusal>(&mine)) {
          CHECK(refusal->sentence.text == std::get<Refusal>(theirs).sentence.text);
          continue;
        }
        const auto& step = std::get<StepPlan>(mine);
        CHECK(check_plan(step) == check_plan(std::get<StepPlan>(theirs)));
        CHECK(step.slots == std::get<StepPlan>(theirs).slots);
        CHECK(step_numbers(step) == step_numbers(std::get<StepPlan>(theirs)));
      }
}

// Two sub-steps written as numbers: trapezium to t + gh, then v₁ = v_n + h(q₀a_n + q₁a_g + q₂z) and the same for q₁.
StepPlan two_sub_steps(double rho, double split, double h, bool singular_mass) {
  const double g = split > 0 ? split : (rho == 1 ? 0.5 : (2 - std::sqrt(2 + 2 * rho)) / (1 - rho));
  const double q1 = (rho + 1) / (2 * g * (rho - 1) + 4), q2 = 0.5 - g * q1, q0 = 1 - q1 - q2;
  const double d = g * h, half = d / 2, curve = d * d / 4, w = q2 * h;
  const double later = q1 * h - d / 2, earlier = q0 * h - d / 2, shared = d * d / 4 - 0.5 * q0 * h * d;
  const auto ask = [](Stage& stage, double at, const Combination& end, const Combination& rate) {
    stage.load = {{at, 1}};
    stage.impact = {.value = end, .bound = {{at, 1}}};
    stage.at(Evaluation::implicit_end) = {end, {{at, 1}}, rate, {{at, 1}}};
    stage.at(Evaluation::averaged) = stage.at(Evaluation::implicit_end);
    stage.at(Evaluation::explicit_start) = {{.slots = end.slots}, {{at, 1}}, {.slots = rate.slots}, {{at, 1}}};
  };
  Stage start, first, second;
  start.matrix = {1, 0, singular_mass ? curve : 0};
  start.history = {{0, 0, -1}, {0, -1, 0}};
  start.load = {{0, 1}};
  start.impact = {.value = {.slots = {1, d}, .z = 0.5 * d * d}, .bound = {{g, 1}}};
  for (const auto evaluation : {Evaluation::implicit_end, Evaluation::averaged, Evaluation::explicit_start})
    start.at(evaluation) = {{.slots = {1}}, {{0, 1}}, {.slots = {0, 1}}, {{0, 1}}};
  start.update = {{.slots = {1}}, {.slots = {0, 1}}, {.slots = {}, .z = 1}, {.slots = {0, 0, 0, 1}}};
  const Combination middle{{1, d, curve}, curve}, middle_rate{{0, 1, half}, half};
  first.matrix = {1, half, curve};
  first.history = {{0, 0, -1}, {0, -1, -d}, {0, -half, -curve}};
  first.update = {middle, middle_rate, {.slots = {}, .z = 1}, {.slots = {0, 0, 1}}};
  ask(first, g, middle, middle_rate);
  const Combination end{{1, h - d, shared + w * later, shared + w * earlier}, w * w}, rate{{0, 1, later, earlier}, w};
  second.matrix = {1, w, w * w};
  for (std::size_t j = 0; j < 4; ++j) second.history.push_back({0, -rate.slots[j], -end.slots[j]});
  second.update = {end, rate, {.slots = {}, .z = 1}, {.slots = {0, 0, 0, 1}}};
  ask(second, 1, end, rate);
  StepPlan plan;
  plan.slots = {"q", "v", "a", "b"};
  plan.initial = {{1, 0}, {0, 1}, {0, 0}, {0, 0}};
  plan.start = {start};
  plan.stages = {first, second};
  plan.velocity = {.slots = {0, 1}};
  plan.facts.order = 2;
  return plan;
}

const std::string& smallest() {
  static const std::string text = R"({
  "name": "mine",
  "parameters": {"theta": {"default": 0.5, "range": [0.5, 1]}},
  "let": {"next": "q + (1-theta)*h*v + theta*h*z"},
  "refuse": [{"when": "massless && theta == 0.5", "because": "theta = {theta} on a singular mass"}],
  "slots": {"q": [1, 0], "v": [0, 1]},
  "stages": [{
    "matrix": {"M": 1, "C": "theta*h", "K": "theta*theta*h*h"},
    "history": {"q": {"K": "-h"}, "v": {"M": 1, "C": "-(1-theta)*h", "K": "-(1-theta)*theta*h*h"}},
    "load": {"theta": "h"},
    "update": {"q": "next", "v": "z"}
  }],
  "facts": {"order": "theta == 0.5 ? 2 : 1"}
})";
  return text;
}

// The message of a plan in which one place of the text above is another.
std::string message(const std::string& from, const std::string& to) {
  std::string text = smallest();
  const auto at = text.find(from);
  REQUIRE(at != std::string::npos);
  text.replace(at, from.size(), to);
  const ScratchFolder folder;
  write_text(folder / "mine.json", text);
  try {
    const PlanSource source = read_plan_file(folder / "mine.json");
    try {
      check_plan_source(source);
    } catch (const InputError& error) {
      return source.explain(error).substr(folder.path().string().size() + 1);
    }
  } catch (const InputError& error) {
    return std::string(error.what()).substr(folder.path().string().size() + 1);
  }
  return "";
}

}  // namespace

TEST_CASE("Newmark as a plan equals its plugin bitwise", "[plan-file]") {
  require_twins("newmark.json", "newmark-as-plan", "newmark",
                {{}, {{"beta", 0.3}, {"gamma", 0.6}}, {{"beta", 0.1}}, {{"beta", 0.4}, {"gamma", 0.7}}});
}

TEST_CASE("a plan at velocity level, with its gate, equals its plugin bitwise", "[plan-file]") {
  require_twins("moreau-jean.json", "moreau-jean-as-plan", "moreau-jean",
                {{}, {{"theta", 0.7}}, {{"theta", 0.7}, {"restitution", 0.8}}, {{"restitution", 1.0}}});
}

TEST_CASE("a plan that gives work back, its levels derived, equals its plugin bitwise", "[plan-file]") {
  require_twins("laursen-love.json", "laursen-love-as-plan", "laursen-love", {{}});
}

TEST_CASE("a plan whose stage has an impulse equals its plugin bitwise", "[plan-file]") {
  require_twins("kane.json", "kane-as-plan", "kane",
                {{{"beta", 0.3}}, {{"beta", 0.0}}, {{"beta", 0.4}, {"gamma", 0.6}}});
}

TEST_CASE("w is a name where some stage has an impulse, and free where none has", "[plan-file]") {
  const std::string text = read_plan_file(plans / "kane.json").text;
  const auto said = [](std::string plan) -> std::string {
    PlanSource source;
    source.plan = parse_json(plan);
    try {
      check_plan_source(source);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  const auto with = [&](const std::string& what, const std::string& instead) {
    std::string plan = text;
    const auto at = plan.find(what);
    REQUIRE(at != std::string::npos);
    return said(plan.replace(at, what.size(), instead));
  };
  CHECK(said(text) == "");
  CHECK_THAT(with("\"let\": {", "\"let\": {\"w\": 2, "), Catch::Contains("the name \"w\" is that of"));
  CHECK_THAT(with("\"R\"", "\"Q\""), Catch::Contains("Q"));
  CHECK_THAT(with("\"of\": \"a\"", "\"of\": \"a + w\""), Catch::Contains("after the step there is no w"));
  const std::string free = read_plan_file(plans / "moreau-jean.json").text;
  std::string named = free;
  const auto at = named.find("\"let\": {");
  REQUIRE(at != std::string::npos);
  CHECK(said(named.replace(at, 8, "\"let\": {\"w\": 2, ")) == "");
}

TEST_CASE("Bathe's two sub-steps as a plan equal the same sums in C++ bitwise", "[plan-file]") {
  const Registry stated = registered(plans / "bathe.json");
  for (const auto& [rho, split] : {std::pair(0.0, 0.0), {0.8, 0.0}, {1.0, 0.0}, {0.0, 0.5}, {0.3, 0.25}})
    for (const double h : {1e-2, 3.1e-5})
      for (const int kernel : {0, 2}) {
        ProblemFacts facts;
        facts.mass_kernel_dimension = kernel;
        const PlanOrRefusal mine = plan_of(stated, "bathe-as-plan", {{"rho_inf", rho}, {"split", split}}, h, facts);
        REQUIRE(std::holds_alternative<StepPlan>(mine));
        CHECK_FALSE(check_plan(std::get<StepPlan>(mine)));
        CHECK(step_numbers(std::get<StepPlan>(mine)) == step_numbers(two_sub_steps(rho, split, h, kernel > 0)));
      }
}

TEST_CASE("a plan is checked when it is read, and every error has its place", "[plan-file]") {
  CHECK(message("\"mine\"", "\"mine\"").empty());
  const std::string place = "mine.json:8: at /stages/0/matrix";
  CHECK(message("\"theta*h\", \"K\"", "\"thta*h\", \"K\"") ==
        place +
            "/C: unknown name \"thta\" in the formula \"thta*h\"; the names are contact, damped, h, massless, theta, "
            "the constants are pi and e; did you mean \"theta\"?");
  CHECK(message("\"theta*h\", \"K\"", "\"theta h\", \"K\"").find("a product is written with *") != std::string::npos);
  CHECK(message("\"theta*h\", \"K\"", "[1], \"K\"") == place + "/C: expected a number or a formula, found [1]");
  CHECK(message("{\"M\": 1, \"C\": \"theta*h\", \"K\": \"theta*theta*h*h\"}", "\"M + theta*h*C*K\"") ==
        place +
            ": the formula \"M + theta*h*C*K\" is not linear in \"M\", \"C\", \"K\"; expected a sum of terms, each a "
            "coefficient times one of them");
  CHECK(message("\"matrix\"", "\"matrx\"").find("/stages/0/matrx: unknown key \"matrx\"; did you mean \"matrix\"?") !=
        std::string::npos);
  CHECK(message("\"history\": {\"q\"", "\"history\": {\"w\"").find("/stages/0/history/w: unknown key \"w\"") !=
        std::string::npos);
  CHECK(message("\"v\": \"z\"", "\"v\": \"z*v\"").find("is not linear in \"q\", \"v\", \"z\"") != std::string::npos);
  CHECK(message("\"v\": \"z\"", "\"v\": \"z + 1\"").find("is not linear in") != std::string::npos);
  CHECK(message("\"v\": \"z\"", "\"v\": \"abs(z)\"").find("is not linear in") != std::string::npos);
  CHECK(message("\"update\"", "\"updat\"").find("did you mean \"update\"?") != std::string::npos);
  CHECK(message("{\"q\": [1, 0]", "{\"v\": [0, 1], \"q\": [1, 0]").find("given twice") != std::string::npos);
  CHECK(message("{\"q\": [1, 0], \"v\": [0, 1]}", "{\"v\": [0, 1], \"q\": [1, 0]}") ==
        "mine.json:6: at /slots: expected the position \"q\" as the first slot, found \"v\"");
  CHECK(message("\"v\": [0, 1]", "\"v\": [0]").find("/slots/v: expected the slot's weights of q₀ and v₀") !=
        std::string::npos);
  CHECK(message("\"order\"", "\"oder\"").find("did you mean \"order\"?") != std::string::npos);
  CHECK(message("\"facts\": {", "\"facts\": {\"restitution\": \"exactly\", ")
            .find("/facts/restitution: expected one of \"exact\", \"asymptotic\", \"ignored\", found \"exactly\"") !=
        std::string::npos);
  CHECK(message("\"name\": \"mine\",", "").find("at /name: missing; a plan has a name") != std::string::npos);
  CHECK(message("\"mine\"", "\"My scheme\"").find("at /name: expected a name made of a-z, 0-9 and '-'") !=
        std::string::npos);
  CHECK(message("\"mine\"", "\"plan\"").find("at /name: expected a name of its own") != std::string::npos);
  CHECK(message("{theta}", "{thetas}").find("/refuse/0/because: unknown name \"thetas\"") != std::string::npos);
  CHECK(message("{theta}", "{theta").find("none closes it") != std::string::npos);
  CHECK_THAT(message("\"mine\",", "\"mine\""), Catch::Matchers::StartsWith("mine.json:2:") &&
                                                   Catch::Matchers::Contains("a comma is missing after \"mine\""));
}

TEST_CASE("names of a plan are told apart, and those that formulas know are taken", "[plan-file]") {
  CHECK(message("\"let\": {", "\"let\": {\"h\": 2, ").find("the name \"h\" is taken") != std::string::npos);
  CHECK(message("\"let\": {", "\"let\": {\"theta\": 2, ").find("is that of a parameter already") != std::string::npos);
  CHECK(message("\"let\": {", "\"let\": {\"v\": 2, ").find("is that of a slot already") != std::string::npos);
  CHECK(message("\"let\": {", "\"let\": {\"2x\": 2, ").find("cannot stand in a formula") != std::string::npos);
  CHECK(message("\"let\": {", "\"let\": {\"sin\": 2, ").find("the name \"sin\" is taken") != std::string::npos);
  CHECK(message("\"parameters\": {", "\"parameters\": {\"pi\": {}, ").find("the name \"pi\" is taken") !=
        std::string::npos);
  CHECK(message("\"parameters\": {", "\"parameters\": {\"file\": {}, ").find("has the key \"file\" already") !=
        std::string::npos);
  CHECK(message("\"parameters\": {", "\"parameters\": {\"Beta\": {}, ").find("made of a-z, 0-9 and '_'") !=
        std::string::npos);
  CHECK(message("\"v\": [0, 1]}", "\"v\": [0, 1], \"z\": [0, 0]}").find("the name \"z\" is taken") !=
        std::string::npos);
  CHECK(message("\"v\": [0, 1]}", "\"v\": [0, 1], \"pi\": [0, 0]}").find("the name \"pi\" is taken") !=
        std::string::npos);
  // A name of let is known to those after it.
  CHECK(message("\"let\": {", "\"let\": {\"a\": \"b\", \"b\": 1, ").find("unknown name \"b\"") != std::string::npos);
}

TEST_CASE("parameters of a plan have the ranges of any plugin's", "[plan-file]") {
  CHECK(message("0.5, \"range\"", "0.4, \"range\"") ==
        "mine.json:3: at /parameters/theta/default: the default 0.4 does not fit: 0.4 is outside [0.5, 1]");
  CHECK(message("[0.5, 1]}", "\"]0.5, 1]\"}").find("0.5 is outside ]0.5, 1]") != std::string::npos);
  CHECK(message("[0.5, 1]}", "\"0.5 to 1\"}").find("/parameters/theta/range: expected a range such as") !=
        std::string::npos);
  CHECK(message("[0.5, 1]}", "[1, 0.5]}").find("whose low end is not above its high end") != std::string::npos);
  CHECK(message("[0.5, 1]}", "[0.5, null]}").empty());
  CHECK(message("[0.5, 1]}", "\"[0.5, ∞[\"}").empty());
  CHECK(message("0.5, \"range\"", "0.5, \"type\": \"integer\", \"range\"").find("expected a whole number") !=
        std::string::npos);
  // Without a default a study must give one, and the formulas are read all the same.
  CHECK(message("\"default\": 0.5, ", "").empty());
  const std::string both =
      message("\"default\": 0.5, \"range\": [0.5, 1]}}", "\"range\": [0.5, 1]}, \"x\": {}, \"x\": {}}");
  CHECK(both.find("given twice") != std::string::npos);
}

TEST_CASE("a plan that is no step is told so with the default parameters", "[plan-file]") {
  // The mass is not carried forward by h.
  const std::string wrong = message("\"q + (1-theta)*h*v + theta*h*z\"", "\"q + theta*h*z\"");
  CHECK(wrong.find("with the default parameters and h = 0.001 s the plan is ill-formed: ") != std::string::npos);
  CHECK(wrong.find("a step of 0.001 s carries a free mass at 1 m/s by 0.0005 m") != std::string::npos);
  const std::string gains = message("\"q + (1-theta)*h*v + theta*h*z\"", "\"1.01*q + (1-theta)*h*v + theta*h*z\"");
  CHECK(gains.find("at /: ") == std::string::npos);
  CHECK(gains.find("ill-formed: a free mass at rest at 1 m is at") != std::string::npos);
  CHECK(message("\"theta*h\", \"K\"", "\"theta*h/0\", \"K\"")
            .find("gives an infinite value where h = 0.001, theta = 0.5") != std::string::npos);
}

TEST_CASE("what only a choice of parameters makes wrong is told with the place in the file", "[plan-file]") {
  const ScratchFolder folder;
  std::string text = smallest();
  const std::string from = "\"K\": \"theta*theta*h*h\"";
  text.replace(text.find(from), from.size(), "\"K\": \"theta*theta*h*h/(1-theta)*(1-theta)\"");
  write_text(folder / "mine.json", text);
  const Registry registry = registered(folder / "mine.json");
  CHECK_THROWS_WITH(plan_of(registry, "mine", {{"theta", 1.0}}, 0.1, {}),
                    Catch::Contains("mine.json:8: at /stages/0/matrix/K: the formula") &&
                        Catch::Contains("where h = 0.1, theta = 1; expected a finite number"));
  CHECK(std::holds_alternative<StepPlan>(plan_of(registry, "mine", {{"theta", 0.5}}, 0.1, {})));
}

TEST_CASE("a refusal is a sentence with the values in it", "[plan-file]") {
  const ScratchFolder folder;
  write_text(folder / "mine.json", smallest());
  const Registry registry = registered(folder / "mine.json");
  ProblemFacts facts;
  facts.mass_kernel_dimension = 1;
  const PlanOrRefusal answer = plan_of(registry, "mine", {}, 0.1, facts);
  REQUIRE(std::holds_alternative<Refusal>(answer));
  CHECK(std::get<Refusal>(answer).sentence.text == "theta = 0.5 on a singular mass");
  CHECK(std::holds_alternative<StepPlan>(plan_of(registry, "mine", {{"theta", 0.75}}, 0.1, facts)));
}

TEST_CASE("weights, formulas and names of combinations are three spellings of one thing", "[plan-file]") {
  const ScratchFolder folder;
  std::string weights = smallest();
  const std::string formula = "\"q + (1-theta)*h*v + theta*h*z\"";
  weights.replace(weights.find(formula), formula.size(), R"({"q": 1, "v": "(1-theta)*h", "z": "theta*h"})");
  write_text(folder / "a.json", smallest());
  write_text(folder / "b.json", weights);
  const Registry one = registered(folder / "a.json"), other = registered(folder / "b.json");
  const auto numbers = [&](const Registry& registry) {
    return step_numbers(std::get<StepPlan>(plan_of(registry, "mine", {{"theta", 0.7}}, 0.01, {})));
  };
  CHECK(numbers(one) == numbers(other));
}

TEST_CASE("one scheme makes its plans on several threads at once", "[plan-file]") {
  const Registry registry = registered(plans / "newmark.json");
  const auto* entry = registry.time("newmark-as-plan");
  const auto scheme = entry->make(complete(entry->manual, {}));
  const std::vector<double> expected = step_numbers(std::get<StepPlan>(scheme->plan(1e-3, {})));
  int wrong = 0;
  std::vector<std::thread> threads;
  std::vector<int> differences(4, 0);
  for (int& different : differences)
    threads.emplace_back([&] {
      for (int i = 0; i < 20; ++i)
        different += step_numbers(std::get<StepPlan>(scheme->plan(1e-3, {}))) != expected ? 1 : 0;
    });
  for (std::thread& thread : threads) thread.join();
  for (const int different : differences) wrong += different;
  CHECK(wrong == 0);
}
