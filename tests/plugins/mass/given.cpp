// Masses made of matrices that are given: those of a beam's files are the beam's.
#include "tests/plugins/mass/laws.hpp"
#include "tests/scene/structure/plane_frame.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace given_mass_tests {
namespace {

std::unique_ptr<MassStrategy> projected(int reach) {
  return mass("redistributed", {{"form", std::string("projected")}, {"reach", static_cast<long long>(reach)}});
}

FiniteElementSpace space_of(AssembledStructure structure) {
  AssembledSpec spec;
  spec.structure = std::make_shared<const AssembledStructure>(std::move(structure));
  return make_space(spec, 1);
}

std::string sentence(const MassStrategy& strategy, const FiniteElementSpace& space) {
  const auto made = strategy.build(space);
  return std::holds_alternative<Refusal>(made) ? std::get<Refusal>(made).sentence.text : "built";
}

// Two nodes that move along x and y, M diagonal.
BeamFiles four_dofs(const char* components, double last) {
  const std::string head = "%%MatrixMarket matrix coordinate real symmetric\n4 4 ";
  const auto word = [&](int i) { return std::string(components).substr(static_cast<std::size_t>(2 * i), 2); };
  return {head + "4\n1 1 1\n2 2 1\n3 3 1\n4 4 1\n", head + fmt::format("5\n1 1 2\n2 2 3\n3 3 2\n4 4 {}\n3 1 1\n", last),
          fmt::format("dof,node,component,x,y,z,held\n1,A,{},0,0,0,\n2,A,{},0,0,0,\n3,B,{},1,0,0,\n4,B,{},1,0,0,\n",
                      word(0), word(1), word(2), word(3))};
}

}  // namespace

TEST_CASE("given masses: hrz and redistributed of a beam's files are those of the beam, whatever the unit") {
  constexpr int elements = 9;
  const BeamSpec beam = std::get<BeamSpec>(working_set().structure);
  for (const double unit : {1.0, 1e-3}) {
    FiniteElementSpace own = make_space(beam, elements),
                       given = space_of(assembled(beam_files(beam, elements, {unit, "fixed", {}}), unit));
    const Eigen::MatrixXd scaled = built(*mass("hrz"), own).mass;
    CHECK((Eigen::MatrixXd(built(*mass("hrz"), given).mass) - scaled).norm() <= 1e-13 * scaled.norm());
    for (const std::vector<int>& contact : {std::vector<int>{16}, {8, 16}, {16, 17}, {2, 14}})
      for (const int reach : {2, 3, 0}) {
        INFO("reach " << reach << ", " << contact.size() << " contact dofs, the first " << contact.front());
        own.contact_dofs = given.contact_dofs = contact;
        if (sentence(*projected(reach), own).find("negative eigenvalue") != std::string::npos) {
          CHECK(sentence(*projected(reach), given).find("negative eigenvalue") != std::string::npos);
          continue;
        }
        const Inertia moved = built(*projected(reach), given), expected = built(*projected(reach), own);
        CHECK(moved.kernel_dimension == expected.kernel_dimension);
        // Round-off of the multipliers, over the condition of their three equations.
        CHECK((Eigen::MatrixXd(moved.mass) - Eigen::MatrixXd(expected.mass)).norm() <= 1e-11 * expected.mass.norm());
      }
  }
}

TEST_CASE("given masses: redistributed keeps what rigid motions of a frame move, and empties the contact dofs") {
  const AssembledStructure frame = assembled(frame_files(arch()));
  // Two translations and the rotation in the plane.
  REQUIRE(frame.dofs_known.rigid.cols() == 3);
  FiniteElementSpace space = space_of(frame);
  const Eigen::MatrixXd X = frame.dofs_known.rigid, before = X.transpose() * frame.mass * X;
  const auto dof = [&](const char* node, const char* component) {
    return frame.row(at_node(node, component), "").free.front().first;
  };
  space.contact_dofs = {dof("N5", "ux"), dof("N5", "uy"), dof("N9", "ux")};
  std::sort(space.contact_dofs.begin(), space.contact_dofs.end());
  for (const int reach : {2, 0}) {
    const Inertia moved = built(*projected(reach), space);
    for (const int one : space.contact_dofs) CHECK(moved.mass.col(one).norm() == 0);
    CHECK(moved.kernel_dimension == 3);
    CHECK((X.transpose() * moved.mass * X - before).norm() <= 1e-12 * before.norm());
    // Only neighbours within the reach gain mass.
    const Eigen::MatrixXd change = Eigen::MatrixXd(moved.mass) - Eigen::MatrixXd(frame.mass);
    CHECK((change.row(dof("N2", "uy")).norm() == 0) == (reach == 2));
  }
}

TEST_CASE("given masses: a rotation that K resists because the places are not told is none") {
  const AssembledStructure told = assembled(frame_files(arch())), untold = assembled(frame_files(arch(), false));
  CHECK(told.dofs_known.rigid.cols() == 3);
  CHECK(untold.dofs_known.rigid.cols() == 2);
  FiniteElementSpace space = space_of(untold);
  space.contact_dofs = {15};
  const Eigen::MatrixXd X = untold.dofs_known.rigid, before = X.transpose() * untold.mass * X,
                        after = X.transpose() * built(*projected(2), space).mass * X;
  CHECK((after - before).norm() <= 1e-12 * before.norm());
}

TEST_CASE("given masses: hrz keeps the mass along x and y apart, and leaves a diagonal mass as it is") {
  const auto scaled = [](const char* components, double last, const char* node, const char* component) {
    const AssembledStructure made = assembled(four_dofs(components, last));
    const int dof = made.row(at_node(node, component), "").free.front().first;
    return built(*mass("hrz"), space_of(made)).mass.coeff(dof, dof);
  };
  // Along x 2 + 2 + 2·1 = 6 kg on a diagonal of 4; along y the matrix is diagonal.
  CHECK(scaled("uxuyuxuy", 5, "A", "ux") == 3);
  CHECK(scaled("uxuyuxuy", 5, "B", "ux") == 3);
  CHECK(scaled("uxuyuxuy", 5, "A", "uy") == 3);
  CHECK(scaled("uxuyuxuy", 5, "B", "uy") == 5);
  // Rotations that M couples with no displacement are scaled as all displacements are: (6 + 3)/(4 + 3).
  CHECK(scaled("uxuyuxrz", 7, "B", "rz") == Approx(9).epsilon(1e-15));
}

TEST_CASE("given masses: what has no direction, no neighbour or no form is refused") {
  CHECK(sentence(*mass("hrz"), space_of(assembled(four_dofs("uxuyuxp1", 5)))) ==
        "a diagonal mass needs displacements along x, y, z and rotations, and the structure has dofs of another name: "
        "use consistent or redistributed");
  FiniteElementSpace space = space_of(assembled(four_dofs("uxuyuxuy", 5)));
  CHECK(sentence(*mass("redistributed"), space) ==
        "the redistributed mass empties the end nodes of a bar; for this assembled structure use its form projected");
  space.contact_dofs = {1};
  CHECK(sentence(*projected(2), space).starts_with("no dof near the contact points of this assembled structure"));
  space.contact_dofs = {};
  CHECK(Eigen::MatrixXd(built(*projected(2), space).mass) == Eigen::MatrixXd(space.given->mass));
}

}  // namespace given_mass_tests
