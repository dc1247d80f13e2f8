#include "runners/kinds/bifurcation/bifurcation_answers.hpp"

#include <fmt/format.h>

#include "runners/kinds/bifurcation/diagram_answers.hpp"
#include "runners/kinds/kind.hpp"
#include "runners/kinds/sweep/page/orbits.hpp"
#include "runners/report/html.hpp"
#include "runners/table/table_reader.hpp"

namespace ricochet {
namespace {

using report::number_text;

std::string with_unit(double value, const report::Quantity& parameter) {
  return number_text(value, 5) + (parameter.unit.empty() ? "" : " " + parameter.unit);
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
      parts += fmt::format("{}{} in {}{}", parts.empty() ? "" : ", ", depends ? "depends on " + choice : verdict,
                           intervals, share ? fmt::format(" ({} of the range)", report::share_text(*share)) : "");
    }
    const auto from = rows.number(0, "from"), to = rows.number(0, "to");
    const std::string range = from && to ? fmt::format(" of {} from {} to {}", parameter.name, number_text(*from, 5),
                                                       with_unit(*to, parameter))
                                         : "";
    // Of one verdict there are no parts to count.
    const std::string one = rows.text(0, "verdict");
    const bool whole = rows.size() == 1 && one != "depends" && from && to;
    const std::string lead = whole ? fmt::format("Over the whole range{} the motion is {}.", range, one)
                                   : fmt::format("Over {}{} the motion is {}.",
                                                 report::count_text(all, "interval", "intervals"), range, parts);
    for (std::size_t row = 0; row < rows.size(); ++row)
      add(rows.text(row, "choice"), rows.text(row, "verdict"), Cell(rows.number(row, "share")),
          row == 0 ? Cell(lead) : Cell());
  }
  say_diagram(results, out);
  if (const Table* verdicts = find_table(results.derived, "verdicts")) {
    const TableReader rows(*verdicts);
    for (const char* wanted : {"depends", "undecided", "robust"})
      for (std::size_t row = 0; row < rows.size(); ++row)
        if (rows.text(row, "verdict") == wanted) add(rows.text(row, "choice"), wanted, {}, rows.text(row, "sentence"));
  }
  return out;
}

}  // namespace ricochet
