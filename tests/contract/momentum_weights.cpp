// What an effort finally gives to a free mass follows from the plan alone, however its unknown and its slots are
// chosen.
#include <random>
#include <ricochet/contract/momentum_weights.hpp>
#include <ricochet/contract/plan_algebra.hpp>
#include <ricochet/contract/unit_mass.hpp>
#include <ricochet/measure/contact/impact_recorder.hpp>

#include "tests/composed_plan.hpp"
#include "tests/contract/sub_step_plans.hpp"
#include "tests/marching.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

constexpr std::optional<Evaluation> rigid;

std::vector<std::optional<Evaluation>> evaluations_and_rigid() {
  return {rigid, Evaluation::implicit_end, Evaluation::averaged, Evaluation::explicit_start, Evaluation::conserving};
}

/// c with z written as by·z + Σ add_j x_j.
void substitute(Combination& c, double by, const std::vector<double>& add) {
  if (c.z == 0) return;
  c.slots.resize(add.size(), 0.0);
  for (std::size_t j = 0; j < add.size(); ++j) c.slots[j] += c.z * add[j];
  c.z *= by;
}

/// The stage with the unknown by·z + Σ add_j x_j, and its equation times `times`.
void change_unknown(Stage& stage, double by, const std::vector<double>& add, double times) {
  stage.history.resize(add.size());
  for (std::size_t j = 0; j < add.size(); ++j) stage.history[j] = times * (stage.history[j] - add[j] * stage.matrix);
  stage.matrix = times * by * stage.matrix;
  if (stage.impulse) stage.impulse->feed = times * stage.impulse->feed;
  for (Combination& row : stage.update) substitute(row, by, add);
  each_measure(stage, [&](Combination& c) { substitute(c, by, add); });
  const auto efforts = [&](std::vector<double>& weights) {
    for (double& w : weights) w *= times;
  };
  if (stage.impact) efforts(stage.impact->effort);
  for (auto& one : stage.compliance)
    if (one) efforts(one->effort);
}

/// The plan with slot j counted in units of `units[j]`.
void change_units(StepPlan& plan, const std::vector<double>& units) {
  const auto combination = [&](Combination& c) {
    for (std::size_t j = 0; j < c.slots.size(); ++j) c.slots[j] *= units[j];
  };
  for (std::size_t j = 0; j < units.size(); ++j)
    plan.initial[j] = {plan.initial[j][0] / units[j], plan.initial[j][1] / units[j]};
  combination(plan.velocity);
  for (auto* stages : {&plan.start, &plan.stages})
    for (Stage& stage : *stages) {
      for (std::size_t j = 0; j < stage.history.size(); ++j) stage.history[j] = units[j] * stage.history[j];
      for (std::size_t j = 0; j < stage.update.size(); ++j) {
        combination(stage.update[j]);
        stage.update[j] = stage.update[j] / units[j];
      }
      each_measure(stage, combination);
    }
}

/// What a mass under 1 N of the k-th stage of some step has for a mean speed, over many steps once it goes on: marched.
double marched_momentum(const StepPlan& plan, const StageEfforts& efforts, std::size_t source, double h) {
  constexpr int settle = 2000, steps = 1000;
  UnitMass mass(plan, 0, 0);
  double from = 0;
  for (int n = 0; n < settle + steps; ++n) {
    if (n == settle) from = mass.slots[0];
    for (std::size_t k = 0; k < plan.stages.size(); ++k) {
      const std::ptrdiff_t back = static_cast<std::ptrdiff_t>(static_cast<std::size_t>(n) * plan.stages.size() + k) -
                                  static_cast<std::ptrdiff_t>(source);
      const StageEffort& one = efforts[k];
      const bool acts = back >= 0 && back < static_cast<std::ptrdiff_t>(one.weights.size());
      const double w = back == 0 ? UnitMass::jump(plan.stages[k], one.impulse) : 0.0;
      mass.update(plan.stages[k],
                  mass.unknown(plan.stages[k], 0, acts ? one.weights[static_cast<std::size_t>(back)] : 0.0, w), w);
    }
  }
  return (mass.slots[0] - from) / (steps * h);
}

