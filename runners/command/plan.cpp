#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <ostream>
#include <set>
#include <thread>

#include "runners/command/command.hpp"
#include "runners/command/plain.hpp"
#include "runners/command/study_file.hpp"
#include "runners/run/plan_cases.hpp"
#include "runners/table/plain_text.hpp"

namespace ricochet {
namespace {

using Grouped = std::map<std::string, int>;  // sentence → number of cases

Json axis_value(const StudyCase& study_case, const std::string& axis) {
  for (const auto& [name, value] : study_case.axes)
    if (name == axis) return value;
  return {};
}

bool has_axis(const StudyCase& study_case, const std::string& axis) {
  return std::any_of(study_case.axes.begin(), study_case.axes.end(),
                     [&](const auto& item) { return item.first == axis; });
}

// Axes with more than one value become columns; the others are said once.
void split_axes(const Study& study, std::vector<std::string>& varying, std::string& same) {
  for (const std::string& axis : study.columns) {
    std::set<std::string> values;
    bool everywhere = true;
    Json value;
    for (const StudyCase& study_case : study.cases) {
      if (!has_axis(study_case, axis)) {
        everywhere = false;
        continue;
      }
      value = axis_value(study_case, axis);
      values.insert(value.dump());
    }
    if (values.size() > 1)
      varying.push_back(axis);
    else
      same += (same.empty() ? "" : ", ") + axis + " " + plain(value) + (everywhere ? "" : " (where it applies)");
  }
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
  double total = 0, longest = 0;
  int runnable = 0, refused = 0, excluded = 0, failed = 0;
};

void print_costs(const Costs& costs, std::ostream& out) {
  out << "\n"
      << fmt::format("{} to run, {} refused, {} excluded", costs.runnable, costs.refused, costs.excluded)
      << (costs.failed > 0 ? fmt::format(", {} failed", costs.failed) : "") << "\n";
  if (costs.runnable == 0) return;
  const unsigned cores = std::max(1U, std::thread::hardware_concurrency());
  out << "predicted: " << duration_text(costs.total) << " on 1 core";
  // A case runs on one core: the longest bounds the whole.
  if (cores > 1) out << ", " << duration_text(std::max(costs.total / cores, costs.longest)) << " on all " << cores;
  out << "\n";
}

void print_unopened(const Catalogue& catalogue, std::ostream& out) {
  std::set<std::string> files;
  for (const Provided& method : catalogue.provided())
    if (std::find(catalogue.opened().begin(), catalogue.opened().end(), method.file) == catalogue.opened().end())
      files.insert(method.file.filename().string());
  if (files.empty()) return;
  out << "\nplugin libraries found and not opened, as the study does not name them:\n ";
  for (const std::string& file : files) out << " " << file;
  out << "\n";
}

void print_warnings(const std::vector<std::string>& warnings, std::ostream& out) {
  if (warnings.empty()) return;
  out << "\nplugins:\n";
  for (const std::string& warning : warnings) out << "  " << warning << "\n";
}

}  // namespace

int command_plan(const Arguments& arguments, std::ostream& out) {
  return with_study(arguments, [&](const OpenStudy& open) -> int {
    const Study& study = open.study;
    std::vector<std::string> varying;
    std::string same;
    split_axes(study, varying, same);
    std::vector<std::string> header = {"id"};
    header.insert(header.end(), varying.begin(), varying.end());
    header.insert(header.end(), {"steps", "operator", "time", "not run because"});

    TextTable table(header);
    Grouped left_out, notes;
    Costs costs;
    CasePlanner planner(study, open.catalogue, open.registry);
    for (const StudyCase& study_case : study.cases) {
      std::vector<std::string> row = {study_case.id};
      for (const std::string& axis : varying)
        row.push_back(has_axis(study_case, axis) ? plain(axis_value(study_case, axis)) : "");
      if (study_case.excluded) {
        ++costs.excluded;
        row.insert(row.end(), {"", "", "", "excluded: " + *study_case.excluded});
        table.add(std::move(row));
        continue;
      }
      const auto [plan, failure] = planner.plan(study_case);
      if (!failure.empty()) {
        ++costs.failed;
        row.insert(row.end(), {"", "", "", "fails: " + failure});
      } else if (!plan.refusal.empty()) {
        ++costs.refused;
        row.insert(row.end(), {"", "", "", "refused: " + plan.refusal});
      } else {
        ++costs.runnable;
        costs.total += plan.predicted_seconds;
        costs.longest = std::max(costs.longest, plan.predicted_seconds);
        row.insert(row.end(),
                   {fmt::format("{}", plan.steps), plan.operator_name, duration_text(plan.predicted_seconds), ""});
        for (const auto& [item, reason] : plan.left_out) ++left_out[item + ": " + reason];
        for (const std::string& note : plan.notes) ++notes[note];
      }
      table.add(std::move(row));
    }

    out << study.name << (study.question.empty() ? "" : ": " + study.question) << "\n"
        << fmt::format("kind {}, {} case{}{}\n", study.kind, study.cases.size(), study.cases.size() == 1 ? "" : "s",
                       study.cases.front().duration > 0 ? fmt::format(", duration {} s", study.cases.front().duration)
                                                        : std::string());
    if (!same.empty()) out << "the same throughout: " << same << "\n";
    out << "\n" << table.text();
    print_grouped("left out:", left_out, static_cast<std::size_t>(costs.runnable), out);
    print_grouped("notes:", notes, static_cast<std::size_t>(costs.runnable), out);
    print_costs(costs, out);
    print_unopened(open.catalogue, out);
    print_warnings(plugin_warnings(open), out);
    return costs.failed > 0 ? exit_some_failed : exit_done;
  });
}

}  // namespace ricochet
