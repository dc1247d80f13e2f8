// Structures whose motion other programs have published: two masses that meet between supports that move apart, three
// beams in a row.
#include <numbers>
#include <ricochet/scene/history/time_history.hpp>

#include "tests/marching.hpp"
#include "tests/scene/structure/beam_files.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

const std::string matrix_head = "%%MatrixMarket matrix coordinate real symmetric\n";

/// φ'' = amplitude sin(20πt), φ(0) = 0, φ'(0) = −amplitude/(20π): φ = −φ''/(20π)².
std::shared_ptr<const PiecewiseCubic> shaken(double amplitude, double duration) {
  const double omega = 20 * std::numbers::pi, every = 1e-5;
  TimeTable table;
  table.name = "a";
  for (int k = 0; k <= std::lround(duration / every) + 1; ++k) {
    table.times.push_back(k * every);
    table.values.push_back(amplitude * std::sin(omega * table.times.back()));
  }
  return std::make_shared<const PiecewiseCubic>(PiecewiseCubic::integrate_twice(table, 0, -amplitude / omega));
}

/// Absolute displacements of the free dofs at some instants.
std::vector<Eigen::VectorXd> positions(const SceneSpec& scene, const Methods& methods, double h,
                                       const std::vector<double>& times) {
  Marcher made = marcher(scene, 1, methods, h);
  made.start();
  std::vector<Eigen::VectorXd> out;
  for (const double t : times) {
    made.march(std::llround(t / h) - made.step());
    out.push_back(made.program().problem->contact * made.position(0));
  }
  REQUIRE(made.status(0).running);
  return out;
}

}  // namespace

TEST_CASE("two masses on supports that move apart meet as in code_aster (SDND102)") {
  const std::string springs = "4 4 6\n1 1 98696\n2 1 -98696\n2 2 98696\n3 3 98696\n4 3 -98696\n4 4 98696\n";
  const BeamFiles pair{matrix_head + springs, matrix_head + "4 4 2\n2 2 25\n4 4 25\n",
                       "dof,node,component,x,y,z,held\n1,S1,ux,0,0,0,left\n2,A,ux,0,0,0,\n3,S2,ux,0,0,0,right\n"
                       "4,B,ux,0,0,0,\n"};
  const BeamFiles single{matrix_head + "2 2 3\n1 1 98696\n2 1 -98696\n2 2 98696\n", matrix_head + "2 2 1\n2 2 25\n",
                         "dof,node,component,x,y,z,held\n1,S1,ux,0,0,0,left\n2,A,ux,0,0,0,\n"};
  const Damping damping{.beyond = 0.07};
  SceneSpec two = assembled_scene(assembled(pair), damping), one = assembled_scene(assembled(single), damping);
  two.motions = {{{"left"}, shaken(1, 0.5)}, {{"right"}, shaken(-1, 0.5)}};
  one.motions = {{{"left"}, shaken(1, 0.5)}};
  two.stops.named = {{"gap", at_node("A", "ux"), at_node("B", "ux"), {}, 1e-3},
                     {"seen", at_node("A", "ux"), {}, -1, {}}};
  one.stops.named = {{"wall", at_node("A", "ux"), {}, {}, 5e-4}};
  for (SceneSpec* scene : {&two, &one}) scene->from_supports = true;
  const std::vector<double> times = {0.05, 0.25, 0.4}, here = {-3.5801e-4, -1.8873e-4, -1.8985e-4},
                            printed = {-3.58082e-4, -1.8876e-4, -1.89772e-4};
  const auto with = [](double stiffness) {
    return Methods{{"consistent"}, {"penalty", {{"stiffness", stiffness}}}, {"central-difference"}};
  };
  const auto both = positions(two, with(2.88e7), 1e-5, times), alone = positions(one, with(5.76e7), 1e-5, times);
  for (std::size_t k = 0; k < times.size(); ++k) {
    INFO("t = " << times[k] << " s");
    const double moved = shaken(1, 0.5)->value(times[k]);
    CHECK(std::abs(both[k][1] + moved - printed[k]) < 3e-6);
    CHECK(std::abs(both[k][1] + moved - here[k]) < 1e-6);  // of an independent program, of order 2 at the same step
    CHECK(std::abs(both[k][1] - alone[k][0]) < 1e-12);
  }
}