/// Every time scheme of the program with its own parameters, and some with others.
std::vector<std::pair<std::string, StepPlan>> every_plan(double h) {
  std::vector<std::pair<std::string, StepPlan>> all;
  const auto add = [&](const Choice& time, const std::string& words) {
    auto made = plan_of(time, h, {.dofs = 1, .contact = true});
    if (auto* plan = std::get_if<StepPlan>(&made)) all.emplace_back(words, std::move(*plan));
  };
  for (const std::string& name : registry().names(Role::time)) add({name}, name);
  REQUIRE(all.size() > 15);
  for (const double rho : {0.0, 0.5, 1.0}) {
    add({"bathe", {{"rho_inf", rho}, {"split", 0.4}}}, "bathe");
    add({"generalised-alpha", {{"rho_inf", rho}}}, "generalised-alpha");
    add({"wbz-alpha", {{"rho_inf", rho}}}, "wbz-alpha");
  }
  add({"newmark", {{"beta", 0.36}, {"gamma", 0.7}}}, "newmark");
  add({"moreau-jean", {{"theta", 1.0}}}, "moreau-jean");
  add({"noh-bathe", {{"split", 0.7}}}, "noh-bathe");
  for (const double split : {0.365, 0.42, 0.499}) all.emplace_back("three sub-steps", three_sub_steps(h, split));
  all.emplace_back("bathe, new position", bathe_by_position(h, 0.5));
  return all;
}

}  // namespace

TEST_CASE("Bathe's two sub-steps give h/3 and 2h/3, whatever their unknown, at any step") {
  for (const double h : {10.0, 1e-2, 1e-4, 1e-5, 1e-7}) {
    const std::vector<double> thirds = {h / 3, 2 * h / 3};
    for (const std::optional<Evaluation>& reads : {rigid, std::optional(Evaluation::implicit_end)}) {
      const StepPlan by_acceleration = std::get<StepPlan>(plan_of({"bathe", {{"split", 0.5}}}, h, {})),
                     by_position = bathe_by_position(h, 0.5);
      REQUIRE(check_plan(by_position, h).value_or("nothing") == "nothing");
      INFO("h = " << h);
      // The fraction itself.
      for (const StepPlan* plan : {&by_acceleration, &by_position})
        for (std::size_t k = 0; k < 2; ++k)
          CHECK(effort_momenta(*plan, reads).stages[k] == Approx(thirds[k]).epsilon(4e-16));
    }
  }
}

TEST_CASE("momenta are the mean speed at which a marched mass finally goes on") {
  constexpr double h = 1e-3;
  for (const auto& [name, plan] : every_plan(h))
    for (const std::optional<Evaluation>& reads : evaluations_and_rigid()) {
      const StageEfforts efforts = stage_efforts(plan.stages, reads);
      const EffortMomenta momenta = effort_momenta(plan, reads);
      INFO(name << ", " << (reads ? evaluation_word(*reads) : "rigid"));
      REQUIRE(momenta.why_none.empty());
      // A mean over 1000 steps.
      for (std::size_t k = 0; k < plan.stages.size(); ++k)
        CHECK(std::abs(momenta.stages[k] - marched_momentum(plan, efforts, k, h)) < 2e-3 * h);
    }
}

TEST_CASE("momenta do not depend on the unknowns, the scale of the equations or the units of the slots") {
  constexpr double h = 1e-3;
  std::mt19937 random(20);
  std::uniform_real_distribution<double> sign(-1, 1), power(-6, 6);
  const auto scale = [&] { return (sign(random) < 0 ? -1 : 1) * std::pow(10, power(random)); };
  for (const auto& [name, plan] : every_plan(h))
    for (int trial = 0; trial < 4; ++trial) {
      StepPlan other = plan;
      const std::size_t n = plan.slots.size();
      for (auto* stages : {&other.start, &other.stages})
        for (Stage& stage : *stages) {
          // A share of each slot of the size that the slot has in what z stands for, with a tenth of noise.
          std::vector<double> add(n, 0.0);
          double of_z = 0;
          for (const Combination& row : stage.update) of_z = std::max(of_z, std::abs(row.z));
          for (const Combination& row : stage.update)
            for (std::size_t j = 0; j < row.slots.size() && row.z != 0; ++j)
              if (add[j] == 0 && std::abs(row.z) == of_z) add[j] = sign(random) * row.slots[j] / row.z;
          // A stage that gives work back has its effort as it is.
          const bool restores = std::any_of(plan.stages.begin(), plan.stages.end(),
                                            [](const Stage& one) { return one.impact && one.impact->restores > 0; });
          if (restores)
            change_unknown(stage, std::abs(scale()), add, 1);
          else
            change_unknown(stage, scale(), add, scale());
        }
      std::vector<double> units(n, 1.0);
      for (std::size_t j = 1; j < n; ++j) units[j] = std::abs(scale());
      change_units(other, units);
      INFO(name << ", trial " << trial);
      REQUIRE(check_plan(steps_of(other), h).value_or("nothing") == "nothing");
      for (const std::optional<Evaluation>& reads : {rigid, std::optional(Evaluation::averaged)}) {
        const EffortMomenta given = effort_momenta(plan, reads), found = effort_momenta(other, reads);
        REQUIRE(found.why_none.empty());
        for (std::size_t k = 0; k < given.stages.size(); ++k)
          CHECK(std::abs(found.stages[k] - given.stages[k]) < 1e-9 * h);
        for (std::size_t k = 0; k < given.start.size(); ++k)
          CHECK(std::abs(found.start[k] - given.start[k]) < 1e-9 * h);
      }
    }
}

