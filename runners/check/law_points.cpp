#include <fmt/format.h>

#include "runners/check/law_checks.hpp"

namespace ricochet::checking {
namespace {

constexpr int points = 3, lanes = 2;

std::vector<Parameters> copies(const Law& law) {
  return std::vector<Parameters>(static_cast<std::size_t>(points * lanes), law.set.values);
}

std::vector<LaneProblem> apart_lanes(std::mt19937& random) {
  std::vector<LaneProblem> out;
  for (int l = 0; l < lanes; ++l) out.push_back(random_lane(random, points, l == 1));
  return out;
}

}  // namespace

Verdict points_have_own_sets(const Law& law) {
  LawBench together(law, points, lanes);
  if (together.law().absent() || !together.law().per_point()) return not_declared("one set of parameters per lane");
  if (together.law().changes_problem()) return fails("has a set for each point, and changes the problem by one");
  LawBench single(law, 1, 1);
  if (is_barrier(single)) return fine("it has no force beyond its stop, where this is asked");
  std::mt19937 random(20261126);
  DenseDelassus W = random_delassus(random, points, flexibility_of(law));
  const std::vector<LaneProblem> problems = apart_lanes(random);
  LawBench apart(law, points, lanes);
  apart.law().prepare_points(points, lanes, copies(law));
  for (LawBench* bench : {&together, &apart}) bench->solve(W, 1, 1, problems, {0, 1});
  for (int l = 0; l < lanes; ++l)
    if (together.effort(l) != apart.effort(l))
      return fails("equal sets for all points give other efforts than one set for the lane");
  const std::string key = together.law().parameter_of(ParameterRole::stiffness);
  if (key.empty()) return fine("equal sets give the same bits");
  // Where no effort moves a measure, each point is alone with its set.
  constexpr int changed = 1;
  std::vector<Parameters> sets = copies(law);
  Law stiffer = law;
  stiffer.set.values.set(key, 3 * law.set.values.real(key));
  for (int l = 0; l < lanes; ++l) sets[static_cast<std::size_t>(changed * lanes + l)] = stiffer.set.values;
  LawBench one(law, points, lanes), other(stiffer, points, lanes);
  apart.law().prepare_points(points, lanes, sets);
  for (LawBench* bench : {&one, &other, &apart}) bench->solve(W, 0, 0, problems, {0, 1});
  for (int l = 0; l < lanes; ++l)
    for (int i = 0; i < points; ++i)
      if (apart.effort(l)[i] != (i == changed ? other : one).effort(l)[i])
        return fails(fmt::format("the set of point {} of lane {} is not the one that it is given", i, l));
  return fine("each point has its own");
}

}  // namespace ricochet::checking
