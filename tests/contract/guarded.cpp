#include <catch2/catch.hpp>
#include <cfenv>
#include <functional>
#include <ricochet/contract/contact_law.hpp>
#include <ricochet/contract/float_control.hpp>
#include <ricochet/contract/registry.hpp>

#include "tests/allocations.hpp"

using namespace ricochet;
using Catch::Matchers::Contains;

namespace {

/// A scheme, a law, a mass and a reference that do what a test tells them.
struct Scheme : TimeScheme {
  explicit Scheme(std::function<PlanOrRefusal()> act_) : act(std::move(act_)) {}
  std::function<PlanOrRefusal()> act;
  PlanOrRefusal plan(double, const ProblemFacts&) const override { return act(); }
};
struct Mass : MassStrategy {
  explicit Mass(std::function<InertiaOrRefusal()> act_) : act(std::move(act_)) {}
  std::function<InertiaOrRefusal()> act;
  InertiaOrRefusal build(const FiniteElementSpace&) const override { return act(); }
};
struct Reference : ReferenceSolver {
  explicit Reference(std::function<ReferenceOrRefusal()> act_) : act(std::move(act_)) {}
  std::function<ReferenceOrRefusal()> act;
  ReferenceOrRefusal solve(const ReferenceProblem&, const SampleGrid&) const override { return act(); }
};
// A map of two numbers whose answers have as many as a test says.
struct Map : ReferenceMap {
  explicit Map(int count_) : count(count_) {}
  int count;
  int size() const override { return 2; }
  Eigen::VectorXd start() const override { return Eigen::VectorXd::Zero(count); }
  Eigen::VectorXd weights() const override { throw 42; }
  std::pair<double, double> tip(const Eigen::VectorXd&) const override { return {1, 2}; }
  Image march(const Eigen::VectorXd& x, double, bool derivative) override {
    return {x, derivative ? Eigen::MatrixXd::Zero(count, 2) : Eigen::MatrixXd(), x[0] < 0 ? "below" : "", 3};
  }
};
struct Mapped : Reference {
  explicit Mapped(int count_) : Reference([]() -> ReferenceOrRefusal { return Refusal{"no"}; }), count(count_) {}
  int count;
  ReferenceMapOrRefusal map(const ReferenceProblem&) const override {
    if (count == 0) return std::unique_ptr<ReferenceMap>();
    return std::make_unique<Map>(count);
  }
};
struct Law : ContactLaw {
  explicit Law(std::function<void()> act_) : act(std::move(act_)) {}
  std::function<void()> act;
  bool absent() const override { return (act(), true); }
  std::optional<Evaluation> reads() const override { return (act(), Evaluation::averaged); }
  bool reads_rate() const override { return (act(), true); }
  bool conserves_energy() const override { return (act(), true); }
  bool changes_problem() const override { return (act(), true); }
  std::optional<Refusal> prepare_problem(ContactStructure& structure) override {
    return (act(), structure.rigidity = 7, std::nullopt);
  }
  void prepare(int, std::span<const Parameters>) override { act(); }
  bool per_point() const override { return (act(), true); }
  void prepare_points(int, int, std::span<const Parameters>) override { act(); }
  void solve(ReducedProblem& problem) override { (act(), problem.points = 7); }
  double potential(const StopState& at) const override { return (act(), at.depth + at.set); }
  std::optional<ContactSlopes> linear_slopes(int lane) const override {
    return (act(), ContactSlopes{.viscosity = static_cast<double>(lane)});
  }
};

PluginManual manual() {
  return {"mine", "A stand-in.", "Registered by the tests.", "none", {}};
}

PlanOrRefusal plan_of(std::function<PlanOrRefusal()> act) {
  Registry registry;
  registry.set_current_file("here.so");
  registry.add_time(manual(), [act](const Parameters&) { return std::make_unique<Scheme>(act); });
  return registry.time("mine")->make({})->plan(1e-3, {});
}
InertiaOrRefusal mass_of(std::function<InertiaOrRefusal()> act) {
  Registry registry;
  registry.add_mass(manual(), [act](const Parameters&) { return std::make_unique<Mass>(act); });
  FiniteElementSpace space;
  space.dofs = 2;
  return registry.mass("mine")->make({})->build(space);
}
ReferenceOrRefusal motion_of(std::function<ReferenceOrRefusal()> act) {
  Registry registry;
  registry.add_reference(manual(), [act](const Parameters&) { return std::make_unique<Reference>(act); });
  return registry.reference("mine")->make({})->solve({}, {{0, 1}, {0.5}, {1}});
}
std::unique_ptr<ContactLaw> law_of(std::function<void()> act) {
  Registry registry;
  registry.add_contact(manual(), [act](const Parameters&) { return std::make_unique<Law>(act); });
  return registry.contact("mine")->make({});
}

StepPlan still() {
  StepPlan plan;
  plan.slots = {"q", "d"};
  plan.initial = {{1, 0}, {0, 1e-3}};
  plan.velocity = {.slots = {0, 1e3}};
  plan.stages.resize(1);
  plan.stages[0].update = {{{1, 1}, 0}, {{0, 1}, 0}};
  return plan;
}

struct Silent : std::exception {
  const char* what() const noexcept override { return ""; }
};

}  // namespace

