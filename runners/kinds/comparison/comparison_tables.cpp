#include "runners/kinds/comparison/comparison_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <ricochet/measure/motion/orders.hpp>
#include <set>

#include "runners/json/json_text.hpp"
#include "runners/kinds/comparison/comparison_answers.hpp"
#include "runners/store/record_values.hpp"
#include "runners/study/axis_meaning.hpp"
#include "runners/study/body_keys.hpp"
#include "runners/table/in_order_met.hpp"

namespace ricochet {
namespace {

std::vector<std::string> without(std::vector<std::string> columns, const std::string& one) {
  std::erase(columns, one);
  return columns;
}

const Column error_column{"error", "", "Which error: a quantity of the motion and how its difference is measured."};
Column value_column(const std::string& unit) {
  return {"value", unit, "The error of the case against its reference."};
}

double size_of(const CaseRecord& record, const std::string& refined) {
  const double value = axis(record, refined).number().value();
  return refined == "step" ? value : 1 / value;
}

// By how much the error of this case would still move if the other quantity were refined. The first part is the
// distance to the finest of it. The second is what remains then, judged by the last refinements. The error of the
// finest case is an upper bound.
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
  const auto scene = results.study.find("scene");
  return scene != results.study.end() && has_structure(*scene, {"beam", "bar", "assembled", "modal"});
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

std::string error_unit(const StudyResults& results) {
  std::set<std::string> units;
  for (const std::string& name : errors_of(results)) {
    const MeasureInfo* info = measure_info("error." + name);
    units.insert(info ? info->unit : of_each_error);
  }
  return units.size() == 1 ? *units.begin() : of_each_error;
}

TableType<ErrorRow> errors_type(const std::string& unit) {
  RowType<ErrorRow> rows;
  rows.of_case(&ErrorRow::id)
      .add(error_column, &ErrorRow::error)
      .add(value_column(unit), &ErrorRow::value)
      .add({"floor", unit,
            "What the reference itself may be wrong by: below it the error says nothing, and below four of it no "
            "order."},
           &ErrorRow::floor);
  return {"errors", "One kind of error of one case.", rows};
}

Table errors_table(const StudyResults& results) {
  const TableType<ErrorRow> type = errors_type(error_unit(results));
  Table table = table_of_cases(results, type.head());
  for (const CaseRecord& record : results.cases)
    for (const std::string& name : errors_of(results))
      if (const auto value = measure(record, "error." + name))
        add_row(table, place_of(results, record),
                type.rows.row({record.id, name, value, measure(record, "floor." + name)}));
  return table;
}

TableType<OrderRow> orders_type() {
  RowType<OrderRow> rows;
  rows.of_case(&OrderRow::id)
      .add(
          {"refined", "", "What is refined: step or elements; the order is one in the step, or in the element length."},
          &OrderRow::refined)
      .add(error_column, &OrderRow::error)
      .add(
          {"order", "1", "Fitted order: the slope of the error over the refined quantity, both on logarithmic scales."},
          &OrderRow::order)
      .add({"low", "1", "Lower end of the 95 % interval of the order."}, &OrderRow::low)
      .add({"high", "1", "Upper end of the 95 % interval of the order."}, &OrderRow::high)
      .add({"declared", "1", "The order in the step that the scheme declares; empty where it declares none."},
           &OrderRow::declared)
      .add({"verdict", "", "Whether the fit confirms the declared order, refutes it, or cannot decide."},
           &OrderRow::verdict)
      .add({"reason", "", "What the verdict rests on: which points were used, and what was in the way."},
           &OrderRow::reason)
      .add({"saturates_at", "",
            "Where the errors do not fall, so that there is no order: what may keep them up. The law: stops of the "
            "reference are rigid and those of the case are not; the mesh, or the step: the reference has none. Not "
            "told: neither."},
           &OrderRow::saturates_at);
  return {"orders", "The order with which one kind of error of one method falls as one quantity is refined.", rows};
}

double error_floor(const CaseRecord& record, const std::string& error) {
  constexpr double units = 4;
  const double round_off =
      units * 0x1p-52 * std::sqrt(static_cast<double>(record.steps)) * measure(record, "size." + error).value_or(0);
  return std::max(measure(record, "floor." + error).value_or(0), round_off);
}

namespace {

/// By method, the finest of the other quantity. One order per method: steps on the finest mesh, meshes at the smallest
/// step.
std::map<std::string, double> finest_of(const StudyResults& results, const std::vector<std::string>& methods,
                                        const std::string& other) {
  std::map<std::string, double> finest;
  for (const CaseRecord& record : results.cases) {
    const double size = size_of(record, other);
    const auto [found, fresh] = finest.emplace(key_of(axes_of(record, methods)), size);
    if (!fresh) found->second = std::min(found->second, size);
  }
  return finest;
}

/// Of cases that differ in `refined` alone, and one kind of error; none where no case has it.
std::optional<OrderRow> order_row(const StudyResults& results, const Cases& group, const std::string& refined,
                                  const std::string& other, const std::string& error) {
  std::vector<OrderPoint> points;
  const CaseRecord* finest = nullptr;
  for (const CaseRecord* record : group)
    if (const auto value = measure(*record, "error." + error)) {
      points.push_back({size_of(*record, refined), *value, error_floor(*record, error)});
      if (!finest || size_of(*record, refined) < size_of(*finest, refined)) finest = record;
    }
  if (!finest) return std::nullopt;
  OrderQuestion question;
  // A declared order is one in h; the two ends of an interval of time are no norm of the motion.
  const ShownOrder shown = refined == "step" ? shown_order(*finest, error) : ShownOrder{};
  question.declared = shown.order;
  question.refined = refined == "step" ? "step" : "element length";
  question.other_error = other_error(results, *finest, other, "error." + error);
  question.other = refined == "step" ? "the mesh" : "the step";
  // One mesh against a motion without a mesh (or one step): nothing tells how large its error is.
  question.other_unknown = single_valued(results, other) && meshed(results) &&
                           (refined == "elements" || measure(*finest, "reference_of_mesh") != 1.0);
  const OrderFit fit = fit_order(points, question);
  OrderRow told{.id = finest->id, .refined = refined, .error = error, .declared = question.declared};
  if (!fit.saturated) {
    told.order = fit.order;
    told.low = fit.low;
    told.high = fit.high;
  } else {
    told.saturates_at = saturates_at(question, measure(*finest, "reference_of_law") != 0.0);
  }
  told.verdict = fit.verdict;
  told.reason = fit.reason + (shown.because.empty() ? "" : "; " + shown.because) +
                (fit.gci ? fmt::format("; grid convergence index of the finest point used: {:.2g}", *fit.gci) : "");
  return told;
}

}  // namespace

Table orders_table(const StudyResults& results) {
  const TableType<OrderRow> type = orders_type();
  Table table{type.name, type.text, {}, {}};
  table.columns = {{case_name, "",
                    "The finest of the cases that the order is fitted to; the others differ in the refined "
                    "quantity alone."}};
  table.columns = joined(std::move(table.columns), axis_columns(results, without(results.columns, "step")));
  table.columns = joined(std::move(table.columns), type.rows.columns());
  const std::vector<std::string> methods = without(without(results.columns, "step"), "elements");
  for (const std::string refined : {"step", "elements"}) {
    const std::string other = refined == "step" ? "elements" : "step";
    std::set<double> sizes;
    for (const CaseRecord& record : results.cases) sizes.insert(size_of(record, refined));
    if (sizes.size() < 2) continue;
    const std::map<std::string, double> finest = finest_of(results, methods, other);
    for (const Cases& group : groups_of(all_cases(results), without(results.columns, refined))) {
      const CaseRecord& first = *group.front();
      const bool fine = size_of(first, other) == finest.at(key_of(axes_of(first, methods)));
      if (refined == "elements" && !fine) continue;
      for (const std::string& name : errors_of(results)) {
        const auto told = order_row(results, group, refined, other, name);
        if (!told) continue;
        Row row = {told->id};
        for (const std::string& column : without(results.columns, "step"))
          row.push_back(column == refined ? Cell() : axis(first, column));
        add_row(table, std::move(row), type.rows.row(*told));
      }
    }
  }
  return table;
}

TableType<WorkRow> work_precision_type(const std::string& unit) {
  RowType<WorkRow> rows;
  rows.of_case(&WorkRow::id)
      .add(error_column, &WorkRow::error)
      .add(value_column(unit), &WorkRow::value)
      .add({"run_seconds", "s", "Processor time of the marching alone, nothing observed: median of the repeats."},
           &WorkRow::run_seconds)
      .add({"low", "s", "The fastest repeat."}, &WorkRow::low)
      .add({"high", "s", "The slowest repeat."}, &WorkRow::high)
      .add({"steps", "1", "Steps of time that were marched."}, &WorkRow::steps)
      .add({"status", "", "done, refused, diverged or failed, as in cases.csv."}, &WorkRow::status);
  return {"work_precision", "One kind of error of one case, and what the case costs.", rows};
}

Table work_precision_table(const StudyResults& results) {
  const std::vector<std::string> methods = without(results.columns, "step");
  const TableType<WorkRow> type = work_precision_type(error_unit(results));
  Table table{type.name, type.text, {case_column()}, {}};
  table.columns = joined(std::move(table.columns), axis_columns(results, methods));
  table.columns = joined(std::move(table.columns), axis_columns(results, {"step"}));
  table.columns = joined(std::move(table.columns), type.rows.columns());
  for (const CaseRecord& record : results.cases)
    for (const std::string& name : errors_of(results)) {
      Row place = place_of(record, methods);
      place.push_back(axis(record, "step"));
      add_row(table, std::move(place),
              type.rows.row({record.id, name, measure(record, "error." + name), measure(record, "timed_seconds"),
                             measure(record, "timed_low"), measure(record, "timed_high"), record.steps,
                             word(record.status)}));
    }
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
  if (record.status != Status::done || !value || !seconds || !(*value > 0) || !(*seconds > 0)) return std::nullopt;
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
  return is_method_role(role) || role == "march";
}

bool is_scene(const std::string& column) {
  return !is_method(column) && column != "elements" && column != "step";
}

TableType<TargetRow> precision_targets_type(const std::string& unit) {
  RowType<TargetRow> rows;
  const auto add = [&](Column column, TargetCase TargetRow::*which, auto TargetCase::*member) {
    using Value = std::remove_reference_t<decltype(std::declval<TargetCase>().*member)>;
    rows.add(
        std::move(column), [which, member](const TargetRow& row) { return Cell(row.*which.*member); },
        [which, member](TargetRow& row, const Cell& cell) {
          if (!cell.is_nothing()) row.*which.*member = CellValue<Value>::of(cell).value_or(Value());
        });
  };
  rows.in_front(case_name, [](TargetRow& row, const Cell& cell) { row.first.id = cell.text(); });
  rows.add({"error", "", "Which error: a quantity of the motion and how its difference is measured."},
           &TargetRow::error);
  rows.add({"at_most", unit, "The error to be reached."}, &TargetRow::at_most);
  add({"seconds", "s", "Processor time of the case: median of the repeats."}, &TargetRow::first, &TargetCase::seconds);
  add({"low", "s", "Its fastest repeat."}, &TargetRow::first, &TargetCase::low);
  add({"high", "s", "Its slowest repeat."}, &TargetRow::first, &TargetCase::high);
  add({"other_case", "", "The fastest case of any other method that gets there."}, &TargetRow::other, &TargetCase::id);
  add({"other_seconds", "s", "Processor time of that case: median of the repeats."}, &TargetRow::other,
      &TargetCase::seconds);
  add({"other_low", "s", "Its fastest repeat."}, &TargetRow::other, &TargetCase::low);
  add({"other_high", "s", "Its slowest repeat."}, &TargetRow::other, &TargetCase::high);
  rows.add({"speed_up", "1", "other_seconds over seconds."}, &TargetRow::speed_up);
  rows.add({"overlap", "", "Whether the repeats of both overlap, so that they are not told apart."},
           &TargetRow::overlap);
  rows.add({"share", "1",
            "at_most over what the error of a motion at rest would be, a power of ten. Empty where that is not known: "
            "then at_most is one."},
           &TargetRow::share);
  return {"precision_targets",
          "One error to be reached in one scene: the cheapest method with a step that was run, and the runner-up.",
          rows};
}

Table precision_targets_table(const StudyResults& results) {
  const std::vector<std::string> scene = columns_that(results, is_scene), method = columns_that(results, is_method);
  const TableType<TargetRow> type = precision_targets_type(error_unit(results));
  Table table{type.name, type.text, {{case_name, "", "The case that gets there in the least time."}}, {}};
  table.columns = joined(joined(std::move(table.columns), axis_columns(results, scene)), type.rows.columns());
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
        const auto costs = [](const TimedError& one) {
          return TargetCase{one.record->id, one.seconds, one.low, one.high};
        };
        TargetRow row{costs(first), {}, error.get<std::string>(), tolerance, {}, {}, {}};
        if (entries.size() > 1) {
          row.other = costs(entries[1]);
          row.speed_up = entries[1].seconds / first.seconds;
          row.overlap = entries[1].low <= first.high;
        }
        if (size > 0) row.share = share;
        add_row(table, place_of(*first.record, scene), type.rows.row(row));
        if (tolerance <= best->known) break;
      }
    }
  return table;
}

