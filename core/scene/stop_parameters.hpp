#pragma once
#include <ricochet/contract/contact_law.hpp>
#include <ricochet/contract/errors.hpp>
#include <ricochet/scene/scene.hpp>
#include <span>
#include <string>
#include <vector>

/// \file
/// Stops whose parameters are their own, in the place of those of the contact law and of the time scheme.
namespace ricochet {

/// Of each contact point, what its stop has; empty where no stop has anything.
using OwnParameters = std::vector<StopParameters>;

/// The value that a stop gives to a role.
const std::optional<double>& value_of(const StopParameters& stop, ParameterRole role);
/// The roles that a stop may give a value to, as a study writes them.
const char* role_word(ParameterRole role);

/// The first point whose stop gives a value to this role; −1: none.
int first_with(const OwnParameters& stops, ParameterRole role);

/// Whether stops replace a parameter of this law: it then has a set for each point and lane.
bool sets_per_point(const ContactLaw& law, const OwnParameters& stops);

/// prepare() with a set for each lane, or prepare_points() where stops replace parameters.
void prepare_law(ContactLaw& law, int points, std::span<const Parameters> lanes, const OwnParameters& stops);

/// Values that a law has no use for, the same for all stops as far as a sentence goes.
struct UnusedParameter {
  ParameterRole role = ParameterRole::none;
  int point = 0;       ///< the first whose stop gives it
  bool wrong = false;  ///< whether the law has such a parameter, or a force that should: it is refused
};
/// What of the stops' own stiffness and damping a law does not take. A rigid law, and a law without the parameter
/// damping, leave it aside. A compliant law refuses it with another stiffness than N/m, or with one set for all stops.
std::vector<UnusedParameter> unused_by(const ContactLaw& law, const OwnParameters& stops);

/// The refusal of a law that cannot take what stops have of their own, or nothing. `names`: of the stops.
std::optional<Refusal> refuse_own(const ContactLaw& law, const OwnParameters& stops,
                                  const std::vector<std::string>& names);

}  // namespace ricochet
