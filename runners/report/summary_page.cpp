#include "runners/report/summary_page.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "runners/report/assets.hpp"
#include "runners/report/html.hpp"
#include "runners/report/quantity.hpp"
#include "runners/report/scene_sketch.hpp"
#include "runners/store/fingerprint.hpp"
#include "runners/store/record_values.hpp"
#include "runners/store/study_tables.hpp"
#include "runners/study/axis_meaning.hpp"
#include "runners/study/body_keys.hpp"
#include "runners/table/in_order_met.hpp"

namespace ricochet::report {

std::vector<std::string> answer_lines(const StudyResults& results) {
  std::vector<answers::Clause> clauses = answers::answers_type().read(results.derived);
  // What happened, or did not, comes before any number.
  std::stable_partition(clauses.begin(), clauses.end(), [](const auto& one) { return one.form == "status"; });
  std::vector<std::string> lines;
  for (answers::Clause& one : clauses)
    if (!one.sentence.empty()) lines.push_back(std::move(one.sentence));
  return lines;
}

std::vector<std::pair<Status, size_t>> status_counts(const StudyResults& results) {
  std::vector<std::pair<Status, size_t>> counts;
  for (const Status status : statuses)
    if (const size_t count = with_status(all_cases(results), status).size()) counts.emplace_back(status, count);
  return counts;
}

std::string statuses_text(const StudyResults& results) {
  std::string text;
  for (const auto& [status, count] : status_counts(results))
    text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + word(status);
  return text;
}

std::string counts_text(const StudyResults& results) {
  const std::string statuses = statuses_text(results);
  const std::string part =
      results.part.whole() ? "" : fmt::format("Part {} of {}, ", results.part.number, results.part.of);
  return part + count_text(results.cases.size(), "case", "cases") + (statuses.empty() ? "" : ": " + statuses) + ".";
}

namespace {

// So much stands on one sheet beside a sketch and a figure.
constexpr std::size_t most_summary_lines = 6, most_values = 8, most_reasons = 3;

Fill pair_fill(const char* first, const std::string& name, const char* second, const std::string& value) {
  Fill out;
  out.set(first, name);
  out.set(second, value);
  return out;
}

Fill line_fill(const std::string& line) {
  Fill out;
  out.set("line", line);
  return out;
}

Fill answer_fill(const StudyResults& results) {
  Fill out{Fill::type::list};
  const std::vector<std::string> lines = answer_lines(results);
  for (std::size_t k = 0; k < std::min(lines.size(), most_summary_lines); ++k) out << line_fill(lines[k]);
  if (lines.size() > most_summary_lines)
    out << line_fill(count_text(lines.size() - most_summary_lines, "more line", "more lines") + " in the report.");
  if (lines.empty()) out << line_fill("None is stated in sentences; the report's tables and figures stand for it.");
  return out;
}

/// A mesh of bodies by the numbers that the study gives each: "rod 10 + strap 4"; any other value as it is.
std::string level_text(const StudyResults& results, const std::string& role, const std::string& value) {
  if ((role != "elements" && role != "modes") || !results.study.contains("/scene/bodies"_json_pointer)) return value;
  const auto number = nlohmann::ordered_json::parse(value, nullptr, false);
  const auto said = number.is_number() ? said_of_mesh(results.study, role, number) : number;
  if (!said.is_object()) return value;
  std::vector<std::string> parts;
  for (const auto& [body, count] : said.items()) parts.push_back(body + " " + count.dump());
  return fmt::format("{}", fmt::join(parts, " + "));
}

/// What ran of a role: its methods in order of appearance, each with the values that its parameters had; of a plain
/// axis its values. "alpha (order 1, 2), beta".
std::string ran_text(const StudyResults& results, const std::string& role) {
  using Values = std::vector<std::string>;
  std::vector<std::string> own;
  for (const std::string& column : results.columns)
    if (column != role && axis_role(column) == role) own.push_back(column);
  InOrderMet<std::string, InOrderMet<std::string, InOrderMet<std::string, bool>>> methods;
  for (const CaseRecord& record : results.cases) {
    const std::string name = axis_words(record, role);
    if (record.status == Status::refused || name.empty()) continue;
    auto& parameters = methods[name];
    for (const std::string& column : own)
      if (const std::string value = axis_words(record, column); !value.empty())
        parameters[column.substr(role.size() + 1)][value] = true;
  }
  Values out;
  for (const auto& [name, parameters] : methods.list()) {
    Values said;
    for (const auto& [parameter, met] : parameters.list()) {
      Values values;
      for (const auto& [value, ignored] : met.list()) values.push_back(value);
      said.push_back(parameter + " " + list_text(values, most_values));
    }
    out.push_back(said.empty() ? level_text(results, role, name) : fmt::format("{} ({})", name, fmt::join(said, "; ")));
  }
  return list_text(out, most_values);
}

/// Roles with the methods that a case ran with, then every other axis with its values.
Fill methods_fill(const Choices& choices) {
  Fill out{Fill::type::list};
  std::vector<std::string> roles;
  for (const std::string& column : choices.results().columns)
    if (const std::string role = axis_role(column); std::find(roles.begin(), roles.end(), role) == roles.end())
      roles.push_back(role);
  for (const std::string& role : roles) {
    const std::string ran = ran_text(choices.results(), role), unit = choices.unit_of(role);
    if (!ran.empty())
      out << pair_fill("role", axis_text(choices.results(), role) + (unit.empty() ? "" : " (" + unit + ")"), "values",
                       ran);
  }
  return out;
}

Fill limits_fill(const StudyResults& results) {
  Fill out{Fill::type::list};
  out << line_fill(counts_text(results));
  if (const auto missing = results.expected_cases - static_cast<int>(results.cases.size()); missing > 0)
    out << line_fill(count_text(static_cast<std::size_t>(missing), "case", "cases") + " not run yet.");
  const std::vector<ReasonRow> reasons = reasons_type().read(results.derived);
  for (std::size_t k = 0; k < std::min(reasons.size(), most_reasons); ++k)
    out << line_fill(fmt::format("{} {}: {}.", reasons[k].cases, reasons[k].status, reasons[k].reason));
  if (reasons.size() > most_reasons)
    out << line_fill(count_text(reasons.size() - most_reasons, "more reason", "more reasons") + " in reasons.csv.");
  std::vector<std::string> open;
  for (const answers::Clause& one : answers::answers_type().read(results.derived))
    if (one.form == "open") open.push_back(in_words(one.measure));
  if (!open.empty()) out << line_fill("Not resolved: " + list_text(open, most_values) + ".");
  std::size_t notes = 0;
  for (const CaseRecord& record : results.cases) notes += record.notes.empty() ? 0 : 1;
  if (notes > 0) out << line_fill(count_text(notes, "case", "cases") + " with remarks, under Notes in the report.");
  return out;
}

/// What the sketch does not say: a paragraph for each body, for stops, loads, what else is a list, and for all else.
Fill numbers_fill(const StudyResults& results) {
  Fill out{Fill::type::list};
  std::string part, paragraph;
  const auto end = [&] {
    if (!paragraph.empty()) out << line_fill(paragraph);
    paragraph.clear();
  };
  for (const SceneNumber& one : scene_numbers(results.study)) {
    std::string of;
    if (one.entry && !one.pointer.starts_with("/scene/structure/")) {
      of = one.pointer;
      if (!of.starts_with("/scene/bodies/")) of.resize(of.rfind('/'));
    }
    if (of != part) end();
    part = of;
    paragraph += (paragraph.empty() ? "" : " · ") + one.symbol +
                 (one.symbol.empty() ? ""
                  : one.entry        ? ": "
                                     : " = ") +
                 one.text;
  }
  end();
  return out;
}

Fill identity_fill(const StudyResults& results) {
  Fill out{Fill::type::list};
  out << pair_fill("name", "fingerprint", "value",
                   study_fingerprint(results) + " (resolved study, commit and plugins)");
  for (const char* name : {"program", "commit", kStarted, "compiler", "flags", "processor", "kernel"})
    if (const std::string value = environment_entry(results.environment, name); !value.empty())
      out << pair_fill("name", name, "value", value);
  return out;
}

/// Text as a CSS string.
std::string css_string(const std::string& text) {
  // What is no UTF-8 is replaced on the way through JSON.
  using Json = nlohmann::ordered_json;
  const auto legible = Json::parse(Json(text).dump(-1, ' ', false, Json::error_handler_t::replace)).get<std::string>();
  std::string out = "\"";
  for (const char c : legible)
    if (c == '"' || c == '\\' || c == '<' || static_cast<unsigned char>(c) < 0x20)
      out += fmt::format("\\{:x} ", static_cast<unsigned char>(c));
    else
      out += c;
  return out + "\"";
}

}  // namespace

std::string study_fingerprint(const StudyResults& results) {
  constexpr std::size_t digits = 16;
  nlohmann::ordered_json study = results.study;
  if (study.contains("files"))  // where files lie says nothing of the study, nor how their structure is drawn
    for (const char* key : {"folder", "layout"}) study["files"].erase(key);
  std::string content = study.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  content += environment_entry(results.environment, "commit");
  for (const auto& [name, value] : results.environment.entries)
    if (name.starts_with("plugin ")) content += name + without_place(name, value);
  return content_hash(content).substr(0, digits);
}

std::string summary_html(const Choices& choices, const std::string& measures) {
  const StudyResults& results = choices.results();
  if (results.cases.empty()) return "";
  Fill with;
  with.set("name", results.name);
  if (!results.question.empty()) with.set("question", results.question);
  with.set("sketch", scene_svg(results.study));
  with.set("numbers", numbers_fill(results));
  with.set("lines", answer_fill(results));
  with.set("measures", measures);
  with.set("methods", methods_fill(choices));
  with.set("limits", limits_fill(results));
  with.set("identity", identity_fill(results));
  return filled("summary", with);
}

std::string page_margins(const StudyResults& results) {
  const std::string commit = environment_entry(results.environment, "commit"),
                    started = environment_entry(results.environment, kStarted);
  const std::string left = fmt::format("{} · fingerprint {}{}", results.name, study_fingerprint(results),
                                       commit.empty() ? "" : " · commit " + commit);
  return fmt::format(
      "@page {{ size: A4; margin: 14mm 15mm 18mm; @bottom-left {{ content: {}; font: 7.5pt sans-serif; color: #5c5c5c; "
      "white-space: nowrap; }} @bottom-right {{ content: {} \"page \" counter(page) \" of \" counter(pages); font: "
      "7.5pt sans-serif; color: #5c5c5c; white-space: nowrap; }} }}\n",
      css_string(left), started.empty() ? "" : css_string(started + " · "));
}

namespace {

// A row is read at a glance; the report has the rest.
constexpr std::size_t most_index_lines = 3;

Fill study_fill(const IndexEntry& entry) {
  const StudyResults& results = entry.results;
  Fill out, lines{Fill::type::list}, statuses{Fill::type::list};
  out.set("name", results.name);
  out.set("kind", results.kind);
  out.set("question", results.question);
  out.set("link", entry.link);
  const std::vector<std::string> all = answer_lines(results);
  for (std::size_t k = 0; k < std::min(all.size(), most_index_lines); ++k) {
    Fill line;
    line.set("line", all[k]);
    lines << line;
  }
  out.set("lines", lines);
  if (all.size() > most_index_lines)
    out.set("more", count_text(all.size() - most_index_lines, "more line", "more lines") + " in the report");
  for (const auto& [status, count] : status_counts(results)) {
    Fill one;
    one.set("status", word(status));
    one.set("text", status_mark(status) + " " + std::to_string(count) + " " + word(status));
    statuses << one;
  }
  if (const auto missing = results.expected_cases - static_cast<int>(results.cases.size()); missing > 0) {
    Fill one;
    one.set("status", "missing");
    one.set("text", std::to_string(missing) + " not run yet");
    statuses << one;
  }
  out.set("statuses", statuses);
  if (const std::string started = environment_entry(results.environment, kStarted); !started.empty())
    out.set("date", started.substr(0, started.find('T')));
  return out;
}

/// What Markdown would read as a mark.
std::string plain_markdown(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '*' || c == '_' || c == '<' || c == '|' || c == '`') out += '\\';
    out += c;
  }
  return out;
}

}  // namespace

std::string index_markdown(const std::vector<IndexEntry>& studies) {
  std::string out;
  for (const IndexEntry& entry : studies) {
    const StudyResults& results = entry.results;
    out += "**`" + results.name + "`** " + plain_markdown(results.question) + " (" + statuses_text(results) + ")\n\n";
    for (const std::string& line : answer_lines(results)) out += "* " + plain_markdown(line) + "\n";
    out += "\n";
  }
  return out;
}

std::string index_page(const std::vector<IndexEntry>& studies) {
  Fill page, rows{Fill::type::list};
  for (const IndexEntry& one : studies) rows << study_fill(one);
  page.set("style", std::string(asset("page.css")));
  page.set("count", count_text(studies.size(), "study", "studies"));
  page.set("studies", rows);
  return filled("index", page) + "<script>" +
         script_text("\"use strict\";\nconst ricochet = {};\n" + std::string(asset("script/sorting.js")) +
                     "document.querySelectorAll(\"table.sortable\").forEach(ricochet.startSorting);\n") +
         "</script>\n</body>\n</html>\n";
}

}  // namespace ricochet::report
