// n steps of h are one step of n sub-steps: in motion, energies, works, impulses, counts and times.
#include <ricochet/measure/motion/motion_sampler.hpp>
#include <ricochet/measure/stability/step_map.hpp>

#include "tests/composed_plan.hpp"
#include "tests/marching.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

struct Case {
  std::string name;
  SceneSpec scene;
  int elements;
  double h, stiffness;
  int steps;
};

SceneSpec oscillator(double place, double speed) {
  SceneSpec scene;
  scene.structure = OscillatorSpec{.mass = 1.3, .stiffness = 40, .damping = 0.3, .force = {3, 9, 0.2}};
  scene.stops.lower = Formula(-0.1);
  scene.stops.upper = Formula(0.12);
  scene.stops.place = StopsSpec::Place::tip;
  scene.support = {0.02, 7, 0.4};
  scene.load = Formula("-2*cos(3*t)", "/scene/load", "t");
  scene.initial.displacement = Formula(place);
  scene.initial.velocity = Formula(speed);
  return scene;
}

std::vector<Case> cases() {
  SceneSpec bar;
  bar.structure = BarSpec{.length = 1, .EA = 400, .rhoA = 1, .fixed = BarSpec::Fixed::right, .damping = {1e-4, 0.1}};
  bar.stops.lower = Formula(-0.01);
  bar.stops.upper = Formula(0.02);
  bar.stops.place = StopsSpec::Place::tip;
  bar.support = {0.002, 15, 0.3};
  bar.load = Formula("-3*cos(9*t)", "/scene/load");
  bar.initial.displacement = Formula("0.02*(1-x)", "/scene/initial/displacement", "x");
  SceneSpec beam = working_set();
  beam_of(beam).damping = {2e-5, 0.4};
  beam.support.amplitude = 0.03;
  beam.support.phase = 0.4;
  beam.load = Formula("0.5*x*cos(20*t) - 0.2", "/scene/load");
  beam.stops.place = StopsSpec::Place::nodes;
  // The second starts at its stop: contact in the first step, hence in the start rule.
  return {{"oscillator", oscillator(0.05, -1.1), 1, 1e-3, 1e4, 600},
          {"oscillator at its stop", oscillator(-0.1, -0.8), 1, 1e-3, 1e4, 300},
          {"bar", bar, 6, 1e-3, 1e3, 300},
          {"beam", beam, 4, 1e-4, 1e3, 900}};
}

std::vector<Choice> schemes() {
  const std::string second = "second-order", first = "first-order", weighted = "weighted";
  return {{"newmark"},
          {"newmark", {{"beta", 0.36}, {"gamma", 0.7}}},
          {"newmark-dumont-paoli", {{"beta", 0.25}, {"start", second}}},
          {"newmark-dumont-paoli", {{"start", first}}},
          {"newmark-dumont-paoli", {{"restitution", 0.8}, {"start", second}}},
          {"newmark-dumont-paoli", {{"restitution", 0.8}, {"start", first}}},
          {"moreau-jean", {{"restitution", 0.8}}},
          {"midpoint"},
          {"hht-alpha"},
          {"hht-alpha", {{"alpha", -0.3}, {"contact", weighted}}}};
}

std::vector<Choice> laws(double stiffness) {
  std::vector<Choice> all = {{"signorini"}};
  for (const std::string evaluation : {"implicit", "averaged", "explicit"})
    all.push_back({"penalty", {{"stiffness", stiffness}, {"evaluation", evaluation}}});
  return all;
}

// A marcher of the plan's step h, or of n sub-steps of it.
Marcher made(const Case& one, const Methods& methods, int n, const CompileOptions& options = {},
             const Lanes& lanes = one_lane) {
  const auto problem = problem_of(one.scene, one.elements, methods.mass);
  const auto* entry = registry().contact(methods.contact.name);
  auto law = make(entry, methods.contact);
  auto plan = plan_of(methods.time, one.h, problem_facts(*problem, *law));
  REQUIRE(std::holds_alternative<StepPlan>(plan));
  const StepPlan whole = n == 1 ? std::get<StepPlan>(plan) : composed(std::get<StepPlan>(plan), n);
  const LaneSpec lane = scene_lane(*problem, complete(entry->manual.parameters, methods.contact.values));
  auto program = compile(problem, whole, n * one.h, std::move(law), lanes(lane), options);
  INFO((std::holds_alternative<Refusal>(program) ? std::get<Refusal>(program).sentence.text : ""));
  REQUIRE(std::holds_alternative<Program>(program));
  return Marcher(std::move(std::get<Program>(program)));
}

class Both final : public StepObserver {
 public:
  explicit Both(const Marcher& marcher) : audit(marcher), log(marcher) {}
  void stage_solved(const Marcher& marcher, const StageView& view) override {
    audit.stage_solved(marcher, view);
    log.stage_solved(marcher, view);
  }
  void step_done(Marcher& marcher) override {
    audit.step_done(marcher);
    log.step_done(marcher);
  }
  EnergyAudit audit;
  ContactLog log;
};

