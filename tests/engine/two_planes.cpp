// Motions of beams in two planes, and of places within clearances.
#include <ricochet/measure/contact/stop_places.hpp>

#include "tests/marching.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

LoadTerm force(double x, const char* history, std::vector<double> direction = {}) {
  LoadTerm term{.force = true, .at = x, .shape = Formula(), .history = Formula(history, "/scene/load", "t")};
  term.towards.direction = std::move(direction);
  return term;
}

SceneSpec struck_beam(int planes) {
  SceneSpec scene = working_set();
  beam_of(scene).planes = planes;
  beam_of(scene).damping.stiffness = 1e-4;
  scene.load.terms = {force(1.2, "30*sin(40*t)")};
  return scene;
}

NamedStop stop_at(double x, std::vector<double> direction, double bound) {
  NamedStop stop{.name = "a", .at = {}, .to = {}, .lower = -bound, .upper = bound};
  stop.at.x = x;
  stop.at.direction = std::move(direction);
  return stop;
}

PointSpec point(const char* name, double x, const char* component) {
  PointSpec out{.name = name, .at = {}};
  out.at.x = x;
  out.at.component = component;
  return out;
}

double shown(const Marcher& made, int point) {
  return RowReadings(made, made.program().problem->observed).displacement(made, point);
}

}  // namespace

TEST_CASE("a motion along y is that of the beam in one plane") {
  for (const char* mass_name : {"consistent", "singular", "lumped", "hrz", "hybrid-singular"})
    for (const Choice& time : {Choice{"newmark-dumont-paoli"}, Choice{"moreau-jean", {{"theta", 0.6}}}}) {
      INFO(mass_name << ", " << time.name);
      const Methods methods{.mass = {mass_name}, .contact = {"signorini"}, .time = time};
      const std::vector<double> one = tip_history(struck_beam(1), 12, methods, 1e-4, 0.2),
                                two = tip_history(struck_beam(2), 12, methods, 1e-4, 0.2);
      // Zeros stand between the numbers of a factor: other sums of the same terms at most.
      CHECK(largest_gap(one, two) <= 1e-12 * 0.1);
    }
}

TEST_CASE("a rotated load and rotated stops give the rotated motion") {
  const double y = 0.6, z = 0.8;
  SceneSpec straight = struck_beam(2), turned = struck_beam(2);
  for (SceneSpec* scene : {&straight, &turned}) {
    scene->stops = {};
    scene->initial = {};
  }
  straight.stops.named = {stop_at(1.501, {1, 0}, 0.02)};
  turned.stops.named = {stop_at(1.501, {y, z}, 0.02)};
  turned.load.terms = {force(1.2, "30*sin(40*t)", {y, z})};
  for (SceneSpec* scene : {&straight, &turned}) scene->points = {point("y", 0.9, "uy"), point("z", 0.9, "uz")};
  const Methods methods;
  Marcher a = marcher(straight, 12, methods, 1e-4), b = marcher(turned, 12, methods, 1e-4);
  run(a, 0.3);
  run(b, 0.3);
  const double along = shown(a, 0);
  CHECK(std::abs(along) > 1e-4);
  // Modes of equal frequency may be any of their plane.
  CHECK(std::abs(shown(a, 1)) <= 1e-12 * std::abs(along));
  // The stop has been hit: round-off has grown a little.
  CHECK(std::abs(shown(b, 0) - y * along) <= 1e-9 * std::abs(along));
  CHECK(std::abs(shown(b, 1) - z * along) <= 1e-9 * std::abs(along));
}
