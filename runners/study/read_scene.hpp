#pragma once
#include <ricochet/scene/scene.hpp>
#include <string>

#include "runners/json/json_text.hpp"
#include "runners/study/study.hpp"
#include "runners/study/study_files.hpp"

namespace ricochet {

/// A checked and complete scene, scalars only (as check_object leaves it, lists replaced by one value each), as the
/// core wants it. What one key alone does not show (a wall thicker than the radius, a position beyond the tip) is left
/// to check_scene(). `files`: of a scene that may name some; their faults are InputErrors. "basis", which no study
/// writes there, are the modes of a case that marches in some.
SceneSpec read_scene(const Json& scene, StudyFiles* files);

/// Puts into `said`, as "layout", where a structure of files is drawn, for sketches. Of matrices {"axes": ["x", "y"],
/// "nodes", "x", "y", "held", "links", "stops": [{"at", "to", "direction"}], "loads": the same}, numbers of nodes in
/// order. Of a description in modes, or of matrices without places, {"points"}. Of bodies {"bodies": {name: one of
/// these}, "stops", "loads"}. Nothing for every other structure.
Json with_layout(Json said, const SceneSpec& scene);

}  // namespace ricochet
