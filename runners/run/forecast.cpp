#include "runners/run/forecast.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <ricochet/measure/statistics/quantiles.hpp>

#include "runners/kinds/kind.hpp"
#include "runners/march/prepare_case.hpp"
#include "runners/store/fingerprint.hpp"

namespace ricochet {
namespace {

constexpr double enough_measuring = 1.5;  // s for all parts together
constexpr int most_measured = 64;
constexpr double preparations = 2;  // that measuring a case takes
// Processor time of a run that is no case's: the program and its plugins opened, the report written; and of each case:
// its fingerprint, its row in the store, its curve, its share of tables and page.
constexpr double each_run = 0.1, each_case = 3e-3;

std::string group_of(const StudyCase& one) {
  return content_of(one.contact).dump() + "/" + std::to_string(one.elements) + "/" + one.mass.name;
}

/// Seconds of a step by the model, of which the measured ones are a multiple.
double modelled_step(const CasePlan& plan) {
  return plan.steps > 0 ? plan.predicted_seconds / static_cast<double>(plan.steps) : 0;
}

/// How many times what the model says a case costs, measured; 0 where it cannot be told.
double measured_ratio(const PlannedCase& one, const Kind& kind, const CasePlanner& planner, const Registry& registry) {
  const StudyCase& study_case = *one.study_case;
  const std::string text = planner.ask(study_case, [&]() -> std::string {
    return fmt::format("{}", kind.rehearse
                                 ? kind.rehearse(study_case, registry)
                                 : march_pace(study_case, registry, kind.watch).value_or(0) / modelled_step(one.plan));
  });
  return text.empty() ? 0 : std::strtod(text.c_str(), nullptr);
}

/// Those whose cost the model knows, the costliest of each group first, then the next of each.
std::vector<const PlannedCase*> by_group(const std::vector<PlannedCase>& cases) {
  std::vector<const PlannedCase*> costliest;
  for (const PlannedCase& one : cases)
    if (modelled_step(one.plan) > 0) costliest.push_back(&one);
  std::stable_sort(costliest.begin(), costliest.end(), [](const PlannedCase* a, const PlannedCase* b) {
    return a->plan.predicted_seconds > b->plan.predicted_seconds;
  });
  std::map<std::string, int> met;
  std::vector<std::pair<int, const PlannedCase*>> ranked;
  for (const PlannedCase* one : costliest) ranked.emplace_back(met[group_of(*one->study_case)]++, one);
  std::stable_sort(ranked.begin(), ranked.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<const PlannedCase*> ordered;
  for (const auto& [rank, one] : ranked) ordered.push_back(one);
  return ordered;
}

/// The ratio of measured to modelled steps, by group.
class Ratios {
 public:
  void add(const std::string& group, double ratio) {
    groups_[group].push_back(ratio);
    all_.push_back(ratio);
  }
  double of(const std::string& group) const {
    const auto found = groups_.find(group);
    if (found != groups_.end()) return median(found->second);
    return all_.empty() ? 1 : median(all_);
  }

 private:
  std::map<std::string, std::vector<double>> groups_;
  std::vector<double> all_;
};

}  // namespace

Forecast forecast(const Study& study, std::vector<PlannedCase>& cases, const CasePlanner& planner,
                  const Registry& registry) {
  const Kind& kind = *find_kind(study.kind);
  Forecast found;
  Ratios ratios;
  if (kind.watch || kind.rehearse) {
    const double begin = thread_seconds();
    for (const PlannedCase* one : by_group(cases)) {
      const double left = enough_measuring - (thread_seconds() - begin);
      if (found.measured == most_measured || left < 0) break;
      // Setting up again what took that long to plan leaves no time for others: the model is believed.
      if (preparations * one->plan_seconds > left) continue;
      const double ratio = measured_ratio(*one, kind, planner, registry);
      if (ratio <= 0) continue;
      ++found.measured;
      ratios.add(group_of(*one->study_case), ratio);
    }
  }
  std::map<const StudyCase*, double> steps;
  for (PlannedCase& one : cases) {
    const double ratio = ratios.of(group_of(*one.study_case));
    steps[one.study_case] = ratio * modelled_step(one.plan);
    // Planned once more by the run, and prepared.
    one.plan.predicted_seconds = ratio * one.plan.predicted_seconds + 2 * one.plan_seconds;
    found.seconds += one.plan.predicted_seconds;
    found.longest = std::max(found.longest, one.plan.predicted_seconds);
  }
  if (kind.beside) {
    ForecastContext context{study, registry, {}, [&](const StudyCase& one) {
                              const auto step = steps.find(&one);
                              return step == steps.end() ? 0 : step->second;
                            }};
    for (const PlannedCase& one : cases) context.cases.push_back(one.study_case);
    found.seconds += kind.beside(context);
  }
  found.seconds += each_run + each_case * static_cast<double>(cases.size());
  return found;
}

}  // namespace ricochet
