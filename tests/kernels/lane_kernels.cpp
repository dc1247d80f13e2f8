// Kernels against plain loops, for each instruction set and each number of lanes.
#include <Eigen/Core>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <ricochet/kernels/band_ldlt.hpp>
#include <ricochet/kernels/block.hpp>
#include <ricochet/kernels/lane_kernels.hpp>

#include "tests/eigen.hpp"
#include "tests/instruction_sets.hpp"

using namespace ricochet;
using ricochet::testing::instruction_sets;

namespace {

Block random_block(int rows, int lanes, int border, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  Block block(rows, lanes, border);
  for (int i = 0; i < rows; ++i)
    for (int l = 0; l < lanes; ++l) block.at(i, l) = uniform(engine);
  return block;
}

SparseMatrix random_band(int n, int width, bool definite) {
  std::mt19937 engine(static_cast<unsigned>(n * 31 + width));
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<Eigen::Triplet<double>> triplets;
  for (int i = 0; i < n; ++i)
    for (int j = i; j < std::min(n, i + width + 1); ++j) {
      const double value = i == j && definite ? 2.5 * (width + 1) : uniform(engine);
      triplets.emplace_back(i, j, value);
      if (i != j) triplets.emplace_back(j, i, value);
    }
  SparseMatrix matrix(n, n);
  matrix.setFromTriplets(triplets.begin(), triplets.end());
  return matrix;
}

// Weights and lanes for the kernels that combine slots: what they make of lane l, by every kernel in turn. The lanes of
// a shorter block are the first of a longer one.
struct Slots {
  int count = 0, lanes = 1;
  std::vector<Block> x;
  std::vector<double> weight, update, next, coefficient;
  Block z, scale;
  std::vector<int> start = {0, 2, 3, 6}, index = {0, 4, 2, 1, 5, 6};
  std::vector<double> value = {0.5, -1.25, 2, 0.75, 1, -0.3};

  static constexpr int rows = 7;

  Slots(int n, int T, int terms) : count(n), lanes(T), z(rows, T), scale(1, T) {
    const auto number = [](int a, int b, int c) { return std::sin(1.7 * a + 2.3 * b + 0.9 * c + 0.4); };
    for (int j = 0; j < terms; ++j) {
      x.emplace_back(rows, T);
      weight.push_back(number(j, 1, 7));
      next.push_back(number(j, 2, 5));
      for (int i = 0; i < rows; ++i)
        for (int l = 0; l < T; ++l) x.back().at(i, l) = number(i, l, j);
    }
    for (int e = 0; e < count * (count + 1); ++e) update.push_back(number(e, 3, 3));
    for (int e = 0; e < rows * (count + 1); ++e) coefficient.push_back(number(e, 4, 1));
    for (int l = 0; l < T; ++l) {
      scale.at(0, l) = number(1, l, 9);
      for (int i = 0; i < rows; ++i) z.at(i, l) = number(i, l, 11);
    }
  }

  LaneRows matrix() const { return {3, start.data(), index.data(), value.data()}; }

  std::vector<const double*> read() const {
    std::vector<const double*> pointers;
    for (const Block& block : x) pointers.push_back(block.data());
    return pointers;
  }

  // Combination; updated slots; their combination; diagonal step; measure with and without offset, and combination, of
  // one term more.
  std::vector<Block> outcome(const LaneKernels& kernels) const {
    Block combined(rows, lanes), following(rows, lanes), diagonal(rows, lanes), measured(3, lanes), bare(3, lanes),
        whole(rows, lanes);
    kernels.combine(static_cast<long>(z.size()), count, read().data(), next.data(), combined.data());
    kernels.combine(static_cast<long>(z.size()), count + 1, read().data(), weight.data(), whole.data());
    kernels.diagonal_step(rows, count, coefficient.data(), read().data(), scale.data(), diagonal.data());
    kernels.measure(matrix(), count + 1, read().data(), weight.data(), scale.data(), measured.data());
    kernels.measure(matrix(), count + 1, read().data(), weight.data(), nullptr, bare.data());
    Slots with = *this, without = *this;
    for (Slots* one : {&with, &without}) {
      std::vector<double*> slot;
      for (Block& block : one->x) slot.push_back(block.data());
      kernels.update(static_cast<long>(z.size()), count, slot.data(), z.data(), update.data(),
                     one == &with ? next.data() : nullptr, following.data());
    }
    std::vector<Block> all = {combined, following, diagonal, measured, bare, whole};
    for (int j = 0; j < count; ++j) {
      all.push_back(with.x[static_cast<std::size_t>(j)]);
      all.push_back(without.x[static_cast<std::size_t>(j)]);
    }
    return all;
  }

