#include "runners/kinds/sweep/orbit_portraits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "runners/kinds/sweep/sweep_tables.hpp"

namespace ricochet {
namespace {

constexpr std::size_t most_portraits = 400;  // per case
constexpr int samples_per_period = 100, longest = 4, portrait_width = 8;

}  // namespace

std::vector<Portrait> march_portraits(Program program, const std::vector<const Orbit*>& orbits, const SectionPlan& plan,
                                      int periods, int samples) {
  Marcher marcher(std::move(program));
  const double h = marcher.program().h;
  std::vector<Portrait> portraits(orbits.size());
  marcher.set_clock(plan.strobe + 1);
  for (std::size_t lane = 0; lane < orbits.size(); ++lane)
    marcher.set_lane(static_cast<int>(lane), orbits[lane]->lane, orbits[lane]->entry);
  const int stride = std::max(2, plan.steps_per_period / samples);
  std::vector<double> before(orbits.size()), at(orbits.size());
  const auto read = [&](std::vector<double>& tips) {
    for (std::size_t lane = 0; lane < orbits.size(); ++lane) tips[lane] = marcher.tip(static_cast<int>(lane));
  };
  long long made = 1;  // steps since the strobe
  const long long whole = static_cast<long long>(periods) * plan.steps_per_period;
  while (made + stride <= whole) {
    const long long ahead = std::max<long long>(0, stride - 2);
    marcher.march(ahead);
    read(before);
    marcher.march(1);
    read(at);
    marcher.march(1);
    made += ahead + 2;
    for (std::size_t lane = 0; lane < orbits.size(); ++lane) {
      portraits[lane].time.push_back(static_cast<double>(made - 1) * h);
      portraits[lane].displacement.push_back(at[lane]);
      portraits[lane].velocity.push_back((marcher.tip(static_cast<int>(lane)) - before[lane]) / (2 * h));
    }
  }
  return portraits;
}

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
      const auto portraits =
          march_portraits(scenes.program(key.first, lanes), orbits, plan, key.second, samples_per_period);
      for (std::size_t i = first; i < last; ++i) {
        const Portrait& portrait = portraits[i - first];
        for (std::size_t k = 0; k < portrait.time.size(); ++k)
          table.add({members[i]->value, static_cast<double>(members[i]->start), portrait.time[k],
                     portrait.displacement[k], portrait.velocity[k]});
      }
    }
  record.numbers.push_back(std::move(table));
}

}  // namespace ricochet
