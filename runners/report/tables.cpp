#include "runners/report/tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

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

// Of the table of all cases with every column and every digit; a page of more would be filled by them.
constexpr std::size_t most_full_rows = 100;
// What fits the width of a sheet of paper (page.css hides the columns after), and how many rows of it a reader turns
// over.
constexpr std::size_t columns_on_paper = 11, rows_on_paper = 150;

struct CaseCell {
  std::string text = {}, classes = {}, swatch = {};
  std::string value = {};  ///< all digits of a number that is shown shorter
  std::string plain = {};  ///< what a word says without its mark
};

Fill cell_fill(const CaseCell& cell, bool exact, bool extra) {
  Fill out;
  out.set("text", cell.text);
  std::string classes = cell.classes;
  if (extra) classes += classes.empty() ? "extra" : " extra";
  if (!classes.empty()) out.set("classes", classes);
  if (!cell.swatch.empty()) out.set("swatch", cell.swatch);
  if (exact && !cell.value.empty()) out.set("value", cell.value);
  if (!cell.plain.empty()) out.set("plain", cell.plain);
  return out;
}

/// A number that sorts as it is, shown short; an empty cell where there is none, which the style sheet marks.
CaseCell number_cell(std::optional<double> value, int digits) {
  if (!value || !std::isfinite(*value)) return {};
  return {.text = number_text(*value, digits), .value = exact_text(*value)};
}

/// A column of the table of cases: its name in cases.csv, its header, and what a case has in it.
struct CaseColumn {
  std::string name, header, tooltip, classes;
  bool extra = false;  ///< a first look leaves it out
  std::function<CaseCell(const CaseRecord&)> cell;
};

CaseColumn axis_column(const CaseView& view, const std::string& name) {
  return {name,
          with_unit({name, axis_unit(name)}),
          "Axis of the study",
          "axis",
          !view.varies(name),
          [name](const CaseRecord& record) {
            const std::string text = CaseView::text(record, name);
            if (const auto number = CaseView::number(record, name))
              return CaseCell{.text = text, .value = exact_text(*number)};
            return CaseCell{.text = text, .classes = text.empty() ? "" : "text"};
          }};
}

CaseColumn measure_column_of(const std::string& name) {
  const MeasureInfo* info = measure_info(name);
  // Ratios are near 1, where what counts is far behind the point.
  const int digits = info && std::string_view(info->unit) == "1" ? 9 : 5;
  return {name,
          with_unit({in_words(name), info ? info->unit : ""}),
          info ? info->text : "",
          "number",
          info && info->aside,
          [name, digits](const CaseRecord& record) { return number_cell(ricochet::measure(record, name), digits); }};
}

/// Which case it is, what became of it, what sets it apart, what it measured; last what a first look leaves out.
std::vector<CaseColumn> case_columns(const CaseView& view, const std::vector<std::string>& measures) {
  const bool reasons = std::any_of(view.results().cases.begin(), view.results().cases.end(),
                                   [](const CaseRecord& record) { return !record.reason.empty(); });
  std::vector<CaseColumn> out = {
      {"case", "case", "Identity of the case: its row in cases.csv and its file in curves/", "text", false,
       [&view](const CaseRecord& record) {
         return CaseCell{.text = record.id, .classes = "text", .swatch = view.colour(record)};
       }},
      {"status", "status", "done, refused (does not apply), diverged or failed", "text", false,
       [](const CaseRecord& record) {
         return CaseCell{.text = status_mark(record.status) + " " + record.status,
                         .classes = "status " + record.status,
                         .plain = record.status};
       }}};
  for (const std::string& name : view.results().columns) out.push_back(axis_column(view, name));
  out.push_back({"reason", "reason", "Why a case has no result", "text", !reasons,
                 [](const CaseRecord& record) { return CaseCell{.text = record.reason, .classes = "reason"}; }});
  for (const std::string& name : measures) out.push_back(measure_column_of(name));
  const auto marched = [](const CaseRecord& record, CaseCell cell) {
    return record.status == "refused" ? CaseCell{} : cell;
  };
  out.push_back({"steps", "steps", "Number of time steps marched", "number", false, [=](const CaseRecord& record) {
                   return marched(record, CaseCell{.text = std::to_string(record.steps)});
                 }});
  const auto timed = [&](const char* name, const char* header, const char* tooltip, bool extra,
                         double CaseRecord::*seconds) {
    out.push_back({name, header, tooltip, "number", extra,
                   [=](const CaseRecord& record) { return marched(record, number_cell(record.*seconds, 5)); }});
  };
  timed("run_seconds", "run (s)", "Time of marching", false, &CaseRecord::run_seconds);
  timed("setup_seconds", "set-up (s)", "Time before the first step", true, &CaseRecord::setup_seconds);
  out.push_back({"operator", "operator", "How the matrices were stored and solved", "text", true,
                 [](const CaseRecord& record) { return CaseCell{.text = record.operator_name, .classes = "text"}; }});
  std::stable_partition(out.begin(), out.end(), [](const CaseColumn& column) { return !column.extra; });
  return out;
}