// Differences of two runs, relative to sizes of the whole run, and what they are of.
class Differences {
 public:
  void of(const char* what, double a, double b, double scale) {
    const double difference = std::abs(a - b) / scale;
    if (!(difference <= largest)) {
      largest = difference;
      where = what;
    }
  }
  double largest = 0;
  std::string where = "nothing";
};

void compare(const EnergySample& a, const EnergySample& b, double scale, Differences& differ) {
  differ.of("kinetic energy", a.kinetic, b.kinetic, scale);
  differ.of("elastic energy", a.elastic, b.elastic, scale);
  differ.of("energy of the law", a.contact, b.contact, scale);
  differ.of("energy of the scheme", a.scheme, b.scheme, scale);
}

}  // namespace

TEST_CASE("n steps of h are one step of n sub-steps") {
  const Case one = GENERATE(from_range(cases()));
  const Choice time = GENERATE(from_range(schemes()));
  for (const Choice& law : laws(one.stiffness))
    for (const int n : {2, 3}) {
      const Methods methods{{"consistent"}, law, time};
      Marcher fine = made(one, methods, 1), coarse = made(one, methods, n);
      Both of_fine(fine), of_coarse(coarse);
      fine.start(&of_fine);
      coarse.start(&of_coarse);
      Differences differ;
      const double length = 0.1;
      // A scheme that knows no restitution throws what hits a rigid stop back up to three times as fast as it came.
      // Round-off grows by as much with each impact, so that only the first ones are compared.
      const bool throws_back = law.name == "signorini" && fine.program().plan.facts.restitution == Restitution::ignored;
      for (int step = 1; step <= one.steps / n / (throws_back ? 4 : 1); ++step) {
        coarse.march(step - coarse.step(), &of_coarse);
        fine.march(step * n - fine.step(), &of_fine);
        differ.of("position", (coarse.position(0) - fine.position(0)).lpNorm<Eigen::Infinity>(), 0, length);
      }
      const EnergyTotals &a = of_fine.audit.totals(0), &b = of_coarse.audit.totals(0);
      const double energy = a.scheme_start + std::abs(a.work_of_loads) + a.last.common();
      compare(a.first, b.first, energy, differ);
      compare(a.last, b.last, energy, differ);
      differ.of("energy at the start of the balance", a.scheme_start, b.scheme_start, energy);
      differ.of("work of damping", a.work_of_damping, b.work_of_damping, energy);
      differ.of("work of loads", a.work_of_loads, b.work_of_loads, energy);
      differ.of("work of contact", a.work_of_contact, b.work_of_contact, energy);
      differ.of("work of the scheme", a.work_of_scheme, b.work_of_scheme, energy);
      differ.of("balance", a.balance_residual(), b.balance_residual(), energy);
      // largest_step_gain is of a step by its nature, and so is the deepest penetration: looked at when a step ends.
      const ContactTotals &x = of_fine.audit.contact(0), &y = of_coarse.audit.contact(0);
      differ.of("impulse", x.impulse, y.impulse, x.impulse + 1);
      differ.of("force", x.force, y.force, std::abs(x.force) + energy / length);
      differ.of("first impact", x.first_impact, y.first_impact, 1);
      differ.of("first release", x.first_release, y.first_release, 1);
      differ.of("signed impulse", of_fine.log.impulse(), of_coarse.log.impulse(), x.impulse + 1);
      const auto &events = of_fine.log.events(), &others = of_coarse.log.events();
      INFO(one.name << ", " << time.name << ", " << law.name << ", n = " << n);
      REQUIRE(fine.status(0).running);
      REQUIRE(events.size() == others.size());
      for (std::size_t k = 0; k < events.size(); ++k) {
        CHECK(events[k].side == others[k].side);
        CHECK(events[k].begins == others[k].begins);
        differ.of("time of an event", events[k].time, others[k].time, 1);
        differ.of("speed at an event", events[k].velocity, others[k].velocity, 1);
      }
      if (!throws_back) CHECK(x.impacts > 0);
      CHECK(x.impacts == y.impacts);
      CHECK(x.active_set_changes == y.active_set_changes);
      CHECK(x.contact_steps == y.contact_steps);
      CHECK(x.active == y.active);
      CHECK(of_fine.log.changes() == of_coarse.log.changes());
      INFO(differ.where);
      // The same operations on the same numbers; only times differ, (k + c)/n · nh for (k + c)h. That is some 1e-16 of
      // a second in loads and supports. Impacts magnify it, by up to 1e4 on the beam.
      CHECK(differ.largest <= 1e-9);
    }
}

