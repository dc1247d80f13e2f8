// Hundreds of contact points that close together: held in the band of the step, marched beside the columns alone.
#include <Eigen/Core>

#include "tests/allocations.hpp"
#include "tests/eigen.hpp"
#include "tests/marching.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

/// The beam upon a plane stop below all of its nodes, pressed on it by q (N/m).
SceneSpec lying_scene(double q, double gap) {
  SceneSpec scene = working_set();
  beam_of(scene).damping = {1e-3, 200};
  scene.stops.lower = Formula(-gap);
  scene.stops.upper.reset();
  scene.stops.place = StopsSpec::Place::nodes;
  scene.initial.displacement = Formula(0.0);
  scene.initial.velocity = Formula(0.0);
  scene.load = Formula(-q);
  return scene;
}

/// The same thrown flat at the plane.
SceneSpec thrown_scene() {
  SceneSpec scene = lying_scene(50, 2e-4);
  beam_of(scene).damping = {1e-4, 0};
  scene.initial.velocity = Formula("-0.5*x", "/scene/initial/velocity", "x");
  return scene;
}

/// The efforts of the last step, and the most that were ever found at once.
struct Efforts final : StepObserver {
  void stage_solved(const Marcher& marcher, const StageView& view) override {
    if (view.starting || !view.effort) return;
    last = Eigen::Map<const Eigen::VectorXd>(view.effort[0], marcher.program().problem->points());
    most = std::max(most, static_cast<int>((last.array() != 0).count()));
  }
  void step_done(Marcher&) override {}
  Eigen::VectorXd last;
  int most = 0;
};

}  // namespace

TEST_CASE("a beam that lies on a plane stop with all nodes closed pushes with what lies on it", "[many]") {
  // Held at all nodes, the beam still turns there: K_θθ θ = F_θ, and the stop carries p = K_wθ θ − F_w.
  const int elements = GENERATE(200, 500);
  const std::string mass = GENERATE("consistent", "singular", "lumped");
  const SceneSpec scene = lying_scene(30, 0);
  Marcher beam =
      marcher(scene, elements, {{mass}, {"signorini"}, {"newmark-dumont-paoli"}}, 1e-3, {.kind = OperatorKind::band});
  Efforts efforts;
  beam.start(&efforts);
  beam.march(300, &efforts);
  INFO(mass << " on " << elements);
  REQUIRE(beam.status(0).running);
  const SemiDiscrete& problem = *beam.program().problem;
  Eigen::VectorXd load(problem.dofs());
  problem.load->assemble(0, load.data());
  const int n = problem.dofs();
  Eigen::MatrixXd stiff(problem.stiffness), held = stiff;
  Eigen::VectorXd turning = load;
  for (int i = 0; i < n; i += 2) {
    held.row(i).setZero();
    held.col(i).setZero();
    held(i, i) = 1;
    turning[i] = 0;
  }
  const Eigen::VectorXd turned = eigen::ldlt_solve(held, turning), reaction = stiff * turned - load;
  Eigen::VectorXd expected(elements);
  for (int i = 0; i < elements; ++i) expected[i] = reaction[2 * i];
  REQUIRE(expected.minCoeff() > 0);
  CHECK((efforts.last.array() > 0).all());
  // What is left of turning at t = 0.3 s under 200/s, and the round-off of K θ.
  CHECK((efforts.last - expected).norm() <= 1e-6 * expected.norm());
  for (int i = 0; i < elements; ++i) CHECK(std::abs(beam.position(0)[2 * i]) <= 1e-12);
}

TEST_CASE("a beam thrown flat at a plane goes on as it does by columns alone", "[many]") {
  const std::string mass = GENERATE("consistent", "singular");
  const Methods methods{{mass}, {"signorini"}, {"newmark-dumont-paoli"}};
  Eigen::VectorXd position[2];
  int most[2] = {};
  for (const bool in_band : {true, false}) {
    Marcher beam =
        marcher(thrown_scene(), 220, methods, 2e-5, {.kind = in_band ? OperatorKind::band : OperatorKind::sparse});
    Efforts efforts;
    beam.start(&efforts);
    beam.march(60, &efforts);
    REQUIRE(beam.status(0).running);
    position[in_band] = beam.position(0);
    most[in_band] = efforts.most;
  }
  CHECK(most[true] > 128);
  CHECK(most[true] == most[false]);
  // Two factors of the same S, whose condition is some 1e6, over 60 steps.
  CHECK((position[true] - position[false]).norm() <= 1e-8 * position[false].norm());
}

TEST_CASE("lanes of many points equal single runs bit for bit", "[many]") {
  const Methods methods{{"consistent"}, {"signorini"}, {"newmark-dumont-paoli"}};
  const CompileOptions options{.kind = OperatorKind::band};
  // One of them stays far above its stop, one meets it later.
  const auto varied = [](const LaneSpec& base) {
    std::vector<LaneSpec> lanes(3, base);
    lanes[1].lower = base.lower.array() - 1.0;
    lanes[2].lower = base.lower.array() - 1e-4;
    return lanes;
  };
  Marcher block = marcher(thrown_scene(), 180, methods, 2e-5, options, varied);
  block.start();
  block.march(60);
  for (int k = 0; k < 3; ++k) {
    Marcher single = marcher(thrown_scene(), 180, methods, 2e-5, options, [&](const LaneSpec& base) {
      return std::vector<LaneSpec>{varied(base)[static_cast<std::size_t>(k)]};
    });
    Efforts efforts;
    single.start(&efforts);
    single.march(60, &efforts);
    CHECK((efforts.most > 128) == (k != 1));
    for (int j = 0; j < single.slot_count(); ++j)
      for (int i = 0; i < single.program().model->rows(); ++i) {
        const double alone = single.slot(j)[i], together = block.slot(j)[i * block.width() + k];
        if (alone != together) FAIL("lane " << k << " slot " << j << " row " << i << " off by " << together - alone);
      }
  }
}

TEST_CASE("an integration of many points allocates nothing once they have closed", "[many]") {
  Marcher beam = marcher(lying_scene(30, 0), 200, {{"consistent"}, {"signorini"}, {"moreau-jean"}}, 1e-3,
                         {.kind = OperatorKind::band});
  beam.start();
  beam.march(20);
  const long before = allocations();
  beam.march(50);
  CHECK(allocations() == before);
  CHECK(beam.status(0).running);
}