/// What of the table's columns and rows does not fit on paper, "" where all does; `all`: columns that there are.
std::string off_paper(const CaseView& view, std::size_t shown, std::size_t all) {
  const std::size_t hidden = all - std::min(shown, columns_on_paper), cases = view.results().cases.size(),
                    rows = cases > rows_on_paper ? cases - rows_on_paper : 0;
  std::string out;
  if (hidden) out = count_text(hidden, "more column", "more columns");
  if (rows) out += (out.empty() ? "" : " and ") + count_text(rows, "more row", "more rows");
  return out.empty() ? "" : out + (hidden + rows == 1 ? " is" : " are") + " in cases.csv.";
}

/// A condition that is true of something here, to show how one is written.
std::string filter_example(const CaseView& view, const std::vector<std::string>& measures) {
  std::string out = "words, or status = done";
  if (!measures.empty()) out = fmt::format("words, or {} > 0", measures.front());
  return view.with_status("refused").empty() ? out : "words, or status = refused";
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
  Fill with, statuses{Fill::type::list}, heads{Fill::type::list}, rows{Fill::type::list}, entries{Fill::type::list};
  for (const char* status : {"done", "refused", "diverged", "failed"})
    if (const size_t count = view.with_status(status).size()) {
      Fill one;
      one.set("status", status);
      one.set("mark", status_mark(status));
      one.set("count", std::to_string(count));
      statuses << one;
    }
  std::vector<CaseColumn> columns = case_columns(view, measures);
  const std::size_t all_columns = columns.size();
  const bool full = results.cases.size() <= most_full_rows;
  const auto shown = static_cast<std::size_t>(
      std::count_if(columns.begin(), columns.end(), [](const CaseColumn& column) { return !column.extra; }));
  if (!full) columns.resize(shown);
  for (const CaseColumn& column : columns) {
    Fill head;
    head.set("column", column.name);
    head.set("header", column.header);
    head.set("tooltip", column.tooltip);
    head.set("classes", column.classes + (column.extra ? " extra" : ""));
    heads << head;
  }
  for (std::size_t k = 0; k < results.cases.size(); ++k) {
    const CaseRecord& record = results.cases[k];
    Fill row, cells{Fill::type::list};
    row.set("status", record.status);
    row.set("case", record.id);
    if (k >= rows_on_paper) row.set("row_classes", "off-paper");
    for (const CaseColumn& column : columns) cells << cell_fill(column.cell(record), full, column.extra);
    row.set("cells", cells);
    rows << row;
  }
  with.set("statuses", statuses);
  with.set("columns", heads);
  with.set("rows", rows);
  with.set("example", filter_example(view, measures));
  if (full)
    with.set("full", Fill::type::bool_true);
  else
    with.set("hidden", fmt::format("{} more columns", all_columns - columns.size()));
  if (const std::string left = off_paper(view, shown, all_columns); !left.empty()) with.set("off_paper", left);
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
