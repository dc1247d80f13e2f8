// Beams in two planes: two beams of one plane each, side by side.
#include <ricochet/scene/assembly.hpp>
#include <ricochet/scene/planes.hpp>

#include "tests/refusals.hpp"
#include "tests/scene/beam_numbers.hpp"

using namespace ricochet;
using namespace ricochet::testing;
using Catch::Matchers::Contains;

namespace {

// Of everything that a beam may have, in two planes that differ.
SceneSpec full_beam() {
  SceneSpec scene = held_beam(2, {pinned("left", 0), pinned("middle", 1.2), elastic("right", 2, 50, 3)});
  BeamSpec& beam = beam_of(scene);
  beam.planes = 2;
  beam.section.EI_z = 3;
  beam.tension = 0.5;
  beam.foundation = 0.2;
  beam.added_mass = 0.1;
  beam.masses = {{.x = 0.5, .mass = 0.3, .inertia = 0.01}};
  beam.supports->at(1).in_plane = {true, false};
  return scene;
}

// A support that holds nothing there is none of a beam by itself: a mass of 0 keeps its node.
SceneSpec plane_of(const SceneSpec& scene, int plane) {
  SceneSpec one = scene;
  BeamSpec beam = in_plane(std::get<BeamSpec>(scene.structure), plane);
  for (const BeamSupport& support : *beam.supports) beam.masses.push_back({.x = support.x, .mass = 0});
  std::erase_if(*beam.supports, [](const BeamSupport& support) {
    return support.type == BeamSupport::Type::elastic && support.stiffness == 0;
  });
  one.structure = beam;
  return one;
}

Eigen::MatrixXd block(const SparseMatrix& matrix, const std::vector<int>& rows, const std::vector<int>& columns) {
  return Eigen::MatrixXd(matrix)(rows, columns);
}

}  // namespace

TEST_CASE("matrices of two planes are those of each plane, and nothing couples them") {
  const SceneSpec scene = full_beam();
  for (const char* name : {"consistent", "lumped", "singular", "hybrid-singular", "hrz", "reciprocal", "mixed"}) {
    INFO(name);
    const auto both = discretise(scene, 9, *mass(name));
    const auto y = discretise(plane_of(scene, 0), 9, *mass(name)), z = discretise(plane_of(scene, 1), 9, *mass(name));
    if (const auto* refusal = std::get_if<Refusal>(&y)) {
      CHECK(std::get<Refusal>(both).sentence.text == refusal->sentence.text);
      continue;
    }
    const SemiDiscrete& joint = std::get<SemiDiscrete>(both);
    const std::array<PlaneSpace, 2> planes{plane_space(joint.space, 0), plane_space(joint.space, 1)};
    const std::array<const SemiDiscrete*, 2> alone{&std::get<SemiDiscrete>(y), &std::get<SemiDiscrete>(z)};
    CHECK(joint.dofs() == alone[0]->dofs() + alone[1]->dofs());
    CHECK(joint.inertia.kernel_dimension == alone[0]->inertia.kernel_dimension + alone[1]->inertia.kernel_dimension);
    const SparseMatrix M = dense_mass(joint.inertia).sparseView();
    for (std::size_t p = 0; p < 2; ++p) {
      CHECK(block(joint.stiffness, planes[p].dofs, planes[p].dofs) == Eigen::MatrixXd(alone[p]->stiffness));
      // Factors are the same; a dense solve of both planes together rounds otherwise.
      const Eigen::MatrixXd own = dense_mass(alone[p]->inertia);
      CHECK((block(M, planes[p].dofs, planes[p].dofs) - own).norm() <= 1e-13 * own.norm());
    }
    CHECK(block(joint.stiffness, planes[0].dofs, planes[1].dofs).norm() == 0);
    CHECK(block(M, planes[0].dofs, planes[1].dofs).norm() <= 1e-16 * M.norm());
  }
}

TEST_CASE("dofs of two planes stand node by node: half-bandwidth at most 7") {
  const SceneSpec scene = full_beam();
  const SemiDiscrete made = discretised(scene, 9, *mass("consistent"));
  for (const SparseMatrix* matrix : {&made.stiffness, &made.inertia.mass})
    for (Eigen::Index j = 0; j < matrix->outerSize(); ++j)
      for (SparseMatrix::InnerIterator it(*matrix, j); it; ++it) CHECK(std::abs(it.row() - it.col()) <= 7);
  // A support along uy alone leaves uz free at its node.
  const std::vector<DofPlace> places = dof_places(made.space);
  int y = 0, z = 0;
  for (const DofPlace& place : places)
    if (!place.slope && std::abs(place.x - 1.2) < 1e-9) (place.across ? z : y) += 1;
  CHECK(y == 0);
  CHECK(z == 1);
}

