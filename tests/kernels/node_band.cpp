// Steps by nodes against the kernels that they stand for, bit by bit. Compared are update, product and substitution,
// measures, test of the bounds, for each instruction set and each number of lanes.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <ricochet/kernels/band_ldlt.hpp>
#include <ricochet/kernels/block.hpp>
#include <ricochet/kernels/quadratic_form.hpp>

#include "tests/instruction_sets.hpp"

using namespace ricochet;
using ricochet::testing::instruction_sets;

namespace {

constexpr int nodes = 7, dofs = 2 * nodes;

double number(int a, int b, int c) {
  return std::sin(1.7 * a + 2.3 * b + 0.9 * c + 0.4);
}

SparseMatrix matrix_of(int rows, int columns, const std::vector<Eigen::Triplet<double>>& entries) {
  SparseMatrix matrix(rows, columns);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

// Neighbouring nodes coupled in every entry, and one diagonally dominant.
SparseMatrix coupled(bool definite) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < dofs; ++i)
    for (int j = std::max(0, i / 2 * 2 - 2); j < std::min(dofs, i / 2 * 2 + 4); ++j)
      entries.emplace_back(i, j, i == j && definite ? 8.0 : number(std::min(i, j), std::max(i, j), 1));
  return matrix_of(dofs, dofs, entries);
}

QuasiDefinite system(bool border) {
  QuasiDefinite matrix;
  matrix.A = coupled(true);
  if (!border) return matrix;
  std::vector<Eigen::Triplet<double>> coupling, mass;
  for (int a = 0; a < nodes; ++a)
    for (int b = std::max(0, a - 1); b < std::min(nodes, a + 2); ++b) {
      coupling.emplace_back(a, 2 * b, a == b ? 2.0 : 0.5);
      coupling.emplace_back(a, 2 * b + 1, 0.1 * number(a, b, 4));
      mass.emplace_back(a, b, a == b ? 4.0 : 1.0);
    }
  matrix.G = matrix_of(nodes, dofs, coupling);
  matrix.Cv = matrix_of(nodes, nodes, mass);
  return matrix;
}

Block filled(int rows, int T, int border, int kind) {
  Block block(rows, T, border);
  for (int i = 0; i < rows; ++i)
    for (int l = 0; l < T; ++l) block.at(i, l) = number(i, l, kind);
  return block;
}

// What a step reads and writes, and the points that it measures: all nodes but one.
struct March {
  int T;
  Block q, d, last, z, k, scale, offset, lower, upper, y;
  double weight[3] = {1, 0.4, 0.6}, next[2] = {-1, 0.3};
  std::uint32_t outside = 0;

  March(int lanes, int points)
      : T(lanes),
        q(filled(dofs, T, 3, 1)),
        d(filled(dofs, T, 3, 2)),
        last(filled(dofs, T, 5, 3)),
        z(dofs, T, 3),
        k(filled(dofs, T, 3, 4)),
        scale(filled(1, T, 0, 5)),
        offset(filled(1, T, 0, 6)),
        lower(points, T),
        upper(points, T),
        y(points, T) {
    lower.fill(-2.5);
    upper.fill(2.5);
    if (T > 1) q.at(2, T - 1) = std::numeric_limits<double>::quiet_NaN();
  }

  void update(const LaneKernels& kernels) {
    double* slots[] = {q.data(), d.data()};
    const double increments[] = {1, 1, 1, 0, 1, 1};
    kernels.update(static_cast<long>(q.size()), 2, slots, last.data(), increments, next, k.data());
  }
  void measure(const LaneKernels& kernels, const LaneRows& rows) {
    const double* terms[] = {q.data(), d.data(), z.data()};
    kernels.measure(rows, 3, terms, weight, offset.data(), y.data());
    outside = kernels.outside(rows.rows, y.data(), lower.data(), upper.data());
  }
  // A step in one pass, with update and measures where they are asked for.
  template <class Step>
  void make(void (*kernel)(const Step&), Step step, bool updates, bool tests, SquareSum* sum = nullptr) {
    double* slots[] = {q.data(), d.data()};
    const IncrementUpdate update{slots, last.data(), {next[0], next[1]}};
    PointTest test{slots, {weight[0], weight[1], weight[2]}, offset.data(), lower.data(), upper.data(), y.data()};
    if constexpr (requires { step.x; }) step.x = slots;
    step.scale = scale.data();
    step.z = z.data();
    if (updates) step.update = &update;
    if (tests) step.test = &test;
    step.sum = sum;
    if (sum) sum->x = d.data();
    kernel(step);
    outside = test.outside;
  }
  void require_same(const March& other) const {
    const auto same = [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); };
    for (int l = 0; l < T; ++l) {
      for (int i = 0; i < dofs; ++i) {
        INFO(T << " lanes, row " << i << ", lane " << l);
        REQUIRE(same(q.at(i, l), other.q.at(i, l)));
        REQUIRE(same(d.at(i, l), other.d.at(i, l)));
        REQUIRE(same(z.at(i, l), other.z.at(i, l)));
      }
      for (int i = 0; i < y.rows(); ++i) REQUIRE(same(y.at(i, l), other.y.at(i, l)));
    }
    REQUIRE(outside == other.outside);
  }
};

}  // namespace

