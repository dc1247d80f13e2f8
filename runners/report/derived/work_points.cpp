#include <algorithm>

#include "runners/report/derived/shown_tables.hpp"
#include "runners/report/work_precision.hpp"

namespace ricochet::report {
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

Table work_points(const CaseView& view) {
  Table out{"work_points",
            "",
            named_columns({"case", "error", "value", "floor", "seconds", "low", "high", "steps", "microseconds",
                           "on_front", "near_front", "on_front_of_steps", "none"}),
            {}};
  const WorkPrecision work(view);
  if (work.empty()) return out;
  for (const std::string& error : work.errors())
    for (const CaseGroup& scene : view.group(view.all(), work.scene_columns())) {
      SceneFronts fronts;
      fronts.points = work.points(scene.cases, error);
      fronts.of_time = pareto_front(fronts.points, seconds_at);
      fronts.of_steps = pareto_front(fronts.points, steps_at);
      for (const CaseRecord* record : scene.cases) {
        const auto p = work.point(*record, error);
        if (!p) {
          const Cell none;
          const std::string why = record->status == "done" ? work.why_none(*record, error) : record->status;
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
