// Nitsche's method: what it makes of a structure, where it must be refused, and what it is worth beside a penalty.
#include <fmt/format.h>

#include <Eigen/SparseCholesky>
#include <numbers>

#include "tests/eigen.hpp"
#include "tests/plugins/contact/impacts.hpp"
#include "tests/refusals.hpp"

using namespace ricochet;
using namespace ricochet::testing;
using Catch::Matchers::Contains;

namespace {

SceneSpec beam_scene(StopsSpec::Place place = StopsSpec::Place::tip) {
  SceneSpec scene = working_set();
  beam_of(scene).damping.stiffness = 1e-4;
  scene.stops.place = place;
  return scene;
}

Choice nitsche(double gamma0, const char* evaluation = "implicit") {
  return {"nitsche", {{"gamma0", gamma0}, {"evaluation", std::string(evaluation)}}};
}

// κ/γ₀ = 12EI/ℓ³.
double element_stiffness(const SceneSpec& scene, int elements) {
  const auto& beam = std::get<BeamSpec>(scene.structure);
  return 12 * section_properties(beam.section, beam.young, beam.density).EI / std::pow(beam.length / elements, 3);
}

SemiDiscreteOrRefusal made(const SceneSpec& scene, int elements, const Choice& law, double* kappa = nullptr) {
  const auto contact = make(registry().contact(law.name), law);
  const auto mass = make(registry().mass("consistent"), {"consistent"});
  auto result = discretise(scene, elements, *mass, contact.get());
  if (kappa) *kappa = constant_stiffness(*contact).value_or(0);
  return result;
}

std::string refusal(const SceneSpec& scene, int elements, const Choice& law) {
  const auto result = made(scene, elements, law);
  const auto* refused = std::get_if<Refusal>(&result);
  return refused ? refused->sentence.text : "";
}

// λ of tridiag(−1, 2, −1) with 1 in the last place, at its largest: of H K Hᵀ over 12EI/ℓ³ or EA/ℓ at all nodes.
double chain(int elements) {
  return 2 + 2 * std::cos(2 * std::numbers::pi / (2 * elements + 1));
}

}  // namespace

TEST_CASE("Nitsche's springs are consistent: a structure at rest on its stop feels nothing of κ") {
  const SceneSpec scene =
      GENERATE(beam_scene(StopsSpec::Place::tip), beam_scene(StopsSpec::Place::nodes), released_bar(1e4, "0.05*(1-x)"));
  double kappa = 0;
  const auto result = made(scene, 6, nitsche(7), &kappa);
  const auto& problem = std::get<SemiDiscrete>(result);
  REQUIRE(problem.changed_by_law());
  const bool beam = std::holds_alternative<BeamSpec>(scene.structure);
  REQUIRE(kappa == Approx(7 * (beam ? element_stiffness(scene, 6) : 6e4)));
  const Eigen::MatrixXd K = problem.own_stiffness, H = problem.contact, G = problem.measured();
  // Points held at given displacements by efforts p, at rest.
  const Eigen::VectorXd p = Eigen::VectorXd::LinSpaced(H.rows(), 3, -2);
  const Eigen::VectorXd q = eigen::ldlt_solve(K, H.transpose() * p);
  // p = κ(H q − G q) is the reaction, and the structure is in balance: K' q = Gᵀp.
  CHECK((kappa * (H * q - G * q) - p).norm() < 1e-9 * p.norm());
  const Eigen::VectorXd load = H.transpose() * p;
  CHECK((Eigen::MatrixXd(problem.stiffness) * q - G.transpose() * p).norm() < 1e-9 * load.norm());
}

