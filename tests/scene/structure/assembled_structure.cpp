// Structures given by matrices: what elimination, order, units and supports may not change, and what is refused.
#include <random>

#include "tests/scene/structure/beam_files.hpp"
#include "tests/scene/working_set.hpp"

using namespace ricochet;
using namespace ricochet::testing;
using Catch::Matchers::Contains;

namespace {

constexpr int elements = 6;

/// The sentence of files that are no structure.
std::string refusal(const BeamFiles& files, double unit = 1) {
  try {
    assembled(files, unit);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "no error";
}

/// Two dofs, K and M as given by their lower triangles.
BeamFiles two_masses(const std::string& K, const std::string& M, const std::string& held = "") {
  const std::string head = "%%MatrixMarket matrix array real symmetric\n2 2\n";
  return {head + K, head + M, "dof,node,component,x,y,z,held\n1,A,ux,0,0,0,\n2,B,ux,1,0,0," + held + "\n"};
}

std::vector<int> shuffled(int count, unsigned seed) {
  std::vector<int> order(static_cast<std::size_t>(count));
  std::iota(order.begin(), order.end(), 0);
  std::mt19937 random(seed);
  for (std::size_t i = order.size(); i-- > 1;) std::swap(order[i], order[random() % (i + 1)]);
  return order;
}

}  // namespace

TEST_CASE("the files of a beam are the beam: K, M and order are equal to the last bit") {
  const SceneSpec beam = working_set();
  const auto problem = discretised(beam, elements, *mass("consistent"));
  const AssembledStructure made = assembled(beam_files(std::get<BeamSpec>(beam.structure), elements));
  CHECK((made.stiffness - problem.stiffness).norm() == 0);
  CHECK((made.mass - problem.inertia.mass).norm() == 0);
  CHECK(made.definite);
  CHECK(made.held_dofs == 2);
  CHECK(made.half_width == 3);
}

TEST_CASE("a beam whose dofs are shuffled has its frequencies and its flexibility, and a narrow band again") {
  const BeamSpec beam = std::get<BeamSpec>(unit_beam().structure);
  const AssembledStructure given = assembled(beam_files(beam, elements));
  const AssembledStructure other = assembled(beam_files(beam, elements, {1, "fixed", shuffled(2 * elements + 2, 7)}));
  // Levels of two dofs beside each other.
  CHECK(other.half_width <= 4);
  const auto flexibility = [](const AssembledStructure& one) {
    const PlaceRow row = one.row(at_node("N6"), "");
    Eigen::VectorXd load = Eigen::VectorXd::Zero(one.dofs());
    for (const auto& [dof, value] : row.free) load[dof] = value;
    return load.dot(eigen::ldlt_solve(Eigen::MatrixXd(one.stiffness), load));
  };
  // L³/3EI; K has a condition of 1e5.
  CHECK(flexibility(given) == Approx(1.0 / 3).epsilon(1e-11));
  CHECK(flexibility(other) == Approx(1.0 / 3).epsilon(1e-11));
  const auto values = [](const AssembledStructure& one) {
    return Eigen::VectorXd(eigen::modes(Eigen::MatrixXd(one.stiffness), Eigen::MatrixXd(one.mass)).values);
  };
  CHECK((values(given) - values(other)).norm() <= 1e-12 * values(given).norm());
  // (βL)⁴ of a cantilever; six elements are off by 1e-5 or less in the first mode.
  CHECK(values(given)[0] == Approx(12.3623633).epsilon(1e-4));
}

TEST_CASE("files in mm, t and s are the structure in m, kg and s") {
  const BeamSpec beam = std::get<BeamSpec>(working_set().structure);
  const AssembledStructure metres = assembled(beam_files(beam, elements));
  const AssembledStructure millimetres = assembled(beam_files(beam, elements, {1e-3, "fixed", {}}), 1e-3);
  CHECK((metres.stiffness - millimetres.stiffness).norm() <= 1e-14 * metres.stiffness.norm());
  CHECK((metres.mass - millimetres.mass).norm() <= 1e-14 * metres.mass.norm());
  CHECK(millimetres.names.back().place[0] == Approx(beam.length).epsilon(1e-14));
}

TEST_CASE("a support that moves takes a statically determinate structure along: static modes are rigid motions") {
  const BeamSpec beam = std::get<BeamSpec>(working_set().structure);
  const AssembledStructure made = assembled(beam_files(beam, elements, {1, "clamp", {}}));
  REQUIRE(made.supports == std::vector<std::string>{"clamp"});
  for (int i = 0; i < made.dofs(); ++i)
    CHECK(made.static_modes(i, 0) ==
          Approx(made.names[static_cast<std::size_t>(i)].rotation() ? 0.0 : 1.0).margin(1e-9));
  // s = M ψ + M_fs e is ∫ρS φ_i, that of a beam whose clamp moves.
  const Eigen::VectorXd load = rigid_motion_load(make_space(beam, elements));
  CHECK((made.support_loads.col(0) - load).norm() <= 1e-9 * load.norm());
}

TEST_CASE("static modes of supports that move together are the rigid motion, each holds the others at rest") {
  // Three masses in a row on four springs k: ψ of the left end is 3/4, 1/2, 1/4.
  BeamFiles files;
  files.stiffness =
      "%%MatrixMarket matrix coordinate real symmetric\n5 5 9\n1 1 1\n2 1 -1\n2 2 2\n3 2 -1\n3 3 2\n4 3 -1\n4 4 2\n"
      "5 4 -1\n5 5 1\n";
  files.mass = "%%MatrixMarket matrix coordinate real symmetric\n5 5 3\n2 2 10\n3 3 10\n4 4 10\n";
  files.dofs =
      "dof,node,component,x,y,z,held\n1,L,ux,0,0,0,left\n2,A,ux,1,0,0,\n3,B,ux,2,0,0,\n4,C,ux,3,0,0,\n"
      "5,R,ux,4,0,0,right\n";
  const AssembledStructure made = assembled(files);
  REQUIRE(made.supports == std::vector<std::string>{"left", "right"});
  const Eigen::Vector3d left = made.static_modes.col(0), right = made.static_modes.col(1);
  CHECK((left - Eigen::Vector3d(0.75, 0.5, 0.25)).norm() < 1e-15);
  CHECK((left + right - Eigen::Vector3d::Ones()).norm() < 1e-15);
  CHECK((made.support_loads - 10 * made.static_modes).norm() < 1e-14);
  // The displacement of a held dof is its support's.
  const PlaceRow row = difference(made.row(at_node("A", "ux"), ""), made.row(at_node("L", "ux"), ""));
  CHECK(row.free == std::vector<std::pair<int, double>>{{0, 1.0}});
  CHECK(row.held == std::vector<std::pair<int, double>>{{0, -1.0}});
}

TEST_CASE("a structure without supports has rigid motions, and is told from one that is held") {
  const AssembledStructure made = assembled(two_masses("1\n-1\n1\n", "1\n0\n2\n"));
  CHECK_FALSE(made.definite);
  CHECK(assembled(two_masses("1\n-1\n1\n", "1\n0\n2\n", "fixed")).definite);
  CHECK_THAT(refusal(two_masses("1\n-1\n1\n", "1\n-1\n1\n")), Contains("have a motion that neither holds nor moves"));
}

TEST_CASE("rows of places: a direction is normalised, weights are kept, dofs of the file are counted from 1") {
  const AssembledStructure made = assembled(two_masses("2\n-1\n2\n", "1\n0\n1\n"));
  Place place;
  place.node = "A";
  place.direction = {-3, 0, 0};
  CHECK(made.row(place, "").free == std::vector<std::pair<int, double>>{{0, -1.0}});
  place = {};
  place.dofs = {{2, 0.25}, {1, 0.5}, {2, 0.25}};
  CHECK(made.row(place, "").free == std::vector<std::pair<int, double>>{{0, 0.5}, {1, 0.5}});
}

TEST_CASE("a place that is not there is told with the nearest name") {
  const AssembledStructure made = assembled(beam_files(std::get<BeamSpec>(unit_beam().structure), elements));
  const auto fault = [&](const Place& place) { return input_error([&] { made.row(place, "/at"); }); };
  CHECK(fault(at_node("N66")) == "/at/node: \"N66\": no such node; nearest N6");
  CHECK(fault(at_node("N6", "uz")) == "/at/component: node N6 has rz, uy and no uz");
  Place place;
  place.node = "N6";
  place.direction = {0, 1, 1};
  CHECK(fault(place) == "/at/direction: node N6 has rz, uy and no uz");
  place.direction = {0, 0, 0};
  CHECK(fault(place) == "/at/direction: the direction has no length; expected three numbers, not all 0");
  place = {};
  place.dofs = {{99, 1.0}};
  CHECK(fault(place) == "/at/dofs/0/dof: dof 99 of a structure of 14; expected 1 to 14");
  place = {};
  place.x = 0.5;
  CHECK_THAT(fault(place), Contains("x has no meaning for matrices that are given"));
}

TEST_CASE("matrices that are no structure in stable equilibrium are refused with the dof") {
  CHECK(refusal(two_masses("2\n-1\n2\n", "1\n0\n-2\n")) ==
        "M.mtx has a negative pivot -2 at dof 2 (B ux), beyond -1e-12 of the largest: a mass is positive semidefinite");
  CHECK_THAT(
      refusal(two_masses("1\n-2\n1\n", "1\n0\n1\n")),
      Contains("K.mtx has a negative pivot -3 at dof") && Contains("expected a structure in stable equilibrium"));
  CHECK(refusal(two_masses("1\n0\n0\n", "1\n0\n0\n")) ==
        "nothing holds or moves dof 2 (B ux): its rows of K.mtx and M.mtx are zero");
  BeamFiles files = two_masses("2\n-1\n2\n", "1\n0\n1\n");
  files.stiffness = "%%MatrixMarket matrix array real general\n2 2\n2\n-1\n-1.1\n2\n";
  CHECK(refusal(files) ==
        "K.mtx is not symmetric: entries 2, 1 and 1, 2 (B ux, A ux) are -1 and -1.1. They differ by 0.1, 0.05 of the "
        "largest entry; expected at most 1e-10; gyroscopic and circulatory terms are not treated");
  files.stiffness = "%%MatrixMarket matrix array real general\n2 2\n2\n-1\n-1.00000000001\n2\n";
  CHECK_THAT(assembled(files).notes.at(0), Contains("K.mtx is symmetric to 5.0e-12 of its largest entry"));
  CHECK_THAT(refusal(two_masses("1\n-1\n1\n", "1\n0\n1\n"), 1), Contains("no error"));
  files = two_masses("1\n-1\n1\n", "1\n0\n1\n");
  files.dofs = "dof,node,component,x,y,z,held\n1,A,p,0,0,0,\n2,B,p,1,0,0,\n";
  CHECK(
      refusal(files, 0.001) ==
      "dofs.csv: the component p of dof 1 has no known unit; with length_unit 0.001 expected ux, uy, uz, rx, ry or rz");
  files.dofs = "dof,node,component,x,y,z,held\n1,A,p,0,0,0,fixed\n2,B,p,1,0,0,fixed\n";
  CHECK(refusal(files) == "dofs.csv holds all of its 2 dofs; expected one that can move");
  // What no free dof is tied to is not held by a support.
  files = {"%%MatrixMarket matrix coordinate real symmetric\n3 3 3\n1 1 1\n2 1 -1\n2 2 1\n",
           "%%MatrixMarket matrix coordinate real symmetric\n3 3 2\n1 1 1\n2 2 1\n",
           "dof,node,component,x,y,z,held\n1,A,ux,0,0,0,\n2,B,ux,1,0,0,\n3,C,ux,2,0,0,wall\n"};
  CHECK_THAT(refusal(files), Contains("so the support wall has no static mode"));
}