TEST_CASE("momenta of three sub-steps, of sub-steps in a row and of efforts of several levels add up to the step") {
  constexpr double h = 1e-3;
  for (const double split : {0.365, 0.42, 0.4999}) {
    const auto momenta = effort_momenta(three_sub_steps(h, split), rigid).stages;
    // The weights of its acceleration in the quadrature: that of the last stage is in the next step's, too.
    const double w3 = split / 2, w1 = (1 - w3) / 2, w2 = (0.5 - w3 - split * w1) / (2 * split), w0 = w1 - w2;
    CHECK(momenta[0] == Approx(w1 * h).epsilon(1e-9));
    CHECK(momenta[1] == Approx(w2 * h).epsilon(1e-9));
    CHECK(momenta[2] == Approx((w3 + w0) * h).epsilon(1e-9));
  }
  StepPlan levels = std::get<StepPlan>(plan_of({"newmark"}, h, {}));
  levels.stages[0].at(Evaluation::implicit_end)->effort = {0.2, 0.5, 0.3};
  CHECK(effort_momenta(levels, Evaluation::implicit_end).stages[0] == Approx(h).epsilon(1e-12));
  levels.stages[0].at(Evaluation::implicit_end)->effort = {0.2, 0.5, 0.1};
  CHECK(effort_momenta(levels, Evaluation::implicit_end).stages[0] == Approx(0.8 * h).epsilon(1e-12));
  for (const int n : {2, 5})
    for (const double each : effort_momenta(composed(levels, n), Evaluation::implicit_end).stages)
      CHECK(each == Approx(0.8 * h).epsilon(1e-12));
}

TEST_CASE("an effort whose push goes on, or has no mass to push, gives no momentum, and contact is refused") {
  constexpr double h = 1e-3;
  // A push that the scheme keeps, u ← c u + z: v grows by h u in each step.
  const auto [q, v, u] = plan_algebra::slots<3>();
  const auto pushed = [&, v = v, u = u](double c) {
    StepPlan made = std::get<StepPlan>(plan_of({"midpoint"}, h, {}));
    REQUIRE(made.slots.size() == 2);
    made.slots.emplace_back("u");
    made.initial.push_back({0, 0});
    Stage& stage = made.stages[0];
    stage.update[1] = stage.update[1] + h * u;
    stage.update.push_back(c * u + plan_algebra::z);
    made.start.clear();
    REQUIRE(check_plan(made, h).value_or("nothing") == "nothing");
    return made;
  };
  CHECK(effort_momenta(pushed(1), rigid).why_none == "a free mass may go on at a speed that changes for ever");
  // What fades away is part of the momentum: h (1 + u₀/(1−c)), u₀ = 1/h of the mid-point rule's z per N.
  const double u0 = 1 / pushed(0.5).stages[0].matrix.M;
  CHECK(effort_momenta(pushed(0.5), rigid).stages[0] == Approx(h + h * u0 / 0.5).epsilon(1e-9));
  const StepPlan plan = pushed(1.1);
  const EffortMomenta momenta = effort_momenta(plan, rigid);
  CHECK(momenta.why_none == "what an effort of stage 1 gives to a free mass grows for ever");
  CHECK(std::isnan(momenta.stages[0]));
  CHECK_THAT(print_plan(plan), Catch::Matchers::Contains("no contact: what an effort of stage 1 gives"));

  SceneSpec scene;
  scene.structure = OscillatorSpec{.mass = 1, .stiffness = 0, .damping = 0, .force = {}};
  scene.stops.lower = Formula(0.0);
  scene.stops.place = StopsSpec::Place::tip;
  const auto problem = problem_of(scene, 1, {"consistent"});
  const auto compiled = [&](const char* law) {
    const auto* entry = registry().contact(law);
    return compile(problem, plan, h, make(entry, {law}),
                   {scene_lane(*problem, complete(entry->manual.parameters, {}))});
  };
  const auto refused = compiled("signorini");
  REQUIRE(std::holds_alternative<Refusal>(refused));
  CHECK(std::get<Refusal>(refused).sentence.text ==
        "contact gives no definite impulse under this time scheme, as what an effort of stage 1 gives to a free mass "
        "grows for ever: use another time scheme, or the contact law none");
  CHECK(std::holds_alternative<Program>(compiled("none")));
}

