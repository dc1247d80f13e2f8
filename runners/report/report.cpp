#include "runners/report/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <unordered_set>

#include "runners/report/assets.hpp"
#include "runners/report/choices.hpp"
#include "runners/report/curve_data.hpp"
#include "runners/report/html.hpp"
#include "runners/report/kind_page.hpp"
#include "runners/report/page_data.hpp"
#include "runners/report/scene_sketch.hpp"
#include "runners/report/summary_page.hpp"

namespace ricochet {
namespace report {
namespace {

Fill banner(const std::string& first, const std::string& rest) {
  Fill out;
  out.set("first", first);
  out.set("rest", rest);
  return out;
}

/// What is not whole yet.
Fill banners(const StudyResults& results) {
  Fill out{Fill::type::list};
  const auto partial = std::count_if(results.cases.begin(), results.cases.end(),
                                     [](const CaseRecord& record) { return record.partial; });
  if (partial > 0)
    out << banner(partial == 1 ? "One case is still being worked on."
                               : fmt::format("{} cases are still being worked on.", partial),
                  "What they have so far is shown; running the study again goes on from there.");
  const size_t have = results.cases.size(), expected = static_cast<size_t>(std::max(results.expected_cases, 0));
  if (!results.part.whole())
    out << banner(fmt::format("This is {} of the study.", results.part.text()),
                  "Everything below speaks of its cases alone; `ricochet merge` joins the parts.");
  if (have < expected)
    out << banner(fmt::format("Partial results: {} of {} so far.", have, count_text(expected, "case", "cases")),
                  "Everything below speaks of these alone; running the study again adds the rest.");
  return out;
}

Fill html_section(const std::string& html) {
  Fill out;
  out.set("html", html);
  return out;
}

/// What every page has, around the figures of its kind.
constexpr const char* shared_scripts[] = {
    "format",  "later", "unpacked",   "data",          "cases",   "short_names",    "axes",       "theme",  "pens",
    "plot",    "chart", "marks",      "method_curves", "strips",  "figure_section", "chart_data", "figure", "case_map",
    "picture", "paper", "side_panel", "case_panel",    "address", "copied",         "exported"};
constexpr const char* page_scripts[] = {"snapshots",     "film_stage", "space_time",    "film", "sorting",
                                        "column_filter", "case_table", "verdict_words", "page"};

std::string page_program(const KindPage& kind) {
  std::string out = "\"use strict\";\n";
  // Without its comments and indents, which are for who writes them.
  const auto lines = [&](std::string_view text) {
    while (!text.empty()) {
      const std::size_t end = std::min(text.find('\n'), text.size() - 1), first = text.find_first_not_of(' ');
      if (first < end && text.substr(first, 2) != "//") out += text.substr(first, end + 1 - first);
      text.remove_prefix(end + 1);
    }
  };
  const auto add = [&](const std::string& name) { lines(asset(name)); };
  for (const char* name : shared_scripts) add(fmt::format("script/{}.js", name));
  for (const std::string_view script : kind.scripts) lines(script);
  for (const char* name : {"effects", "choice_effects"}) add(fmt::format("{}.js", name));
  for (const char* name : page_scripts) add(fmt::format("script/{}.js", name));
  return out;
}

std::string script(const std::string& attributes, const std::string& content) {
  return "<script" + attributes + ">" + content + "</script>\n";
}

}  // namespace

std::string answer_html(const Choices& choices, const KindPage& kind) {
  if (choices.results().cases.empty()) return "<p>No case has run yet.</p>\n";
  const std::string answer = asked_html(kind.asked);
  if (answer.empty() && with_status(all_cases(choices.results()), Status::done).empty())
    return "<p>No case has finished with a result; the table below says why.</p>\n";
  return answer;
}

}  // namespace report

std::string render_report(const Choices& choices, const report::KindPage& kind) {
  using namespace report;
  const StudyResults& results = choices.results();
  const std::optional<StudyResults> some = shown_cases(results);
  const std::optional<Choices> fewer = some ? std::make_optional<Choices>(*some) : std::nullopt;
  const Choices& shown = fewer ? *fewer : choices;
  PageData data = page_data(shown, kind, results);
  if (some) data.thinning = shown_sentence(*some, results) + (data.thinning.empty() ? "" : " ") + data.thinning;
  const auto truth = [](bool value) { return value ? Fill::type::bool_true : Fill::type::bool_false; };
  Fill page;
  page.set("name", results.name);
  page.set("kind", results.kind);
  page.set("style", std::string(asset("page.css")) + std::string(asset("panel.css")) + page_margins(results));
  page.set("summary", summary_html(choices, kind.summary ? kind.summary(choices) : ""));
  if (const std::string sketch = scene_svg(results.study); !sketch.empty())
    page.set("sketch", sketch + scene_svg(results.study, true));
  if (!results.question.empty()) page.set("question", results.question);
  page.set("counts", counts_text(results));
  page.set("banners", banners(results));
  page.set("answer", answer_html(choices, kind));
  if (const std::string beneath = kind.answer ? kind.answer(choices) : ""; !beneath.empty())
    page.set("beneath", html_section(beneath));
  page.set("masses", truth(kind.masses));
  if (!data.thinning.empty()) page.set("thinning", data.thinning);
  if (const std::string methods = kind.methods ? kind.methods(choices) : ""; !methods.empty())
    page.set("methods", html_section(methods));
  if (const std::string effects = effects_html(choices); !effects.empty()) page.set("effects", html_section(effects));
  page.set("cases", case_table_html(shown, results));
  if (const std::string tables = derived_tables_html(results); !tables.empty())
    page.set("tables", html_section(tables));
  page.set("left_out", left_out_html(choices));
  page.set("notes", notes_html(choices));
  page.set("environment", environment_html(choices));
  // Scripts follow what they work on; the data are too long to pass through a template.
  std::string out = filled("page", page) + script("", script_text(page_program(kind)));
  out += script(" type=\"application/json\" id=\"page-data\"", script_json(data.results));
  out += script(" type=\"application/json\" id=\"curve-data\"", script_json(packed_blocks(data.blocks)));
  return out + "</body>\n</html>\n";
}

}  // namespace ricochet

