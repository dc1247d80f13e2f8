// Supports of matrices that are given: eliminated ones by their influence, and all together by the harmonic motion.
#include <ricochet/scene/files/text_file.hpp>
#include <ricochet/scene/supports.hpp>

#include "tests/marching.hpp"
#include "tests/scene/structure/beam_files.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace given_supports_tests {
namespace {

constexpr int elements = 6;

/// The files of a structure without its held dofs.
BeamFiles without_held(const AssembledStructure& made) {
  BeamFiles files{matrix_market(made.stiffness), matrix_market(made.mass), "dof,node,component,x,y,z,held\n"};
  for (std::size_t i = 0; i < made.names.size(); ++i) {
    const DofName& name = made.names[i];
    files.dofs += fmt::format("{},{},{},{},{},{},\n", i + 1, name.node, name.component, name.place[0], name.place[1],
                              name.place[2]);
  }
  return files;
}

/// The same structure with its supports given by their influence.
AssembledStructure by_influence(const AssembledStructure& made) {
  const BeamFiles files = without_held(made);
  AssembledFiles read;
  read.stiffness_name = "K.mtx";
  read.mass_name = "M.mtx";
  read.table = read_dof_table(files.dofs, "dofs.csv");
  read.stiffness = read_matrix_market(files.stiffness, "K.mtx", made.dofs(), "dofs.csv");
  read.mass = read_matrix_market(files.mass, "M.mtx", made.dofs(), "dofs.csv");
  for (std::size_t j = 0; j < made.supports.size(); ++j) {
    AssembledFiles::Influence& one = read.influences.emplace_back();
    one.support = made.supports[j];
    one.file = made.supports[j] + ".csv";
    for (int i = 0; i < made.dofs(); ++i)
      one.values.emplace_back(i + 1, made.static_modes(i, static_cast<Eigen::Index>(j)));
  }
  return assemble_structure(read);
}

/// Five masses between two supports; `k`: of a spring from the middle one to the ground.
AssembledStructure chain(double k = 0) {
  std::string K = "%%MatrixMarket matrix coordinate real symmetric\n7 7 13\n1 1 1e4\n7 7 1e4\n",
              M = "%%MatrixMarket matrix coordinate real symmetric\n7 7 5\n", dofs = "dof,node,component,x,y,z,held\n";
  for (int i = 1; i <= 7; ++i) {
    if (i > 1) K += fmt::format("{} {} -1e4\n", i, i - 1);
    if (i > 1 && i < 7) {
      K += fmt::format("{} {} {}\n", i, i, i == 4 ? 2e4 + k : 2e4);
      M += fmt::format("{} {} 10\n", i, i);
    }
    dofs += fmt::format("{},N{},ux,{},0,0,{}\n", i, i, i, i == 1 ? "left" : i == 7 ? "right" : "");
  }
  return assembled({K, M, dofs});
}

SceneSpec with_stops(AssembledStructure structure) {
  SceneSpec scene = assembled_scene(std::move(structure), {1e-4, 0});
  scene.stops.named = {{"wall", at_node("N4", "ux"), {}, {}, 0.012},
                       {"between", at_node("N3", "ux"), at_node("N5", "ux"), -0.004, {}}};
  return scene;
}

MotionSpec sine(std::vector<std::string> supports, double amplitude, double pulsation, double phase) {
  return {.supports = std::move(supports),
          .history = std::make_shared<const HarmonicMotion>(amplitude, pulsation, phase)};
}

const Methods methods{{"consistent"}, {"penalty", {{"stiffness", 1e5}}}, {"newmark-dumont-paoli"}};

std::vector<double> tips(const SceneSpec& scene, int mesh = 1) {
  return tip_history(scene, mesh, methods, 1e-3, 1.5);
}

}  // namespace

TEST_CASE("a structure without its held dofs, and their influence, moves as the one that keeps them") {
  const AssembledStructure whole = chain(), less = by_influence(whole);
  CHECK(less.held_dofs == 0);
  CHECK(less.supports == whole.supports);
  CHECK((less.static_modes - whole.static_modes).norm() == 0);
  // No mass couples held dofs and free ones, so that s = M ψ.
  CHECK((less.support_loads - whole.support_loads).norm() == 0);
  SceneSpec a = with_stops(whole), b = with_stops(less);
  a.motions = b.motions = {sine({"left"}, 0.01, 9, 0.4), sine({"right"}, 0.015, 14, 0)};
  const std::vector<double> moved = tips(a);
  CHECK(*std::max_element(moved.begin(), moved.end()) > 0.011);
  CHECK(largest_gap(moved, tips(b)) < 1e-12);
}

