#include <algorithm>

#include "runners/kinds/work-precision/page/page.hpp"
#include "runners/kinds/work-precision/page/work_precision.hpp"

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
  Table out{
      "work_points",
      "One row per case and error: a point of work against precision.",
      {{"case", "", "Identity of the case: its row in cases.csv."},
       {"error", "", "Name of the error."},
       {"value", "that of the error", "The error; nothing where the case has none."},
       {"floor", "that of the error", "Errors below it are not told apart: what the reference itself is uncertain by."},
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
  const WorkPrecision work(view);
  if (work.empty()) return out;
  const auto scenes = view.group(view.all(), scene_columns(view));
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
