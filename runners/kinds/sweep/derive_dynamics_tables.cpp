#include <algorithm>
#include <cmath>

#include "runners/kinds/sweep/derive_dynamics_parts.hpp"
#include "runners/store/record_values.hpp"

namespace ricochet::dynamics {
namespace {

/// A change moves by less than this share of the values' range; further away there is another one.
constexpr double kReach = 0.1;

/// Whether a class is none: what comes before or after it is no change of the motion.
bool open(const std::string& regime) {
  return regime == "undecided" || regime == "failed";
}

/// One located change of a case.
struct Change {
  std::string start, from, to, kind;
  double value = 0, low = 0, high = 0;
  bool like(const Change& other) const {
    return start == other.start && from == other.from && to == other.to && kind == other.kind;
  }
};

std::vector<Change> changes_of(const CaseRecord& record) {
  std::vector<Change> out;
  const Table* table = find_table(record.tables, "bifurcations");
  if (!table) return out;
  const TableReader rows(*table);
  const std::size_t start = rows.column("start"), from = rows.column("from"), to = rows.column("to"),
                    kind = rows.column("kind"), value = rows.column("value"), low = rows.column("low"),
                    high = rows.column("high");
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const auto at = rows.number(r, value);
    if (!at || open(rows.text(r, from)) || open(rows.text(r, to))) continue;
    out.push_back({rows.text(r, start), rows.text(r, from), rows.text(r, to), rows.text(r, kind), *at,
                   rows.number(r, low).value_or(*at), rows.number(r, high).value_or(*at)});
  }
  return out;
}

/// Index in `here` of the change that each of `reference` became, −1 where none is left within `reach`: the nearest
/// pairs first.
std::vector<int> nearest_changes(const std::vector<Change>& reference, const std::vector<Change>& here, double reach) {
  struct Pair {
    double distance;
    std::size_t one, other;
  };
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < reference.size(); ++i)
    for (std::size_t j = 0; j < here.size(); ++j)
      if (reference[i].like(here[j]) && std::abs(reference[i].value - here[j].value) <= reach)
        pairs.push_back({std::abs(reference[i].value - here[j].value), i, j});
  std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) { return a.distance < b.distance; });
  std::vector<int> out(reference.size(), -1);
  std::vector<char> taken(here.size(), 0);
  for (const Pair& pair : pairs)
    if (out[pair.one] < 0 && !taken[pair.other]) {
      out[pair.one] = static_cast<int>(pair.other);
      taken[pair.other] = 1;
    }
  return out;
}

}  // namespace

Table agreement_table(const Diagram& diagram) {
  Table table = agreement_head();
  if (diagram.cases.size() < 2) return table;
  for (const CaseRuns& one : diagram.cases)
    for (const CaseRuns& other : diagram.cases) {
      int compared = 0, same_class = 0, same_attractor = 0;
      for (std::size_t k = 0; k < one.at.size(); ++k) {
        if (one.at[k] < 0 || other.at[k] < 0) continue;
        const Run &a = one.runs[static_cast<std::size_t>(one.at[k])],
                  &b = other.runs[static_cast<std::size_t>(other.at[k])];
        if (!a.decided() || !b.decided()) continue;
        ++compared;
        same_class += a.kind == b.kind;
        same_attractor += a.attractor == b.attractor;
      }
      const auto share = [&](int count) { return compared > 0 ? Cell(static_cast<double>(count) / compared) : Cell(); };
      table.rows.push_back({one.record->id, other.record->id, compared, same_class, share(same_class), same_attractor,
                            share(same_attractor)});
    }
  return table;
}

Table shifts_table(const Diagram& diagram) {
  Table table = table_of_cases(*diagram.results, shifts_head(diagram.swept));
  const auto reference = reference_case(diagram);
  if (!reference) return table;
  const CaseRecord& standard = *diagram.cases[*reference].record;
  const std::vector<Change> expected = changes_of(standard);
  const double reach = kReach * (diagram.values.back() - diagram.values.front());
  for (std::size_t c = 0; c < diagram.cases.size(); ++c) {
    const CaseRuns& owner = diagram.cases[c];
    if (c == *reference || !owner.any_decided) continue;
    const std::vector<Change> here = changes_of(*owner.record);
    const std::vector<int> match = nearest_changes(expected, here, reach);
    std::vector<char> used(here.size(), 0);
    const auto add = [&](const Change& change, const Change* standing, const Change* found) {
      Row row = place_of(*diagram.results, *owner.record);
      row.insert(row.end(), {standard.id, change.start, change.from, change.to, change.kind});
      row.push_back(standing ? Cell(standing->value) : Cell());
      row.push_back(found ? Cell(found->value) : Cell());
      if (standing && found)
        row.insert(row.end(),
                   {found->value - standing->value, found->low - standing->high, found->high - standing->low, true});
      else
        row.insert(row.end(), {nullptr, nullptr, nullptr, false});
      table.rows.push_back(std::move(row));
    };
    for (std::size_t k = 0; k < expected.size(); ++k) {
      if (match[k] >= 0) used[static_cast<std::size_t>(match[k])] = 1;
      add(expected[k], &expected[k], match[k] < 0 ? nullptr : &here[static_cast<std::size_t>(match[k])]);
    }
    for (std::size_t k = 0; k < here.size(); ++k)
      if (!used[k]) add(here[k], nullptr, &here[k]);
  }
  return table;
}

}  // namespace ricochet::dynamics
