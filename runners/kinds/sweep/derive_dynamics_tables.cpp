#include <algorithm>
#include <cmath>

#include "runners/kinds/sweep/derive_dynamics_parts.hpp"

namespace ricochet::dynamics {
namespace {

/// A change moves by less than this share of the values' range; further away there is another one.
constexpr double kReach = 0.1;

/// Whether a class is none: what comes before or after it is no change of the motion.
bool open(const std::string& regime) {
  return regime == text(Regime::undecided) || regime == text(Regime::failed);
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
  const DerivedTable* table = table_of(record, "bifurcations");
  if (!table) return out;
  const auto word = [&](std::size_t row, const std::string& column) {
    const Json cell = cell_of(*table, row, column_of(*table, column));
    return cell.is_string() ? cell.get<std::string>() : std::string();
  };
  const auto number = [&](std::size_t row, const std::string& column) {
    return number_of(cell_of(*table, row, column_of(*table, column)));
  };
  for (std::size_t r = 0; r < table->rows.size(); ++r) {
    const auto value = number(r, "value");
    if (!value || open(word(r, "from")) || open(word(r, "to"))) continue;
    out.push_back({word(r, "start"), word(r, "from"), word(r, "to"), word(r, "kind"), *value,
                   number(r, "low").value_or(*value), number(r, "high").value_or(*value)});
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

DerivedTable agreement_table(const Diagram& diagram) {
  DerivedTable table{
      "agreement", {"case", "other_case", "compared", "same_class", "share", "same_attractor", "share_attractor"}, {}};
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
        same_class += a.motion == b.motion;
        same_attractor += a.attractor == b.attractor;
      }
      const auto share = [&](int count) {
        return compared > 0 ? Json(static_cast<double>(count) / compared) : Json(nullptr);
      };
      table.rows.push_back({one.record->id, other.record->id, compared, same_class, share(same_class), same_attractor,
                            share(same_attractor)});
    }
  return table;
}

DerivedTable shifts_table(const Diagram& diagram) {
  DerivedTable table = table_with_axes(
      *diagram.results, "shifts",
      {"reference_case", "start", "from", "to", "kind", "reference_value", "value", "shift", "low", "high", "found"});
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
      Row row = axes_row(*diagram.results, *owner.record);
      row.insert(row.end(), {standard.id, change.start, change.from, change.to, change.kind});
      row.push_back(standing ? Json(standing->value) : Json(nullptr));
      row.push_back(found ? Json(found->value) : Json(nullptr));
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
