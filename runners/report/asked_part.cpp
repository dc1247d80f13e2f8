#include "runners/report/asked_part.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "runners/report/ask_figure.hpp"
#include "runners/report/html.hpp"

namespace ricochet::report {
namespace {

constexpr std::size_t long_text = 60;  // which a narrow column would make tall

std::string table_html(const AskedTable& table) {
  HtmlTable out("", {}, "verdicts");
  for (std::size_t k = 0; k < table.heads.size(); ++k) out.add({table.heads[k], k == table.values});
  for (const std::vector<std::string>& row : table.rows) {
    out.row("", "", unbroken(row.front()));
    for (std::size_t k = 1; k < row.size(); ++k) {
      if (k != table.values)
        out.cell(row[k].empty() ? "–" : unbroken(row[k]), row[k].size() > long_text ? " class=\"long\"" : "");
      else if (row[k].empty())
        out.absent();
      else
        out.number(row[k]);
    }
  }
  return out.html(table.rows.size());
}

/// The ask beside which the kind's own chart stands: the first whose figure that is, or that has none where no ask has
/// any; the number of asks where there is none.
std::size_t with_own_chart(const std::vector<AskedPart>& parts) {
  const auto own = [](const AskedPart& part) {
    return part.figure.is_object() && part.figure.value("form", "") == "own";
  };
  const auto found = std::find_if(parts.begin(), parts.end(), own);
  if (found != parts.end()) return static_cast<std::size_t>(found - parts.begin());
  const bool none =
      std::all_of(parts.begin(), parts.end(), [](const AskedPart& part) { return part.figure.is_null(); });
  return none ? 0 : parts.size();
}

}  // namespace

std::string asked_html(const AskedAnswers& asked) {
  std::string out;
  std::set<std::string> told;
  const auto line = [&](const std::string& text) {
    if (told.insert(text).second) out += "<p class=\"warns\">" + unbroken(text) + "</p>\n";
  };
  for (const std::string& one : asked.first) line(one);
  const std::size_t own = with_own_chart(asked.parts);
  for (std::size_t k = 0; k < asked.parts.size(); ++k) {
    const AskedPart& part = asked.parts[k];
    for (const std::string& one : part.aside) line(one);
    const std::string table = table_html(part.table), figure = figure_svg(part.figure);
    out += fmt::format("<div class=\"asked\" id=\"ask-{}\">\n<p class=\"headline\">{}</p>\n<div class=\"told\">\n{}",
                       part.number, unbroken(part.sentence), table);
    if (!figure.empty()) out += "<div class=\"scroll drawn\">" + figure + "</div>\n";
    if (k == own) out += "<div id=\"answer-figure\"></div>\n";
    out += "</div></div>\n";
  }
  return out;
}

}  // namespace ricochet::report
