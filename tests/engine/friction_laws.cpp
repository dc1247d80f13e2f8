// What friction obeys whatever the numbers: no gain without restitution, limits, frames, stops at one place.
#include <algorithm>
#include <array>
#include <random>

#include "tests/engine/rubbing.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

const Methods dry_blocks{{"consistent"}, {"none"}, moreau};

// Displacements of a dof at every step, and that the run went to its end.
std::vector<double> path(Marcher& made, int dof, double duration) {
  std::vector<double> out;
  made.start();
  for (long long n = made.step(); n < std::llround(duration / made.program().h); ++n) {
    made.march(1);
    out.push_back(made.position(0)[dof]);
  }
  REQUIRE(made.status(0).running);
  return out;
}

double size_of(const std::vector<double>& all) {
  double most = 0;
  for (const double x : all) most = std::max(most, std::abs(x));
  return most;
}

// A tube with two stops on both sides, whose surface turns there.
SceneSpec knocking_tube(double mu) {
  SceneSpec scene = working_set();
  beam_of(scene).damping = {};
  scene.initial.displacement = Formula(0.0);
  NamedStop end{.name = "end", .at = {}, .to = {}, .lower = -0.01, .upper = 0.02}, middle = end;
  middle.name = "middle";
  middle.lower = -0.004;
  middle.upper = 0.003;
  end.at.x = 1.501;
  middle.at.x = 0.75;
  scene.stops = {};
  for (NamedStop* stop : {&end, &middle}) {
    stop->tangent = TangentSpec{.slope_radius = 0.005, .direction = {}, .component = "", .speed = 0};
    if (mu > 0) stop->friction = FrictionSpec{mu, mu};
    scene.stops.named.push_back(*stop);
  }
  return scene;
}

// How much a step gained at most, over the energy of the start.
double largest_gain(const SceneSpec& scene, int elements, const Methods& methods, double h, double duration) {
  Marcher made = marcher(scene, elements, methods, h);
  const auto all = watched(made, duration);
  REQUIRE(made.status(0).running);
  const EnergyTotals& energy = all->audit.totals(0);
  REQUIRE(energy.first.common() > 0);
  CHECK(energy.last.common() < energy.first.common());
  CHECK((energy.work_of_friction < 0) == !made.program().problem->rubbing.empty());
  return energy.largest_step_gain / energy.first.common();
}

}  // namespace

TEST_CASE("a block that turns back under its static bound stays there at every step, and so does one that starts there",
          "[friction]") {
  // k = 100 N/m; thrown so that it stops at 40 mm, where the spring pulls 4 N: ½ v² = ½ k x² + μ_d N x.
  const double stiffness = 100, place = 0.04, force = 10;
  for (const Choice& scheme : {moreau, dumont})
    for (const auto& [held, stays] : {std::pair(0.41, true), std::pair(0.39, false)}) {
      SceneSpec scene = damped_block(1, stiffness, force, {held, 0.1});
      scene.initial.displacement = Formula(0.0);
      scene.initial.velocity = Formula(std::sqrt(stiffness * place * place + 2 * 0.1 * force * place));
      for (const double h : {1e-3, 7e-4, 5e-4, 2.5e-4, 1.7e-4, 1.25e-4}) {
        INFO(scheme.name << ", static " << held << ", h = " << h);
        Marcher made = marcher(scene, 1, {{"consistent"}, {"none"}, scheme}, h, with_friction({"coulomb"}));
        const double end = path(made, 0, 0.5).back();
        // Else it slides back past the middle.
        CHECK((std::abs(end - place) < 5 * h * h * stiffness) == stays);
        if (!stays) CHECK(std::abs(end) < 0.75 * place);
      }
      SceneSpec released = damped_block(1, stiffness, force, {held, 0.1});
      released.initial.displacement = Formula(place);
      released.initial.velocity = Formula(0.0);
      Marcher made = marcher(released, 1, {{"consistent"}, {"none"}, scheme}, 1e-3, with_friction({"coulomb"}));
      CHECK((std::abs(path(made, 0, 0.5).back() - place) < 1e-12) == stays);
    }
}

