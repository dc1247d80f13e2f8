// Laursen and Love: energy kept through contact, nothing beyond a stop at the end of a step.
#include <ricochet/measure/stability/plan_restitution.hpp>

#include "tests/allocations.hpp"
#include "tests/marching.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace laursen_love_tests {
namespace {

const Choice love{"laursen-love"};

SceneSpec beam_between_stops() {
  SceneSpec scene = working_set();
  scene.stops.place = StopsSpec::Place::nodes;
  return scene;
}

SceneSpec shaken_beam() {
  SceneSpec scene = beam_between_stops();
  beam_of(scene).damping.stiffness = 1e-5;
  scene.support.amplitude = 0.08;
  return scene;
}

}  // namespace

TEST_CASE("a thrown bar keeps its energy and never enters its stop", "[laursen-love]") {
  const double h = 0.005;
  Marcher bar = marcher(thrown_bar(), 20, {{"consistent"}, {"signorini"}, love}, h);
  EnergyAudit audit(bar);
  bar.start(&audit);
  double before = 500, worst = 0, sum = 0, squares = 0;
  int samples = 0;
  for (int n = 1; n <= 320; ++n) {
    bar.march(1, &audit);
    const double energy = audit.energy(0).scheme, force = audit.contact(0).force;
    worst = std::max(worst, std::abs(energy - before));
    before = energy;
    if (n * h > 0.55 - h / 2 && n * h < 1.1 + h / 2) {
      sum += force;
      squares += force * force;
      ++samples;
    }
  }
  const double mean = sum / samples, deviation = std::sqrt(squares / samples - mean * mean);
  INFO("mean " << mean << " ± " << deviation << " N, worst step " << worst);
  CHECK(worst <= 1e-12 * 500);
  CHECK(before == Approx(500).epsilon(1e-12));
  CHECK(audit.contact(0).deepest_penetration <= 1e-13);
  // What a dense march of the same equations gave: about the exact force, in one step of three or so.
  CHECK(mean == Approx(306).margin(0.5));
  CHECK(deviation == Approx(418).margin(0.5));
  CHECK(audit.contact(0).active_set_changes == 92);
  // Momentum 100 N s, there and back: but for what the bar rings with.
  CHECK(audit.contact(0).impulse == Approx(200).margin(5));
}

TEST_CASE("an undamped beam between stops at all nodes keeps its energy in every step", "[laursen-love]") {
  for (const double h : {1e-3, 1e-4, 1e-5}) {
    const auto mass = GENERATE(Choice{"consistent"}, Choice{"lumped"});
    Marcher beam = marcher(beam_between_stops(), 10, {mass, {"signorini"}, love}, h);
    const EnergyAudit audit = audited(beam, 0.3);
    INFO(mass.name << ", h = " << h);
    REQUIRE(beam.status(0).running);
    const EnergyTotals& totals = audit.totals(0);
    CHECK(audit.contact(0).impacts > 0);
    CHECK(totals.largest_step_gain <= 2e-12 * totals.scheme_start);
    // Steps add up like a random walk at worst.
    CHECK(totals.last.scheme == Approx(totals.scheme_start).epsilon(1e-12 * std::sqrt(0.3 / h)));
    CHECK(std::abs(totals.work_of_contact) <= 1e-9 * totals.scheme_start);
    CHECK(audit.contact(0).deepest_penetration <= 1e-12);
  }
}

TEST_CASE("the tip of the damped beam converges to that of its mesh", "[laursen-love]") {
  // EI/ρS rounded to 282.84 m⁴/s² (the tube has 282.8125), for which the limit is known from dense marches.
  SceneSpec scene = working_set();
  beam_of(scene).section.type = Section::Type::given;
  beam_of(scene).section.EI = 282.84;
  beam_of(scene).section.rhoS = 1;
  beam_of(scene).damping.stiffness = 1e-4;
  std::vector<double> errors;
  for (const double h : {4e-5, 2e-5, 1e-5}) {
    Marcher beam = marcher(scene, 10, {{"consistent"}, {"signorini"}, love}, h);
    run(beam, 0.4);
    errors.push_back(std::abs(beam.tip(0) - 0.0607598064));
  }
  INFO(errors[0] << ", " << errors[1] << ", " << errors[2]);
  // Dense marches of the same equations found 3.6e-5, 8e-6 and 7e-6.
  CHECK(errors[0] == Approx(3.6e-5).margin(5e-7));
  CHECK(errors[1] == Approx(8e-6).margin(5e-7));
  CHECK(errors[2] == Approx(7e-6).margin(5e-7));
}

TEST_CASE("one mass leaves as fast as it came, at whatever part of a step it meets its stop", "[laursen-love]") {
  for (const double h : {1e-6, 1e-2}) {
    const auto plan = testing::plan_of(love, h, {1, 0, false, true});
    const auto range = restitution_range(std::get<StepPlan>(plan), h);
    REQUIRE(range);
    CHECK(range->least == Approx(1).epsilon(1e-12));
    CHECK(range->most == Approx(1).epsilon(1e-12));
  }
}

