#include "runners/report/index_page.hpp"

#include <algorithm>

#include "runners/report/answer_lines.hpp"
#include "runners/report/assets.hpp"
#include "runners/report/html.hpp"
#include "runners/report/status_counts.hpp"
#include "runners/report/template.hpp"
#include "runners/store/environment_entries.hpp"

namespace ricochet::report {
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
    one.set("status", status);
    one.set("text", status_mark(status) + " " + std::to_string(count) + " " + status);
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
