// Friction at stops: closed forms of blocks that slide, stick, are pressed and hit.
#include <cmath>

#include "tests/engine/rubbing.hpp"

using namespace ricochet;
using namespace ricochet::testing;

TEST_CASE("friction: a block that slides to rest stays there, and its energy is heat", "[friction]") {
  // v²/(2 μ g) with μ g = 0.2 · 9.81; the last step is cut at order h². The first acceleration knows friction.
  for (const Choice& time : {moreau, dumont, alpha, Choice{"bathe"}}) {
    INFO(time.name);
    Marcher made = marcher(pressed_block(2 * Eigen::Matrix2d::Identity(), 0.2, "-19.62", 1), 1,
                           {{"consistent"}, {"signorini"}, time}, 1e-3);
    const auto all = watched(made, 3);
    REQUIRE(made.status(0).running);
    CHECK(along(made) == Approx(0.2548419980).margin(1e-6));
    const double rest = along(made);
    made.march(10000);
    CHECK(std::abs(along(made) - rest) <= 1e-14);
    CHECK(all->watch.residual() <= 1e-12);
    if (!all->audit.balances()) continue;
    CHECK(-all->audit.totals(0).work_of_friction == Approx(1).epsilon(1e-6));
    CHECK(std::abs(all->audit.totals(0).balance_residual()) <= 1e-12);
    CHECK(all->watch.totals(0).heat == Approx(1).epsilon(1e-6));
  }
}

TEST_CASE("friction: a block on a spring stops turn by turn where Coulomb's law puts it", "[friction]") {
  // Each half swing loses 2 s/k = 0.0075 m; at 0.0031 m the spring pulls by 2.48 N of 3.
  for (const Choice& time : {moreau, dumont, alpha}) {
    INFO(time.name);
    SceneSpec scene = damped_block(2, 800, 30, {0.1, 0.1});
    scene.initial.displacement = Formula(0.0331);
    Marcher made = marcher(scene, 1, {{"consistent"}, {"none"}, time}, 1e-4);
    const auto all = watched(made, 1);
    CHECK(made.tip(0) == Approx(0.0031).margin(1e-7));
    if (all->audit.balances()) CHECK(-all->audit.totals(0).work_of_friction == Approx(0.4344).epsilon(1e-5));
    CHECK(all->watch.totals(0).slipped == Approx(0.1448).epsilon(1e-4));
  }
}

TEST_CASE("friction: a reversal of sliding that one step solves as rest is no stick", "[friction]") {
  // The block above turns three times and then stays.
  for (const Choice& time : {moreau, alpha, Choice{"sdirk", {{"order", 3LL}}}})
    for (const double h : {1e-4, 3.1e-5, 1e-5, 3.1e-6}) {
      INFO(time.name << ", h = " << h);
      SceneSpec scene = damped_block(2, 800, 15, {0.2, 0.2});
      scene.initial.displacement = Formula(0.0331);
      Marcher made = marcher(scene, 1, {{"consistent"}, {"signorini"}, time}, h);
      CHECK(watched(made, 1)->watch.totals(0).changes == 1);
    }
}

TEST_CASE("friction: one impact is Newton with Coulomb, whatever the step", "[friction]") {
  // A disc with the dofs height and rolling speed at the contact: masses m and (1/m + r²/J)⁻¹.
  constexpr double m = 2, J = 0.3, r = 0.4;
  const double rolling = 1 / (1 / m + r * r / J);
  Eigen::Matrix2d M = Eigen::Matrix2d::Zero();
  M(0, 0) = m;
  M(1, 1) = rolling;
  for (const double e : {0.0, 0.7})
    for (const Choice& scheme : {moreau, dumont, Choice{"cd-lagrange"}})
      for (const double h : {1e-3, 1e-4}) {
        Choice time = scheme;
        time.values["restitution"] = e;
        INFO(time.name << ", e = " << e << ", h = " << h);
        // Slip at 1.2 + 0.4·3 m/s under μ = 0.12: it goes on sliding. At 0.3 − 0.08 under 0.5: it sticks.
        for (const auto& [slip, mu] : {std::pair(1.2 + r * 3, 0.12), {0.3 - r * 0.2, 0.5}}) {
          Marcher made =
              marcher(pressed_block(M, mu, "0", slip, "0", 0.1, -2), 1, {{"consistent"}, {"signorini"}, time}, h);
          const auto all = watched(made, 0.08);
          const double impulse = (1 + e) * m * 2, before = slip, left = before - mu * impulse / rolling;
          const double after = std::max(0.0, left);
          const double at = made.time(), place = along(made);
          made.march(100);
          CHECK((along(made) - place) / (made.time() - at) == Approx(after).margin(1e-11));
          CHECK(-all->audit.totals(0).work_of_friction ==
                Approx(0.5 * rolling * (before * before - after * after)).epsilon(1e-10));
        }
      }
}

