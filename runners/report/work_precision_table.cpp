#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runners/report/evidence.hpp"
#include "runners/report/html.hpp"
#include "runners/report/work_precision.hpp"

namespace ricochet::report {
namespace {

/// The fastest case of a method that is precise enough.
struct Entry {
  std::string method;
  WorkPoint point;
};

std::string name_or_all(std::string label) {
  return label.empty() ? "the one method" : std::move(label);
}

std::vector<Entry> fastest(const CaseView& view, const std::vector<WorkPoint>& points, double tolerance,
                           const std::vector<std::string>& method) {
  std::vector<Entry> out;
  for (const WorkPoint& p : points) {
    if (p.known() > tolerance) continue;
    std::string name = name_or_all(view.label(*p.record, method));
    const auto found = std::find_if(out.begin(), out.end(), [&](const Entry& e) { return e.method == name; });
    if (found == out.end())
      out.push_back({std::move(name), p});
    else if (p.seconds < found->point.seconds)
      found->point = p;
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const Entry& a, const Entry& b) { return a.point.seconds < b.point.seconds; });
  return out;
}

std::string entry_cells(const CaseView& view, const Entry* entry) {
  if (!entry) return "<td class=\"absent\">no other</td><td class=\"absent\">–</td><td class=\"number absent\">–</td>";
  const WorkPoint& p = entry->point;
  std::string how = exact_text(CaseView::number(*p.record, "step").value_or(0)) + " s";
  if (view.varies("elements")) how += ", " + CaseView::text(*p.record, "elements") + " elements";
  return fmt::format("<td>{}</td><td>{}</td><td class=\"number\" title=\"{} to {} s\">{}</td>", escape(entry->method),
                     escape(how), number_text(p.low), number_text(p.high), number_text(p.seconds, 3));
}

std::string row(const CaseView& view, const std::string& head, double tolerance, const std::vector<Entry>& entries) {
  const Entry* second = entries.size() > 1 ? &entries[1] : nullptr;
  std::string out = fmt::format("<tr>{}<td class=\"number\">{}</td>{}{}", head, power_text(tolerance),
                                entry_cells(view, &entries[0]), entry_cells(view, second));
  if (!second) return out + "<td class=\"number absent\">–</td><td class=\"absent\">–</td></tr>\n";
  const WorkPoint &a = entries[0].point, &b = second->point;
  const bool overlap = b.low <= a.high;
  return out + fmt::format("<td class=\"number\">{} ×</td><td>{}</td></tr>\n", number_text(b.seconds / a.seconds, 3),
                           overlap ? "overlap" : "apart");
}

}  // namespace

std::string work_precision_html(const CaseView& view) {
  const WorkPrecision work(view);
  if (work.empty()) return "";
  std::vector<std::string> method = view.varying_without({"step", "elements"});
  std::erase_if(method, [&](const std::string& column) {
    return std::find(work.scene_columns().begin(), work.scene_columns().end(), column) != work.scene_columns().end();
  });
  const std::vector<CaseGroup> scenes = view.group(view.all(), work.scene_columns());
  std::string rows;
  for (const std::string& error : work.errors())
    for (const CaseGroup& scene : scenes) {
      const std::vector<WorkPoint> points = work.points(scene.cases, error);
      if (points.empty()) continue;
      const auto [best, worst] = std::minmax_element(
          points.begin(), points.end(), [](const WorkPoint& a, const WorkPoint& b) { return a.known() < b.known(); });
      Quantity quantity = error_quantity(error);
      quantity.name = error;
      std::string head = fmt::format("<td class=\"text\">{}</td>", escape(with_unit(quantity)));
      if (scenes.size() > 1) head += fmt::format("<td>{}</td>", escape(scene.label));
      // From the power of ten that the worst case misses (or the first that some case reaches) to the last that one
      // does.
      int k = static_cast<int>(std::ceil(-std::log10(worst->known())));
      while (best->known() > std::pow(10, -k)) --k;
      for (;; ++k) {
        const double tolerance = std::pow(10, -k);
        const std::vector<Entry> entries = fastest(view, points, tolerance, method);
        if (entries.empty()) break;
        rows += row(view, head, tolerance, entries);
        if (tolerance <= best->known()) break;
      }
    }
  if (rows.empty()) return "<p>No case has both an error and a run time.</p>\n";
  return fmt::format(
      "<div class=\"scroll{}\"><table class=\"matrix\"><caption>The cheapest method for an error of at most 10<sup>−k"
      "</sup>: of the steps that were run, the one that takes the least time. Spread: fastest to slowest repeat (in "
      "the time's tooltip); where the spreads overlap, the two are not told apart.</caption>\n<thead><tr><th "
      "scope=\"col\">error</th>{}<th scope=\"col\" class=\"number\">at "
      "most</th><th scope=\"col\">cheapest</th><th scope=\"col\">with step</th><th scope=\"col\" class=\"number\">run "
      "time "
      "(s)</th><th scope=\"col\">runner-up</th><th scope=\"col\">with step</th><th scope=\"col\" class=\"number\">run "
      "time (s)</th><th scope=\"col\" class=\"number\">speed-up</th><th "
      "scope=\"col\">spreads</th></tr></thead>\n<tbody>\n{}</tbody></table></div>\n",
      std::count(rows.begin(), rows.end(), '\n') > 24 ? " tall" : "",
      scenes.size() > 1 ? "<th scope=\"col\">scene</th>" : "", rows);
}

}  // namespace ricochet::report
