#pragma once
#include <optional>
#include <ricochet/scene/place.hpp>
#include <vector>

#include "runners/study/fields.hpp"

/// \file
/// Keys of what is observed of a scene: points, and motions along the surfaces of stops.
namespace ricochet {

/// `points` of a scene.
Field points_key();
/// What a stop of a list may say of its surface.
std::vector<Field> observed_of_stops();

Place read_place(const Json& json);
std::vector<PointSpec> read_points(const Json& scene);
std::optional<TangentSpec> read_tangent(const Json& stop);

}  // namespace ricochet