TEST_CASE("an influence counts rotations per unit of length, and names no support that is held") {
  const BeamSpec beam = std::get<BeamSpec>(unit_beam().structure);
  AssembledStructure whole = assembled(beam_files(beam, elements, {1, "clamp", {}}));
  AssembledFiles files;
  const BeamFiles text = beam_files(beam, elements, {1e-3, "clamp", {}});
  files.stiffness_name = "K.mtx";
  files.mass_name = "M.mtx";
  files.length_unit = 1e-3;
  files.table = read_dof_table(text.dofs, "dofs.csv");
  files.stiffness = read_matrix_market(text.stiffness, "K.mtx", 2 * elements + 2, "dofs.csv");
  files.mass = read_matrix_market(text.mass, "M.mtx", 2 * elements + 2, "dofs.csv");
  files.influences = {{"hand", "hand.csv", {{3, 0.5}, {4, 2e-3}}}};
  const AssembledStructure made = assemble_structure(files);
  REQUIRE(made.supports == std::vector<std::string>{"clamp", "hand"});
  CHECK(made.static_modes(made.row(at_node("N1"), "").free.front().first, 1) == 0.5);
  CHECK(made.static_modes(made.row(at_node("N1", "rz"), "").free.front().first, 1) == Approx(2).epsilon(1e-15));
  const auto fault = [&](AssembledFiles::Influence influence) -> std::string {
    files.influences = {std::move(influence)};
    try {
      assemble_structure(files);
    } catch (const FileError& error) {
      return error.what();
    }
    return "no error";
  };
  CHECK(fault({"clamp", "clamp.csv", {}}) ==
        "dofs.csv holds dofs by the support clamp, whose static mode is computed; expected no clamp.csv");
  CHECK(fault({"hand", "hand.csv", {{1, 1.0}}}) ==
        "hand.csv: dof 1 (N0 uy) is held, and would follow by 1; expected 0");
}

TEST_CASE("the harmonic support of a beam's files moves them as the beam's, and as a motion of the same displacement") {
  SceneSpec beam = unit_beam();
  beam_of(beam).damping.stiffness = 1e-3;
  Place end;
  end.x = 1;
  beam.stops = {};
  beam.stops.named = {{"end", end, {}, -0.03, 0.02}};
  beam.support = {0.01, 5, 0.3};
  SceneSpec files = assembled_scene(
      assembled(beam_files(beam_of(*std::make_unique<SceneSpec>(unit_beam())), elements, {1, "clamp", {}})), {1e-3, 0});
  files.stops.named = {{"end", at_node("N6"), {}, -0.03, 0.02}};
  SceneSpec moved = files;
  files.support = beam.support;
  moved.motions = {sine({}, 0.01, 5, 0.3)};
  CHECK(discretised(files, 1, *mass("consistent")).motions.empty());
  const std::vector<double> shaken = tips(files);
  CHECK(*std::max_element(shaken.begin(), shaken.end()) > 0.019);
  // Round-off of the static modes, 1e-12 of K's condition; the tip moves by 0.03.
  CHECK(largest_gap(shaken, tips(beam, elements)) < 1e-11);
  CHECK(largest_gap(shaken, tips(moved)) < 1e-11);
}

TEST_CASE("a harmonic support that does not lift all stops alike is a motion of all supports") {
  for (const double ground : {0.0, 3e3}) {
    SceneSpec shaken = with_stops(chain(ground)), moved = shaken;
    shaken.support = {0.01, 9, 0.4};
    moved.motions = {sine({}, 0.01, 9, 0.4)};
    CHECK(support_bends(shaken));
    CHECK(discretised(shaken, 1, *mass("consistent")).motions.histories.size() == 1);
    CHECK(largest_gap(tips(shaken), tips(moved)) == 0);
    shaken.stops.named.resize(1);
    CHECK(support_bends(shaken) == (ground > 0));
  }
}

}  // namespace given_supports_tests
