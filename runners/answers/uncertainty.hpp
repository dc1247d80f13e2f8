#pragma once
#include <optional>

#include "runners/answers/answer.hpp"
#include "runners/answers/limits.hpp"
#include "runners/report/choices.hpp"
#include "runners/table/row_type.hpp"

namespace ricochet::answers {

/// One row of `uncertainty`, in its unit.
struct StopRange {
  std::string measure = {}, stop = {}, unit = {};
  double value = 0, least = 0, largest = 0;
  std::size_t methods = 0;
  std::optional<double> step = {}, mesh = {}, sampling = {}, low = {}, high = {};
  std::string verdict = {}, sentence = {};
};
const TableType<StopRange>& uncertainty_type();

/// uncertainty: one row per measure of a stop that has a name, what all methods and refinements together leave of it.
///
///     d = step gap + mesh gap + sampling,     interval [least − d, largest + d]
///
/// over the methods, each at its finest step and mesh. Gaps are the largest u that a method's refinement leaves,
/// sampling half the 95 % interval of a mean over seeds, or over the parts of a window. The interval is blank of a
/// single step. Where the scene itself varies its levels are among the cases.
Table uncertainty_table(const Choices& study);

/// Whether cases differ in more than methods, their refinements and draws: then a range over all is of no one scene.
bool scene_varies(const Choices& study);

/// Words whose numbers are thousandths or millionths where the unit is W or m: mW below 0.1 W, µW below 1e-4 W. `scale`
/// is the largest value, in the unit.
MeasureWords prefixed(MeasureWords words, double scale);

}  // namespace ricochet::answers
