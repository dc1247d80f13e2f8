#pragma once
#include <ricochet/scene/scene.hpp>
#include <vector>

#include "runners/study/fields.hpp"

/// \file
/// Keys of beams in two planes and of clearances.
namespace ricochet {

/// `planes` of a beam, EI_z of a section that is given, `components` of a support.
Field planes_key();
Field EI_z_key();
Field components_of_support();
/// `component` of a load that is spread, and of a motion of supports.
Field component_key(const char* text);
/// u_z and its rate at t = 0.
std::vector<Field> initial_across_keys();
/// `clearance` of a stop.
Field clearance_key();

/// {u_y, u_z} of a support as it is checked.
std::array<bool, 2> read_components(const Json& support);

/// Adds a stop as its rows: itself, or of a clearance its sides. `one`: the stop as it is checked, of number `entry`.
/// Throws InputError for bounds beside a clearance, for a node without component where there is none.
void add_stop(NamedStop stop, const Json& one, std::size_t entry, std::vector<NamedStop>& rows);

/// A pointer that counts rows, as one that counts the stops of the study.
std::string pointer_in_study(const StopsSpec& stops, const std::string& pointer);

}  // namespace ricochet
