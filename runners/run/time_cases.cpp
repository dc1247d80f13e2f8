#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <ricochet/measure/statistics/quantiles.hpp>

#include "runners/march/case_plan.hpp"
#include "runners/march/seconds.hpp"
#include "runners/run/say.hpp"
#include "runners/run/study_runner.hpp"

namespace ricochet {
namespace {

bool timed(const CaseRecord& record) {
  return std::any_of(record.measures.begin(), record.measures.end(),
                     [](const auto& measure) { return measure.first == "timed_seconds"; });
}

}  // namespace

std::vector<CaseRecord> time_cases(const StudyRunner& runner, const Study& study, const StudyResults& results,
                                   int repeats, const std::atomic<bool>& stop) {
  std::map<std::string, const StudyCase*> cases;
  for (const StudyCase& one : study.cases) cases[one.id] = &one;
  std::vector<CaseRecord> records;
  for (const CaseRecord& record : results.cases)
    if (record.status == "done" && !timed(record) && cases.count(record.id)) records.push_back(record);
  if (records.empty()) return {};
  double expected = 0;
  for (const CaseRecord& record : records) expected += record.run_seconds;
  say(runner.messages, fmt::format("timing {} cases {} times, one at a time: about {:.0f} s\n", records.size(), repeats,
                                   expected * repeats));

  std::vector<std::vector<double>> seconds(records.size());
  double busy = 0;
  const auto wall = std::chrono::steady_clock::now();
  for (int round = 0; round < repeats; ++round)
    for (std::size_t i = 0; i < records.size(); ++i) {
      if (stop) return {};
      const StudyCase& one = *cases.at(records[i].id);
      try {
        if (const auto time = runner.cases.time(one, stop)) {
          seconds[i].push_back(time->marching);
          busy += time->processor;
        }
      } catch (const Interrupted&) {
        return {};
      } catch (...) {
        // It ran before: what fails now is its time alone.
      }
    }
  // One of ours is busy at a time: the rest of the wall time went to others.
  const double passed = seconds_since(wall);
  const double share = passed > 0 ? 1 - busy / passed : 0;
  constexpr double loaded = 0.1;
  for (std::size_t i = 0; i < records.size(); ++i) {
    if (seconds[i].empty()) continue;
    const auto [low, high] = std::minmax_element(seconds[i].begin(), seconds[i].end());
    records[i].measures.emplace_back("timed_seconds", median(seconds[i]));
    records[i].measures.emplace_back("timed_low", *low);
    records[i].measures.emplace_back("timed_high", *high);
    if (share > loaded)
      records[i].notes.push_back(fmt::format(
          "the machine was loaded while cases were timed: {:.0f} % of the time went to other programs", 100 * share));
  }
  return records;
}

}  // namespace ricochet