  // The same, term by term, of one lane.
  std::vector<std::vector<double>> expected(int l) const {
    const auto n = static_cast<std::size_t>(count);
    const auto at = [&](const std::vector<double>& w, std::size_t from, std::size_t terms, int i) {
      double sum = 0;
      for (std::size_t j = 0; j < terms; ++j) sum += w[from + j] * x[j].at(i, l);
      return sum;
    };
    std::vector<std::vector<double>> all(6 + 2 * n);
    for (int i = 0; i < rows; ++i) {
      all[0].push_back(at(next, 0, n, i));
      all[5].push_back(at(weight, 0, n + 1, i));
      double sum = 0;
      for (std::size_t j = 0; j < n; ++j) {
        const double fresh = at(update, j * (n + 1), n, i) + update[j * (n + 1) + n] * z.at(i, l);
        all[6 + 2 * j].push_back(fresh);
        all[7 + 2 * j].push_back(fresh);
        sum += next[j] * fresh;
      }
      all[1].push_back(sum);
      const std::size_t from = static_cast<std::size_t>(i) * (n + 1);
      all[2].push_back(at(coefficient, from, n, i) + coefficient[from + n] * scale.at(0, l));
    }
    for (std::size_t r = 0; r < 3; ++r) {
      double sum = 0;
      for (int e = start[r]; e < start[r + 1]; ++e)
        sum += value[static_cast<std::size_t>(e)] * at(weight, 0, n + 1, index[static_cast<std::size_t>(e)]);
      all[3].push_back(sum + scale.at(0, l));
      all[4].push_back(sum);
    }
    return all;
  }
};

/// A step of a band: K and M of one width, S of another, diagonally dominant.
struct BandCase {
  static constexpr int n = 23;
  SparseMatrix K, M, S;
  int T, width;
  bool full;  ///< with M and a load that all lanes have
  BandLdlt ldlt;
  Block k, m, scale;
  std::vector<double> shape, load, bands, masses;

  BandCase(int lanes, int half_width, bool everything)
      : K(random_band(n, half_width, false)),
        M(random_band(n, half_width, false)),
        S(random_band(n, half_width, true)),
        T(lanes),
        width(half_width),
        full(everything),
        k(random_block(n, T, width, 1)),
        m(random_block(n, T, width, 2)),
        scale(random_block(1, T, 0, 3)),
        bands(band_storage(K, width, T == 1)),
        masses(band_storage(M, width, T == 1)) {
    QuasiDefinite matrix;
    matrix.A = S;
    REQUIRE_FALSE(ldlt.factorise(matrix));
    for (int i = 0; i < n; ++i) {
      shape.push_back(std::cos(i));
      load.push_back(std::sin(2 * i));
    }
  }
  Block outcome(const LaneKernels& kernels) const {
    Block b(n, T), z(n, T, ldlt.half_width());
    BandStep step;
    step.rows = n;
    step.product_width = width;
    step.K = bands.data();
    step.k = k.data();
    step.shape = shape.data();
    step.scale = scale.data();
    if (full) {
      step.M = masses.data();
      step.m = m.data();
      step.load = load.data();
    }
    step.b = b.data();
    ldlt.substitute_in(step, z.data());
    kernels.band_step(step);
    return z;
  }
};

}  // namespace

