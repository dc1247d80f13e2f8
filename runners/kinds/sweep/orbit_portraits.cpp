#include "runners/kinds/sweep/orbit_portraits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "runners/kinds/sweep/sweep_tables.hpp"
#include "runners/kinds/sweep/tip_march.hpp"

namespace ricochet {
namespace {

constexpr std::size_t most_portraits = 400;  // per case
constexpr int samples_per_period = 100, longest = 4, portrait_width = 8;

struct TipSample {
  double time, displacement, velocity;
};

}  // namespace

void add_portraits(CaseRecord& record, const ForcedScenes& scenes, const std::vector<OrbitView>& views,
                   const SectionPlan& plan) {
  std::vector<const OrbitView*> complete;
  for (const OrbitView& view : views)
    if (view.complete()) complete.push_back(&view);
  if (complete.empty()) return;
  if (complete.size() > most_portraits) {
    record.notes.push_back(
        fmt::format("phase portraits are stored for up to {} orbits per case; this one has {}: "
                    "\"ricochet point\" marches any of them again",
                    most_portraits, complete.size()));
    return;
  }
  NumberTable table = portraits_head();
  if (const NumberTable* points = find_table(record.numbers, "points")) table.words = {points->words.front()};
  const int stride = std::max(2, plan.steps_per_period / samples_per_period);
  std::map<std::pair<int, int>, std::vector<const OrbitView*>> batches;  // by group and periods
  for (const OrbitView* view : complete) {
    const int period = view->judged.verdict.period > 0 ? std::min(view->judged.verdict.period, longest) : longest;
    batches[{view->group, period}].push_back(view);
  }
  for (const auto& [key, members] : batches)
    for (std::size_t first = 0; first < members.size(); first += portrait_width) {
      std::vector<const Orbit*> orbits;
      std::vector<LaneSpec> lanes;
      const std::size_t last = std::min(first + portrait_width, members.size());
      for (std::size_t i = first; i < last; ++i) {
        orbits.push_back(members[i]->orbit);
        lanes.push_back(members[i]->orbit->lane);
      }
      TipMarch tips(scenes.program(key.first, lanes), orbits, plan);
      std::vector<std::vector<TipSample>> portraits(orbits.size());
      tips.march(static_cast<long long>(key.second) * plan.steps_per_period - 1,
                 [&](std::size_t lane, long long step, double displacement, double velocity) {
                   if (step % stride == 0)
                     portraits[lane].push_back({static_cast<double>(step) * tips.h(), displacement, velocity});
                 });
      for (std::size_t i = first; i < last; ++i)
        for (const auto& [time, displacement, velocity] : portraits[i - first])
          table.add({members[i]->value, static_cast<double>(members[i]->start), time, displacement, velocity});
    }
  record.numbers.push_back(std::move(table));
}

}  // namespace ricochet
