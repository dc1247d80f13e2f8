#pragma once
#include <algorithm>

namespace ricochet {

/// Runs of steps in which a point is closed by one stop, over the steps of a map, round its end.
struct ContactRuns {
  int count = 0, shortest = 0;
  void add(long long length) {
    ++count;
    shortest = shortest == 0 ? static_cast<int>(length) : std::min(shortest, static_cast<int>(length));
  }
};

/// Calls run(begin, length) for each run of one point over n steps: side(k) in step k, 0 open, −1 or 1 closed. Before
/// the first step stand those of the last one, of a half map with the sides exchanged; a run may go beyond n.
template <class Side, class Run>
void each_run(long long n, bool half, const Side& side, const Run& run) {
  const int turned = half ? -1 : 1;
  const auto at = [&](long long k) { return k < 0 ? turned * side(k + n) : k < n ? side(k) : turned * side(k - n); };
  bool any = false;
  for (long long k = 0; k < n; ++k) {
    if (side(k) == 0 || side(k) == at(k - 1)) continue;
    long long end = k + 1;
    while (end < k + n && at(end) == side(k)) ++end;
    run(k, end - k);
    any = true;
    k = std::min(end, n) - 1;
  }
  if (!any && n > 0 && side(0) != 0) run(0, n);  // closed all the time
}

}  // namespace ricochet