TEST_CASE("below the limit of coercivity Nitsche's method is refused with the limit, above it runs") {
  for (const int N : {5, 10, 20})
    for (const auto place : {StopsSpec::Place::tip, StopsSpec::Place::nodes}) {
      const double limit = place == StopsSpec::Place::tip ? 1 : chain(N);
      INFO(N << " elements, limit " << limit);
      const std::string said = refusal(beam_scene(place), N, nitsche(limit * (1 - 1e-6)));
      CHECK_THAT(said, names_cause_and_remedy());
      CHECK_THAT(said, Contains(fmt::format("the limit is {:.6g}", limit)));
      const auto above = made(beam_scene(place), N, nitsche(limit * (1 + 1e-6)));
      REQUIRE(std::holds_alternative<SemiDiscrete>(above));
      Eigen::SimplicialLLT<SparseMatrix> factor(std::get<SemiDiscrete>(above).stiffness);
      CHECK(factor.info() == Eigen::Success);
    }
  // 3.68, 3.91, 3.98 with stops at all nodes.
  CHECK(chain(5) == Approx(3.68).margin(5e-3));
  CHECK(chain(10) == Approx(3.91).margin(5e-3));
  CHECK(chain(20) == Approx(3.98).margin(5e-3));
  CHECK_THAT(refusal(released_bar(1e4, "0.05*(1-x)"), 8, nitsche(0.99)), Contains("the limit is 1,"));
  CHECK(refusal(released_bar(1e4, "0.05*(1-x)"), 8, nitsche(1.01)).empty());
}

TEST_CASE("what Nitsche's method cannot do is refused in a sentence") {
  for (const long long theta : {0LL, -1LL}) {
    Choice law = nitsche(10);
    law.values["theta"] = theta;
    CHECK_THAT(refusal(beam_scene(), 8, law), Contains("theta") && Contains("nonsymmetric"));
  }
  SceneSpec oscillator = thrown_mass();
  CHECK_THAT(refusal(oscillator, 1, nitsche(10)), Contains("oscillator") && Contains("penalty"));
  SceneSpec between = beam_scene(StopsSpec::Place::positions);
  between.stops.positions = {0.7};
  CHECK_THAT(refusal(between, 8, nitsche(10)), Contains("nodes"));
  SceneSpec stages = beam_scene();
  stages.stops = {};
  Place tip;
  tip.x = std::get<BeamSpec>(stages.structure).length;
  stages.stops.named = {{"soft", tip, {}, {}, 0.1}, {"hard", tip, {}, {}, 0.2}};
  CHECK_THAT(refusal(stages, 8, nitsche(10)), Contains("two stops stand at one node") && names_cause_and_remedy());
  // Lanes share the matrices.
  const SceneSpec scene = beam_scene();
  const auto problem = problem_of(scene, 8, {"consistent"}, nitsche(10));
  const auto two = [](const LaneSpec& lane) {
    std::vector<LaneSpec> lanes(2, lane);
    lanes[1].law.set("gamma0", 20.0);
    return lanes;
  };
  const auto program = compiled(problem, {{"consistent"}, nitsche(10), {"midpoint"}}, 1e-4, {}, two);
  REQUIRE(std::holds_alternative<Refusal>(program));
  CHECK_THAT(std::get<Refusal>(program).sentence.text, Contains("stiffness") && Contains("lanes"));
  // Nor is a problem that was made for another law taken.
  CHECK_THROWS_AS(compiled(problem, {{"consistent"}, nitsche(20), {"midpoint"}}, 1e-4), std::logic_error);
}

TEST_CASE("the law measures the reaction too, the observer where the points are") {
  Marcher beam = marcher(beam_scene(), 8, {{"consistent"}, nitsche(5), {"midpoint"}}, 1e-5);
  const SemiDiscrete& problem = *beam.program().problem;
  class Watch final : public StepObserver {
   public:
    double deepest = 0, apart = 0;
    long steps = 0;
    void stage_solved(const Marcher&, const StageView&) override {}
    void step_done(Marcher& marcher) override {
      const SemiDiscrete& problem = *marcher.program().problem;
      const Eigen::VectorXd q = marcher.position(0);
      const double u = (problem.contact * q)[0], g = (problem.measured() * q)[0];
      const double depth = std::max({0.0, problem.lower[0] - u, u - problem.upper[0]});
      CHECK(marcher.penetration(0) == Approx(depth).margin(1e-15));
      if (depth > deepest) deepest = depth;
      apart = std::max(apart, std::abs(u - g));
      ++steps;
    }
  } watch;
  beam.start(&watch);
  beam.march(12000, &watch);
  REQUIRE(beam.status(0).running);
  CHECK(watch.deepest > 0);
  // What the law takes for the displacement is another by a good part of the penetration.
  CHECK(watch.apart > 0.1 * watch.deepest);
  CHECK(beam.tip(0) == Approx((problem.tip * beam.position(0))[0]).epsilon(1e-12));
}

