#include "runners/kinds/continuation/point_tables.hpp"

#include <algorithm>
#include <map>

#include "runners/store/record_values.hpp"
#include "runners/store/rows_of_cases.hpp"

namespace ricochet {
namespace {

const Column name_column{"name", "", "Name of the special point, as in special_points."};

/// The column of a value of the parameter.
Column of_parameter(const SweptColumns& swept, const char* name, const char* text) {
  return {name, swept.parameter.unit, text};
}

}  // namespace

TableType<PointPresenceRow> point_presence_type(const SweptColumns& swept) {
  RowType<PointPresenceRow> rows;
  rows.of_case(&PointPresenceRow::id)
      .add(name_column, &PointPresenceRow::name)
      .add({"presence", "",
            "found; many: other turns share its place; absent: a branch passed the place without it; not reached."},
           &PointPresenceRow::presence)
      .add({"points", "1", "Points of its kind at its place, where there is one."}, &PointPresenceRow::points)
      .add(of_parameter(swept, "passed_from", "Least parameter of the branch that passed the place without the point."),
           &PointPresenceRow::passed_from)
      .add(of_parameter(swept, "passed_to", "Largest parameter of that branch."), &PointPresenceRow::passed_to)
      .add({"robust", "", "Whether every case that reached the place has the point."}, &PointPresenceRow::robust);
  return {"point_presence", "A special point that has a name, and one case: whether the case has it.", rows};
}

TableType<PointShiftRow> point_shifts_type(const SweptColumns& swept) {
  RowType<PointShiftRow> rows;
  rows.of_case(&PointShiftRow::id)
      .add(name_column, &PointShiftRow::name)
      .add({"choice", "", "The one choice or refinement in which the case differs from the reference case."},
           &PointShiftRow::choice)
      .add({"value", "", "What the case has of it."}, &PointShiftRow::value)
      .add({"reference_value", "", "What the reference case has of it."}, &PointShiftRow::reference_value)
      .add(of_parameter(swept, "shift", "Parameter at the point less that of the reference case."),
           &PointShiftRow::shift)
      .add(of_parameter(swept, "low", "Lower end of where the shift may be, by the intervals of both points."),
           &PointShiftRow::low)
      .add(of_parameter(swept, "high", "Upper end of where the shift may be."), &PointShiftRow::high);
  return {"point_shifts",
          "A special point that has a name, in a case that differs from the reference case in one choice: how far it "
          "moves.",
          rows};
}

TableType<PointOrderRow> point_orders_type() {
  RowType<PointOrderRow> rows;
  rows.of_case(&PointOrderRow::id)
      .add(name_column, &PointOrderRow::name)
      .add({"method", "", "The finest case of the method, which may lie at another mesh, step or stiffness."},
           &PointOrderRow::method)
      .add({"refined", "", "What is refined: steps_per_period, elements, modes or contact.stiffness."},
           &PointOrderRow::refined)
      .add({"order", "1", "Order p of λ(h) = λ + c hᵖ in the step, the length of an element or the compliance 1/κ."},
           &PointOrderRow::order)
      .add({"low", "1", "Lower end of its interval."}, &PointOrderRow::low)
      .add({"high", "1", "Upper end of its interval."}, &PointOrderRow::high)
      .add({"sizes", "1", "Cases of the method along the refinement that have the point."}, &PointOrderRow::sizes)
      .add({"used", "1", "Those whose differences stand above twice their intervals and were used."},
           &PointOrderRow::used)
      .add({"verdict", "", "told: an interval no wider than ±0.5, above 0.3; not told."}, &PointOrderRow::verdict)
      .add({"reason", "", "Which sizes were used, or why the order is not told."}, &PointOrderRow::reason);
  return {"point_orders",
          "A special point that has a name, with one method and one refinement: the order by differences of successive "
          "sizes. The other refinements are the finest at which most sizes have it.",
          rows};
}

TableType<PointLimitRow> point_limits_type(const SweptColumns& swept) {
  RowType<PointLimitRow> rows;
  rows.of_case(&PointLimitRow::id)
      .add(name_column, &PointLimitRow::name)
      .add(of_parameter(swept, "finest", "Parameter at the point in the finest case of the method."),
           &PointLimitRow::finest)
      .add(of_parameter(swept, "limit", "Where it goes as everything is refined: Richardson where an order is told."),
           &PointLimitRow::limit)
      .add(of_parameter(swept, "low", "Lower end of where the limit may be; empty where nothing was refined."),
           &PointLimitRow::low)
      .add(of_parameter(swept, "high", "Upper end of where the limit may be."), &PointLimitRow::high)
      .add(of_parameter(swept, "step_open", "What the step leaves open; empty of one step."), &PointLimitRow::step_open)
      .add(of_parameter(swept, "mesh_open", "What the mesh leaves open; empty of one mesh."), &PointLimitRow::mesh_open)
      .add(of_parameter(swept, "law_open", "What the stiffness of the contact law leaves open; empty of one."),
           &PointLimitRow::law_open)
      .add(of_parameter(swept, "reference", "Parameter at the point of the reference solution, where there is one."),
           &PointLimitRow::reference)
      .add(of_parameter(swept, "reference_gap", "limit less reference."), &PointLimitRow::reference_gap);
  return {"point_limits", "A special point that has a name, with one method (its finest case): where it goes.", rows};
}

namespace {

/// special_points over all cases.
std::vector<SpecialRow> special_rows(const StudyResults& results, const StudyPoints& study) {
  const TableType<SpecialRow> type = special_points_type();
  const double least = study.least_fold().value_or(0);
  std::vector<SpecialRow> rows;
  const auto add = [&](SpecialRow row, const CaseRecord& record, int name) {
    row.id = record.id;
    if (name >= 0) row.name = study.names()[static_cast<std::size_t>(name)].text;
    if (row.kind != PointKind::fold || !row.name.empty() || row.prominence.value_or(least) >= least)
      rows.push_back(std::move(row));
  };
  auto point = study.points().begin();
  for (const CaseRecord& record : results.cases) {
    const auto first = point;
    for (; point != study.points().end() && study.cases()[point->owner] == &record; ++point)
      add(point->row, record, point->name);
    // A case without a branch says why.
    if (point == first)
      for (SpecialRow& row : type.read(record.tables)) add(std::move(row), record, -1);
  }
  return rows;
}

std::vector<PointPresenceRow> presence_rows(const StudyPoints& study) {
  std::vector<PointPresenceRow> rows;
  for (std::size_t name = 0; name < study.names().size(); ++name) {
    const std::size_t first = rows.size();
    bool robust = true;
    for (std::size_t c = 0; c < study.cases().size(); ++c) {
      std::optional<BranchReach> passed;
      const PointPresence presence = study.presence(c, static_cast<int>(name), &passed);
      PointPresenceRow row{study.cases()[c]->id, study.names()[name].text, word(presence)};
      if (const StudyPoint* point = study.find(c, static_cast<int>(name))) row.points = point->sharing;
      if (presence == PointPresence::absent && passed) {
        row.passed_from = passed->from;
        row.passed_to = passed->to;
      }
      robust &= presence != PointPresence::absent;
      rows.push_back(std::move(row));
    }
    for (std::size_t k = first; k < rows.size(); ++k) rows[k].robust = robust;
  }
  return rows;
}

std::vector<PointShiftRow> shift_rows(const StudyPoints& study) {
  std::vector<PointShiftRow> rows;
  for (std::size_t name = 0; name < study.names().size(); ++name) {
    const StudyPoint* standard = study.find(study.root(), static_cast<int>(name));
    // Where other turns share its place it is not known which one it is.
    if (!standard || standard->sharing > 1) continue;
    for (std::size_t c = 0; c < study.cases().size(); ++c) {
      const StudyPoint* point = c == study.root() ? nullptr : study.find(c, static_cast<int>(name));
      const std::vector<std::string> differs = study.differences(c, study.root());
      if (!point || point->sharing > 1 || differs.size() != 1 || is_reference(*study.cases()[c])) continue;
      PointShiftRow row{study.cases()[c]->id, study.names()[name].text, differs.front(),
                        study.level(c, differs.front()), study.level(study.root(), differs.front())};
      row.shift = point->parameter - standard->parameter;
      row.low = *row.shift - point->half - standard->half;
      row.high = *row.shift + point->half + standard->half;
      rows.push_back(std::move(row));
    }
  }
  return rows;
}

/// The parameter at the point of the first reference of the case's scene.
std::optional<double> value_of_reference(const StudyPoints& study, const CaseRecord& of, int name) {
  for (std::size_t c = 0; c < study.cases().size(); ++c) {
    const CaseRecord& one = *study.cases()[c];
    if (!is_reference(one) || std::any_of(one.axes.begin(), one.axes.end(), [&](const auto& place) {
          return axis(of, place.first).text() != axis(one, place.first).text();
        }))
      continue;
    if (const StudyPoint* point = study.find(c, name)) return point->parameter;
  }
  return std::nullopt;
}

void convergence_rows(const StudyPoints& study, const std::vector<std::vector<PointConvergence>>& convergence,
                      std::vector<PointOrderRow>& orders, std::vector<PointLimitRow>& limits) {
  for (std::size_t name = 0; name < study.names().size(); ++name)
    for (const PointConvergence& found : convergence[name]) {
      const std::string &id = study.cases()[found.finest]->id, &text = study.names()[name].text;
      if (is_reference(*study.cases()[found.finest])) continue;
      for (const PointConvergence::Along& one : found.along) {
        PointOrderRow row{study.cases()[one.finest]->id, text, id, study.axes()[one.axis].column};
        row.order = one.order.order;
        row.low = one.order.low;
        row.high = one.order.high;
        row.sizes = static_cast<int>(one.sizes);
        row.used = static_cast<int>(one.order.used);
        row.verdict = one.order.told ? order_told : order_not_told;
        row.reason = one.order.reason;
        orders.push_back(std::move(row));
      }
      if (!found.point) continue;
      PointLimitRow row{id, text, found.point->parameter, found.value};
      if (found.half) {
        row.low = found.value - *found.half;
        row.high = found.value + *found.half;
      }
      for (const PointConvergence::Along& one : found.along) {
        const std::string words = study.axes()[one.axis].words;
        (words == "step" ? row.step_open : words == "mesh" ? row.mesh_open : row.law_open) = one.limit.open;
      }
      row.reference = value_of_reference(study, *study.cases()[found.finest], static_cast<int>(name));
      if (row.reference) row.reference_gap = *row.limit - *row.reference;
      limits.push_back(std::move(row));
    }
}

}  // namespace

PointAnalysis::PointAnalysis(const Choices& study)
    : points(study), presence(presence_rows(points)), shifts(shift_rows(points)) {
  for (std::size_t name = 0; name < points.names().size(); ++name) {
    std::vector<PointConvergence>& own = convergence.emplace_back();
    for (const std::size_t head : points.heads()) own.push_back(points.convergence(head, static_cast<int>(name)));
  }
  convergence_rows(points, convergence, orders, limits);
  if (points.reference()) told = told_points(*this);
}

void PointAnalysis::append_tables(StudyResults& results) const {
  const SweptColumns swept = swept_columns(results);
  std::vector<Table>& derived = results.derived;
  const auto branches =
      std::find_if(derived.begin(), derived.end(), [](const Table& table) { return table.name == branches_name; });
  if (branches != derived.end())
    derived.insert(branches + 1, rows_of_cases(results, special_points_type(swept), special_rows(results, points)));
  if (points.cases().empty()) return;
  derived.push_back(rows_of_cases(results, point_presence_type(swept), presence));
  derived.push_back(rows_of_cases(results, point_shifts_type(swept), shifts));
  derived.push_back(rows_of_cases(results, point_orders_type(), orders));
  derived.push_back(rows_of_cases(results, point_limits_type(swept), limits));
}

}  // namespace ricochet
