#include "runners/kinds/work-precision/page/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <numeric>

#include "runners/kinds/comparison/comparison.hpp"
#include "runners/kinds/comparison/comparison_tables.hpp"
#include "runners/report/choices.hpp"
#include "runners/report/html.hpp"
#include "runners/report/quantity.hpp"

namespace ricochet::report {

KindPage work_precision_page() {
  KindPage page = comparison_page();
  page.scripts = scripts({"error_names", "work_against_error", "work_front", "work_precision", "steps_precision",
                          "step_cost", "order_dots", "errors"});
  page.tables.push_back("work_points");
  page.derived.push_back(work_points);
  page.answer = [](const Choices& choices) { return work_precision_html(choices) + orders_html(choices); };
  return page;
}

WorkPrecision::WorkPrecision(const Choices& choices)
    : rows_(choices.results(), work_precision_type(),
            [](const WorkRow& row) -> std::vector<std::string> { return {row.error}; }),
      errors_(choices.results(), errors_type(),
              [](const ErrorRow& row) -> std::vector<std::string> { return {row.error}; }) {}

std::vector<std::string> scene_columns(const Choices& choices) {
  std::vector<std::string> scene;
  std::copy_if(choices.varying().begin(), choices.varying().end(), std::back_inserter(scene), is_scene);
  return scene;
}

std::optional<WorkPoint> WorkPrecision::point(const CaseRecord& record, const std::string& error) const {
  const auto found = rows_.find(record, {error});
  if (!found || record.status != Status::done) return std::nullopt;
  const WorkRow& row = rows_[*found];
  const auto value = row.value, seconds = row.run_seconds;
  if (!value || !seconds || !(*value > 0) || !(*seconds > 0)) return std::nullopt;
  WorkPoint out{&record, *value, *seconds, row.low.value_or(*seconds), row.high.value_or(*seconds), 0, 0};
  out.steps = static_cast<double>(row.steps);
  if (const auto known = errors_.find(record, {error})) out.floor = errors_[*known].floor.value_or(0);
  return out;
}

std::string WorkPrecision::why_none(const CaseRecord& record, const std::string& error) const {
  const auto row = rows_.find(record, {error});
  const auto value = row ? rows_[*row].value : std::nullopt;
  const auto seconds = row ? rows_[*row].run_seconds : std::nullopt;
  return !value ? "no such error" : !(*value > 0) ? "error exactly 0" : !seconds || !(*seconds > 0) ? "not timed" : "";
}

std::vector<WorkPoint> WorkPrecision::points(const Cases& cases, const std::string& error) const {
  std::vector<WorkPoint> out;
  for (const CaseRecord* record : cases)
    if (const auto one = point(*record, error)) out.push_back(*one);
  return out;
}

std::vector<size_t> pareto_front(const std::vector<WorkPoint>& points, double (*work)(const WorkPoint&)) {
  std::vector<size_t> order(points.size()), out;
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) {
    return std::pair(points[a].known(), work(points[a])) < std::pair(points[b].known(), work(points[b]));
  });
  for (const size_t k : order) {
    const bool beaten =
        !out.empty() && work(points[out.back()]) <= work(points[k]) &&
        !(points[out.back()].known() == points[k].known() && work(points[out.back()]) == work(points[k]));
    if (!beaten) out.push_back(k);
  }
  return out;
}

bool told_from_front(const WorkPoint& point, const std::vector<WorkPoint>& points) {
  return std::any_of(points.begin(), points.end(),
                     [&](const WorkPoint& other) { return other.known() <= point.known() && other.high < point.low; });
}

namespace {

/// The method of a case, its step, and its time.
void case_cells(HtmlTable& table, const Choices& choices, const TargetCase& one) {
  const CaseRecord* record = choices.find(one.id.value_or(""));
  if (!record) {
    table.absent(false, "no other").absent(false).absent();
    return;
  }
  std::vector<std::string> methods;
  std::copy_if(choices.varying().begin(), choices.varying().end(), std::back_inserter(methods), is_method);
  std::string how = exact_text(axis(*record, "step").number().value_or(0)) + " s";
  if (choices.varies("elements")) how += ", " + axis_words(*record, "elements") + " elements";
  table.text(choices.short_name(*record, methods)).text(how);
  table.number(number_text(one.seconds.value_or(0), 3),
               number_text(one.low.value_or(0), 4) + " to " + number_text(one.high.value_or(0), 4) + " s");
}

}  // namespace

