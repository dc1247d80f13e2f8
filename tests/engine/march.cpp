// The time loop itself: no allocation, flat memory, lanes that diverge, refusals.
#include <fstream>

#include "tests/allocations.hpp"
#include "tests/marching.hpp"

using namespace ricochet;
using namespace ricochet::testing;

TEST_CASE("marching allocates nothing, observed or not") {
  SceneSpec scene = working_set();
  beam_of(scene).damping.stiffness = 1e-4;
  scene.stops.place = StopsSpec::Place::nodes;
  scene.support.amplitude = 0.02;
  scene.load = Formula("0.1*x*sin(3*t)", "/scene/load");
  const auto mass = GENERATE(Choice{"consistent"}, Choice{"singular"}, Choice{"reciprocal"});
  const auto contact = GENERATE(Choice{"signorini"}, Choice{"penalty", {{"stiffness", 1e5}}},
                                Choice{"augmented-lagrangian", {{"augmentation", 1e5}}});
  const auto time =
      GENERATE(Choice{"newmark-dumont-paoli"}, Choice{"newmark"}, Choice{"moreau-jean", {{"theta", 0.6}}});
  const auto kind = GENERATE(OperatorKind::band, OperatorKind::modal, OperatorKind::sparse);
  CompileOptions options;
  options.kind = kind;
  Marcher beam = marcher(scene, 8, {mass, contact, time}, 1e-4, options);
  EnergyAudit audit(beam);
  beam.start(&audit);
  beam.march(100, &audit);
  const long before = allocations();
  beam.march(1500, &audit);
  beam.march(500);
  const long after = allocations();  // the macros below allocate
  INFO(mass.name << " " << contact.name << " " << time.name << " " << operator_name(kind));
  CHECK(after == before);
  CHECK(audit.contact(0).impacts > 0);
}

TEST_CASE("memory stays flat over ten million steps") {
  const auto resident = [] {
    std::ifstream status("/proc/self/statm");
    long total = 0, pages = 0;
    status >> total >> pages;
    return pages;
  };
  SceneSpec scene = working_set();
  beam_of(scene).damping.stiffness = 1e-4;
  scene.support.amplitude = 0.09;
  Marcher beam = marcher(scene, 1, {{"consistent"}, {"signorini"}, {"newmark-dumont-paoli"}}, 1e-4);
  beam.start();
  beam.march(100000);
  const long before = resident();
  beam.march(10000000);
  CHECK(beam.status(0).running);
  // Some pages come and go with the test program itself (a sanitizer's shadow: 22), and the system may make huge pages
  // of 512 out of what was resident in part. A byte per step would be 2400.
  CHECK(resident() - before <= 2 * 512 + 64);
}

TEST_CASE("a lane that diverges is frozen with step, time and cause, and the others go on") {
  // Central differences beyond the step limit of this mesh; one lane starts at rest and has nothing to amplify.
  Methods methods{{"consistent"}, {"none"}, {"newmark-dumont-paoli", {{"beta", 0.0}}}};
  SceneSpec scene = working_set();
  const double length = 1.501 / 10;
  const double limit = 0.0334014193 * length * length / std::sqrt(282.8125);
  Marcher beam = marcher(scene, 10, methods, 1.5 * limit, {}, [](const LaneSpec& lane) {
    LaneSpec still = lane;
    still.position.setZero();
    still.velocity.setZero();
    return std::vector{lane, still};
  });
  beam.start();
  CHECK(beam.march(5000) == 5000);
  CHECK_FALSE(beam.status(0).running);
  CHECK(beam.status(0).step > 0);
  CHECK(beam.status(0).time == Approx(static_cast<double>(beam.status(0).step) * 1.5 * limit));
  CHECK(beam.status(0).end);
  CHECK(beam.status(1).running);
  CHECK(beam.tip(1) == 0.0);
  CHECK(beam.tip(0) == 0.0);  // nothing that is not finite is left behind
}

