#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "runners/check/bench.hpp"
#include "runners/check/law_checks.hpp"

namespace ricochet::checking {

double barrier_of(const Law& law) {
  LawBench bench(law, 1, 1);
  return is_barrier(bench) ? bench.layer() : 0;
}

double reach_of(const Law& law) {
  return barrier_of(law) > 0 ? 0.0 : 1.0;
}

std::vector<LaneProblem> random_lanes(std::mt19937& random, int points, double barrier) {
  std::vector<LaneProblem> lanes;
  for (int l = 0; l < lanes_of_block; ++l) {
    LaneProblem lane = random_lane(random, points, l % 2 == 1);
    if (barrier > 0)
      for (int i = 0; i < points; ++i) lane.before[i] = lane.free[i] = lane.lower[i] - barrier * (0.2 + 0.15 * (i % 5));
    lanes.push_back(std::move(lane));
  }
  return lanes;
}

Verdict lanes_are_independent(const Law& law) {
  if (law.make()->absent()) return not_applicable(no_contact_at_all);
  std::mt19937 random(20240614);
  const double flexibility = flexibility_of(law);
  for (const int points : {1, 3, 10}) {
    LawBench together(law, points, lanes_of_block), alone(law, points, 1), partly(law, points, lanes_of_block);
    together.remember(true);
    // Twice, so that each lane has something of its own to remember.
    for (int round = 0; round < 2; ++round) {
      DenseDelassus W = random_delassus(random, points, flexibility);
      const std::vector<LaneProblem> lanes = random_lanes(random, points, barrier_of(law));
      const std::vector<double> before = together.memory();
      together.solve(W, reach_of(law), reach_of(law), lanes, {0, 1, 2, 3});
      for (int l = 0; l < lanes_of_block; ++l) {
        alone.keep(together.of_lane(before, l));
        alone.solve(W, reach_of(law), reach_of(law), {lanes[static_cast<std::size_t>(l)]}, {0});
        partly.keep(before);
        partly.solve(W, reach_of(law), reach_of(law), lanes, {l});
        if (const std::vector<double> kept = together.of_lane(together.memory(), l);
            kept != alone.memory() || kept != partly.of_lane(partly.memory(), l))
          return fails(
              fmt::format("{} points: what is kept of lane {} is other than when it is solved alone", points, l));
        const Eigen::VectorXd p = together.effort(l);
        if (p != alone.effort(0) || p != partly.effort(l))
          return fails(fmt::format(
              "{} points: lane {} of {} gets {:.17g} N at its first point, and {:.17g} N when it is "
              "solved alone: lanes must not know of each other",
              points, l, lanes_of_block, p[0], p != alone.effort(0) ? alone.effort(0)[0] : partly.effort(l)[0]));
      }
    }
  }
  return fine("bitwise equal alone and beside others");
}

Verdict untouched_lanes_are_left_alone(const Law& law) {
  if (law.make()->absent()) return not_applicable(no_contact_at_all);
  constexpr double kept = 1e-3;  // some number, of each memory
  std::mt19937 random(20240615);
  const double flexibility = flexibility_of(law);
  for (const int points : {1, 3}) {
    LawBench bench(law, points, lanes_of_block);
    DenseDelassus W = random_delassus(random, points, flexibility);
    std::vector<LaneProblem> lanes = random_lanes(random, points, barrier_of(law));
    for (const int l : {0, 2}) lanes[static_cast<std::size_t>(l)].effort.setConstant(7.25 + l);
    bench.keep(std::vector<double>(bench.memory().size(), kept));
    bench.solve(W, reach_of(law), reach_of(law), lanes, {1, 3});
    for (const int l : {0, 2}) {
      for (int i = 0; i < points; ++i)
        for (const double number : bench.of_point(bench.memory(), i, l))
          if (number != kept)
            return fails(
                fmt::format("writes what is kept of lane {}, which is not in `touched` (1 and 3 of 4 are)", l));
      if (bench.effort(l) != lanes[static_cast<std::size_t>(l)].effort)
        return fails(fmt::format("writes the effort of lane {}, which is not in `touched` (1 and 3 of 4 are)", l));
      const LaneOutcome& outcome = bench.outcome(l);
      if (!outcome.converged || outcome.iterations != 0 || outcome.residual != 0 || outcome.dissipation != 0)
        return fails(fmt::format("writes the outcome of lane {}, which is not in `touched` (1 and 3 of 4 are)", l));
    }
  }
  return fine();
}

namespace {

// A further value of a parameter for the lane `which`, unlike those of the lanes beside it where there are as many.
ParameterValue unlike(const ParameterSpec& spec, const ParameterValue& value, int which) {
  const auto turn = static_cast<std::size_t>(which);
  if (spec.type == ParameterSpec::Type::word) return spec.words[turn % spec.words.size()];
  if (spec.type == ParameterSpec::Type::boolean) return which % 2 == 0;
  if (spec.type == ParameterSpec::Type::table) return value;
  const Range& range = spec.range;
  const bool bounded = std::isfinite(range.low) && std::isfinite(range.high);
  constexpr std::array<double, lanes_of_block> shares = {0.3, 0.8, 0.45, 0.65}, factors = {1, 3, 0.5, 1.7};
  const auto* whole = std::get_if<long long>(&value);
  const double base = whole ? static_cast<double>(*whole) : std::get<double>(value);
  const double x = bounded     ? range.low + shares[turn] * (range.high - range.low)
                   : base == 0 ? range.contains(factors[turn]) ? factors[turn] : -factors[turn]
                               : base * factors[turn];
  ParameterValue result = x;
  if (whole) result = std::llround(x);
  return check_parameter(spec, result) ? value : result;
}

// One set for each lane; parameters that lanes must share are those of the law. Empty where they must share all.
std::vector<Law> unlike_laws(const Law& law) {
  std::vector<Law> laws(lanes_of_block, law);
  bool any = false;
  for (const ParameterSpec& spec : law.entry->manual.parameters) {
    if (!spec.per_lane) continue;
    any = true;
    for (int l = 0; l < lanes_of_block; ++l)
      laws[static_cast<std::size_t>(l)].set.values.set(spec.key, unlike(spec, law.set.values.values().at(spec.key), l));
  }
  if (!any) laws.clear();
  for (Law& one : laws) one.set = parameter_set(law.entry->manual.parameters, one.set.values);
  return laws;
}

bool same(const ContactSlopes& a, const ContactSlopes& b) {
  return a.stiffness == b.stiffness && a.viscosity == b.viscosity && a.before == b.before;
}

// What a law tells of a lane, "" where it is what the law of this lane alone tells.
std::string told_otherwise(const LawBench& together, int lane, const LawBench& alone, int points) {
  if (together.law().layer(lane) != alone.law().layer(0)) return "layer()";
  const auto mine = together.law().linear_slopes(lane), own = alone.law().linear_slopes(0);
  if (mine.has_value() != own.has_value() || (mine && !same(*mine, *own))) return "linear_slopes()";
  for (const int side : {-1, 1})
    for (const double depth : {1e-4, 1e-2}) {
      StopState state{.depth = alone.law().layer(0) > 0 ? -0.3 * alone.law().layer(0) : depth, .side = side};
      const double stored = alone.law().potential(state);
      state.set = lane;
      if (together.law().potential(state) != stored) return "potential()";
    }
  for (int i = 0; i < points; ++i) {
    if (together.effort(lane)[i] != alone.effort(0)[i]) return "solve()";
    if (together.law().offers_slopes() && alone.effort(0)[i] != 0 &&
        !same(together.law().slopes(i, lane), alone.law().slopes(i, 0)))
      return "slopes()";
    if (together.of_point(together.memory(), i, lane) != alone.of_point(alone.memory(), i, 0)) return "memory";
  }
  const LaneOutcome &mine_ended = together.outcome(lane), &own_ended = alone.outcome(0);
  if (mine_ended.dissipation != own_ended.dissipation || mine_ended.converged != own_ended.converged)
    return "the outcome";
  return {};
}

std::vector<Parameters> sets_of(const std::vector<Law>& laws) {
  std::vector<Parameters> sets;
  for (const Law& law : laws) sets.push_back(law.set.values);
  return sets;
}

}  // namespace

Verdict unlike_lanes_are_their_own(const Law& law) {
  if (law.make()->absent()) return not_applicable(no_contact_at_all);
  const std::vector<Law> laws = unlike_laws(law);
  if (laws.empty()) return not_declared("lanes of a block share all parameters");
  if (law.make()->changes_problem())
    return fails("its parameters may differ between lanes, and it changes the problem by them");
  double barrier = barrier_of(law);
  for (const Law& other : laws) barrier = std::min(barrier, barrier_of(other));
  const double flexibility = flexibility_of(law);
  std::mt19937 random(20261127);
  for (const int points : {1, 3}) {
    DenseDelassus W = random_delassus(random, points, flexibility);
    const std::vector<LaneProblem> lanes = random_lanes(random, points, barrier);
    // Prepared for all alike before: a lane may be given other parameters.
    LawBench together(law, points, lanes_of_block);
    for (const bool backwards : {true, false}) {
      std::vector<Law> order = laws;
      if (backwards) std::reverse(order.begin(), order.end());
      together.law().prepare(points, sets_of(order));
      together.remember(false);
      together.solve(W, reach_of(law), reach_of(law), lanes, {0, 1, 2, 3});
      for (int l = 0; l < lanes_of_block; ++l) {
        const Law& own = order[static_cast<std::size_t>(l)];
        LawBench alone(own, points, 1);
        alone.solve(W, reach_of(law), reach_of(law), {lanes[static_cast<std::size_t>(l)]}, {0});
        if (const std::string what = told_otherwise(together, l, alone, points); !what.empty())
          return fails(
              fmt::format("{} of lane {} is not that of its own parameters ({}), beside lanes of others: "
                          "{:.10g} N at its first point, {:.10g} N alone",
                          what, l, own.set.text, together.effort(l)[0], alone.effort(0)[0]));
      }
    }
  }
  return fine("lanes of unlike parameters are bitwise those of each alone");
}

namespace {

constexpr int own_points = 3, own_lanes = 2;

std::vector<Parameters> copies(const Law& law) {
  return std::vector<Parameters>(static_cast<std::size_t>(own_points * own_lanes), law.set.values);
}

std::vector<LaneProblem> apart_lanes(std::mt19937& random) {
  std::vector<LaneProblem> out;
  for (int l = 0; l < own_lanes; ++l) out.push_back(random_lane(random, own_points, l == 1));
  return out;
}

}  // namespace

Verdict points_have_own_sets(const Law& law) {
  LawBench together(law, own_points, own_lanes);
  if (together.law().absent() || !together.law().per_point()) return not_declared("one set of parameters per lane");
  if (together.law().changes_problem()) return fails("has a set for each point, and changes the problem by one");
  LawBench single(law, 1, 1);
  if (is_barrier(single)) return fine("it has no force beyond its stop, where this is asked");
  std::mt19937 random(20261126);
  DenseDelassus W = random_delassus(random, own_points, flexibility_of(law));
  const std::vector<LaneProblem> problems = apart_lanes(random);
  LawBench apart(law, own_points, own_lanes);
  apart.law().prepare_points(own_points, own_lanes, copies(law));
  for (LawBench* bench : {&together, &apart}) bench->solve(W, 1, 1, problems, {0, 1});
  for (int l = 0; l < own_lanes; ++l)
    if (together.effort(l) != apart.effort(l))
      return fails("equal sets for all points give other efforts than one set for the lane");
  std::string found = "equal sets give bitwise equal efforts";
  for (const ParameterRole role : {ParameterRole::stiffness, ParameterRole::damping}) {
    const std::string key = together.law().parameter_of(role);
    if (key.empty() || law.set.values.real(key) == 0) continue;
    // Where no effort moves a measure, each point is alone with its set.
    std::vector<Parameters> sets;
    for (std::size_t k = 0; k < copies(law).size(); ++k) {
      sets.push_back(law.set.values);
      sets.back().set(key, law.set.values.real(key) * (1 + 0.3 * static_cast<double>(k)));
    }
    apart.law().prepare_points(own_points, own_lanes, sets);
    apart.solve(W, 0, 0, problems, {0, 1});
    for (std::size_t k = 0; k < sets.size(); ++k) {
      Law own = law;
      own.set.values = sets[k];
      LawBench one(own, own_points, own_lanes);
      one.solve(W, 0, 0, problems, {0, 1});
      const int set = static_cast<int>(k), i = set / own_lanes, l = set % own_lanes;
      const StopState at{.depth = 1e-3, .set = set};
      if (apart.effort(l)[i] != one.effort(l)[i] || apart.law().layer(set) != one.law().layer(l) ||
          apart.law().potential(at) != one.law().potential({.depth = 1e-3, .set = l}))
        return fails(fmt::format("the {} of point {} of lane {} is not the one that it is given", key, i, l));
    }
    found = "each point has its own";
  }
  return fine(found);
}

}  // namespace ricochet::checking
