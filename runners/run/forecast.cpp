#include "runners/run/forecast.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <set>

#include "runners/kinds/kind.hpp"
#include "runners/march/prepare_case.hpp"
#include "runners/march/seconds.hpp"
#include "runners/run/alike_cases.hpp"
#include "runners/store/fingerprint.hpp"

namespace ricochet {
namespace {

constexpr double enough_measuring = 1.5;  // s for all parts together
constexpr int most_measured = 64;
// A case is marched for so long at least; a costly one for its share of what all parts together may take.
constexpr double least_part = 0.01, shared_measuring = 1;  // s
constexpr double preparations = 2;                         // that measuring a case takes
// Processor time of a run that is no case's: the program and its plugins opened, the report written; and of each case:
// its fingerprint, its row in the store, its curve, its share of tables and page.
constexpr double each_run = 0.15, each_case = 1.6e-3;

std::string group_of(const StudyCase& one) {
  return fmt::format("{}/{}/{}/{}", content_of(one.contact).dump(), content_of(one.mass).dump(),
                     content_of(one.time).dump(), one.elements);
}

/// Groups that differ in parameters of mass and time.
std::string family_of(const StudyCase& one) {
  return fmt::format("{}/{}/{}/{}", content_of(one.contact).dump(), one.mass.name, one.time.name, one.elements);
}

/// Seconds of a step by the model, of which the measured ones are a multiple.
double modelled_step(const CasePlan& plan) {
  return plan.steps > 0 ? plan.predicted_seconds / static_cast<double>(plan.steps) : 0;
}

/// How many times what the model says a case costs, measured; 0 where it cannot be told.
double measured_ratio(const PlannedCase& one, double seconds, const Kind& kind, const CasePlanner& planner,
                      const Registry& registry) {
  const StudyCase& study_case = *one.study_case;
  const std::string text = planner.ask(study_case, [&]() -> std::string {
    return fmt::format("{}", kind.rehearse ? kind.rehearse(study_case, registry)
                                           : march_pace(study_case, registry, kind.watch, seconds).value_or(0) /
                                                 modelled_step(one.plan));
  });
  return text.empty() ? 0 : std::strtod(text.c_str(), nullptr);
}

/// Those whose cost the model knows, one of the costliest of each group first, then the next of each. Of cases that
/// cost about the same those come first that lie furthest apart in the study: neighbours differ in one value.
std::vector<const PlannedCase*> by_group(const std::vector<PlannedCase>& cases) {
  constexpr double golden = 0.6180339887498949;
  std::vector<std::pair<std::pair<int, double>, const PlannedCase*>> places;
  for (std::size_t i = 0; i < cases.size(); ++i)
    if (modelled_step(cases[i].plan) > 0)
      places.push_back(
          {{-std::ilogb(cases[i].plan.predicted_seconds), std::fmod(golden * static_cast<double>(i), 1)}, &cases[i]});
  std::sort(places.begin(), places.end());
  std::vector<const PlannedCase*> costliest;
  for (const auto& [place, one] : places) costliest.push_back(one);
  std::map<std::string, int> met;
  std::vector<std::pair<int, const PlannedCase*>> ranked;
  for (const PlannedCase* one : costliest) ranked.emplace_back(met[group_of(*one->study_case)]++, one);
  std::stable_sort(ranked.begin(), ranked.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<const PlannedCase*> ordered;
  for (const auto& [rank, one] : ranked) ordered.push_back(one);
  return ordered;
}

/// How many times what the model says cases cost: of one that was measured its own, of others that of all measured ones
/// of their group together, so that the few costly ones count for what they cost.
class Ratios {
 public:
  void add(const PlannedCase& one, double ratio) {
    own_[one.study_case] = ratio;
    groups_[group_of(*one.study_case)].add(one, ratio);
    families_[family_of(*one.study_case)].add(one, ratio);
    all_.add(one, ratio);
  }
  double of(const StudyCase& one) const {
    if (const auto own = own_.find(&one); own != own_.end()) return own->second;
    if (const auto group = groups_.find(group_of(one)); group != groups_.end()) return group->second.ratio();
    if (const auto family = families_.find(family_of(one)); family != families_.end()) return family->second.ratio();
    return all_.modelled > 0 ? all_.ratio() : 1;
  }

 private:
  struct Sum {
    double measured = 0, modelled = 0;
    void add(const PlannedCase& one, double ratio) {
      measured += ratio * one.plan.predicted_seconds;
      modelled += one.plan.predicted_seconds;
    }
    double ratio() const { return measured / modelled; }
  };
  std::map<const StudyCase*, double> own_;
  std::map<std::string, Sum> groups_, families_;
  Sum all_;
};

}  // namespace

Forecast forecast(const Study& study, std::vector<PlannedCase>& cases, const CasePlanner& planner,
                  const Registry& registry) {
  const Kind& kind = *find_kind(study.kind);
  Forecast found;
  Ratios ratios;
  if (kind.watch || kind.rehearse) {
    double modelled = 0;
    for (const PlannedCase& one : cases) modelled += one.plan.predicted_seconds;
    const double begin = thread_seconds();
    for (const PlannedCase* one : by_group(cases)) {
      const double left = enough_measuring - (thread_seconds() - begin);
      if (found.measured == most_measured || left < 0) break;
      // Setting up again what took that long to plan leaves no time for others: the model is believed.
      if (preparations * one->plan_seconds > left) continue;
      const double part = std::max(least_part, shared_measuring * one->plan.predicted_seconds / modelled);
      const double ratio = measured_ratio(*one, part, kind, planner, registry);
      if (ratio <= 0) continue;
      ++found.measured;
      ratios.add(*one, ratio);
    }
  }
  std::map<const StudyCase*, double> steps;
  std::set<std::string> alike;
  for (PlannedCase& one : cases) {
    const double ratio = ratios.of(*one.study_case);
    steps[one.study_case] = ratio * modelled_step(one.plan);
    // Prepared by the run, which plans one of cases that are alike once more.
    const double set_up = (alike.insert(cost_key(*one.study_case)).second ? 2 : 1) * one.plan_seconds;
    const double chain = one.plan.chain_seconds > 0 ? one.plan.chain_seconds : one.plan.predicted_seconds;
    found.chain = std::max(found.chain, ratio * chain + set_up);
    found.bytes += one.plan.bytes;
    one.plan.predicted_seconds = ratio * one.plan.predicted_seconds + set_up;
    found.seconds += one.plan.predicted_seconds;
  }
  if (kind.beside) {
    ForecastContext context{study, registry, {}, [&](const StudyCase& one) {
                              const auto step = steps.find(&one);
                              return step == steps.end() ? 0 : step->second;
                            }};
    for (const PlannedCase& one : cases) context.cases.push_back(one.study_case);
    found.beside = kind.beside(context);
    found.seconds += found.beside;
  }
  found.seconds += each_run + each_case * static_cast<double>(cases.size());
  return found;
}

}  // namespace ricochet
