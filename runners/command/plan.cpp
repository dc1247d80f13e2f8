#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <ostream>
#include <set>

#include "runners/asks/ask.hpp"
#include "runners/command/command.hpp"
#include "runners/command/subcommand.hpp"
#include "runners/run/plan_cases.hpp"
#include "runners/run/study_cases.hpp"
#include "runners/run/waiting_line.hpp"
#include "runners/store/record_values.hpp"
#include "runners/table/text.hpp"
#include "runners/workers/allowed_processors.hpp"

namespace ricochet {
namespace {

using Grouped = std::map<std::string, int>;  // sentence → number of cases

constexpr const char* fails = "fails: ";

// As tables of results write it; null (an absent stop) is none.
std::string shown(const Json& value) {
  return value.is_null() ? "none" : cell_of(value).text();
}

std::string shown(const StudyCase& study_case, const std::string& axis) {
  for (const auto& [name, value] : study_case.axes)
    if (name == axis) return shown(value);
  return "";
}

bool has_axis(const StudyCase& study_case, const std::string& axis) {
  return std::any_of(study_case.axes.begin(), study_case.axes.end(),
                     [&](const auto& item) { return item.first == axis; });
}

/// An axis of the study and the values that its cases have on it.
struct AxisValues {
  std::string name;
  std::vector<std::string> values;
  bool everywhere = true;
};

std::vector<AxisValues> axis_values(const Study& study) {
  std::vector<AxisValues> all;
  for (const std::string& name : study.columns) {
    AxisValues axis{name, {}};
    std::set<std::string> seen;
    for (const StudyCase& study_case : study.cases) {
      if (!has_axis(study_case, name)) {
        axis.everywhere = false;
        continue;
      }
      const std::string value = shown(study_case, name);
      if (seen.insert(value).second) axis.values.push_back(value);
    }
    all.push_back(std::move(axis));
  }
  return all;
}

void print_axes(const std::vector<AxisValues>& axes, std::ostream& out) {
  constexpr std::size_t most = 12;
  std::string same;
  for (const AxisValues& axis : axes) {
    const std::string where = axis.everywhere ? "" : " (where it applies)";
    if (axis.values.size() == 1) {
      same += (same.empty() ? "" : ", ") + axis.name + " " + axis.values.front() + where;
      continue;
    }
    const std::vector<std::string> first(
        axis.values.begin(), axis.values.begin() + static_cast<std::ptrdiff_t>(std::min(most, axis.values.size())));
    out << fmt::format("  {}{}: {}{}\n", axis.name, where, fmt::join(first, ", "),
                       axis.values.size() > most ? fmt::format(" and {} more", axis.values.size() - most) : "");
  }
  if (!same.empty()) out << "the same throughout: " << same << "\n";
}

/// What keeps cases from running, each reason with its number of cases, the most frequent first. What fails is told in
/// full, of other reasons the first ones.
void print_reasons(const Grouped& reasons, std::ostream& out) {
  if (reasons.empty()) return;
  constexpr std::size_t most = 10;
  std::vector<std::pair<int, std::string>> sorted;
  for (const auto& [reason, count] : reasons) sorted.emplace_back(-count, reason);
  std::sort(sorted.begin(), sorted.end());
  out << "\nnot run:\n";
  std::size_t told = 0, untold = 0;
  for (const auto& [count, reason] : sorted) {
    if (!reason.starts_with(fails) && told++ >= most)
      ++untold;
    else
      out << fmt::format("  {} case{}, {}\n", -count, count == -1 ? "" : "s", reason);
  }
  if (untold > 0)
    out << fmt::format("  and {} more reason{}: --cases shows that of every case\n", untold, untold == 1 ? "" : "s");
}

void print_grouped(const char* title, const Grouped& grouped, std::size_t all, std::ostream& out) {
  if (grouped.empty()) return;
  out << "\n" << title << "\n";
  for (const auto& [sentence, count] : grouped) {
    const bool everywhere = static_cast<std::size_t>(count) == all;
    out << "  " << sentence << (everywhere ? " (all cases)" : fmt::format(" ({} of {} cases)", count, all)) << "\n";
  }
}

struct Costs {
  int runnable = 0, refused = 0, excluded = 0, failed = 0;
};

void print_costs(const Costs& costs, const Forecast& forecast, const AllowedProcessors& cores, std::ostream& out) {
  out << fmt::format("\n{} to run, {} refused, {} excluded", costs.runnable, costs.refused, costs.excluded)
      << (costs.failed > 0 ? fmt::format(", {} failed", costs.failed) : "") << "\n";
  if (costs.runnable == 0) return;
  out << "predicted: about " << duration_text(forecast.seconds) << " on 1 core";
  if (cores.count > 1)
    out << ", " << duration_text(forecast.on(cores.count)) << (cores.limit.empty() ? " on all " : " on ")
        << cores.count;
  out << "\n";
  if (!cores.limit.empty()) out << "cores that this process may use: " << cores.text() << "\n";
}

/// What worker processes would take, on one machine or many; only what is known of a kind's cases is said.
void print_workers(int workers, const Costs& costs, const Forecast& forecast, std::ostream& out) {
  if (costs.runnable == 0) return;
  // Measured: a coordinator or a case that waits for its blocks, and a worker; rows on their way to the store.
  constexpr double memory_of_worker = 30e6, memory_of_coordinator = 100e6, copies = 3;
  const double work = forecast.work(), wall = forecast.on(workers);
  out << fmt::format("with {} worker{}: about {}", workers, workers == 1 ? "" : "s", duration_text(wall));
  if (forecast.chain > work / workers)
    out << fmt::format("; the longest chain alone takes {}: more than {} worker{} shorten nothing",
                       duration_text(forecast.chain), static_cast<long long>(std::ceil(work / forecast.chain)),
                       std::ceil(work / forecast.chain) == 1 ? "" : "s");
  else
    out << fmt::format("; the longest chain takes {}, which up to {} workers shorten", duration_text(forecast.chain),
                       static_cast<long long>(std::ceil(work / std::max(forecast.chain, 1e-9))));
  out << "\n";
  if (forecast.beside > 0.05 * wall)
    out << fmt::format("  of these, {} are references and repeats, which few or one of them can do\n",
                       duration_text(forecast.beside));
  out << fmt::format("  memory: about {} for each worker, {} where the run was started", size_text(memory_of_worker),
                     size_text(memory_of_coordinator + copies * forecast.bytes));
  if (forecast.bytes > 0)
    out << fmt::format("; store: about {}, {} a second", size_text(forecast.bytes),
                       size_text(forecast.bytes / std::max(wall, 1e-3)));
  out << "\n";
  // Measured: 84 MB a second on a disk of its own; a file system that others use is slower.
  constexpr double store_rate = 8e7;
  if (forecast.bytes > store_rate * wall)
    out << "  the store takes some 80 MB a second at most: fewer samples or points help more than workers\n";
}

void print_warnings(const std::vector<std::string>& warnings, std::ostream& out) {
  if (warnings.empty()) return;
  out << "\nplugins:\n";
  for (const std::string& warning : warnings) out << "  " << warning << "\n";
}

/// Every case of a study planned, and what is said of them together.
struct StudyPlan {
  std::vector<PlannedCase> runnable;
  Grouped reasons, left_out, notes;
  Costs costs;
  std::map<std::string, std::string> why_not;  // id → reason
};

std::vector<PlanOutcome> plan_all(const Study& study, CasePlanner& planner, int at_once, const char* what) {
  WaitingLine waiting(what);
  return planner.plan_all(study.cases, at_once, [&](std::size_t done) { waiting.done(done, study.cases.size()); });
}

StudyPlan plan_study(const Study& study, CasePlanner& planner, int at_once) {
  StudyPlan all;
  std::vector<PlanOutcome> outcomes = plan_all(study, planner, at_once, "planning cases");
  for (std::size_t i = 0; i < study.cases.size(); ++i) {
    const StudyCase& study_case = study.cases[i];
    std::string& why = all.why_not[study_case.id];
    if (study_case.excluded) {
      ++all.costs.excluded;
      why = "excluded: " + *study_case.excluded;
    } else {
      auto& [plan, failure, seconds] = outcomes[i];
      if (!failure.empty()) {
        ++all.costs.failed;
        why = fails + failure;
      } else if (!plan.refusal.empty()) {
        ++all.costs.refused;
        why = "refused: " + plan.refusal;
      } else {
        ++all.costs.runnable;
        for (const auto& [item, reason] : plan.left_out) ++all.left_out[item + ": " + reason];
        for (const std::string& note : plan.notes) ++all.notes[note];
        all.runnable.push_back({&study_case, std::move(plan), seconds});
      }
    }
    if (!why.empty()) ++all.reasons[why];
  }
  return all;
}

/// What each ask could leave open, known before anything runs.
void print_doubts(const Study& study, std::ostream& out) {
  for (const asks::Ask& ask : asks::asks_of(study.resolved)) {
    // Motions are told by their classes and periods, not by intervals.
    const bool by_values = asks::verb_of_kind(ask) == ask.verb->name;
    const std::string doubt = by_values && ask.verb->doubt ? ask.verb->doubt(ask, study) : "";
    if (doubt.empty()) continue;
    const std::string subject = ask.subject();
    out << fmt::format("ask {} ({}{}): {}\n", ask.number, ask.verb->name, subject.empty() ? "" : " " + subject, doubt);
  }
}

/// The study with the cases of one part.
Study part_of(const Study& study, const StudyPart& part, CasePlanner& planner, int at_once) {
  check_part(study, part);
  std::map<std::string, double> seconds;
  const std::vector<PlanOutcome> outcomes =
      plan_all(study, planner, at_once, "planning all cases, to deal them into parts");
  for (std::size_t i = 0; i < study.cases.size(); ++i)
    if (!study.cases[i].excluded) seconds[study.cases[i].id] = outcomes[i].plan.predicted_seconds;
  Study own = study;
  own.cases.clear();
  for (const StudyCase* one : cases_of_part(study, part, seconds)) own.cases.push_back(*one);
  return own;
}

std::string table_of_plans(const Study& study, const StudyPlan& all, const std::vector<AxisValues>& axes) {
  std::vector<std::string> header = {"id"};
  for (const AxisValues& axis : axes)
    if (axis.values.size() > 1) header.push_back(axis.name);
  header.insert(header.end(), {"steps", "operator", "predicted", "not run because"});
  std::map<std::string, const CasePlan*> plans;
  for (const PlannedCase& one : all.runnable) plans[one.study_case->id] = &one.plan;
  TextTable table(header);
  for (const StudyCase& study_case : study.cases) {
    std::vector<std::string> row = {study_case.id};
    for (const AxisValues& axis : axes)
      if (axis.values.size() > 1) row.push_back(shown(study_case, axis.name));
    if (const auto found = plans.find(study_case.id); found != plans.end())
      row.insert(row.end(), {fmt::format("{}", found->second->steps), found->second->operator_name,
                             duration_text(found->second->predicted_seconds), ""});
    else
      row.insert(row.end(), {"", "", "", all.why_not.at(study_case.id)});
    table.add(std::move(row));
  }
  return table.text();
}

}  // namespace

int command_plan(const Arguments& arguments, std::ostream& out) {
  const AllowedProcessors cores = allowed_processors();
  return with_study(arguments, [&](const OpenStudy& open) -> int {
    CasePlanner planner(open.study, open.catalogue, open.registry);
    std::optional<Study> part;
    if (!arguments.part.whole()) part = part_of(open.study, arguments.part, planner, cores.count);
    const Study& study = part ? *part : open.study;
    StudyPlan all = plan_study(study, planner, cores.count);
    const Forecast costs = forecast(study, all.runnable, open.registry);
    const std::vector<AxisValues> axes = axis_values(study);
    const auto runnable = static_cast<std::size_t>(all.costs.runnable);

    out << study.name << (study.question.empty() ? "" : ": " + study.question) << "\n"
        << fmt::format("{}kind {}, {} case{}{}\n", arguments.part.whole() ? "" : arguments.part.text() + ": ",
                       study.kind, study.cases.size(), study.cases.size() == 1 ? "" : "s",
                       study.cases.front().duration > 0 ? fmt::format(", duration {} s", study.cases.front().duration)
                                                        : std::string());
    print_axes(axes, out);
    print_doubts(study, out);
    print_costs(all.costs, costs, cores, out);
    if (arguments.workers > 0) print_workers(arguments.workers, all.costs, costs, out);
    print_reasons(all.reasons, out);
    if (const std::string physics = physics_text(all.runnable, planner, open.registry); !physics.empty())
      out << "\nphysics:\n" << physics;
    print_grouped("left out:", all.left_out, runnable, out);
    print_grouped("notes:", all.notes, runnable, out);
    print_warnings(plugin_warnings(open), out);
    if (arguments.cases) out << "\n" << table_of_plans(study, all, axes);
    if (runnable > 0) return all.costs.failed > 0 ? exit_some_failed : exit_done;
    out << "\nnothing would run: " << (all.costs.failed > 0 ? "no case can be planned" : "every case is refused")
        << "; the reasons above say what to change\n";
    return exit_some_failed;
  });
}

}  // namespace ricochet