TEST_CASE("stops that move against the clamp do no work on a shaken beam", "[laursen-love]") {
  const double h = 1e-4;
  Marcher beam = marcher(shaken_beam(), 8, {{"consistent"}, {"signorini"}, love}, h);
  const EnergyAudit audit = audited(beam, 0.6);
  const EnergyTotals& totals = audit.totals(0);
  REQUIRE(beam.status(0).running);
  CHECK(audit.contact(0).impacts > 10);
  const double scale = totals.scheme_start + totals.work_of_damping;
  CHECK(std::abs(totals.work_of_contact) <= 1e-10 * scale);
  CHECK(std::abs(totals.balance_residual()) <= 1e-9 * scale);
  CHECK(audit.contact(0).deepest_penetration <= 1e-12);
}

TEST_CASE("without rigid contact it is the mid-point rule, to the bit, and solves once", "[laursen-love]") {
  const auto law = GENERATE(Choice{"none"}, Choice{"penalty", {{"stiffness", 1e3}}},
                            Choice{"penalty", {{"stiffness", 1e3}, {"evaluation", std::string("conserving")}}});
  Marcher one = marcher(shaken_beam(), 6, {{"consistent"}, law, love}, 1e-4);
  Marcher other = marcher(shaken_beam(), 6, {{"consistent"}, law, {"midpoint"}}, 1e-4);
  run(one, 0.2);
  run(other, 0.2);
  for (int slot = 0; slot < 2; ++slot)
    for (int i = 0; i < 12; ++i) CHECK(one.slot(slot)[i] == other.slot(slot)[i]);
  CHECK_FALSE(one.program().stages[1].op);
}

TEST_CASE("lanes of a block give back their own work and nothing is allocated", "[laursen-love]") {
  const auto lanes = [](const LaneSpec& lane) {
    std::vector<LaneSpec> all;
    for (int l = 0; l < 3; ++l) {
      all.push_back(lane);
      all.back().velocity *= 1 + 0.2 * l;
      all.back().amplitude *= 1 - 0.3 * l;
    }
    return all;
  };
  // Widths have equal bits with one operator.
  const CompileOptions one_operator{.kind = OperatorKind::band, .eager_delassus = true};
  Marcher block = marcher(shaken_beam(), 6, {{"consistent"}, {"signorini"}, love}, 1e-4, one_operator, lanes);
  block.start();
  const long before = allocations();
  block.march(4000);
  CHECK(allocations() == before);
  for (int lane = 0; lane < 3; ++lane) {
    Marcher alone =
        marcher(shaken_beam(), 6, {{"consistent"}, {"signorini"}, love}, 1e-4, one_operator,
                [&](const LaneSpec& spec) { return std::vector{lanes(spec)[static_cast<std::size_t>(lane)]}; });
    run(alone, 0.4);
    CHECK(block.status(lane).running);
    CHECK(block.tip(lane) == alone.tip(0));
  }
}

TEST_CASE("a step that begins beyond its stop ends the lane, with the cause", "[laursen-love]") {
  const auto beyond = [](LaneSpec lane) {
    lane.position.setConstant(-0.01);
    return std::vector{lane};
  };
  Marcher bar = marcher(thrown_bar(), 4, {{"consistent"}, {"signorini"}, love}, 1e-3, {}, beyond);
  bar.start();
  bar.march(10);
  CHECK_FALSE(bar.status(0).running);
  CHECK(bar.status(0).end.cause == EndCause::law_not_converged);
  CHECK(bar.status(0).end.failed());
  // By how far the stop had to move the point.
  CHECK(bar.status(0).end.value == Approx(0.01).epsilon(1e-9));
}

TEST_CASE("exponents by tangents are refused, a singular mass too, each in a sentence", "[laursen-love]") {
  const auto sentence = [](const ProgramOrRefusal& made) {
    const auto* refusal = std::get_if<Refusal>(&made);
    return refusal ? refusal->sentence.text : std::string();
  };
  const auto problem = problem_of(shaken_beam(), 6, {"consistent"});
  CHECK(sentence(compiled(problem, {{"consistent"}, {"signorini"}, love}, 1e-4, {.tangents = 1})).find("twins") !=
        std::string::npos);
  CHECK(sentence(compiled(problem, {{"consistent"}, {"penalty", {{"stiffness", 1e3}}}, love}, 1e-4, {.tangents = 1})) ==
        "");
  const auto massless = problem_of(working_set(), 6, {"singular"});
  CHECK(sentence(compiled(massless, {{"singular"}, {"signorini"}, love}, 1e-4)).find("regular mass") !=
        std::string::npos);
}

}  // namespace laursen_love_tests
