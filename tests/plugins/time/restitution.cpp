// What a scheme restitutes of the speed of a free mass at a rigid stop, over the phases of the step at which they meet.
#include <ricochet/measure/stability/plan_restitution.hpp>

#include "tests/plugins/time/family.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

ProblemFacts free_mass() {
  return {1, 0, false, true};
}

// −v⁺/v⁻ of a mass that meets its stop the share ξ of a step after a step's beginning.
double thrown_back(const Choice& time, double share) {
  const double h = 1e-3;
  SceneSpec scene = oscillator(0, 0, (3 + share) * h, -1);
  scene.stops.lower = Formula(0.0);
  scene.stops.place = StopsSpec::Place::tip;
  Marcher mass = marcher(scene, 1, {{"consistent"}, {"signorini"}, time}, h);
  mass.start();
  mass.march(20 - mass.step());
  const double before = mass.tip(0);
  mass.march(1);
  return (mass.tip(0) - before) / h;
}

}  // namespace

TEST_CASE("least, mean and most that a free mass keeps of its speed, by scheme") {
  struct Row {
    Choice time;
    double least, mean, most;
  };
  const std::vector<Row> rows = {{scheme("newmark"), 0.34, 1.67, 3},
                                 {scheme("hht-alpha"), 0.26, 1.28, 2.31},
                                 {scheme("hht-alpha", {{"alpha", -0.3}}), 0.14, 0.75, 1.37},
                                 {scheme("wbz-alpha"), 0.34, 1.47, 2.60},
                                 {scheme("generalised-alpha", {{"rho_inf", 1.0}}), 0, 0.5, 1},
                                 {scheme("generalised-alpha"), 0.03, 0.59, 1.16},
                                 {scheme("generalised-alpha", {{"rho_inf", 0.0}}), 0.33, 0.67, 1},
                                 {scheme("bathe", {{"split", 0.5}}), 0.27, 1.10, 2},
                                 {scheme("bathe", {{"rho_inf", 0.8}}), 0.30, 1.56, 2.89},
                                 {scheme("midpoint"), 0, 0.5, 1},
                                 {worded("midpoint", "constraint", "middle"), 0.34, 1.67, 3},
                                 {scheme("kane"), 0, 0.5, 1},
                                 {scheme("kane", {{"beta", 0.3}, {"gamma", 0.6}}), 0, 0.5, 1},
                                 {scheme("noh-bathe"), 0, 0.02, 0.06},
                                 {scheme("sdirk"), 0, 0.78, std::sqrt(2.0)},
                                 {scheme("sdirk", {{"order", 3LL}}), 0, 0.38, std::sqrt(3.0) - 1}};
  for (const Row& row : rows) {
    INFO(label(row.time));
    const auto range = restitution_range(plan_made(row.time, 1e-3, free_mass()), 1e-3);
    REQUIRE(range);
    // 64 phases: the outermost lies 1/128 of a step off the end of a piece. No piece crosses the whole range in less
    // than a quarter of a step. Printed to two digits.
    const double phase = (row.most - row.least) / 32 + 0.005;
    CHECK(range->least == Approx(row.least).margin(phase));
    CHECK(range->most == Approx(row.most).margin(phase));
    CHECK(range->mean == Approx(row.mean).margin(0.012));
  }
}

TEST_CASE("schemes that know a restitution keep it at every phase") {
  struct Row {
    Choice time;
    double e;
  };
  std::vector<Row> rows = {{scheme("laursen-chawla"), 1},
                           {scheme("contact-stabilised-newmark"), 0},
                           {worded("contact-stabilised-newmark", "velocity", "corrected"), 0},
                           {scheme("carpenter-taylor-katona"), 0}};
  for (const char* name : {"moreau-jean", "cd-lagrange", "paoli-schatzman", "newmark-dumont-paoli"})
    for (const double e : {0.0, 0.3, 0.8, 1.0}) rows.push_back({scheme(name, {{"restitution", e}}), e});
  for (const Row& row : rows) {
    INFO(label(row.time));
    const auto range = restitution_range(plan_made(row.time, 1e-3, free_mass()), 1e-3);
    REQUIRE(range);
    // Round-off of positions of a few h, over h.
    CHECK(range->least == Approx(row.e).margin(1e-12));
    CHECK(range->mean == Approx(row.e).margin(1e-12));
    CHECK(range->most == Approx(row.e).margin(1e-12));
  }
  CHECK_FALSE(restitution_range(plan_made(scheme("central-difference"), 1e-3, free_mass()), 1e-3));
}

