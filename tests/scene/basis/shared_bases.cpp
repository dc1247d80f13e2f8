// Cases of one structure share its basis, bit for bit that of each.
#include <ricochet/scene/assembly.hpp>
#include <ricochet/scene/basis/shared_bases.hpp>
#include <ricochet/scene/beam.hpp>

#include "tests/scene/working_set.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

struct Asked {
  SparseMatrix stiffness, mass;
  SparseRows contact;
  BasisSpec spec{4, true};

  std::shared_ptr<const ModalBasis> shared() const { return shared_basis(stiffness, mass, contact, true, spec); }
};

Asked asked_beam(int elements, double length, const std::vector<double>& stops) {
  SceneSpec scene = unit_beam();
  BeamSpec beam = beam_of(scene);
  beam.length = length;
  Asked out;
  const FiniteElementSpace space = make_space(beam, elements);
  out.stiffness = beam_stiffness(beam, space);
  out.mass = consistent_mass(space);
  out.contact = displacement_rows(space, stops);
  return out;
}

}  // namespace

TEST_CASE("a basis asked for again is the one there is, and equals one of its own to the last bit") {
  const Asked beam = asked_beam(20, 1.25, {0.5, 1.25});
  const auto first = beam.shared();
  const long long made = basis_count().made;
  CHECK(asked_beam(20, 1.25, {0.5, 1.25}).shared() == first);
  CHECK(basis_count().made == made);
  const ModalBasis own = modal_basis(beam.stiffness, beam.mass, beam.contact, true, beam.spec);
  CHECK(first->shapes == own.shapes);
  CHECK(first->stiffness == own.stiffness);
  CHECK(first->at_points == own.at_points);
  CHECK(Eigen::MatrixXd(first->mass) == Eigen::MatrixXd(own.mass));
}

TEST_CASE("whatever a basis depends on makes another one") {
  const Asked beam = asked_beam(20, 1.5, {0.5});
  const auto first = beam.shared();
  CHECK(asked_beam(21, 1.5, {0.5}).shared() != first);
  CHECK(asked_beam(20, 1.5, {0.75}).shared() != first);
  CHECK(asked_beam(20, std::nextafter(1.5, 2), {0.5}).shared() != first);
  Asked other = beam;
  other.spec = {4, false};
  CHECK(other.shared() != first);
  other.spec = {5, true};
  CHECK(other.shared() != first);
  other = beam;
  other.mass *= 1 + 0x1p-50;
  CHECK(other.shared() != first);
  CHECK(beam.shared() == first);
}

TEST_CASE("bases that take more than the limit give way to those used last") {
  // Full matrices of 500 dofs take 6 MB for each basis: 128 MB hold 21 of them.
  constexpr int dofs = 500;
  Eigen::MatrixXd full = Eigen::MatrixXd::Constant(dofs, dofs, 1e-3);
  full.diagonal() += Eigen::VectorXd::LinSpaced(dofs, 1, dofs);
  const SparseMatrix matrix = full.sparseView();
  const SparseRows none(0, dofs);
  const auto kept = [&](int k) {
    return shared_basis(SparseMatrix((1 + 0.01 * k) * matrix), matrix, none, true, {2, false});
  };
  const std::weak_ptr<const ModalBasis> oldest = kept(0);
  REQUIRE_FALSE(oldest.expired());
  for (int k = 1; k <= 22; ++k) kept(k);
  CHECK(oldest.expired());
  CHECK(basis_count().kept < 23);
}
