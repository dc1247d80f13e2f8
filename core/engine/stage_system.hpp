#pragma once
#include <ricochet/algebra/band_ldlt.hpp>
#include <ricochet/engine/stage_operator.hpp>

namespace ricochet {

/// S of a stage as (1) of band_ldlt.hpp: a mass that is not assembled enters through its border, scaled so that both
/// blocks have the same units.
QuasiDefinite stage_system(const MarchModel& model, const FoldedStage& stage);

}  // namespace ricochet
