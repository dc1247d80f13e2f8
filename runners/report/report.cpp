#include "runners/report/report.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "runners/report/answer.hpp"
#include "runners/report/assets.hpp"
#include "runners/report/case_view.hpp"
#include "runners/report/drawn.hpp"
#include "runners/report/dynamics_report.hpp"
#include "runners/report/evidence.hpp"
#include "runners/report/html.hpp"
#include "runners/report/orbits.hpp"
#include "runners/report/page.hpp"
#include "runners/report/page_data.hpp"
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

/// What every page has, around the figures of its kind.
constexpr const char* shared_scripts[] = {"format",        "data",           "cases",  "options",
                                          "method_curves", "figure_section", "figure", "picture"};
constexpr const char* page_scripts[] = {"case_table", "page"};

std::string page_program(const Drawn& drawn) {
  std::string out = "\"use strict\";\n";
  const auto add = [&](const std::string& name) { out += asset(name); };
  for (const char* name : shared_scripts) add(fmt::format("script/{}.js", name));
  for (const std::string_view name : drawn.scripts) add(fmt::format("figures/{}.js", name));
  for (const char* name : page_scripts) add(fmt::format("script/{}.js", name));
  return out;
}

std::string script(const std::string& attributes, const std::string& content) {
  return "<script" + attributes + ">" + content + "</script>\n";
}

}  // namespace

std::string render_page(const StudyResults& results, std::string_view library, std::string_view library_version) {
  const CaseView view(results);
  const Drawn& drawn = drawn_for(results.kind);
  const PageData data = library.empty() ? PageData() : page_data(view, drawn);

  std::string out = "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n";
  out += fmt::format("<meta http-equiv=\"Content-Security-Policy\" content=\"{}\">\n", policy);
  out +=
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<link rel=\"icon\" href=\"data:,\">\n";
  out += fmt::format("<title>{} · Ricochet</title>\n<style>\n{}</style>\n</head>\n<body>\n", escape(results.name),
                     asset("page.css"));

  out += fmt::format("<header>\n<p class=\"kind\">Ricochet · {}</p>\n<h1>{}</h1>\n", escape(results.kind),
                     escape(results.name));
  if (!results.question.empty()) out += fmt::format("<p class=\"question\">{}</p>\n", escape(results.question));
  out += status_line(view);
  out += "<nav><a href=\"#answer\">Answer</a>";
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
  } else {
    out +=
        "<section id=\"figures\"><h2>Figures</h2>\n<p class=\"fine\">Drag over a chart to zoom in, double-click to "
        "zoom out; charts over time or along a parameter "
        "zoom together. Shift + wheel zooms along the horizontal axis, Alt + wheel along the vertical one. A legend "
        "entry hides or shows what it names in every chart of the figure.";
    if (!sweeps(results)) out += " Colour: mass matrix, the same everywhere, where the study has several.";
    out += "</p>\n";
    if (!data.thinning.empty()) out += "<p class=\"fine\">" + escape(data.thinning) + "</p>\n";
    out += "<noscript><p class=\"banner\">Charts need JavaScript; the tables do not.</p></noscript>\n</section>\n";
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
  out += script("", script_text(page_program(drawn)));
  if (!library.empty()) {
    out += script(" type=\"application/json\" id=\"page-data\"", script_json(data.results));
    out += script(" type=\"application/json\" id=\"curve-data\"", script_json(data.blocks));
    out += script("", script_text(library));
  }
  return out + "</body>\n</html>\n";
}

}  // namespace report

std::string render_report(const StudyResults& results) {
  return report::render_page(results, report::chart_library(), report::chart_library_version());
}

}  // namespace ricochet
