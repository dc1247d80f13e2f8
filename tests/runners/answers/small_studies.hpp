#pragma once
#include <functional>
#include <string>
#include <vector>

#include "runners/run/finish_run.hpp"
#include "runners/table/table_reader.hpp"

/// \file
/// Studies of trajectories made from formulas, and what they answer.
namespace ricochet::synthetic {

/// One choice with its levels.
struct Choice {
  std::string column;
  std::vector<std::string> levels;
};

/// Every combination of the choices at every step; `value` gives the measure by the indices of the levels.
inline StudyResults full_factorial(const std::vector<Choice>& choices, const std::vector<double>& steps,
                                   const std::function<double(const std::vector<std::size_t>&, double)>& value,
                                   const std::string& measure = "energy_left") {
  StudyResults results;
  results.kind = "trajectory";
  for (const Choice& one : choices) results.columns.push_back(one.column);
  results.columns.emplace_back("step");
  std::vector<std::size_t> at(choices.size(), 0);
  for (bool more = true; more;) {
    for (const double step : steps) {
      CaseRecord& record = results.cases.emplace_back();
      record.id = "c" + std::to_string(results.cases.size());
      record.status = Status::done;
      record.steps = 1000;
      for (std::size_t k = 0; k < choices.size(); ++k)
        record.axes.emplace_back(choices[k].column, choices[k].levels[at[k]]);
      record.axes.emplace_back("step", step);
      record.measures = {{measure, value(at, step)}, {"work_of_loads", 0}, {"work_of_damping", 0}};
    }
    more = false;
    for (std::size_t k = choices.size(); k-- > 0 && !more;) {
      more = ++at[k] < choices[k].levels.size();
      if (!more) at[k] = 0;
    }
  }
  results.study = {{"observe", {measure}}};
  return results;
}

/// What a study says, a sentence a line.
inline std::string sentences(const StudyResults& results) {
  const AnalysedResults analysed(results);
  std::string all;
  const TableReader rows(*find_table(analysed.derived, "answers"));
  for (std::size_t row = 0; row < rows.size(); ++row) all += rows.text(row, "sentence") + "\n";
  return all;
}

}  // namespace ricochet::synthetic
