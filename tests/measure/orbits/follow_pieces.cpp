// Branches of the shaken tube: what one method follows, another one marches or solves.
#include <ricochet/measure/orbits/periodic_map.hpp>
#include <ricochet/measure/orbits/special_points.hpp>
#include <ricochet/measure/stability/linear_response.hpp>

#include "tests/measure/orbits/shaken_tube.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

constexpr double round_off = 2e-13;  // m, of a period of some thousand steps

struct Started {
  Started(int steps, bool half, double amplitude) : map(tube_map(steps)), clock{steps, 1, half} {
    orbit = shoot(map, settled_tube(map, amplitude, steps), amplitude, clock, 1e-12);
    REQUIRE(orbit.found);
  }
  PeriodicMap map;
  MapClock clock;
  ShotOrbit orbit;
};

BranchRun run(Started& from, int way, double least, double largest) {
  BranchRun branch(from.map, from.clock,
                   PieceFollower(from.map, from.clock,
                                 branch_start(from.orbit.x, from.orbit.parameter, from.orbit.sets, way), round_off),
                   {least, largest});
  branch.advance(1000000);
  return branch;
}

const SpecialPoint& first_of(const std::vector<SpecialPoint>& points, PointKind kind) {
  const auto found =
      std::find_if(points.begin(), points.end(), [&](const SpecialPoint& one) { return one.kind == kind; });
  REQUIRE(found != points.end());
  return *found;
}

}  // namespace

TEST_CASE("a branch without contact meets its stop where the linear response does") {
  const int steps = 500;
  PeriodicMap map = tube_map(steps);
  const MapClock clock{steps, 1, true};
  const auto x = free_orbit(map, 0.07, clock);
  REQUIRE(x);
  BranchRun branch(
      map, clock,
      PieceFollower(map, clock, branch_start(*x, 0.07, SetSequence(static_cast<std::size_t>(steps) / 2, 0), 1), 1e-13),
      {0.06, 0.12});
  branch.advance(1);
  REQUIRE(branch.trace().corners.size() == 2);
  const double met = branch.trace().corners[1].parameter;
  // Another program: 0.0791790584 m.
  CHECK(met == Approx(0.0791790584).margin(1e-10));
  const Program& program = map.program();
  const auto response = linear_response(*program.problem, program.plan, program.h);
  REQUIRE(response);
  CHECK(std::abs(overlap(*response, map.lanes().lane(met))) < 1e-6);  // peaks between two steps
}

TEST_CASE("the branch of the shaken tube folds and touches where another program says") {
  Started from(2000, true, 0.08);
  SECTION("upwards") {
    const BranchRun branch = run(from, 1, 0.06, 0.1005);
    const auto points = special_points(branch.trace(), {true, 5e-4});
    const SpecialPoint& fold = first_of(points, PointKind::fold);
    CHECK(fold.parameter == Approx(0.1004955).margin(1e-7));
    CHECK(fold.low < fold.parameter);
    CHECK(fold.high > fold.parameter);
  }
  SECTION("down to the first contact") {
    const BranchRun branch = run(from, -1, 0.06, 0.12);
    const auto points = special_points(branch.trace(), {true, 5e-3});
    const auto contact =
        std::find_if(points.begin(), points.end(), [](const SpecialPoint& one) { return one.note == "first contact"; });
    REQUIRE(contact != points.end());
    CHECK(contact->parameter == Approx(0.0791792331).margin(1e-10));
    CHECK(contact->low < contact->parameter);
    // The turn before it, the only one so prominent but the contact itself.
    CHECK(first_of(points, PointKind::fold).parameter == Approx(0.0674790).margin(1e-7));
  }
}

TEST_CASE("every corner of a branch is an orbit of the march") {
  Started from(500, true, 0.08);
  const BranchRun branch = run(from, 1, 0.06, 0.09);
  REQUIRE(branch.trace().corners.size() > 20);
  for (const auto& [number, x] : branch.trace().states) {
    const double parameter = branch.trace().corners[static_cast<std::size_t>(number)].parameter;
    const MapMarch made = from.map.march(x, parameter, from.clock);
    REQUIRE(!made.end);
    CHECK(from.map.metric().size(made.image - x) < 1e-11);
  }
}

TEST_CASE("a branch followed back ends where it began") {
  Started from(500, true, 0.08);
  BranchRun there = run(from, 1, 0.06, 0.09);
  const Eigen::VectorXd end = there.state().x;
  const MapMarch made = from.map.march(end, there.state().parameter, from.clock);
  from.orbit = shoot(from.map, end, there.state().parameter, from.clock, 1e-12);
  REQUIRE(from.orbit.found);
  BranchRun back(from.map, from.clock,
                 PieceFollower(from.map, from.clock,
                               branch_start(from.orbit.x, from.orbit.parameter, from.orbit.sets, -1), round_off),
                 {0.06, 0.09, 200000, there.state().arc + 1e-9});
  back.advance(1000000);
  // The same corners in the other order: neither way knows of the other.
  const auto& a = there.trace().corners;
  const auto& b = back.trace().corners;
  REQUIRE(b.size() >= a.size() - 1);
  for (std::size_t i = 1; i + 1 < a.size(); ++i)
    CHECK(b[i].parameter == Approx(a[a.size() - 1 - i].parameter).margin(1e-10));
}

