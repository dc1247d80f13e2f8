// A structure that is described by its modes: what is read of the tables, and what is refused.
#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>
#include <numbers>
#include <ricochet/measure/stability/structure_physics.hpp>
#include <ricochet/scene/structure/assembled_structure.hpp>

#include "tests/scene/structure/beam_files.hpp"
#include "tests/scene/working_set.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

const char* const two_modes = "mode,frequency,mass,damping\n1,5,2,0.01\n2,3,1,0.02\n";
const char* const two_shapes = "point,1,2\na,1,0.5\nb,-1,2\nground,0.3,0.7\n";

struct Tables {
  std::string modes = two_modes, shapes = two_shapes, residual = "", residual_mass = "", static_modes = "";
};

AssembledStructure read(const Tables& tables, std::vector<double>* ratios = nullptr) {
  const auto optional = [](const std::string& text, const char* name) {
    return text.empty() ? std::nullopt : std::optional(read_csv(text, name));
  };
  std::vector<double> found;
  AssembledStructure out =
      modal_structure({read_csv(tables.modes, "modes.csv"), read_csv(tables.shapes, "shapes.csv"),
                       optional(tables.residual, "residual.csv"), optional(tables.residual_mass, "residual_mass.csv"),
                       optional(tables.static_modes, "static.csv")},
                      found);
  if (ratios) *ratios = found;
  return out;
}

Place at_point(const char* name) {
  Place place;
  place.point = name;
  return place;
}

}  // namespace

TEST_CASE("a description in modes is read slowest mode first, with its points") {
  std::vector<double> ratios;
  const AssembledStructure structure = read({}, &ratios);
  const double slow = 2 * std::numbers::pi * 3, fast = 2 * std::numbers::pi * 5;
  CHECK(structure.dofs() == 2);
  CHECK(structure.definite);
  CHECK(ratios == std::vector<double>{0.02, 0.01});
  CHECK(structure.stiffness.coeff(0, 0) == Approx(slow * slow).epsilon(1e-14));
  CHECK(structure.stiffness.coeff(1, 1) == Approx(2 * fast * fast).epsilon(1e-14));
  CHECK(structure.mass.coeff(1, 1) == 2);
  const PlaceRow a = structure.row(at_point("a"), "/at");
  CHECK(a.free == std::vector<std::pair<int, double>>{{0, 0.5}, {1, 1.0}});
  CHECK(a.held.empty());
}

TEST_CASE("a residual adds its flexibility at its points and nothing at the others") {
  Tables tables;
  tables.residual = "point,b,a\na,1e-7,4e-7\nb,3e-7,1e-7\n";
  const AssembledStructure structure = read(tables);
  REQUIRE(structure.dofs() == 4);
  CHECK(structure.mass.coeff(2, 2) == 0);
  CHECK_FALSE(structure.modes->attached_mass);
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(2, 4);
  for (const int i : {0, 1})
    for (const auto& [dof, value] : structure.row(at_point(i == 0 ? "a" : "b"), "/at").free) rows(i, dof) = value;
  const Eigen::MatrixXd inverse = Eigen::MatrixXd(structure.stiffness).inverse();
  const Eigen::MatrixXd flexibility =
      rows.rightCols(2) * inverse.bottomRightCorner(2, 2) * rows.rightCols(2).transpose();
  CHECK(flexibility(0, 0) == Approx(4e-7).epsilon(1e-12));
  CHECK(flexibility(0, 1) == Approx(1e-7).epsilon(1e-12));
  CHECK(flexibility(1, 1) == Approx(3e-7).epsilon(1e-12));
  tables.residual_mass = "point,a,b\na,0.4,0.1\nb,0.1,0.3\n";
  const AssembledStructure heavy = read(tables);
  CHECK(heavy.modes->attached_mass);
  const Eigen::MatrixXd V = rows.rightCols(2);
  const Eigen::MatrixXd mass = V * Eigen::MatrixXd(heavy.mass).bottomRightCorner(2, 2) * V.transpose();
  CHECK(mass(0, 0) == Approx(0.4).epsilon(1e-12));
  CHECK(mass(0, 1) == Approx(0.1).epsilon(1e-12));
}

TEST_CASE("supports of a description push its modes and move its points") {
  Tables tables;
  tables.static_modes = "point,ground\na,1\nb,0.8\n";
  const AssembledStructure structure = read(tables);
  CHECK(structure.supports == std::vector<std::string>{"ground"});
  CHECK(structure.support_loads(0, 0) == 0.7);
  CHECK(structure.support_loads(1, 0) == 0.3);
  // Modes and the rest of a point carry its static mode together.
  for (const auto& [point, share] : {std::pair("a", 1.0), {"b", 0.8}}) {
    const PlaceRow row = structure.row(at_point(point), "/at");
    double sum = row.held.at(0).second;
    for (const auto& [dof, value] : row.free) sum += value * structure.static_modes(dof, 0);
    CHECK(sum == Approx(share).epsilon(1e-15));
  }
  CHECK_THROWS_WITH(structure.row(at_point("ground"), "/at"), Catch::Contains("no point \"ground\""));
}

