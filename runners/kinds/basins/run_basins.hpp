#pragma once
#include <ricochet/contract/registry.hpp>

#include "runners/march/case_context.hpp"
#include "runners/march/prepare_case.hpp"

namespace ricochet {

/// What would run for a case of kind `basins`.
CasePlan plan_basins(const StudyCase& study_case, const Registry& registry);

/// Runs one case of kind `basins`: the orbit of every cell of the grid from the scene's own initial state, as lanes, or
/// of the cells that GridRefinement asks for.
///
/// Table `cells` (a cell is numbered by its row; x runs first, both ascending): x, y, class, period, attractor (the
/// end within the case, from 1 in the order met, which derive_basins() turns into one over all cases; null on a grid of
/// parameters, where attractors move, and for what is undecided), marched (false: filled from `source`, a cell of the
/// same basin), source (its own number where it was marched), status, reason. Numbers `cell_points` (not exported):
/// cell, index, tip_displacement, tip_velocity, opposite_displacement, opposite_velocity: the last strobed points, one
/// period of what repeats, else at most 64; of filled cells those of the source.
CaseRecord run_basins(const StudyCase& study_case, const Registry& registry, const CaseContext& context,
                      const std::atomic<bool>& stop);

}  // namespace ricochet
