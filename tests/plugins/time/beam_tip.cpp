// The tip of a beam between two stops against the motion of the same mesh, exact in time.
#include "tests/plugins/time/family.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

// u(L, 0.4 s), 10 elements, α = 10⁻⁴ s: modes between events (reference event-driven-semi-discrete), known to 10⁻¹².
constexpr double consistent_tip = 0.060759888616, lumped_tip = 0.074729192586;

double marched_tip(const Choice& mass, const Choice& time, double h, int elements = 10) {
  Marcher beam = marcher(compared_beam(1e-4), elements, {mass, {"signorini"}, time}, h);
  run(beam, 0.4);
  INFO(label(time) << " h = " << h);
  REQUIRE(beam.status(0).running);
  return beam.tip(0);
}

}  // namespace

TEST_CASE("errors of the tip after five impacts, schemes whose contact does not chatter") {
  struct Row {
    Choice time;
    double coarse, fine;  // at h = 4e-5 and 2e-5 s, m
  };
  const std::vector<Row> rows = {{scheme("generalised-alpha"), 2.23e-5, 6.8e-6},
                                 {scheme("generalised-alpha", {{"rho_inf", 0.0}}), 4.72e-5, 1.27e-5},
                                 {scheme("hht-alpha", {{"alpha", -0.3}}), 3.21e-5, 1.58e-5},
                                 {scheme("bathe"), 2.38e-5, 1.41e-5},
                                 {scheme("sdirk"), 3.60e-5, 1.24e-6},
                                 {scheme("sdirk", {{"order", 3LL}}), 8.9e-6, 3.1e-6},
                                 {scheme("moreau-jean"), 7.82e-5, 4.88e-5},
                                 {scheme("newmark-dumont-paoli"), 4.31e-5, 1.04e-5},
                                 {scheme("laursen-chawla"), -1.328e-4, -5.07e-5},
                                 {worded("contact-stabilised-newmark", "velocity", "corrected"), -3.33e-5, -2.00e-5}};
  for (const Row& row : rows) {
    INFO(label(row.time));
    // Printed digits, and 1 nm of initial displacement (10⁻⁹ of it) moves them by less than that.
    const double digits = 0.02;
    CHECK(marched_tip({"consistent"}, row.time, 4e-5) - consistent_tip ==
          Approx(row.coarse).epsilon(digits).margin(2e-7));
    CHECK(marched_tip({"consistent"}, row.time, 2e-5) - consistent_tip ==
          Approx(row.fine).epsilon(digits).margin(2e-7));
  }
}

TEST_CASE("errors of the tip after five impacts, schemes whose contact chatters") {
  // Round-off decides: a relative 10⁻⁹ of the initial displacement moves the error of kane between 5e-6 and 2.1e-5,
  // that of newmark between 2e-4 and 9e-4. What holds is a size, and that it falls with the step.
  struct Row {
    Choice time;
    double coarse, fine;
  };
  const std::vector<Row> rows = {{scheme("kane"), 4e-5, 5e-6},
                                 {scheme("midpoint"), 4e-5, 5e-6},
                                 {scheme("generalised-alpha", {{"rho_inf", 1.0}}), 4e-5, 5e-6},
                                 {scheme("hht-alpha"), 2e-4, 1.5e-4},
                                 {scheme("wbz-alpha"), 5e-4, 2e-4}};
  for (const Row& row : rows) {
    INFO(label(row.time));
    CHECK(std::abs(marched_tip({"consistent"}, row.time, 4e-5) - consistent_tip) < row.coarse);
    CHECK(std::abs(marched_tip({"consistent"}, row.time, 2e-5) - consistent_tip) < row.fine);
  }
}

TEST_CASE("the contact-stabilised original does not tend to the motion of the mesh, corrected it does") {
  const Choice original = scheme("contact-stabilised-newmark");
  // The velocity of arrival that a resting node keeps: as far off at every step.
  for (const double h : {8e-5, 4e-5, 2e-5}) {
    INFO("h = " << h);
    CHECK(marched_tip({"consistent"}, original, h) - consistent_tip == Approx(1.37e-2).epsilon(0.01));
  }
  // It is O(ℓ): u(L, 0.4 s) as h → 0 by number of elements, where all meshes are within 5e-4 of 0.0608.
  const std::vector<std::pair<int, double>> meshes = {{5, 0.0888}, {10, 0.0744}, {20, 0.0675}};
  for (const auto& [elements, tip] : meshes) {
    INFO(elements << " elements");
    CHECK(marched_tip({"consistent"}, original, 4e-5, elements) == Approx(tip).margin(1.5e-4));
    const Choice corrected = worded("contact-stabilised-newmark", "velocity", "corrected");
    CHECK(marched_tip({"consistent"}, corrected, 4e-5, elements) == Approx(0.0608).margin(6e-4));
  }
}

TEST_CASE("errors of the tip on the lumped mass: explicit schemes, and what a restitution changes") {
  const double h = 1.6e-5;
  // Contact at e = 0 is clean; C enters cd-lagrange half a step late, at first order.
  CHECK(std::abs(marched_tip({"lumped"}, scheme("carpenter-taylor-katona"), h) - lumped_tip) < 8e-7);
  CHECK(std::abs(marched_tip({"lumped"}, scheme("carpenter-taylor-katona"), h / 2) - lumped_tip) < 2.5e-7);
  CHECK(std::abs(marched_tip({"lumped"}, scheme("noh-bathe"), h) - lumped_tip) < 1e-6);
  CHECK(std::abs(marched_tip({"lumped"}, scheme("cd-lagrange"), h) - lumped_tip) < 1e-5);
  // The lumped tip has mass, so that a restitution is another motion.
  for (const char* name : {"cd-lagrange", "paoli-schatzman", "newmark-dumont-paoli", "moreau-jean"}) {
    INFO(name);
    const double bouncing = marched_tip({"lumped"}, scheme(name, {{"restitution", 0.8}}), h) - lumped_tip;
    CHECK(bouncing > 1e-3);
    CHECK(bouncing < 3e-3);
  }
}