TEST_CASE("a step by nodes is bitwise that of a band, update and measures included") {
  const int T = GENERATE(1, 2, 4, 8, 16, 32);
  const bool border = GENERATE(false, true), updates = GENERATE(false, true), tests = GENERATE(false, true);
  const LaneKernels& kernels = lane_kernels(T, GENERATE(from_range(instruction_sets())));
  const SparseMatrix K = coupled(false);
  BandLdlt ldlt;
  REQUIRE_FALSE(ldlt.factorise(system(border)));
  std::vector<double> shape, value;
  for (int i = 0; i < dofs; ++i) shape.push_back(std::cos(i));
  // All nodes but the third.
  std::vector<int> start = {0}, index;
  for (int a = 0; a < nodes; ++a) {
    if (a == 2) continue;
    index.push_back(2 * a);
    value.push_back(1 + 0.125 * a);
    start.push_back(static_cast<int>(index.size()));
  }
  const LaneRows H{static_cast<int>(index.size()), start.data(), index.data(), value.data()};

  March expected(T, H.rows), found(T, H.rows);
  if (updates) expected.update(kernels);
  const std::vector<double> band = band_storage(K, 3, T == 1);
  Block b(dofs, T), solution(ldlt.rows(), T, ldlt.half_width());
  std::vector<int> from = ldlt.order();
  for (int& row : from)
    if (row >= dofs) row = -1;
  BandStep step;
  step.rows = dofs;
  step.product_width = 3;
  step.K = band.data();
  step.k = expected.k.data();
  step.shape = shape.data();
  step.scale = expected.scale.data();
  step.b = b.data();
  step.from = from.data();
  ldlt.substitute_in(step, solution.data());
  kernels.band_step(step);
  for (int r = 0; r < ldlt.rows(); ++r)
    if (from[static_cast<std::size_t>(r)] >= 0)
      std::copy_n(solution.row(r), T, expected.z.row(from[static_cast<std::size_t>(r)]));
  if (tests) expected.measure(kernels, H);

  NodeBand by_nodes(K, shape.data(), ldlt);
  REQUIRE_FALSE(by_nodes.empty());
  REQUIRE(by_nodes.border() == border);
  REQUIRE(by_nodes.place_points(H));
  Block r(nodes, T);
  NodeStep whole = by_nodes.step();
  whole.k = found.k.data();
  whole.r = r.data();
  found.make(kernels.node_step, whole, updates, tests);
  found.require_same(expected);
}

TEST_CASE("the unknown of the step before may be where the next one goes") {
  const int T = GENERATE(1, 16);
  const LaneKernels& kernels = lane_kernels(T);
  BandLdlt ldlt;
  REQUIRE_FALSE(ldlt.factorise(system(false)));
  const std::vector<double> shape(dofs, 0.5);
  const NodeBand band(coupled(false), shape.data(), ldlt);
  March apart(T, 1), together(T, 1);
  together.z = together.last;
  for (March* one : {&apart, &together}) {
    double* slots[] = {one->q.data(), one->d.data()};
    const IncrementUpdate update{slots, one == &apart ? one->last.data() : one->z.data(), {one->next[0], one->next[1]}};
    NodeStep step = band.step();
    step.scale = one->scale.data();
    step.z = one->z.data();
    step.update = &update;
    kernels.node_step(step);
  }
  together.require_same(apart);
}

