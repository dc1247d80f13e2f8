// Friction at stops: discs that bounce, walls, a slider without mass, gain by restitution, published oscillators.
#include <array>
#include <random>
#include <ricochet/engine/jamming.hpp>

#include "tests/engine/rubbing.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

// Slope of a coordinate over some steps of free flight, to round-off.
double rate_over(Marcher& made, int dof, int steps) {
  const double before = made.position(0)[dof];
  made.march(steps);
  return (made.position(0)[dof] - before) / (steps * made.program().h);
}

// Dofs uy (height), ux (s = x + rφ, what slides at the contact) and rz (φ) of a disc over a floor.
SceneSpec disc(double mass, double inertia, double radius, double mu) {
  Eigen::Matrix3d M = Eigen::Matrix3d::Zero();
  M(0, 0) = M(1, 1) = mass;
  M(1, 2) = M(2, 1) = -mass * radius;
  M(2, 2) = inertia + mass * radius * radius;
  SceneSpec scene = given_scene(Eigen::Matrix3d::Zero(), M,
                                "dof,node,component,x,y,z,held\n1,P,uy,0,0,0,\n2,P,ux,0,0,0,\n3,P,rz,0,0,0,\n");
  scene.stops.named = {rubbing_floor(mu)};
  return scene;
}

// What shakes a floor, as a load on a block that stands on it: the block is told of from the floor.
SceneSpec shaken(double mass, double stiffness, double normal_force, double mu, double acceleration, double frequency) {
  SceneSpec scene = damped_block(mass, stiffness, normal_force, {mu, mu});
  scene.load = Formula(fmt::format("-{}*sin(2*pi*{}*t)", mass * acceleration, frequency), "", "t");
  return scene;
}

// What a damper slides along, which goes at this speed and by this motion.
TangentSpec along_by(double speed, std::shared_ptr<const TimeHistory> history) {
  MotionSpec motion;
  motion.history = std::move(history);
  TangentSpec out;
  out.speed = speed;
  out.motion = std::make_shared<const MotionSpec>(motion);
  return out;
}

}  // namespace

TEST_CASE("friction: a disc that bounces ends rolling, with the momentum that it has about the contact", "[friction]") {
  constexpr double m = 1.5, J = 0.08, r = 0.3, v = 2, spin = -1, g = 9.81, drop = 0.6, e = 0.8;
  // m v − (J/r) φ' about the contact stays; rolling is v + r φ' = 0.
  const double rolls = (m * v - J / r * spin) / (m + J / (r * r));
  CHECK(rolls == Approx(1.367441860465).epsilon(1e-12));
  for (const Choice& scheme : {moreau, dumont})
    for (const double h : {1e-2, 1e-3}) {
      INFO(scheme.name << ", h = " << h);
      Choice time = scheme;
      time.values["restitution"] = e;
      SceneSpec scene = disc(m, J, r, 0.15);
      scene.load.terms = {{true, {}, {}, Formula(-m * g), at_node("P")}};
      scene.initial.dofs = {{1, drop, 0}, {2, 0, v + r * spin}, {3, 0, spin}};
      Marcher made = marcher(scene, 1, {{"consistent"}, {"signorini"}, time}, h);
      const auto all = watched(made, 4);
      REQUIRE(made.status(0).running);
      const EnergyTotals& energy = all->audit.totals(0);
      CHECK(std::abs(energy.balance_residual()) <= 1e-10);
      CHECK(energy.work_of_contact < 0);
      CHECK(-energy.work_of_friction > 0.3);
      CHECK(rate_over(made, 1, 100) == Approx(0).margin(1e-10));
      CHECK(rate_over(made, 2, 100) == Approx(-rolls / r).margin(1e-10));
    }
}

TEST_CASE("friction: between two walls each hit takes the same speed along them", "[friction]") {
  SceneSpec scene = pressed_block(Eigen::Matrix2d::Identity(), 0.1, "0", 0.4, "0", 0, 0.5);
  scene.stops.named[0].lower = -0.01;
  scene.stops.named[0].upper = 0.01;
  Marcher made =
      marcher(scene, 1, {{"consistent"}, {"signorini"}, {"moreau-jean", {{"theta", 0.5}, {"restitution", 1.0}}}}, 1e-3);
  made.start();
  // Hits at 0.02, 0.06, … s; 2 m v_n = 1 N s at each.
  for (const double expected : {0.4, 0.3, 0.2, 0.1, 0.0, 0.0}) {
    CHECK(rate_over(made, 1, 10) == Approx(expected).margin(1e-12));
    made.march(30);
  }
}

