#include "runners/answers/answer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "runners/answers/limits.hpp"
#include "runners/study/axis_meaning.hpp"
#include "runners/table/row_type.hpp"
#include "runners/table/table_reader.hpp"
#include "runners/table/text.hpp"

namespace ricochet::answers {

void Answer::say(std::string text, Clause clause) {
  sentences.push_back({std::move(text), {std::move(clause)}});
}

Table Answer::table() const {
  Table table = answers_type().head();
  int order = 0;
  for (const Sentence& sentence : sentences) {
    ++order;
    bool first = true;
    for (Clause clause : sentence.clauses) {
      clause.order = order;
      clause.sentence = first ? sentence.text : "";
      first = false;
      table.rows.push_back(answers_type().rows.row(clause));
    }
  }
  return table;
}

namespace {

std::optional<double> finite(std::optional<double> value, double factor) {
  return value && std::isfinite(*value) ? std::optional(*value * factor) : std::nullopt;
}

}  // namespace

const TableType<MeasureLimit>& limits_type() {
  static const TableType<MeasureLimit> all = [] {
    RowType<MeasureLimit> rows;
    rows.add({"measure", "", "The measure."}, &MeasureLimit::measure)
        .add({"case", "", "The case of the finest mesh and step that has a value."}, &MeasureLimit::id)
        .add({"value", "", "The value there, over the scale of its measure where that is a share; in `unit`."},
             &MeasureLimit::value)
        .add({"u", "", "Uncertainty that step and mesh leave, in `unit`; none of a single size, and of what grows."},
             &MeasureLimit::uncertainty)
        .add({"low", "", "Where the limit may be: from; none without u."}, &MeasureLimit::low)
        .add({"high", "", "Where the limit may be: to."}, &MeasureLimit::high)
        .add({"unit", "", "Unit of these."}, &MeasureLimit::unit)
        .add({"status", "",
              "What the values do as they are refined: one, same, two, settles, reaches truth, vanishes, moves, "
              "wanders, blows up."},
             &MeasureLimit::status)
        .add({"order", "1", "Order of convergence in the step, where two orders in a row agree."}, &MeasureLimit::order)
        .add({"step_moves", "", "What the step still moves it by, in `unit`."}, &MeasureLimit::step_moves)
        .add({"mesh_moves", "", "What the mesh still moves it by, in `unit`."}, &MeasureLimit::mesh_moves)
        .add({"steps", "1", "Steps at the finest mesh."}, &MeasureLimit::steps)
        .add({"meshes", "1", "Meshes at the finest step."}, &MeasureLimit::meshes)
        .add({"method", "", "The method in words."}, &MeasureLimit::method)
        .add({"tier", "1", "Methods with one number are not told apart; 1 is best, or least where none is better."},
             &MeasureLimit::tier)
        .add({"truth", "", "What an exact method gives, in `unit`, where that is known."}, &MeasureLimit::truth);
    return TableType<MeasureLimit>{
        "limits",
        "One row per method and measure: the value at the finest step and mesh, and how far refining them still "
        "moves it.",
        rows};
  }();
  return all;
}

namespace {

/// What a method has on an axis: nothing on that of its draws.
Cell of_method(const CaseRecord& record, const std::string& column) {
  return column == seed_axis ? Cell() : axis(record, column);
}

}  // namespace

Table limits_table(const Choices& study, const std::vector<std::string>& measures) {
  const StudyResults& results = study.results();
  const TableType<MeasureLimit>& type = limits_type();
  Table table{type.name, type.text, axis_columns(results, study.columns()), {}};
  table.columns = joined(std::move(table.columns), type.rows.columns());
  for (const std::string& measure : measures) {
    const MeasureLimits limits = limits_of(study, measure, keeps_energy(results), all_cases(results));
    const std::vector<const Method*> methods = limits.with_limit();
    const std::vector<std::size_t> tiers = tier_places(study, limits);
    for (std::size_t k = 0; k < methods.size(); ++k) {
      const Method* method = methods[k];
      const auto tier = tiers[k] > 0 ? std::optional(static_cast<int>(tiers[k])) : std::nullopt;
      const double factor = limits.words.factor;
      const Limit& limit = *method->limit;
      const auto move = [&](const std::optional<Limit>& along) -> std::optional<double> {
        return along ? finite(along->uncertainty, factor) : std::nullopt;
      };
      const auto sizes = [](const std::optional<Limit>& along) { return along ? static_cast<int>(along->sizes) : 0; };
      MeasureLimit row{.measure = measure, .id = method->finest->id, .value = factor * limit.value};
      row.uncertainty = finite(limit.uncertainty, factor);
      if (row.uncertainty) {
        row.low = finite(limit.low, factor);
        row.high = finite(limit.high, factor);
      }
      row.unit = limits.words.unit;
      row.status = word(limit.status);
      row.order = limit.order;
      row.step_moves = move(method->step);
      row.mesh_moves = move(method->mesh);
      row.steps = sizes(method->step);
      row.meshes = sizes(method->mesh);
      row.method = study.label(method->first(), without(study.choices(), {seed_axis}));
      row.tier = tier;
      row.truth = finite(limits.words.truth, factor);
      Row axes;
      for (const std::string& column : study.columns()) axes.push_back(of_method(method->first(), column));
      add_row(table, std::move(axes), type.rows.row(row));
    }
  }
  return table;
}

Table refinements_table(const Choices& study, const std::vector<std::string>& measures) {
  const StudyResults& results = study.results();
  Table table{"refinements",
              "The values that limits rest on: one row per method, measure, step at the finest mesh, and mesh at the "
              "finest step.",
              {{"measure", "", "The measure."},
               {"method", "", "The case that stands for the method in limits."},
               {"refined", "", "step or mesh."},
               {"size", "", "The step, in s or in periods, or the number of elements or modes."},
               {"value", "", "The value, in `unit`."},
               {"unit", "", "Unit of the value."}},
              {}};
  for (const std::string& measure : measures) {
    const MeasureLimits limits = limits_of(study, measure, keeps_energy(results), all_cases(results));
    for (const Method* method : limits.with_limit()) {
      const double h = study.step(*method->finest).value_or(0), N = study.elements(*method->finest).value_or(1);
      for (const auto& [size, value] : method->grid) {
        const bool by_step = size.second == N, by_mesh = size.first == h;
        const double shown = limits.words.factor * value;
        if (by_step && size.first > 0)
          table.rows.push_back({measure, method->finest->id, "step", size.first, shown, limits.words.unit});
        if (by_mesh && size.second > 1)
          table.rows.push_back({measure, method->finest->id, "mesh", size.second, shown, limits.words.unit});
      }
    }
  }
  return table;
}

Table differences_table(const Choices& study, const std::vector<std::string>& measures) {
  const StudyResults& results = study.results();
  Table table{"differences",
              "One row per choice, measure and combination of all other choices: how far apart the two levels are that "
              "are farthest apart.",
              {{"choice", "", "The choice: a role with its parameters, or an axis of the study."},
               {"measure", "", "The measure."}},
              {}};
  for (const std::string& column : study.columns()) table.columns.push_back(axis_column(results, column));
  for (const Column& column :
       {Column{"levels", "1", "Levels of the choice that were compared."},
        {"difference", "%", "Difference at the finest step and mesh, over one scale for all that are compared."},
        {"u", "%", "Uncertainty that step and mesh leave of it; none of a single step and mesh."},
        {"most", "", "The level with the largest value."},
        {"least", "", "The level with the smallest value."},
        {"verdict", "",
         "matters: the difference is beyond 1 % and its uncertainty; does not matter: both within; open, also without "
         "u."}})
    table.columns.push_back(column);
  for (const std::string& measure : measures) {
    const MeasureLimits limits = limits_of(study, measure, keeps_energy(results), all_cases(results));
    for (const ChoiceEffect& effect : choice_effects(study, limits)) {
      const std::vector<std::string> own = study.columns_of(effect.choice);
      for (const ChoiceRow& one : effect.rows) {
        Row row = {effect.choice, measure};
        for (const std::string& column : study.columns()) {
          const bool of_choice = std::find(own.begin(), own.end(), column) != own.end();
          row.push_back(of_choice ? Cell() : of_method(*one.combination, column));
        }
        for (Cell cell : {Cell(one.levels), Cell(100 * one.difference), Cell(finite(one.uncertainty, 100)),
                          Cell(one.most), Cell(one.least), Cell(word(one.matters()))})
          row.push_back(std::move(cell));
        table.rows.push_back(std::move(row));
      }
    }
  }
  return table;
}

}  // namespace ricochet::answers
