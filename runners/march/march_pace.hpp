#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <ricochet/contract/registry.hpp>
#include <ricochet/engine/marcher.hpp>

#include "runners/study/study.hpp"

namespace ricochet {

/// Makes what watches the steps of a march in this kind of study; null: nothing does.
using MakeObserver = std::function<std::shared_ptr<StepObserver>(const Marcher& marcher)>;

/// Processor seconds that one step of a case costs, measured: marches its whole duration in a few hundred steps, then
/// in as many as some milliseconds allow, so that it touches its stops for the share of the time for which the case
/// will; a step that is too coarse for the scheme gives way to the case's own, over the beginning. Nothing where the
/// case does not march. The contact of a coarse step may ask for more or fewer iterations than that of a fine one: a
/// forecast, not a measure of the method.
std::optional<double> march_pace(const StudyCase& study_case, const Registry& registry,
                                 const MakeObserver& observe = {});

}  // namespace ricochet
