#include <catch2/catch.hpp>
#include <limits>
#include <ricochet/contract/check_inertia.hpp>
#include <ricochet/loader/catalogue.hpp>
#include <ricochet/scene/semi_discrete.hpp>

#include "tests/places.hpp"

using namespace ricochet;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

namespace {

FiniteElementSpace three_dofs() {
  FiniteElementSpace space;
  space.dofs = 3;
  return space;
}

Inertia assembled(const Eigen::MatrixXd& mass, int kernel = 0) {
  Inertia inertia;
  inertia.mass = mass.sparseView();
  inertia.kernel_dimension = kernel;
  return inertia;
}

Inertia factored(const Eigen::MatrixXd& B, const Eigen::MatrixXd& C, int kernel) {
  Inertia inertia;
  inertia.coupling = B.sparseView();
  inertia.velocity_mass = C.sparseView();
  inertia.kernel_dimension = kernel;
  return inertia;
}

Inertia inverted(const Eigen::MatrixXd& inverse, int kernel = 0) {
  Inertia inertia;
  inertia.inverse = inverse.sparseView();
  inertia.kernel_dimension = kernel;
  return inertia;
}

std::string wrong(const Inertia& inertia) {
  return check_inertia(inertia, three_dofs()).value_or("nothing");
}

Eigen::MatrixXd with(double value, int i, int j) {
  Eigen::MatrixXd mass = Eigen::Vector3d(2, 1e-6, 3).asDiagonal();
  mass(i, j) = value;
  return mass;
}

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

}  // namespace

TEST_CASE("a mass that is one has nothing wrong") {
  CHECK(wrong(assembled(Eigen::Matrix3d::Identity())) == "nothing");
  CHECK(wrong(assembled(Eigen::Vector3d(2, 0, 1e-9).asDiagonal(), 1)) == "nothing");
  CHECK(wrong(assembled(Eigen::Matrix3d::Ones(), 2)) == "nothing");
  CHECK(wrong(assembled(Eigen::Matrix3d::Zero(), 3)) == "nothing");
  CHECK(wrong(factored(Eigen::MatrixXd::Identity(2, 3), Eigen::Vector2d(1, 1e-8).asDiagonal(), 1)) == "nothing");
}

TEST_CASE("sizes that do not fit are told") {
  CHECK(wrong(assembled(Eigen::Matrix2d::Identity())) == "its mass is 2 × 2; expected 3 × 3, the dofs of the space");
  CHECK_THAT(wrong(Inertia{}), StartsWith("its mass is 0 × 0"));
  CHECK(wrong(factored(Eigen::MatrixXd::Identity(2, 2), Eigen::Matrix2d::Identity(), 0)) ==
        "its B is 2 × 2; expected 3 columns, the dofs of the space");
  CHECK(wrong(factored(Eigen::MatrixXd::Identity(2, 3), Eigen::Matrix3d::Identity(), 1)) ==
        "its C_v is 3 × 3; expected 2 × 2, the rows of B");
}

TEST_CASE("entries that are no numbers are told with their place") {
  CHECK(wrong(assembled(with(not_a_number, 1, 2))) == "the mass holds nan at (1, 2)");
  CHECK(wrong(assembled(with(std::numeric_limits<double>::infinity(), 0, 0))) == "the mass holds inf at (0, 0)");
  Eigen::MatrixXd B = Eigen::MatrixXd::Identity(2, 3);
  B(0, 2) = not_a_number;
  CHECK(wrong(factored(B, Eigen::Matrix2d::Identity(), 1)) == "B holds nan at (0, 2)");
  CHECK(wrong(factored(Eigen::MatrixXd::Identity(2, 3), Eigen::Matrix2d::Constant(not_a_number), 1)) ==
        "C_v holds nan at (0, 0)");
}

TEST_CASE("a mass is symmetric, measured by what its own rows weigh") {
  CHECK(wrong(assembled(with(0.1, 0, 2))) == "the mass is not symmetric: 0 at (2, 0), 0.1 at (0, 2)");
  // 1e-9 is little beside 3, but not beside √(2·1e-6).
  CHECK_THAT(wrong(assembled(with(1e-9, 0, 1))), StartsWith("the mass is not symmetric"));
  Eigen::MatrixXd rounded = Eigen::Matrix3d::Identity() + 0.5 * with(0, 1, 1);
  rounded(0, 1) = 0.25;
  rounded(1, 0) = std::nextafter(0.25, 1);
  CHECK(wrong(assembled(rounded)) == "nothing");
}

