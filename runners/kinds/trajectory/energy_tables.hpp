#pragma once
#include "runners/store/record.hpp"
#include "runners/table/row_type.hpp"

/// \file
/// What the energies of a study of trajectories say of its methods, worked out of the measures of its cases.
namespace ricochet {

/// Share of the energy brought in below which a change of a case's energy is not told from round-off. It is the larger
/// of 2⁻⁵² × steps and the residual of the case's energy balance. A residual above exact_balance is not round-off: the
/// scheme does something that it does not declare. It says nothing of the floor.
double energy_noise(const CaseRecord& record);
inline constexpr double exact_balance = 1e-8;

/// A step counts as gaining energy above this share of the energy brought in.
inline constexpr double step_gain_threshold = 1e-9;

/// One row of `energy_ends`.
struct EnergyEnd {
  std::string id;
  std::optional<double> energy, ratio, change;
  double noise_floor = 0;
  std::optional<bool> kept;
  std::optional<double> step_gain;
  std::optional<bool> gains;
  std::optional<double> lost_at_contact;
  bool conservative = false;
};
TableType<EnergyEnd> energy_ends_type();
/// energy_ends: one row per finished case with an energy at its end.
Table energy_ends_table(const StudyResults& results);

/// energy_ledger: one row per finished case, where its energy came from and where it went.
Table energy_ledger_table(const StudyResults& results);

}  // namespace ricochet