TableType<OrderVerdicts> order_verdicts_type() {
  RowType<OrderVerdicts> rows;
  rows.add({"orders", "1", "Orders that were fitted."}, &OrderVerdicts::orders)
      .add({"declared", "1", "Those whose scheme declares an order for such a run."}, &OrderVerdicts::declared)
      .add({"confirmed", "1", "Those that agree with the declared order."}, &OrderVerdicts::confirmed)
      .add({"refuted", "1", "Those that do not."}, &OrderVerdicts::refuted)
      .add({"undecided", "1", "Those of which the points do not tell."}, &OrderVerdicts::undecided);
  return {"order_verdicts", "Over all cases: how often fitted orders are those that the schemes declare.", rows};
}

Table order_verdicts_table(const Table& orders) {
  OrderVerdicts counts;
  for (const OrderRow& row : orders_type().rows.read(orders)) {
    ++counts.orders;
    if (!row.declared) continue;
    counts.confirmed += row.verdict == OrderVerdict::confirmed;
    counts.refuted += row.verdict == OrderVerdict::refuted;
    counts.undecided += row.verdict == OrderVerdict::undecided;
  }
  counts.declared = counts.confirmed + counts.refuted + counts.undecided;
  return order_verdicts_type().with({counts});
}

}  // namespace ricochet
