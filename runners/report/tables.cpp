#include "runners/report/tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "runners/report/html.hpp"

namespace ricochet::report {
namespace {

/// Measures that a first look leaves aside (shown by "all columns").
const std::set<std::string> aside = {
    "scheme_energy_start", "scheme_energy_end", "energy_start",       "work_of_loads",
    "projection_energy",   "kernel_energy",     "active_set_changes", "complementarity_residual",
    "drift_per_impact",    "first_impact",      "first_release"};

struct CaseColumn {
  std::string header, tooltip, classes;
};

std::string cell_number(double value, const std::string& classes, int digits = 5) {
  if (!std::isfinite(value)) return fmt::format("<td class=\"number absent{}\">–</td>", classes);
  return fmt::format("<td class=\"number{}\" data-value=\"{}\" title=\"{}\">{}</td>", classes, exact_text(value),
                     exact_text(value), number_text(value, digits));
}

std::string words_of(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

/// Measures that at least one case has, in the declared order, others after them.
std::vector<std::string> measures_present(const CaseView& view) {
  std::vector<std::string> out;
  const auto present = [&](const std::string& name) {
    return std::any_of(view.results().cases.begin(), view.results().cases.end(),
                       [&](const CaseRecord& r) { return CaseView::measure(r, name).has_value(); });
  };
  for (const MeasureInfo& info : all_measures())
    if (present(info.name)) out.emplace_back(info.name);
  for (const CaseRecord& record : view.results().cases)
    for (const auto& [name, value] : record.measures)
      if (std::find(out.begin(), out.end(), name) == out.end()) out.push_back(name);
  return out;
}

std::string header_cell(const CaseColumn& column) {
  return fmt::format(
      "<th scope=\"col\" class=\"{}\" title=\"{}\" aria-sort=\"none\"><button type=\"button\">{}</button></th>",
      column.classes, escape(column.tooltip), escape(column.header));
}

std::string glossary(const std::vector<std::string>& measures) {
  std::string rows;
  for (const std::string& name : measures)
    if (const MeasureInfo* info = measure_info(name))
      rows +=
          fmt::format("<dt>{}</dt><dd>{}</dd>\n", escape(with_unit({words_of(name), info->unit})), escape(info->text));
  return rows.empty() ? ""
                      : "<details><summary>What the measures mean</summary><dl class=\"glossary\">\n" + rows +
                            "</dl></details>\n";
}

}  // namespace

std::string case_table_html(const CaseView& view) {
  const StudyResults& results = view.results();
  if (results.cases.empty()) return "<p>No case has run yet.</p>\n";
  const std::vector<std::string> measures = measures_present(view);

  std::vector<CaseColumn> columns = {
      {"case", "Identity of the case: its row in cases.csv and its file in curves/", "text extra"}};
  for (const std::string& column : results.columns)
    columns.push_back(
        {with_unit({column, axis_unit(column)}), "Axis of the study", view.varies(column) ? "axis" : "axis extra"});
  columns.push_back({"status", "done, refused (does not apply), diverged or failed", "text"});
  columns.push_back({"reason", "Why a case has no result", "text"});
  columns.push_back({"operator", "How the matrices were stored and solved", "text extra"});
  columns.push_back({"steps", "Number of time steps marched", "number"});
  columns.push_back({"set-up (s)", "Time before the first step", "number extra"});
  columns.push_back({"run (s)", "Time of marching", "number"});
  for (const std::string& name : measures) {
    const MeasureInfo* info = measure_info(name);
    columns.push_back({with_unit({words_of(name), info ? info->unit : ""}), info ? info->text : "",
                       aside.contains(name) ? "number extra" : "number"});
  }

  std::string out =
      "<div class=\"controls\"><label>Filter <input type=\"search\" id=\"filter\" placeholder=\"words, all must "
      "appear\"></label>";
  for (const char* status : {"done", "refused", "diverged", "failed"})
    if (const size_t count = view.with_status(status).size())
      out += fmt::format(
          "<label class=\"status {0}\"><input type=\"checkbox\" data-status=\"{0}\" checked> {1} {0} ({2})</label>",
          status, status_mark(status), count);
  out +=
      "<label><input type=\"checkbox\" id=\"all-columns\"> all columns</label><span id=\"shown\" "
      "role=\"status\"></span></div>\n";
  const std::vector<std::string> constants = view.constants();
  if (!constants.empty())
    out += fmt::format("<p class=\"fine\">The same in every case: {}.</p>\n",
                       escape(fmt::format("{}", fmt::join(constants, " · "))));

  out += "<div class=\"scroll tall\"><table class=\"cases\" id=\"cases\"><thead><tr>";
  for (const CaseColumn& column : columns) out += header_cell(column);
  out += "</tr></thead>\n<tbody>\n";
  for (const CaseRecord& record : results.cases) {
    out += fmt::format("<tr data-status=\"{}\"><td class=\"text extra\">{}</td>", escape(record.status),
                       escape(record.id));
    bool first = true;
    for (const std::string& column : results.columns) {
      const std::string text = CaseView::text(record, column), extra = view.varies(column) ? "" : " extra";
      const std::string mark =
          first ? fmt::format("<span class=\"swatch\" style=\"background:{}\"></span>", view.colour(record)) : "";
      first = false;
      if (const auto number = CaseView::number(record, column))
        out += fmt::format("<td class=\"number{}\" data-value=\"{}\">{}{}</td>", extra, exact_text(*number), mark,
                           escape(text));
      else
        out += fmt::format("<td class=\"text{}\">{}{}</td>", extra, mark, text.empty() ? "–" : escape(text));
    }
    out += fmt::format(
        "<td class=\"status {0}\">{1} {0}</td><td class=\"reason\">{2}</td><td class=\"text extra\">{3}</td>",
        escape(record.status), status_mark(record.status), escape(record.reason), escape(record.operator_name));
    if (record.status == "refused")
      out +=
          "<td class=\"number absent\">–</td><td class=\"number absent extra\">–</td><td class=\"number "
          "absent\">–</td>";
    else
      out += fmt::format("<td class=\"number\" data-value=\"{0}\">{0}</td>", record.steps) +
             cell_number(record.setup_seconds, " extra") + cell_number(record.run_seconds, "");
    for (const std::string& name : measures) {
      const std::string extra = aside.contains(name) ? " extra" : "";
      const auto value = CaseView::measure(record, name);
      // Ratios are near 1, where what counts is far behind the point.
      const MeasureInfo* info = measure_info(name);
      const int digits = info && std::string_view(info->unit) == "1" ? 9 : 5;
      out += value ? cell_number(*value, extra, digits) : fmt::format("<td class=\"number absent{}\">–</td>", extra);
    }
    out += "</tr>\n";
  }
  return out + "</tbody></table></div>\n" + glossary(measures);
}

std::string left_out_html(const CaseView& view) {
  std::vector<std::pair<std::pair<std::string, std::string>, Cases>> groups;
  for (const CaseRecord* record : view.all())
    for (const auto& entry : record->left_out) {
      auto found = std::find_if(groups.begin(), groups.end(), [&](const auto& g) { return g.first == entry; });
      if (found == groups.end()) found = groups.insert(groups.end(), {entry, {}});
      found->second.push_back(record);
    }
  if (groups.empty()) return "<p>Nothing was left out.</p>\n";
  std::string out =
      "<table class=\"plain\"><thead><tr><th scope=\"col\">left out</th><th scope=\"col\">because</th><th "
      "scope=\"col\">in</th></tr></thead><tbody>\n";
  for (const auto& [entry, cases] : groups)
    out += fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td></tr>\n", escape(entry.first), escape(entry.second),
                       escape(view.describe(cases)));
  return out + "</tbody></table>\n";
}

std::string notes_html(const CaseView& view) {
  std::vector<std::pair<std::string, Cases>> groups;
  for (const CaseRecord* record : view.all())
    for (const std::string& note : record->notes) {
      auto found = std::find_if(groups.begin(), groups.end(), [&](const auto& g) { return g.first == note; });
      if (found == groups.end()) found = groups.insert(groups.end(), {note, {}});
      found->second.push_back(record);
    }
  if (groups.empty()) return "";
  std::string out = "<h3>Notes</h3>\n<ul>\n";
  for (const auto& [note, cases] : groups)
    out += fmt::format("<li>{} <span class=\"fine\">({})</span></li>\n", escape(note), escape(view.describe(cases)));
  return out + "</ul>\n";
}

std::string environment_html(const CaseView& view) {
  std::string out = "<table class=\"plain environment\"><tbody>\n";
  for (const auto& [name, value] : view.results().environment.entries)
    out += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td></tr>\n", escape(name), escape(value));
  out += "</tbody></table>\n";
  const std::string study = view.results().study.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  return out + "<details><summary>The study, every default written out</summary><pre>" + escape(study) +
         "</pre></details>\n";
}

}  // namespace ricochet::report
