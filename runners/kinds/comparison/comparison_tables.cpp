#include "runners/kinds/comparison/comparison_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <ricochet/measure/motion/orders.hpp>
#include <set>

#include "runners/store/record_values.hpp"
#include "runners/study/axis_meaning.hpp"
#include "runners/table/in_order_met.hpp"
#include "runners/table/table_reader.hpp"

namespace ricochet {
namespace {

using Json = nlohmann::ordered_json;

std::vector<std::string> without(std::vector<std::string> columns, const std::string& one) {
  std::erase(columns, one);
  return columns;
}

const Column error_column{"error", "", "Which error: a quantity of the motion and how its difference is measured."};
const Column value_column{"value", "that of the error", "The error of the case against its reference."};

double size_of(const CaseRecord& record, const std::string& refined) {
  const double value = axis(record, refined).number().value();
  return refined == "step" ? value : 1 / value;
}

// By how much the error of this case would still move if the other quantity were refined: to the finest of it, and by
// what the last refinements say of the rest. The error of the finest case bounds what is in it.
double other_error(const StudyResults& results, const CaseRecord& finest, const std::string& other,
                   const std::string& error) {
  const std::vector<std::string> columns = without(results.columns, other);
  const Row place = axes_of(finest, columns);
  std::vector<std::pair<double, double>> along;  // size, error
  for (const CaseRecord& record : results.cases) {
    const auto value = measure(record, error);
    if (value && axes_of(record, columns) == place) along.emplace_back(size_of(record, other), *value);
  }
  std::sort(along.begin(), along.end());
  if (along.size() < 2) return 0;
  const double here = measure(finest, error).value_or(0);
  // The remaining error is about the last change when it halves at each refinement, less when changes fall faster.
  const double change = std::abs(along[1].second - along[0].second);
  double fall = std::max(1.0, along[1].first / along[0].first);
  if (along.size() > 2 && change > 0) fall = std::max(fall, std::abs(along[2].second - along[1].second) / change - 1);
  return std::min(here, std::abs(here - along.front().second) + change / fall);
}

bool single_valued(const StudyResults& results, const std::string& column) {
  std::set<std::string> values;
  for (const CaseRecord& record : results.cases) values.insert(axis(record, column).text());
  return values.size() < 2;
}

// An oscillator has no mesh whose error could be in the way.
bool meshed(const StudyResults& results) {
  return results.study.at("scene").at("structure").at("type") != "oscillator";
}

/// What errors that do not fall may have met.
std::string saturates_at(const OrderQuestion& question, bool reference_of_law) {
  const bool other = question.other_unknown || question.other_error > 0;
  if (reference_of_law) return other ? question.other : "not told";
  return other ? "the law or " + question.other.substr(4) : "the law";
}

}  // namespace

std::vector<std::string> errors_of(const StudyResults& results) {
  const Json errors = results.study.value("errors", Json::array());
  return errors.get<std::vector<std::string>>();
}

Table errors_table(const StudyResults& results) {
  Table table = table_of_cases(
      results, "errors", "One kind of error of one case.",
      {error_column,
       value_column,
       {"floor", "that of the error",
        "What the reference itself may be wrong by: below it the error says nothing, and below four of it no order."}});
  for (const CaseRecord& record : results.cases)
    for (const std::string& name : errors_of(results))
      if (const auto value = measure(record, "error." + name))
        add_row(table, place_of(results, record), {name, *value, measure(record, "floor." + name)});
  return table;
}

Table orders_table(const StudyResults& results) {
  Table table{
      "orders", "The order with which one kind of error of one method falls as one quantity is refined.", {}, {}};
  table.columns = {{"case", "",
                    "The finest of the cases that the order is fitted to; the others differ in the refined "
                    "quantity alone."}};
  table.columns = joined(std::move(table.columns), axis_columns(results, without(results.columns, "step")));
  table.columns = joined(
      std::move(table.columns),
      {{"refined", "", "What is refined: step or elements; the order is one in the step, or in the element length."},
       error_column,
       {"order", "1", "Fitted order: the slope of the error over the refined quantity, both on logarithmic scales."},
       {"low", "1", "Lower end of the 95 % interval of the order."},
       {"high", "1", "Upper end of the 95 % interval of the order."},
       {"declared", "1", "The order in the step that the scheme declares; empty where it declares none."},
       {"verdict", "", "Whether the fit confirms the declared order, refutes it, or cannot decide."},
       {"reason", "", "What the verdict rests on: which points were used, and what was in the way."},
       {"saturates_at", "",
        "Where the errors do not fall, so that there is no order: what may keep them up. The law: stops of the "
        "reference "
        "are rigid and those of the case are not; the mesh, or the step: the reference has none. Not told: neither."}});
  for (const std::string refined : {"step", "elements"}) {
    const std::string other = refined == "step" ? "elements" : "step";
    std::set<double> sizes;
    for (const CaseRecord& record : results.cases) sizes.insert(size_of(record, refined));
    if (sizes.size() < 2) continue;
    // One order per method: steps on the finest mesh, meshes at the smallest step.
    std::map<std::string, double> finest_other;
    const std::vector<std::string> methods = without(without(results.columns, "step"), "elements");
    for (const CaseRecord& record : results.cases) {
      const double size = size_of(record, other);
      const auto [found, fresh] = finest_other.emplace(key_of(axes_of(record, methods)), size);
      if (!fresh) found->second = std::min(found->second, size);
    }
    for (const Cases& group : groups_of(all_cases(results), without(results.columns, refined))) {
      const CaseRecord& first = *group.front();
      const bool fine = size_of(first, other) == finest_other.at(key_of(axes_of(first, methods)));
      if (refined == "elements" && !fine) continue;
      for (const std::string& name : errors_of(results)) {
        std::vector<OrderPoint> points;
        const CaseRecord* finest = nullptr;
        for (const CaseRecord* record : group)
          if (const auto value = measure(*record, "error." + name)) {
            points.push_back({size_of(*record, refined), *value, measure(*record, "floor." + name).value_or(0)});
            if (!finest || size_of(*record, refined) < size_of(*finest, refined)) finest = record;
          }
        if (!finest) continue;
        OrderQuestion question;
        // A declared order is one in h; the two ends of an interval of time are no norm of the motion.
        if (refined == "step") question.declared = measure(*finest, "declared_order");
        question.refined = refined == "step" ? "step" : "element length";
        question.other_error = other_error(results, *finest, other, "error." + name);
        question.other = refined == "step" ? "the mesh" : "the step";
        // One mesh against a motion without a mesh (or one step): nothing tells how large its error is.
        question.other_unknown = single_valued(results, other) && meshed(results) &&
                                 (refined == "elements" || measure(*finest, "reference_of_mesh") != 1.0);
        const OrderFit fit = fit_order(points, question);
        const bool of_law = measure(*finest, "reference_of_law") != 0.0;
        Row row = {finest->id};
        for (const std::string& column : without(results.columns, "step"))
          row.push_back(column == refined ? Cell() : axis(first, column));
        const std::string gci =
            fit.gci ? fmt::format("; grid convergence index of the finest point used: {:.2g}", *fit.gci) : "";
        const auto slope = [&](const std::optional<double>& value) { return fit.saturated ? Cell() : Cell(value); };
        row.insert(row.end(), {refined, name, slope(fit.order), slope(fit.low), slope(fit.high), question.declared,
                               verdict_word(fit.verdict), fit.reason + gci,
                               fit.saturated ? Cell(saturates_at(question, of_law)) : Cell()});
        table.rows.push_back(std::move(row));
      }
    }
  }
  return table;
}

Table work_precision_table(const StudyResults& results) {
  const std::vector<std::string> methods = without(results.columns, "step");
  Table table{"work_precision", "One kind of error of one case, and what the case costs.", {case_column()}, {}};
  table.columns = joined(std::move(table.columns), axis_columns(results, methods));
  table.columns = joined(std::move(table.columns), axis_columns(results, {"step"}));
  table.columns =
      joined(std::move(table.columns),
             {error_column,
              value_column,
              {"run_seconds", "s", "Processor time of the marching alone, nothing observed: median of the repeats."},
              {"low", "s", "The fastest repeat."},
              {"high", "s", "The slowest repeat."},
              {"steps", "1", "Steps of time that were marched."},
              {"status", "", "done, refused, diverged or failed, as in cases.csv."}});
  for (const CaseRecord& record : results.cases)
    for (const std::string& name : errors_of(results))
      add_row(table, place_of(record, methods),
              {axis(record, "step"), name, measure(record, "error." + name), measure(record, "timed_seconds"),
               measure(record, "timed_low"), measure(record, "timed_high"), record.steps, record.status});
  return table;
}

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
