#include <algorithm>
#include <cmath>
#include <ricochet/measure/attractors/diagram_changes.hpp>

namespace ricochet {

std::vector<int> match_changes(const std::vector<DiagramChange>& reference, const std::vector<DiagramChange>& here,
                               double reach) {
  struct Pair {
    double distance;
    std::size_t one, other;
  };
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < reference.size(); ++i)
    for (std::size_t j = 0; j < here.size(); ++j)
      if (reference[i].like(here[j]) && std::abs(reference[i].value - here[j].value) <= reach)
        pairs.push_back({std::abs(reference[i].value - here[j].value), i, j});
  std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) { return a.distance < b.distance; });
  std::vector<int> out(reference.size(), -1);
  std::vector<char> taken(here.size(), 0);
  for (const Pair& pair : pairs)
    if (out[pair.one] < 0 && !taken[pair.other]) {
      out[pair.one] = static_cast<int>(pair.other);
      taken[pair.other] = 1;
    }
  return out;
}

}  // namespace ricochet
