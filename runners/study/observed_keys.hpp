#pragma once
#include <optional>
#include <ricochet/scene/scene.hpp>
#include <vector>

#include "runners/study/fields.hpp"

/// \file
/// Keys of what is observed of a scene: points, and motions along the surfaces of stops; and parameters of stops.
namespace ricochet {

/// `points` of a scene.
Field points_key();
/// What a stop of a list may say of its surface.
std::vector<Field> observed_of_stops();
/// What a stop of a list may have of its own, in the place of the methods' parameters.
std::vector<Field> parameters_of_stops();

Place read_place(const Json& json);
/// Whether a value is a word of `of_each` and a name in brackets: "impulse[bar-a]". Throws InputError for one that is
/// nearly so: another word in its place, or no name.
bool is_of_each(const Field& field, const Json& value, const std::string& pointer);
std::vector<PointSpec> read_points(const Json& scene);
std::optional<TangentSpec> read_tangent(const Json& stop);
StopParameters read_own(const Json& stop);

}  // namespace ricochet