TEST_CASE("friction without restitution: no impact gains energy, whatever couples normal and tangent", "[friction]") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-1, 1), share(0.05, 0.95);
  int stuck = 0, slid = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const double coupling = 0.9 * any(random), a = std::exp(any(random)), b = std::exp(any(random));
    Eigen::Matrix2d M;
    M << a * a, coupling * a * b, coupling * a * b, b * b;
    // W_nt/W_nn of M⁻¹; a jam number below 1, and no more friction than steel on steel could be asked to have.
    const double mu = std::min(3.0, share(random) / std::abs(coupling * a / b));
    for (const Choice& scheme : {moreau, dumont}) {
      Choice time = scheme;
      time.values["restitution"] = 0.0;
      INFO("trial " << trial << ", " << time.name << ", coupling " << coupling << ", mu " << mu);
      Marcher made = marcher(pressed_block(M, mu, "0", 2 * any(random), "0", 0.02, -1), 1,
                             {{"consistent"}, {"signorini"}, time}, 1e-3);
      const auto all = watched(made, 0.1);
      const EnergyTotals& energy = all->audit.totals(0);
      CHECK(energy.largest_step_gain <= 1e-12 * energy.first.common());
      CHECK(energy.last.common() <= energy.first.common());
      const double before = made.position(0)[1];
      made.march(10);
      (std::abs(made.position(0)[1] - before) > 1e-9 ? slid : stuck) += 1;
    }
  }
  CHECK(stuck > 10);
  CHECK(slid > 10);
}

TEST_CASE("friction without restitution: a tube that knocks gains at reversals alone, and ever less", "[friction]") {
  // A step gains ½ h p_t·a at most, a the free acceleration of a surface that turns back: order 1 at an impact.
  for (const Choice& scheme : {moreau, dumont}) {
    Choice time = scheme;
    time.values["restitution"] = 0.0;
    const Methods methods{{"consistent"}, {"signorini"}, time};
    std::vector<double> steps, gains;
    for (const double h : {1e-3, 3e-4, 1e-4, 3e-5, 1e-5}) {
      INFO(time.name << ", h = " << h);
      CHECK(largest_gain(knocking_tube(0), 4, methods, h, 0.5) <= 1e-14);
      steps.push_back(std::log(h));
      gains.push_back(std::log(largest_gain(knocking_tube(0.4), 4, methods, h, 0.5)));
    }
    CHECK(fitted_slope(steps, gains) >= 1);
  }
}

TEST_CASE("friction: a bound that nothing reaches holds as a support does", "[friction]") {
  Eigen::Matrix2d K, M;
  K << 1300, -900, -900, 1050;
  M << 1.3, 0, 0, 0.7;
  const std::string table = "dof,node,component,x,y,z,held\n1,P,ux,0,0,0,\n2,Q,ux,0,0,0,";
  SceneSpec sticks = given_scene(K, M, table + "\n"), held = given_scene(K, M, table + "fixed\n");
  NamedStop damper = friction_damper(1e12, {1, 1});
  damper.at = at_node("Q", "ux");
  sticks.stops.named = {damper};
  for (SceneSpec* scene : {&sticks, &held}) {
    scene->load.terms = {{true, {}, {}, Formula("4*cos(11*t)", "", "t"), at_node("P", "ux")}};
    scene->initial.dofs = {{1, 0.01, 0.2}};
  }
  for (const Choice& time : {moreau, dumont, alpha, Choice{"bathe"}}) {
    INFO(time.name);
    Marcher a = marcher(sticks, 1, {{"consistent"}, {"none"}, time}, 1e-3),
            b = marcher(held, 1, {{"consistent"}, {"none"}, time}, 1e-3);
    const std::vector<double> stuck = path(a, 0, 2), supported = path(b, 0, 2);
    CHECK(largest_gap(stuck, supported) <= 1e-12 * size_of(supported));
    CHECK(std::abs(a.position(0)[1]) <= 1e-14);
  }
}

