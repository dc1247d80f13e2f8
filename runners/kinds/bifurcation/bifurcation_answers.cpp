#include "runners/kinds/bifurcation/bifurcation_answers.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "runners/kinds/bifurcation/diagram_answers.hpp"
#include "runners/kinds/kind.hpp"
#include "runners/kinds/sweep/page/orbits.hpp"
#include "runners/report/html.hpp"
#include "runners/study/axis_meaning.hpp"
#include "runners/table/table_reader.hpp"

namespace ricochet {
namespace {

using report::number_text;

std::string with_unit(double value, const report::Quantity& parameter) {
  return number_text(value, 5) + (parameter.unit.empty() ? "" : " " + parameter.unit);
}

// An answer tells the widest intervals of each verdict, and how many others there are.
constexpr std::size_t most_told = 3;

std::vector<bool> told_in_full(const TableReader& verdicts) {
  std::vector<bool> told(verdicts.size(), false);
  for (const char* wanted : {"depends", "undecided", "robust"}) {
    std::vector<std::size_t> found;
    for (std::size_t row = 0; row < verdicts.size(); ++row)
      if (verdicts.text(row, "verdict") == wanted) found.push_back(row);
    const auto width = [&](std::size_t row) {
      return verdicts.number(row, "to").value_or(0) - verdicts.number(row, "from").value_or(0);
    };
    std::stable_sort(found.begin(), found.end(), [&](std::size_t a, std::size_t b) { return width(a) > width(b); });
    for (std::size_t k = 0; k < std::min(found.size(), most_told); ++k) told[found[k]] = true;
  }
  return told;
}

}  // namespace

Table bifurcation_answers(const StudyResults& results) {
  Table out = answers_head();
  const auto add = [&](const std::string& choice, const std::string& verdict, const Cell& share, const Cell& sentence) {
    out.rows.push_back(AnswerRow{.choice = choice, .verdict = verdict, .effect = share, .sentence = sentence}.row());
  };
  const report::Quantity parameter = report::swept_parameter(results);
  if (const Table* shares = find_table(results.derived, "verdict_shares"); shares && !shares->rows.empty()) {
    const TableReader rows(*shares);
    std::size_t all = 0;
    std::string parts;
    for (std::size_t row = 0; row < rows.size(); ++row) {
      const std::string verdict = rows.text(row, "verdict"), choice = rows.text(row, "choice");
      const auto intervals = static_cast<std::size_t>(rows.number(row, "intervals").value_or(0));
      const auto share = rows.number(row, "share");
      all += intervals;
      const bool depends = verdict == "depends" && !choice.empty();
      parts += fmt::format("{}{} in {}{}", parts.empty() ? "" : ", ",
                           depends ? "depends on " + spoken_choice(choice) : verdict, intervals,
                           share ? fmt::format(" ({} of the range)", report::share_text(*share)) : "");
    }
    const auto from = rows.number(0, "from"), to = rows.number(0, "to");
    const std::string range = from && to ? fmt::format(" of {} from {} to {}", parameter.name, number_text(*from, 5),
                                                       with_unit(*to, parameter))
                                         : "";
    // Of one verdict there are no parts to count.
    const std::string one = rows.text(0, "verdict");
    const bool whole = rows.size() == 1 && one != "depends" && from && to;
    const std::string lead = whole ? fmt::format("Over the whole range{} the motion is {}.", range, one)
                                   : fmt::format("The motion over {}{}: {}.",
                                                 report::count_text(all, "interval", "intervals"), range, parts);
    for (std::size_t row = 0; row < rows.size(); ++row)
      add(rows.text(row, "choice"), rows.text(row, "verdict"), Cell(rows.number(row, "share")),
          row == 0 ? Cell(lead) : Cell());
  }
  say_diagram(results, out);
  if (const Table* verdicts = find_table(results.derived, "verdicts")) {
    const TableReader rows(*verdicts);
    const std::vector<bool> told = told_in_full(rows);
    std::size_t untold = 0;
    for (const char* wanted : {"depends", "undecided", "robust"})
      for (std::size_t row = 0; row < rows.size(); ++row)
        if (rows.text(row, "verdict") == wanted) {
          untold += !told[row];
          add(rows.text(row, "choice"), wanted, {}, told[row] ? Cell(rows.text(row, "sentence")) : Cell());
        }
    if (untold > 0)
      add("", "", {},
          fmt::format("{} told in verdicts.csv alone, none wider than those of its verdict above.",
                      report::count_text(untold, "interval is", "intervals are")));
  }
  return out;
}

}  // namespace ricochet