TEST_CASE("what a plugin throws arrives as a fault that names plugin, file and function") {
  const std::string place = "plugin time 'mine' (here.so), plan(): ";
  CHECK_THROWS_AS(plan_of([]() -> PlanOrRefusal { throw std::runtime_error("my plan failed"); }), PluginFault);
  CHECK_THROWS_WITH(plan_of([]() -> PlanOrRefusal { throw std::runtime_error("my plan failed"); }),
                    place + "my plan failed");
  CHECK_THROWS_WITH(plan_of([]() -> PlanOrRefusal { throw 42; }), place + "an exception that says nothing");
  CHECK_THROWS_WITH(plan_of([]() -> PlanOrRefusal { throw Silent(); }), place + "an exception that says nothing");
  CHECK_THROWS_WITH(plan_of([]() -> PlanOrRefusal { throw std::bad_alloc(); }), place + "not enough memory");
  CHECK_THROWS_WITH(mass_of([]() -> InertiaOrRefusal { throw 42; }),
                    "plugin mass 'mine', build(): an exception that says nothing");
  CHECK_THROWS_WITH(motion_of([]() -> ReferenceOrRefusal { throw 42; }),
                    "plugin reference 'mine', solve(): an exception that says nothing");
}

TEST_CASE("what a plugin says in several lines arrives in one") {
  const std::string place = "plugin time 'mine' (here.so), plan(): ";
  CHECK_THROWS_WITH(plan_of([]() -> PlanOrRefusal { throw std::runtime_error("first\n  second\r\n\n"); }),
                    place + "first; second");
  CHECK_THROWS_WITH(plan_of([]() -> PlanOrRefusal { throw std::runtime_error("\n \n"); }),
                    place + "an exception that says nothing");
  const auto refused = plan_of([]() -> PlanOrRefusal { return Refusal{"too stiff:\nlower the step"}; });
  CHECK(std::get<Refusal>(refused).sentence.text == "too stiff: lower the step");
}

TEST_CASE("an error that already says what to do passes as it is") {
  CHECK_THROWS_AS(plan_of([]() -> PlanOrRefusal { throw InputError("/methods/time/beta", "no"); }), InputError);
  CHECK_THROWS_AS(plan_of([]() -> PlanOrRefusal { throw PluginError("no"); }), PluginError);
}

TEST_CASE("maps of references are guarded, and their answers have the size of a state") {
  const auto map_of = [](int count) {
    Registry registry;
    registry.add_reference(manual(), [count](const Parameters&) { return std::make_unique<Mapped>(count); });
    return std::get<std::unique_ptr<ReferenceMap>>(registry.reference("mine")->make({})->map({}));
  };
  const std::string place = "plugin reference 'mine', ";
  CHECK_THROWS_WITH(map_of(0), place + "map(): returned no object");
  const auto map = map_of(2), wrong = map_of(3);
  CHECK(map->start().size() == 2);
  CHECK(map->tip(map->start()) == std::pair(1.0, 2.0));
  CHECK(map->march(map->start(), 1, true).impacts == 3);
  CHECK(map->march(Eigen::Vector2d(-1, 0), 1, true).stopped == "below");
  CHECK_THROWS_WITH(map->weights(), place + "weights(): an exception that says nothing");
  CHECK_THROWS_WITH(wrong->start(), place + "start(): gives 3 numbers; its states have 2");
  CHECK_THROWS_WITH(wrong->march(map->start(), 1, true),
                    place + "march(): gives a derivative of 3 × 2; expected 2 × 2");
  // A reference that has none says so.
  Registry registry;
  registry.add_reference(manual(), [](const Parameters&) {
    return std::make_unique<Reference>([]() -> ReferenceOrRefusal { return Refusal{"no"}; });
  });
  CHECK(std::holds_alternative<Refusal>(registry.reference("mine")->make({})->map({})));
}