TEST_CASE("friction: a floor that moves under a structure is a structure that moves over a floor", "[friction]") {
  // The motion of the floor, and the same with the other sign of the clamp with what takes its inertia load away.
  constexpr double mass = 3, stiffness = 40, amplitude = 0.02, pulsation = 9;
  SceneSpec floor = damped_block(mass, stiffness, 12, {0.2, 0.15}), clamp = floor;
  floor.stops.named[0].motion = std::make_shared<const MotionSpec>(
      MotionSpec{.supports = {}, .history = std::make_shared<HarmonicMotion>(amplitude, pulsation, 0)});
  clamp.support = {.amplitude = -amplitude, .pulsation = pulsation, .phase = 0};
  clamp.load = Formula(fmt::format("{}*sin({}*t)", mass * amplitude * pulsation * pulsation, pulsation), "", "t");
  // Relative to the clamp the block begins as it does beside the floor.
  clamp.initial.velocity = Formula(-amplitude * pulsation);
  for (const Choice& time : {moreau, dumont, alpha}) {
    INFO(time.name);
    Methods methods = dry_blocks;
    methods.time = time;
    Marcher a = marcher(floor, 1, methods, 1e-3), b = marcher(clamp, 1, methods, 1e-3);
    const std::vector<double> over = path(a, 0, 3), under = path(b, 0, 3);
    CHECK(size_of(over) > 1e-3);
    CHECK(largest_gap(over, under) <= 1e-11 * size_of(over));
  }
}

TEST_CASE("friction: two stops of half the strength at one place are one", "[friction]") {
  SceneSpec whole = damped_block(2, 800, 30, {0.15, 0.1}), halves = damped_block(2, 800, 15, {0.15, 0.1});
  halves.stops.named.push_back(halves.stops.named[0]);
  halves.stops.named[1].name = "second";
  SceneSpec pressed = pressed_block(2 * Eigen::Matrix2d::Identity(), 0.3, "-19.62-9*sin(60*t)", 0.6, "4*cos(17*t)"),
            twice = pressed;
  pressed.stops.named[0].own.stiffness = 2e4;
  twice.stops.named[0].own.stiffness = 1e4;
  twice.stops.named.push_back(twice.stops.named[0]);
  twice.stops.named[1].name = "second";
  for (SceneSpec* scene : {&whole, &halves}) scene->initial.displacement = Formula(0.0331);
  for (const Choice& time : {moreau, dumont, alpha}) {
    INFO(time.name);
    Methods methods{{"consistent"}, {"none"}, time};
    Marcher a = marcher(whole, 1, methods, 1e-3), b = marcher(halves, 1, methods, 1e-3);
    const std::vector<double> one = path(a, 0, 1), two = path(b, 0, 1);
    CHECK(largest_gap(one, two) <= 1e-12 * size_of(one));
    methods.contact = {"penalty", {{"stiffness", 2e4}, {"evaluation", std::string("averaged")}}};
    if (time.name == alpha.name) methods.contact.values.erase("evaluation");
    Marcher c = marcher(pressed, 1, methods, 1e-3), d = marcher(twice, 1, methods, 1e-3);
    const std::vector<double> single = path(c, 1, 1), both = path(d, 1, 1);
    CHECK(largest_gap(single, both) <= 1e-11 * size_of(single));
  }
}

TEST_CASE("friction: springs and limited speeds tend to exact friction at order 1", "[friction]") {
  // Wear of a block on a shaken floor, exactly 0.3316360204 W (its events), and what each law makes of it: the equation
  // of one mass, marched by itself.
  SceneSpec scene = damped_block(3, 0, 40, {0.15, 0.15});
  scene.load = Formula("-7.8*sin(8*pi*t)", "", "t");
  const auto wear_of = [&](const Choice& law, double h) {
    return rubbed_over(scene, dry_blocks, h, 6, 10, with_friction(law)).wear / 4;
  };
  const double h = 0.25 / 3413, exact = 0.3316360204;
  struct Row {
    Choice law;
    double refined, wear;
  };
  const auto spring = [](double stiffness) {
    return Choice{"spring", {{"stiffness", stiffness}, {"damping", 2 * std::sqrt(3 * stiffness)}}};
  };
  const auto limited = [](double speed) { return Choice{"limited", {{"speed", speed}}}; };
  for (const std::vector<Row>& rows :
       {std::vector<Row>{{spring(1e5), 1e-5, 0.37055}, {spring(1e6), 1e-6, 0.33520}},
        std::vector<Row>{{limited(1e-2), 1e-2, 0.643}, {limited(1e-3), 1e-3, 0.365}, {limited(1e-4), 1e-4, 0.335}}}) {
    std::vector<double> refined, off;
    for (const Row& row : rows) {
      INFO(row.law.name << ", " << row.refined);
      const double wear = wear_of(row.law, h);
      CHECK(wear == Approx(row.wear).epsilon(2e-3));
      refined.push_back(std::log(row.refined));
      off.push_back(std::log(std::abs(wear - exact)));
    }
    CHECK(fitted_slope(refined, off) == Approx(1).margin(0.15));
  }
}
