// A stage with a second unknown, R w = ι Hᵀp: what is marched is the plan, whatever operator, law, mass and other
// lanes.
#include "runners/check/scheme_checks.hpp"
#include "tests/allocations.hpp"
#include "tests/marching.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace stage_impulse_tests {
namespace {

constexpr double h = 1e-4;

// Newmark (0.3, 0.6) with an impulse in which every term is present: R and feed of all matrices, ι ≠ 1. An effort also
// acts on z, now and a step later. Neither accurate nor stable by design; damping and a short integration suffice.
StepPlan full_plan(bool gated) {
  const double beta = 0.3, gamma = 0.6, lag = (1 - gamma) * h, curve = (0.5 - beta) * h * h;
  StepPlan plan;
  plan.slots = {"q", "v", "a"};
  plan.initial = {{1, 0}, {0, 1}, {0, 0}};
  plan.velocity = {.slots = {0, 1}};
  const Combination end{.slots = {1, h, curve}, .z = beta * h * h, .w = 0.4 * h};
  const Combination rate{.slots = {0, 1, lag}, .z = gamma * h, .w = 0.9};
  Stage stage;
  stage.matrix = {1, gamma * h, beta * h * h};
  stage.history = {{0, 0, -1}, {0, -1, -h}, {0, -lag, -curve}};
  stage.load = {{1, 1}};
  stage.impulse = {.R = {1 / h, 0.4, 0.2 * h}, .feed = {0.3 / h, -0.7, -0.3 * h}};
  stage.impact = {.value = end, .effort = {0.2, 0.1}, .impulse = 0.8};
  if (gated) {
    stage.impact->value = rate;
    stage.impact->gate = VelocityGate{{.slots = {1, h / 2}}, {}, {.slots = {0, 1}}, {}, 0.5};
  }
  for (const Evaluation evaluation : {Evaluation::implicit_end, Evaluation::averaged, Evaluation::explicit_start})
    stage.at(evaluation) = {.displacement = end, .effort = {0.2, 0.1}, .impulse = 0.8};
  stage.at(Evaluation::averaged)->impulse = 0;
  stage.at(Evaluation::explicit_start)->displacement = {.slots = {1, h}};
  stage.update = {end, rate, {.slots = {}, .z = 1, .w = 0.1 / h}};
  plan.stages = {stage};
  return plan;
}

SceneSpec touching(double alpha, double eta = 0) {
  SceneSpec scene = working_set();
  beam_of(scene).damping = {.stiffness = alpha, .mass = eta};
  scene.support.amplitude = 0.005;
  scene.load = Formula(-3.0);
  scene.stops.place = StopsSpec::Place::nodes;
  scene.stops.lower = Formula(-0.01);
  scene.stops.upper = Formula(0.1);
  return scene;
}

struct Law {
  Choice contact;
  bool gated = false;
};
const std::vector<Law>& laws() {
  const auto penalty = [](const char* evaluation) {
    return Choice{"penalty", {{"stiffness", 1e3}, {"evaluation", std::string(evaluation)}}};
  };
  static const std::vector<Law> all = {
      {{"signorini"}}, {{"signorini"}, true}, {penalty("implicit")}, {penalty("averaged")}, {penalty("explicit")}};
  return all;
}

Marcher impulsive(const Law& law, const SceneSpec& scene, const Choice& mass, const CompileOptions& options,
                  const Lanes& lanes = one_lane) {
  const auto problem = problem_of(scene, 5, mass);
  const auto* entry = registry().contact(law.contact.name);
  const LaneSpec lane = scene_lane(*problem, complete(entry->manual.parameters, law.contact.values));
  auto program = compile(problem, full_plan(law.gated), h, make(entry, law.contact), lanes(lane), options);
  INFO((std::holds_alternative<Refusal>(program) ? std::get<Refusal>(program).sentence.text : ""));
  REQUIRE(std::holds_alternative<Program>(program));
  return Marcher(std::move(std::get<Program>(program)));
}

CompileOptions with(OperatorKind kind, bool eager = false) {
  CompileOptions options;
  options.kind = kind;
  options.eager_delassus = eager;
  return options;
}

Eigen::VectorXd nodal_slots(const Marcher& marcher, int lane) {
  const int rows = marcher.program().model->rows();
  Eigen::VectorXd all(rows * marcher.slot_count());
  for (int j = 0; j < marcher.slot_count(); ++j) {
    Eigen::VectorXd slot(rows);
    for (int i = 0; i < rows; ++i) slot[i] = marcher.slot(j)[i * marcher.width() + lane];
    all.segment(j * rows, rows) = marcher.program().model->to_nodal(slot);
  }
  return all;
}

}  // namespace