TEST_CASE("every function of a law is guarded and forwarded") {
  std::function<void()> act = [] {};
  const auto law = law_of([&] { act(); });
  ReducedProblem problem;
  const SparseRows rows(1, 2);
  ContactStructure structure{.contact = &rows, .measured = rows, .stiffness = SparseMatrix(2, 2)};
  // Each says whether the answer came through.
  const std::vector<std::pair<std::string, std::function<bool()>>> calls = {
      {"absent", [&] { return law->absent(); }},
      {"reads", [&] { return law->reads() == Evaluation::averaged; }},
      {"reads_rate", [&] { return law->reads_rate(); }},
      {"conserves_energy", [&] { return law->conserves_energy(); }},
      {"changes_problem", [&] { return law->changes_problem(); }},
      {"prepare_problem", [&] { return !law->prepare_problem(structure) && structure.rigidity == 7; }},
      {"prepare", [&] { return (law->prepare(1, {}), true); }},
      {"per_point", [&] { return law->per_point(); }},
      {"prepare_points", [&] { return (law->prepare_points(1, 1, {}), true); }},
      {"solve", [&] { return (law->solve(problem), problem.points == 7); }},
      {"potential", [&] { return law->potential({.depth = 0.5, .set = 2}) == 2.5; }},
      {"linear_slopes", [&] { return law->linear_slopes(3)->viscosity == 3; }}};
  for (const auto& [function, call] : calls) {
    INFO(function);
    act = [&, name = function] {
      REQUIRE(current_plugin_call().plugin != nullptr);
      CHECK(current_plugin_call().plugin->text() == "contact 'mine'");
      CHECK(current_plugin_call().function == name);
    };
    CHECK(call());
    CHECK(current_plugin_call().plugin == nullptr);
    act = [] { throw 42; };
    CHECK_THROWS_WITH(call(), "plugin contact 'mine', " + function + "(): an exception that says nothing");
    CHECK(current_plugin_call().plugin == nullptr);
  }
}

TEST_CASE("a call that changes the rounding changes it for itself alone, and is known by its function") {
  const KeepFloatControl test;
  const auto law = law_of([] { std::fesetround(FE_UPWARD); });
  take_float_changer();
  law->prepare(1, {});
  CHECK(std::fegetround() == FE_TONEAREST);
  law->conserves_energy();
  CHECK(std::fegetround() == FE_TONEAREST);
  const char* const changer = take_float_changer();
  REQUIRE(changer != nullptr);
  CHECK(std::string(changer) == "prepare");
  CHECK(take_float_changer() == nullptr);
  // Whatever it was before, and where the call throws.
  std::fesetround(FE_DOWNWARD);
  CHECK_THROWS_AS(plan_of([]() -> PlanOrRefusal {
                    std::fesetround(FE_UPWARD);
                    throw Silent();
                  }),
                  PluginFault);
  CHECK(std::fegetround() == FE_DOWNWARD);
  CHECK(std::string(take_float_changer()) == "plan");
  // One that puts it back, and flags that arithmetic raises, are no change.
  law_of([] {
    const int before = std::fegetround();
    std::fesetround(FE_UPWARD);
    std::feraiseexcept(FE_INEXACT);
    std::fesetround(before);
  })->prepare(1, {});
  CHECK(take_float_changer() == nullptr);
}

TEST_CASE("a measure that does not exist is not read") {
  struct Wild final : Law {
    Wild() : Law([] {}) {}
    std::optional<Evaluation> reads() const override { return static_cast<Evaluation>(9); }
  };
  Registry registry;
  registry.add_contact(manual(), [](const Parameters&) { return std::make_unique<Wild>(); });
  CHECK_THROWS_WITH(registry.contact("mine")->make({})->reads(), Contains("names the measure 9"));
}

