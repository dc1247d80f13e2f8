#include <algorithm>
#include <array>
#include <ricochet/contract/said_format.hpp>
#include <ricochet/scene/stop_parameters.hpp>

namespace ricochet {
namespace {

constexpr std::array law_roles = {ParameterRole::stiffness, ParameterRole::damping};

}  // namespace

const std::optional<double>& value_of(const StopParameters& stop, ParameterRole role) {
  static const std::optional<double> nothing;
  switch (role) {
    case ParameterRole::stiffness:
      return stop.stiffness;
    case ParameterRole::damping:
      return stop.damping;
    case ParameterRole::restitution:
      return stop.restitution;
    case ParameterRole::none:
      break;
  }
  return nothing;
}

const char* role_word(ParameterRole role) {
  switch (role) {
    case ParameterRole::stiffness:
      return "stiffness";
    case ParameterRole::damping:
      return "damping";
    case ParameterRole::restitution:
      return "restitution";
    case ParameterRole::none:
      break;
  }
  return "";
}

int first_with(const OwnParameters& stops, ParameterRole role) {
  const auto found = std::find_if(stops.begin(), stops.end(),
                                  [&](const StopParameters& stop) { return value_of(stop, role).has_value(); });
  return found == stops.end() ? -1 : static_cast<int>(found - stops.begin());
}

bool sets_per_point(const ContactLaw& law, const OwnParameters& stops) {
  return !law.absent() && law.per_point() && std::any_of(law_roles.begin(), law_roles.end(), [&](ParameterRole role) {
    return first_with(stops, role) >= 0 && !law.parameter_of(role).empty();
  });
}

void prepare_law(ContactLaw& law, int points, std::span<const Parameters> lanes, const OwnParameters& stops) {
  if (!sets_per_point(law, stops)) {
    law.prepare(points, lanes);
    return;
  }
  std::vector<Parameters> sets;
  for (const StopParameters& stop : stops)
    for (const Parameters& lane : lanes) {
      Parameters& set = sets.emplace_back(lane);
      for (const ParameterRole role : law_roles)
        if (const auto& value = value_of(stop, role))
          if (const std::string key = law.parameter_of(role); !key.empty()) set.set(key, *value);
    }
  law.prepare_points(points, static_cast<int>(lanes.size()), sets);
}

std::vector<UnusedParameter> unused_by(const ContactLaw& law, const OwnParameters& stops) {
  std::vector<UnusedParameter> out;
  if (law.absent()) return out;
  for (const ParameterRole role : law_roles) {
    const int point = first_with(stops, role);
    if (point < 0) continue;
    const bool takes = !law.parameter_of(role).empty();
    if (takes && law.per_point()) continue;
    const bool should = law.reads().has_value() && role == ParameterRole::stiffness;
    out.push_back({role, point, takes || should});
  }
  return out;
}

std::optional<Refusal> refuse_own(const ContactLaw& law, const OwnParameters& stops,
                                  const std::vector<std::string>& names) {
  for (const UnusedParameter& unused : unused_by(law, stops)) {
    if (!unused.wrong) continue;
    const bool one_set = !law.per_point();
    return Refusal{said("the contact law has {}: leave {} of stop {} out",
                        one_set ? "one set of parameters for all stops" : "no stiffness in N/m", role_word(unused.role),
                        names[static_cast<std::size_t>(unused.point)])};
  }
  return std::nullopt;
}

}  // namespace ricochet
