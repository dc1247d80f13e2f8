// Plans as large as check_plan() lets them be: every operator, law and observer takes them.
#include <fmt/format.h>

#include <algorithm>
#include <ricochet/measure/motion/motion_sampler.hpp>

#include "tests/composed_plan.hpp"
#include "tests/marching.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

/// The plan with its last slot held as a sum of equal parts, so many that the plan has most_slots of them: the same
/// sums of the same numbers.
StepPlan split(const StepPlan& plan) {
  const std::size_t last = plan.slots.size() - 1, parts = static_cast<std::size_t>(most_slots) - last;
  const double share = 1.0 / static_cast<double>(parts);
  const auto weights = [&](std::vector<double>& of) {
    if (of.size() > last) of.resize(last + parts, of[last]);
  };
  const auto combination = [&](Combination& c) { weights(c.slots); };
  StepPlan out = plan;
  for (std::size_t k = 1; k < parts; ++k) out.slots.push_back(fmt::format("{}{}", plan.slots[last], k));
  out.initial[last] = {share * plan.initial[last][0], share * plan.initial[last][1]};
  out.initial.resize(last + parts, out.initial[last]);
  combination(out.velocity);
  for (QuadraticTerm& term : out.energy) weights(term.slots);
  for (auto* stages : {&out.start, &out.stages})
    for (Stage& stage : *stages) {
      if (stage.history.size() > last) stage.history.resize(last + parts, stage.history[last]);
      each_measure(stage, combination);
      for (Combination& row : stage.update) combination(row);
      Combination& sum = stage.update[last];
      for (double& w : sum.slots) w *= share;
      sum.z *= share;
      sum.w *= share;
      stage.update.resize(last + parts, sum);
    }
  return out;
}

SceneSpec forced_beam(StopsSpec::Place place) {
  SceneSpec scene = working_set();
  beam_of(scene).damping = {2e-5, 0.4};
  scene.support = {0.03, 40, 0.4};
  scene.load = Formula("0.5*x*cos(20*t) - 0.2", "/scene/load");
  scene.stops.place = place;
  // Near the lower stop, which it meets after some 10 ms.
  scene.initial.displacement = Formula("-0.03*x^2", "/scene/initial/displacement", "x");
  return scene;
}

struct Seen {
  std::vector<double> tips, tangents;
  EnergyTotals energy;
  ContactTotals contact;
  double momentum = 0;
  OperatorKind kind = OperatorKind::automatic;
  std::string every_step_because;
};

Seen seen(const SceneSpec& scene, const Methods& methods, const StepPlan& plan, double h, const CompileOptions& options,
          int lanes, int steps) {
  const auto problem = problem_of(scene, 4, methods.mass);
  const auto* entry = registry().contact(methods.contact.name);
  LaneSpec lane = scene_lane(*problem, complete(entry->manual.parameters, methods.contact.values));
  std::vector<LaneSpec> all(static_cast<std::size_t>(lanes), lane);
  for (int l = 1; l < lanes; ++l) all[static_cast<std::size_t>(l)].amplitude *= 1 + 0.1 * l;
  auto program = compile(problem, plan, h, make(entry, methods.contact), all, options);
  INFO((std::holds_alternative<Refusal>(program) ? std::get<Refusal>(program).sentence.text : ""));
  REQUIRE(std::holds_alternative<Program>(program));
  Marcher made(std::move(std::get<Program>(program)));
  Seen out;
  out.kind = made.program().kind;
  out.every_step_because = made.program().every_step_because;
  EnergyAudit audit(made);
  ContactLog log(made);
  const Observers observers{&audit, &log};
  made.start(observers);
  LaneState direction = made.lane_state(0);
  std::fill(direction.efforts.begin(), direction.efforts.end(), 0.0);
  if (options.tangents > 0) made.set_tangent(0, 0, direction);
  for (int n = 0; n < 10; ++n) {
    made.march(steps / 10, observers);
    for (int l = 0; l < lanes; ++l) out.tips.push_back(made.tip(l));
  }
  REQUIRE(made.status(0).running);
  if (options.tangents > 0) {
    out.tangents = made.tangent(0, 0).slots;
    out.tangents.resize(static_cast<std::size_t>(problem->dofs()));  // of q, the first slot
  }
  out.energy = audit.totals(0);
  out.contact = audit.contact(0);
  out.momentum = log.impulse();
  return out;
}

void check_same(const Seen& a, const Seen& b, double tolerance) {
  CHECK(a.kind == b.kind);
  CHECK(a.contact.impacts > 0);
  CHECK(a.every_step_because == b.every_step_because);
  CHECK(largest_gap(a.tips, b.tips) < 0.1 * tolerance);
  for (std::size_t i = 0; i < a.tangents.size(); ++i)
    CHECK(std::abs(a.tangents[i] - b.tangents[i]) < tolerance * (1 + std::abs(a.tangents[i])));
  const double energy = std::abs(a.energy.first.common()) + std::abs(a.energy.work_of_loads);
  CHECK(std::abs(a.energy.last.common() - b.energy.last.common()) < tolerance * energy);
  CHECK(std::abs(a.energy.last.scheme - b.energy.last.scheme) < tolerance * energy);
  CHECK(std::abs(a.energy.work_of_contact - b.energy.work_of_contact) < tolerance * energy);
  CHECK(std::abs(a.energy.work_of_damping - b.energy.work_of_damping) < tolerance * energy);
  CHECK(std::abs(a.energy.work_of_scheme - b.energy.work_of_scheme) < tolerance * energy);
  CHECK(a.contact.impacts == b.contact.impacts);
  CHECK(std::abs(a.contact.impulse - b.contact.impulse) < tolerance * (1 + a.contact.impulse));
  CHECK(std::abs(a.momentum - b.momentum) < tolerance * (1 + std::abs(a.momentum)));
}

}  // namespace