TEST_CASE("a problem that a law changes keeps its size, and its refusal has a sentence") {
  struct Wild final : Law {
    explicit Wild(bool says) : Law([] {}), refuses(says) {}
    bool refuses;
    std::optional<Refusal> prepare_problem(ContactStructure& structure) override {
      if (refuses) return Refusal{" "};
      structure.measured = SparseRows(1, 3);
      return std::nullopt;
    }
  };
  const SparseRows rows(1, 2);
  ContactStructure structure{.contact = &rows, .measured = rows, .stiffness = SparseMatrix(2, 2)};
  const auto made = [](bool refuses) {
    Registry registry;
    registry.add_contact(manual(), [refuses](const Parameters&) { return std::make_unique<Wild>(refuses); });
    return registry.contact("mine")->make({});
  };
  CHECK_THROWS_WITH(made(true)->prepare_problem(structure), Contains("refuses without a sentence"));
  CHECK_THROWS_WITH(made(false)->prepare_problem(structure),
                    Contains("1 × 3 rows and a stiffness of 2 × 2; 1 points of 2 dofs were given"));
}

TEST_CASE("asking a guarded law allocates nothing") {
  const auto law = law_of([] {});
  ReducedProblem problem;
  const long before = allocations();
  for (int k = 0; k < 100; ++k) {
    law->solve(problem);
    law->potential({.depth = 0.5});
    law->linear_slopes(0);
  }
  CHECK(allocations() == before);
}

TEST_CASE("a factory that gives nothing, or throws, or is none, is a fault") {
  Registry registry;
  registry.add_time(manual(), [](const Parameters&) { return nullptr; });
  CHECK_THROWS_WITH(registry.time("mine")->make({}), "plugin time 'mine', make(): its factory returned no object");
  registry.add_mass(manual(), [](const Parameters&) -> std::unique_ptr<MassStrategy> { throw 42; });
  CHECK_THROWS_WITH(registry.mass("mine")->make({}), "plugin mass 'mine', make(): an exception that says nothing");
  CHECK_THROWS_WITH(registry.add_contact(manual(), nullptr), "the contact plugin 'mine' registers no factory");
}

TEST_CASE("a plan is checked before anybody sees it") {
  CHECK(std::holds_alternative<StepPlan>(plan_of([] { return still(); })));
  CHECK_THROWS_WITH(plan_of([] {
                      StepPlan plan = still();
                      plan.stages[0].update.clear();
                      return plan;
                    }),
                    "plugin time 'mine' (here.so), plan(): ill-formed plan: stage 1: update must give one combination "
                    "per slot");
  CHECK_THROWS_WITH(plan_of([] { return StepPlan{}; }), Contains("plan(): ill-formed plan: "));
}

TEST_CASE("a refusal has a sentence") {
  const std::string blank = GENERATE("", " ", "\n\t ");
  CHECK_THROWS_WITH(plan_of([&] { return Refusal{blank}; }), Contains("plan(): refuses without a sentence"));
  CHECK_THROWS_WITH(mass_of([&] { return Refusal{blank}; }), Contains("build(): refuses without a sentence"));
  CHECK_THROWS_WITH(motion_of([&] { return Refusal{blank}; }), Contains("solve(): refuses without a sentence"));
  CHECK(std::get<Refusal>(plan_of([] { return Refusal{"use β ≥ ¼"}; })).sentence.text == "use β ≥ ¼");
}

TEST_CASE("a mass is checked before anybody sees it") {
  const auto with = [](const Eigen::MatrixXd& mass) {
    return mass_of([&] {
      Inertia inertia;
      inertia.mass = mass.sparseView();
      return inertia;
    });
  };
  CHECK(std::holds_alternative<Inertia>(with(Eigen::Matrix2d::Identity())));
  CHECK_THROWS_WITH(with(Eigen::MatrixXd(0, 0)), Contains("plugin mass 'mine', build(): its mass is 0 × 0"));
  CHECK_THROWS_WITH(with(-Eigen::Matrix2d::Identity()), Contains("build(): the mass has -1 on its diagonal"));
}

TEST_CASE("a motion fits its grid") {
  ReferenceMotion found;
  found.motion.tip = found.motion.tip_velocity = found.motion.energy = found.motion.impulse = {0, 0};
  found.motion.displacement = found.motion.strain = found.motion.velocity = {0, 0};
  CHECK_NOTHROW(motion_of([&] { return found; }));
  found.coarser.tip = {0};
  CHECK_THROWS_WITH(motion_of([&] { return found; }),
                    "plugin reference 'mine', solve(): its tip has 1 values where the grid has 2");
  found.coarser.tip.clear();
  found.motion.strain.clear();
  CHECK_THROWS_WITH(motion_of([&] { return found; }), Contains("its strain has 0 values where the grid has 2"));
}