TEST_CASE("an α-method throws a mass that lands at the end of a step back by (1−α_m)/(βπ₀) − 1") {
  struct Row {
    Choice time;
    double mass, force, beta, first;  // α_m, α_f, β, π₀
  };
  const auto squared = [](double x) { return 0.25 * x * x; };
  std::vector<Row> rows = {{scheme("newmark"), 0, 0, 0.25, 1}, {scheme("newmark", {{"beta", 0.4}}), 0, 0, 0.4, 1}};
  for (const double a : {0.1, 0.3}) rows.push_back({scheme("hht-alpha", {{"alpha", -a}}), 0, a, squared(1 + a), 1});
  for (const double rho : {0.0, 0.5, 0.8}) {
    const double mass = (rho - 1) / (rho + 1), both = (2 * rho - 1) / (rho + 1), force = rho / (rho + 1);
    rows.push_back({scheme("wbz-alpha", {{"rho_inf", rho}}), mass, 0, squared(1 - mass), 1});
    rows.push_back({scheme("generalised-alpha", {{"rho_inf", rho}}), both, force, squared(1 - both + force), 1});
    rows.push_back({scheme("generalised-alpha", {{"rho_inf", rho}, {"contact", std::string("weighted")}}), both, force,
                    squared(1 - both + force), 1 - force});
  }
  const double late = 1 - 1e-6;
  for (const Row& row : rows) {
    INFO(label(row.time));
    const double e = (1 - row.mass) / (row.beta * row.first) - 1;
    // Just beyond the stop at a step's end; first order in what is left of the phase, by a slope of a few e.
    CHECK(thrown_back(row.time, late) == Approx(e).margin(1e-4));
  }
  // Chung–Hulbert with the effort whole: 1 + ρ(1 − ρ) ≤ 1.25; weighted at ρ = 0.8: 2.89.
  CHECK(thrown_back(scheme("generalised-alpha", {{"rho_inf", 0.5}}), late) == Approx(1.25).margin(1e-4));
  CHECK(thrown_back(worded("generalised-alpha", "contact", "weighted"), late) == Approx(2.888).margin(1e-3));
}

TEST_CASE("Bathe's scheme throws back by 4q₁/γ − 1 and (q₀+q₂)(1−γ)/q₂² − 1, a sub-step each") {
  for (const double rho : {0.0, 0.5, 0.8, 1.0})
    for (const double split : {0.0, 0.4, 0.5}) {
      const Choice time = scheme("bathe", {{"rho_inf", rho}, {"split", split}});
      const double derived = rho == 1 ? 0.5 : (2 - std::sqrt(2 + 2 * rho)) / (1 - rho);
      const double gamma = split == 0 ? derived : split;
      const double q1 = (rho + 1) / (2 * gamma * (rho - 1) + 4), q2 = 0.5 - gamma * q1, q0 = 1 - q1 - q2;
      INFO(label(time));
      // Landed as a sub-step ends, it is the next one that throws it back: the second, then the first.
      CHECK(thrown_back(time, gamma - 1e-6) == Approx((q0 + q2) * (1 - gamma) / (q2 * q2) - 1).margin(1e-4));
      CHECK(thrown_back(time, 1 - 1e-6) == Approx(4 * q1 / gamma - 1).margin(1e-4));
    }
}

TEST_CASE("Kane's scheme, and the mid-point rule with the constraint at the end, keep |1 − 2ξ|") {
  for (const Choice& time : {scheme("kane"), scheme("kane", {{"beta", 0.35}, {"gamma", 0.7}}), scheme("midpoint"),
                             scheme("generalised-alpha", {{"rho_inf", 1.0}})})
    for (const double share : {0.05, 0.3, 0.5, 0.7, 0.95}) {
      INFO(label(time) << " ξ = " << share);
      CHECK(thrown_back(time, share) == Approx(std::abs(1 - 2 * share)).margin(1e-9));
    }
}
