#include "runners/kinds/sweep/sweep_summaries.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <ricochet/measure/attractors/opinions.hpp>

#include "runners/kinds/sweep/study_diagram.hpp"
#include "runners/store/record_values.hpp"
#include "runners/table/in_order_met.hpp"
#include "runners/table/table_reader.hpp"

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
              {{"verdict", "", "robust, depends or undecided; see verdicts.csv."},
               {"choice", "", "The axis that decides, or several choices; empty where none does."},
               {"intervals", "1", "Intervals of verdicts.csv with this verdict and choice."},
               {"width", unit, "Their widths together."},
               {"share", "1", "That width over the width of all intervals."},
               {"from", unit, "Smallest value of the parameter that is compared, the same in every row."},
               {"to", unit, "Largest such value."}},
              {}};
  const TableReader rows(verdicts);
  const std::size_t from = rows.column("from"), to = rows.column("to"), verdict = rows.column("verdict"),
                    choice = rows.column("choice");
  std::map<std::tuple<int, std::string, std::string>, VerdictShare> shares;
  Bounds range;
  double total = 0;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const std::string word = rows.text(row, verdict);
    VerdictShare& share = shares[{rank_of(word), word, rows.text(row, choice)}];
    ++share.intervals;
    const auto low = rows.number(row, from), high = rows.number(row, to);
    if (!low || !high) continue;
    range.include(*low);
    range.include(*high);
    share.width += *high - *low;
    total += *high - *low;
  }
  for (const auto& [key, share] : shares)
    table.rows.push_back({std::get<1>(key), std::get<2>(key), share.intervals, share.width,
                          total > 0 ? Cell(share.width / total) : Cell(), range.low, range.high});
  return table;
}

Table class_counts_table(const StudyResults& results) {
  Table table =
      table_of_cases(results, "class_counts", "One class of motion in one case: how many of its orbits have it.",
                     {{"class", "", "Class of the orbits; failed where they were refused or stopped."},
                      {"period", "1", "Forcing periods after which a periodic orbit repeats."},
                      {"orbits", "1", "Orbits (values and starts) with this class."},
                      {"share", "1", "Their share of the orbits of the case."}});
  for (const CaseRecord& record : results.cases) {
    const std::vector<OrbitRow> orbits = orbits_of(record);
    std::vector<std::pair<std::pair<std::string, std::optional<int>>, int>> counts;  // by class and period
    for (const OrbitRow& orbit : orbits)
      ++in_order_met(counts, orbit.done() ? std::pair(orbit.regime, orbit.period)
                                          : std::pair(std::string("failed"), std::optional<int>()));
    for (const auto& [motion, count] : counts)
      add_row(table, place_of(results, record),
              {motion.first, motion.second, count, static_cast<double>(count) / static_cast<double>(orbits.size())});
  }
  return table;
}

Table grazing_ranges_table(const StudyResults& results, const SweptColumns& swept) {
  const std::string& unit = swept.parameter.unit;
  Table table{"grazing_ranges",
              "Over all cases: where contact begins or ends, from one start.",
              {{"start", "", "Where the orbits begin, as in values.csv."},
               {"changes", "1", "Changes of kind grazing, over the cases."},
               {"low", unit, "The smallest value of the parameter at which one is located."},
               {"high", unit, "The largest such value."},
               {"bracket", unit, "Width of the widest interval that a change is located to."}},
              {}};
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
  for (const auto& [start, one] : found)
    table.rows.push_back({start, one.changes, one.values.low, one.values.high, one.bracket});
  return table;
}

Table numerical_viscosity_table(const StudyResults& results) {
  Table table = table_of_cases(
      results, "numerical_viscosity", "One case: the stiffness viscosity that its scheme adds to that of the scene.",
      {{"low", "s", "Smallest equivalent viscosity over values and starts; negative where the scheme feeds energy."},
       {"high", "s", "Largest equivalent viscosity."},
       {"physical_low", "s", "Smallest α of C = αK in the scene, over the same; empty where it is not known."},
       {"physical_high", "s", "Largest such α."},
       {"share", "1", "Largest modulus of the equivalent viscosity over α; empty where there is no α to compare with."},
       {"small", "", "Whether that share is at most 1 %."}});
  for (const CaseRecord& record : results.cases) {
    Bounds numerical, physical;
    double share = 0;
    bool undamped = false;
    for (const OrbitRow& orbit : orbits_of(record)) {
      const auto added = orbit.alpha_equivalent;
      if (!added) continue;
      numerical.include(*added);
      const auto alpha =
          std::isnan(orbit.parameter) ? std::nullopt : dynamics::viscosity_of(results, record, orbit.parameter);
      if (!alpha) continue;
      physical.include(*alpha);
      if (*alpha > 0)
        share = std::max(share, std::abs(*added) / *alpha);
      else
        undamped = true;
    }
    if (!numerical.low) continue;
    const bool compared = physical.low && !undamped;
    add_row(table, place_of(results, record),
            {numerical.low, numerical.high, physical.low, physical.high, compared ? Cell(share) : Cell(),
             compared ? Cell(share <= small_viscosity) : Cell()});
  }
  return table;
}

}  // namespace ricochet
