#include "runners/kinds/work-precision/page/work_precision.hpp"

#include <algorithm>
#include <iterator>
#include <numeric>

#include "runners/kinds/comparison/precision_targets.hpp"

namespace ricochet::report {

WorkPrecision::WorkPrecision(const CaseView& view)
    : rows_(view.results(), "work_precision", {"error"}), errors_(view.results(), "errors", {"error"}) {}

std::vector<std::string> scene_columns(const CaseView& view) {
  std::vector<std::string> scene;
  std::copy_if(view.varying().begin(), view.varying().end(), std::back_inserter(scene), is_scene);
  return scene;
}

std::optional<WorkPoint> WorkPrecision::point(const CaseRecord& record, const std::string& error) const {
  const auto row = rows_.find(record, {error});
  if (!row || record.status != "done") return std::nullopt;
  const auto value = rows_.number(*row, "value"), seconds = rows_.number(*row, "run_seconds");
  if (!value || !seconds || !(*value > 0) || !(*seconds > 0)) return std::nullopt;
  WorkPoint out{&record, *value, *seconds, *seconds, *seconds, 0, 0};
  out.low = rows_.number(*row, "low").value_or(out.low);
  out.high = rows_.number(*row, "high").value_or(out.high);
  out.steps = rows_.number(*row, "steps").value_or(0);
  if (const auto known = errors_.find(record, {error})) out.floor = errors_.number(*known, "floor").value_or(0);
  return out;
}

std::string WorkPrecision::why_none(const CaseRecord& record, const std::string& error) const {
  const auto row = rows_.find(record, {error});
  const auto value = row ? rows_.number(*row, "value") : std::nullopt;
  const auto seconds = row ? rows_.number(*row, "run_seconds") : std::nullopt;
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

}  // namespace ricochet::report
