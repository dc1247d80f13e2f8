#pragma once
#include <cstddef>
#include <vector>

/// \file
/// Where bodies that meet at stops are drawn: a study gives each its own x, and none a place among the others.
namespace ricochet {

/// What a body looks like. Its x, m, goes from `first` over `length`; one that moves along its axis is `along`.
struct BodyShape {
  double first = 0, length = 0;
  bool along = false;
};

/// Two bodies at a stop, and where each has it, m. `below`: the first goes upwards to close it.
struct BodyMeeting {
  std::size_t at = 0, to = 0;
  double at_x = 0, to_x = 0;
  bool below = true;
};

/// x of a body is drawn at x + shift, m, in the row `row`, from 0 upwards.
struct BodyPlace {
  double shift = 0;
  int row = 0;
};

/// Bodies so that the first stop of each with those before it stands across from its partner, the one that goes upwards
/// in the row beneath. Bodies that would overlap in a row take others; bodies that meet none stand above all.
std::vector<BodyPlace> body_places(const std::vector<BodyShape>& bodies, const std::vector<BodyMeeting>& meetings);

/// Whether every body moves along its axis: then rows go to the right, and each holds one.
bool all_along(const std::vector<BodyShape>& bodies);

}  // namespace ricochet
