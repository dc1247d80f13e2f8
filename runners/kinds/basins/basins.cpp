#include "runners/kinds/basins/basins.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <functional>
#include <iostream>
#include <memory>

#include "runners/asks/kind_verbs.hpp"
#include "runners/kinds/all_kinds.hpp"
#include "runners/kinds/basins/basin_analysis.hpp"
#include "runners/kinds/basins/cell_scenes.hpp"
#include "runners/kinds/basins/page/page.hpp"
#include "runners/kinds/sweep/march_point.hpp"
#include "runners/kinds/sweep/motion_asks.hpp"
#include "runners/kinds/sweep/sweep.hpp"
#include "runners/kinds/sweep/sweep_tables.hpp"
#include "runners/kinds/sweep/with_parameter.hpp"
#include "runners/study/fields.hpp"

namespace ricochet {

/// Integrates the orbit of one cell again, from the scene's initial state: --cell X,Y as in cells.csv.
int march_cell_again(const StudyResults& results, const PointRequest& asked, std::ostream& out);

namespace {

std::vector<Field> basins_keys() {
  using namespace keys;
  ObjectForm axis = swept_range("Number of cells, evenly spaced, the ends included.");
  axis.fields.insert(axis.fields.begin(), swept_pointer());
  Field axes = of_form(Field::Form::objects, "axes", std::nullopt, "The two axes of the grid, x and y.");
  axes.nested.push_back(std::move(axis));
  axes.count = 2;
  Field refine;
  refine.spec.type = ParameterSpec::Type::boolean;
  refine.spec.key = "refine";
  refine.spec.text = "Whether only cells near a boundary of basins are marched, after a coarse grid.";
  refine.fallback = false;
  std::vector<Field> fields = {std::move(axes), steps_per_period(), march("every-step")};
  for (Field& field : orbit_keys()) fields.push_back(std::move(field));
  fields.push_back(std::move(refine));
  fields.push_back(budget());
  return fields;
}

asks::Places ended_cells(const BasinAnalysis& basins, const CaseRecord& record) {
  asks::Places out;
  if (const auto starts = basins.starts.find(record.id); starts != basins.starts.end())
    out.all = starts->second.cells - starts->second.no_starts;
  for (const report::BasinImage& image : basins.images)
    if (image.record == &record)
      for (const auto& [reason, cells] : image.reasons) out.ended[word(Status::failed)] += cells;
  return out;
}

class BasinsKind final : public SweepKind {
 public:
  BasinsKind()
      : SweepKind("basins", "Each case goes through a grid of two parameters: where the orbit of each cell ends.",
                  basins_keys(), {"motions", "effect on motions"}, check_basin_ask,
                  [](const Json& resolved) { return default_motion_asks(resolved, "share"); }) {}
  CasePlan plan(const StudyCase& study_case, const Registry& registry) const override {
    return plan_basins(study_case, registry);
  }
  int point(const StudyResults& results, const PointRequest& asked, std::ostream& out) const override {
    return march_cell_again(results, asked, out);
  }