namespace ricochet::report {
namespace {

using Ids = std::unordered_set<std::string>;

Ids chosen(const StudyResults& results) {
  Ids ids;
  std::set<std::pair<std::string, std::string>> met;
  for (const CaseRecord& record : results.cases)
    for (const std::string& column : results.columns)
      if (ids.size() < most_shown_cases / 4 && met.emplace(column, axis_words(record, column)).second)
        ids.insert(record.id);
  std::vector<const CaseRecord*> by_lot;
  for (const CaseRecord& record : results.cases) by_lot.push_back(&record);
  std::sort(by_lot.begin(), by_lot.end(), [](const CaseRecord* a, const CaseRecord* b) { return a->id < b->id; });
  std::size_t bad = 0;
  for (const CaseRecord* record : by_lot)
    if (record->status != Status::done && bad < most_shown_cases / 4) bad += ids.insert(record->id).second;
  for (const CaseRecord* record : by_lot)
    if (ids.size() < most_shown_cases) ids.insert(record->id);
  return ids;
}

}  // namespace

std::optional<StudyResults> shown_cases(const StudyResults& results) {
  if (results.cases.size() <= 2 * most_shown_cases) return std::nullopt;
  const Ids ids = chosen(results);
  StudyResults shown;
  static_cast<StudyHeader&>(shown) = results;
  for (const CaseRecord& record : results.cases)
    if (ids.contains(record.id)) shown.cases.push_back(record);
  for (const Table& table : results.derived) {
    Table& kept = shown.derived.emplace_back(Table{table.name, table.text, table.columns, {}});
    const bool of_cases = !table.columns.empty() && table.columns.front().name == "case";
    for (const Row& row : table.rows)
      if (!of_cases || ids.contains(row.front().text())) kept.rows.push_back(row);
  }
  return shown;
}

std::string shown_sentence(const StudyResults& shown, const StudyResults& all) {
  return fmt::format(
      "The figures and the table of cases hold {} of {} cases, drawn by lot. Cases that are not done come first, up to "
      "{}. Sentences speak of all cases, and cases.csv has all.",
      shown.cases.size(), all.cases.size(), most_shown_cases / 4);
}

}  // namespace ricochet::report
