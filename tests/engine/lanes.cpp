// A lane's result does not depend on the other lanes of its block. It depends neither on what was left out nor on the
// operator that was chosen.
#include <cstring>

#include "tests/marching.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

SceneSpec forced_scene() {
  SceneSpec scene = working_set();
  beam_of(scene).damping.stiffness = 1e-4;
  scene.support.amplitude = 0.09;
  scene.stops.place = StopsSpec::Place::nodes;
  return scene;
}

// Lanes that differ in amplitude, phase, stops and initial state.
std::vector<LaneSpec> varied(const LaneSpec& base, int count) {
  std::vector<LaneSpec> lanes;
  for (int k = 0; k < count; ++k) {
    LaneSpec lane = base;
    lane.amplitude = 0.03 + 0.004 * k;
    lane.phase = 0.1 * k;
    lane.position = base.position * (1.0 + 0.01 * k);
    lane.lower = base.lower.array() - 1e-3 * k;
    lanes.push_back(lane);
  }
  return lanes;
}

bool same_bits(double a, double b) {
  // Zeros of either sign are the same state.
  return std::memcmp(&a, &b, sizeof a) == 0 || (a == 0 && b == 0);
}

}  // namespace

TEST_CASE("lanes equal single runs bit for bit") {
  const auto mass = GENERATE(Choice{"consistent"}, Choice{"singular", {{"velocity", std::string("P1")}}},
                             Choice{"singular", {{"velocity", std::string("P0")}}});
  const auto time =
      GENERATE(Choice{"newmark-dumont-paoli"}, Choice{"newmark"}, Choice{"moreau-jean", {{"theta", 0.6}}});
  const auto kind = GENERATE(OperatorKind::band, OperatorKind::modal, OperatorKind::sparse);
  const int count = GENERATE(3, 16);
  const Methods methods{mass, {"signorini"}, time};
  CompileOptions options;
  options.kind = kind;
  const double h = 1e-4, duration = 0.15;
  const SceneSpec scene = forced_scene();
  Marcher block = marcher(scene, 6, methods, h, options, [&](const LaneSpec& lane) { return varied(lane, count); });
  run(block, duration);
  int touched = 0;
  for (int k = 0; k < count; ++k) {
    Marcher single = marcher(scene, 6, methods, h, options, [&](const LaneSpec& lane) {
      return std::vector<LaneSpec>{varied(lane, count)[static_cast<std::size_t>(k)]};
    });
    run(single, duration);
    touched += single.delassus_columns();
    for (int j = 0; j < single.slot_count(); ++j)
      for (int i = 0; i < single.program().model->rows(); ++i) {
        const double alone = single.slot(j)[i], together = block.slot(j)[i * block.width() + k];
        if (!same_bits(alone, together))
          FAIL(mass.name << " " << time.name << " " << operator_name(kind) << " of " << count << ": lane " << k
                         << " slot " << j << " row " << i << ": " << alone << ", off by " << together - alone);
      }
  }
  INFO(mass.name << " " << time.name << " " << operator_name(kind));
  CHECK(touched > 0);  // else this tested nothing but free flight
}

TEST_CASE("penalty stiffness may differ between lanes") {
  const Methods methods{{"consistent"}, {"penalty", {{"stiffness", 1e4}}}, {"newmark-dumont-paoli"}};
  const auto lane_of = [](const LaneSpec& base, int k) {
    LaneSpec lane = base;
    lane.law.set("stiffness", 1e3 * (k + 1));
    return lane;
  };
  Marcher block = marcher(working_set(), 6, methods, 1e-4, {}, [&](const LaneSpec& base) {
    return std::vector{lane_of(base, 0), lane_of(base, 1)};
  });
  run(block, 0.1);
  CHECK(block.tip(0) != block.tip(1));
  for (int k = 0; k < 2; ++k) {
    Marcher single = marcher(working_set(), 6, methods, 1e-4, {},
                             [&](const LaneSpec& base) { return std::vector{lane_of(base, k)}; });
    run(single, 0.1);
    CHECK(same_bits(single.tip(0), block.tip(k)));
  }
}

TEST_CASE("every operator gives the same trajectory to round-off") {
  const auto mass =
      GENERATE(Choice{"consistent"}, Choice{"lumped"}, Choice{"singular", {{"velocity", std::string("P1")}}},
               Choice{"singular", {{"velocity", std::string("P0")}}}, Choice{"reciprocal"});
  const auto time = GENERATE(Choice{"newmark-dumont-paoli"}, Choice{"newmark", {{"beta", 0.3}}},
                             Choice{"moreau-jean", {{"theta", 0.6}}});
  SceneSpec scene = working_set();
  beam_of(scene).damping = {1e-4, 0.3};
  // Newmark's rigid impacts amplify any round-off: springs for it.
  const Methods methods{mass, time.name == "newmark" ? Choice{"penalty", {{"stiffness", 1e4}}} : Choice{"signorini"},
                        time};
  std::vector<double> tips;
  for (const OperatorKind kind : {OperatorKind::band, OperatorKind::modal, OperatorKind::sparse}) {
    CompileOptions options;
    options.kind = kind;
    Marcher beam = marcher(scene, 20, methods, 1e-4, options);
    // Past the first impact.
    run(beam, 0.055);
    CHECK(beam.delassus_columns() > 0);
    tips.push_back(beam.tip(0));
  }
  INFO(mass.name << " " << time.name);
  // Round-off of the dense eigenproblem (cond K ~ N⁴ · 1e-16), amplified by an impact.
  CHECK(tips[1] == Approx(tips[0]).margin(1e-8));
  CHECK(tips[2] == Approx(tips[0]).margin(1e-9));
}