TEST_CASE("the energy beyond which a lane has diverged is its own, whoever marches beside it") {
  Methods methods{{"consistent"}, {"signorini"}, {"newmark-dumont-paoli"}};
  SceneSpec scene = working_set();
  scene.support.amplitude = 0.02;
  const auto with_amplitudes = [&](std::vector<double> amplitudes, double gap) {
    return marcher(scene, 5, methods, 1e-4, {}, [=](const LaneSpec& lane) {
      std::vector<LaneSpec> lanes(amplitudes.size(), lane);
      for (std::size_t k = 0; k < lanes.size(); ++k) {
        lanes[k].position.setZero();
        lanes[k].velocity.setZero();
        lanes[k].amplitude = amplitudes[k];
        lanes[k].lower.setConstant(-gap);
        lanes[k].upper.setConstant(gap);
      }
      return lanes;
    });
  };
  const double far = std::numeric_limits<double>::infinity();
  Marcher quiet = with_amplitudes({0.001}, far), loud = with_amplitudes({0.1}, far);
  Marcher both = with_amplitudes({0.001, 0.1}, far), near = with_amplitudes({0.001}, 1.0);
  CHECK(both.energy_bound(0) == quiet.energy_bound(0));
  CHECK(both.energy_bound(1) == loud.energy_bound(0));
  // Static energies are quadratic in the amplitude; one ulp for each of the three products.
  CHECK(loud.energy_bound(0) == Approx(1e4 * quiet.energy_bound(0)).epsilon(1e-15));
  CHECK(near.energy_bound(0) > quiet.energy_bound(0));
  // A lane that takes another's place brings its own.
  both.start();
  quiet.start();
  both.set_lane(1, quiet.program().lanes[0], quiet.lane_state(0));
  CHECK(both.energy_bound(1) == quiet.energy_bound(0));
}

TEST_CASE("central differences hold below the step limit of the consistent mass and fail above") {
  Methods methods{{"consistent"}, {"none"}, {"newmark-dumont-paoli", {{"beta", 0.0}}}};
  const double length = 1.501 / 20;
  const double limit = 0.0334014193 * length * length / std::sqrt(282.8125);
  for (const double factor : {0.99, 1.02}) {
    Marcher beam = marcher(working_set(), 20, methods, factor * limit);
    beam.start();
    beam.march(20000);
    CHECK(beam.status(0).running == (factor < 1));
  }
}

TEST_CASE("an observed run stops at the step where its energy passes the bound") {
  Methods methods{{"consistent"}, {"none"}, {"newmark-dumont-paoli", {{"beta", 0.0}}}};
  const double length = 1.501 / 10;
  const double h = 1.5 * 0.0334014193 * length * length / std::sqrt(282.8125);
  Marcher beam = marcher(working_set(), 10, methods, h);
  EnergyAudit audit(beam);
  beam.start(&audit);
  beam.march(5000, &audit);
  CHECK_FALSE(beam.status(0).running);
  CHECK(audit.energy(0).common() > beam.energy_bound(0));
  CHECK(std::isfinite(audit.totals(0).last.common()));
}

TEST_CASE("combinations that do not apply are refused in a sentence") {
  const auto problem = problem_of(working_set(), 4, {"singular"});
  const auto refused = [&](const Choice& time, const Choice& contact) {
    auto result = compiled(problem, {{"singular"}, contact, time}, 1e-4);
    const auto* refusal = std::get_if<Refusal>(&result);
    return refusal ? refusal->sentence.text : std::string();
  };
  CHECK(refused({"newmark-dumont-paoli", {{"beta", 0.2}}}, {"signorini"}).find("Use beta ≥ 0.25") != std::string::npos);
  CHECK(refused({"newmark-dumont-paoli", {{"beta", 0.0}}}, {"signorini"}).find("singular") != std::string::npos);
  CHECK(refused({"newmark", {{"beta", 0.2}}}, {"signorini"}).find("gamma/2") != std::string::npos);
  CHECK(refused({"newmark-dumont-paoli", {{"beta", 0.25}}}, {"signorini"}).empty());
}

TEST_CASE("a step that is singular is refused, not divided by") {
  // β = 0 on a lumped mass without rotary inertia: S = M/h² has zero rows.
  const auto problem = problem_of(working_set(), 4, {"lumped", {{"rotation", std::string("none")}}});
  StepPlan plan = std::get<StepPlan>(plan_of({"newmark-dumont-paoli", {{"beta", 0.0}}}, 1e-4, {}));
  for (const OperatorKind kind : {OperatorKind::band, OperatorKind::modal, OperatorKind::sparse}) {
    CompileOptions options;
    options.kind = kind;
    auto result =
        compile(problem, plan, 1e-4, make(registry().contact("none"), {"none"}), {scene_lane(*problem, {})}, options);
    REQUIRE(std::holds_alternative<Refusal>(result));
    CHECK(std::get<Refusal>(result).sentence.text.find("singular") != std::string::npos);
  }
}

TEST_CASE("an explicit step on a lumped mass needs no factor at all") {
  Marcher beam = marcher(working_set(), 6, {{"lumped"}, {"none"}, {"newmark-dumont-paoli", {{"beta", 0.0}}}}, 1e-5, [] {
    CompileOptions options;
    options.kind = OperatorKind::band;
    return options;
  }());
  CHECK(beam.program().kind == OperatorKind::diagonal);
}