TEST_CASE("a momentum that alternates for ever is none, and one that nearly does is the limit") {
  constexpr double h = 1e-3;
  // Explicit generalised-α (Hulbert and Chung 1996) on a free mass: (1−α) a₁ + α a₀ = p, v₁ = v₀ + (α−½) h a₀ + (3/2−α)
  // h a₁.
  const auto plan_with = [&](double alpha) {
    using namespace plan_algebra;
    const auto [q, v, a] = slots<3>();
    StepPlan plan;
    plan.slots = {"q", "v", "a"};
    plan.initial = {{1, 0}, {0, 1}, {0, 0}};
    Stage stage = equation(M * ((1 - alpha) * z + alpha * a) + C * v + K * q, at(0));
    const Combination next = q + h * v + h * h / 2 * z;
    stage.impact = {.value = next};
    stage.update = {next, v + (alpha - 0.5) * h * a + (1.5 - alpha) * h * z, z};
    plan.stages = {stage};
    plan.velocity = v;
    return plan;
  };
  for (const double alpha : {0.0, 0.3, 0.499, 0.5 - 1e-6}) {
    INFO("alpha = " << alpha);
    REQUIRE(check_plan(plan_with(alpha), h).value_or("nothing") == "nothing");
    CHECK(effort_momenta(plan_with(alpha), rigid).why_none.empty());
    CHECK(effort_momenta(plan_with(alpha), rigid).stages[0] == Approx(h).epsilon(1e-9));
  }
  CHECK(effort_momenta(plan_with(0.5), rigid).why_none ==
        "what an effort of stage 1 gives to a free mass changes for ever");
}

TEST_CASE("impulse and time in contact of a bounce are the mass's own, whatever the unknown of the scheme") {
  SceneSpec scene;
  scene.structure = OscillatorSpec{.mass = 2, .stiffness = 0, .damping = 0, .force = {}};
  scene.stops.lower = Formula(0.0);
  scene.stops.place = StopsSpec::Place::tip;
  scene.initial.displacement = Formula(0.1037);
  scene.initial.velocity = Formula(-1.0);
  const Choice law{"penalty", {{"stiffness", 1e4}}};
  const auto problem = problem_of(scene, 1, {"consistent"});
  for (const double h : {1e-3, 1e-4, 1e-5})
    for (const bool three : {false, true}) {
      const auto* entry = registry().contact(law.name);
      auto program = compile(problem, three ? three_sub_steps(h, 0.4) : bathe_by_position(h, 0.5), h, make(entry, law),
                             {scene_lane(*problem, complete(entry->manual.parameters, law.values))});
      REQUIRE(std::holds_alternative<Program>(program));
      Marcher made(std::move(std::get<Program>(program)));
      ImpactRecorder recorder(made);
      made.start(&recorder);
      made.march(std::llround(0.2 / h), &recorder);
      const StopTotals& totals = recorder.totals(0, 0, StopSide::lower);
      INFO("h = " << h << (three ? ", three sub-steps" : ", two"));
      // 2 m v and π √(m/k); a step of 1e-3 s is 0.07 of a radian of the bounce.
      CHECK(totals.impulse == Approx(4).epsilon(h == 1e-3 ? 1e-3 : 1e-5));
      CHECK(totals.contact_time == Approx(M_PI * std::sqrt(2e-4)).margin(2 * h));
    }
}
