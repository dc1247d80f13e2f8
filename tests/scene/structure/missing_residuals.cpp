// What a description in modes leaves unsaid of loads, stops and points of a scene.
#include <Eigen/Cholesky>
#include <cmath>
#include <ricochet/scene/bodies.hpp>
#include <ricochet/scene/structure/assembled_structure.hpp>
#include <ricochet/scene/structure/missing_residuals.hpp>

#include "tests/scene/structure/beam_files.hpp"
#include "tests/scene/working_set.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

Place place_of(const char* name) {
  Place place;
  place.point = name;
  return place;
}

LoadTerm force_at(const Place& place) {
  LoadTerm term;
  term.force = true;
  term.place = place;
  term.history = Formula("sin(3*t)", "", "t");
  return term;
}

/// Two modes, points a and b. `residual`: a table of points, or nothing.
AssembledStructure described(const std::string& residual, bool supported = false) {
  std::vector<double> ratios;
  const auto optional = [](const std::string& text, const char* name) {
    return text.empty() ? std::nullopt : std::optional(read_csv(text, name));
  };
  return modal_structure(
      {read_csv("mode,frequency,mass,damping\n1,5,2,0.01\n2,3,1,0.02\n", "modes.csv"),
       read_csv("point,1,2\na,1,0.5\nb,-1,2\nground,0.3,0.7\n", "shapes.csv"), optional(residual, "residual.csv"),
       std::nullopt, optional(supported ? "point,ground\na,1\nb,1\n" : "", "static.csv")},
      ratios);
}

SceneSpec scene_of(AssembledStructure structure) {
  SceneSpec scene = assembled_scene(std::move(structure));
  scene.stops.named = {{"wall", place_of("a"), {}, {}, 0.1}};
  return scene;
}

std::vector<std::string> said(const SceneSpec& scene) {
  return missing_residuals(scene, make_space(scene.structure, 1));
}

const char* const of_a = "point,a\na,1e-7\n";

}  // namespace

TEST_CASE("a load at a point without residual is told, with the share of the fastest mode at the stop") {
  SceneSpec scene = scene_of(described(of_a));
  CHECK(said(scene).empty());
  scene.load.terms = {force_at(place_of("a"))};
  CHECK(said(scene).empty());
  scene.load.terms.push_back(force_at(place_of("b")));
  // Modes of 3 Hz and 5 Hz give Φ_a Φ_b/(m ω²) of 1 and −1/2 over their squares: 9/50 over 1 − 9/50.
  const double share = 100 * (0.5 / 25) / (1.0 / 9 - 0.5 / 25);
  CHECK(share == Approx(21.95).epsilon(1e-3));
  CHECK(said(scene) ==
        std::vector<std::string>{"load 1 is at a point without residual: what it moves the stops by at rest, beyond "
                                 "the modes, is not known. The fastest mode alone gives 22 % of its static "
                                 "displacement at stop wall"});
  scene.structure = scene_of(described("point,a,b\na,1e-7,0\nb,0,1e-7\n")).structure;
  CHECK(said(scene).empty());
}

TEST_CASE("stops and points without residual, and supports that move, are told") {
  SceneSpec scene = scene_of(described("", true));
  scene.points = {{"seen", place_of("b")}};
  CHECK(said(scene) == std::vector<std::string>{"no residual at stop wall: its force moves no stop beyond the modes",
                                                "no residual at point seen: what is shown there follows the modes "
                                                "alone"});
  scene = scene_of(described(of_a, true));
  CHECK(said(scene).empty());
  scene.support = {0.01, 3, 0};
  CHECK(said(scene) == std::vector<std::string>{"supports of a structure in modes move: what their inertia moves the "
                                                "stops by, beyond the modes, is not known"});
}

TEST_CASE("a body in modes is looked at as a structure in modes is, and a beam in modes knows all") {
  auto all = std::make_shared<Bodies>();
  AssembledSpec body;
  body.structure = std::make_shared<const AssembledStructure>(described(of_a));
  all->all = {{"ball", OscillatorSpec{1, 0, 0, {}}}, {"frame", body}};
  SceneSpec scene;
  scene.structure = AssembledSpec{.structure = nullptr, .bodies = all};
  scene = on_mesh(std::move(scene), 1);
  Place ball, a = place_of("a"), b = place_of("b");
  ball.body = "ball";
  a.body = b.body = "frame";
  scene.stops.named = {{"gap", ball, a, {}, 0.1}};
  scene.load.terms = {force_at(b)};
  REQUIRE(said(scene).size() == 1);
  CHECK(said(scene).front().find("load 0 is at a point without residual") == 0);

  SceneSpec beam = unit_beam();
  beam.stops = {};
  Place at;
  at.x = 0.8;
  beam.stops.named = {{"end", at, {}, {}, 0.1}};
  beam.basis = BasisSpec{2, true};
  CHECK(said(beam).empty());
}

TEST_CASE("a force moves a stop at rest in modes as in the structure, wherever it acts") {
  SceneSpec scene = unit_beam();
  scene.stops = {};
  Place stop;
  stop.x = 0.7;
  scene.stops.named = {{"end", stop, {}, {}, 0.1}};
  LoadTerm term;
  term.force = true;
  term.at = 0.45;
  term.history = Formula(1.0);
  scene.load.terms = {term};
  const auto consistent = mass("consistent");
  const auto moved = [&](const SemiDiscrete& problem) {
    Eigen::VectorXd load(problem.dofs());
    problem.load->assemble(0, load.data());
    const Eigen::MatrixXd K = problem.stiffness;
    return (problem.contact * K.ldlt().solve(load).eval())[0];
  };
  const double whole = moved(discretised(scene, 8, *consistent));
  scene.basis = BasisSpec{1, true};
  CHECK(moved(discretised(scene, 8, *consistent)) == Approx(whole).epsilon(1e-10));
  scene.basis = BasisSpec{1, false};
  CHECK(std::abs(moved(discretised(scene, 8, *consistent)) / whole - 1) > 1e-3);
}
