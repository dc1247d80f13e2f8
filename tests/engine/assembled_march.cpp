// Given matrices march as the structure that they are of.

#include "tests/marching.hpp"
#include "tests/scene/structure/beam_files.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

constexpr int elements = 8;

Place at_x(double x) {
  Place place;
  place.x = x;
  return place;
}

SceneSpec shaken_beam() {
  SceneSpec scene = unit_beam();
  beam_of(scene).damping.stiffness = 1e-3;
  scene.stops = {};
  scene.stops.named = {{"end", at_x(1), {}, -0.02, 0.03}, {"between", at_x(0.5), at_x(1), {}, 0.01}};
  scene.load.terms = {{true, 1.0, {}, Formula("0.4*sin(5*t)", "", "t")}};
  return scene;
}

SceneSpec shaken_files(const BeamFileOptions& options) {
  const BeamFiles files = beam_files(beam_of(*std::make_unique<SceneSpec>(unit_beam())), elements, options);
  SceneSpec scene = assembled_scene(assembled(files, options.unit), {1e-3, 0});
  scene.stops.named = {{"end", at_node("N8"), {}, -0.02, 0.03}, {"between", at_node("N4"), at_node("N8"), {}, 0.01}};
  scene.load.terms = {{true, {}, {}, Formula("0.4*sin(5*t)", "", "t"), at_node("N8")}};
  return scene;
}

/// The tip at every step.
std::vector<double> tips(const SceneSpec& scene, int mesh, const Methods& methods, OperatorKind kind) {
  CompileOptions options;
  options.kind = kind;
  return tip_history(scene, mesh, methods, 1e-3, 1.5, options);
}

}  // namespace

TEST_CASE("the files of a beam march as the beam, whatever the order of their dofs, their unit and the operator") {
  const Methods rigid{{"consistent"}, {"signorini"}, {"newmark-dumont-paoli"}},
      spring{{"consistent"}, {"penalty", {{"stiffness", 1e3}}}, {"newmark-dumont-paoli"}};
  std::vector<int> backwards(2 * elements + 2);
  for (std::size_t i = 0; i < backwards.size(); ++i)
    backwards[i] = static_cast<int>((7 * i + 3) % backwards.size());  // 7 and 18 have no common factor
  for (const Methods& methods : {rigid, spring}) {
    const std::vector<double> beam = tips(shaken_beam(), elements, methods, OperatorKind::band);
    CHECK(*std::max_element(beam.begin(), beam.end()) > 0.029);
    // Round-off of K grows over the impacts; the tip moves by 0.03.
    CHECK(largest_gap(beam, tips(shaken_files({}), 1, methods, OperatorKind::band)) < 1e-12);
    CHECK(largest_gap(beam, tips(shaken_files({1, "fixed", backwards}), 1, methods, OperatorKind::band)) < 1e-12);
    CHECK(largest_gap(beam, tips(shaken_files({1e-3, "fixed", {}}), 1, methods, OperatorKind::band)) < 1e-12);
    CHECK(largest_gap(beam, tips(shaken_files({1, "fixed", backwards}), 1, methods, OperatorKind::sparse)) < 1e-12);
    CHECK(largest_gap(beam, tips(shaken_files({}), 1, methods, OperatorKind::modal)) < 1e-9);
  }
}

TEST_CASE("rotations without inertia in the files are those of the beam's own lumped mass") {
  const Choice lumped{"lumped", {{"rotation", std::string("none")}}};
  const Methods own{lumped, {"signorini"}, {"newmark-dumont-paoli"}},
      given{{"consistent"}, {"signorini"}, {"newmark-dumont-paoli"}};
  const BeamSpec beam = beam_of(*std::make_unique<SceneSpec>(unit_beam()));
  BeamFiles files = beam_files(beam, elements);
  files.mass = matrix_market(built(*mass("lumped", lumped.values), free_space(beam, elements)).mass);
  SceneSpec scene = shaken_files({});
  std::get<AssembledSpec>(scene.structure).structure = std::make_shared<const AssembledStructure>(assembled(files));
  CHECK(discretised(scene, 1, *mass("consistent")).inertia.kernel_dimension == elements);
  CHECK(largest_gap(tips(shaken_beam(), elements, own, OperatorKind::band), tips(scene, 1, given, OperatorKind::band)) <
        1e-12);
}

TEST_CASE("files of a beam march as the beam with masses that are made of the matrices alone") {
  const Methods scaled{{"hrz"}, {"signorini"}, {"newmark-dumont-paoli"}},
      moved{{"redistributed", {{"form", std::string("projected")}}}, {"signorini"}, {"newmark-dumont-paoli"}};
  for (const Methods& methods : {scaled, moved})
    CHECK(largest_gap(tips(shaken_beam(), elements, methods, OperatorKind::band),
                      tips(shaken_files({}), 1, methods, OperatorKind::band)) < 1e-11);
}

