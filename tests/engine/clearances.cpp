// Places that move within a clearance, a polygon of rows.
#include <numbers>
#include <ricochet/measure/contact/stop_places.hpp>
#include <ricochet/scene/clearances.hpp>
#include <ricochet/scene/named_stops.hpp>
#include <ricochet/scene/structure/assembled_structure.hpp>
#include <ricochet/scene/supports.hpp>

#include "tests/engine/contact_march.hpp"
#include "tests/engine/steady_motion.hpp"
#include "tests/marching.hpp"
#include "tests/scene/structure/beam_files.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

constexpr double radius = 0.01;

NamedStop hole(const Place& at) {
  return {.name = "hole", .at = at, .to = {}, .lower = {}, .upper = {}};
}

/// A free mass of 2 kg in a plane, at the middle of a clearance, with a velocity.
SceneSpec free_mass(int sides, double speed, double angle) {
  BeamFiles files;
  files.stiffness = "%%MatrixMarket matrix coordinate real symmetric\n2 2 0\n";
  files.mass = "%%MatrixMarket matrix coordinate real symmetric\n2 2 2\n1 1 2\n2 2 2\n";
  files.dofs = "dof,node,component,x,y,z,held\n1,N1,uy,0,0,0,\n2,N1,uz,0,0,0,\n";
  SceneSpec scene = assembled_scene(assembled(files));
  Place node;
  node.node = "N1";
  scene.stops.named = clearance_rows(hole(node), {.radius = radius, .sides = sides});
  scene.initial.dofs = {{1, 0, speed * std::cos(angle)}, {2, 0, speed * std::sin(angle)}};
  return scene;
}

struct Marched {
  std::vector<Impact> impacts;
  StopTotals totals;
  double distance = 0;  // at the end
  double wear = 0;      // J
};

Marched marched(const SceneSpec& scene, const Methods& methods, double h, double duration, int elements = 1) {
  const ContactMarch done(scene, elements, methods, h, duration);
  StopTotals totals = done.contacts.totals(0, StopSide::upper);
  if (!done.contacts.list().round(0)) totals.impulse += done.contacts.totals(0, StopSide::lower).impulse;
  return {done.contacts.impacts(), totals, StopPlaces(done.made).displacement(done.made, 0), done.wear};
}

/// A tube that is driven round within two clearances of 2 mm.
SceneSpec driven_tube(int sides) {
  SceneSpec scene = working_set();
  beam_of(scene).planes = 2;
  beam_of(scene).damping.stiffness = 1e-4;
  scene.stops = {};
  scene.initial = {};
  const auto push = [](const char* history, std::vector<double> direction) {
    LoadTerm term{.force = true, .at = 1.2, .shape = Formula(), .history = Formula(history, "/scene/load", "t")};
    term.towards.direction = std::move(direction);
    return term;
  };
  scene.load.terms = {push("20*cos(60*t)", {1, 0}), push("20*sin(60*t)", {0, 1})};
  for (const double x : {0.9, 1.501}) {
    Place place;
    place.x = x;
    NamedStop stop = hole(place);
    stop.name = x < 1 ? "middle" : "end";
    stop.entry = x < 1 ? 0 : 1;
    for (NamedStop& row : clearance_rows(stop, {.radius = 2e-3, .sides = sides})) scene.stops.named.push_back(row);
  }
  return scene;
}

const Methods rebounding{{"consistent"}, {"signorini"}, {"moreau-jean", {{"restitution", 1.0}}}},
    holding{{"consistent"}, {"signorini"}, {"newmark-dumont-paoli"}};

}  // namespace

TEST_CASE("opposite sides of a clearance are one row with two bounds, an odd number has a row for each") {
  Place node;
  node.node = "N1";
  for (const auto& [sides, rows] : {std::pair(16, 8), {3, 3}, {4, 2}, {7, 7}}) {
    const std::vector<NamedStop> made = clearance_rows(hole(node), {.radius = radius, .sides = sides});
    CHECK(static_cast<int>(made.size()) == rows);
    for (const NamedStop& row : made) {
      CHECK(row.upper == radius);
      CHECK(row.lower.has_value() == (sides % 2 == 0));
    }
  }
  const SemiDiscrete problem = discretised(free_mass(16, 0, 0), 1, *mass("consistent"));
  REQUIRE(problem.clearances.size() == 1);
  CHECK(problem.clearances[0].angles.size() == 8);
  // Rows are unit vectors, u₁ the first of them.
  CHECK((Eigen::MatrixXd(problem.contact).rowwise().norm().array() - 1).abs().maxCoeff() <= 1e-15);
  CHECK(problem.contact.coeff(0, 0) == 1);
  CHECK(problem.contact.coeff(0, 1) == 0);
}

