#include "runners/kinds/comparison/comparison_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <ricochet/measure/motion/orders.hpp>
#include <set>

#include "runners/store/record_values.hpp"

namespace ricochet {
namespace {

using Json = nlohmann::ordered_json;
using Row = std::vector<Json>;

std::vector<std::string> without(std::vector<std::string> columns, const std::string& one) {
  std::erase(columns, one);
  return columns;
}

std::vector<std::string> errors_of(const StudyResults& results) {
  const Json& errors = results.study.value("errors", Json::array());
  return errors.get<std::vector<std::string>>();
}

// The cases that differ in `refined` alone, in the study's order.
std::vector<std::vector<const CaseRecord*>> refinements(const StudyResults& results, const std::string& refined) {
  const std::vector<std::string> columns = without(results.columns, refined);
  std::map<std::string, std::size_t> known;
  std::vector<std::vector<const CaseRecord*>> groups;
  for (const CaseRecord& record : results.cases) {
    const auto [found, fresh] = known.emplace(Json(axes_of(record, columns)).dump(), groups.size());
    if (fresh) groups.emplace_back();
    groups[found->second].push_back(&record);
  }
  return groups;
}

double size_of(const CaseRecord& record, const std::string& refined) {
  const double value = axis(record, refined).get<double>();
  return refined == "step" ? value : 1 / value;
}

// By how much the error of the finest case would still move if the other quantity were refined: the change that its
// last refinement made.
double other_error(const StudyResults& results, const CaseRecord& finest, const std::string& other,
                   const std::string& error) {
  const std::vector<std::string> columns = without(results.columns, other);
  const Row place = axes_of(finest, columns);
  std::vector<std::pair<double, double>> along;  // size, error
  for (const CaseRecord& record : results.cases) {
    const auto value = measure(record, error);
    if (value && axes_of(record, columns) == place) along.emplace_back(size_of(record, other), *value);
  }
  std::sort(along.begin(), along.end());
  const double here = size_of(finest, other);
  if (along.size() < 2 || along.front().first != here) return 0;
  // The remaining error is about the last change when it halves at each refinement, less when it falls faster.
  return std::abs(along[1].second - along[0].second) / std::max(1.0, along[1].first / along[0].first);
}

bool single_valued(const StudyResults& results, const std::string& column) {
  std::set<std::string> values;
  for (const CaseRecord& record : results.cases) values.insert(axis(record, column).dump());
  return values.size() < 2;
}

// An oscillator has no mesh whose error could be in the way.
bool meshed(const StudyResults& results) {
  return results.study.at("scene").at("structure").at("type") != "oscillator";
}

}  // namespace

DerivedTable errors_table(const StudyResults& results) {
  DerivedTable table{"errors", results.columns, {}};
  table.columns.insert(table.columns.end(), {"error", "value", "floor"});
  for (const CaseRecord& record : results.cases)
    for (const std::string& name : errors_of(results)) {
      const auto value = measure(record, "error." + name);
      if (!value) continue;
      Row row = axes_of(record, results.columns);
      row.insert(row.end(), {name, *value, number(measure(record, "floor." + name))});
      table.rows.push_back(std::move(row));
    }
  return table;
}

DerivedTable orders_table(const StudyResults& results) {
  DerivedTable table{"orders", without(results.columns, "step"), {}};
  table.columns.insert(table.columns.end(),
                       {"refined", "error", "order", "low", "high", "declared", "verdict", "reason"});
  for (const std::string refined : {"step", "elements"}) {
    const std::string other = refined == "step" ? "elements" : "step";
    std::set<double> sizes;
    for (const CaseRecord& record : results.cases) sizes.insert(size_of(record, refined));
    if (sizes.size() < 2) continue;
    // One order per method: steps on the finest mesh, meshes at the smallest step.
    std::map<std::string, double> finest_other;
    const std::vector<std::string> methods = without(without(results.columns, "step"), "elements");
    for (const CaseRecord& record : results.cases) {
      const double size = size_of(record, other);
      const auto [found, fresh] = finest_other.emplace(Json(axes_of(record, methods)).dump(), size);
      if (!fresh) found->second = std::min(found->second, size);
    }
    for (const auto& group : refinements(results, refined)) {
      const CaseRecord& first = *group.front();
      const bool fine = size_of(first, other) == finest_other.at(Json(axes_of(first, methods)).dump());
      if (refined == "elements" && !fine) continue;
      for (const std::string& name : errors_of(results)) {
        std::vector<OrderPoint> points;
        const CaseRecord* finest = nullptr;
        for (const CaseRecord* record : group)
          if (const auto value = measure(*record, "error." + name)) {
            points.push_back({size_of(*record, refined), *value, measure(*record, "floor." + name).value_or(0)});
            if (!finest || size_of(*record, refined) < size_of(*finest, refined)) finest = record;
          }
        if (!finest) continue;
        OrderQuestion question;
        // A declared order is one in h; the two ends of an interval of time are no norm of the motion.
        if (refined == "step") question.declared = measure(*finest, "declared_order");
        question.refined = refined == "step" ? "step" : "element length";
        question.other_error = other_error(results, *finest, other, "error." + name);
        question.other = refined == "step" ? "the mesh" : "the step";
        // One mesh against a motion without a mesh (or one step): nothing tells how large its error is.
        question.other_unknown = single_valued(results, other) && meshed(results) &&
                                 (refined == "elements" || measure(*finest, "reference_of_mesh") != 1.0);
        const OrderFit fit = fit_order(points, question);
        Row row = axes_of(first, without(results.columns, "step"));
        if (refined == "elements")
          for (std::size_t c = 0; c + 8 < table.columns.size(); ++c)
            if (table.columns[c] == "elements") row[c] = nullptr;
        const std::string gci =
            fit.gci ? fmt::format("; grid convergence index of the finest point used: {:.2g}", *fit.gci) : "";
        row.insert(row.end(), {refined, name, number(fit.order), number(fit.low), number(fit.high),
                               number(question.declared), verdict_word(fit.verdict), fit.reason + gci});
        table.rows.push_back(std::move(row));
      }
    }
  }
  return table;
}

DerivedTable work_precision_table(const StudyResults& results) {
  const std::vector<std::string> methods = without(results.columns, "step");
  DerivedTable table{"work_precision", methods, {}};
  table.columns.insert(table.columns.end(),
                       {"step", "error", "value", "run_seconds", "low", "high", "steps", "status"});
  for (const CaseRecord& record : results.cases)
    for (const std::string& name : errors_of(results)) {
      Row row = axes_of(record, methods);
      row.insert(row.end(), {axis(record, "step"), name, number(measure(record, "error." + name)),
                             number(measure(record, "timed_seconds")), number(measure(record, "timed_low")),
                             number(measure(record, "timed_high")), record.steps, record.status});
      table.rows.push_back(std::move(row));
    }
  return table;
}

}  // namespace ricochet
