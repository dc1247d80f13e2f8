#pragma once
#include <optional>
#include <string>
#include <vector>

#include "runners/asks/evidence.hpp"

/// \file
/// Differences of cases that agree in all else.
namespace ricochet::asks {

/// Two levels of a choice, all else the same.
struct Pair {
  const Point *first = nullptr, *second = nullptr;
  double difference = 0;         ///< second less first, at the finest step and mesh that both have
  double base = 0;               ///< of the first there: what the difference is a share of
  std::optional<double> u = {};  ///< of the difference, as of an Estimate; nothing where it is not known
  std::string unknown = {};      ///< why it is not: "one step: …"
  /// The difference as a share of the first at the same step and mesh, and what is open of that; nothing where the
  /// first is not told from zero.
  std::optional<double> share = {}, share_u = {};
  std::optional<double> u_most = {};      ///< what is open of the difference where a yes or a no is told
  std::optional<double> share_most = {};  ///< what is open of it where a yes or a no is told (Estimate::doubt)
  std::string motion = {};                ///< of what is not settled: "still rises with the step"
  bool identical = false;                 ///< the same to the last bit at each of several sizes, and not nothing
  bool one_limit = false;                 ///< of two schemes that lead to one limit, where the difference is zero
  bool least = false;                     ///< one of the two lies beyond its range: the difference is larger than this
  /// At each of several sizes one is ten times what the other is at any, and it does not fall to zero: they differ
  /// though neither settles.
  bool apart = false;
};

/// What refinement and draws leave of the difference of two points: what moves both alike cancels. Seeds are paired.
/// Nothing where they have no step and mesh in common.
std::optional<Pair> pair_of(const Point& first, const Point& second);

}  // namespace ricochet::asks