TEST_CASE("a free mass goes to and fro between the sides that it meets at a right angle") {
  // 2R/v between impacts, v before and after each.
  const double speed = 1, h = 1e-6;
  for (const int side : {0, 3, 11}) {
    const Marched made = marched(free_mass(16, speed, 2 * std::numbers::pi * side / 16), rebounding, h, 0.095);
    REQUIRE(made.impacts.size() == 5);
    for (std::size_t k = 0; k < made.impacts.size(); ++k) {
      // An impact takes a step, and the way back begins within it.
      CHECK(std::abs(made.impacts[k].time - (0.01 + 0.02 * static_cast<double>(k))) <=
            2 * (static_cast<double>(k) + 1) * h);
      // A difference of positions over h: round-off of the radius over h.
      CHECK(made.impacts[k].speed_in == Approx(speed).epsilon(1e-10));
      CHECK(made.impacts[k].speed_out == Approx(speed).epsilon(1e-10));
      CHECK(made.impacts[k].impulse == Approx(2 * 2 * speed).epsilon(1e-12));
    }
    CHECK(made.totals.impacts == 5);
  }
}

TEST_CASE("chords of a circle: a mass that meets every fourth side at 45° flies along a square") {
  // Chords R√2, each in R√2/v; v/√2 across each side.
  SceneSpec scene = free_mass(16, 1, 3 * std::numbers::pi / 4);
  scene.initial.dofs[0].displacement = radius;
  const double h = 1e-6, chord = radius * std::sqrt(2);
  const Marched made = marched(scene, rebounding, h, 6.5 * chord);
  REQUIRE(made.impacts.size() == 6);
  for (std::size_t k = 0; k < 6; ++k) {
    CHECK(std::abs(made.impacts[k].time - chord * static_cast<double>(k + 1)) <= 4 * static_cast<double>(k + 1) * h);
    CHECK(made.impacts[k].speed_in == Approx(std::sqrt(0.5)).epsilon(1e-10));
    CHECK(made.impacts[k].impulse == Approx(2 * 2 * std::sqrt(0.5)).epsilon(1e-12));
  }
  // Each impact slides by v/√2 while it gives 2 m v/√2.
  CHECK(made.wear == Approx(6 * 2.0).epsilon(1e-9));
}

TEST_CASE("a mass that meets a corner closes two rows, and its force is their resultant") {
  // Both sides turn their part of the velocity round: the mass comes back as it came.
  const double corner = std::numbers::pi / 16;
  const Marched made = marched(free_mass(16, 1, corner), rebounding, 1e-6, 0.015);
  REQUIRE(made.impacts.size() == 1);
  CHECK(made.impacts[0].speed_in == Approx(1).epsilon(1e-9));
  CHECK(made.impacts[0].speed_out == Approx(1).epsilon(1e-9));
  CHECK(made.impacts[0].impulse == Approx(4).epsilon(1e-9));
}

TEST_CASE("a circumscribed polygon is 2.0 %, 0.5 %, 0.12 % too wide at its corners") {
  for (const auto& [sides, percent] : {std::pair(16, 1.96), {32, 0.484}, {64, 0.121}}) {
    SceneSpec scene = free_mass(sides, 0, 0);
    LoadTerm push{.force = true, .at = {}, .shape = Formula(), .history = Formula(1.0)};
    push.place.emplace();
    push.place->node = "N1";
    push.place->direction = {0, std::cos(std::numbers::pi / sides), std::sin(std::numbers::pi / sides)};
    scene.load.terms = {push};
    // It rests in the corner where no impact rebounds.
    const Marched made = marched(scene, holding, 1e-4, 0.5);
    CHECK(made.distance == Approx(radius / std::cos(std::numbers::pi / sides)).epsilon(1e-9));
    CHECK(100 * (made.distance / radius - 1) == Approx(percent).epsilon(5e-3));
    // What pushed it for 0.5 s is all in the corner, but for one step.
    CHECK(made.totals.impulse == Approx(0.5).epsilon(1e-3));
    CHECK(made.totals.impacts >= 1);
  }
}