TEST_CASE("a mass is positive semidefinite") {
  CHECK(wrong(assembled(with(-1e-6, 1, 1))) == "the mass has -1e-06 on its diagonal, at 1");
  Eigen::Matrix3d indefinite = Eigen::Matrix3d::Identity();
  indefinite(0, 1) = indefinite(1, 0) = 1.001;
  CHECK(wrong(assembled(indefinite)) == "the mass has a negative eigenvalue");
  // A row without a diagonal cannot have anything else.
  Eigen::Matrix3d row = Eigen::Matrix3d::Identity();
  row(1, 1) = 0;
  row(1, 2) = row(2, 1) = 1e-3;
  CHECK(wrong(assembled(row, 1)) == "the mass has a negative eigenvalue");
  CHECK(wrong(factored(Eigen::MatrixXd::Identity(2, 3), Eigen::Matrix2d::Ones(), 1)) == "C_v is not positive definite");
}

TEST_CASE("a declared kernel is the real one") {
  CHECK(wrong(assembled(Eigen::Matrix3d::Identity(), 1)) == "declares a kernel of dimension 1, its mass has 0");
  CHECK(wrong(assembled(Eigen::Matrix3d::Ones(), 0)) == "declares a kernel of dimension 0, its mass has 2");
  CHECK(wrong(assembled(with(0, 1, 1), 0)) == "declares a kernel of dimension 0, its mass has 1");
  CHECK(wrong(factored(Eigen::MatrixXd::Identity(2, 3), Eigen::Matrix2d::Identity(), 0)) ==
        "declares a kernel of dimension 0, its mass has 1");
  CHECK_THAT(wrong(assembled(Eigen::Matrix3d::Identity(), -1)), Contains("-1"));
}

TEST_CASE("an inverse is symmetric, positive definite, of all dofs, and has no kernel") {
  CHECK(wrong(inverted(Eigen::Vector3d(2, 1e-9, 3).asDiagonal())) == "nothing");
  CHECK(wrong(inverted(Eigen::Matrix2d::Identity())) == "its inverse is 2 × 2; expected 3 × 3, the dofs of the space");
  CHECK(wrong(inverted(with(not_a_number, 1, 2))) == "the inverse holds nan at (1, 2)");
  CHECK_THAT(wrong(inverted(with(0.1, 0, 2))), StartsWith("the inverse is not symmetric"));
  CHECK(wrong(inverted(Eigen::Matrix3d::Ones())) == "the inverse is not positive definite");
  CHECK(wrong(inverted(Eigen::Matrix3d::Identity(), 1)) ==
        "declares a kernel of dimension 1, a mass that has an inverse has 0");
  Inertia both = inverted(Eigen::Matrix3d::Identity());
  both.mass = both.inverse;
  CHECK_THAT(wrong(both), StartsWith("gives its mass in several forms"));
}

TEST_CASE("the masses of this tree pass on meshes coarse and fine") {
  const int elements = GENERATE(1, 2, 3, 50, 500);
  Catalogue catalogue(tests::places().plugins, {}, {});
  Registry registry;
  catalogue.open_all(registry);
  REQUIRE(registry.names(Role::mass).size() >= 4);
  BeamSpec beam;
  beam.length = 1.501;
  beam.section = {.type = Section::Type::given, .EI = 1, .rhoS = 1};
  for (const StructureSpec& structure : {StructureSpec(beam), StructureSpec(BarSpec{})})
    for (const std::string& name : registry.names(Role::mass)) {
      const auto* entry = registry.mass(name);
      std::vector<Parameters> choices(1);
      for (const ParameterSpec& spec : entry->manual.parameters) {
        if (spec.words.empty() && spec.fallback)
          for (Parameters& choice : choices) choice.set(spec.key, *spec.fallback);
        if (spec.words.empty()) continue;
        std::vector<Parameters> more;
        for (const Parameters& choice : choices)
          for (const std::string& word : spec.words) (more.emplace_back(choice), more.back().set(spec.key, word));
        choices = more;
      }
      for (const Parameters& choice : choices) {
        const FiniteElementSpace space = make_space(structure, elements);
        INFO(name << " on " << elements << " elements of a " << space.structure);
        // The guard throws where check_inertia finds fault.
        CHECK_NOTHROW(entry->make(choice)->build(space));
      }
    }
}
