#pragma once
#include <vector>

#include "runners/report/figures.hpp"

namespace ricochet::report {

/// Step × parameter maps, one figure per numeric parameter with at least three values: background by the prediction
/// (stable, marginal, unstable by its growth, refused), marks by the observation, both boundaries, and the cells where
/// they disagree said below.
std::vector<Figure> stability_maps(const CaseView& view);

}  // namespace ricochet::report
