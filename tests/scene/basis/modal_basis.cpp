// A basis of modes and static shapes of stops, against the structure that it stands for.
#include <Eigen/Cholesky>
#include <numbers>
#include <ricochet/scene/assembly.hpp>
#include <ricochet/scene/basis/modal_basis.hpp>
#include <ricochet/scene/beam.hpp>

#include "tests/scene/working_set.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

BeamSpec pinned_unit_beam(double length = 1) {
  SceneSpec scene = unit_beam();
  BeamSpec beam = beam_of(scene);
  beam.length = length;
  beam.supports = {{"left", 0, BeamSupport::Type::pinned}, {"right", length, BeamSupport::Type::pinned}};
  return beam;
}

struct Meshed {
  FiniteElementSpace space;
  SparseMatrix stiffness, mass;
  SparseRows contact;
};

Meshed meshed(const BeamSpec& beam, int elements, const std::vector<double>& stops) {
  Meshed out;
  out.space = make_space(beam, elements);
  out.stiffness = beam_stiffness(beam, out.space);
  out.mass = consistent_mass(out.space);
  out.contact = displacement_rows(out.space, stops);
  return out;
}

double basis_gap(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return (a - b).cwiseAbs().maxCoeff() / std::max(1e-300, b.cwiseAbs().maxCoeff());
}

/// H K⁻¹ Hᵀ.
Eigen::MatrixXd flexibility(const SparseMatrix& stiffness, const Eigen::MatrixXd& rows) {
  const Eigen::MatrixXd K(stiffness);
  return rows * K.ldlt().solve(rows.transpose());
}

}  // namespace

TEST_CASE("a basis has diagonal matrices of its own, and is as soft at its stops as the structure") {
  const Meshed beam = meshed(pinned_unit_beam(), 20, {0.3, 0.55, 0.8});
  for (const int modes : {1, 4, 12}) {
    const ModalBasis basis = modal_basis(beam.stiffness, beam.mass, beam.contact, true, {modes, true});
    CHECK(basis.dofs() == modes + 3);
    const Eigen::MatrixXd& Q = basis.shapes;
    // Round-off of the solve is 1e-16 times the condition of K, 1e6 here.
    CHECK(basis_gap(Q.transpose() * (beam.stiffness * Q), Eigen::MatrixXd(basis.stiffness.asDiagonal())) < 1e-10);
    CHECK(basis_gap(Q.transpose() * (beam.mass * Q), Eigen::MatrixXd(basis.mass)) < 1e-10);
    CHECK(basis_gap(beam.contact * Q, basis.at_points) < 1e-10);
    const Eigen::MatrixXd whole = flexibility(beam.stiffness, Eigen::MatrixXd(beam.contact));
    const Eigen::MatrixXd here =
        basis.at_points * basis.stiffness.cwiseInverse().asDiagonal() * basis.at_points.transpose();
    CHECK(basis_gap(here, whole) < 1e-10);
    CHECK(basis_gap(basis.flexibility, whole.diagonal()) < 1e-10);
    CHECK(basis.left_out.minCoeff() > 0);
    const ModalBasis bare = modal_basis(beam.stiffness, beam.mass, beam.contact, true, {modes, false});
    CHECK(bare.dofs() == modes);
    CHECK(bare.left_out == basis.left_out);
  }
}

TEST_CASE("what modes leave out of a pinned beam's flexibility is the rest of its series") {
  // R = Σ_{k>N} 2 sin²(kπx) / (kπ)⁴ of EI = ρS = L = 1; the mesh follows mode k to (kπ/n)⁴/720.
  const double x = 0.3;
  const Meshed beam = meshed(pinned_unit_beam(), 200, {x});
  const ModalBasis basis = modal_basis(beam.stiffness, beam.mass, beam.contact, true, {5, true});
  double rest = 0;
  for (int k = 6; k < 2000; ++k)
    rest += 2 * std::pow(std::sin(k * std::numbers::pi * x), 2) / std::pow(k * std::numbers::pi, 4);
  CHECK(basis.left_out[0] == Approx(rest).epsilon(1e-5));
  // 1e-16 times the condition of K, 1e9.
  CHECK(basis.flexibility[0] == Approx(x * x * (1 - x) * (1 - x) / 3).epsilon(1e-7));
  for (int k = 0; k < 5; ++k) CHECK(basis.squares[k] == Approx(std::pow((k + 1) * std::numbers::pi, 4)).epsilon(1e-6));
}

TEST_CASE("all modes leave nothing out") {
  const Meshed beam = meshed(pinned_unit_beam(), 6, {0.5, 0.8});
  const ModalBasis basis = modal_basis(beam.stiffness, beam.mass, beam.contact, true, {beam.space.dofs, true});
  CHECK(basis.dofs() == beam.space.dofs);
  CHECK(basis_gap(basis.shapes * basis.shapes.transpose() * Eigen::MatrixXd(beam.mass),
                  Eigen::MatrixXd::Identity(beam.space.dofs, beam.space.dofs)) < 1e-10);
}