TEST_CASE("a band step solves S z = K k + M m + shape·scale + load") {
  const int T = GENERATE(1, 2, 4, 8, 16, 32), width = GENERATE(0, 1, 2, 3, 5);
  const InstructionSet set = GENERATE(from_range(instruction_sets()));
  const bool full = GENERATE(false, true);
  const BandCase band(T, width, full);
  const Block z = band.outcome(lane_kernels(T, set));
  const int n = BandCase::n;
  const Eigen::MatrixXd dense_K = band.K, dense_M = band.M, dense_S = band.S;
  for (int l = 0; l < T; ++l) {
    Eigen::VectorXd a(n), c(n), rhs(n), found(n);
    for (int i = 0; i < n; ++i) {
      const auto row = static_cast<std::size_t>(i);
      a[i] = band.k.at(i, l);
      c[i] = band.m.at(i, l);
      found[i] = z.at(i, l);
      rhs[i] = band.shape[row] * band.scale.at(0, l) + (full ? band.load[row] : 0);
    }
    rhs += dense_K * a;
    if (full) rhs += dense_M * c;
    // S is diagonally dominant: its condition is a small number.
    CHECK((eigen::ldlt_solve(dense_S, rhs) - found).lpNorm<Eigen::Infinity>() < 1e-13);
  }
}

TEST_CASE("the instruction sets agree to round-off, and updates follow their weights") {
  const int T = GENERATE(1, 4, 32), n = 9;
  for (const bool increments : {false, true}) {
    // The second set of weights is the one that the kernels recognise: q ← q + d + z, d ← d + z.
    const std::vector<double> weights =
        increments ? std::vector<double>{1, 1, 1, 0, 1, 1} : std::vector<double>{0.5, 1, 2, 0.1, -1, 3};
    const std::vector<double> next = {0.3, -0.7};
    const Block q = random_block(n, T, 0, 5), d = random_block(n, T, 0, 6), z = random_block(n, T, 0, 7);
    for (const InstructionSet set : instruction_sets()) {
      Block x = q, y = d, combined(n, T);
      double* slots[] = {x.data(), y.data()};
      lane_kernels(T, set).update(static_cast<long>(x.size()), 2, slots, z.data(), weights.data(), next.data(),
                                  combined.data());
      for (std::size_t e = 0; e < x.size(); ++e) {
        const double new_q = weights[0] * q.data()[e] + weights[1] * d.data()[e] + weights[2] * z.data()[e];
        const double new_d = weights[3] * q.data()[e] + weights[4] * d.data()[e] + weights[5] * z.data()[e];
        REQUIRE(x.data()[e] == Approx(new_q).margin(1e-15));
        REQUIRE(y.data()[e] == Approx(new_d).margin(1e-15));
        REQUIRE(combined.data()[e] == Approx(next[0] * new_q + next[1] * new_d).margin(1e-15));
      }
    }
  }
}

TEST_CASE("one to eight slots are combined, updated, stepped and measured by their weights") {
  const int count = GENERATE(range(1, most_lane_slots + 1)), T = GENERATE(1, 2, 4, 8, 16, 32);
  const InstructionSet set = GENERATE(from_range(instruction_sets()));
  const Slots slots(count, T, count + 1);
  const auto found = slots.outcome(lane_kernels(T, set));
  for (int l = 0; l < T; ++l) {
    const auto expected = slots.expected(l);
    REQUIRE(expected.size() == found.size());
    for (std::size_t k = 0; k < found.size(); ++k)
      for (std::size_t i = 0; i < expected[k].size(); ++i) {
        INFO(count << " slots, " << T << " lanes: outcome " << k << ", row " << i << ", lane " << l);
        // At most 9 · 9 products of numbers below 2.
        REQUIRE(std::abs(found[k].at(static_cast<int>(i), l) - expected[k][i]) < 1e-13);
      }
  }
}

