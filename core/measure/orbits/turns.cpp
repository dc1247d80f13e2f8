#include <algorithm>
#include <ricochet/measure/orbits/special_points.hpp>

namespace ricochet {
namespace {

// Turning points of λ, and what cuts a way off: the ends of the path, and where the motion first touches a stop.
struct Path {
  std::vector<double> value;
  std::vector<char> cut;
  std::vector<long long> corner;  // of the trace; −1: it is none of its turns
  void add(double parameter, bool cuts, long long at) {
    value.push_back(parameter);
    cut.push_back(cuts);
    corner.push_back(at);
  }
};

bool turns_at(const std::vector<BranchCorner>& corners, std::size_t i) {
  return i > 0 && i + 1 < corners.size() && corners[i].way != corners[i - 1].way;
}

bool first_contact_at(const std::vector<BranchCorner>& corners, std::size_t i) {
  return i > 0 && (corners[i].runs == 0) != (corners[i - 1].runs == 0);
}

Path path_of(const BranchTrace& trace, const BranchTrace* before) {
  Path path;
  const auto kept = [](const std::vector<BranchCorner>& corners, std::size_t i) {
    return turns_at(corners, i) || first_contact_at(corners, i);
  };
  if (before && !before->corners.empty()) {
    const auto& corners = before->corners;
    path.add(corners.back().parameter, true, -1);
    for (std::size_t i = corners.size() - 1; i-- > 1;)
      if (kept(corners, i)) path.add(corners[i].parameter, first_contact_at(corners, i), -1);
  }
  const auto& corners = trace.corners;
  path.add(corners.front().parameter, !before, -1);
  for (std::size_t i = 1; i + 1 < corners.size(); ++i)
    if (kept(corners, i))
      path.add(corners[i].parameter, first_contact_at(corners, i),
               turns_at(corners, i) ? static_cast<long long>(i) : -1);
  path.add(corners.back().parameter, true, -1);
  return path;
}

// How far the values fall along the path before one above it or a cut is met.
struct Fall {
  double way = 0;
  bool cut = false;
};

std::vector<Fall> falls(const Path& path, double sign, bool reversed) {
  const std::size_t n = path.value.size();
  struct Higher {
    double value, low;  // `low`: the least one since the higher one before
  };
  std::vector<Fall> all(n);
  std::vector<Higher> higher;
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t i = reversed ? n - 1 - k : k;
    const double own = sign * path.value[i];
    double low = own;
    // Of two equal ones one is the higher one.
    while (!higher.empty() && (reversed ? higher.back().value < own : higher.back().value <= own)) {
      low = std::min(low, higher.back().low);
      higher.pop_back();
    }
    all[i] = {own - low, higher.empty()};
    if (path.cut[i]) {
      higher.clear();
      low = own;
    }
    higher.push_back({own, low});
  }
  return all;
}

}  // namespace

std::vector<Turn> turns_of(const BranchTrace& trace, const BranchTrace* before) {
  std::vector<Turn> turns;
  if (trace.corners.empty()) return turns;
  const Path path = path_of(trace, before);
  // Of maxima and of minima, on both sides.
  const std::vector<Fall> sides[2][2] = {{falls(path, 1, false), falls(path, 1, true)},
                                         {falls(path, -1, false), falls(path, -1, true)}};
  for (std::size_t k = 0; k < path.value.size(); ++k) {
    if (path.corner[k] < 0) continue;
    const auto i = static_cast<std::size_t>(path.corner[k]);
    const auto& both = sides[trace.corners[i].way < 0 ? 0 : 1];
    const Fall &one = both[0][k], &other = both[1][k];
    const auto [shortest, longest] = std::minmax(one.way, other.way);
    // Beyond a cut the way may go on.
    double prominence = one.cut ? longest : shortest;
    if (one.cut != other.cut) prominence = one.cut ? other.way : one.way;
    const Turn turn{path.corner[k], path.value[k], prominence, shortest};
    turns.push_back(turn);
  }
  return turns;
}

}  // namespace ricochet
