#include "runners/kinds/stability/step_limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "runners/kinds/stability/step_range.hpp"
#include "runners/store/record_values.hpp"
#include "runners/table/table_reader.hpp"

namespace ricochet {
namespace {

// Whether the range has a limit, and which way it has none.
template <class Known, class Unstable>
std::string where(const StepRange& range, const std::optional<double>& limit, Known known, Unstable unstable) {
  if (limit) return "limit";
  if (std::none_of(range.cells.begin(), range.cells.end(), known)) return "";
  return std::any_of(range.cells.begin(), range.cells.end(), unstable) ? "below the range" : "none";
}

std::string prediction(const StepRange& range) {
  const auto known = [](const StepCell& cell) { return cell.radius.has_value(); };
  return where(range, range.predicted, known, std::mem_fn(&StepCell::predicted_unstable));
}

std::string observation(const StepRange& range) {
  const auto known = [](const StepCell& cell) { return !cell.behaviour.empty(); };
  return where(range, range.observed, known, std::mem_fn(&StepCell::observed_unstable));
}

std::string marginal(const StepRange& range) {
  std::vector<std::string> said;
  for (const StepCell& cell : range.cells)
    if (!cell.marginal.empty() && std::find(said.begin(), said.end(), cell.marginal) == said.end())
      said.push_back(cell.marginal);
  if (said.size() > 2) {
    const std::size_t more = said.size() - 2;
    said.resize(2);
    said.push_back(fmt::format("and {} more", more));
  }
  return fmt::format("{}", fmt::join(said, "; "));
}

// The smallest step that is not stable, and what grows there: the first sentence of its reason, the others say what was
// seen.
const StepCell* first_unstable(const StepRange& range) {
  const auto found = std::find_if(range.cells.begin(), range.cells.end(), [](const StepCell& cell) {
    return cell.status == "unstable" || cell.status == "failed" || cell.status == "refused";
  });
  return found == range.cells.end() ? nullptr : &*found;
}

bool is_contact(const std::string& column) {
  return column == "contact" || column.starts_with("contact.");
}

// Of the cases that differ in the contact law alone: the first that was done, or the first.
Cases counted_open(const StudyResults& results) {
  std::vector<std::string> others;
  for (const std::string& column : results.columns)
    if (!is_contact(column)) others.push_back(column);
  Cases open = all_cases(results), out;
  std::erase_if(open, [](const CaseRecord* record) { return !step_range(*record, false); });
  for (const Cases& group : groups_of(open, others)) {
    const auto done =
        std::find_if(group.begin(), group.end(), [](const CaseRecord* record) { return record->status == "done"; });
    out.push_back(done == group.end() ? group.front() : *done);
  }
  return out;
}

}  // namespace

Table step_limits_table(const StudyResults& results) {
  Table table = table_of_cases(
      results, "step_limits", "One case with its contact open or closed: the step limits that its cells come to.",
      {{"closed", "",
        "Whether contact is closed: predicted with points held on both sides, observed in the scene itself. Otherwise "
        "the structure alone."},
       {"counted", "",
        "Whether the row counts in step_limit_agreement.csv: the open structure of cases that differ in the contact "
        "law alone counts once."},
       {"prediction", "", "limit, none (every step of the range is stable), below the range, or empty: not made."},
       {"predicted", "s", "Largest stable step, from the plan alone."},
       {"observation", "", "limit, none (every step of the range is stable), below the range, or empty: not made."},
       {"observed", "s", "Largest stable step, from marches and bisection."},
       {"expected", "s", "The smallest predicted limit that the marched cell meets: a scene is open as well."},
       {"ratio", "1", "observed over expected."},
       {"agrees", "", "Whether the ratio is one to 2 %; empty where a limit is missing."},
       {"disagreeing_steps", "1", "Steps of the range at which the march does not do what the spectra say."},
       {"marginal", "", "Which roots on the unit circle are the scheme's own, over the range."},
       {"first_unstable", "s", "Smallest step of the range that is unstable, failed or refused."},
       {"grows", "", "What grows there, or why it is refused."},
       {"refused", "", "Whether that step is refused."}});
  const Cases counted = counted_open(results);
  for (const bool closed : {false, true})
    for (const CaseRecord& record : results.cases) {
      const std::optional<StepRange> range = step_range(record, closed);
      if (!range) continue;
      const bool counts = closed || std::find(counted.begin(), counted.end(), &record) != counted.end();
      std::optional<double> ratio;
      if (range->expected && range->observed) ratio = *range->observed / *range->expected;
      const StepCell* grows = first_unstable(*range);
      add_row(table, place_of(results, record),
              {closed, counts, prediction(*range), range->predicted, observation(*range), range->observed,
               range->expected, ratio, ratio ? Cell(std::abs(*ratio - 1) <= limit_tolerance) : Cell(),
               std::count_if(range->cells.begin(), range->cells.end(),
                             [](const StepCell& cell) { return cell.disagrees(); }),
               marginal(*range), grows ? Cell(grows->step) : Cell(),
               grows ? grows->reason.substr(0, grows->reason.find("; ")) : "",
               grows ? Cell(grows->status == "refused") : Cell()});
    }
  return table;
}

Table step_limit_agreement_table(const Table& step_limits) {
  Table table{"step_limit_agreement",
              "Over all cases: how often observed step limits are those that are expected.",
              {{"contact", "", "open, closed, or both together."},
               {"ranges", "1", "Ranges of steps: a method with its contact open or closed."},
               {"limits", "1", "Ranges whose limit is both predicted and observed."},
               {"agree", "1", "Those whose limits agree within the tolerance."},
               {"tolerance", "1", "Difference, relative to the expected limit, up to which limits agree."},
               {"disagree", "1", "Ranges with a step at which the march does not do what the spectra say."}},
              {}};
  const TableReader rows(step_limits);
  const std::size_t closed = rows.column("closed"), counted = rows.column("counted"), agrees = rows.column("agrees"),
                    disagreeing = rows.column("disagreeing_steps");
  for (const char* contact : {"open", "closed", "both"}) {
    int ranges = 0, limits = 0, agree = 0, disagree = 0;
    for (std::size_t row = 0; row < rows.size(); ++row) {
      const bool touching = rows.truth(row, closed).value_or(false);
      const bool asked = contact == std::string("both") || touching == (contact == std::string("closed"));
      if (!asked || rows.truth(row, counted) != true) continue;
      ++ranges;
      limits += rows.truth(row, agrees).has_value();
      agree += rows.truth(row, agrees) == true;
      disagree += rows.number(row, disagreeing).value_or(0) > 0;
    }
    table.rows.push_back({contact, ranges, limits, agree, limit_tolerance, disagree});
  }
  return table;
}

}  // namespace ricochet
