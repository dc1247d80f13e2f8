#include <ricochet/measure/attractors/orbit_ends.hpp>
#include <utility>

namespace ricochet {

int OrbitEnds::label(SettledSection section) {
  int label = static_cast<int>(met_.size());
  double nearest = 1;
  for (std::size_t k = 0; k < met_.size(); ++k)
    if (const double distance = relative_distance(met_[k], section, rule_); distance <= nearest) {
      nearest = distance;
      label = static_cast<int>(k);
    }
  if (label == static_cast<int>(met_.size())) met_.push_back(std::move(section));
  return label;
}

}  // namespace ricochet
