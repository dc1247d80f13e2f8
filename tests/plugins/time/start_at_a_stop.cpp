// An integration that begins at a rigid stop, or nearer than a step's way to it.
#include "tests/plugins/time/family.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

// Schemes that know a restitution, each start rule of those that have several.
std::vector<Choice> restituting(double e) {
  std::vector<Choice> all;
  for (const char* name : {"moreau-jean", "cd-lagrange", "paoli-schatzman"})
    all.push_back(scheme(name, {{"restitution", e}}));
  for (const char* position : {"half", "projected"})
    all.push_back(scheme("nonsmooth-generalised-alpha", {{"restitution", e}, {"position", std::string(position)}}));
  for (const char* start : {"first-order", "second-order"})
    for (const double beta : {0.0, 0.25, 0.5})
      all.push_back(
          scheme("newmark-dumont-paoli", {{"restitution", e}, {"beta", beta}, {"start", std::string(start)}}));
  return all;
}

struct Marched {
  double position = 0, velocity = 0, lost = 0, residual = 0, highest = 0;
  long long impacts = 0;
  bool balances = false;  // whether the scheme declares what its stops take
};
Marched marched(const SceneSpec& scene, const Choice& time, double h, double duration) {
  Marcher mass = marcher(scene, 1, {{"consistent"}, {"signorini"}, time}, h);
  WatchedMarch watch(mass);
  mass.start(&watch);
  Marched out;
  double last = mass.tip(0);
  for (const long long steps = std::llround(duration / h); mass.step() < steps;) {
    last = mass.tip(0);
    mass.march(1, &watch);
    out.highest = std::max(out.highest, mass.tip(0));
  }
  REQUIRE(mass.status(0).running);
  out.position = mass.tip(0);
  out.velocity = (out.position - last) / h;
  out.lost = watch.audit.lost_at_stops(0);
  out.residual = watch.audit.totals(0).balance_residual();
  out.balances = watch.audit.balances();
  out.impacts = watch.audit.contact(0).impacts;
  return out;
}

SceneSpec with_stop(SceneSpec scene, bool lower) {
  (lower ? scene.stops.lower : scene.stops.upper) = Formula(0.0);
  scene.stops.place = StopsSpec::Place::tip;
  return scene;
}

}  // namespace

TEST_CASE("a free mass that starts within a step's way of its stop rebounds with e v, and the stop takes the rest") {
  const double h = 1e-3;
  for (const double e : {0.0, 0.3, 0.5, 0.8, 1.0})
    for (const Choice& time : restituting(e))
      for (const double steps : {0.0, 0.1, 0.5, 0.9, 1.0, 1.5})
        for (const bool lower : {true, false}) {
          INFO(label(time) << ", " << steps << " steps away, " << (lower ? "lower" : "upper") << " stop");
          const double side = lower ? 1 : -1;
          const Marched of = marched(with_stop(oscillator(0, 0, side * steps * h, -side), lower), time, h, 30 * h);
          // Round-off of positions of some h, over h.
          CHECK(side * of.velocity == Approx(e).margin(1e-10));
          CHECK(of.impacts >= 1);
          if (!of.balances) continue;
          CHECK(of.lost == Approx(0.5 * (1 - e * e)).margin(1e-10));
          CHECK(std::abs(of.residual) < 1e-10);
        }
}

TEST_CASE("what leaves its stop as an integration begins is not pushed, whatever the load") {
  for (const double e : {0.0, 0.5, 1.0})
    for (const Choice& time : restituting(e)) {
      SceneSpec scene = with_stop(oscillator(0, 0, 0, 4.905), true);
      scene.load = Formula(-9.81);
      double last = HUGE_VAL;
      for (const double h : {1e-2, 1e-3, 1e-4}) {
        INFO(label(time) << ", h = " << h);
        const Marched of = marched(scene, time, h, 0.9);
        CHECK(of.impacts == 0);
        // v²/2g; parabolas are exact to the start rule: h v, or h² g.
        const double error = std::abs(of.highest - 1.22625);
        CHECK(error < 5 * h);
        CHECK(error <= std::max(last, 1e-6));
        last = error;
      }
    }
}

TEST_CASE("what is pressed on its stop as an integration begins stays there, the stop carrying the load") {
  for (const double e : {0.0, 0.5, 1.0})
    for (const Choice& time : restituting(e)) {
      INFO(label(time));
      SceneSpec scene = with_stop(oscillator(4, 0, 0, 0), true);
      scene.load = Formula(-3.0);
      const Marched of = marched(scene, time, 1e-3, 0.5);
      // Round-off, or the way h² F/2m of a first step without a force.
      CHECK(std::abs(of.position) < 2e-6);
      CHECK(std::abs(of.velocity) < 5e-3);
      if (of.balances) CHECK(std::abs(of.lost) < 1e-4);
    }
}

TEST_CASE("a cantilever's massive tip rebounds from a start at its stop as from an impact on the way") {
  // The tip moves with the whole beam; the start at the stop tends to the integration that meets it a step later.
  for (const double e : {0.0, 0.5})
    for (const char* start : {"first-order", "second-order"}) {
      const auto tip = [&](double gap, double h) {
        SceneSpec scene = compared_beam(1e-4);
        scene.initial.displacement = Formula(0.0);
        scene.initial.velocity = Formula("-2*x", "/initial/velocity");
        scene.stops.lower = Formula(-gap);
        scene.stops.place = StopsSpec::Place::tip;
        const Choice time = scheme("newmark-dumont-paoli", {{"restitution", e}, {"start", std::string(start)}});
        Marcher beam = marcher(scene, 4, {{"consistent"}, {"signorini"}, time}, h);
        beam.start();
        beam.march(std::llround(0.01 / h) - beam.step());
        return beam.tip(0);
      };
      INFO(start << ", e = " << e);
      double last = HUGE_VAL;
      for (const double h : {4e-5, 1e-5, 2.5e-6}) {
        const double apart = std::abs(tip(0, h) - tip(20 * h * 3.0, h));
        CHECK(apart < 0.5 * last);
        last = apart;
      }
      CHECK(last < 2e-3);
    }
}