TEST_CASE("friction: a slider without mass follows its springs, at order 2", "[friction]") {
  Eigen::Matrix2d K, M = Eigen::Matrix2d::Zero(), C = Eigen::Matrix2d::Zero();
  K << 1300, -900, -900, 1050;
  M(0, 0) = 1.3;
  C(0, 0) = 0.8;
  SceneSpec scene = given_scene(K, M, "dof,node,component,x,y,z,held\n1,P,ux,0,0,0,\n2,Q,ux,0,0,0,\n",
                                matrix_market(SparseMatrix(C.sparseView())));
  NamedStop damper = friction_damper(11, {0.1, 0.1});
  damper.at = at_node("Q", "ux");
  scene.stops.named = {damper};
  scene.load.terms = {{true, {}, {}, Formula("4*cos(11*t)", "", "t"), at_node("P", "ux")}};
  // Found between the events of the exact motion, every half second.
  const std::array<double, 8> expected{0.00642386,  -0.00192502, -0.00943887, -0.00924031,
                                       -0.00310346, 0.00263399,  0.00734259,  0.00908277};
  const CompileOptions allow = with_friction({"coulomb", {{"ringing", std::string("allow")}}});
  for (const Choice& time : {dumont, Choice{"newmark"}, Choice{"bathe"}}) {
    INFO(time.name);
    std::vector<double> steps, errors;
    for (const double h : {1e-3, 5e-4, 2.5e-4, 1.25e-4}) {
      Marcher made = marcher(scene, 1, {{"consistent"}, {"none"}, time}, h, allow);
      EnergyAudit audit(made);
      made.start(&audit);
      double most = 0;
      for (std::size_t k = 0; k < expected.size(); ++k) {
        made.march(std::llround(0.5 * static_cast<double>(k + 1) / h) - made.step(), &audit);
        most = std::max(most, std::abs(made.position(0)[0] - expected[k]));
      }
      UNSCOPED_INFO("h = " << h << ", off by " << most << ", heat " << -audit.totals(0).work_of_friction);
      steps.push_back(std::log(h));
      errors.push_back(std::log(most));
      if (h < 1.3e-4) {
        CHECK(most <= 5e-7);
        if (audit.balances()) CHECK(-audit.totals(0).work_of_friction == Approx(0.2349951407).epsilon(1e-4));
      }
    }
    CHECK(fitted_slope(steps, errors) >= 1.8);
  }
}

TEST_CASE("friction: with restitution a coupled impact may gain what its equations say, without it never",
          "[friction]") {
  // The inverse of W = [[1, 0.6], [0.6, 1]].
  Eigen::Matrix2d M;
  M << 1 / 0.64, -0.6 / 0.64, -0.6 / 0.64, 1 / 0.64;
  const Eigen::Vector2d before(-0.857392, -0.514664);
  const double brought = 0.5 * before.dot(M * before);
  for (const Choice& scheme : {moreau, dumont})
    for (const double e : {0.9, 0.0}) {
      INFO(scheme.name << ", e = " << e);
      Choice time = scheme;
      time.values["restitution"] = e;
      Marcher made = marcher(pressed_block(M, 1, "0", before[1], "0", 0.05, before[0]), 1,
                             {{"consistent"}, {"signorini"}, time}, 1e-3);
      const auto all = watched(made, 0.2);
      const EnergyTotals& energy = all->audit.totals(0);
      CHECK(energy.first.kinetic == Approx(brought).epsilon(1e-12));
      CHECK(std::abs(energy.balance_residual()) <= 1e-10 * brought);
      // W p = (1 + e)·0.857392 along n and 0.514664 along t, with p_t < p_n: it sticks.
      const Eigen::Vector2d after(e * 0.857392, 0);
      const double left = 0.5 * after.dot(M * after);
      CHECK(energy.last.kinetic == Approx(left).margin(1e-10));
      // It comes from where an impact gains most.
      CHECK(largest_gain(made.program().jam[0], e) == Approx(std::max(left / brought - 1, 0.0)).epsilon(1e-6));
      if (e > 0) CHECK(left / brought == Approx(1.265625).epsilon(1e-5));
      CHECK(rate_over(made, 0, 20) == Approx(after[0]).margin(1e-10));
      CHECK(rate_over(made, 1, 20) == Approx(0).margin(1e-10));
    }
}

TEST_CASE("friction: no direction of approach gains more than what plan says, and one gains as much", "[friction]") {
  std::mt19937 draw(7);
  std::uniform_real_distribution<double> uniform(0, 1);
  int gains = 0;
  for (int n = 0; n < 400; ++n) {
    JamNumber point;
    point.across = std::exp(4 * uniform(draw) - 2);
    point.coupling = std::sqrt(point.across) * uniform(draw);
    point.mu = 0.99 * uniform(draw) / std::max(point.coupling, 0.1);
    const double e = uniform(draw), c = point.coupling, d = point.across;
    const auto energy = [&](double v, double u) { return (d * v * v - 2 * c * v * u + u * u) / (d - c * c); };
    double most = 0;
    for (int k = 1; k < 20000; ++k) {
      const double tau = std::tan(M_PI * (k / 20000.0 - 0.5)) * std::sqrt(d - c * c) - c;
      // Sticks where W⁻¹(1 + e, −τ) lies in the cone; slides else against where it ends.
      const double p = (d * (1 + e) + c * tau) / (d - c * c), q = (-tau - c * (1 + e)) / (d - c * c);
      double after = 0;
      if (std::abs(q) > point.mu * p)
        for (const double way : {1.0, -1.0}) {
          const double push = (1 + e) / (1 - way * point.mu * c), slid = tau + push * (c - way * point.mu * d);
          if (way * slid > 0) after = slid;
        }
      most = std::max(most, energy(e, after) / energy(-1, tau) - 1);
    }
    INFO("c = " << c << ", d = " << d << ", mu = " << point.mu << ", e = " << e);
    const double told = largest_gain(point, e);
    CHECK(told >= most - 1e-12);
    // Directions are 1.6e-4 rad apart, and the largest gain may stand where sticking begins.
    CHECK(told <= most + 1e-3 * (1 + most));
    gains += told > 0;
    CHECK(largest_gain(point, 0) == 0);
  }
  CHECK(gains > 20);
  CHECK(largest_gain({.coupling = 0.6, .number = 0.18, .across = 1, .mu = 0.3}, 0.5) == 0);
}

