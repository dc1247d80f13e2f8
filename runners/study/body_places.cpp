#include "runners/study/body_places.hpp"

#include <algorithm>

namespace ricochet {

bool all_along(const std::vector<BodyShape>& bodies) {
  return std::all_of(bodies.begin(), bodies.end(), [](const BodyShape& one) { return one.along; });
}

std::vector<BodyPlace> body_places(const std::vector<BodyShape>& bodies, const std::vector<BodyMeeting>& meetings) {
  std::vector<BodyPlace> out(bodies.size());
  std::vector<std::size_t> placed;
  const bool one_in_a_row = all_along(bodies);
  double longest = 0;
  for (const BodyShape& one : bodies) longest = std::max(longest, one.length);
  const double apart = 0.05 * longest;  // m, between bodies of a row
  const auto put = [&](std::size_t body, BodyPlace place, int step) {
    const auto from = [&](std::size_t b, double shift) { return bodies[b].first + shift - apart; };
    const auto covered = [&](std::size_t other) {
      return out[other].row == place.row &&
             (one_in_a_row || (from(body, place.shift) < from(other, out[other].shift) + bodies[other].length + apart &&
                               from(other, out[other].shift) < from(body, place.shift) + bodies[body].length + apart));
    };
    while (std::any_of(placed.begin(), placed.end(), covered)) place.row += step;
    out[body] = place;
    placed.push_back(body);
  };
  const auto has = [&](std::size_t body) { return std::find(placed.begin(), placed.end(), body) != placed.end(); };
  const auto join = [&] {
    for (const BodyMeeting& one : meetings) {
      const int up = one.below ? 1 : -1;
      if (has(one.at) == has(one.to)) continue;
      if (has(one.at))
        put(one.to, {out[one.at].shift + one.at_x - one.to_x, out[one.at].row + up}, up);
      else
        put(one.at, {out[one.to].shift + one.to_x - one.at_x, out[one.to].row - up}, -up);
      return true;
    }
    return false;
  };
  for (std::size_t body = 0; body < bodies.size(); ++body) {
    if (has(body)) continue;
    int top = -1;
    for (const std::size_t other : placed) top = std::max(top, out[other].row);
    put(body, {-bodies[body].first, top + 1}, 1);
    while (join()) continue;
  }
  int lowest = 0;
  for (const BodyPlace& one : out) lowest = std::min(lowest, one.row);
  for (BodyPlace& one : out) one.row -= lowest;
  return out;
}

}  // namespace ricochet
