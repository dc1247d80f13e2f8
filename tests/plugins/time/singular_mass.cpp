// Schemes that blow up or chatter at stops are of second order through contact, with a clean force, where the contact
// point has no mass.
#include "tests/plugins/time/family.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

struct SingularSpace {
  std::string velocity;
  double tip;  // u(L, 0.4 s) of 10 elements and projected data, exact in time, to 10⁻¹²
};
const SingularSpace linear_velocities{"P1", 0.060546797991}, constant_velocities{"P0", 0.053866583504};

Marcher projected_beam(const SingularSpace& space, const Choice& time, double h) {
  SceneSpec scene = compared_beam(1e-4);
  scene.initial.projection = InitialSpec::Projection::constraint;
  return marcher(scene, 10, {{"singular", {{"velocity", space.velocity}}}, {"signorini"}, time}, h);
}

double tip_error(const SingularSpace& space, const Choice& time, double h) {
  Marcher beam = projected_beam(space, time, h);
  run(beam, 0.4);
  REQUIRE(beam.status(0).running);
  return std::abs(beam.tip(0) - space.tip);
}

// Total variation of the contact force over its largest value, during the first impact: 2 for one bump.
double roughness(const SingularSpace& space, const Choice& time, double h) {
  Marcher beam = projected_beam(space, time, h);
  WatchedMarch march(beam);
  watch(beam, march, 0.1);
  double variation = 0, largest = 0;
  for (std::size_t k = 1; k < march.forces.size(); ++k) {
    variation += std::abs(march.forces[k] - march.forces[k - 1]);
    largest = std::max(largest, std::abs(march.forces[k]));
  }
  CHECK(march.audit.contact(0).impacts > 0);
  return variation / largest;
}

}  // namespace

TEST_CASE("on a singular mass dissipative schemes are of order two through contact") {
  struct Row {
    Choice time;
    double linear, constant;  // errors at h = 4e-5 s on P1 and P0 velocities, m
  };
  const std::vector<Row> rows = {{scheme("newmark-dumont-paoli"), 3.79e-5, 1.01e-4},
                                 {scheme("generalised-alpha"), 1.21e-5, 2.99e-5},
                                 {scheme("generalised-alpha", {{"rho_inf", 0.0}}), 4.07e-5, 1.21e-4},
                                 {scheme("hht-alpha"), 1.04e-5, 3.94e-5},
                                 {scheme("bathe", {{"split", 0.5}}), 2.98e-6, 1.06e-5},
                                 {scheme("bathe", {{"rho_inf", 0.5}}), 2.07e-6, 7.70e-6},
                                 {scheme("sdirk"), 3.62e-6, 5.5e-6},
                                 {scheme("midpoint"), 1.22e-5, 2.86e-5}};
  for (const Row& row : rows) {
    INFO(label(row.time));
    const double linear = tip_error(linear_velocities, row.time, 4e-5);
    const double constant = tip_error(constant_velocities, row.time, 4e-5);
    // Three digits, of which the scheme's own sawtooth leaves one where it damps least (hht-alpha).
    CHECK(linear == Approx(row.linear).epsilon(0.06));
    CHECK(constant == Approx(row.constant).epsilon(0.06));
    // The step a fourth: a sixteenth of the error, were the impacts at the same phase of a step.
    CHECK(tip_error(linear_velocities, row.time, 1e-5) < linear / 8);
    CHECK(tip_error(constant_velocities, row.time, 1e-5) < constant / 6);
  }
}

TEST_CASE("on a singular mass Bathe's scheme is an order of magnitude ahead of Dumont and Paoli's at equal steps") {
  const double bathe = tip_error(linear_velocities, scheme("bathe", {{"rho_inf", 0.5}}), 4e-5);
  const double paoli = tip_error(linear_velocities, scheme("newmark-dumont-paoli"), 4e-5);
  INFO(paoli << " / " << bathe);
  CHECK(paoli > 10 * bathe);
}

TEST_CASE("on a singular mass the force of an impact is one bump, and Newmark's is a sawtooth that grows") {
  for (const SingularSpace& space : {linear_velocities, constant_velocities})
    for (const Choice& time :
         {scheme("newmark-dumont-paoli"), scheme("newmark-dumont-paoli", {{"beta", 0.25}}), scheme("generalised-alpha"),
          scheme("generalised-alpha", {{"rho_inf", 0.0}}), scheme("bathe", {{"split", 0.5}}),
          scheme("bathe", {{"rho_inf", 0.5}}), scheme("midpoint")})
      for (const double h : {4e-5, 1e-5}) {
        INFO(label(time) << " on " << space.velocity << " h = " << h);
        // One bump is 2; its own ripple is a third of it.
        CHECK(roughness(space, time, h) < 2.8);
      }
  // HHT damps its sawtooth slowly: the bump and a few teeth, fewer as the step shrinks on P1.
  CHECK(roughness(linear_velocities, scheme("hht-alpha"), 1e-5) < 3);
  CHECK(roughness(constant_velocities, scheme("hht-alpha"), 1e-5) < 10);
  CHECK(roughness(linear_velocities, scheme("newmark"), 1e-5) > 10);
  const double coarse = roughness(constant_velocities, scheme("newmark"), 4e-5);
  CHECK(coarse > 25);
  CHECK(roughness(constant_velocities, scheme("newmark"), 1e-5) > 2 * coarse);
}
