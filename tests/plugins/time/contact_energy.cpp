// The largest gain of energy in one step of an undamped beam between stops at all nodes: none, or some.
#include "tests/plugins/time/family.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

// Over 0.3 s, of the scheme's energy at the start; the initial displacement is scaled by 1 + `change`.
double largest_gain(const Choice& mass, const Choice& time, double h, double change = 0) {
  SceneSpec scene = compared_beam(0);
  scene.stops.place = StopsSpec::Place::nodes;
  std::ostringstream displacement;
  displacement << 0.04 * (1 + change) << "*x^2";
  scene.initial.displacement = Formula(displacement.str(), "/scene/initial/displacement", "x");
  Marcher beam = marcher(scene, 10, {mass, {"signorini"}, time}, h);
  const EnergyAudit audit = audited(beam, 0.3);
  INFO(label(time) << " h = " << h);
  CHECK(beam.status(0).running);
  CHECK(audit.contact(0).impacts > 0);
  return audit.totals(0).largest_step_gain / audit.totals(0).scheme_start;
}

// Median over nine beams that differ by 10⁻³: one integration is a draw that may be ten times another.
double usual_gain(const Choice& time, double h) {
  std::vector<double> gains;
  for (int k = -4; k <= 4; ++k) gains.push_back(largest_gain({"consistent"}, time, h, 1e-3 * k));
  return median_of(gains);
}

}  // namespace

TEST_CASE("contact at all nodes gives energy in no step of the schemes that say so") {
  const auto time = GENERATE(scheme("kane"), scheme("kane", {{"beta", 0.3}, {"gamma", 0.6}}), scheme("midpoint"),
                             scheme("generalised-alpha", {{"rho_inf", 1.0}}), scheme("contact-stabilised-newmark"),
                             worded("contact-stabilised-newmark", "velocity", "corrected"), scheme("laursen-chawla"),
                             scheme("moreau-jean", {{"restitution", 0.8}}), scheme("newmark-dumont-paoli"),
                             scheme("newmark-dumont-paoli", {{"beta", 0.25}}), scheme("carpenter-taylor-katona"),
                             scheme("cd-lagrange"), scheme("cd-lagrange", {{"restitution", 0.8}}),
                             scheme("cd-lagrange", {{"restitution", 1.0}}));
  CHECK(plan_made(time, 1e-4).facts.contact_never_gains);
  // Round-off of one step, 10⁻¹⁶ of terms up to 10⁴ times the energy. Explicit steps are below their limit.
  const double round_off = 2e-12;
  const bool limited = plan_made(time, 1e-4).facts.stability_limit.has_value();
  for (const double h : {1e-4, 2e-5}) {
    INFO(label(time) << " h = " << h);
    CHECK(largest_gain({"lumped"}, time, h) <= round_off);
    if (!limited || h < 1e-4) CHECK(largest_gain({"consistent"}, time, h) <= round_off);
  }
}

TEST_CASE("Laursen and Chawla's contact at all nodes takes no energy either") {
  SceneSpec scene = compared_beam(0);
  scene.stops.place = StopsSpec::Place::nodes;
  for (const char* mass : {"consistent", "lumped"}) {
    Marcher beam = marcher(scene, 10, {{mass}, {"signorini"}, {"laursen-chawla"}}, 1e-4);
    const EnergyAudit audit = audited(beam, 0.3);
    INFO(mass);
    CHECK(audit.energy(0).scheme == Approx(audit.totals(0).scheme_start).epsilon(1e-11));
  }
}

TEST_CASE("contact at all nodes gives energy to schemes that throw a mass back faster than it came") {
  struct Row {
    Choice time;
    double least;  // of the energy at the start
  };
  // Medians measured at h = 2e-4, 1e-4, 5e-5. Newmark: .46 .26 .52. HHT-α: .05 .076 .058. WBZ-α: .048 .072 .054.
  // Bathe 0.8: .12 .13 .17. Midpoint, middle: .36 .72 .52. Generalised-α, weighted: .074 .14 .17.
  const std::vector<Row> rows = {{scheme("newmark"), 0.1},
                                 {scheme("hht-alpha"), 0.02},
                                 {scheme("wbz-alpha"), 0.02},
                                 {scheme("bathe", {{"rho_inf", 0.8}}), 0.04},
                                 {worded("midpoint", "constraint", "middle"), 0.1},
                                 {worded("generalised-alpha", "contact", "weighted"), 0.03}};
  for (const Row& row : rows) {
    INFO(label(row.time));
    CHECK_FALSE(plan_made(row.time, 1e-4).facts.contact_never_gains);
    CHECK(usual_gain(row.time, 1e-4) > row.least);
  }
  // Chung–Hulbert with the effort whole gains a hundred times less than with it weighted, and says that it does gain.
  CHECK_FALSE(plan_made(scheme("generalised-alpha"), 1e-4).facts.contact_never_gains);
  const double whole = usual_gain(scheme("generalised-alpha"), 1e-4);
  CHECK(whole > 2e-4);
  CHECK(whole < 1e-2);
}
