// Schemes whose velocities jump beside a smooth acceleration: nonsmooth generalised α, and Kane's for any β and γ.
#include <ricochet/measure/stability/plan_restitution.hpp>

#include "tests/marching.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace jumping_schemes_tests {
namespace {

Choice alpha(double rho, const std::string& position = "half", double e = 0) {
  return {"nonsmooth-generalised-alpha", {{"rho_inf", rho}, {"restitution", e}, {"position", position}}};
}
Choice kane(double beta, double gamma, const std::string& impulse = "energy") {
  return {"kane", {{"beta", beta}, {"gamma", gamma}, {"impulse", impulse}}};
}

// A bar of 10 m (EA = 900 N, ρA = 1 kg/m: waves of 30 m/s) thrown with 10 m/s at a wall that it meets at 0.5 s.
SceneSpec thrown_bar() {
  SceneSpec scene;
  scene.structure = BarSpec{.length = 10, .EA = 900, .rhoA = 1, .fixed = BarSpec::Fixed::none, .damping = {}};
  scene.stops.lower = Formula(0.0);
  scene.stops.place = StopsSpec::Place::tip;
  scene.initial.displacement = Formula(5.0);
  scene.initial.velocity = Formula(-10.0);
  return scene;
}

struct Thrown {
  double gain = 0, common_gain = 0, end = 0, impulse = 0, force = 0;  // gains and end over the first energy
};

// Largest gain of a step, of the scheme's own energy and of ½|v|²_M + ½|q|²_K; mean force over the contact.
Thrown thrown(const Choice& time, double h = 0.005) {
  Marcher bar = marcher(thrown_bar(), 20, {{"consistent"}, {"signorini"}, time}, h);
  EnergyAudit audit(bar);
  bar.start(&audit);
  Thrown found;
  double before = 0, first = 0;
  int steps = 0;
  while (bar.time() < 1.5) {
    bar.march(1, &audit);
    const double now = audit.energy(0).common();
    if (first == 0) first = before = now;
    found.common_gain = std::max(found.common_gain, (now - before) / first);
    before = now;
    if (bar.time() < 0.55 || bar.time() > 1.1) continue;
    found.force += audit.contact(0).force;
    ++steps;
  }
  found.gain = audit.totals(0).largest_step_gain / audit.totals(0).scheme_start;
  found.end = before / first;
  found.impulse = audit.contact(0).impulse;
  found.force /= steps;
  return found;
}

SceneSpec beam_between_stops() {
  SceneSpec scene = working_set();
  scene.stops.place = StopsSpec::Place::nodes;
  return scene;
}

}  // namespace

TEST_CASE("probe of jumping schemes", "[.probe]") {
  for (const char* position : {"half", "beta", "projected"})
    for (const double rho : {1.0, 0.8, 0.5, 0.2, 0.0})
      for (const double e : {0.0, 0.8}) {
        const Thrown bar = thrown(alpha(rho, position, e));
        WARN(position << " rho " << rho << " e " << e << ": gain " << bar.gain << " common " << bar.common_gain
                      << " end " << bar.end << " impulse " << bar.impulse << " force " << bar.force);
      }
  for (const char* impulse : {"energy", "mass"})
    for (const auto& [beta, gamma] : {std::pair(0.25, 0.5), {0.3, 0.5}, {0.5, 0.5}, {1.0 / 6, 0.5}, {0.0, 0.5},
                                      {0.4, 0.6}, {0.25, 0.6}}) {
      const Thrown bar = thrown(kane(beta, gamma, impulse));
      WARN(impulse << " " << beta << " " << gamma << ": gain " << bar.gain << " common " << bar.common_gain << " end "
                   << bar.end << " impulse " << bar.impulse << " force " << bar.force);
    }
  for (const char* position : {"half", "beta", "projected"})
    for (const double rho : {1.0, 0.8, 0.5, 0.2, 0.0}) {
      Marcher beam = marcher(beam_between_stops(), 10, {{"consistent"}, {"signorini"}, alpha(rho, position)}, 1e-4);
      EnergyAudit audit(beam);
      beam.start(&audit);
      double common = 0, before = 0, first = 0;
      while (beam.time() < 0.3) {
        beam.march(1, &audit);
        const double now = audit.energy(0).common();
        if (first == 0) first = before = now;
        common = std::max(common, (now - before) / first);
        before = now;
      }
      WARN("beam " << position << " rho " << rho << ": gain "
                   << audit.totals(0).largest_step_gain / audit.totals(0).scheme_start << " common " << common
                   << " residual " << audit.totals(0).balance_residual() / first);
    }
}
}  // namespace jumping_schemes_tests
