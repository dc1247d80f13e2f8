#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "runners/report/choices.hpp"
#include "runners/report/html.hpp"
#include "runners/report/page_data.hpp"
#include "runners/report/quantity.hpp"
#include "runners/report/summary_page.hpp"
#include "runners/store/atomic_file.hpp"
#include "runners/store/study_tables.hpp"
#include "runners/table/in_order_met.hpp"

namespace ricochet::report {
namespace {

constexpr size_t most_full_rows = 100;  // of the table of all cases with every column
// Columns that fit the width of a sheet of paper, and rows that a reader turns over. The style sheet leaves out the
// others.
constexpr size_t columns_on_paper = 11, rows_on_paper = 150;

/// Measures that at least one case has, in the declared order, others after them.
std::vector<std::string> measures_present(const Choices& choices) {
  InOrderMet<std::string, bool> met;
  for (const CaseRecord& record : choices.results().cases)
    for (const auto& [name, value] : record.measures) met[name] = true;
  std::vector<std::string> out;
  for (const MeasureInfo& info : all_measures())
    if (met.holds(info.name)) out.emplace_back(info.name);
  for (const auto& [name, ignored] : met.list())
    if (std::find(out.begin(), out.end(), name) == out.end()) out.push_back(name);
  return out;
}

struct CaseCell {
  std::string text, classes, swatch = "";
};

/// Onto the HTML of a row. Cells and rows end where the next begins, as HTML has it: a thousand rows are shorter by a
/// fifth.
void add_cell(std::string& row, const CaseCell& cell) {
  row += "<td";
  if (!cell.classes.empty()) row += " class=\"" + escape(cell.classes) + "\"";
  row += ">";
  if (!cell.swatch.empty()) row += swatch(cell.swatch);
  row += escape(cell.text);
}

/// A column of the table of all cases. `extra`: shown on demand, and only where there are few cases.
struct CaseColumn {
  std::string name;  ///< in cases.csv
  std::string header, tooltip, classes;
  bool extra = false;
  std::function<CaseCell(const CaseRecord&)> cell;
};

/// A number, shown short; an empty cell where there is none, which the style sheet marks.
CaseCell number_cell(std::optional<double> value, int digits) {
  return value && std::isfinite(*value) ? CaseCell{number_text(*value, digits), ""} : CaseCell{"", ""};
}

CaseColumn axis_column(const Choices& choices, const std::string& column) {
  const auto cell = [column](const CaseRecord& record) {
    const std::string text = axis_words(record, column);
    return CaseCell{text, text.empty() || axis(record, column).number() ? "" : "text"};
  };
  return {column, with_unit({column, choices.unit_of(column)}), "Axis of the study", "axis", !choices.varies(column),
          cell};
}

CaseColumn measure_cells(const std::string& name) {
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
std::vector<CaseColumn> case_columns(const Choices& choices, const std::vector<std::string>& measures, bool files) {
  const auto worked = [](const CaseRecord& record, double value) {
    return record.status == Status::refused ? CaseCell{"", ""} : number_cell(value, 5);
  };
  std::vector<CaseColumn> out = {{"case", "case",
                                  files ? "Identity of the case: its row in cases.csv and its file in curves/"
                                        : "Identity of the case: its row in cases.csv",
                                  "text", false,
                                  [&choices](const CaseRecord& record) {
                                    return CaseCell{record.id, "text", choices.colour(record)};
                                  }},
                                 {"status", "status", "done, refused (does not apply), diverged or failed", "text",
                                  false, [](const CaseRecord& record) {
                                    return CaseCell{status_mark(record.status) + " " + word(record.status),
                                                    std::string("status ") + word(record.status)};
                                  }}};
  for (const std::string& column : choices.results().columns) out.push_back(axis_column(choices, column));
  const Cases all = all_cases(choices.results());
  if (std::any_of(all.begin(), all.end(), [](const CaseRecord* record) { return !record->reasons.empty(); }))
    out.push_back({"reason", "reason", "Why a case has no result", "text", false, [](const CaseRecord& record) {
                     return CaseCell{record.reason(), "reason"};
                   }});
  for (const std::string& name : measures) out.push_back(measure_cells(name));
  out.push_back({"steps", "steps", "Number of time steps marched", "number", false, [](const CaseRecord& record) {
                   return CaseCell{record.status == Status::refused ? "" : std::to_string(record.steps), ""};
                 }});
  out.push_back({"run_seconds", "run (s)", "Time of marching", "number", false,
                 [worked](const CaseRecord& record) { return worked(record, record.run_seconds); }});
  out.push_back({"setup_seconds", "set-up (s)", "Time before the first step", "number", true,
                 [worked](const CaseRecord& record) { return worked(record, record.setup_seconds); }});
  out.push_back(
      {"operator", "operator", "How the matrices were stored and solved", "text", true, [](const CaseRecord& record) {
         return CaseCell{record.operator_name, "text"};
       }});
  std::stable_partition(out.begin(), out.end(), [](const CaseColumn& column) { return !column.extra; });
  return out;
}

/// What of the table's columns and rows is not on paper, "" where all is.
std::string off_paper(const Choices& choices, const std::vector<CaseColumn>& columns) {
  const size_t cases = choices.results().cases.size(), rows = cases > rows_on_paper ? cases - rows_on_paper : 0;
  const size_t shown = static_cast<size_t>(
      std::count_if(columns.begin(), columns.end(), [](const CaseColumn& column) { return !column.extra; }));
  const size_t hidden = columns.size() - std::min(shown, columns_on_paper);
  std::string out;
  if (hidden) out = count_text(hidden, "more column", "more columns");
  if (rows) out += (out.empty() ? "" : " and ") + count_text(rows, "more row", "more rows");
  return out.empty() ? "" : out + (hidden + rows == 1 ? " is" : " are") + " in cases.csv.";
}

/// A condition that is true of something here, to show how one is written.
std::string filter_example(const Choices& choices, const std::vector<std::string>& measures) {
  if (!with_status(all_cases(choices.results()), Status::refused).empty()) return "words, or status = refused";
  return measures.empty() ? "words, or status = done" : fmt::format("words, or {} > 0", measures.front());
}

/// Entries of lists that cases carry, each once with the cases that have it.
template <class Entry, class List>
std::vector<std::pair<Entry, Cases>> grouped(const Choices& choices, List list) {
  InOrderMet<Entry, Cases> out;
  for (const CaseRecord* record : all_cases(choices.results()))
    for (const Entry& entry : list(*record)) out[entry].push_back(record);
  return std::move(out).list();
}

/// What the measures mean; none where none is known.
std::optional<Fill> glossary_of(const std::vector<std::string>& measures) {
  Fill entries{Fill::type::list};
  bool any = false;
  for (const std::string& name : measures)
    if (const MeasureInfo* info = measure_info(name)) {
      Fill entry;
      entry.set("name", with_unit({in_words(name), info->unit}));
      entry.set("text", info->text);
      entries << entry;
      any = true;
    }
  if (!any) return std::nullopt;
  Fill glossary;
  glossary.set("entries", entries);
  return glossary;
}

}  // namespace

std::string case_table_html(const Choices& choices, const StudyResults& all) {
  const StudyResults& results = choices.results();
  if (results.cases.empty()) return "<p>No case has run yet.</p>\n";
  const std::vector<std::string> measures = measures_present(choices);
  Fill with, statuses{Fill::type::list};
  for (const auto& [status, count] : status_counts(results)) {
    Fill one;
    one.set("status", word(status));
    one.set("mark", status_mark(status));
    one.set("count", std::to_string(count));
    statuses << one;
  }
  std::vector<CaseColumn> columns = case_columns(choices, measures, has_curve_files(all));
  // Cells that are out of sight are left out of a page of many cases, which they would fill.
  const size_t all_columns = columns.size();
  if (results.cases.size() > most_full_rows) std::erase_if(columns, [](const CaseColumn& one) { return one.extra; });
  Fill headers{Fill::type::list};
  for (const CaseColumn& one : columns) {
    Fill head;
    head.set("column", one.name);
    head.set("header", one.header);
    head.set("tooltip", one.tooltip);
    head.set("classes", one.classes + (one.extra ? " extra" : ""));
    headers << head;
  }
  if (const std::string left = off_paper(choices, columns); !left.empty()) with.set("off_paper", left);
  std::string rows;
  for (const CaseRecord& record : results.cases) {
    rows +=
        fmt::format("<tr data-status=\"{}\" data-case=\"{}\" tabindex=\"0\">", word(record.status), escape(record.id));
    for (const CaseColumn& one : columns) {
      CaseCell cell = one.cell(record);
      if (one.extra) cell.classes += cell.classes.empty() ? "extra" : " extra";
      add_cell(rows, cell);
    }
  }
  with.set("statuses", statuses);
  with.set("example", filter_example(choices, measures));
  with.set("columns", headers);
  if (columns.size() < all_columns)
    with.set("hidden", fmt::format("{} more columns", all_columns - columns.size()));
  else
    with.set("full", Fill::type::bool_true);
  with.set("rows", std::move(rows));
  if (results.cases.size() > most_full_rows) with.set("later", Fill::type::bool_true);
  const std::vector<std::string> constants = choices.constants();
  if (!constants.empty()) with.set("constants", fmt::format("{}", fmt::join(constants, " · ")));
  if (const auto glossary = glossary_of(measures)) with.set("glossary", *glossary);
  return filled("cases", with);
}

std::string left_out_html(const Choices& choices) {
  Fill with, entries{Fill::type::list};
  const auto groups = grouped<std::pair<std::string, std::string>>(
      choices, [](const CaseRecord& r) -> const auto& { return r.left_out; });
  for (const auto& [entry, cases] : groups) {
    Fill one;
    one.set("item", entry.first);
    one.set("reason", entry.second);
    one.set("cases", choices.describe(cases));
    entries << one;
  }
  with.set("any", groups.empty() ? Fill::type::bool_false : Fill::type::bool_true);
  with.set("entries", entries);
  return filled("left_out", with);
}

std::string notes_html(const Choices& choices) {
  Fill with, entries{Fill::type::list};
  const auto groups = grouped<std::string>(
      choices, [](const CaseRecord& r) -> const auto& { return r.notes; });
  bool any = !groups.empty();
  for (const ReasonRow& row : reasons_type().read(choices.results().derived)) {
    if (row.status != word(Status::done)) continue;
    Fill one;
    one.set("note", row.reason);
    one.set("cases", row.cases == 1
                         ? choices.name_of(row.first)
                         : fmt::format("{} cases, of this kind; this is {}", row.cases, choices.name_of(row.first)));
    entries << one;
    any = true;
  }
  if (!any) return "";
  for (const auto& [note, cases] : groups) {
    Fill one;
    one.set("note", note);
    one.set("cases", choices.describe(cases));
    entries << one;
  }
  with.set("entries", entries);
  return filled("notes", with);
}

std::string environment_html(const Choices& choices) {
  Fill with, entries{Fill::type::list};
  for (const auto& [name, value] : choices.results().environment.entries) {
    Fill one;
    one.set("name", name);
    one.set("value", value);
    entries << one;
  }
  with.set("entries", entries);
  with.set("study", choices.results().study.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
  return filled("environment", with);
}

namespace {

constexpr size_t most_view_rows = 40;  // a page of a thousand cases must stay one that can be sent

Fill view_column(const Table& table, size_t place) {
  const Column& column = table.columns[place];
  const bool numbers = std::any_of(table.rows.begin(), table.rows.end(),
                                   [&](const Row& row) { return place < row.size() && row[place].number(); });
  Fill out;
  out.set("header", with_unit({in_words(column.name), column.unit}));
  out.set("tooltip", column.text);
  out.set("classes", numbers ? "number" : "text");
  return out;
}

Fill view_cell(const Cell& cell) {
  Fill out;
  if (const auto number = cell.number()) {
    out.set("classes", "number");
    const std::string exact = exact_text(*number), shown = number_text(*number, 6);
    if (exact != shown) out.set("value", exact);
    out.set("text", shown);
  } else {
    const auto truth = cell.truth();
    const std::string text = truth ? (*truth ? "yes" : "no") : cell.text();
    out.set("classes", text.empty() ? "absent" : text.size() > 30 ? "reason" : "text");
    out.set("text", text.empty() ? "–" : text);
  }
  return out;
}

}  // namespace

std::string derived_tables_html(const StudyResults& results) {
  Fill tables{Fill::type::list}, with;
  bool any = false;
  for (const Table& table : results.derived) {
    if (table.rows.empty()) continue;
    any = true;
    Fill one, columns{Fill::type::list}, rows{Fill::type::list};
    for (size_t c = 0; c < table.columns.size(); ++c) columns << view_column(table, c);
    const size_t shown = std::min(table.rows.size(), most_view_rows);
    for (size_t r = 0; r < shown; ++r) {
      Fill row, cells{Fill::type::list};
      for (const auto& cell : table.rows[r]) cells << view_cell(cell);
      row.set("cells", cells);
      rows << row;
    }
    one.set("name", table.name);
    one.set("title", in_words(table.name));
    one.set("size", count_text(table.rows.size(), "row", "rows"));
    one.set("columns", columns);
    one.set("rows", rows);
    one.set("tall", shown > 24 ? Fill::type::bool_true : Fill::type::bool_false);
    if (table.rows.size() > shown) one.set("more", std::to_string(table.rows.size() - shown));
    tables << one;
  }
  if (!any) return "";
  with.set("tables", tables);
  return filled("tables", with);
}

}  // namespace ricochet::report