TEST_CASE("a composed plan gives what it leaves to be derived the levels that the fine one declares") {
  const Case one = cases().front();
  for (const Choice& time : schemes())
    for (const int n : {2, 3}) {
      INFO(time.name << ", n = " << n);
      const StepPlan plan = composed(std::get<StepPlan>(plan_of(time, one.h, {})), n);
      CHECK(check_plan(plan).value_or("nothing") == "nothing");
      const DerivedPlan given = derive(plan), found = derive(steps_of(without_stop_levels(plan)));
      CHECK(given.h == Approx(n * one.h).epsilon(1e-9));
      for (int k = 0; k < n; ++k) {
        CHECK(given.stages[static_cast<std::size_t>(k)].from == Approx(k / double(n)).margin(1e-12));
        CHECK(given.stages[static_cast<std::size_t>(k)].to == Approx((k + 1) / double(n)).margin(1e-12));
      }
      const bool rates = time.values.count("gamma") == 0;  // above ½ they stand O(h) off the positions
      for (std::size_t k = 0; k < given.stages.size(); ++k)
        check_same_stops(given.plan.stages[k], found.plan.stages[k], rates);
    }
}

TEST_CASE("the map of a composed step is the power of the map of one") {
  LinearProblem problem{Eigen::Matrix2d::Identity(), 0.1 * Eigen::Matrix2d::Identity(),
                        Eigen::Matrix2d{{3, -1}, {-1, 2}}, Eigen::MatrixXd{{0.0, 1.0}}};
  for (const Choice& time : schemes())
    for (const ClosedContact& law :
         {ClosedContact{}, ClosedContact{Evaluation::implicit_end, 50}, ClosedContact{Evaluation::averaged, 50}}) {
      const StepPlan plan = std::get<StepPlan>(plan_of(time, 0.05, {.damped = true}));
      const auto once = step_map(problem, plan, law), twice = step_map(problem, composed(plan, 2), law);
      REQUIRE(std::holds_alternative<Eigen::MatrixXd>(once));
      REQUIRE(std::holds_alternative<Eigen::MatrixXd>(twice));
      const Eigen::MatrixXd& A = std::get<Eigen::MatrixXd>(once);
      INFO(time.name << ", evaluation " << (law.evaluation ? evaluation_word(*law.evaluation) : "none"));
      CHECK((std::get<Eigen::MatrixXd>(twice) - A * A).norm() <= 1e-13 * (A * A).norm());
    }
}

TEST_CASE("tangents of a composed step are those of its sub-steps") {
  const std::vector<Case> all = cases();
  const Case& one = all.back();
  const Choice time = GENERATE(from_range(schemes()));
  for (const Choice& law : laws(one.stiffness)) {
    CompileOptions options;
    options.tangents = 1;
    const Methods methods{{"consistent"}, law, time};
    Marcher fine = made(one, methods, 1, options), coarse = made(one, methods, 2, options);
    for (Marcher* marcher : {&fine, &coarse}) {
      marcher->start();
      marcher->march(std::llround(0.02 / marcher->program().h) - marcher->step());
      LaneState direction = marcher->lane_state(0);
      std::fill(direction.efforts.begin(), direction.efforts.end(), 0.0);
      for (std::size_t i = 0; i < direction.slots.size(); ++i) direction.slots[i] *= 1 + 0.1 * double(i % 3);
      marcher->set_tangent(0, 0, direction);
      marcher->march(std::llround(0.06 / marcher->program().h));
    }
    const LaneState a = fine.tangent(0, 0), b = coarse.tangent(0, 0);
    INFO(time.name << ", " << law.name);
    CHECK(coarse.delassus_columns() > 0);
    const Eigen::Map<const Eigen::VectorXd> x(a.slots.data(), Eigen::Index(a.slots.size())),
        y(b.slots.data(), Eigen::Index(b.slots.size()));
    REQUIRE(x.allFinite());
    // As above; what contact magnifies in the motion it magnifies once more in its derivative.
    CHECK((x - y).norm() <= 1e-8 * x.norm());
  }
}

TEST_CASE("an orbit of a composed plan goes on bitwise equal in another lane") {
  const std::vector<Case> all = cases();
  const Case& one = all.back();
  const Choice time = GENERATE(from_range(schemes()));
  const Methods methods{
      {"consistent"}, {"penalty", {{"stiffness", one.stiffness}, {"evaluation", std::string("averaged")}}}, time};
  CompileOptions options;
  options.kind = OperatorKind::band;
  Marcher alone = made(one, methods, 3, options);
  alone.start();
  alone.march(150);
  const LaneState state = alone.lane_state(0);
  Marcher block = made(one, methods, 3, options, [](const LaneSpec& lane) {
    std::vector<LaneSpec> lanes(3, lane);
    lanes[1].amplitude *= 1.1;
    return lanes;
  });
  block.start();
  block.march(37);
  block.set_clock(alone.step());
  block.set_lane(1, alone.program().lanes[0], state);
  alone.march(150);
  block.march(150);
  INFO(time.name);
  CHECK(alone.lane_state(0).slots == block.lane_state(1).slots);
  CHECK(alone.lane_state(0).efforts == block.lane_state(1).efforts);
}
