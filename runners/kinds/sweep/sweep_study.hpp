#pragma once
#include <ricochet/contract/registry.hpp>

#include "runners/study/study.hpp"

/// \file
/// What the kinds that go through a parameter add to a study: settings, and what they refuse before anything runs.
namespace ricochet {

/// The settings of every case, complete and in a fixed order:
///     bifurcation: parameter {pointer, values}, start, transient, keep, section, phase, exponents, refine, budget
///     basins:      axes [{pointer, values}, {pointer, values}], transient, keep, section, phase, exponents (0),
///     refine,
///                  budget
/// `values` ascending, of a range n values (from·(n−1−i) + to·i)/(n−1), rounded to 12 digits where they stay different;
/// `budget` only where one is given. Throws InputError for a range that is empty or too narrow for its count.
Json sweep_settings(const Json& resolved);

/// The most memory that the results of a study may need, bytes.
inline constexpr double largest_results = 16e9;

/// Refuses, with pointer, what no case of the sweep could do:
///   · a pointer that names a list, or no scalar of the scene or of the methods (the nearest one, and all, are told),
///   · two axes with the same pointer, a start that does not read what the parameter changes,
///   · at_most < periods, more exponents than the state has components, results beyond largest_results.
/// `cases`: number of combinations of the axes; `dofs`: of the coarsest mesh.
void check_sweep(const Json& resolved, const Json& settings, const Registry& registry, double cases, int dofs);

/// Refuses, with the pointer `where`, what names no scalar of the scene or of the methods, or a list.
void check_swept_pointer(const Json& resolved, const std::string& pointer, const std::string& where,
                         const Registry& registry);

/// Marks the cases whose method does not have the parameter as excluded, writes "swept" where the parameter is an axis
/// of the methods, and notes its declaration in the others. To be called when the cases are there.
void mark_sweep(const Json& settings, const Registry& registry, StudyCase& study_case);

/// Whether the scene is possible at some value of what is swept in it: its own value is never marched, nor is its
/// initial state where no orbit begins there.
bool some_value_possible(const StudyCase& study_case);

/// Refuses a study in which no value of any case is possible, or nothing is forced at any value while the section is a
/// strobe.
void check_values(const Study& study);

}  // namespace ricochet
