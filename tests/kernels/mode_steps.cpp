// Steps by modes: z and the update bit by bit those of the kernels that they stand for, the measure to round-off. Lanes
// do not depend on their number, nor a run of steps on how many are made at once.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <ricochet/kernels/block.hpp>
#include <ricochet/kernels/lane_kernels.hpp>
#include <vector>

#include "tests/instruction_sets.hpp"

using namespace ricochet;
using ricochet::testing::instruction_sets;

namespace {

double entry(int a, int b, int c) {
  return std::sin(1.7 * a + 2.3 * b + 0.9 * c + 0.4);
}

// Modes that a point reads, as a block of T lanes has them.
struct ModeNumbers {
  Block storage;
  Modes modes;
  ModeNumbers(int rows, int T) : storage(Modes::numbers * ((rows + 7) / 8 * 8), 1) {
    const int padded = (rows + 7) / 8 * 8;
    for (int i = 0; i < rows; ++i)
      for (int s = 0; s < Modes::numbers; ++s)
        storage.at(T == 1 ? s * padded + i : Modes::numbers * i + s, 0) = 0.4 * entry(i, s, 9);
    modes = {rows, storage.data(), 0.3};
  }
};

// `T` lanes, or one of them alone.
struct Lanes {
  int rows, T;
  Block q, d, last, z, scale, offset, lower, upper, y, effort, column;
  std::uint32_t outside = 0;