TEST_CASE("a lane does not depend on the other lanes of its block, whatever the number of slots") {
  const int count = GENERATE(range(1, most_lane_slots + 1)), T = GENERATE(2, 4, 8, 16, 32);
  const InstructionSet set = GENERATE(from_range(instruction_sets()));
  const auto alone = Slots(count, 1, count + 1).outcome(lane_kernels(1, set));
  const auto together = Slots(count, T, count + 1).outcome(lane_kernels(T, set));
  for (std::size_t k = 0; k < alone.size(); ++k)
    for (int i = 0; i < alone[k].rows(); ++i) {
      INFO(count << " slots, " << T << " lanes: outcome " << k << ", row " << i);
      REQUIRE(together[k].at(i, 0) == alone[k].at(i, 0));
    }
}

TEST_CASE("a lane's results are bitwise those of AVX2 where vectors are twice as long") {
  if (best_instruction_set() != InstructionSet::avx512) {
    WARN("skipped: this processor has no AVX-512");
    return;
  }
  const int T = GENERATE(1, 2, 4, 8, 16, 32);
  const LaneKernels &narrow = lane_kernels(T, InstructionSet::avx2), &wide = lane_kernels(T, InstructionSet::avx512);
  for (int count = 1; count <= most_lane_slots; ++count) {
    const Slots slots(count, T, count + 1);
    const auto expected = slots.outcome(narrow), found = slots.outcome(wide);
    for (std::size_t k = 0; k < expected.size(); ++k)
      for (int i = 0; i < expected[k].rows(); ++i)
        for (int l = 0; l < T; ++l) REQUIRE(found[k].at(i, l) == expected[k].at(i, l));
  }
  for (const int width : {0, 1, 2, 3, 5, 7})
    for (const bool full : {false, true}) {
      const BandCase band(T, width, full);
      const Block expected = band.outcome(narrow), found = band.outcome(wide);
      for (int i = 0; i < BandCase::n; ++i)
        for (int l = 0; l < T; ++l) REQUIRE(found.at(i, l) == expected.at(i, l));
    }
}

TEST_CASE("a slot without weight changes nothing, also where the loop takes over from what is written out") {
  const int count = GENERATE(range(1, most_lane_slots)), T = GENERATE(1, 2, 4, 8, 16, 32);
  const InstructionSet set = GENERATE(from_range(instruction_sets()));
  const LaneKernels& kernels = lane_kernels(T, set);
  const Slots few(count, T, count + 1);
  Slots more(count + 1, T, count + 2);
  const auto n = static_cast<std::size_t>(count);
  more.weight[n + 1] = more.next[n] = 0;
  more.update.clear();
  more.coefficient.clear();
  for (std::size_t j = 0; j <= n; ++j)
    for (std::size_t s = 0; s <= n + 1; ++s)
      more.update.push_back(j == n || s == n ? 0 : few.update[j * (n + 1) + s - (s > n)]);
  for (std::size_t i = 0; i < Slots::rows; ++i)
    for (std::size_t s = 0; s <= n + 1; ++s)
      more.coefficient.push_back(s == n ? 0 : few.coefficient[i * (n + 1) + s - (s > n)]);
  const auto expected = few.outcome(kernels), found = more.outcome(kernels);
  for (std::size_t k = 0; k < expected.size(); ++k)
    for (int i = 0; i < expected[k].rows(); ++i)
      for (int l = 0; l < T; ++l) {
        INFO(count << " slots and one, " << T << " lanes: outcome " << k << ", row " << i << ", lane " << l);
        REQUIRE(found[k].at(i, l) == expected[k].at(i, l));
      }
}

