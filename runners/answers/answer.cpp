#include "runners/answers/answer.hpp"

#include <algorithm>

#include "runners/answers/limits.hpp"
#include "runners/answers/set_names.hpp"
#include "runners/answers/tier_speaker.hpp"
#include "runners/study/axis_meaning.hpp"

namespace ricochet::answers {

const RowType<Clause>& clause_rows() {
  static const RowType<Clause> rows = [] {
    RowType<Clause> type;
    type.add({"order", "1", "Number of the sentence in the answer, from 1."}, &Clause::order)
        .add({"form", "",
              "What is said: keeps, gains, differ, none (no difference), open (not told), apart (how far, as a share "
              "of the scale), needs (the step that "
              "would tell), matters, part (matters in "
              "some "
              "combinations), value, order, cheapest, limit, diagram, basin, status."},
             &Clause::form)
        .add({"measure", "", "The measure that is spoken of."}, &Clause::measure)
        .add({"choice", "", "The choice that is spoken of: a role, or an axis of the study."}, &Clause::choice)
        .add({"who", "", "The methods that it holds for, in words."}, &Clause::who)
        .add({"methods", "", "A case of each of these methods, the finest with a value."}, &Clause::methods)
        .add({"value", "", "The value; of several methods, or of a choice's effects, the median. In `unit`."},
             &Clause::value)
        .add({"low", "", "The least of these methods, in `unit`."}, &Clause::low)
        .add({"high", "", "The largest of these methods, in `unit`."}, &Clause::high)
        .add({"u", "", "Uncertainty that step and mesh leave: the largest of these methods, in `unit`."},
             &Clause::uncertainty)
        .add({"status", "",
              "What the values do as they are refined, \"several\" where methods differ in that; of a choice its "
              "verdict."},
             &Clause::status)
        .add({"unit", "", "Unit of value, low, high and u."}, &Clause::unit)
        .add({"at_step", "", "The finest step of these methods: s, or a share of the period."}, &Clause::at_step)
        .add({"at_mesh", "1", "The finest mesh of these methods: elements."}, &Clause::at_mesh)
        .add({"sentence", "", "What is said of it; a sentence stands on the first of its rows."}, &Clause::sentence);
    return type;
  }();
  return rows;
}

Table answers_head() {
  return {
      "answers",
      "What the study says to its question, in the order in which it is read: a row for each set of methods, or each "
      "choice, that a sentence speaks of.",
      clause_rows().columns(),
      {}};
}

void Answer::say(std::string text, Clause clause) {
  sentences.push_back({std::move(text), {std::move(clause)}});
}

Table Answer::table() const {
  Table table = answers_head();
  int order = 0;
  for (const Sentence& sentence : sentences) {
    ++order;
    bool first = true;
    for (Clause clause : sentence.clauses) {
      clause.order = order;
      clause.sentence = first ? sentence.text : "";
      first = false;
      table.rows.push_back(clause_rows().row(clause));
    }
  }
  return table;
}

namespace {

std::optional<double> finite(std::optional<double> value, double factor) {
  return value && std::isfinite(*value) ? std::optional(*value * factor) : std::nullopt;
}

}  // namespace

Table limits_table(const Compared& study, const std::vector<std::string>& measures) {
  const StudyResults& results = study.results();
  Table table{"limits",
              "One row per method and measure: the value at the finest step and mesh, and how far refining them still "
              "moves it.",
              {},
              {}};
  for (const std::string& column : study.columns()) table.columns.push_back(axis_column(results, column));
  for (const Column& column :
       {Column{"measure", "", "The measure."},
        {"case", "", "The case of the finest mesh and step that has a value."},
        {"value", "", "The value there, over the scale of its measure where that is a share; in `unit`."},
        {"u", "", "Uncertainty that step and mesh leave, in `unit`; none of a single size, and of what grows."},
        {"low", "", "Where the limit may be: from."},
        {"high", "", "Where the limit may be: to."},
        {"unit", "", "Unit of these."},
        {"status", "",
         "What the values do as they are refined: one, same, two, settles, reaches truth, vanishes, moves, wanders, "
         "blows "
         "up."},
        {"order", "1", "Order of convergence in the step, where two orders in a row agree."},
        {"step_moves", "", "What the step still moves it by, in `unit`."},
        {"mesh_moves", "", "What the mesh still moves it by, in `unit`."},
        {"steps", "1", "Steps at the finest mesh."},
        {"meshes", "1", "Meshes at the finest step."},
        {"method", "", "The method in words."},
        {"tier", "1", "Methods with one number are not told apart; 1 is best, or least where none is better."},
        {"truth", "", "What an exact method gives, in `unit`, where that is known."}})
    table.columns.push_back(column);
  for (const std::string& measure : measures) {
    const MeasureLimits limits = limits_of(study, measure, keeps_energy(results), all_cases(results));
    const std::vector<const Method*> methods = limits.with_limit();
    const std::vector<std::size_t> tiers = in_tiers(study, limits)
                                               ? TierSpeaker(study, limits, study.columns()).places()
                                               : std::vector<std::size_t>(methods.size(), 0);
    for (std::size_t k = 0; k < methods.size(); ++k) {
      const Method* method = methods[k];
      const auto tier = tiers[k] > 0 ? std::optional(static_cast<int>(tiers[k])) : std::nullopt;
      Row row = axes_of(method->first(), study.columns());
      const double factor = limits.words.factor;
      const Limit& limit = *method->limit;
      const auto move = [&](const std::optional<Limit>& along) -> std::optional<double> {
        return along ? finite(along->uncertainty, factor) : std::nullopt;
      };
      const auto sizes = [](const std::optional<Limit>& along) { return along ? static_cast<int>(along->sizes) : 0; };
      for (Cell cell :
           {Cell(measure), Cell(method->finest->id), Cell(factor * limit.value),
            Cell(finite(limit.uncertainty, factor)), Cell(finite(limit.low, factor)), Cell(finite(limit.high, factor)),
            Cell(limits.words.unit), Cell(word(limit.status)), Cell(limit.order), Cell(move(method->step)),
            Cell(move(method->mesh)), Cell(sizes(method->step)), Cell(sizes(method->mesh)),
            Cell(study.label(method->first())), Cell(tier), Cell(finite(limits.words.truth, factor))})
        row.push_back(std::move(cell));
      table.rows.push_back(std::move(row));
    }
  }
  return table;
}

Table refinements_table(const Compared& study, const std::vector<std::string>& measures) {
  const StudyResults& results = study.results();
  Table table{"refinements",
              "The values that limits rest on: one row per method, measure, step at the finest mesh, and mesh at the "
              "finest step.",
              {{"measure", "", "The measure."},
               {"method", "", "The case that stands for the method in limits."},
               {"refined", "", "step or mesh."},
               {"size", "", "The step, in s or in periods, or the number of elements."},
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

Table differences_table(const Compared& study, const std::vector<std::string>& measures) {
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
         "matters: the difference is beyond 1 % and its uncertainty; does not matter: both within; open."}})
    table.columns.push_back(column);
  for (const std::string& measure : measures) {
    const MeasureLimits limits = limits_of(study, measure, keeps_energy(results), all_cases(results));
    for (const ChoiceEffect& effect : choice_effects(study, limits)) {
      const std::vector<std::string> own = study.columns_of(effect.choice);
      for (const ChoiceRow& one : effect.rows) {
        Row row = {effect.choice, measure};
        for (const std::string& column : study.columns()) {
          const bool of_choice = std::find(own.begin(), own.end(), column) != own.end();
          row.push_back(of_choice ? Cell() : axis(*one.combination, column));
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