TEST_CASE("what is left out would have changed nothing") {
  Methods methods{{"consistent"}, {"signorini"}, {"newmark-dumont-paoli"}};
  const double h = 1e-4, duration = 0.2;
  const auto tip = [&](const SceneSpec& scene, const Methods& chosen, const CompileOptions& options = {}) {
    Marcher beam = marcher(scene, 12, chosen, h, options);
    run(beam, duration);
    return beam.tip(0);
  };
  const auto leaves_out = [&](const SceneSpec& scene, const Methods& chosen, const std::string& item) {
    Marcher beam = marcher(scene, 12, chosen, h);
    for (const LeftOut& left : beam.program().left_out)
      if (left.item.find(item) != std::string::npos) return true;
    return false;
  };
  const SceneSpec lean = working_set();
  CompileOptions band;
  band.kind = OperatorKind::band;
  SECTION("damping") {
    SceneSpec full = lean;
    // Far below a round-off of anything, and still a size that a study may state.
    beam_of(full).damping = {1e-120, 1e-120};
    CHECK(leaves_out(lean, methods, "damping"));
    CHECK(tip(lean, methods) == tip(full, methods));
  }
  SECTION("support load") {
    SceneSpec full = lean;
    full.support.amplitude = 1e-120;
    CHECK(leaves_out(lean, methods, "inertia load"));
    CHECK_FALSE(leaves_out(full, methods, "inertia load"));
    CHECK(tip(lean, methods) == tip(full, methods));
  }
  SECTION("distributed load, absent or constant in time") {
    SceneSpec full = lean, constant = lean, varying = lean;
    full.load = Formula("0*t", "/scene/load");
    constant.load = Formula("3*x", "/scene/load");
    varying.load = Formula("3*x + 0*t", "/scene/load");
    CHECK(leaves_out(lean, methods, "distributed load"));
    CHECK_FALSE(leaves_out(full, methods, "distributed load"));
    // One operator for both, whose sums then differ by the order of one addition.
    CHECK(tip(lean, methods, band) == Approx(tip(full, methods, band)).epsilon(1e-12));
    CHECK(leaves_out(constant, methods, "assembly of the distributed load"));
    CHECK(tip(constant, methods, band) == Approx(tip(varying, methods, band)).epsilon(1e-12));
    CHECK(tip(constant, methods) != tip(lean, methods));
  }
  SECTION("contact rows and box problem") {
    Methods none = methods;
    none.contact.name = "none";
    SceneSpec far = lean, absent = lean;
    far.stops.lower = Formula(-1e6);
    far.stops.upper = Formula(1e6);
    absent.stops.lower.reset();
    absent.stops.upper.reset();
    CHECK(leaves_out(lean, none, "contact rows"));
    CHECK(leaves_out(absent, methods, "contact rows"));
    CHECK(tip(lean, none) == tip(far, methods));
    CHECK(tip(absent, methods) == tip(far, methods));
  }
  SECTION("one stop") {
    SceneSpec far = lean, absent = lean;
    far.stops.upper = Formula(1e6);
    absent.stops.upper.reset();
    CHECK(leaves_out(absent, methods, "upper stop"));
    CHECK(tip(absent, methods) == tip(far, methods));
    CHECK(tip(absent, methods) != tip(lean, methods));
  }
  SECTION("rows of points that cannot touch") {
    // Stops at all nodes, out of reach everywhere but at the tip: the box problem has twelve points instead of one.
    SceneSpec all = lean;
    all.stops.place = StopsSpec::Place::nodes;
    all.stops.lower = Formula("x > 1.5 ? -0.1 : -1e3", "/scene/stops/lower", "x");
    all.stops.upper = Formula("x > 1.5 ? 0.1 : 1e3", "/scene/stops/upper", "x");
    CHECK(leaves_out(lean, methods, "active-set search"));
    CHECK(tip(lean, methods, band) == Approx(tip(all, methods, band)).epsilon(1e-12));
  }
  SECTION("Delassus columns never asked for") {
    SceneSpec nodes = lean;
    nodes.stops.place = StopsSpec::Place::nodes;
    CompileOptions eager = band;
    eager.eager_delassus = true;
    CHECK(tip(nodes, methods, band) == tip(nodes, methods, eager));
    Marcher lazy = marcher(nodes, 12, methods, h, band);
    run(lazy, duration);
    CHECK(lazy.delassus_columns() < 12);
  }
}