TEST_CASE("the derivative along a branch is that of its steps, and a follower in its place goes on alike") {
  Started from(500, true, 0.08);
  PieceFollower follower(from.map, from.clock, branch_start(from.orbit.x, from.orbit.parameter, from.orbit.sets, 1),
                         round_off);
  std::optional<PieceFollower> other;
  double apart = 0, size = 0;
  for (long long piece = 1; piece < pieces_updated + 40; ++piece) {
    follower.go(follower.end_of_piece(0.06, 0.2));
    if (other) {
      other->go(other->end_of_piece(0.06, 0.2));
      REQUIRE(other->state().x == follower.state().x);
      REQUIRE(other->derivative() == follower.derivative());
    }
    if (piece == pieces_updated) other.emplace(from.map, from.clock, follower.entry(), round_off);
    const Eigen::MatrixXd made = from.map.derivative(follower.state().sets, from.clock);
    apart = std::max(apart, (made - follower.derivative()).cwiseAbs().maxCoeff());
    size = std::max(size, made.cwiseAbs().maxCoeff());
  }
  REQUIRE(other);
  CHECK(apart > 0);
  // Round-off of as many updates.
  CHECK(apart < 1e-11 * size);
}

TEST_CASE("turns are paired from the smallest on") {
  BranchTrace trace;
  const std::vector<double> path = {0, 1, 0.5, 0.6, 0.2, 2};
  for (std::size_t i = 0; i < path.size(); ++i) {
    BranchCorner corner;
    corner.parameter = path[i];
    corner.way = i + 1 < path.size() && path[i + 1] < path[i] ? -1 : 1;
    trace.corners.push_back(corner);
  }
  const std::vector<Turn> turns = turns_of(trace);
  REQUIRE(turns.size() == 4);
  CHECK(turns[0].prominence == Approx(0.8));  // 1 and 0.2, once 0.5 and 0.6 are gone
  CHECK(turns[1].prominence == Approx(0.1));
  CHECK(turns[2].prominence == Approx(0.1));
  CHECK(turns[3].prominence == Approx(0.8));
}

TEST_CASE("runs of contact are counted round the end of a map") {
  PeriodicMap map = tube_map(100, 4);
  const int lower = map.sets().number({{map.sets().place(0).stage, 0, false}}),
            upper = map.sets().number({{map.sets().place(0).stage, 0, true}});
  const SetSequence sets = {lower, lower, 0, 0, upper, 0, 0, lower};
  const ContactRuns whole = contact_runs(map.sets(), sets, false);
  CHECK(whole.count == 2);
  CHECK(whole.shortest == 1);
  // Half a period later the sides change: what ends below begins above.
  const ContactRuns half = contact_runs(map.sets(), {upper, 0, 0, 0, lower, lower, 0, lower}, true);
  CHECK(half.count == 2);
  CHECK(half.shortest == 2);
}

TEST_CASE("the half-step rule is continuous where a change moves from step to step") {
  Started from(500, true, 0.08);
  const BranchRun branch = run(from, 1, 0.06, 0.0808);
  const auto& corners = branch.trace().corners;
  REQUIRE(corners.size() > 3);
  double raw = 0, smooth = 0;
  for (std::size_t i = 2; i + 1 < corners.size(); ++i) {
    if (corners[i].runs != corners[i - 1].runs) continue;
    raw = std::max(raw, std::abs(corners[i].raw.modulus - corners[i - 1].raw.modulus));
    smooth = std::max(smooth, std::abs(corners[i].smooth.modulus - corners[i - 1].smooth.modulus));
  }
  CHECK(smooth < raw);
}

TEST_CASE("multipliers by the half-step rule do not depend on where the period begins") {
  for (const bool half : {false, true}) {
    Started from(500, half, 0.08);
    std::vector<PeriodicMap::Column> column = {{from.orbit.x, 0.08, false}};
    PeriodicMap::Measures measures;
    SetSequence sets = from.orbit.sets;
    from.map.sweep(sets, from.clock, column, &measures);
    const auto rows = static_cast<std::ptrdiff_t>(from.map.sets().measure_rows());
    const auto mirrored = [&](int number) {
      ContactSet closed = from.map.sets()[number].closed;
      for (SetPoint& one : closed) one.upper = !one.upper;
      return from.map.sets().number(closed);
    };
    const auto multiplier = [&] {
      const Eigen::MatrixXd frozen = from.map.derivative(sets, from.clock);
      return multipliers_of(half_step_derivative(from.map, frozen, sets, from.clock, 0.08, measures)).front();
    };
    const std::complex<double> expected = multiplier();
    int changes = 0;
    for (std::size_t k = 0; k < from.orbit.sets.size(); ++k) {
      // One step later: what was the first step is the last one, of a half map with the sides exchanged.
      std::rotate(sets.begin(), sets.begin() + 1, sets.end());
      std::rotate(measures.value.begin(), measures.value.begin() + rows, measures.value.end());
      if (half) {
        sets.back() = mirrored(sets.back());
        for (auto value = measures.value.end() - rows; value != measures.value.end(); ++value) *value = -*value;
      }
      const bool same = sets.front() == (half ? mirrored(sets.back()) : sets.back());
      if (same) continue;
      ++changes;
      CHECK(std::abs(multiplier() - expected) < 1e-8 * std::abs(expected));
    }
    CHECK(changes > 1);
  }
}

TEST_CASE("a branch that begins beyond the range ends at once") {
  Started from(500, true, 0.08);
  CHECK(run(from, 1, 0.07, 0.079).trace().end == "the range ends at 0.08");
}

TEST_CASE("each special point has a state of its branch at its corner") {
  // The half-step rule crosses the circle there between two corners that have the same frozen multipliers outside.
  Started from(8000, true, 0.08);
  const BranchRun branch = run(from, 1, 0.07, 0.0926);
  for (const SpecialPoint& point : special_points(branch.trace(), {true, 1e-5})) {
    INFO(word(point.kind) << " at " << point.parameter);
    CHECK(branch.trace().states.contains(point.corner));
  }
}