TEST_CASE("two stops of one place share one static shape") {
  const Meshed beam = meshed(pinned_unit_beam(), 10, {0.4, 0.4, 0.7});
  const ModalBasis basis = modal_basis(beam.stiffness, beam.mass, beam.contact, true, {3, true});
  CHECK(basis.dofs() == 3 + 2);
  CHECK(basis_gap(beam.contact * basis.shapes, basis.at_points) < 1e-10);
}

TEST_CASE("a free beam moves rigidly in its basis, and is as soft as its elastic modes") {
  BeamSpec beam = pinned_unit_beam();
  beam.supports.emplace();
  const Meshed free = meshed(beam, 16, {0.2, 0.6});
  const ModalBasis basis = modal_basis(free.stiffness, free.mass, free.contact, false, {5, true});
  CHECK(basis.squares[0] == 0);
  CHECK(basis.squares[1] == 0);
  CHECK(basis.squares[2] == Approx(std::pow(4.730040744862704, 4)).epsilon(2e-5));
  const Eigen::MatrixXd& Q = basis.shapes;
  CHECK(basis_gap(Q.transpose() * (free.stiffness * Q), Eigen::MatrixXd(basis.stiffness.asDiagonal())) < 1e-9);
  CHECK(basis_gap(Q.transpose() * (free.mass * Q), Eigen::MatrixXd(basis.mass)) < 1e-9);
  // The flexibility of the elastic modes is the same with three more modes in the place of their share of R.
  const ModalBasis more = modal_basis(free.stiffness, free.mass, free.contact, false, {8, true});
  CHECK(basis_gap(basis.flexibility, more.flexibility) < 1e-9);
}

TEST_CASE("modes of a long mesh are found without its dense matrices") {
  BeamSpec beam = pinned_unit_beam();
  const Meshed fine = meshed(beam, 700, {0.5});  // 1400 dofs
  const LowestModes modes = lowest_modes(fine.stiffness, fine.mass, 12, true);
  REQUIRE(modes.found);
  for (int k = 0; k < 12; ++k) CHECK(modes.squares[k] == Approx(std::pow((k + 1) * std::numbers::pi, 4)).epsilon(1e-6));
  CHECK(basis_gap(modes.shapes.transpose() * (fine.mass * modes.shapes), Eigen::MatrixXd::Identity(12, 12)) < 1e-10);
  beam.supports.emplace();
  const Meshed free = meshed(beam, 700, {0.5});
  const LowestModes rigid = lowest_modes(free.stiffness, free.mass, 5, false);
  REQUIRE(rigid.found);
  CHECK(rigid.squares[0] == 0);
  CHECK(rigid.squares[1] == 0);
  CHECK(rigid.squares[2] == Approx(std::pow(4.730040744862704, 4)).epsilon(1e-5));
}

TEST_CASE("a field is kept by the basis where its modes and its stops have it") {
  const Meshed beam = meshed(pinned_unit_beam(), 12, {0.3, 0.7});
  const ModalBasis basis = modal_basis(beam.stiffness, beam.mass, beam.contact, true, {4, true});
  const Eigen::VectorXd inside = basis.shapes * Eigen::VectorXd::LinSpaced(basis.dofs(), -1, 2);
  CHECK(basis_gap(basis.shapes * in_basis(basis, beam.mass, beam.contact, inside), inside) < 1e-10);
  CHECK(basis_gap(basis.shapes * in_basis_by_least_squares(basis, inside), inside) < 1e-10);
  const Eigen::VectorXd any = Eigen::VectorXd::LinSpaced(beam.space.dofs, 1, -3).array().sin();
  CHECK(basis_gap(basis.at_points * in_basis(basis, beam.mass, beam.contact, any), beam.contact * any) < 1e-10);
}

TEST_CASE("more modes than there are, or than have mass, are refused") {
  Meshed beam = meshed(pinned_unit_beam(), 4, {0.5});
  CHECK_THROWS_WITH(modal_basis(beam.stiffness, beam.mass, beam.contact, true, {99, true}),
                    Catch::Contains("99 modes; the structure has 8 degrees of freedom"));
  SparseMatrix lumped(beam.space.dofs, beam.space.dofs);
  for (int i = 0; i < beam.space.dofs; ++i)
    if (beam.mass.coeff(i, i) > 0.01) lumped.insert(i, i) = 1;
  const int heavy = static_cast<int>(lumped.nonZeros());
  REQUIRE(heavy < beam.space.dofs);
  CHECK_THROWS_WITH(modal_basis(beam.stiffness, lumped, beam.contact, true, {heavy + 1, true}),
                    Catch::Contains("of the structure have mass"));
  CHECK(modal_basis(beam.stiffness, lumped, beam.contact, true, {heavy, true}).modes == heavy);
}

// Cases of one structure share its basis, bit for bit that of each.

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
