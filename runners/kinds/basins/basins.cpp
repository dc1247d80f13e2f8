#include "runners/kinds/basins/basins.hpp"

#include "runners/kinds/basins/basin_tables.hpp"
#include "runners/kinds/basins/page/page.hpp"
#include "runners/kinds/basins/point.hpp"
#include "runners/kinds/basins/run_basins.hpp"
#include "runners/kinds/sweep/sweep.hpp"
#include "runners/kinds/sweep/sweep_keys.hpp"
#include "runners/study/fields.hpp"

namespace ricochet {
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

}  // namespace

Kind basins_kind() {
  Kind kind = sweep_kind(run_basins, dynamics::derive_basins);
  kind.format.name = "basins";
  kind.format.text = "Each case goes through a grid of two parameters: where the orbit of each cell ends.";
  kind.format.keys = basins_keys();
  kind.plan = plan_basins;
  kind.point = march_cell_again;
  kind.answers = [](const StudyResults& results) {
    Table table = answers_head();
    for (const std::string& sentence : report::basins_said(report::CaseView(results)))
      table.rows.push_back(AnswerRow{.sentence = sentence}.row());
    return table;
  };
  kind.page = report::basins_page;
  return kind;
}

}  // namespace ricochet