std::string work_precision_html(const Choices& choices) {
  const TableType<TargetRow> type = precision_targets_type();
  if (!type.find(choices.results().derived)) return "";
  const std::vector<std::string> scene = scene_columns(choices);
  std::vector<HtmlTable::Head> heads = {
      {"error"},     {"at most", true}, {"cheapest"},           {"with step"},      {"run time (s)", true},
      {"runner-up"}, {"with step"},     {"run time (s)", true}, {"speed-up", true}, {"spreads"}};
  if (!scene.empty()) heads.insert(heads.begin() + 1, {"scene"});
  HtmlTable table(
      "The cheapest method for a relative error of at most 10<sup>−k</sup>, 1 being a motion at rest. It takes the "
      "least time of the steps that were run. Spread: fastest to slowest repeat (in the time's tooltip); where the "
      "spreads overlap, the two are not told apart.",
      std::move(heads));
  for (const TargetRow& row : type.read(choices.results().derived)) {
    Quantity quantity = error_quantity(row.error);
    quantity.name = row.error;
    table.row().text(with_unit(quantity), "text");
    const CaseRecord* record = choices.find(row.first.id.value_or(""));
    if (!scene.empty()) table.text(record ? choices.short_label(*record, scene) : "");
    const double at_most = row.at_most.value_or(0);
    table.number(power_text(row.share.value_or(at_most)), row.share ? exact_text(at_most) : "");
    case_cells(table, choices, row.first);
    case_cells(table, choices, row.other);
    if (row.speed_up)
      table.number(number_text(*row.speed_up, 3) + " ×").text(row.overlap == true ? "overlap" : "apart");
    else
      table.absent().absent(false);
  }
  return table.size() == 0 ? "<p>No case has both an error and a run time.</p>\n" : table.html();
}

namespace {

double seconds_at(const WorkPoint& p) {
  return p.seconds;
}
double steps_at(const WorkPoint& p) {
  return p.steps;
}

/// What a scene's points say of each of its cases.
struct SceneFronts {
  std::vector<WorkPoint> points;
  std::vector<size_t> of_time, of_steps;
  bool on(const std::vector<size_t>& front, const CaseRecord& record) const {
    return std::any_of(front.begin(), front.end(), [&](size_t k) { return points[k].record == &record; });
  }
};

}  // namespace

Table work_points(const Choices& choices) {
  Table out{"work_points",
            "One row per case and error: a point of work against precision.",
            {{"case", "", "Identity of the case: its row in cases.csv."},
             {"error", "", "Name of the error."},
             {"value", error_unit(choices.results()), "The error; nothing where the case has none."},
             {"floor", error_unit(choices.results()),
              "Errors below it are not told apart: what the reference itself is uncertain by."},
             {"seconds", "s", "Processor time of marching, the median over the repeats."},
             {"low", "s", "The fastest repeat."},
             {"high", "s", "The slowest repeat."},
             {"steps", "1", "Time steps marched."},
             {"microseconds", "µs", "Processor time per step."},
             {"on_front", "", "Whether no case of the scene is both faster and more precise."},
             {"near_front", "", "Whether its spread reaches the front."},
             {"on_front_of_steps", "", "Whether no case of the scene has fewer steps and a smaller error."},
             {"none", "", "Why there is no point."}},
            {}};
  const WorkPrecision work(choices);
  if (work.empty()) return out;
  const auto scenes = choices.group(all_cases(choices.results()), scene_columns(choices));
  for (const std::string& error : work.errors())
    for (const CaseGroup& scene : scenes) {
      SceneFronts fronts;
      fronts.points = work.points(scene.cases, error);
      fronts.of_time = pareto_front(fronts.points, seconds_at);
      fronts.of_steps = pareto_front(fronts.points, steps_at);
      for (const CaseRecord* record : scene.cases) {
        const auto p = work.point(*record, error);
        if (!p) {
          const Cell none;
          const std::string why = record->status == Status::done ? work.why_none(*record, error) : word(record->status);
          out.rows.push_back({record->id, error, none, none, none, none, none, none, none, false, false, false, why});
          continue;
        }
        const double each = p->steps > 0 ? 1e6 * p->seconds / p->steps : 0;
        out.rows.push_back({record->id, error, p->error, p->floor, p->seconds, p->low, p->high, p->steps, each,
                            fronts.on(fronts.of_time, *record), !told_from_front(*p, fronts.points),
                            fronts.on(fronts.of_steps, *record), ""});
      }
    }
  return out;
}

}  // namespace ricochet::report