TEST_CASE("supports that move on at a steady speed, and their clearances with them, change nothing") {
  const SceneSpec still = driven_tube(16);
  SceneSpec moving = still;
  moving.from_supports = true;
  moving.motions.resize(2);
  moving.motions[0].history = std::make_shared<const Steady>(0.3);
  moving.motions[1].history = std::make_shared<const Steady>(-0.7);
  moving.motions[1].component = "uz";
  for (NamedStop& row : moving.stops.named) row.moves_with = all_supports;
  const Marched a = marched(still, holding, 1e-4, 0.1, 6), b = marched(moving, holding, 1e-4, 0.1, 6);
  REQUIRE(a.impacts.size() == b.impacts.size());
  CHECK(a.impacts.size() > 2);
  // Round-off of v t beside the clearance grows over the impacts.
  CHECK(b.totals.impulse == Approx(a.totals.impulse).epsilon(1e-6));
  // Clearances that stay are met where the supports have carried the tube.
  for (NamedStop& row : moving.stops.named) row.moves_with.clear();
  CHECK(std::abs(marched(moving, holding, 1e-4, 0.1, 6).totals.impulse - a.totals.impulse) > 0.01 * a.totals.impulse);
}

TEST_CASE("a harmonic support moves a beam past its clearance along uy, as its motion does") {
  SceneSpec shaken = driven_tube(16);
  shaken.load.terms.clear();
  shaken.support = {.amplitude = 2e-2, .pulsation = 60, .phase = 0};
  CHECK(support_bends(shaken));
  const Marched a = marched(shaken, holding, 1e-4, 0.1, 6);
  CHECK(a.totals.impulse > 0);
  // What moves along uy alone meets what a stop along uy is.
  SceneSpec flat = shaken;
  flat.stops.named = {flat.stops.named.front(), flat.stops.named[8]};
  for (NamedStop& row : flat.stops.named) {
    row.side.reset();
    row.entry = row.name == "end" ? 1 : 0;
  }
  CHECK_FALSE(support_bends(flat));
  const Marched b = marched(flat, holding, 1e-4, 0.1, 6);
  REQUIRE(a.impacts.size() == b.impacts.size());
  CHECK(a.totals.impulse == Approx(b.totals.impulse).epsilon(1e-6));
}

TEST_CASE("a description in modes has clearances at points of two components") {
  SceneSpec scene = free_mass(16, 1, 0.3);
  std::vector<double> ratios;
  std::get<AssembledSpec>(scene.structure).structure = std::make_shared<const AssembledStructure>(
      modal_structure({read_csv("mode,frequency,mass,damping\n1,0,2,0\n2,0,2,0\n", "modes.csv"),
                       read_csv("point,1,2\ntube.uy,1,0\ntube.uz,0,1\n", "shapes.csv"),
                       {},
                       {},
                       {}},
                      ratios));
  Place point;
  point.point = "tube";
  scene.stops.named = clearance_rows(hole(point), {.radius = radius, .sides = 16});
  const Marched modes = marched(scene, rebounding, 1e-5, 0.1),
                files = marched(free_mass(16, 1, 0.3), rebounding, 1e-5, 0.1);
  REQUIRE(modes.impacts.size() == files.impacts.size());
  CHECK(modes.impacts.size() > 3);
  for (std::size_t k = 0; k < modes.impacts.size(); ++k)
    CHECK(modes.impacts[k].impulse == Approx(files.impacts[k].impulse).epsilon(1e-12));
}

TEST_CASE("a beam marches within clearances in its modes, whose residual has rank 2 at each of them") {
  SceneSpec scene = driven_tube(16);
  const Marched mesh = marched(scene, {{"consistent"}, {"signorini"}, {"newmark-dumont-paoli"}}, 1e-4, 0.1, 6);
  scene.basis = BasisSpec{10, true};
  CHECK(discretised(scene, 6, *mass("consistent")).dofs() == 14);
  const Marched modes = marched(scene, {{"consistent"}, {"signorini"}, {"newmark-dumont-paoli"}}, 1e-4, 0.1, 6);
  CHECK(mesh.totals.impulse > 0);
  CHECK(modes.totals.impulse == Approx(mesh.totals.impulse).epsilon(0.1));
}

