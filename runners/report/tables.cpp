#include "runners/report/tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runners/report/html.hpp"
#include "runners/report/template.hpp"
#include "runners/table/in_order_met.hpp"

namespace ricochet::report {
namespace {

/// Measures that at least one case has, in the declared order, others after them.
std::vector<std::string> measures_present(const CaseView& view) {
  std::vector<std::string> out;
  const auto present = [&](const std::string& name) {
    return std::any_of(view.results().cases.begin(), view.results().cases.end(),
                       [&](const CaseRecord& r) { return ricochet::measure(r, name).has_value(); });
  };
  for (const MeasureInfo& info : all_measures())
    if (present(info.name)) out.emplace_back(info.name);
  for (const CaseRecord& record : view.results().cases)
    for (const auto& [name, value] : record.measures)
      if (std::find(out.begin(), out.end(), name) == out.end()) out.push_back(name);
  return out;
}

Fill header_fill(const std::string& header, const std::string& tooltip, const std::string& classes) {
  Fill out;
  out.set("header", header);
  out.set("tooltip", tooltip);
  out.set("classes", classes);
  return out;
}

Fill text_fill(const std::string& text, const std::string& classes) {
  Fill out;
  out.set("text", text);
  out.set("classes", classes);
  return out;
}

/// A number that sorts as it is, shown shorter.
Fill number_fill(double value, const std::string& text, const std::string& classes) {
  if (!std::isfinite(value)) return text_fill("–", "number absent" + classes);
  Fill out = text_fill(text, "number" + classes);
  out.set("value", exact_text(value));
  return out;
}

Fill case_columns(const CaseView& view, const std::vector<std::string>& measures) {
  Fill out{Fill::type::list};
  out << header_fill("case", "Identity of the case: its row in cases.csv and its file in curves/", "text extra");
  for (const std::string& column : view.results().columns)
    out << header_fill(with_unit({column, axis_unit(column)}), "Axis of the study",
                       view.varies(column) ? "axis" : "axis extra");
  out << header_fill("status", "done, refused (does not apply), diverged or failed", "text");
  out << header_fill("reason", "Why a case has no result", "text");
  out << header_fill("operator", "How the matrices were stored and solved", "text extra");
  out << header_fill("steps", "Number of time steps marched", "number");
  out << header_fill("set-up (s)", "Time before the first step", "number extra");
  out << header_fill("run (s)", "Time of marching", "number");
  for (const std::string& name : measures) {
    const MeasureInfo* info = measure_info(name);
    out << header_fill(with_unit({in_words(name), info ? info->unit : ""}), info ? info->text : "",
                       info && info->aside ? "number extra" : "number");
  }
  return out;
}

Fill case_cells(const CaseView& view, const CaseRecord& record, const std::vector<std::string>& measures) {
  Fill out{Fill::type::list};
  out << text_fill(record.id, "text extra");
  bool first = true;
  for (const std::string& column : view.results().columns) {
    const std::string text = CaseView::text(record, column), extra = view.varies(column) ? "" : " extra";
    const auto number = CaseView::number(record, column);
    Fill cell = number ? number_fill(*number, text, extra) : text_fill(text.empty() ? "–" : text, "text" + extra);
    if (first) cell.set("swatch", view.colour(record));
    first = false;
    out << cell;
  }
  out << text_fill(status_mark(record.status) + " " + record.status, "status " + record.status);
  out << text_fill(record.reason, "reason");
  out << text_fill(record.operator_name, "text extra");
  const auto timed = [&](double value, const std::string& classes) {
    Fill cell = number_fill(value, number_text(value, 5), classes);
    cell.set("title", exact_text(value));
    return cell;
  };
  if (record.status == "refused") {
    for (const char* extra : {"", " extra", ""}) out << text_fill("–", std::string("number absent") + extra);
  } else {
    out << number_fill(static_cast<double>(record.steps), std::to_string(record.steps), "");
    out << timed(record.setup_seconds, " extra");
    out << timed(record.run_seconds, "");
  }
  for (const std::string& name : measures) {
    const MeasureInfo* info = measure_info(name);
    const std::string extra = info && info->aside ? " extra" : "";
    const auto value = ricochet::measure(record, name);
    if (!value || !std::isfinite(*value)) {
      out << text_fill("–", "number absent" + extra);
      continue;
    }
    // Ratios are near 1, where what counts is far behind the point.
    Fill cell = number_fill(*value, number_text(*value, info && std::string_view(info->unit) == "1" ? 9 : 5), extra);
    cell.set("title", exact_text(*value));
    out << cell;
  }
  return out;
}

/// Entries of lists that cases carry, each once with the cases that have it.
template <class Entry, class List>
std::vector<std::pair<Entry, Cases>> grouped(const CaseView& view, List list) {
  std::vector<std::pair<Entry, Cases>> out;
  for (const CaseRecord* record : view.all())
    for (const Entry& entry : list(*record)) in_order_met(out, entry).push_back(record);
  return out;
}

}  // namespace

std::string case_table_html(const CaseView& view) {
  const StudyResults& results = view.results();
  if (results.cases.empty()) return "<p>No case has run yet.</p>\n";
  const std::vector<std::string> measures = measures_present(view);
  Fill with, statuses{Fill::type::list}, rows{Fill::type::list}, entries{Fill::type::list};
  for (const char* status : {"done", "refused", "diverged", "failed"})
    if (const size_t count = view.with_status(status).size()) {
      Fill one;
      one.set("status", status);
      one.set("mark", status_mark(status));
      one.set("count", std::to_string(count));
      statuses << one;
    }
  for (const CaseRecord& record : results.cases) {
    Fill row;
    row.set("status", record.status);
    row.set("case", record.id);
    row.set("cells", case_cells(view, record, measures));
    rows << row;
  }
  with.set("statuses", statuses);
  with.set("columns", case_columns(view, measures));
  with.set("rows", rows);
  const std::vector<std::string> constants = view.constants();
  if (!constants.empty()) with.set("constants", fmt::format("{}", fmt::join(constants, " · ")));
  bool any = false;
  for (const std::string& name : measures)
    if (const MeasureInfo* info = measure_info(name)) {
      Fill entry;
      entry.set("name", with_unit({in_words(name), info->unit}));
      entry.set("text", info->text);
      entries << entry;
      any = true;
    }
  if (any) {
    Fill glossary;
    glossary.set("entries", entries);
    with.set("glossary", glossary);
  }
  return filled("cases", with);
}

std::string left_out_html(const CaseView& view) {
  Fill with, entries{Fill::type::list};
  const auto groups = grouped<std::pair<std::string, std::string>>(
      view, [](const CaseRecord& r) -> const auto& { return r.left_out; });
  for (const auto& [entry, cases] : groups) {
    Fill one;
    one.set("item", entry.first);
    one.set("reason", entry.second);
    one.set("cases", view.describe(cases));
    entries << one;
  }
  with.set("any", groups.empty() ? Fill::type::bool_false : Fill::type::bool_true);
  with.set("entries", entries);
  return filled("left_out", with);
}

std::string notes_html(const CaseView& view) {
  Fill with, entries{Fill::type::list};
  const auto groups = grouped<std::string>(
      view, [](const CaseRecord& r) -> const auto& { return r.notes; });
  if (groups.empty()) return "";
  for (const auto& [note, cases] : groups) {
    Fill one;
    one.set("note", note);
    one.set("cases", view.describe(cases));
    entries << one;
  }
  with.set("entries", entries);
  return filled("notes", with);
}

std::string environment_html(const CaseView& view) {
  Fill with, entries{Fill::type::list};
  for (const auto& [name, value] : view.results().environment.entries) {
    Fill one;
    one.set("name", name);
    one.set("value", value);
    entries << one;
  }
  with.set("entries", entries);
  with.set("study", view.results().study.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
  return filled("environment", with);
}

}  // namespace ricochet::report