TEST_CASE("friction: coupled inertia slides and presses as its equations say, and jams are refused", "[friction]") {
  Eigen::Matrix2d M;
  M << 2, 0.6, 0.6, 0.5;
  for (const Choice& time : {moreau, dumont})
    for (const auto& [speed, rest] : {std::pair(0.9, 0.1033448276), {-0.9, -0.0300857143}}) {
      INFO(time.name << ", v = " << speed);
      Marcher made = marcher(pressed_block(M, 0.4, "-8", speed, "0.3"), 1, {{"consistent"}, {"signorini"}, time}, 1e-4);
      run(made, 1);
      CHECK(along(made) == Approx(rest).margin(1e-6));
    }
  const auto at = [&](double mu) {
    return compiled(problem_of(pressed_block(M, mu, "-8", 0.9), 1, {"consistent"}, Choice{"signorini"}),
                    {{"consistent"}, {"signorini"}, moreau}, 1e-4);
  };
  // W_nt/W_nn = 1.2 of this mass.
  CHECK(std::holds_alternative<Program>(at(0.83)));
  const auto jams = at(0.84);
  REQUIRE(std::holds_alternative<Refusal>(jams));
  CHECK(std::get<Refusal>(jams).sentence.text ==
        "stop floor may jam: μ = 0.84 times the coupling 1.2 of its normal and tangent is 1.008, and 1 or more has "
        "several motions. Use a smaller friction");
}

TEST_CASE("friction: exact friction holds, a spring gives way, a limited speed creeps", "[friction]") {
  const SceneSpec scene = pressed_block(Eigen::Matrix2d::Identity(), 0.3, "-10", 0, "2.9");
  const auto place_after = [&](const Choice& law, double duration) {
    Marcher made = marcher(scene, 1, {{"consistent"}, {"signorini"}, moreau}, 1e-3, with_friction(law));
    run(made, duration);
    return along(made);
  };
  CHECK(std::abs(place_after({"coulomb"}, 10)) <= 1e-12);
  // 2.9 N on 2e5 N/m; so much damping that no overshoot passes the bound.
  CHECK(place_after({"spring", {{"stiffness", 2e5}, {"damping", 5000.0}}}, 1) == Approx(1.45e-5).margin(1e-9));
  // 2.9/3 of the speed, from the first steps on.
  CHECK(place_after({"limited", {{"speed", 1e-4}}}, 2) - place_after({"limited", {{"speed", 1e-4}}}, 1) ==
        Approx(9.666667e-5).epsilon(1e-6));
}

TEST_CASE("friction: a belt makes a block stick and slip between static and dynamic friction", "[friction]") {
  SceneSpec scene = damped_block(1.5, 600, 20, {0.3, 0.2});
  std::get<OscillatorSpec>(scene.structure).damping = 0.4;
  scene.stops.named[0].tangent = TangentSpec{.slope_radius = 0, .direction = {}, .component = "", .speed = 0.08};
  const double h = 2 * M_PI / (18 * 3571);
  for (const Choice& time : {moreau, dumont}) {
    INFO(time.name);
    Marcher made = marcher(scene, 1, {{"consistent"}, {"none"}, time}, h);
    run(made, 5);
    double most = -1, least = 1;
    for (int n = 0; n < 20000; ++n) {
      made.march(1);
      most = std::max(most, made.tip(0));
      least = std::min(least, made.tip(0));
    }
    // Extremes of the steady motion, found between its events; 1e-3 of the amplitude.
    CHECK(most == Approx(0.011826).margin(1.1e-5));
    CHECK(least == Approx(0.001614).margin(1.1e-5));
  }
}

TEST_CASE("friction without restitution never gives energy, and a scheme that rings is refused", "[friction]") {
  SceneSpec scene = damped_block(2, 800, 30, {0.1, 0.1});
  const auto refused =
      compiled(problem_of(scene, 1, {"consistent"}, Choice{"none"}), {{"consistent"}, {"none"}, {"newmark"}}, 1e-4);
  REQUIRE(std::holds_alternative<Refusal>(refused));
  CHECK(std::get<Refusal>(refused).sentence.text ==
        "friction does not run under this time scheme: it alternates the effort of a point that sticks (by the factor "
        "-1 a step). Use a scheme that closes velocities at its stops, or more numerical damping: `ricochet describe` "
        "says "
        "by what factor a scheme forgets a disturbance of a held effort");
  CHECK(std::holds_alternative<Program>(compiled(problem_of(scene, 1, {"consistent"}, Choice{"none"}),
                                                 {{"consistent"}, {"none"}, {"newmark"}}, 1e-4,
                                                 with_friction({"coulomb", {{"ringing", std::string("allow")}}}))));
}

TEST_CASE("friction: lanes and states that are taken over march on with equal bits", "[friction]") {
  SceneSpec scene = damped_block(2, 800, 30, {0.15, 0.1});
  scene.initial.displacement = Formula(0.0331);
  const Methods methods{{"consistent"}, {"none"}, dumont};
  Marcher whole = marcher(scene, 1, methods, 1e-3), cut = marcher(scene, 1, methods, 1e-3),
          later = marcher(scene, 1, methods, 1e-3);
  run(whole, 0.6);
  run(cut, 0.25);
  later.start();
  later.set_clock(cut.step());
  later.set_lane(0, later.program().lanes[0], cut.lane_state(0));
  later.march(350);
  CHECK(later.tip(0) == whole.tip(0));
  const auto four = [](const LaneSpec& lane) {
    std::vector<LaneSpec> lanes(4, lane);
    for (std::size_t k = 0; k < lanes.size(); ++k) lanes[k].position *= 1 - 0.2 * static_cast<double>(k);
    return lanes;
  };
  Marcher block = marcher(scene, 1, methods, 1e-3, {}, four);
  run(block, 0.6);
  for (int lane = 0; lane < 4; ++lane) {
    Marcher alone = marcher(scene, 1, methods, 1e-3, {}, [&](const LaneSpec& spec) {
      return std::vector<LaneSpec>{four(spec)[static_cast<std::size_t>(lane)]};
    });
    run(alone, 0.6);
    CHECK(block.tip(lane) == alone.tip(0));
  }
}
