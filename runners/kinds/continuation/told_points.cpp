#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "runners/kinds/continuation/point_tables.hpp"
#include "runners/kinds/continuation/point_words.hpp"
#include "runners/table/table_reader.hpp"

namespace ricochet {
namespace {

/// Share of stable orbits over the arc from `from` to `to`; nothing where no row lies there.
std::optional<double> stable_share(const std::vector<BranchRow>& rows, double from, double to) {
  double stable = 0, all = 0;
  for (std::size_t k = 0; k + 1 < rows.size(); ++k) {
    const double length = std::min(to, *rows[k + 1].arc) - std::max(from, *rows[k].arc);
    if (length <= 0) continue;
    all += length;
    if (*rows[k].stable) stable += length;
  }
  return all > 0 ? std::optional(stable / all) : std::nullopt;
}

/// Whether stable orbits lie on one side of the point alone. Their share of the arc differs by more than a half between
/// both sides, over 5 % of the branch's arc each. Flickers of multipliers at corners change a share by little. `rows`:
/// by branch, those with an arc that are known to be stable or not.
bool ends_stability(const std::map<std::string, std::vector<BranchRow>>& rows, const SpecialRow& point) {
  const auto branch = rows.find(point.branch);
  if (branch == rows.end() || !point.arc) return false;
  const std::vector<BranchRow>& own = branch->second;
  constexpr double window_share = 0.05, least_difference = 0.5;
  const double window = window_share * (*own.back().arc - *own.front().arc), at = *point.arc;
  const auto before = stable_share(own, at - window, at), after = stable_share(own, at, at + window);
  return before && after && std::abs(*before - *after) > least_difference;
}

/// In the order of the kinds, which is that in which they are told.
constexpr PointWords words_of_points[] = {{"folds", "fold"},
                                          {"becomes a torus", "torus"},
                                          {"loses its symmetry", "loss of symmetry"},
                                          {"doubles its period", "flip"},
                                          {"first touches a stop", "first contact"},
                                          {"leaves a stop that held it", "lift-off"},
                                          {"gains or loses a contact", "change of contact"}};

/// Contacts beyond which another motion begins, stable or not.
bool changes_motion(PointKind kind) {
  return kind == PointKind::first_contact || kind == PointKind::lift_off;
}

}  // namespace

bool at_one_place(const StudyPoint& a, const StudyPoint& b) {
  constexpr double round_off = 1e-9;
  return a.kind == b.kind && std::abs(a.parameter - b.parameter) <= a.half + b.half + round_off * std::abs(b.parameter);
}

const PointWords& point_words(PointKind kind) {
  static constexpr PointWords other = {"changes", "point"};
  return changes_orbit(kind) ? words_of_points[static_cast<std::size_t>(kind)] : other;
}

std::vector<ToldPoint> told_points(const PointAnalysis& of) {
  const StudyPoints& study = of.points;
  const std::string& reference = study.reference()->id;
  // Changes of contact last; else where stability ends, orders, whether a reference has it, the kind, and how well it
  // is located.
  using Rank = std::tuple<bool, bool, bool, bool, bool, PointKind, double, double>;
  std::vector<std::pair<Rank, ToldPoint>> ranked;
  std::map<std::string, std::vector<BranchRow>> rows;
  for (BranchRow& row : branch_rows_in(*find_table(study.reference()->tables, branches_name)))
    if (row.arc && row.stable) rows[row.branch].push_back(std::move(row));
  std::vector<double> contacts;
  for (const StudyPoint& one : study.points())
    if (one.owner == study.root() && one.kind == PointKind::first_contact) contacts.push_back(one.parameter);
  for (std::size_t k = 0; k < study.names().size(); ++k) {
    const NamedPoint& name = study.names()[k];
    const auto limit = std::find_if(of.limits.begin(), of.limits.end(), [&](const PointLimitRow& row) {
      return row.name == name.text && row.id == reference;
    });
    const StudyPoint& point = *name.point;
    if (limit == of.limits.end() || point.owner != study.root()) continue;
    if (point.kind == PointKind::fold && std::any_of(contacts.begin(), contacts.end(), [&](double contact) {
          return std::abs(contact - point.parameter) <= point.half;
        }))
      continue;
    const bool ordered = std::any_of(of.orders.begin(), of.orders.end(), [&](const PointOrderRow& row) {
      return row.name == name.text && row.method == reference && row.verdict == order_told;
    });
    // An interval of a fiftieth of the range locates nothing.
    constexpr double wide_share = 0.02;
    const double width = limit->low && limit->high ? *limit->high - *limit->low : 0;
    const bool wide = width > wide_share * study.range();
    const ToldPoint told{&name, &*limit, ends_stability(rows, point.row)};
    ranked.push_back({{point.kind == PointKind::contact, !told.ends_stability, !ordered, !limit->reference, wide,
                       point.kind, width, -point.row.prominence.value_or(0)},
                      told});
  }
  const auto by_rank = [](const auto& a, const auto& b) { return a.first < b.first; };
  std::stable_sort(ranked.begin(), ranked.end(), by_rank);
  // Where stability ends nowhere, every point is told.
  if (std::any_of(ranked.begin(), ranked.end(), [](const auto& one) { return one.second.ends_stability; }))
    std::erase_if(ranked, [](const auto& one) {
      const PointKind kind = one.second.point().kind;
      return kind == PointKind::contact || (!one.second.ends_stability && !changes_motion(kind));
    });
  // Points of several branches at one place are one.
  std::vector<const StudyPoint*> kept;
  std::erase_if(ranked, [&](const auto& one) {
    const StudyPoint& own = one.second.point();
    if (std::any_of(kept.begin(), kept.end(), [&](const StudyPoint* other) { return at_one_place(own, *other); }))
      return true;
    kept.push_back(&own);
    return false;
  });
  std::map<PointKind, int> met;
  std::vector<std::pair<int, ToldPoint>> turns;
  for (const auto& [rank, told] : ranked) turns.emplace_back(met[told.point().kind]++, told);
  std::stable_sort(turns.begin(), turns.end(), by_rank);
  std::vector<ToldPoint> out;
  for (const auto& [turn, told] : turns) out.push_back(told);
  return out;
}

}  // namespace ricochet