TEST_CASE("all modes of a structure at rest are those of the structure at rest, however its support moves") {
  // Two masses of 1 kg, m₂–m₁–base by springs of 1 N/m: φ = (1, g), (g, −1) over √(1 + g²), g the golden ratio.
  const double g = 0.5 * (1 + std::sqrt(5.0)), size = std::sqrt(1 + g * g), turn = 2 * std::numbers::pi;
  Tables tables;
  tables.modes = fmt::format("mode,frequency,mass,damping\n1,{},1,0\n2,{},1,0\n", 1 / g / turn, g / turn);
  tables.shapes = fmt::format("point,1,2\none,{},{}\ntwo,{},{}\nbase,{},{}\n", 1 / size, g / size, g / size, -1 / size,
                              (1 + g) / size, (g - 1) / size);
  tables.static_modes = "point,base\none,1\ntwo,1\n";
  SceneSpec scene;
  auto structure = std::make_shared<AssembledStructure>(read(tables));
  scene.structure = AssembledSpec{structure, {}, at_point("one")};
  for (const char* point : {"one", "two"}) {
    const PlaceRow row = structure->row(at_point(point), "/at");
    double carried = 0;
    for (const auto& [dof, value] : row.free) carried += value * structure->static_modes(dof, 0);
    CHECK(carried == Approx(1).epsilon(1e-15));
    for (const auto& [support, rest] : row.held) CHECK(std::abs(rest) < 1e-15);
  }
  // Neither a mesh nor a direction of its dofs is known.
  const auto physics = structure_physics(scene, 1, *testing::mass("consistent"));
  REQUIRE(std::holds_alternative<StructurePhysics>(physics));
  CHECK(std::get<StructurePhysics>(physics).pulsations.front() == Approx(1 / g).epsilon(1e-14));
}

TEST_CASE("what is wrong with a description in modes is told with its file and line") {
  const auto says = [](const Tables& tables, const std::string& text) {
    CHECK_THROWS_WITH(read(tables), Catch::Contains(text));
  };
  says({.shapes = "point,1\na,1\n"}, "shapes.csv has 1 modes, modes.csv 2");
  says({.shapes = "point,1,3\na,1,2\n"}, "shapes.csv has no column 2");
  says({.shapes = "point,1,2\na,1,2\na,2,1\n"}, "shapes.csv, line 3: point a stands a second time");
  says({.modes = "mode,frequency,mass,damping\n1,-3,1,0\n"}, "modes.csv, line 2: frequency -3 Hz");
  says({.modes = "mode,frequency,mass,damping\n1,3,0,0\n"}, "modes.csv, line 2: mass 0 kg");
  says({.modes = "mode,frequency,mass,damping\n1,3,1,1\n"}, "modes.csv, line 2: damping ratio 1");
  says({.modes = "mode,frequency,mass,damping\n1,3,1,0\n1,4,1,0\n"}, "line 3: mode 1 stands a second time");
  says({.modes = "mode,frequency,mass,damping\n5,3,1,0\n"}, "mode \"5\" of a table of 1; expected 1 to 1");
  says({.modes = "mode,frequency,mass,damping\n"}, "modes.csv has no mode");
  says({.residual = "point,a,b\na,1e-7,2e-8\nb,1e-8,1e-7\n"}, "residual.csv is not symmetric");
  says({.residual = "point,a,b\na,1e-7,2e-7\nb,2e-7,1e-7\n"},
       "residual.csv is not positive semidefinite: eigenvalue -1e-07 m/N");
  says({.residual = "point,a,c\na,1e-7,0\nc,0,1e-7\n"}, "residual.csv: no point \"c\" in the shapes");
  says({.residual = "point,a,b\na,1e-7,0\n"}, "1 rows and 2 columns");
  says({.residual = "point\n"}, "residual.csv has no point");
  says({.modes = "mode,frequency,mass,damping\n1,1e200,1,0\n"}, "modes.csv, line 2: frequency 1e+200 Hz");
  says({.residual_mass = "point,a\na,1\n"}, "weighs a residual that is not given");
  says({.static_modes = "point,floor\na,1\n"}, "shapes.csv: no row of the support \"floor\"");
  const AssembledStructure structure = read({});
  Place node;
  node.node = "a";
  CHECK_THROWS_WITH(structure.row(node, "/at"), Catch::Contains("points of shapes alone"));
  CHECK(read({.modes = "mode,frequency,mass,damping\n1,5,2,-0.01\n2,0,1,0\n"}).notes.size() == 1);
}
