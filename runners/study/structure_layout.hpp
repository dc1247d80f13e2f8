#pragma once
#include <ricochet/scene/scene.hpp>

#include "runners/json/json_text.hpp"

namespace ricochet {

/// Puts into `said`, as "layout", where a structure of files is drawn, for sketches: of matrices {"axes": ["x", "y"],
/// "nodes", "x", "y", "held", "links", "stops": [{"at", "to", "direction"}], "loads": the same}, numbers of nodes in
/// order; of a description in modes, or of matrices without places, {"points"}. Of bodies {"bodies": {name: one of
/// these}, "stops", "loads"}. Nothing for every other structure.
Json with_layout(Json said, const SceneSpec& scene);

}  // namespace ricochet
