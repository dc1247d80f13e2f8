#pragma once
#include <ricochet/engine/stage_operator.hpp>

namespace ricochet {

/// The operator of a stage where `model` has modal coordinates. Refuses a mode on which S vanishes.
OperatorOrRefusal make_modal_operator(const MarchModel& model, const FoldedStage& stage, int lanes);

}  // namespace ricochet
