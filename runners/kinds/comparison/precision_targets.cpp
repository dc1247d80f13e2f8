#include "runners/kinds/comparison/precision_targets.hpp"

#include <algorithm>
#include <cmath>

#include "runners/store/record_values.hpp"
#include "runners/study/axis_meaning.hpp"
#include "runners/table/in_order_met.hpp"
#include "runners/table/table_reader.hpp"

namespace ricochet {
namespace {

/// A timed case with one kind of error.
struct TimedError {
  const CaseRecord* record = nullptr;
  double known = 0;                       ///< the error, or its floor if that is larger; > 0
  double size = 0;                        ///< what a motion at rest has; 0 where it is not known
  double seconds = 0, low = 0, high = 0;  ///< run time: median, fastest, slowest
};

template <class Wanted>
std::vector<std::string> columns_that(const StudyResults& results, Wanted wanted) {
  std::vector<std::string> out;
  std::copy_if(results.columns.begin(), results.columns.end(), std::back_inserter(out), wanted);
  return out;
}

std::optional<TimedError> timed_error(const CaseRecord& record, const std::string& error) {
  const auto value = measure(record, "error." + error), seconds = measure(record, "timed_seconds");
  if (record.status != "done" || !value || !seconds || !(*value > 0) || !(*seconds > 0)) return std::nullopt;
  return TimedError{&record,
                    std::max(*value, measure(record, "floor." + error).value_or(0)),
                    measure(record, "size." + error).value_or(0),
                    *seconds,
                    measure(record, "timed_low").value_or(*seconds),
                    measure(record, "timed_high").value_or(*seconds)};
}

// The fastest case of each method that is precise enough, the fastest method first.
std::vector<TimedError> fastest(const std::vector<TimedError>& points, double tolerance,
                                const std::vector<std::string>& method) {
  std::vector<std::pair<std::string, TimedError>> best;
  for (const TimedError& point : points) {
    if (point.known > tolerance) continue;
    TimedError& known = in_order_met(best, key_of(axes_of(*point.record, method)));
    if (!known.record || point.seconds < known.seconds) known = point;
  }
  std::vector<TimedError> out;
  for (const auto& [name, point] : best) out.push_back(point);
  std::stable_sort(out.begin(), out.end(),
                   [](const TimedError& a, const TimedError& b) { return a.seconds < b.seconds; });
  return out;
}

}  // namespace

bool is_method(const std::string& column) {
  const std::string role = axis_role(column);
  return role == "mass" || role == "contact" || role == "time" || role == "march";
}

bool is_scene(const std::string& column) {
  return !is_method(column) && column != "elements" && column != "step";
}

Table precision_targets_table(const StudyResults& results) {
  const std::vector<std::string> scene = columns_that(results, is_scene), method = columns_that(results, is_method);
  Table table{"precision_targets",
              "One error to be reached in one scene: the cheapest method with a step that was run, and the runner-up.",
              {{"case", "", "The case that gets there in the least time."}},
              {}};
  table.columns = joined(joined(std::move(table.columns), axis_columns(results, scene)),
                         {{"error", "", "Which error: a quantity of the motion and how its difference is measured."},
                          {"at_most", "that of the error", "The error to be reached."},
                          {"seconds", "s", "Processor time of the case: median of the repeats."},
                          {"low", "s", "Its fastest repeat."},
                          {"high", "s", "Its slowest repeat."},
                          {"other_case", "", "The fastest case of any other method that gets there."},
                          {"other_seconds", "s", "Processor time of that case: median of the repeats."},
                          {"other_low", "s", "Its fastest repeat."},
                          {"other_high", "s", "Its slowest repeat."},
                          {"speed_up", "1", "other_seconds over seconds."},
                          {"overlap", "", "Whether the repeats of both overlap, so that they are not told apart."},
                          {"share", "1",
                           "at_most over what the error of a motion at rest would be, a power of ten; empty where that "
                           "is not known: then at_most is one."}});
  const std::vector<Cases> scenes = groups_of(all_cases(results), scene);
  const nlohmann::ordered_json errors = results.study.value("errors", nlohmann::ordered_json::array());
  for (const auto& error : errors)
    for (const Cases& cases : scenes) {
      std::vector<TimedError> points;
      for (const CaseRecord* record : cases)
        if (const auto point = timed_error(*record, error.get<std::string>())) points.push_back(*point);
      if (points.empty()) continue;
      const auto [best, worst] = std::minmax_element(
          points.begin(), points.end(), [](const TimedError& a, const TimedError& b) { return a.known < b.known; });
      double size = 0;
      for (const TimedError& point : points) size = std::max(size, point.size);
      const double unit = size > 0 ? size : 1;
      int k = static_cast<int>(std::ceil(-std::log10(worst->known / unit)));
      while (best->known > unit * std::pow(10, -k)) --k;
      for (;; ++k) {
        const double share = std::pow(10, -k), tolerance = unit * share;
        const std::vector<TimedError> entries = fastest(points, tolerance, method);
        if (entries.empty()) break;
        const TimedError& first = entries[0];
        Row row = place_of(*first.record, scene);
        row.insert(row.end(), {error.get<std::string>(), tolerance, first.seconds, first.low, first.high});
        if (entries.size() > 1) {
          const TimedError& second = entries[1];
          row.insert(row.end(), {second.record->id, second.seconds, second.low, second.high,
                                 second.seconds / first.seconds, second.low <= first.high});
        }
        row.resize(table.columns.size());
        if (size > 0) row.back() = share;
        table.rows.push_back(std::move(row));
        if (tolerance <= best->known) break;
      }
    }
  return table;
}

Table order_verdicts_table(const Table& orders) {
  Table table{"order_verdicts",
              "Over all cases: how often fitted orders are those that the schemes declare.",
              {{"orders", "1", "Orders that were fitted."},
               {"declared", "1", "Those whose scheme declares an order for such a run."},
               {"confirmed", "1", "Those that agree with the declared order."},
               {"refuted", "1", "Those that do not."},
               {"undecided", "1", "Those of which the points do not tell."}},
              {}};
  const TableReader rows(orders);
  const std::size_t declared = rows.column("declared"), verdict = rows.column("verdict");
  const auto count = [&](const char* word) {
    int out = 0;
    for (std::size_t row = 0; row < rows.size(); ++row)
      out += rows.number(row, declared) && rows.text(row, verdict) == word;
    return out;
  };
  const int confirmed = count("confirmed"), refuted = count("refuted"), undecided = count("undecided");
  table.rows.push_back({rows.size(), confirmed + refuted + undecided, confirmed, refuted, undecided});
  return table;
}

}  // namespace ricochet
