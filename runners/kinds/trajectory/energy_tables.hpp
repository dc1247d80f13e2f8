#pragma once
#include "runners/store/record.hpp"

/// \file
/// What the energies of a study of trajectories say of its methods, worked out of the measures of its cases.
namespace ricochet {

/// Share of the energy brought in below which a change of a case's energy is not told from round-off: the larger of
/// 2⁻⁵² × steps and the residual of its energy balance. A residual above exact_balance is no round-off but what the
/// scheme does and does not declare: it says nothing of the floor.
double energy_noise(const CaseRecord& record);
inline constexpr double exact_balance = 1e-8;

/// A step counts as gaining energy above this share of the energy brought in.
inline constexpr double step_gain_threshold = 1e-9;

/// Whether nothing but contact changes the energy of the finished cases: then its start is the reference.
bool energy_is_kept(const StudyResults& results);

/// energy_ends: one row per finished case with an energy at its end.
Table energy_ends_table(const StudyResults& results);

/// energy_by_mass: one row per mass matrix, over everything else that varies.
Table energy_by_mass_table(const StudyResults& results);

/// energy_trends: one row per method, over its steps.
Table energy_trends_table(const StudyResults& results);

/// energy_ledger: one row per finished case, where its energy came from and where it went.
Table energy_ledger_table(const StudyResults& results);

/// choice_worth: the spread of a result over the finished cases that differ in one choice alone.
Table choice_worth_table(const StudyResults& results);

}  // namespace ricochet
