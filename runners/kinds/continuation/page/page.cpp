#include "runners/kinds/continuation/page/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>

#include "runners/kinds/continuation/point_tables.hpp"
#include "runners/kinds/continuation/point_words.hpp"
#include "runners/kinds/sweep/page/orbits.hpp"
#include "runners/kinds/sweep/with_parameter.hpp"
#include "runners/report/html.hpp"
#include "runners/report/quantity.hpp"

namespace ricochet::report {

KindPage continuation_page(std::shared_ptr<const PointAnalysis> points) {
  KindPage page;
  page.scripts = scripts({"branches", "branch_panel", "branch_figure", "special_points", "multipliers", "turns"});
  page.tables = {"special_points", "turns", "point_presence", "point_levels", "point_lines"};
  page.derived = {[points](const Choices&) { return point_levels(*points); },
                  [points](const Choices&) { return point_lines(*points); }};
  page.answer = [points](const Choices& choices) { return points_html(choices, *points); };
  page.methods = [points](const Choices& choices) { return point_methods_html(choices, *points); };
  page.data_key = "branches";
  page.data = branch_data;
  page.masses = false;
  return page;
}

namespace {

/// "0.100565 ± 2e-6".
std::string limit_text(const PointLimitRow& row) {
  const auto half = row.low && row.high ? std::optional(0.5 * (*row.high - *row.low)) : std::nullopt;
  return point_value(row.limit.value_or(NAN), half);
}

std::string order_text(const PointOrderRow& row) {
  if (!row.order || row.verdict != order_told) return row.verdict;
  return fmt::format("{} ± {}", number_text(*row.order, 2), number_text(0.5 * (*row.high - *row.low), 1));
}

/// The cells of orders and of presence, of all points.
struct PointCells {
  explicit PointCells(const PointAnalysis& of) : orders(of.orders), presence(of.presence) {
    for (const PointOrderRow& row : orders)
      if (std::find(refined.begin(), refined.end(), row.refined) == refined.end()) refined.push_back(row.refined);
  }
  void order_cells(HtmlTable& table, const PointLimitRow& row) const {
    for (const std::string& one : refined) {
      const auto found = std::find_if(orders.begin(), orders.end(), [&](const PointOrderRow& order) {
        return order.name == row.name && order.method == row.id && order.refined == one;
      });
      table.number(found == orders.end() ? "–" : order_text(*found), found == orders.end() ? "" : found->reason);
    }
  }
  /// How many cases have the point and no other at its place.
  int found(const std::string& name) const {
    return static_cast<int>(std::count_if(presence.begin(), presence.end(), [&](const PointPresenceRow& one) {
      return one.name == name && one.presence == word(PointPresence::found);
    }));
  }
  /// "33 of 36, 3 without".
  std::string cases_text(const std::string& name) const {
    std::map<std::string, int> counts;
    for (const PointPresenceRow& one : presence)
      if (one.name == name) ++counts[one.presence];
    const int found = counts["found"] + counts["many"], absent = counts["absent"], away = counts["not reached"];
    std::string out = fmt::format("{} of {}", found, found + absent + away);
    if (absent > 0) out += fmt::format(", {} without", absent);
    if (away > 0) out += fmt::format(", {} elsewhere", away);
    return out;
  }
  const std::vector<PointOrderRow>& orders;
  const std::vector<PointPresenceRow>& presence;
  std::vector<std::string> refined;
};

/// The heads of the columns of orders: "order in h".
const char* order_head(const std::string& refined) {
  return refined == "steps_per_period" ? "order in h" : refined == "contact.stiffness" ? "order in 1/κ" : "order in ℓ";
}

/// The place of a name in a row in which those that the answer tells stand first.
std::ptrdiff_t told_place(const PointAnalysis& of, const std::string& name) {
  return std::find_if(of.told.begin(), of.told.end(), [&](const ToldPoint& one) { return one.name->text == name; }) -
         of.told.begin();
}

}  // namespace

std::string points_html(const Choices& choices, const PointAnalysis& of) {
  const PointCells rows(of);
  std::vector<HtmlTable::Head> columns = {{"point"}, {with_unit(swept_parameter(choices.results())), true}};
  for (const std::string& one : rows.refined) columns.push_back({order_head(one), true});
  columns.push_back({"cases that have it", true, "Without: a branch passed the place. Elsewhere: none came there."});
  // What the answer tells; then what most is known of: orders, cases that have it; changes of contact last.
  std::vector<PointLimitRow> shown;
  for (const PointLimitRow& row : of.limits)
    if (row.limit &&
        std::none_of(shown.begin(), shown.end(), [&](const PointLimitRow& before) { return before.name == row.name; }))
      shown.push_back(row);
  const auto rank = [&](const PointLimitRow& row) {
    const bool told = std::any_of(rows.orders.begin(), rows.orders.end(), [&](const PointOrderRow& order) {
      return order.name == row.name && order.method == row.id && order.verdict == order_told;
    });
    const bool change = row.name.find("contact at") != std::string::npos && row.name.find("first") == std::string::npos;
    return std::make_tuple(told_place(of, row.name), change, !told, -rows.found(row.name));
  };
  std::stable_sort(shown.begin(), shown.end(),
                   [&](const PointLimitRow& a, const PointLimitRow& b) { return rank(a) < rank(b); });
  constexpr std::size_t most_shown = 12;
  const std::size_t all = shown.size();
  if (shown.size() > most_shown) shown.resize(most_shown);
  HtmlTable table(
      fmt::format("Special points that the two finest cases of a refinement share, with the first method that has "
                  "them{}.",
                  all > most_shown ? fmt::format("; the {} of {} that most is known of", most_shown, all) : ""),
      columns);
  for (const PointLimitRow& row : shown) {
    table.row(row.name).number(limit_text(row), exact_text(*row.limit));
    rows.order_cells(table, row);
    table.number(rows.cases_text(row.name));
  }
  return table.size() > 0 ? table.html() : "";
}

std::string point_methods_html(const Choices& choices, const PointAnalysis& of) {
  const PointCells rows(of);
  std::vector<HtmlTable::Head> columns = {{"point"}, {"method"}, {with_unit(swept_parameter(choices.results())), true}};
  for (const std::string& one : rows.refined) columns.push_back({order_head(one), true});
  for (const char* one : {"step leaves open", "mesh leaves open", "stiffness leaves open", "reference", "from it"})
    columns.push_back({one, true});
  HtmlTable table(
      "Special points by method, at the limit of all refinements; ±: what these leave open and the interval of the "
      "finest point. Order: by differences of successive sizes.",
      columns);
  for (const PointLimitRow& row : of.limits) {
    const CaseRecord* record = choices.find(row.id);
    if (!record || !row.limit) continue;
    table.row(row.name).text(
        choices.short_label(*record, choices.varying_without({"elements", "modes", "steps_per_period"})));
    table.number(limit_text(row), exact_text(*row.limit));
    rows.order_cells(table, row);
    for (const auto& open : {row.step_open, row.mesh_open, row.law_open}) table.number(open, 2);
    table.number(row.reference, 8).number(row.reference_gap, 2);
  }
  return table.size() > 0 ? "<h3>Special points by method</h3>\n" + table.html() : "";
}

Table point_levels(const PointAnalysis& of) {
  const std::string unit = swept_columns(of.points.study().results()).parameter.unit;
  Table out{"point_levels",
            "One row per point that has a name, refinement and case along it: how far the point is from its limit.",
            {{"name", "", "Name of the special point."},
             {"refined", "", "What is refined."},
             {"method", "", "The finest case of the method."},
             {"case", "", "Identity of the case: its row in cases.csv."},
             {"size", "1", "The step as a share of the period, one over the elements, or the compliance."},
             {"value", unit, "Parameter at the point; nothing where the case lacks it."},
             {"distance", unit, "Its distance from the limit along the refinement."},
             {"half", unit, "Half the width of the interval of the point."},
             {"presence", "", "found, many, absent or not reached."}},
            {}};
  const StudyPoints& study = of.points;
  std::vector<std::size_t> names(study.names().size());
  std::iota(names.begin(), names.end(), std::size_t{0});
  std::stable_sort(names.begin(), names.end(), [&](std::size_t a, std::size_t b) {
    return told_place(of, study.names()[a].text) < told_place(of, study.names()[b].text);
  });
  for (const std::size_t name : names)
    for (const PointConvergence& found : of.convergence[name]) {
      const int number = static_cast<int>(name);
      const std::size_t head = found.finest;
      const auto add = [&](std::size_t axis, std::size_t c, const StudyPoint* point, const PointLimit& limit) {
        Row row = {study.names()[name].text, study.axes()[axis].column, study.cases()[head]->id, study.cases()[c]->id,
                   Cell(study.axes()[axis].size(*study.cases()[c]))};
        row.push_back(point ? Cell(point->parameter) : Cell());
        row.push_back(point ? Cell(std::abs(point->parameter - limit.value)) : Cell());
        row.push_back(point ? Cell(point->half) : Cell());
        row.push_back(word(study.presence(c, number, nullptr)));
        out.rows.push_back(std::move(row));
      };
      std::vector<bool> told(study.axes().size(), false);
      for (const PointConvergence::Along& one : found.along) {
        told[one.axis] = true;
        const PointLimit limit = study.limit(one, number);
        for (const std::size_t c : study.along(one.finest, one.axis)) add(one.axis, c, study.find(c, number), limit);
      }
      // Where the finest case alone has the point, those that lack it say so.
      for (std::size_t axis = 0; found.point && axis < told.size(); ++axis)
        for (const std::size_t c : study.along(head, axis))
          if (!told[axis] && study.presence(c, number, nullptr) == PointPresence::absent) add(axis, c, nullptr, {});
    }
  return out;
}

Table point_lines(const PointAnalysis& of) {
  const std::string unit = swept_columns(of.points.study().results()).parameter.unit;
  Table out{"point_lines",
            "One row per point that has a name, refinement and method whose order is told: the fitted distance from "
            "the limit.",
            {{"name", "", "Name of the special point."},
             {"refined", "", "What is refined."},
             {"method", "", "The finest case of the method."},
             {"from", "1", "Smallest size."},
             {"to", "1", "Largest size."},
             {"distance_from", unit, "Fitted distance at the smallest size."},
             {"distance_to", unit, "Fitted distance at the largest size."},
             {"order", "1", "The order."}},
            {}};
  const StudyPoints& study = of.points;
  for (std::size_t name = 0; name < study.names().size(); ++name)
    for (const PointConvergence& found : of.convergence[name])
      for (const PointConvergence::Along& one : found.along) {
        const PointLimit limit = study.limit(one, static_cast<int>(name));
        if (!one.order.told || limit.correction == 0) continue;
        double from = INFINITY, to = 0;
        for (const std::size_t c : study.along(one.finest, one.axis))
          if (const auto size = study.axes()[one.axis].size(*study.cases()[c]);
              size && study.find(c, static_cast<int>(name))) {
            from = std::min(from, *size);
            to = std::max(to, *size);
          }
        const double distance = std::abs(limit.correction);
        out.rows.push_back({study.names()[name].text, study.axes()[one.axis].column, study.cases()[found.finest]->id,
                            from, to, distance, distance * std::pow(to / from, *one.order.order), *one.order.order});
      }
  return out;
}

}  // namespace ricochet::report