TEST_CASE("two equal masses that are pushed together are one mass against a wall half the gap away") {
  // 25 kg on springs of 98696 N/m; the stop between them is twice as far and half as stiff as the wall.
  const std::string head = "%%MatrixMarket matrix coordinate real symmetric\n";
  const BeamFiles pair{head + "2 2 2\n1 1 98696\n2 2 98696\n", head + "2 2 2\n1 1 25\n2 2 25\n",
                       "dof,node,component,x,y,z,held\n1,A,ux,0,0,0,\n2,B,ux,1,0,0,\n"};
  const BeamFiles single{head + "1 1 1\n1 1 98696\n", head + "1 1 1\n1 1 25\n",
                         "dof,node,component,x,y,z,held\n1,A,ux,0,0,0,\n"};
  const auto push = [](const char* node, const char* force) {
    return LoadTerm{true, {}, {}, Formula(force, "", "t"), at_node(node, "ux")};
  };
  SceneSpec two = assembled_scene(assembled(pair)), one = assembled_scene(assembled(single));
  two.stops.named = {{"gap", at_node("A", "ux"), at_node("B", "ux"), {}, 1e-3}};
  one.stops.named = {{"wall", at_node("A", "ux"), {}, {}, 5e-4}};
  two.load.terms = {push("A", "25*sin(62.83*t)"), push("B", "-25*sin(62.83*t)")};
  one.load.terms = {push("A", "25*sin(62.83*t)")};
  const auto with = [](double stiffness) {
    return Methods{{"consistent"}, {"penalty", {{"stiffness", stiffness}}}, {"newmark-dumont-paoli"}};
  };
  const auto a = tips(two, 1, with(2.88e7), OperatorKind::band), b = tips(one, 1, with(5.76e7), OperatorKind::band);
  CHECK(*std::max_element(a.begin(), a.end()) > 4.9e-4);
  CHECK(largest_gap(a, b) < 1e-12);
}

TEST_CASE("two masses without springs that meet share the momentum of a constant push") {
  // A is pushed from rest by F and carries B along once the gap g is closed. After the meeting at √(2gm/F) both move
  // with half its velocity, and with F/2m from then on.
  const std::string head = "%%MatrixMarket matrix coordinate real symmetric\n";
  const BeamFiles files{head + "2 2 0\n", head + "2 2 2\n1 1 2\n2 2 2\n",
                        "dof,node,component,x,y,z,held\n1,A,ux,0,0,0,\n2,B,ux,1,0,0,\n"};
  SceneSpec scene = assembled_scene(assembled(files));
  scene.stops.named = {{"gap", at_node("A", "ux"), at_node("B", "ux"), {}, 0.09}};
  scene.load.terms = {{true, {}, {}, Formula(2.0), at_node("A", "ux")}};
  const Methods methods{{"consistent"}, {"signorini"}, {"moreau-jean"}};
  const std::vector<double> tip = tips(scene, 1, methods, OperatorKind::band);
  const double meet = std::sqrt(2 * 0.09), speed = meet / 2, h = 1e-3;
  for (const double t : {0.3, 0.8, 1.2}) {
    const double later = t - meet;
    const double exact = later < 0 ? t * t / 2 : 0.09 + speed * later + later * later / 4;
    // The impact falls on a step: h times the change of velocity.
    CHECK(std::abs(tip[static_cast<std::size_t>(std::llround(t / h)) - 1] - exact) < h * meet);
  }
}

TEST_CASE("a damping matrix of a file that is αK + ηM marches as α and η, in every operator and in a basis") {
  const BeamSpec beam = beam_of(*std::make_unique<SceneSpec>(unit_beam()));
  const BeamFiles files = beam_files(beam, elements);
  SceneSpec numbers = shaken_files({});
  std::get<AssembledSpec>(numbers.structure).damping = {1e-3, 0.3};
  const FiniteElementSpace space = free_space(beam, elements);
  const SparseMatrix C = 1e-3 * bending_stiffness(space, 1) + 0.3 * consistent_mass(space);
  SceneSpec given = numbers;
  AssembledStructure structure = assembled(files, 1, matrix_market(C));
  CHECK(structure.notes.empty());
  given.structure = AssembledSpec{std::make_shared<const AssembledStructure>(std::move(structure)), {}, {}};
  for (const Choice& law : {Choice{"signorini"}, Choice{"penalty", {{"stiffness", 1e3}}}})
    for (const char* scheme : {"newmark-dumont-paoli", "moreau-jean", "generalised-alpha"}) {
      const Methods methods{{"consistent"}, law, {scheme}};
      INFO(law.name << ", " << scheme);
      const std::vector<double> expected = tips(numbers, 1, methods, OperatorKind::band);
      // Round-off of C grows over the impacts.
      CHECK(largest_gap(expected, tips(given, 1, methods, OperatorKind::band)) < 1e-9);
      CHECK(largest_gap(expected, tips(given, 1, methods, OperatorKind::sparse)) < 1e-9);
      SceneSpec whole = given;
      whole.basis = BasisSpec{2 * elements, true};
      CHECK(largest_gap(expected, tips(whole, 1, methods, OperatorKind::automatic)) < 1e-8);
    }
  Marcher made = marcher(given, 1, {{"consistent"}, {"signorini"}, {"newmark-dumont-paoli"}}, 1e-3, {});
  const EnergyAudit audit = audited(made, 1.5);
  CHECK(audit.totals(0).work_of_damping > 0.01 * audit.totals(0).work_of_loads);
  CHECK(std::abs(audit.totals(0).balance_residual()) < 1e-10 * audit.totals(0).work_of_loads);
}
