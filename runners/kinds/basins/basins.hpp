#pragma once
#include <ricochet/contract/registry.hpp>

#include "runners/asks/evidence.hpp"
#include "runners/march/case_context.hpp"
#include "runners/march/prepare_case.hpp"
#include "runners/store/record.hpp"

/// \file
/// Cases of kind `basins`, their tables, and what they answer.
namespace ricochet {

struct BasinAnalysis;

/// What would run for a case of kind `basins`.
CasePlan plan_basins(const StudyCase& study_case, const Registry& registry);

/// Runs one case of kind `basins`: orbits from the scene's own initial state, as lanes. They are those of every cell of
/// the grid, or of the cells that GridRefinement asks for.
///
/// Table `cells`, a cell numbered by its row, x first, both ascending: x, y, class, period, attractor, marched, source,
/// status, reason. `attractor` is the end within the case, from 1 in the order met; analyse_basins() numbers it over
/// all cases. It is null where undecided, and on a grid of parameters, where attractors move. `marched` false: the cell
/// is filled from `source`, a cell of the same basin. Numbers `cell_points` (not exported): cell, index,
/// tip_displacement, tip_velocity, opposite_displacement, opposite_velocity. They are the last strobed points: one
/// period of what repeats, else at most 64; of filled cells those of the source.
CaseRecord run_basins(const StudyCase& study_case, const Registry& registry, const CaseContext& context,
                      const std::atomic<bool>& stop);

/// Which share of the starts ends in which motion, method by method.
asks::Answered motions_of_basins(const asks::Ask& ask, const asks::Evidence& evidence, const BasinAnalysis& basins);
/// How many cells a choice changes.
asks::Answered effect_on_basins(const asks::Ask& ask, const asks::Evidence& evidence, const BasinAnalysis& basins);
void check_basin_ask(const Study& study, const Json& ask, const std::string& pointer);

}  // namespace ricochet