TEST_CASE("a number of slots that no kernel takes is an error and writes nothing") {
  const int T = GENERATE(1, 4, 32);
  const InstructionSet set = GENERATE(from_range(instruction_sets()));
  const LaneKernels& kernels = lane_kernels(T, set);
  for (const int count : {-1, 0, most_lane_slots + 1, most_lane_slots + 4}) {
    Slots slots(most_lane_slots, T, most_lane_slots + 4);
    std::vector<double*> written;
    for (Block& block : slots.x) written.push_back(block.data());
    const Slots before = slots;
    const std::vector<double> weights(400, 0.5);
    const long size = static_cast<long>(slots.z.size());
    double* z = slots.z.data();
    CHECK_THROWS_AS(kernels.update(size, count, written.data(), z, weights.data(), weights.data(), z),
                    std::logic_error);
    CHECK_THROWS_AS(kernels.update(size, count, written.data(), z, weights.data(), nullptr, nullptr), std::logic_error);
    CHECK_THROWS_AS(
        kernels.diagonal_step(Slots::rows, count, weights.data(), slots.read().data(), slots.scale.data(), z),
        std::logic_error);
    // The unknown may stand beside the slots in a sum.
    const int terms = count <= 0 ? count : count + most_lane_terms - most_lane_slots;
    CHECK_THROWS_AS(kernels.combine(size, terms, slots.read().data(), weights.data(), z), std::logic_error);
    CHECK_THROWS_AS(kernels.measure(slots.matrix(), terms, slots.read().data(), weights.data(), nullptr, z),
                    std::logic_error);
    for (std::size_t j = 0; j <= slots.x.size(); ++j) {
      const Block &now = j < slots.x.size() ? slots.x[j] : slots.z, &then = j < slots.x.size() ? before.x[j] : before.z;
      CHECK(std::equal(now.data(), now.data() + now.size(), then.data()));
    }
  }
}

TEST_CASE("a lane is outside when any of its points is, or is no number") {
  const int T = GENERATE(1, 2, 8, 32);
  const double infinity = std::numeric_limits<double>::infinity();
  for (const InstructionSet set : instruction_sets()) {
    Block y(3, T), lower(3, T), upper(3, T);
    lower.fill(-1);
    upper.fill(infinity);
    const auto& kernels = lane_kernels(T, set);
    CHECK(kernels.outside(3, y.data(), lower.data(), upper.data()) == 0);
    y.at(2, T - 1) = -1;
    CHECK(kernels.outside(3, y.data(), lower.data(), upper.data()) == 0);
    y.at(2, T - 1) = -1.5;
    CHECK(kernels.outside(3, y.data(), lower.data(), upper.data()) == 1u << (T - 1));
    y.at(0, 0) = std::nan("");
    CHECK((kernels.outside(3, y.data(), lower.data(), upper.data()) & 1u) == 1u);
  }
}

TEST_CASE("a quasi-definite system equals its Schur complement, and a singular one is refused") {
  const int n = 12, border = 6;
  QuasiDefinite system;
  system.A = random_band(n, 3, true);
  std::vector<Eigen::Triplet<double>> coupling;
  for (int r = 0; r < border; ++r)
    for (int j = std::max(0, 2 * r - 2); j < std::min(n, 2 * r + 4); ++j)
      coupling.emplace_back(r, j, j == 2 * r ? 1.0 : 0.2);
  system.G = SparseMatrix(border, n);
  system.G.setFromTriplets(coupling.begin(), coupling.end());
  system.Cv = random_band(border, 1, true);
  BandLdlt ldlt;
  REQUIRE_FALSE(ldlt.factorise(system));
  CHECK(ldlt.half_width() == 5);
  const Eigen::MatrixXd A = system.A, G = system.G, Cv = system.Cv;
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(n, -1, 2),
                        expected = eigen::ldlt_solve(A + G.transpose() * eigen::inverse(Cv) * G, b);
  std::vector<int> from = ldlt.order();
  for (int& row : from)
    if (row >= n) row = -1;
  Block z(ldlt.rows(), 1, ldlt.half_width());
  Eigen::VectorXd rhs = b;
  BandStep step;
  ldlt.substitute_in(step, z.data());
  step.from = from.data();
  step.b = rhs.data();
  lane_kernels(1).band_step(step);
  for (int r = 0; r < ldlt.rows(); ++r)
    if (ldlt.order()[static_cast<std::size_t>(r)] < n)
      CHECK(z.data()[r] == Approx(expected[ldlt.order()[static_cast<std::size_t>(r)]]).margin(1e-13));

  QuasiDefinite singular;
  singular.A = SparseMatrix(3, 3);
  singular.A.insert(0, 0) = 1;
  CHECK(ldlt.factorise(singular)->find("singular") != std::string::npos);
}
