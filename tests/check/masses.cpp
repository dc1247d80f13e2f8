// Masses with one thing wrong, each caught by the check that looks at it.
#include <algorithm>
#include <catch2/catch.hpp>

#include "runners/check/mass_checks.hpp"
#include "tests/check/sound_schemes.hpp"
#include "tests/eigen.hpp"

using namespace ricochet;
using namespace ricochet::testing;
using Catch::Matchers::Contains;
using checking::CheckResult;
using checking::Finding;

namespace {

using MassChange = std::function<void(SparseMatrix& mass, Inertia& inertia)>;
using ContactChange = std::function<void(const FiniteElementSpace& space, Inertia& inertia)>;

class ChangedMass final : public MassStrategy {
 public:
  explicit ChangedMass(MassChange change) : change_(std::move(change)) {}
  InertiaOrRefusal build(const FiniteElementSpace& space) const override {
    if (space.elements.empty()) return Refusal{"an oscillator has no elements: use another mass"};
    Inertia inertia;
    inertia.mass = consistent_mass(space);
    if (change_) change_(inertia.mass, inertia);
    return inertia;
  }

 private:
  MassChange change_;
};

Entry<MassStrategy> mass_entry(MassChange change) {
  Entry<MassStrategy> entry{full_manual("made-here"), {}, ""};
  entry.make = [change](const Parameters&) { return std::make_unique<ChangedMass>(change); };
  return entry;
}

// Wrong where stops stand, right elsewhere.
class WrongAtContact final : public MassStrategy {
 public:
  explicit WrongAtContact(ContactChange change) : change_(std::move(change)) {}
  InertiaOrRefusal build(const FiniteElementSpace& space) const override {
    if (space.elements.empty()) return Refusal{"an oscillator has no elements: use another mass"};
    Inertia inertia;
    inertia.mass = consistent_mass(space);
    change_(space, inertia);
    return inertia;
  }

 private:
  ContactChange change_;
};

void caught(Entry<MassStrategy> entry, const std::string& check, const std::string& words) {
  const CheckResult result = one_check(checking::mass_checks(), std::move(entry), check);
  INFO(text_of({result}));
  CHECK(result.finding == Finding::fails);
  REQUIRE_FALSE(result.sentences.empty());
  CHECK_THAT(result.sentences.front(), Contains(words));
}
void caught(MassChange change, const std::string& check, const std::string& words) {
  caught(mass_entry(std::move(change)), check, words);
}
void caught_at_contact(ContactChange change, const std::string& check, const std::string& words) {
  Entry<MassStrategy> entry{full_manual("made-here"), {}, ""};
  entry.make = [change](const Parameters&) { return std::make_unique<WrongAtContact>(change); };
  caught(std::move(entry), check, words);
}

}  // namespace

// Rotations without inertia, and a kernel counted as if every node had a displacement.
class HeldEndsAlone final : public MassStrategy {
 public:
  InertiaOrRefusal build(const FiniteElementSpace& space) const override {
    if (space.elements.empty()) return Refusal{"an oscillator has no elements: use another mass"};
    Inertia inertia;
    Eigen::VectorXd diagonal = Eigen::VectorXd::Zero(space.dofs);
    const bool hermite = space.basis == FiniteElementSpace::Basis::hermite;
    for (const auto& element : space.elements)
      for (const int a : {0, hermite ? 2 : 1})
        if (element.dof[static_cast<std::size_t>(a)] >= 0)
          diagonal[element.dof[static_cast<std::size_t>(a)]] += element.line_density * element.length / 2;
    for (const auto& point : space.point_masses)
      if (!point.rotation) diagonal[point.dof] += point.mass;
    inertia.mass = SparseMatrix(Eigen::MatrixXd(diagonal.asDiagonal()).sparseView());
    inertia.kernel_dimension = hermite ? space.dofs / 2 : 0;
    return inertia;
  }
};

TEST_CASE("check: a mass that thinks of supports at the ends alone is caught by one between them") {
  Entry<MassStrategy> entry{full_manual("made-here"), {}, ""};
  entry.make = [](const Parameters&) { return std::make_unique<HeldEndsAlone>(); };
  caught(entry, "kernel",
         "a beam of 6 elements, fixed at its left end, pinned between: declares a kernel of dimension 5");
}

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

TEST_CASE("check: what a mass does wrong only where stops stand is caught") {
  const auto emptied = [](const FiniteElementSpace& space, Inertia& inertia) {
    inertia.mass.prune([&](Eigen::Index row, Eigen::Index column, double) {
      const auto touched = [&](Eigen::Index dof) {
        return std::count(space.contact_dofs.begin(), space.contact_dofs.end(), static_cast<int>(dof)) > 0;
      };
      return !touched(row) && !touched(column);
    });
  };
  caught_at_contact(emptied, "kernel", "with stops at its free ends: declares a kernel of dimension 0");
  caught_at_contact(
      [&](const FiniteElementSpace& space, Inertia& inertia) {
        if (space.contact_dofs.size() < 3) emptied(space, inertia);
      },
      "total mass", "with stops at its free ends: a translation moves");
  caught_at_contact(
      [](const FiniteElementSpace& space, Inertia& inertia) {
        if (!space.contact_dofs.empty()) inertia.mass *= 1.02;
      },
      "frequencies", "with a stop at its free end does not converge");
  caught_at_contact(
      [](const FiniteElementSpace& space, Inertia& inertia) {
        if (space.contact_dofs.size() > 2) inertia.mass.coeffRef(0, 0) *= -1;
      },
      "semidefinite", "with stops at all nodes");
}

TEST_CASE("check: a mass given by its inverse passes, and its faults are caught") {
  const auto entry = [](const std::function<void(Eigen::MatrixXd&)>& change) {
    Entry<MassStrategy> made = mass_entry([change](SparseMatrix& mass, Inertia& inertia) {
      Eigen::MatrixXd inverse = eigen::inverse(mass);
      inverse = (0.5 * (inverse + inverse.transpose())).eval();
      change(inverse);
      inertia.inverse = inverse.sparseView();
      mass = SparseMatrix();
    });
    return made;
  };
  const auto sound = entry([](Eigen::MatrixXd&) {});
  for (const auto& check : checking::mass_checks()) {
    const CheckResult result = one_check(checking::mass_checks(), sound, check.name);
    INFO(text_of({result}));
    CHECK(result.finding == Finding::ok);
  }
  caught(entry([](Eigen::MatrixXd& inverse) { inverse /= 1.02; }), "total mass", "of 1 kg");
  caught(entry([](Eigen::MatrixXd& inverse) { inverse(0, 0) = -1; }), "semidefinite", "not positive definite");
}