TEST_CASE("a plan with an impulse is marched as its equations say, with every law that it offers") {
  for (const Law& law : laws())
    for (const OperatorKind kind : {OperatorKind::band, OperatorKind::modal, OperatorKind::sparse}) {
      Marcher beam = impulsive(law, touching(1e-4, 0.3), {"consistent"}, with(kind));
      checking::DenseMarch dense(beam);
      beam.start(&dense);
      beam.march(400, &dense);
      INFO(law.contact.name << (law.gated ? " gated, " : ", ") << operator_name(kind));
      CHECK(beam.status(0).running);
      CHECK(dense.difference() == "");
      CHECK(beam.delassus_columns() > 0);
    }
}

TEST_CASE("what a law sees of z and w together is symmetric and moves each point towards its push") {
  const auto problem = problem_of(touching(1e-4, 0.3), 5, {"consistent"});
  for (const OperatorKind kind : {OperatorKind::band, OperatorKind::modal}) {
    const MarchModel model(problem, kind == OperatorKind::modal);
    const Stage stage = full_plan(false).stages[0];
    auto S = make_operator(kind, model, fold(stage, problem->damping, 3), 1);
    auto R = make_operator(kind, model, fold(stage.impulse->R, problem->damping), 1);
    ImpulseProgram program;
    program.op = std::move(std::get<std::unique_ptr<StageOperator>>(R));
    program.direct = 0.3;
    program.elastic = -0.3 * h;
    program.weight = 0.8;
    program.measure_z = stage.impact->value.z;
    program.measure_w = stage.impact->value.w;
    StageImpulse impulse(program, *std::get<std::unique_ptr<StageOperator>>(S), model);
    const int points = model.contact().rows();
    for (int i = 0; i < points; ++i) {
      CHECK(impulse.column(i)[i] > 0);
      // Round-off of two solves, in the size of the diagonal.
      for (int j = 0; j < i; ++j)
        CHECK(std::abs(impulse.column(i)[j] - impulse.column(j)[i]) <= 1e-11 * impulse.column(i)[i]);
    }
    CHECK(impulse.computed() == points);
  }
}

TEST_CASE("lanes with an impulse equal single runs bit for bit, and columns computed early change nothing") {
  const auto varied = [](const LaneSpec& lane) {
    std::vector<LaneSpec> lanes;
    for (int k = 0; k < 5; ++k) {
      lanes.push_back(lane);
      lanes.back().position *= 1 - 0.15 * k;
      lanes.back().velocity *= 1 + 0.2 * k;
    }
    return lanes;
  };
  for (const Law& law : laws())
    for (const OperatorKind kind : {OperatorKind::band, OperatorKind::modal}) {
      Marcher block = impulsive(law, touching(1e-4), {"consistent"}, with(kind, true), varied);
      block.start();
      block.march(400);
      for (int k = 0; k < 5; ++k) {
        Marcher single = impulsive(law, touching(1e-4), {"consistent"}, with(kind), [&](const LaneSpec& lane) {
          return std::vector{varied(lane)[static_cast<std::size_t>(k)]};
        });
        single.start();
        single.march(400);
        INFO(law.contact.name << (law.gated ? " gated" : "") << " lane " << k);
        CHECK(nodal_slots(single, 0) == nodal_slots(block, k));
      }
    }
}

TEST_CASE("a mass in factors has impulses too, where R is regular") {
  for (const char* velocity : {"P0", "P1"})
    for (const Law& law : laws()) {
      if (law.gated) continue;  // a point without mass has no velocity to reverse
      const Choice mass{"singular", {{"velocity", std::string(velocity)}}};
      Marcher band = impulsive(law, touching(1e-4), mass, with(OperatorKind::band));
      Marcher modal = impulsive(law, touching(1e-4), mass, with(OperatorKind::modal));
      for (Marcher* one : {&band, &modal}) {
        one->start();
        one->march(260);
      }
      INFO(velocity << " " << law.contact.name);
      CHECK(band.delassus_columns() > 0);
      // Accelerations of stiff modes carry 1/h² of the round-off of positions, and impacts make it grow. Positions are
      // compared, to 10⁹ times their round-off.
      CHECK((band.position(0) - modal.position(0)).norm() <= 1e-7 * modal.position(0).norm());
    }
}