TEST_CASE("a support that moves along one component has the static mode of that plane") {
  const SceneSpec scene = full_beam();
  const SemiDiscrete joint = discretised(scene, 9, *mass("consistent"));
  REQUIRE(joint.static_modes.cols() == 6);
  CHECK(joint.held);
  for (int plane = 0; plane < 2; ++plane) {
    const StaticModes alone = static_modes(in_plane(std::get<BeamSpec>(scene.structure), plane), 9);
    const std::vector<int> dofs = plane_space(joint.space, plane).dofs;
    const std::vector<int> others = plane_space(joint.space, 1 - plane).dofs;
    const Eigen::MatrixXd mine = joint.static_modes.middleCols(3 * plane, 3);
    CHECK(Eigen::MatrixXd(mine(dofs, Eigen::all)) == alone.modes);
    CHECK(Eigen::MatrixXd(mine(others, Eigen::all)).norm() == 0);
    CHECK(Eigen::MatrixXd(joint.support_loads.middleCols(3 * plane, 3)(dofs, Eigen::all)) == alone.loads);
  }
  // What holds uy alone moves nothing along uz.
  CHECK(joint.static_modes.col(4).norm() == 0);
}

TEST_CASE("a rectangle bends along z across its width, a given section with EI_z") {
  SceneSpec scene = held_beam(1, {clamped("wall", 0)});
  BeamSpec& beam = beam_of(scene);
  beam.planes = 2;
  beam.young = 2e11;
  beam.density = 8000;
  beam.section = {.type = Section::Type::rectangle, .width = 0.03, .height = 0.01};
  const auto EI = [&](int plane) { return uniform_parts(in_plane(beam, plane)).front().section.EI; };
  CHECK(EI(1) / EI(0) == Approx(9).epsilon(1e-12));  // I = b h³/12, b and h exchanged
  beam.section = {.type = Section::Type::given, .EI = 2, .rhoS = 1};
  CHECK(EI(1) == 2);
  beam.section.EI_z = 5;
  CHECK(EI(0) == 2);
  CHECK(EI(1) == 5);
}

TEST_CASE("what beams of one plane do not have is refused") {
  const auto refused = [](auto change) -> std::string {
    SceneSpec scene = held_beam(1, {clamped("wall", 0)});
    scene.stops = {};
    change(scene);
    return input_error([&] { check_scene(scene, 4); }, "");
  };
  const auto at = [](const char* component, std::vector<double> direction) {
    Place place;
    place.x = 1;
    place.component = component;
    place.direction = std::move(direction);
    return place;
  };
  const auto stop_at = [](const Place& place) {
    return [place](SceneSpec& scene) {
      scene.stops.named = {{.name = "a", .at = place, .to = {}, .lower = {}, .upper = 1}};
    };
  };
  CHECK(refused([](SceneSpec&) {}).empty());
  CHECK_THAT(refused([](SceneSpec& s) { beam_of(s).planes = 3; }),
             Contains("/scene/structure/planes: 3 planes; expected 1 or 2"));
  CHECK_THAT(refused([](SceneSpec& s) { beam_of(s).section.EI_z = 2; }),
             Contains("/scene/structure/section/EI_z: a beam of one plane bends with EI alone; expected planes 2"));
  CHECK_THAT(refused([](SceneSpec& s) {
               beam_of(s).supports->front().in_plane = {true, false};
             }),
             Contains("/scene/structure/supports/0/components: a beam of one plane"));
  CHECK_THAT(refused([&](SceneSpec& s) {
               beam_of(s).planes = 2;
               s.points = {{.name = "across", .at = at("uz", {})}};
             }),
             Contains("/scene/points/0/at: the first point is the tip, along uy"));
  CHECK_THAT(refused(stop_at(at("uz", {}))), Contains("/scene/stops/0/at/component: a beam of one plane"));
  CHECK_THAT(refused(stop_at(at("uzz", {}))), Contains("no component \"uzz\"") && Contains("did you mean \"uz\"?"));
  CHECK_THAT(refused(stop_at(at("", {0, 1}))), Contains("/scene/stops/0/at/direction: a beam of one plane"));
  CHECK_THAT(refused(stop_at(at("", {0, 0}))), Contains("the direction has no length"));
  CHECK_THAT(refused(stop_at(at("", {0, 1, 0}))), Contains("3 numbers; expected two of a beam"));
  CHECK_THAT(
      refused([](SceneSpec& s) { s.initial.displacement_z = Formula("0.1*x", "/scene/initial/displacement_z", "x"); }),
      Contains("/scene/initial/displacement_z: only a beam of planes 2 moves along uz"));
}
