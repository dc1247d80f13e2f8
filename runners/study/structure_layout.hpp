#pragma once
#include <ricochet/scene/scene.hpp>

#include "runners/json/json_text.hpp"

namespace ricochet {

/// Where a structure of files is drawn, for sketches: of matrices {"axes": ["x", "y"], "nodes", "x", "y", "held",
/// "links", "stops": [{"at", "to", "direction"}], "loads": the same}, numbers of nodes in order; of a description in
/// modes, or of matrices without places, {"points"}. Null for every other structure.
Json structure_layout(const SceneSpec& scene);

}  // namespace ricochet
