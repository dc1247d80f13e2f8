#include "runners/kinds/sweep/sweep_tables.hpp"

#include <ricochet/measure/orbits/regime.hpp>

#include "runners/store/record_values.hpp"
#include "runners/table/table_reader.hpp"

namespace ricochet {

const Column attractor_column{
    "attractor", "", "Number of the attractor, the same for every case and start of the study; empty where undecided."};

namespace {

const Column start_column{start_name, "", "Where the orbit begins: rest, state, up, down or random-NUMBER."};
const Column class_column{"class", "",
                          "no contact, at rest (what touches its stop never leaves it), periodic, chattering, "
                          "quasi-periodic, chaotic, undecided, or "
                          "failed: what the orbit is in the long run."};
const Column period_column{"period", "1", "Forcing periods after which a periodic orbit repeats."};
const Column status_column{"status", "", "done, refused, diverged or failed."};
const Column reason_column{"reason", "", "Why the orbit was refused or stopped."};

NumberType<SectionColumns>& add_section(NumberType<SectionColumns>& type) {
  return type
      .add({"index", "1", "Number of the point in its section, from 0, in the order of time."}, &SectionColumns::index)
      .add({"tip_displacement", "m", "Absolute displacement of the tip at the section."}, &SectionColumns::displacement)
      .add({"tip_velocity", "m/s", "Velocity of the tip at the section."}, &SectionColumns::velocity)
      .add({"opposite_displacement", "m",
            "The same of the mirror image of the orbit, x → −x half a forcing period later."},
           &SectionColumns::opposite_displacement)
      .add({"opposite_velocity", "m/s", "Velocity of the tip of that mirror image."},
           &SectionColumns::opposite_velocity);
}

Column in_units_of(const Column& parameter, const char* name, const char* text) {
  return {name, parameter.unit, text};
}

std::string exponent_name(int number) {
  return "exponent_" + std::to_string(number);
}

}  // namespace

std::string regime_text(const std::string& regime, std::optional<double> period) {
  const auto motion = motion_class(regime, period);
  return motion ? text(*motion) : regime;
}

RowType<OrbitRow> orbit_row_type(int exponents, const SweptColumns& swept) {
  RowType<OrbitRow> type;
  type.of_case(&OrbitRow::id)
      .add(swept.parameter, &OrbitRow::parameter)
      .add(start_column, &OrbitRow::start)
      .add(class_column, &OrbitRow::regime)
      .add(period_column, &OrbitRow::period)
      .add({"impacts_per_period", "1",
            "Impacts in one forcing period, mean over the kept ones; a contact that never opens is none."},
           &OrbitRow::impacts_per_period)
      .add({"symmetric", "", "Whether the orbit is its own image under x → −x half a forcing period later."},
           &OrbitRow::symmetric);
  for (int k = 1; k <= exponents; ++k) {
    const std::string name = exponent_name(k);
    const auto add = [&](Column column, std::optional<double> OrbitRow::Exponent::*part) {
      const auto place = static_cast<std::size_t>(k) - 1;
      type.add(
          std::move(column),
          [place, part](const OrbitRow& row) {
            return place < row.exponents.size() ? Cell(row.exponents[place].*part) : Cell();
          },
          [place, part](OrbitRow& row, const Cell& cell) {
            if (row.exponents.size() <= place) row.exponents.resize(place + 1);
            row.exponents[place].*part = cell.number();
          });
    };
    add({name, "1/s", "Lyapunov exponent number " + std::to_string(k) + ", largest first."},
        &OrbitRow::Exponent::value);
    add({name + "_low", "1/s", "Lower end of its 95 % interval (stationary block bootstrap)."},
        &OrbitRow::Exponent::low);
    add({name + "_high", "1/s", "Upper end of that interval."}, &OrbitRow::Exponent::high);
  }
  type.add({"exponent_method", "",
            "How the exponents were found: tangent, tangent+jump, or twin with its offset. superstable: all are −∞, as "
            "the mass comes to rest on its stop. Empty: there are none, or none would see how impacts move; a note of "
            "the case says so."},
           &OrbitRow::exponent_method)
      .add({"exponent_twin", "1/s",
            "The largest exponent by a second trajectory beside the first, as a check. Empty where impacts have "
            "inertia, as both would meet their stops at the same steps."},
           &OrbitRow::exponent_twin)
      .add({"marginal", "", "Roots of modulus one that are the scheme's own and not the motion's."},
           &OrbitRow::marginal)
      .add(attractor_column, &OrbitRow::attractor)
      .add({"alpha_equivalent", "s",
            "Stiffness viscosity that the scheme itself adds: what α of C = αK would damp the first modes as much."},
           &OrbitRow::alpha_equivalent)
      .add({"recurrence", "1", "Largest distance between readings one period apart, relative to the gap."},
           &OrbitRow::recurrence)
      .add({"contraction", "1",
            "Factor by which that distance falls per forcing period; 1 where nothing tells it from 1."},
           &OrbitRow::contraction)
      .add({"zero_one", "1", "K of the 0–1 test of the strobed displacement: near 0 regular, near 1 chaotic."},
           &OrbitRow::zero_one)
      .add({"transient_periods", "1", "Forcing periods that were left out before the first reading."},
           &OrbitRow::transient_periods)
      .add({"settled", "", "Whether the orbit had settled before the transient was cut at its cap."},
           &OrbitRow::settled)
      .add({"chatter", "", "Whether there were ten or more impacts on one side within one forcing period."},
           &OrbitRow::chatter)
      .add({"sticking", "1", "Share of the kept steps with contact closed."}, &OrbitRow::sticking)
      .add({"section_open", "m",
            "How far the step leaves the section open: impacts that rebound are placed to within it. Motions that are "
            "nearer are one."},
           &OrbitRow::open)
      .add({"evidence", "", "What the class rests on, one sentence with its numbers."}, &OrbitRow::evidence)
      .add(status_column, &OrbitRow::status)
      .add(reason_column, &OrbitRow::reason);
  return type;
}

std::vector<OrbitRow> orbits_in(const Table& values) {
  int exponents = 0;
  while (find_column(values.columns, exponent_name(exponents + 1))) ++exponents;
  return orbit_row_type(exponents).read(values);
}

std::vector<OrbitRow> orbits_of(const CaseRecord& record) {
  const Table* table = find_table(record.tables, values_name);
  return table ? orbits_in(*table) : std::vector<OrbitRow>();
}

RowType<ChangeRow> change_row_type(const SweptColumns& swept) {
  const Column& of = swept.parameter;
  RowType<ChangeRow> type;
  type.add(start_column, &ChangeRow::start)
      .add({"from", "", "Class below the change."}, &ChangeRow::from)
      .add({"to", "", "Class above it."}, &ChangeRow::to)
      .add({"kind", "",
            "grazing (contact begins or ends), lift-off (a contact that never opens begins to) or change (any other)."},
           &ChangeRow::kind)
      .add(in_units_of(of, "value", "Value of the parameter at which the change is located."), &ChangeRow::value)
      .add(in_units_of(of, "low", "Largest value known to lie below the change."), &ChangeRow::low)
      .add(in_units_of(of, "high", "Smallest value known to lie above it."), &ChangeRow::high)
      .add({"steps", "1", "Steps of the search, where the change was located apart from the sweep."},
           &ChangeRow::steps);
  return type;
}

std::vector<ChangeRow> changes_of(const CaseRecord& record) {
  const Table* table = find_table(record.tables, "bifurcations");
  return table ? change_row_type().read(*table) : std::vector<ChangeRow>();
}

Table values_head(int exponents, const SweptColumns& swept) {
  return {values_name,
          "One orbit of one case: a value of the parameter and a start.",
          orbit_row_type(exponents, swept).columns(),
          {}};
}

Table bifurcations_head(const SweptColumns& swept) {
  return {"bifurcations",
          "One change of the motion of one case along the parameter.",
          change_row_type(swept).columns(),
          {}};
}

TableType<CellRow> cells_type(const SweptColumns& swept) {
  RowType<CellRow> rows;
  rows.of_case(&CellRow::id)
      .add(swept.x, &CellRow::x)
      .add(swept.y, &CellRow::y)
      .add(class_column, &CellRow::regime)
      .add(period_column, &CellRow::period)
      .add(attractor_column, &CellRow::attractor)
      .add({"marched", "", "Whether the cell was marched; otherwise it takes the end of a marched one of its basin."},
           &CellRow::marched)
      .add({"source", "1", "Row of the marched cell whose end this one has, from 0 within the case."}, &CellRow::source)
      .add(status_column, &CellRow::status)
      .add(reason_column, &CellRow::reason);
  return {"cells", "One cell of the grid of one case: a start, or a scene, and where it leads.", rows};
}

NumberType<SectionColumns> points_type(const SweptColumns& swept) {
  NumberType<SectionColumns> type("points", "One point of the section of one orbit.");
  type.add(swept.parameter, &SectionColumns::parameter).add(start_column, &SectionColumns::start);
  return add_section(type);
}

NumberType<ImpactColumns> impacts_type(const SweptColumns& swept) {
  NumberType<ImpactColumns> type("impacts",
                                 "One impact of one orbit: of one period of what repeats, else of every kept period.");
  type.add(swept.parameter, &ImpactColumns::parameter)
      .add(start_column, &ImpactColumns::start)
      .add({"phase", "rad", "Phase of the forcing at the impact."}, &ImpactColumns::phase)
      .add({"side", "", "The stop that is hit: lower or upper."}, &ImpactColumns::side)
      .add({"speed", "m/s", "Speed at which the contact point closes."}, &ImpactColumns::speed)
      .add({"x", "m", "Place of the contact point."}, &ImpactColumns::x)
      .add({"t", "s", "Time since the orbit began: at t = 0, or where its neighbour ended."}, &ImpactColumns::t);
  return type;
}

NumberType<PortraitColumns> portraits_type(const SweptColumns& swept) {
  NumberType<PortraitColumns> type("portraits", "", false);
  type.add(swept.parameter, &PortraitColumns::parameter)
      .add(start_column, &PortraitColumns::start)
      .add({"time", "s", "Time from the strobe that the portrait begins at."}, &PortraitColumns::time)
      .add({"tip_displacement", "m", "Absolute displacement of the tip."}, &PortraitColumns::displacement)
      .add({"tip_velocity", "m/s", "Velocity of the tip."}, &PortraitColumns::velocity);
  return type;
}

NumberType<EntryColumns> entries_type(const SweptColumns& swept) {
  NumberType<EntryColumns> type("entries", "", false);
  type.add(swept.parameter, &EntryColumns::parameter)
      .add(start_column, &EntryColumns::start)
      .add({"index", "1", "Place of the number in the state."}, &EntryColumns::index)
      .add({"value", "", "One number of the state that the kept periods begin with."}, &EntryColumns::value);
  return type;
}

NumberType<SectionColumns> cell_points_type() {
  NumberType<SectionColumns> type("cell_points", "", false);
  type.add({"cell", "1", "Row of the cell in `cells`, from 0."}, &SectionColumns::cell);
  return add_section(type);
}

NumberType<ContactLawColumns> contact_law_type() {
  NumberType<ContactLawColumns> type("contact_law", "", false);
  type.add({"compliance", "m/N", "How much the contact law gives way, 0 for a rigid one; empty: not known."},
           &ContactLawColumns::compliance);
  return type;
}

TableType<AttractorRow> attractors_type(const SweptColumns& swept) {
  RowType<AttractorRow> rows;
  rows.add({"attractor", "", "Number of the attractor, as in values.csv or cells.csv."}, &AttractorRow::attractor)
      .add({"label", "",
            "common to all, depends on AXIS, depends on several choices, vanishes under refinement, or not compared."},
           &AttractorRow::label)
      .add({"cases", "1", "Cases that have it."}, &AttractorRow::cases)
      .add(in_units_of(swept.parameter, "from", "Smallest value of the parameter at which some case has it."),
           &AttractorRow::from)
      .add(in_units_of(swept.parameter, "to", "Largest such value."), &AttractorRow::to)
      .add(class_column, &AttractorRow::regime)
      .add(period_column, &AttractorRow::period)
      .add(
          {"symmetric", "", "Whether its orbits are their own mirror images; empty where they differ or are not told."},
          &AttractorRow::symmetric)
      .add({"fraction", "1", "Share of the starts, or of the cells, that lead there, where a case shows it."},
           &AttractorRow::fraction)
      .add({"fraction_low", "1", "Lower end of the 95 % interval of that share (Wilson)."}, &AttractorRow::fraction_low)
      .add({"fraction_high", "1", "Upper end of that interval."}, &AttractorRow::fraction_high)
      .add({"presence", "", "For each level of the deciding axis, how many of its cases show it."},
           &AttractorRow::presence)
      .add({"sentence", "", "The same in words."}, &AttractorRow::sentence);
  return {"attractors", "Over all cases: one attractor.", rows};
}

TableType<AgreementRow> agreement_type() {
  RowType<AgreementRow> rows;
  rows.add({"case", "", "One case."}, &AgreementRow::id)
      .add({"other_case", "", "The case it is compared with."}, &AgreementRow::other)
      .add({"compared", "1", "Values and starts at which both are decided."}, &AgreementRow::compared)
      .add({"same_class", "1", "How many of these have the same class."}, &AgreementRow::same)
      .add({"share", "1", "same_class over compared."}, &AgreementRow::share)
      .add({"same_attractor", "1", "How many of these are on the same attractor."}, &AgreementRow::same_attractor)
      .add({"share_attractor", "1", "same_attractor over compared."}, &AgreementRow::share_attractor);
  return {"agreement", "One ordered pair of cases: how often they agree, a case with itself included.", rows};
}

TableType<VerdictRow> verdicts_type(const SweptColumns& swept) {
  RowType<VerdictRow> rows;
  rows.add(in_units_of(swept.parameter, "from", "Where the interval begins: half way to the value before."),
           &VerdictRow::from)
      .add(in_units_of(swept.parameter, "to", "Where it ends: half way to the value behind."), &VerdictRow::to)
      .add({"verdict", "", "robust (same classes and branches in every case), depends, or undecided."},
           &VerdictRow::verdict)
      .add({"choice", "", "The axis that decides, or several choices; empty where none does."}, &VerdictRow::choice)
      .add({"sentence", "", "The same in words, with what each choice leads to."}, &VerdictRow::sentence);
  return {"intervals",
          "Over all cases: one interval of the parameter, and whether its motion depends on a numerical choice.", rows};
}

TableType<DistanceRow> distances_type(const SweptColumns& swept) {
  RowType<DistanceRow> rows;
  rows.of_case(&DistanceRow::id)
      .add({"reference_case", "",
            "The case compared with: a rigid contact, the most steps, the most elements, all dofs or the most modes."},
           &DistanceRow::reference)
      .add(swept.parameter, &DistanceRow::parameter)
      .add(start_column, &DistanceRow::start)
      .add({"wasserstein", "1",
            "Wasserstein-1 distance of the sections, displacements and velocities over their spread in the study."},
           &DistanceRow::wasserstein)
      .add({"hausdorff", "1", "Hausdorff distance of the same."}, &DistanceRow::hausdorff)
      .add({"null_wasserstein", "1", "Wasserstein-1 distance between two halves of the reference orbit itself."},
           &DistanceRow::null_wasserstein)
      .add({"null_hausdorff", "1", "Hausdorff distance between these halves."}, &DistanceRow::null_hausdorff)
      .add({"ratio", "1", "wasserstein over null_wasserstein; empty where an orbit repeats exactly."},
           &DistanceRow::ratio)
      .add({"same_class", "", "Whether both have the same class; empty where one is undecided."},
           &DistanceRow::same_class)
      .add({"formula", "", "exact, or sliced where the sections are too large for the exact distance."},
           &DistanceRow::formula);
  return {"distances",
          "One orbit of one case against that of the reference case at the same value and from the same start.", rows};
}

TableType<ShiftRow> shifts_type(const SweptColumns& swept) {
  const Column& of = swept.parameter;
  RowType<ShiftRow> rows;
  rows.of_case(&ShiftRow::id)
      .add({"reference_case", "", "The case compared with, as in distances.csv."}, &ShiftRow::reference)
      .add(start_column, &ShiftRow::start)
      .add({"from", "", "Class below the change."}, &ShiftRow::from)
      .add({"to", "", "Class above it."}, &ShiftRow::to)
      .add({"kind", "",
            "grazing (contact begins or ends), lift-off (a contact that never opens begins to) or change (any other)."},
           &ShiftRow::kind)
      .add(in_units_of(of, "reference_value", "Where the reference case has the change; empty where it has none."),
           &ShiftRow::reference_value)
      .add(in_units_of(of, "value", "Where this case has it; empty where it has none."), &ShiftRow::value)
      .add(in_units_of(of, "shift", "value less reference_value."), &ShiftRow::shift)
      .add(in_units_of(of, "low", "Least shift that the two brackets allow."), &ShiftRow::low)
      .add(in_units_of(of, "high", "Largest shift that they allow."), &ShiftRow::high)
      .add({"found", "", "Whether both have the change within a tenth of the range of values."}, &ShiftRow::found);
  return {"shifts", "One change of the motion of one case against the same change in the reference case.", rows};
}

TableType<FractionRow> basin_fractions_type() {
  RowType<FractionRow> rows;
  rows.of_case(&FractionRow::id)
      .add({"attractor", "", "Number of the attractor, as in cells.csv."}, &FractionRow::attractor)
      .add(class_column, &FractionRow::regime)
      .add(period_column, &FractionRow::period)
      .add({"cells", "1", "Cells that lead there."}, &FractionRow::cells)
      .add({"fraction", "1", "Their share of the decided cells."}, &FractionRow::fraction)
      .add({"low", "1", "Lower end of the 95 % interval of that share (Wilson)."}, &FractionRow::low)
      .add({"high", "1", "Upper end of that interval."}, &FractionRow::high);
  return {"basin_fractions",
          "One attractor in one case: its share of the grid. Cells that begin beyond a stop are no starts.", rows};
}

TableType<BasinDifferenceRow> basin_differences_type() {
  RowType<BasinDifferenceRow> rows;
  rows.add({"case", "", "One case."}, &BasinDifferenceRow::id)
      .add({"other_case", "", "The case it is compared with."}, &BasinDifferenceRow::other)
      .add({"cells", "1", "Cells that both decide."}, &BasinDifferenceRow::cells)
      .add({"differ", "1",
            "Those that lead to different attractors: an orbit of one class and period may lie elsewhere."},
           &BasinDifferenceRow::differ)
      .add({"other_motion", "1", "Those that lead to a motion of another class or period."},
           &BasinDifferenceRow::motions)
      .add({"share", "1", "differ over cells."}, &BasinDifferenceRow::share);
  return {"basin_differences", "One pair of cases: how many cells lead elsewhere.", rows};
}

TableType<UncertaintyRow> basin_uncertainty_type() {
  RowType<UncertaintyRow> rows;
  rows.of_case(&UncertaintyRow::id)
      .add({"boundary_share", "1", "Share of the decided cells that have a neighbour of another basin."},
           &UncertaintyRow::boundary_share)
      .add({"exponent", "1",
            "Uncertainty exponent: f(ε) ~ ε^exponent for the share f of cells whose end an error ε may change."},
           &UncertaintyRow::exponent)
      .add({"low", "1", "Lower end of its 95 % interval."}, &UncertaintyRow::low)
      .add({"high", "1", "Upper end of that interval."}, &UncertaintyRow::high);
  return {"basin_uncertainty", "One case: how rough the boundary of its basins is.", rows};
}

void describe_sweep(std::vector<CaseRecord>& cases, const SweptColumns& swept) {
  std::size_t columns = 0;  // more than there are exponents
  for (const CaseRecord& record : cases)
    if (const Table* values = find_table(record.tables, values_name))
      columns = std::max(columns, values->columns.size());
  NumberTable impacts = impacts_type(swept).head();
  impacts.columns.push_back(stop_column);
  describe(cases, {values_head(static_cast<int>(columns), swept), bifurcations_head(swept), cells_type(swept).head()},
           {points_type(swept).head(), impacts, portraits_type(swept).head(), entries_type(swept).head(),
            cell_points_type().head(), contact_law_type().head()});
}

}  // namespace ricochet