TEST_CASE("masses and laws march a beam between two clearances, whose rows depend on each other") {
  const SceneSpec scene = driven_tube(64);
  for (const Methods& methods :
       {Methods{{"consistent"}, {"signorini"}, {"newmark-dumont-paoli"}},
        Methods{{"singular"}, {"signorini"}, {"newmark-dumont-paoli"}},
        Methods{{"singular", {{"velocity", std::string("P0")}}}, {"signorini"}, {"newmark-dumont-paoli"}},
        Methods{{"hybrid-singular"}, {"signorini"}, {"newmark-dumont-paoli"}},
        Methods{{"redistributed", {{"form", std::string("projected")}}}, {"signorini"}, {"newmark-dumont-paoli"}},
        Methods{{"consistent"}, {"penalty", {{"stiffness", 1e5}}}, {"newmark-dumont-paoli"}},
        Methods{{"lumped"}, {"hertz", {{"stiffness", 1e7}}}, {"newmark-dumont-paoli"}},
        Methods{{"consistent"}, {"signorini"}, {"moreau-jean"}}}) {
    INFO(methods.mass.name << ", " << methods.contact.name << ", " << methods.time.name);
    Marcher made = marcher(scene, 10, methods, 1e-4);
    const EnergyAudit audit = audited(made, 0.3);
    CHECK(made.status(0).running);
    CHECK(audit.contact(0).impulse > 0.1);
    if (methods.contact.name == "signorini") CHECK(audit.contact(0).residual <= 1e-9);
    if (methods.contact.name == "signorini" && methods.time.name != "moreau-jean")
      CHECK(audit.contact(0).deepest_penetration <= 1e-9);
  }
}

TEST_CASE("a steady whirl is pressed against its circle by what its balance leaves, and slides at ωR") {
  // z = R e^{i(ωt − φ)}: (k − mω²)R + N + i c ω R = F e^{iφ}.
  const double m = 2, k = 1000, c = 6, omega = 30, F = 4, R = 1e-3, pi = std::numbers::pi;
  const double N = -(k - m * omega * omega) * R + std::sqrt(F * F - std::pow(c * omega * R, 2));
  const double phi = std::atan2(c * omega * R, N + (k - m * omega * omega) * R);
  BeamFiles files;
  files.stiffness = "%%MatrixMarket matrix coordinate real symmetric\n2 2 2\n1 1 1000\n2 2 1000\n";
  files.mass = "%%MatrixMarket matrix coordinate real symmetric\n2 2 2\n1 1 2\n2 2 2\n";
  files.dofs = "dof,node,component,x,y,z,held\n1,N1,uy,0,0,0,\n2,N1,uz,0,0,0,\n";
  SceneSpec scene = assembled_scene(assembled(files), {0, c / m});
  Place node;
  node.node = "N1";
  scene.stops.named = clearance_rows(hole(node), {.radius = R, .sides = 128});
  for (const auto& [component, history] : {std::pair("uy", "4*cos(30*t)"), {"uz", "4*sin(30*t)"}}) {
    LoadTerm push{.force = true, .at = {}, .shape = Formula(), .history = Formula(history, "", "t")};
    push.place = at_node("N1", component);
    scene.load.terms.push_back(push);
  }
  scene.initial.dofs = {{1, R * std::cos(phi), omega * R * std::sin(phi)},
                        {2, -R * std::sin(phi), omega * R * std::cos(phi)}};
  const double turns = 4, duration = turns * 2 * pi / omega;
  const Marched made = marched(scene, holding, duration / 16000, duration);
  // Corners are (π/128)²/2 = 3e-4 outside the circle. The force differs by that share of k R and m ω² R, and by what
  // the path along a side asks for.
  CHECK(made.totals.impulse / duration == Approx(N).epsilon(2e-3));
  CHECK(made.wear / duration == Approx(N * omega * R).epsilon(3e-3));
  CHECK(made.totals.impacts <= 1);
}

TEST_CASE("loads that are turned by the angle of a side turn the motion of a round beam") {
  const auto turned = [](int side) {
    SceneSpec scene = driven_tube(12);
    const double angle = 2 * std::numbers::pi * side / 12, cosine = std::cos(angle), sine = std::sin(angle);
    scene.load.terms[0].towards.direction = {cosine, sine};
    scene.load.terms[1].towards.direction = {-sine, cosine};
    Marcher made = marcher(scene, 6, holding, 1e-4);
    made.start();
    made.march(2000);
    REQUIRE(made.status(0).running);
    const Eigen::VectorXd q = made.position(0);
    Place end;
    end.x = 1.501;
    std::array<double, 2> u{0, 0};
    for (const std::size_t axis : {0, 1}) {
      end.component = axis == 0 ? "uy" : "uz";
      for (const auto& [dof, value] : place_row(scene, made.program().problem->space, end, "").free)
        u[axis] += value * q[dof];
    }
    return std::array<double, 2>{cosine * u[0] + sine * u[1], -sine * u[0] + cosine * u[1]};
  };
  const std::array<double, 2> still = turned(0);
  CHECK(std::abs(still[0]) > 1e-4);
  for (const int side : {1, 2, 7})
    for (const std::size_t axis : {0, 1})
      CHECK(std::abs(turned(side)[axis] - still[axis]) <= 1e-9);  // round-off, over impacts
}
