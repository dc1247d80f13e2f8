// Masses with one thing wrong, each caught by the check that looks at it.
#include <catch2/catch.hpp>

#include "runners/check/mass_checks.hpp"
#include "tests/check/sound_schemes.hpp"

using namespace ricochet;
using namespace ricochet::testing;
using Catch::Matchers::Contains;
using checking::CheckResult;
using checking::Finding;

namespace {

using Change = std::function<void(SparseMatrix& mass, Inertia& inertia)>;

class ChangedMass final : public MassStrategy {
 public:
  explicit ChangedMass(Change change) : change_(std::move(change)) {}
  InertiaOrRefusal build(const FiniteElementSpace& space) const override {
    if (space.elements.empty()) return Refusal{"an oscillator has no elements: use another mass"};
    Inertia inertia;
    inertia.mass = consistent_mass(space);
    if (change_) change_(inertia.mass, inertia);
    return inertia;
  }

 private:
  Change change_;
};

Entry<MassStrategy> mass_entry(Change change) {
  Entry<MassStrategy> entry{full_manual("made-here"), {}, ""};
  entry.make = [change](const Parameters&) { return std::make_unique<ChangedMass>(change); };
  return entry;
}

void caught(Change change, const std::string& check, const std::string& words) {
  const CheckResult result = one_check(checking::mass_checks(), mass_entry(std::move(change)), check);
  INFO(text_of({result}));
  CHECK(result.finding == Finding::fails);
  REQUIRE_FALSE(result.sentences.empty());
  CHECK_THAT(result.sentences.front(), Contains(words));
}

}  // namespace

TEST_CASE("check: a mass that is what it says passes every check") {
  for (const auto& check : checking::mass_checks()) {
    const CheckResult result = one_check(checking::mass_checks(), mass_entry({}), check.name);
    INFO(text_of({result}));
    CHECK(result.finding == Finding::ok);
  }
}

TEST_CASE("check: a matrix that is no mass is caught") {
  caught([](SparseMatrix& mass, Inertia&) { mass.coeffRef(0, mass.cols() - 1) += 0.01; }, "symmetric", "not symmetric");
  caught([](SparseMatrix& mass, Inertia&) { mass *= -1; }, "semidefinite", "kinetic energy");
  caught([](SparseMatrix& mass, Inertia&) { mass.coeffRef(0, 0) = std::nan(""); }, "symmetric", "not finite");
  caught([](SparseMatrix& mass, Inertia&) { mass.conservativeResize(mass.rows() - 1, mass.cols() - 1); }, "symmetric",
         "the space has");
}

TEST_CASE("check: a hidden kernel, and one that is not there, are caught") {
  caught(
      [](SparseMatrix& mass, Inertia&) {
        mass.prune([](Eigen::Index row, Eigen::Index column, double) { return row != 1 && column != 1; });
      },
      "kernel", "declares a kernel of dimension 0, its matrix has 1");
  caught([](SparseMatrix&, Inertia& inertia) { inertia.kernel_dimension = 2; }, "kernel",
         "declares a kernel of dimension 2, its matrix has 0");
}

TEST_CASE("check: too much mass, mass on one side alone and modes that do not converge are caught") {
  caught([](SparseMatrix& mass, Inertia&) { mass *= 1.02; }, "total mass", "of 1 kg");
  caught([](SparseMatrix& mass, Inertia&) { mass *= 1.02; }, "frequencies", "does not converge");
  caught(
      [](SparseMatrix& mass, Inertia&) {
        const Eigen::Index last = mass.rows() - 1;
        mass.coeffRef(0, 0) += 0.001;
        mass.coeffRef(last, last) -= 0.001;
      },
      "both ends alike", "its mirror image");
}
