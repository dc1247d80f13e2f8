#pragma once
#include <complex>
#include <optional>
#include <ricochet/measure/orbits/branch.hpp>
#include <ricochet/measure/orbits/point_kind.hpp>
#include <string>
#include <vector>

#include "runners/kinds/sweep/with_parameter.hpp"
#include "runners/table/row_type.hpp"

/// \file
/// The tables that a case of kind `continuation` leaves: what their columns mean.
namespace ricochet {

/// One row of `branches`: an orbit on a branch.
struct BranchRow {
  std::string id;      ///< of the case
  std::string branch;  ///< "orbit-1+": the orbit it began with, and the way
  long long row = 0;
  std::optional<double> arc, parameter, tip_displacement, tip_velocity;
  int period = 1;
  std::optional<bool> symmetric, stable;
  std::optional<int> unstable;
  std::vector<std::optional<std::complex<double>>> multipliers;  ///< largest modulus first
  std::optional<double> half_step_real;
  std::optional<std::complex<double>> half_step_pair;  ///< that with a positive imaginary part
  std::optional<double> impacts_per_period;
  std::optional<int> contact_runs;
  std::optional<double> penetration;
  std::optional<int> iterations;
  std::optional<double> residual;
  std::optional<double> march_displacement, march_velocity;  ///< of OwnMarch, over told_periods
  std::optional<long long> pieces;
  std::optional<int> direction;
  std::optional<int> point;  ///< of special_points, where the row is one
};
/// The rows of `branches`, with as many multipliers as it has.
std::vector<BranchRow> branch_rows_in(const Table& branches);
inline constexpr char branches_name[] = "branches";
TableType<BranchRow> branches_type(int multipliers, const SweptColumns& swept = {});

/// One row of `special_points`.
struct SpecialRow {
  std::string id, branch;
  int point = 0;
  PointKind kind = PointKind::end;  ///< contact of any change of contact
  std::string name;
  std::optional<double> parameter, low, high, arc, tip_displacement;
  std::optional<double> multiplier_re, multiplier_im, angle;
  std::optional<int> crossings;
  std::optional<double> prominence;
  std::string side;
  std::optional<double> contact_phase, contact_x;
  std::optional<int> runs_before, runs_after, held_before, held_after;
  std::string to_branch, note;
  TraceEnd ended = TraceEnd::none;
};
TableType<SpecialRow> special_points_type(const SweptColumns& swept = {});

/// One row of `turns`.
struct TurnRow {
  std::string id, branch;
  double prominence = 0;
  int folds = 0;
};
TableType<TurnRow> turns_type(const SweptColumns& swept = {});

/// Gives the tables of cases their meanings, with the units and names that the study gives its parameter.
void describe_continuation(std::vector<CaseRecord>& cases, const SweptColumns& swept);

}  // namespace ricochet
