#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <ricochet/contract/registry.hpp>
#include <ricochet/engine/marcher.hpp>

#include "runners/study/study.hpp"

namespace ricochet {

/// Makes what watches a case of this kind of study over so many steps; null: nothing does.
using MakeObserver = std::function<std::shared_ptr<const Observers>(const StudyCase& study_case, const Marcher& marcher,
                                                                    long long steps)>;

/// Processor seconds that one step of a case costs, measured: marches its whole duration in a few hundred steps, then
/// in as many as `seconds` of processor time allow, so that it touches its stops for the share of the time for which
/// the case will; a step that is too coarse for the scheme or for the motion of the support gives way to a finer one,
/// over the beginning. Where steps are left out, the time is that of its visits and of its steps in contact, whose
/// numbers grow with that of steps as they did between the finest of these marches. Nothing where the case does not
/// march. The contact of a coarse step may ask for more or fewer iterations than that of a fine one: a forecast, not a
/// measure of the method.
std::optional<double> march_pace(const StudyCase& study_case, const Registry& registry,
                                 const MakeObserver& observe = {}, double seconds = 0.01);

}  // namespace ricochet