TEST_CASE("friction: a block on a shaken floor wears and sticks as long as its events say", "[friction]") {
  constexpr double period = 0.25, h = period / 853;
  // Accelerations of the floor, wear power and stick share, found between events; 1.9 m/s² never moves it (μ N/m = 2).
  // Where it never rests, the step of a reversal may stick: two of 853.
  struct Row {
    double acceleration, wear, share, wear_off, share_off;
  };
  for (const Row& row : {Row{1.9, 0, 1, 0, 0}, Row{2.6, 0.3316360204, 0.3262755636, 3e-4, 3e-3},
                         Row{9, 8.5453108720, 0, 2e-3, 2.0 / 853}})
    for (const Choice& time : {moreau, dumont, alpha}) {
      INFO(time.name << ", A = " << row.acceleration);
      const FrictionTotals seen =
          rubbed_over(shaken(3, 0, 40, 0.15, row.acceleration, 4), {{"consistent"}, {"none"}, time}, h, 6, 10);
      CHECK(seen.wear / 4 == Approx(row.wear).epsilon(row.wear_off).margin(0));
      CHECK(seen.held / seen.time == Approx(row.share).epsilon(0).margin(row.share_off));
      // Told of from the ground, the surface goes by (A/ω)(1 − cos ωt).
      SceneSpec moved = shaken(3, 0, 40, 0.15, 0, 4);
      const double w = 8 * M_PI, A = row.acceleration;
      moved.load = LoadSpec();
      moved.stops.named[0].tangent = along_by(A / w, std::make_shared<const HarmonicMotion>(A / (w * w), w, M_PI));
      const FrictionTotals told = rubbed_over(moved, {{"consistent"}, {"none"}, time}, h, 6, 10);
      CHECK(told.wear / 4 == Approx(row.wear).epsilon(row.wear_off).margin(1e-12));
      CHECK(told.held / told.time == Approx(row.share).epsilon(0).margin(row.share_off));
    }
}

TEST_CASE("friction: published oscillators with a friction damper end where they are said to", "[friction]") {
  SECTION("code_aster sdnd100: each half swing loses 2 μN/k") {
    for (const Choice& time : {moreau, dumont, alpha}) {
      INFO(time.name);
      SceneSpec scene = damped_block(1, 1e4, 10, {0.1, 0.1});
      scene.initial.displacement = Formula(0.85e-3);
      const double h = 1e-5;
      Marcher made = marcher(scene, 1, {{"consistent"}, {"none"}, time}, h);
      made.start();
      int half = 1;
      for (const double expected : {-6.5e-4, 4.5e-4, -2.5e-4, 5e-5, 5e-5, 5e-5}) {
        made.march(std::llround(half++ * M_PI / 100 / h) - made.step());
        CHECK(made.tip(0) == Approx(expected).margin(1e-8));
      }
    }
  }
  SECTION("code_aster sdnd104: wear of a block on a shaken floor, in the window that is printed") {
    for (const Choice& time : {moreau, dumont, alpha}) {
      INFO(time.name);
      const FrictionTotals seen =
          rubbed_over(shaken(1, 3e-5, 10, 0.1, 1.5, 1), {{"consistent"}, {"none"}, time}, 1e-4, 4, 12);
      CHECK(seen.wear / 8 == Approx(0.409062).margin(1e-5));
    }
  }
  SECTION("Siconos' oscillator with unit friction, Moreau–Jean with h = 0.01") {
    SceneSpec scene = damped_block(1, 1, 1, {1, 1});
    scene.initial.displacement = Formula(12.0);
    scene.initial.velocity = Formula(6.0);
    Marcher made = marcher(scene, 1, {{"consistent"}, {"none"}, moreau}, 0.01);
    made.start();
    made.march(2500);
    const double rest = made.tip(0);
    CHECK(rest == Approx(0.68204413520).margin(1e-11));
    made.march(7500);
    CHECK(std::abs(made.tip(0) - rest) <= 1e-14);
  }
}