TEST_CASE("three beams that push each other through gaps move as in code_aster (SDNL105)") {
  BeamSpec beam;
  beam.length = 1;
  beam.young = 1e10;
  beam.density = 1e8;
  beam.section = {.type = Section::Type::tube, .outer_diameter = 0.2, .wall = 0.01};
  const FiniteElementSpace space = free_space(beam, 10);
  const double EI = section_properties(beam.section, beam.young, beam.density).EI;
  const SparseMatrix K = bending_stiffness(space, EI), M = consistent_mass(space);
  const auto thrice = [](const SparseMatrix& block) {
    std::vector<Eigen::Triplet<double>> entries;
    const auto n = static_cast<int>(block.rows());
    for (int body = 0; body < 3; ++body)
      for (int j = 0; j < block.outerSize(); ++j)
        for (SparseMatrix::InnerIterator it(block, j); it; ++it)
          entries.emplace_back(body * n + static_cast<int>(it.row()), body * n + j, it.value());
    SparseMatrix out(3 * n, 3 * n);
    out.setFromTriplets(entries.begin(), entries.end());
    return matrix_market(out);
  };
  BeamFiles files{thrice(K), thrice(M), "dof,node,component,x,y,z,held\n"};
  for (int body = 0; body < 3; ++body)
    for (int dof = 0; dof < 22; ++dof)
      files.dofs += fmt::format("{},{}{},{},0,0,0,{}\n", 22 * body + dof + 1, "ABC"[body], dof / 2,
                                dof % 2 == 0 ? "uy" : "rz", dof < 2 || dof >= 20 ? "fixed" : "");
  SceneSpec scene = assembled_scene(assembled(files));
  scene.basis = BasisSpec{15, false};
  scene.stops.named = {{"first", at_node("A5"), at_node("B5"), {}, 1e-3},
                       {"second", at_node("B5"), at_node("C5"), {}, 1e-3},
                       {"a", at_node("A5"), {}, -1, {}},
                       {"b", at_node("B5"), {}, -1, {}},
                       {"c", at_node("C5"), {}, -1, {}}};
  scene.load.terms = {{true, {}, {}, Formula("1e6", "", "t"), at_node("A5")}};
  const Methods methods{{"consistent"}, {"penalty", {{"stiffness", 1e8}}}, {"central-difference"}};
  const double u[] = {0.0164265, 0.0111628, 0.0058874};
  const Eigen::VectorXd end = positions(scene, methods, 1e-5, {1})[0];
  for (int body = 0; body < 3; ++body) CHECK(std::abs(end[2 + body] - u[body]) < 1e-6);
}

TEST_CASE("a support that is driven away alone leaves a chain as its static mode says (SDLD103)") {
  const std::string head = matrix_head;
  std::string springs = "5 5 9\n", masses = "5 5 3\n";
  for (int i = 1; i <= 5; ++i) springs += fmt::format("{} {} {}\n", i, i, i == 1 || i == 5 ? 1e4 : 2e4);
  for (int i = 2; i <= 5; ++i) springs += fmt::format("{} {} -1e4\n", i, i - 1);
  for (int i = 2; i <= 4; ++i) masses += fmt::format("{} {} 10\n", i, i);
  const BeamFiles files{
      head + springs, head + masses,
      "dof,node,component,x,y,z,held\n1,L,ux,0,0,0,left\n2,A,ux,0,0,0,\n3,B,ux,0,0,0,\n4,C,ux,0,0,0,\n"
      "5,R,ux,0,0,0,right\n"};
  SceneSpec scene = assembled_scene(assembled(files));
  TimeTable table;
  table.name = "a";
  for (int k = 0; k <= 11000; ++k) {
    table.times.push_back(1e-4 * k);
    table.values.push_back(2e5 * std::pow(table.times.back(), 2));
  }
  const auto history = std::make_shared<const PiecewiseCubic>(PiecewiseCubic::integrate_twice(table, 0, 0));
  scene.motions = {{{"left"}, history}};
  scene.from_supports = true;
  scene.stops.named = {{"a", at_node("A", "ux"), {}, -1e9, {}}, {"b", at_node("B", "ux"), {}, -1e9, {}}};
  const auto problem = problem_of(scene, 1, {"consistent"});
  const std::vector<double> shape = {problem->motions.at_points(0, 0), problem->motions.at_points(1, 0)};
  CHECK(shape[0] == Approx(0.75).epsilon(1e-14));
  CHECK(shape[1] == Approx(0.5).epsilon(1e-14));
  const Eigen::VectorXd end = positions(scene, {{"consistent"}, {"none"}, {"newmark"}}, 1e-4, {1})[0];
  CHECK(end[0] == Approx(-174.7902).epsilon(1e-6));
  CHECK(end[1] == Approx(-199.7219).epsilon(1e-6));
  CHECK(end[0] + shape[0] * history->value(1) == Approx(12325.20976).epsilon(1e-6));
}