TEST_CASE("a plan of as many slots as there may be runs wherever one of few does, and equals it") {
  const auto place = GENERATE(StopsSpec::Place::tip, StopsSpec::Place::nodes);
  const Choice law = GENERATE(Choice{"signorini"}, Choice{"penalty", {{"stiffness", 1e4}}},
                              Choice{"penalty", {{"stiffness", 1e4}, {"evaluation", std::string("averaged")}}});
  const Choice time =
      GENERATE(Choice{"newmark"}, Choice{"newmark-dumont-paoli", {{"beta", 0.25}}},
               Choice{"moreau-jean", {{"restitution", 0.8}}}, Choice{"bathe"}, Choice{"central-difference"});
  constexpr double h = 2e-5;
  // A scheme that knows no restitution throws what hits a rigid stop back faster than it came: the first impact alone.
  const int steps = law.name == "signorini" ? 700 : 2000;
  const bool explicit_scheme = time.name == "central-difference";
  if (explicit_scheme && law.name == "signorini") return;  // it offers no measure for rigid laws
  const Methods methods{{explicit_scheme ? "lumped" : "consistent"}, law, time};
  const SceneSpec scene = forced_beam(place);
  const auto given = plan_of(time, h, {});
  REQUIRE(std::holds_alternative<StepPlan>(given));
  const StepPlan few = std::get<StepPlan>(given), many = split(few);
  REQUIRE(many.slots.size() == static_cast<std::size_t>(most_slots));
  REQUIRE(check_plan(many, h).value_or("nothing") == "nothing");
  const auto compare = [&](const CompileOptions& options, int lanes, double tolerance) {
    INFO(time.name << ", " << law.name << ", " << operator_name(options.kind) << ", lanes " << lanes << ", tangents "
                   << options.tangents << (options.march == MarchWay::every_step ? "" : ", flights"));
    check_same(seen(scene, methods, few, h, options, lanes, steps),
               seen(scene, methods, many, h, options, lanes, steps), tolerance);
  };
  // Sums of six numbers for one, 1e-16 each, which springs magnify little. Rigid stops at all nodes throw back points
  // one after the other, each by up to three times.
  const double tolerance = law.name == "signorini" ? 1e-3 : 1e-8;
  CompileOptions options;
  for (const OperatorKind kind : {OperatorKind::band, OperatorKind::modal, OperatorKind::sparse}) {
    options.kind = kind;
    for (const int lanes : {1, 3}) compare(options, lanes, tolerance);
  }
  options.kind = OperatorKind::automatic;
  options.march = MarchWay::automatic;
  options.expected_steps = 100'000'000;            // flights, where they can be had
  compare(options, 1, std::max(tolerance, 1e-6));  // what a flight may be wrong by
  options = {};
  if (law.name == "signorini" || law.values.size() == 1) {
    options.tangents = 1;
    compare(options, 2, tolerance);
  }
}

TEST_CASE("a plan of as many stages, efforts and levels as there may be equals the short one that it repeats") {
  constexpr double h = 2e-5;
  constexpr int steps = 1800;
  const SceneSpec scene = forced_beam(StopsSpec::Place::nodes);
  const Choice law{"penalty", {{"stiffness", 1e4}, {"evaluation", std::string("averaged")}}};
  const Methods methods{{"consistent"}, law, {"newmark"}};
  StepPlan one = std::get<StepPlan>(plan_of(methods.time, h, {}));
  // Efforts of thirteen steps, whose weights add up to those of the scheme; loads at eight levels.
  auto& effort = one.stages[0].at(Evaluation::averaged)->effort;
  effort.assign(most_efforts, 1.0 / most_efforts);
  one.start.clear();
  one.stages[0].load.assign(most_levels, {1, 1.0 / most_levels});
  const StepPlan six = composed(one, most_stages);
  REQUIRE(check_plan(six, most_stages * h).value_or("nothing") == "nothing");
  for (const OperatorKind kind : {OperatorKind::band, OperatorKind::modal, OperatorKind::sparse})
    for (const int lanes : {1, 2}) {
      CompileOptions options;
      options.kind = kind;
      INFO(operator_name(kind) << ", lanes " << lanes);
      const Seen a = seen(scene, methods, one, h, options, lanes, steps),
                 b = seen(scene, methods, six, most_stages * h, options, lanes, steps / most_stages);
      check_same(a, b, 1e-9);  // times (k + c)/6 · 6h for (k + c)h, as in substeps.cpp
    }
}
