
#include <algorithm>

#include "runners/answers/limits.hpp"
#include "runners/kinds/comparison/comparison_answers.hpp"
#include "runners/kinds/comparison/comparison_tables.hpp"
#include "runners/table/in_order_met.hpp"

namespace ricochet {

using namespace answers;

bool MethodRun::clean() const {
  const bool contradicted = run.length == 2 && run.stops_at;
  return run.clean() && !(contradicted && errors_of(cases) == Errors::saw_toothed);
}

std::vector<MethodRun> runs_of(const Choices& study, const std::string& error, const std::string& refined) {
  return runs_of(study, all_cases(study.results()), error, refined);
}

std::vector<MethodRun> runs_of(const Choices& study, const Cases& all, const std::string& error,
                               const std::string& refined) {
  InOrderMet<std::string, Cases> methods;
  for (const CaseRecord* record : all) methods[study.key(*record)].push_back(record);
  const bool step = refined == "step";
  const auto size = [&](const CaseRecord& record) {
    return step                     ? study.step(record)
           : study.elements(record) ? std::optional(1 / *study.elements(record))
                                    : std::nullopt;
  };
  const auto other = [&](const CaseRecord& record) {
    return step ? 1 / study.elements(record).value_or(1) : study.step(record).value_or(1);
  };
  std::vector<MethodRun> out;
  for (const auto& [key, cases] : methods.list()) {
    std::optional<double> finest_other;
    for (const CaseRecord* record : cases)
      if (record->status == Status::done && measure(*record, "error." + error))
        finest_other = std::min(finest_other.value_or(other(*record)), other(*record));
    MethodRun one;
    std::vector<SizedValue> errors;
    double floor = 0;
    for (const CaseRecord* record : cases) {
      const auto value = measure(*record, "error." + error);
      const auto at = size(*record);
      if (record->status != Status::done || !value || !at || other(*record) != *finest_other) continue;
      errors.push_back({*at, *value});
      floor = std::max(floor, error_floor(*record, error));
      if (!one.finest || *at < *size(*one.finest)) one.finest = record;
    }
    if (errors.size() < 2) continue;
    std::stable_sort(errors.begin(), errors.end(),
                     [](const SizedValue& a, const SizedValue& b) { return a.size > b.size; });
    one.errors = errors;
    one.floor = floor;
    one.cases = cases;
    one.run = *order_run(errors, floor);
    if (step) one.declared = shown_order(*one.finest, error);
    if (const auto motion = measure(*one.finest, "size." + error); motion && *motion > 0) one.motion = motion;
    out.push_back(std::move(one));
  }
  return out;
}

Table order_runs_table(const Choices& study) {
  const StudyResults& results = study.results();
  Table table{
      "order_runs",
      "One method, error and refined quantity: the order over the longest run of slopes that agree, and where it ends.",
      {case_column()},
      {}};
  for (const std::string& column : study.columns()) table.columns.push_back(axis_column(results, column));
  for (const Column& column :
       {Column{"refined", "", "step or elements; at the finest of the other."},
        {"error", "", "Which error: a quantity of the motion and how its difference is measured."},
        {"verdict", "", "order, stops, does not fall, no steady order, at the floor, too few."},
        {"order", "1", "Slope over the whole run; in the step, or in the element's length."},
        {"least", "1", "Least local slope of the run."},
        {"most", "1", "Largest local slope of the run."},
        {"from", "", "The coarsest size of the run: s, or 1 over the elements."},
        {"to", "", "Its finest size."},
        {"stops_at", error_unit(results), "The smallest error, where the fall ends."},
        {"left", "1", "That error over what a motion at rest would err by."},
        {"declared", "1", "The order in the step that the scheme declares; none where it declares none."}})
    table.columns.push_back(column);
  for (const std::string refined : {"step", "elements"}) {
    if (!study.varies(refined)) continue;
    for (const std::string& error : errors_of(results))
      for (const MethodRun& one : runs_of(study, error, refined)) {
        const bool order = one.run.verdict == OrderRun::Verdict::order;
        Row row = {one.finest->id};
        for (const std::string& column : study.columns()) row.push_back(axis(*one.finest, column));
        const auto slope = [&](double value) { return order ? Cell(value) : Cell(); };
        for (Cell cell :
             {Cell(refined), Cell(error), Cell(word(one.run.verdict)), slope(one.run.order), slope(one.run.least),
              slope(one.run.most), slope(one.run.from), slope(one.run.to), Cell(one.run.stops_at),
              one.run.stops_at && one.motion ? Cell(*one.run.stops_at / *one.motion) : Cell(),
              Cell(one.declared.order)})
          row.push_back(std::move(cell));
        table.rows.push_back(std::move(row));
      }
  }
  return table;
}

}  // namespace ricochet
