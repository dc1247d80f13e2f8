#include "runners/execution/derive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <ricochet/measure/effects.hpp>
#include <ricochet/measure/orders.hpp>
#include <set>

#include "runners/execution/derive_dynamics.hpp"
#include "runners/report/derived/shown_tables.hpp"

namespace ricochet {
namespace {

using Json = nlohmann::ordered_json;
using Row = std::vector<Json>;

std::optional<double> measure(const CaseRecord& record, const std::string& name) {
  for (const auto& [key, value] : record.measures)
    if (key == name) return value;
  return std::nullopt;
}

Json axis(const CaseRecord& record, const std::string& column) {
  for (const auto& [name, value] : record.axes)
    if (name == column) return value;
  return nullptr;
}

Json number(std::optional<double> value) {
  return value && std::isfinite(*value) ? Json(*value) : Json(nullptr);
}

Row axes_of(const CaseRecord& record, const std::vector<std::string>& columns) {
  Row row;
  for (const std::string& column : columns) row.push_back(axis(record, column));
  return row;
}

std::vector<std::string> without(std::vector<std::string> columns, const std::string& one) {
  std::erase(columns, one);
  return columns;
}

bool compares(const StudyResults& results) {
  return results.kind == "convergence" || results.kind == "work-precision";
}

std::vector<std::string> errors_of(const StudyResults& results) {
  const Json& errors = results.study.value("errors", Json::array());
  return errors.get<std::vector<std::string>>();
}

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

// The tables that cases carry, each row behind its case's axes.
void collect(StudyResults& results) {
  for (const CaseRecord& record : results.cases)
    for (const DerivedTable& own : record.tables) {
      if (has_dynamics(results) && derived_as_dynamics(own.name)) continue;
      auto found = std::find_if(results.derived.begin(), results.derived.end(),
                                [&](const DerivedTable& table) { return table.name == own.name; });
      if (found == results.derived.end()) {
        DerivedTable table{own.name, results.columns, {}};
        table.columns.insert(table.columns.end(), own.columns.begin(), own.columns.end());
        found = results.derived.insert(results.derived.end(), std::move(table));
      }
      for (const Row& row : own.rows) {
        Row whole = axes_of(record, results.columns);
        whole.insert(whole.end(), row.begin(), row.end());
        found->rows.push_back(std::move(whole));
      }
    }
}

std::string cell_text(const Json& value) {
  return value.is_null() ? "" : (value.is_string() ? value.get<std::string>() : value.dump());
}

// Measures whose spread says nothing of the motion.
bool of_the_motion(const std::string& measure) {
  static const std::set<std::string> others = {
      "microseconds_per_step", "timed_seconds", "timed_low",         "timed_high",
      "declared_order",        "horizon",       "reference_of_mesh", "exponent_seconds",
      "lane_steps_per_second", "orbits",        "contradictions"};
  return others.count(measure) == 0 && !measure.starts_with("floor.");
}

// Whether the cases of some level that were run to their end never have this measure while those of another do: then
// the method (or the step, the mesh) has none, and what is absent may neither be filled in nor taken for zero.
bool absent_by_level(const StudyResults& results, const std::vector<Factor>& factors,
                     const std::vector<std::optional<double>>& values) {
  for (const Factor& factor : factors) {
    std::vector<int> done(factor.levels.size(), 0), present(factor.levels.size(), 0);
    for (std::size_t c = 0; c < values.size(); ++c) {
      done[factor.level[c]] += results.cases[c].status == "done" ? 1 : 0;
      present[factor.level[c]] += values[c] ? 1 : 0;
    }
    for (std::size_t l = 0; l < done.size(); ++l)
      if (done[l] > 0 && present[l] == 0) return true;
  }
  return false;
}

DerivedTable effects_table(const StudyResults& results) {
  DerivedTable table{"effects", {"measure", "factor", "share", "low", "high", "log"}, {}};
  std::vector<std::vector<std::string>> cells;
  std::vector<std::string> measures;
  for (const CaseRecord& record : results.cases) {
    std::vector<std::string> row;
    for (const Json& value : axes_of(record, results.columns)) row.push_back(cell_text(value));
    cells.push_back(std::move(row));
    for (const auto& [name, value] : record.measures)
      if (of_the_motion(name) && std::find(measures.begin(), measures.end(), name) == measures.end())
        measures.push_back(name);
  }
  std::vector<Factor> factors = factors_of(results.columns, cells).factors;
  std::erase_if(factors, [](const Factor& factor) { return factor.levels.size() < 2; });
  if (factors.size() < 2) return table;
  for (const std::string& name : measures) {
    std::vector<std::optional<double>> values;
    for (const CaseRecord& record : results.cases)
      values.push_back(record.status == "done" ? measure(record, name) : std::nullopt);
    if (absent_by_level(results, factors, values)) continue;
    const Effects effects = effects_of(name, factors, values);
    for (const EffectShare& share : effects.shares)
      table.rows.push_back(
          {name, share.factor, number(share.share), number(share.low), number(share.high), effects.log});
  }
  return table;
}

}  // namespace

void derive_tables(StudyResults& results) {
  results.derived.clear();
  if (compares(results)) {
    results.derived.push_back(errors_table(results));
    results.derived.push_back(orders_table(results));
  }
  if (results.kind == "work-precision") results.derived.push_back(work_precision_table(results));
  collect(results);
  if (has_dynamics(results)) derive_dynamics(results);
  if (DerivedTable effects = effects_table(results); !effects.rows.empty())
    results.derived.push_back(std::move(effects));
  for (DerivedTable& table : report::shown_tables(results)) results.derived.push_back(std::move(table));
}

}  // namespace ricochet
