#include <algorithm>
#include <cmath>
#include <map>
#include <ricochet/measure/attractors/diagram.hpp>

#include "runners/kinds/sweep/diagram_tables.hpp"
#include "runners/kinds/sweep/sweep_tables.hpp"
#include "runners/store/record_values.hpp"
#include "runners/store/rows_of_cases.hpp"
#include "runners/table/in_order_met.hpp"

namespace ricochet {
namespace {

/// Smallest and largest of what was met.
struct Bounds {
  std::optional<double> low, high;
  void include(double value) {
    low = std::min(value, low.value_or(value));
    high = std::max(value, high.value_or(value));
  }
};

struct VerdictShare {
  int intervals = 0;
  double width = 0;
};

int rank_of(const std::string& verdict) {
  return verdict == "robust" ? 0 : verdict == "undecided" ? 2 : 1;
}

}  // namespace

Table verdict_shares_table(const Table& verdicts, const SweptColumns& swept) {
  const std::string& unit = swept.parameter.unit;
  Table table{"verdict_shares",
              "Over all cases: the part of the parameter's range with one verdict.",
              {{"verdict", "", "robust, depends or undecided; see intervals.csv."},
               {"choice", "", "The axis that decides, or several choices; empty where none does."},
               {"intervals", "1", "Intervals of intervals.csv with this verdict and choice."},
               {"width", unit, "Their widths together."},
               {"share", "1", "That width over the width of all intervals."},
               {"from", unit, "Smallest value of the parameter that is compared, the same in every row."},
               {"to", unit, "Largest such value."}},
              {}};
  std::map<std::tuple<int, std::string, std::string>, VerdictShare> shares;
  Bounds range;
  double total = 0;
  for (const VerdictRow& row : verdicts_type().rows.read(verdicts)) {
    VerdictShare& share = shares[{rank_of(row.verdict), row.verdict, row.choice}];
    ++share.intervals;
    if (std::isnan(row.from) || std::isnan(row.to)) continue;
    range.include(row.from);
    range.include(row.to);
    share.width += row.to - row.from;
    total += row.to - row.from;
  }
  for (const auto& [key, share] : shares)
    table.rows.push_back({std::get<1>(key), std::get<2>(key), share.intervals, share.width,
                          total > 0 ? Cell(share.width / total) : Cell(), range.low, range.high});
  return table;
}

TableType<ClassCount> class_counts_type() {
  RowType<ClassCount> rows;
  rows.of_case(&ClassCount::id)
      .add({"class", "", "Class of the orbits; failed where they were refused or stopped."}, &ClassCount::regime)
      .add({"period", "1", "Forcing periods after which a periodic orbit repeats."}, &ClassCount::period)
      .add({"orbits", "1", "Orbits (values and starts) with this class."}, &ClassCount::orbits)
      .add({"share", "1", "Their share of the orbits of the case."}, &ClassCount::share);
  return {"class_counts", "One class of motion in one case: how many of its orbits have it.", rows};
}

Table dynamics::class_counts_table(const StudyDiagram& study) {
  std::vector<ClassCount> rows;
  for (const DiagramSource& source : study.sources) {
    std::vector<std::pair<std::pair<std::string, std::optional<int>>, int>> counts;  // by class and period
    for (const OrbitRow& orbit : source.orbits)
      ++in_order_met(counts, orbit.done() ? std::pair(orbit.regime, orbit.period)
                                          : std::pair(std::string("failed"), std::optional<int>()));
    for (const auto& [motion, count] : counts)
      rows.push_back({source.record->id, motion.first, motion.second, count,
                      static_cast<double>(count) / static_cast<double>(source.orbits.size())});
  }
  return rows_of_cases(*study.results, class_counts_type(), rows);
}

TableType<GrazingRange> grazing_ranges_type(const SweptColumns& swept) {
  const std::string& unit = swept.parameter.unit;
  RowType<GrazingRange> rows;
  rows.add({"start", "", "Where the orbits begin, as in values.csv."}, &GrazingRange::start)
      .add({"changes", "1", "Changes of kind grazing, over the cases."}, &GrazingRange::changes)
      .add({"low", unit, "The smallest value of the parameter at which one is located."}, &GrazingRange::low)
      .add({"high", unit, "The largest such value."}, &GrazingRange::high)
      .add({"bracket", unit, "Width of the widest interval that a change is located to."}, &GrazingRange::bracket);
  return {"grazing_ranges", "Over all cases: where contact begins or ends, from one start.", rows};
}

Table grazing_ranges_table(const StudyResults& results, const SweptColumns& swept) {
  struct Grazings {
    int changes = 0;
    Bounds values;
    double bracket = 0;
  };
  std::vector<std::pair<std::string, Grazings>> found;  // by start
  for (const CaseRecord& record : results.cases)
    for (const ChangeRow& change : changes_of(record)) {
      if (std::isnan(change.value) || change.kind != "grazing") continue;
      Grazings& one = in_order_met(found, change.start);
      ++one.changes;
      one.values.include(change.value);
      if (const double bracket = change.high - change.low; bracket > one.bracket) one.bracket = bracket;
    }
  std::vector<GrazingRange> rows;
  for (const auto& [start, one] : found)
    rows.push_back({start, one.changes, one.values.low, one.values.high, one.bracket});
  return grazing_ranges_type(swept).with(rows);
}

TableType<NumericalViscosity> numerical_viscosity_type() {
  RowType<NumericalViscosity> rows;
  rows.of_case(&NumericalViscosity::id)
      .add(
          {"low", "s", "Smallest equivalent viscosity over values and starts; negative where the scheme feeds energy."},
          &NumericalViscosity::low)
      .add({"high", "s", "Largest equivalent viscosity."}, &NumericalViscosity::high)
      .add({"physical_low", "s", "Smallest α of C = αK in the scene, over the same; empty where it is not known."},
           &NumericalViscosity::physical_low)
      .add({"physical_high", "s", "Largest such α."}, &NumericalViscosity::physical_high)
      .add({"share", "1",
            "Largest modulus of the equivalent viscosity over α; empty where there is no α to compare with."},
           &NumericalViscosity::share)
      .add({"small", "", "Whether that share is at most 1 %."}, &NumericalViscosity::small);
  return {"numerical_viscosity", "One case: the stiffness viscosity that its scheme adds to that of the scene.", rows};
}

Table dynamics::numerical_viscosity_table(const StudyDiagram& study) {
  std::vector<NumericalViscosity> rows;
  for (const DiagramSource& source : study.sources) {
    Bounds numerical, physical;
    double share = 0;
    bool undamped = false;
    for (const OrbitRow& orbit : source.orbits) {
      const auto added = orbit.alpha_equivalent;
      if (!added) continue;
      numerical.include(*added);
      const auto alpha =
          std::isnan(orbit.parameter) ? std::nullopt : viscosity_of(*study.results, *source.record, orbit.parameter);
      if (!alpha) continue;
      physical.include(*alpha);
      if (*alpha > 0)
        share = std::max(share, std::abs(*added) / *alpha);
      else
        undamped = true;
    }
    if (!numerical.low) continue;
    const bool compared = physical.low && !undamped;
    NumericalViscosity& row = rows.emplace_back();
    row = {source.record->id, numerical.low, numerical.high, physical.low, physical.high, {}, {}};
    if (compared) {
      row.share = share;
      row.small = share <= small_viscosity;
    }
  }
  return rows_of_cases(*study.results, numerical_viscosity_type(), rows);
}

}  // namespace ricochet
