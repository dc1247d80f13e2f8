#pragma once
#include <cmath>
#include <optional>
#include <ricochet/measure/attractors/diagram_attractors.hpp>

#include "runners/kinds/sweep/with_parameter.hpp"
#include "runners/table/number_table.hpp"
#include "runners/table/row_type.hpp"

/// \file
/// The tables of both kinds of sweep, without rows: what their columns mean.
namespace ricochet {

/// "periodic 3", "chaotic": a class and its period, as `values` and `cells` have them, in the words of `bifurcations`.
std::string regime_text(const std::string& regime, std::optional<double> period);

/// One row of `values`: what came of one value of the parameter from one start.
struct OrbitRow {
  struct Exponent {
    std::optional<double> value, low, high;  ///< 1/s
  };
  double parameter = NAN;
  std::string start, regime;
  std::optional<int> period;  ///< forcing periods
  std::optional<double> impacts_per_period;
  std::optional<bool> symmetric;
  std::vector<Exponent> exponents;  ///< the largest first
  std::string exponent_method;
  std::optional<double> exponent_twin;  ///< 1/s
  std::string marginal;
  std::optional<int> attractor;
  std::optional<double> alpha_equivalent;  ///< s
  std::optional<double> recurrence, contraction, zero_one;
  std::optional<int> transient_periods;
  std::optional<bool> settled, chatter;
  std::optional<double> sticking;
  std::string evidence, status, reason;
  bool done() const { return status.empty() || status == "done"; }
  /// The motion, or why there is none: "refused".
  std::string motion_text() const { return done() ? regime_text(regime, period) : status; }
  std::optional<double> largest_exponent() const { return exponents.empty() ? std::nullopt : exponents.front().value; }
};
/// With so many exponents.
RowType<OrbitRow> orbit_row_type(int exponents, const SweptColumns& swept = {});
/// The rows of `values`, with as many exponents as it has.
std::vector<OrbitRow> orbits_in(const Table& values);
/// The orbits of a case, in its order; none where it has no such table.
std::vector<OrbitRow> orbits_of(const CaseRecord& record);

/// One row of `bifurcations`.
struct ChangeRow : DiagramChange {
  explicit ChangeRow(DiagramChange change = {{}, {}, {}, {}, NAN, NAN, NAN}, std::optional<int> of_search = {})
      : DiagramChange(std::move(change)), steps(of_search) {}
  std::optional<int> steps;  ///< of the search
};
RowType<ChangeRow> change_row_type(const SweptColumns& swept = {});
/// The changes of a case, in its order; none where it has no such table.
std::vector<ChangeRow> changes_of(const CaseRecord& record);

/// Of a case, kept in the store.
Table values_head(int exponents, const SweptColumns& swept = {});
Table bifurcations_head(const SweptColumns& swept = {});
Table cells_head(const SweptColumns& swept = {});
NumberTable points_head(const SweptColumns& swept = {});
NumberTable impacts_head(const SweptColumns& swept = {});
NumberTable portraits_head(const SweptColumns& swept = {});
NumberTable entries_head(const SweptColumns& swept = {});
NumberTable cell_points_head();
NumberTable contact_law_head();

/// Over all cases, worked out of these.
Table attractors_head(const SweptColumns& swept);
Table agreement_head();
Table verdicts_head(const SweptColumns& swept);
Table basin_differences_head();
/// Of single cases, worked out of these: what stands behind `case` and the axes.
Table distances_head(const SweptColumns& swept);
Table shifts_head(const SweptColumns& swept);
Table basin_fractions_head();
Table basin_uncertainty_head();

/// Gives the tables that a case of a sweep left their units and meanings.
void describe_sweep(CaseRecord& record, const SweptColumns& swept);

}  // namespace ricochet
