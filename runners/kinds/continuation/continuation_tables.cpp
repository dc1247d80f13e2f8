#include "runners/kinds/continuation/continuation_tables.hpp"

#include <fmt/format.h>

#include "runners/store/record_values.hpp"
#include "runners/table/table_reader.hpp"

namespace ricochet {
namespace {

const Column branch_column{"branch", "", "The orbit that the branch began with, and the way: + up or − down."};

using RootPart = double (*)(const std::complex<double>&);
double real_part(const std::complex<double>& value) {
  return value.real();
}
double imaginary_part(const std::complex<double>& value) {
  return value.imag();
}

void add_multiplier(RowType<BranchRow>& type, std::size_t k, const char* suffix, const char* text, RootPart part,
                    void (*put)(std::complex<double>&, double)) {
  type.add(
      {fmt::format("multiplier_{}_{}", k + 1, suffix), "1", text},
      [k, part](const BranchRow& row) {
        return k < row.multipliers.size() && row.multipliers[k] ? Cell(part(*row.multipliers[k])) : Cell();
      },
      [k, put](BranchRow& row, const Cell& cell) {
        if (row.multipliers.size() <= k) row.multipliers.resize(k + 1);
        const auto number = cell.number();
        if (!number) return;
        if (!row.multipliers[k]) row.multipliers[k] = 0;
        put(*row.multipliers[k], *number);
      });
}

/// With so many multipliers.
RowType<BranchRow> branch_row_type(int multipliers, const SweptColumns& swept) {
  RowType<BranchRow> type;
  type.of_case(&BranchRow::id)
      .add(branch_column, &BranchRow::branch)
      .add({"row", "1", "Number of the row on its branch, from 0."}, &BranchRow::row)
      .add({"arc", "m",
            "Length of the branch from its first orbit: root mean square of displacements, of velocities over ω, and "
            "of the parameter over its scale."},
           &BranchRow::arc)
      .add(swept.parameter, &BranchRow::parameter)
      .add({"tip_displacement", "m", "Displacement of the tip at the strobe, t = 0 of the forcing, absolute."},
           &BranchRow::tip_displacement)
      .add({"tip_velocity", "m/s", "Its velocity there, central over two steps."}, &BranchRow::tip_velocity)
      .add({"period", "1", "Forcing periods after which the orbit repeats."}, &BranchRow::period)
      .add({"symmetric", "", "Whether the orbit is its own image after half its period, and was solved so."},
           &BranchRow::symmetric)
      .add({"stable", "", "Whether all multipliers are inside the unit circle."}, &BranchRow::stable)
      .add({"unstable", "1", "Number of multipliers outside the unit circle."}, &BranchRow::unstable);
  for (int k = 0; k < multipliers; ++k) {
    const auto number = static_cast<std::size_t>(k);
    add_multiplier(type, number, "re",
                   "Real part of a multiplier of the frozen step, largest modulus first; of half the period where the "
                   "orbit is symmetric.",
                   real_part, [](std::complex<double>& of, double value) { of.real(value); });
    add_multiplier(type, number, "im", "Its imaginary part.", imaginary_part,
                   [](std::complex<double>& of, double value) { of.imag(value); });
  }
  type.add({"half_step_real", "1", "Real multiplier nearest −1 by the half-step rule; empty: none."},
           &BranchRow::half_step_real)
      .add(
          {"half_step_pair_re", "1", "Real part of the pair nearest the unit circle by that rule; empty: none."},
          [](const BranchRow& row) { return row.half_step_pair ? Cell(row.half_step_pair->real()) : Cell(); },
          [](BranchRow& row, const Cell& cell) {
            if (const auto number = cell.number()) row.half_step_pair = {*number, 0};
          })
      .add(
          {"half_step_pair_im", "1", "Its imaginary part."},
          [](const BranchRow& row) { return row.half_step_pair ? Cell(row.half_step_pair->imag()) : Cell(); },
          [](BranchRow& row, const Cell& cell) {
            if (const auto number = cell.number(); number && row.half_step_pair) row.half_step_pair->imag(*number);
          });
  type.add({"impacts_per_period", "1", "Runs of contact that begin in one forcing period, both sides."},
           &BranchRow::impacts_per_period)
      .add({"contact_runs", "1", "Runs of steps with an effort, over the period of the orbit, summed over the points."},
           &BranchRow::contact_runs)
      .add({"penetration", "m", "Largest distance by which a point is beyond its stop."}, &BranchRow::penetration)
      .add({"iterations", "1", "Iterations of Newton's method for this orbit; 0: its piece ended there."},
           &BranchRow::iterations)
      .add(
          {"residual", "m",
           "Root mean square of what a period changes, velocities over ω. Impacts that rebound are placed within their "
           "step."},
          &BranchRow::residual)
      .add({"march_displacement", "m",
            "How far the scheme's own march is from the orbit after one or two periods, the larger; root mean square "
            "over nodes."},
           &BranchRow::march_displacement)
      .add({"march_velocity", "m/s", "The same of velocities."}, &BranchRow::march_velocity)
      .add({"pieces", "1", "Pieces, or steps, since the row before."}, &BranchRow::pieces)
      .add({"direction", "1", "1 where the parameter grows along the branch, −1 where it falls."},
           &BranchRow::direction)
      .add({"point", "1", "Number of the special point that the row is; empty: none."}, &BranchRow::point);
  return type;
}

}  // namespace

std::vector<BranchRow> branch_rows_in(const Table& branches) {
  int count = 0;
  while (find_column(branches.columns, fmt::format("multiplier_{}_re", count + 1))) ++count;
  return branch_row_type(count, {}).read(branches);
}

TableType<BranchRow> branches_type(int multipliers, const SweptColumns& swept) {
  return {branches_name,
          "One orbit on a branch; of a branch with more than 2000 the special ones, and others evenly spaced.",
          branch_row_type(multipliers, swept)};
}

TableType<SpecialRow> special_points_type(const SweptColumns& swept) {
  RowType<SpecialRow> rows;
  rows.of_case(&SpecialRow::id)
      .add(branch_column, &SpecialRow::branch)
      .add({"point", "1", "Number of the point on its branch, from 1."}, &SpecialRow::point)
      .add({"kind", "", "fold, symmetry, flip, torus, contact, mark or end."}, &SpecialRow::kind)
      .add(
          {"label", "", "What programs of continuation call it: LP, BP, PD, TR, GR, UZ, EP."},
          [](const SpecialRow& row) { return Cell(label(row.kind)); }, [](SpecialRow&, const Cell&) {})
      .add({"name", "", "What it is called over all cases; empty where it has no counterpart."}, &SpecialRow::name)
      .add(swept.parameter, &SpecialRow::parameter)
      .add({"low", swept.parameter.unit, "Lower end of where the point may be."}, &SpecialRow::low)
      .add({"high", swept.parameter.unit, "Upper end of where the point may be."}, &SpecialRow::high)
      .add({"arc", "m", "Length of the branch from its first orbit."}, &SpecialRow::arc)
      .add({"tip_displacement", "m", "Displacement of the tip at the strobe, absolute."}, &SpecialRow::tip_displacement)
      .add({"multiplier_re", "1", "Real part of the multiplier that crosses."}, &SpecialRow::multiplier_re)
      .add({"multiplier_im", "1", "Its imaginary part."}, &SpecialRow::multiplier_im)
      .add({"angle", "rad", "Its angle on the circle, 0 to π."}, &SpecialRow::angle)
      .add({"crossings", "1", "Crossings of the frozen multipliers that are this one point."}, &SpecialRow::crossings)
      .add({"prominence", swept.parameter.unit,
            "Of a fold: the smaller way that the parameter goes back by, before "
            "and after."},
           &SpecialRow::prominence)
      .add({"side", "", "Where the branch lies of a fold, below or above; the stop of a contact, lower or upper."},
           &SpecialRow::side)
      .add({"contact_phase", "rad", "Phase ωt of the step at which contact comes or goes."}, &SpecialRow::contact_phase)
      .add({"contact_x", "m", "Where the point stands that touches."}, &SpecialRow::contact_x)
      .add({"runs_before", "1", "Runs of contact before the point."}, &SpecialRow::runs_before)
      .add({"runs_after", "1", "Runs of contact after it."}, &SpecialRow::runs_after)
      .add({"held_before", "1", "Of the runs before the point, contacts that never open."}, &SpecialRow::held_before)
      .add({"held_after", "1", "Of the runs after it, contacts that never open."}, &SpecialRow::held_after)
      .add({"to_branch", "", "The branch that begins here."}, &SpecialRow::to_branch)
      .add({"ended", "",
            "Of an end: range (of the parameter), closed, joined (another branch), asked (stop_at), limit (at_most or "
            "budget), left, missing."},
           &SpecialRow::ended)
      .add({"note", "", "What is not certain, or why the branch ends."}, &SpecialRow::note);
  return {"special_points", "One special point of a branch.", rows};
}

TableType<TurnRow> turns_type(const SweptColumns& swept) {
  RowType<TurnRow> rows;
  rows.of_case(&TurnRow::id)
      .add(branch_column, &TurnRow::branch)
      .add({"prominence", swept.parameter.unit, "Way that the parameter goes back by, at least."}, &TurnRow::prominence)
      .add({"folds", "1", "Turns of the parameter along the branch with at least that prominence."}, &TurnRow::folds);
  return {"turns", "How many folds a branch has at one prominence: a scheme invents those that a finer step loses.",
          rows};
}

void describe_continuation(std::vector<CaseRecord>& cases, const SweptColumns& swept) {
  constexpr int most_multipliers = 64;
  describe(cases, {branches_type(most_multipliers, swept).head(), special_points_type(swept).head(),
                   turns_type(swept).head()});
}

}  // namespace ricochet