namespace {

// Beside a step of one lane, of z + 0.4 x_1: the form of A and a projection, against a pass of their own.
template <class Kernel, class Step>
void check_squares(Kernel LaneKernels::*kernel, const Step& step, const QuadraticForm& A, int width, int points) {
  const bool updates = GENERATE(false, true), tests = GENERATE(false, true);
  std::vector<double> h;
  for (int i = 0; i < dofs; ++i) h.push_back(number(i, 5, 5));
  const Block fours = CombinedForm::packed(A, h.data(), width);
  REQUIRE(fours.rows() > 0);
  std::vector<SquareSum> sums;
  for (const InstructionSet set : instruction_sets()) {
    const LaneKernels& kernels = lane_kernels(1, set);
    March apart(1, points), beside(1, points);
    apart.make(kernels.*kernel, step, updates, tests);
    SquareSum sum;
    sum.fours = fours.data();
    sum.ratio = 0.4;
    sum.ones = A.unit();
    beside.make(kernels.*kernel, step, updates, tests, &sum);
    beside.require_same(apart);
    const double* x[] = {beside.z.data(), beside.d.data()};
    const double ratio[] = {1, 0.4};
    const CombinedForm::Value expected = CombinedForm(A, h.data())(2, x, ratio);
    CHECK(sum.form == Approx(expected.form).epsilon(1e-13));
    CHECK(sum.projection == Approx(expected.projection).margin(1e-13));
    if (set != InstructionSet::baseline) sums.push_back(sum);
  }
  for (const SquareSum& sum : sums) {
    CHECK(sum.form == sums.front().form);
    CHECK(sum.projection == sums.front().projection);
  }
}

}  // namespace

TEST_CASE(
    "squares added up beside a step by nodes are those of a pass of their own, and the step stays bitwise equal") {
  const bool border = GENERATE(false, true), everywhere = GENERATE(false, true), wide = GENERATE(false, true);
  BandLdlt ldlt;
  REQUIRE_FALSE(ldlt.factorise(system(border)));
  const std::vector<double> shape(dofs, 0.5);
  NodeBand band(coupled(false), shape.data(), ldlt);
  std::vector<int> start = {0}, index;
  for (int a = 0; a < nodes; ++a)
    if (everywhere || a == 3) {
      index.push_back(2 * a);
      start.push_back(static_cast<int>(index.size()));
    }
  const std::vector<double> value(nodes, 1.25);
  const LaneRows H{static_cast<int>(index.size()), start.data(), index.data(), value.data()};
  REQUIRE(band.place_points(H));
  Block r(nodes, 1);
  const Block k = filled(dofs, 1, 3, 4);
  NodeStep step = band.step();
  step.r = r.data();
  step.k = k.data();
  const SparseMatrix diagonal = Eigen::VectorXd::Constant(dofs, 1.5).asDiagonal().toDenseMatrix().sparseView();
  check_squares(&LaneKernels::node_step, step, QuadraticForm(wide ? coupled(true) : diagonal), 3, H.rows);
}

TEST_CASE(
    "squares added up beside a step by modes are those of a pass of their own, and the step stays bitwise equal") {
  const bool unit = GENERATE(false, true);
  Block columns(Modes::numbers * 16, 1);
  for (int i = 0; i < dofs; ++i)
    for (int s = 0; s < Modes::numbers; ++s) columns.at(s * 16 + i, 0) = number(i, s, 9);
  ModeStep step;
  step.modes = {dofs, columns.data(), 0.3};
  const SparseMatrix diagonal =
      Eigen::VectorXd::LinSpaced(dofs, 1, unit ? 1 : 3).asDiagonal().toDenseMatrix().sparseView();
  check_squares(&LaneKernels::mode_step, step, QuadraticForm(diagonal), 0, 1);
}

TEST_CASE("what does not come by nodes is not packed by nodes") {
  const std::vector<double> shape(dofs, 1.0);
  BandLdlt ldlt;
  REQUIRE_FALSE(ldlt.factorise(system(false)));
  // A rotation coupled with the deflection after the next one.
  SparseMatrix wide = coupled(false);
  wide.coeffRef(1, 4) = wide.coeffRef(4, 1) = 0.5;
  CHECK(NodeBand(wide, shape.data(), ldlt).empty());
  QuasiDefinite matrix = system(false);
  matrix.A.coeffRef(1, 4) = matrix.A.coeffRef(4, 1) = 0.5;
  REQUIRE_FALSE(ldlt.factorise(matrix));
  CHECK(NodeBand(coupled(false), shape.data(), ldlt).empty());
  matrix = system(true);
  matrix.border_first = true;
  REQUIRE_FALSE(ldlt.factorise(matrix));
  CHECK(NodeBand(coupled(false), shape.data(), ldlt).empty());
  // Points between nodes, at rotations, or twice at one node.
  REQUIRE_FALSE(ldlt.factorise(system(false)));
  NodeBand band(coupled(false), shape.data(), ldlt);
  const std::vector<int> alone = {0, 1, 2}, pair = {0, 2};
  const std::vector<double> ones = {1, 1};
  for (const std::vector<int>& index : {std::vector<int>{3, 4}, std::vector<int>{4, 4}})
    CHECK_FALSE(band.place_points({2, alone.data(), index.data(), ones.data()}));
  const std::vector<int> two = {2, 4};
  CHECK_FALSE(band.place_points({1, pair.data(), two.data(), ones.data()}));
  CHECK(band.place_points({2, alone.data(), two.data(), ones.data()}));
}
