#include "runners/report/report.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "runners/report/answer.hpp"
#include "runners/report/assets.hpp"
#include "runners/report/case_view.hpp"
#include "runners/report/curve_data.hpp"
#include "runners/report/dynamics_report.hpp"
#include "runners/report/evidence.hpp"
#include "runners/report/figures.hpp"
#include "runners/report/html.hpp"
#include "runners/report/orbit_data.hpp"
#include "runners/report/orbits.hpp"
#include "runners/report/page.hpp"
#include "runners/report/tables.hpp"

namespace ricochet {
namespace report {
namespace {

constexpr const char* policy =
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:; base-uri 'none'; "
    "form-action 'none'";

bool sweeps(const StudyResults& results) {
  return results.kind == "bifurcation" || results.kind == "basins";
}

std::string status_line(const CaseView& view) {
  const StudyResults& results = view.results();
  std::string counts;
  for (const char* status : {"done", "refused", "diverged", "failed"})
    if (const size_t count = view.with_status(status).size())
      counts += fmt::format("{}{} {}", counts.empty() ? "" : ", ", count, status);
  const size_t have = results.cases.size(), expected = static_cast<size_t>(std::max(results.expected_cases, 0));
  std::string out = fmt::format("<p class=\"status-line\">{}{}.</p>\n", count_text(have, "case", "cases"),
                                counts.empty() ? "" : ": " + counts);
  if (const auto partial = std::count_if(results.cases.begin(), results.cases.end(),
                                         [](const CaseRecord& record) { return is_partial(record); });
      partial > 0)
    out += fmt::format(
        "<p class=\"banner\" role=\"status\"><strong>{} still being worked on.</strong> What they have so far is "
        "shown; "
        "running the study again goes on from there.</p>\n",
        partial == 1 ? "One case is" : fmt::format("{} cases are", partial));
  if (have < expected)
    out += fmt::format(
        "<p class=\"banner\" role=\"status\"><strong>Partial results: {} of {} so far.</strong> Everything below "
        "speaks of these alone; "
        "running the study again adds the rest.</p>\n",
        have, count_text(expected, "case", "cases"));
  return out;
}

std::string list_html(const char* classes, const std::vector<std::string>& items) {
  if (items.empty()) return "";
  std::string out = fmt::format("<ul class=\"{}\">", classes);
  for (const std::string& text : items) out += "<li>" + escape(text) + "</li>";
  return out + "</ul>";
}

std::string legend_html(const Figure& figure) {
  if (figure.legend.size() < 2) return "";
  std::string out = "<div class=\"legend\" role=\"group\" aria-label=\"Show or hide curves\">", heading;
  for (const LegendEntry& entry : figure.legend) {
    if (entry.heading != heading) {
      out += fmt::format("{}<span class=\"heading\">{}</span>", heading.empty() ? "" : "<span class=\"line\"></span>",
                         escape(entry.heading));
      heading = entry.heading;
    }
    const std::string line =
        fmt::format("<line x1=\"0\" y1=\"6\" x2=\"30\" y2=\"6\" stroke=\"{}\" stroke-width=\"2.2\"{}/>", entry.colour,
                    entry.dash.empty() ? "" : " stroke-dasharray=\"" + entry.dash + "\"");
    std::string mark;
    if (entry.symbol == "circle") mark = "<circle cx=\"15\" cy=\"6\" r=\"4\"";
    if (entry.symbol == "rect" || entry.symbol == "roundRect") mark = "<rect x=\"11\" y=\"2\" width=\"8\" height=\"8\"";
    if (entry.symbol == "triangle" || entry.symbol == "arrow") mark = "<path d=\"M15 1 L20 10 L10 10 Z\"";
    if (entry.symbol == "triangle-down") mark = "<path d=\"M10 2 L20 2 L15 11 Z\"";
    if (entry.symbol == "cross") mark = "<path stroke=\"#222\" d=\"M11 2 L19 10 M19 2 L11 10\"";
    if (entry.symbol == "diamond") mark = "<path d=\"M15 1 L20 6 L15 11 L10 6 Z\"";
    if (!mark.empty()) mark += fmt::format(" fill=\"{}\"/>", entry.colour);
    out += fmt::format(
        "<button type=\"button\" aria-pressed=\"true\" data-name=\"{0}\" data-colour=\"{3}\" data-symbol=\"{4}\"><svg "
        "width=\"30\" height=\"12\" "
        "aria-hidden=\"true\">{1}{2}</svg>{0}</button>",
        escape(entry.name), line, mark, entry.colour, entry.symbol);
  }
  return out + "</div>\n";
}

std::string grid_classes(const Figure& figure) {
  if (figure.linked) return figure.charts.size() == 1 ? "grid single broad" : "grid stacked";
  if (figure.charts.size() == 1) return "grid single";
  std::string out = figure.charts.size() > 12 ? "grid many" : figure.charts.size() == 2 ? "grid pair" : "grid";
  for (const Chart& chart : figure.charts)
    if (chart.title.size() > 40) return out + " long-titles";
  return out;
}

std::string figure_html(const Figure& figure) {
  std::string out = fmt::format(
      "<section class=\"figure\" id=\"figure-{0}\" data-figure=\"{0}\">\n<h3>{1}</h3>\n<p "
      "class=\"caption\">{2}</p>\n<div class=\"controls\">",
      figure.id, escape(figure.title), escape(figure.caption));
  if (figure.views.size() > 1) {
    out += "<span class=\"choice\" role=\"group\" aria-label=\"Scale of the vertical axis\">";
    for (size_t v = 0; v < figure.views.size(); ++v)
      out += fmt::format("<button type=\"button\" data-view=\"{}\" aria-pressed=\"{}\">{}</button>", v, v == 0,
                         escape(figure.views[v]));
    out += "</span>";
  }
  if (figure.charts.size() > 1)
    out +=
        "<label title=\"Off: the same vertical scale in all charts, so that they compare\"><input type=\"checkbox\" "
        "data-own> each chart its own scale</label>";
  if (figure.charts.size() > 12)
    out += "<label>Show <input type=\"search\" data-facets placeholder=\"words of a chart's title\"></label>";
  out += "</div>\n" + legend_html(figure) + fmt::format("<div class=\"{}\">\n", grid_classes(figure));
  for (size_t c = 0; c < figure.charts.size(); ++c) {
    const Chart& chart = figure.charts[c];
    const auto alone = [&](const Chart& other) { return &other == &chart || other.only_view != chart.only_view; };
    const bool wide = chart.only_view >= 0 && std::all_of(figure.charts.begin(), figure.charts.end(), alone);
    std::string shown = chart.only_view >= 0 ? fmt::format(" data-only=\"{}\"", chart.only_view) : "";
    if (chart.only_view > 0) shown += " hidden";
    if (wide) shown += " class=\"wide\"";
    out += fmt::format("<figure data-title=\"{0}\"{1}><figcaption><span>{0}</span>", escape(chart.title), shown);
    if (!chart.views.empty())
      out +=
          "<span class=\"export\"><button type=\"button\" data-export=\"svg\">SVG</button><button type=\"button\" "
          "data-export=\"png\">PNG</button></span>";
    out += "</figcaption>";
    if (chart.views.empty())
      out += "<p class=\"nothing\">No curve: no case of this chart has one.</p>";
    else
      out += fmt::format("<div class=\"chart\" data-chart=\"{}\"{} role=\"img\" aria-label=\"{}: {}\"></div>", c,
                         chart.height > 0 ? fmt::format(" style=\"height:{}px\"", chart.height) : "",
                         escape(figure.title), escape(chart.title));
    for (size_t v = 0; v < chart.views.size(); ++v)
      if (!chart.views[v].notes.empty())
        out += fmt::format("<div data-notes=\"{}\"{}>{}</div>", chart.only_view >= 0 ? "" : std::to_string(v),
                           v == 0 ? "" : " hidden", list_html("notes", chart.views[v].notes));
    out += list_html("notes", chart.notes) + "</figure>\n";
  }
  return out + "</div>\n</section>\n";
}

Json figure_json(const Figure& figure) {
  Json charts = Json::array();
  for (const Chart& chart : figure.charts) {
    Json views = Json::array();
    for (const ChartView& view : chart.views)
      views.push_back({{"option", view.option}, {"x", {view.x.name, view.x.unit}}, {"y", {view.y.name, view.y.unit}}});
    Json one = {{"title", chart.title}, {"views", std::move(views)}};
    if (chart.only_view >= 0) one["only"] = chart.only_view;
    charts.push_back(std::move(one));
  }
  return {{"id", figure.id},
          {"title", figure.title},
          {"overTime", figure.over_time},
          {"linked", figure.over_time || figure.linked},
          {"charts", std::move(charts)}};
}

std::string script(const std::string& attributes, const std::string& content) {
  return "<script" + attributes + ">" + content + "</script>\n";
}

}  // namespace

std::string render_page(const StudyResults& results, std::string_view library, std::string_view library_version) {
  const CaseView view(results);
  CurveData curves(sample_limit(series_shown(results)));
  const std::vector<Figure> figures = library.empty() ? std::vector<Figure>() : make_figures(view, curves);

  std::string out = "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n";
  out += fmt::format("<meta http-equiv=\"Content-Security-Policy\" content=\"{}\">\n", policy);
  out +=
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<link rel=\"icon\" href=\"data:,\">\n";
  out += fmt::format("<title>{} · Ricochet</title>\n<style>\n{}</style>\n</head>\n<body>\n", escape(results.name),
                     page_style());

  out += fmt::format("<header>\n<p class=\"kind\">Ricochet · {}</p>\n<h1>{}</h1>\n", escape(results.kind),
                     escape(results.name));
  if (!results.question.empty()) out += fmt::format("<p class=\"question\">{}</p>\n", escape(results.question));
  out += status_line(view);
  out += "<nav><a href=\"#answer\">Answer</a>";
  for (const Figure& figure : figures)
    out += fmt::format("<a href=\"#figure-{}\">{}</a>", figure.id, escape(figure.title));
  const std::string methods = dynamics_tables_html(view);
  if (!methods.empty()) out += "<a href=\"#methods\">Attractors and agreement</a>";
  out +=
      "<a href=\"#all-cases\">All cases</a><a href=\"#left-out\">Left out</a><a "
      "href=\"#environment\">Environment</a></nav>\n</header>\n<main>\n";

  out += "<section id=\"answer\">\n<h2>Answer</h2>\n" + answer_html(view) + "</section>\n";
  if (library.empty()) {
    out +=
        "<section id=\"figures\"><h2>Figures</h2>\n<p class=\"banner\">This program was built without the chart "
        "library, so the charts are "
        "left out; the tables are complete. For charts: run <code>npm ci</code> in <code>runners/report</code>, build "
        "again, then "
        "<code>ricochet report</code> on this folder.</p></section>\n";
  } else if (!figures.empty()) {
    out +=
        "<section id=\"figures\"><h2>Figures</h2>\n<p class=\"fine\">Drag over a chart to zoom in, double-click to "
        "zoom out; charts over time or along a parameter "
        "zoom together. Shift + wheel zooms along the horizontal axis, Alt + wheel along the vertical one. A legend "
        "entry hides or shows what it names in every chart of the figure.";
    if (!sweeps(results)) out += " Colour: mass matrix, the same everywhere, where the study has several.";
    out += "</p>\n";
    if (const std::string thinning = curves.thinning(); !thinning.empty())
      out += "<p class=\"fine\">" + escape(thinning) + "</p>\n";
    out += "<noscript><p class=\"banner\">Charts need JavaScript; the tables do not.</p></noscript>\n</section>\n";
    for (const Figure& figure : figures) out += figure_html(figure);
  }
  if (!methods.empty())
    out += "<section id=\"methods\">\n<h2>What the methods have in common</h2>\n" + methods + "</section>\n";
  if (const std::string effects = effects_html(view); !effects.empty())
    out += "<section id=\"effects\">\n<h2>How much is owed to each choice</h2>\n" + effects + "</section>\n";
  out += "<section id=\"all-cases\">\n<h2>All cases</h2>\n" + case_table_html(view) + "</section>\n";
  out += "<section id=\"left-out\">\n<h2>What was left out</h2>\n" + left_out_html(view) + notes_html(view) +
         "</section>\n";
  out += "<section id=\"environment\">\n<h2>Environment</h2>\n" + environment_html(view) + "</section>\n</main>\n";
  out += "<footer><p>Written by Ricochet. This file needs no network, and forbids it.";
  if (!library.empty())
    out += fmt::format(" Charts: Apache ECharts{}{} (Apache License 2.0).", library_version.empty() ? "" : " ",
                       escape(library_version));
  out += "</p></footer>\n";

  // The page's own script first: it listens for errors of everything that follows.
  out += script("", script_text(dynamics_script()) + script_text(page_script()));
  if (!figures.empty()) {
    Json described = Json::array();
    for (const Figure& figure : figures) described.push_back(figure_json(figure));
    out += script(" type=\"application/json\" id=\"figure-data\"", script_json(described));
    out += script(" type=\"application/json\" id=\"curve-data\"", script_json(curves.blocks()));
    if (results.kind == "bifurcation")
      out += script(" type=\"application/json\" id=\"dynamics-data\"", script_json(orbit_data(view)));
    out += script("", script_text(library));
  }
  return out + "</body>\n</html>\n";
}

}  // namespace report

std::string render_report(const StudyResults& results) {
  return report::render_page(results, report::chart_library(), report::chart_library_version());
}

}  // namespace ricochet