TEST_CASE("Nitsche's energy, that of K' and of its springs, is kept to round-off") {
  SceneSpec scene = beam_scene(GENERATE(StopsSpec::Place::tip, StopsSpec::Place::nodes));
  beam_of(scene).damping = {};
  const Choice time = GENERATE(Choice{"midpoint"}, Choice{"newmark-dumont-paoli", {{"beta", 0.5}}});
  Marcher beam = marcher(scene, 8, {{"consistent"}, nitsche(8, "conserving"), time}, 1e-4);
  EnergyDrift kept(beam);
  beam.start(&kept);
  beam.march(4000, &kept);
  REQUIRE(beam.status(0).running);
  CHECK(kept.deepest > 1e-3);
  CHECK(kept.drift < 1e-10);
}

TEST_CASE("at the tip Nitsche's error is a fraction of that of the penalty of the same κ") {
  // The motion of this mesh between rigid stops, exact in time.
  constexpr double rigid = 0.0607598064;
  const int N = 10;
  const SceneSpec scene = beam_scene();
  const auto error = [&](const Choice& law) {
    Marcher beam = marcher(scene, N, {{"consistent"}, law, {"midpoint"}}, 5e-6);
    run(beam, 0.4);
    REQUIRE(beam.status(0).running);
    return std::abs(beam.tip(0) - rigid);
  };
  // A dense march of the same equations gives these to three digits at any h ≤ 1e-5 s.
  const struct {
    double gamma0, nitsche, penalty;
  } known[] = {{3, 3.303e-4, 1.454e-3}, {10, 5.12e-5, 3.127e-4}, {30, 2.9e-6, 8.08e-5}};
  for (const auto& one : known) {
    const double kappa = one.gamma0 * element_stiffness(scene, N);
    const double found = error(nitsche(one.gamma0, "averaged"));
    const double soft = error({"penalty", {{"stiffness", kappa}, {"evaluation", std::string("averaged")}}});
    INFO("gamma0 " << one.gamma0 << ": " << found << " and " << soft);
    CHECK(found == Approx(one.nitsche).epsilon(0.002).margin(1e-6));
    CHECK(soft == Approx(one.penalty).epsilon(0.002).margin(1e-6));
    CHECK(found < soft / 4);
  }
}

TEST_CASE("with stops at all nodes the softened free beam costs Nitsche's method more than the stops do") {
  const int N = 10;
  const SceneSpec scene = beam_scene(StopsSpec::Place::nodes);
  const auto tip = [&](const Choice& law, const Choice& time, double h) {
    Marcher beam = marcher(scene, N, {{"consistent"}, law, time}, h);
    run(beam, 0.4);
    REQUIRE(beam.status(0).running);
    return beam.tip(0);
  };
  const double rigid = tip({"signorini"}, {"newmark-dumont-paoli"}, 2e-6);
  for (const double gamma0 : {10.0, 30.0}) {
    const double kappa = gamma0 * element_stiffness(scene, N);
    const double found = std::abs(tip(nitsche(gamma0, "averaged"), {"midpoint"}, 5e-6) - rigid);
    const Choice springs{"penalty", {{"stiffness", kappa}, {"evaluation", std::string("averaged")}}};
    const double soft = std::abs(tip(springs, {"midpoint"}, 5e-6) - rigid);
    INFO("gamma0 " << gamma0 << ": " << found << " and " << soft);
    CHECK(found > soft);
    CHECK(found < 1e-3);
  }
}