TEST_CASE("tangents of a plan with an impulse are the derivative of its step") {
  CompileOptions options = with(OperatorKind::band);
  options.tangents = 1;
  const double offset = 1e-7;
  for (const Law& law : laws()) {
    const auto three = [](const LaneSpec& lane) { return std::vector<LaneSpec>(3, lane); };
    SceneSpec pressed = touching(1e-3);
    // Contact that stays: a stop that the load presses on, so that no side opens between the two motions.
    pressed.load = Formula(-300.0);
    pressed.stops.upper.reset();
    Marcher block = impulsive(law, pressed, {"consistent"}, options, three);
    block.start();
    block.march(500);
    LaneState base = block.lane_state(0);
    LaneSpec spec = block.program().lanes[0];
    if (law.gated) {
      // What rests flickers at velocity level: one impact instead, of points that come, beyond a stop that stands
      // higher.
      const std::size_t rows = base.slots.size() / 3;
      for (std::size_t i = 0; i < rows; ++i) base.slots[rows + i] = 50 * base.slots[i];
      spec.lower.array() += 0.02;
    }
    LaneState direction = base;
    std::fill(direction.efforts.begin(), direction.efforts.end(), 0.0);
    const auto moved = [&](double by) {
      LaneState state = base;
      for (std::size_t i = 0; i < state.slots.size(); ++i) state.slots[i] += by * direction.slots[i];
      return state;
    };
    block.set_lane(0, spec, base);
    block.set_tangent(0, 0, direction);
    block.set_lane(1, spec, moved(offset));
    block.set_lane(2, spec, moved(-offset));
    block.march(law.gated ? 1 : 8);
    const LaneState tangent = block.tangent(0, 0), ahead = block.lane_state(1), behind = block.lane_state(2);
    double wrong = 0, size = 0;
    for (std::size_t i = 0; i < tangent.slots.size(); ++i) {
      const double difference = (ahead.slots[i] - behind.slots[i]) / (2 * offset);
      wrong = std::max(wrong, std::abs(tangent.slots[i] - difference));
      size = std::max(size, std::abs(difference));
    }
    INFO(law.contact.name << (law.gated ? " gated" : ""));
    CHECK(wrong < 1e-4 * size);
  }
}

TEST_CASE("an integration with an impulse allocates nothing, columns included") {
  for (const Law& law : laws()) {
    Marcher beam = impulsive(law, touching(1e-4), {"consistent"}, with(OperatorKind::band));
    beam.start();
    const long before = allocations();
    beam.march(400);
    CHECK(allocations() == before);
    CHECK(beam.delassus_columns() > 0);
  }
}

TEST_CASE("what cannot carry an impulse is refused with its cause") {
  const auto refusal = [](const Choice& contact, const Choice& mass, const std::function<void(Stage&)>& change) {
    const auto problem = problem_of(touching(1e-4), 5, mass);
    const auto* entry = registry().contact(contact.name);
    StepPlan plan = full_plan(false);
    change(plan.stages[0]);
    auto program =
        compile(problem, plan, h, make(entry, contact),
                {scene_lane(*problem, complete(entry->manual.parameters, contact.values))}, with(OperatorKind::band));
    return std::holds_alternative<Refusal>(program) ? std::get<Refusal>(program).sentence.text : std::string("nothing");
  };
  const Choice consistent{"consistent"}, massless{"singular", {{"velocity", std::string("P1")}}};
  using Catch::Matchers::Contains;
  CHECK_THAT(refusal({"signorini"}, massless,
                     [](Stage& stage) {
                       stage.impulse->R = {1 / h, 0, 0};
                     }),
             Contains("the scheme's impulse has no solution") && Contains("use a regular mass"));
  CHECK_THAT(refusal({"signorini"}, consistent,
                     [](Stage& stage) {
                       stage.impulse->R = {0, 0, h};
                     }),
             Contains("feeds its step with mass and R has none"));
  // A damped law that would need two different columns: those of the rate and those of the displacement.
  const Choice damped{"kelvin-voigt", {{"stiffness", 1e3}, {"viscosity", 1.0}}};
  const auto rated = [](double w) {
    return [w](Stage& stage) {
      for (auto& compliance : stage.compliance)
        if (compliance) compliance->rate = {.slots = {0, 1, 0.4 * h}, .z = 0.6 * h, .w = w};
    };
  };
  CHECK_THAT(refusal(damped, consistent, rated(0.9)), Contains("moves the rate at contact otherwise"));
  CHECK(refusal(damped, consistent, rated(0.8)) == "nothing");  // 0.6 : 0.8 as 0.3 : 0.4
}

}  // namespace stage_impulse_tests