 private:
  CaseRecord run(const StudyCase& study_case, const Registry& registry, const CaseContext& context,
                 const std::atomic<bool>& stop) const override {
    return run_basins(study_case, registry, context, stop);
  }
  Analysis derive(StudyResults& results) const override {
    const auto basins = std::make_shared<const BasinAnalysis>(analyse_basins(results));
    return {
        report::basins_page(basins),
        {{"motions", [basins](const asks::Ask& ask,
                              const asks::Evidence& evidence) { return motions_of_basins(ask, evidence, *basins); }},
         {"effect on motions",
          [basins](const asks::Ask& ask, const asks::Evidence& evidence) {
            return effect_on_basins(ask, evidence, *basins);
          }},
         {"runs", [basins](const asks::Ask& ask, const asks::Evidence& evidence) {
            return asks::runs_of_places(ask, evidence, basins->of_states ? "starts" : "cells",
                                        [&](const CaseRecord& record) { return ended_cells(*basins, record); });
          }}}};
  }
};

}  // namespace

KindPointer basins_kind() {
  return std::make_unique<BasinsKind>();
}

namespace {

// "X,Y" as two numbers.
std::pair<double, double> two_numbers(const std::string& text) {
  std::pair<double, double> out;
  const char* end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, out.first);
  if (first.ec == std::errc() && first.ptr != end && *first.ptr == ',')
    if (const auto second = std::from_chars(first.ptr + 1, end, out.second);
        second.ec == std::errc() && second.ptr == end)
      return out;
  throw PointRefused(fmt::format("--cell \"{}\": expected two numbers X,Y, the values of the study's axes", text));
}

std::size_t find_place(const GridAxis& axis, double wanted) {
  for (std::size_t k = 0; k < axis.values.size(); ++k)
    if (is_value(axis.values[k], wanted)) return k;
  throw PointRefused(fmt::format("no cell was marched at {} {}; the nearest values are {}", axis.pointer, wanted,
                                 nearest_values(axis.values, wanted)));
}

// The strobed points that the run stored for a row of cells.csv.
std::vector<SectionPoint> stored_section(const CaseRecord& record, std::size_t row) {
  std::vector<SectionPoint> out;
  const NumberType<SectionColumns> type = cell_points_type();
  const NumberTable* table = type.find(record.numbers);
  if (!table) return out;
  const SectionColumns of = type.read(*table);
  if (!of.cell || !of.displacement || !of.velocity || !of.opposite_displacement || !of.opposite_velocity) return out;
  const std::vector<double>&cells = of.cell->get(), &x = of.displacement->get(), &v = of.velocity->get();
  const std::vector<double>&ox = of.opposite_displacement->get(), &ov = of.opposite_velocity->get();
  for (std::size_t i = 0; i < cells.size(); ++i)
    if (cells[i] == static_cast<double>(row)) out.push_back({x[i], v[i], ox[i], ov[i]});
  return out;
}

std::string text_of(const CellEnd& end) {
  if (end.status != Status::done) return status_word(end) + (": " + end.reason);
  return text(end.motion);
}

}  // namespace

int march_cell_again(const StudyResults& results, const PointRequest& asked, std::ostream& out) {
  if (asked.cell.empty() || asked.parameter || !asked.start.empty() || asked.solves())
    throw PointRefused("this is a study of kind basins; expected --cell X,Y, as in cells.csv");
  const auto [x, y] = two_numbers(asked.cell);
  const CaseRecord& record = find_case(results, asked.case_id);
  const StoredStudy stored(results, asked.plugins);
  const StudyCase& study_case = stored.find(record.id);
  const std::vector<GridAxis> axes = grid_axes(study_case.settings);
  const std::size_t column = find_place(axes[0], x), line = find_place(axes[1], y);
  const TableType<CellRow> type = cells_type();
  std::optional<std::size_t> row;
  CellRow cell;
  type.rows.each(stored_table(record, type.name), [&](std::size_t r, CellRow&& one) {
    if (row || one.x != axes[0].values[column] || one.y != axes[1].values[line]) return;
    row = r;
    cell = std::move(one);
  });

  SamplePrinter print(out);
  const CellEnd end = march_cell(study_case, stored.registry, {column, line}, wanted_count(asked), std::ref(print));
  std::cerr << text_of(end);
  if (!row) {
    std::cerr << "; the run has not come to this cell";
  } else if (cell.marched == false) {
    std::cerr << fmt::format("; the run filled this cell from a marched one of its basin ({})",
                             regime_text(cell.regime, cell.period));
  } else {
    const std::vector<SectionPoint> section = stored_section(record, *row);
    std::size_t equal = 0;
    for (std::size_t i = 0; i < std::min(section.size(), end.section.size()); ++i)
      equal += section[i].displacement == end.section[i].displacement && section[i].velocity == end.section[i].velocity;
    std::cerr << comparison_text(equal, std::max(section.size(), end.section.size()));
  }
  std::cerr << "\n";
  constexpr int some_failed = 3;
  return end.status == Status::done ? 0 : some_failed;
}

}  // namespace ricochet