  Lanes(int modes, int width, int steps = 0)
      : rows(modes),
        T(width),
        q(modes, width),
        d(modes, width),
        last(modes, width),
        z(modes, width),
        scale(steps + 1, width),
        offset(steps + 1, width),
        lower(1, width),
        upper(1, width),
        y(1, width),
        effort(1, width),
        column((modes + 7) / 8 * 8, 1) {
    lower.fill(-2.5);
    upper.fill(2.5);
    for (int i = 0; i < modes; ++i) column.at(i, 0) = entry(i, 1, 7);
  }
  void fill(int first) {
    for (int l = 0; l < T; ++l) {
      for (int i = 0; i < rows; ++i) {
        q.at(i, l) = entry(i, first + l, 1);
        d.at(i, l) = entry(i, first + l, 2);
        last.at(i, l) = entry(i, first + l, 3);
      }
      for (int s = 0; s < scale.rows(); ++s) {
        scale.at(s, l) = entry(s, first + l, 5);
        offset.at(s, l) = entry(s, first + l, 6);
      }
      effort.at(0, l) = (first + l) % 2 ? entry(0, first + l, 8) : 0.0;
    }
  }
};

bool same(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

// Lane l of `many` against the only one of `alone`.
void require_same(const Lanes& many, int l, const Lanes& alone) {
  for (int i = 0; i < many.rows; ++i) {
    INFO(many.T << " lanes, mode " << i << ", lane " << l);
    REQUIRE(same(many.q.at(i, l), alone.q.at(i, 0)));
    REQUIRE(same(many.d.at(i, l), alone.d.at(i, 0)));
    REQUIRE(same(many.z.at(i, l), alone.z.at(i, 0)));
  }
  REQUIRE(same(many.y.at(0, l), alone.y.at(0, 0)));
  REQUIRE((many.outside >> l & 1U) == alone.outside);
}

void step(const LaneKernels& kernels, const Modes& modes, Lanes& lanes, bool updates, bool tests, int s = 0) {
  double* slots[] = {lanes.q.data(), lanes.d.data()};
  const IncrementUpdate update{slots, lanes.last.data(), {}};
  PointTest test;
  test.offset = lanes.offset.row(s);
  test.lower = lanes.lower.data();
  test.upper = lanes.upper.data();
  test.y = lanes.y.data();
  ModeStep made;
  made.modes = modes;
  made.x = slots;
  made.scale = lanes.scale.row(s);
  made.z = lanes.z.data();
  if (updates) made.update = &update;
  if (tests) made.test = &test;
  kernels.mode_step(made);
  lanes.outside = test.outside;
}

}  // namespace

TEST_CASE("z of a step by modes is bitwise that of a diagonal one, and lanes do not depend on their number") {
  const int T = GENERATE(1, 2, 4, 8, 16, 32), rows = GENERATE(1, 4, 13, 14, 16, 23);
  const bool updates = GENERATE(false, true);
  for (const InstructionSet set : instruction_sets()) {
    const LaneKernels& kernels = lane_kernels(T, set);
    const ModeNumbers numbers(rows, T), single(rows, 1);
    Lanes many(rows, T), apart(rows, T);
    many.fill(0);
    apart.fill(0);
    if (T > 1) many.q.at(0, T - 1) = apart.q.at(0, T - 1) = std::numeric_limits<double>::quiet_NaN();
    step(kernels, numbers.modes, many, updates, true);
    double* slots[] = {apart.q.data(), apart.d.data()};
    const double increments[] = {1, 1, 1, 0, 1, 1};
    if (updates)
      kernels.update(static_cast<long>(apart.q.size()), 2, slots, apart.last.data(), increments, nullptr, nullptr);
    std::vector<double> three;
    for (int i = 0; i < rows; ++i)
      for (int s = 0; s < 3; ++s) three.push_back(0.4 * entry(i, s, 9));
    kernels.diagonal_step(rows, 2, three.data(), slots, apart.scale.data(), apart.z.data());
    for (int l = 0; l < T; ++l) {
      double y = apart.offset.at(0, l) + 0.3 * apart.scale.at(0, l), terms = 1;
      for (int i = 0; i < rows; ++i) {
        REQUIRE(same(many.z.at(i, l), apart.z.at(i, l)));
        REQUIRE(same(many.q.at(i, l), apart.q.at(i, l)));
        const double one = 0.4 * entry(i, 3, 9) * apart.q.at(i, l), other = 0.4 * entry(i, 4, 9) * apart.d.at(i, l);
        y += one + other;
        terms += std::abs(one) + std::abs(other);
      }
      // Some thirty roundings of terms of this size.
      if (!std::isnan(y)) CHECK(many.y.at(0, l) == Approx(y).margin(1e-14 * terms));
      CHECK(std::isnan(many.y.at(0, l)) == std::isnan(y));
      if (std::isnan(y)) continue;
      Lanes alone(rows, 1);
      alone.fill(l);
      step(lane_kernels(1, set), single.modes, alone, updates, true);
      require_same(many, l, alone);
    }
  }
}

TEST_CASE("a run of steps by modes is bitwise steps one by one, up to the first beyond a bound") {
  const int T = GENERATE(1, 2, 8, 16, 32), rows = GENERATE(3, 12, 21);
  const bool pushed = GENERATE(false, true);
  constexpr int steps = 9;
  const double bound = GENERATE(1e12, 1.0);
  for (const InstructionSet set : instruction_sets()) {
    const LaneKernels& kernels = lane_kernels(T, set);
    const ModeNumbers numbers(rows, T);
    Lanes apart(rows, T, steps), together(rows, T, steps);
    for (Lanes* one : {&apart, &together}) {
      one->fill(0);
      one->lower.fill(-bound);
      one->upper.fill(bound);
    }
    ModeRun run;
    run.modes = numbers.modes;
    run.x[0] = together.q.data();
    run.x[1] = together.d.data();
    run.scale = together.scale.data();
    run.offset = together.offset.data();
    run.lower = together.lower.data();
    run.upper = together.upper.data();
    run.y = together.y.data();
    run.column = together.column.data();
    // The test of the first alone.
    kernels.mode_run(run);
    step(kernels, numbers.modes, apart, false, true);
    for (int l = 0; l < T; ++l) REQUIRE(same(run.y[l], apart.y.at(0, l)));
    REQUIRE(run.outside == apart.outside);
    run.steps = steps;
    if (pushed) run.effort = together.effort.data();
    const int made = kernels.mode_run(run);
    int s = 0;
    do {
      if (pushed && s == 0) kernels.add_column(rows, apart.column.data(), apart.effort.data(), apart.z.data());
      std::copy_n(apart.z.data(), apart.z.size(), apart.last.data());
      step(kernels, numbers.modes, apart, true, true, ++s);
    } while (s < steps && apart.outside == 0);
    REQUIRE(made == s);
    CHECK((bound < 2 || made == steps));
    if (bound < 2 && T == 32) CHECK(made < steps);
    for (int l = 0; l < T; ++l) {
      REQUIRE(same(run.y[l], apart.y.at(0, l)));
      for (int i = 0; i < rows; ++i) {
        REQUIRE(same(together.q.at(i, l), apart.q.at(i, l)));
        REQUIRE(same(together.d.at(i, l), apart.d.at(i, l)));
      }
    }
    REQUIRE(run.outside == apart.outside);
  }
}
