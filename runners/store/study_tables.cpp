#include "runners/store/study_tables.hpp"

namespace ricochet {

TableType<EffectRow> effects_type() {
  RowType<EffectRow> rows;
  rows.add({"measure", "", "The measure, a column of cases.csv."}, &EffectRow::measure)
      .add({"factor", "", "The axis that was varied; two joined by × for what only their combination explains."},
           &EffectRow::factor)
      .add({"share", "1", "Share of the variance of the measure over the finished cases that the factor explains."},
           &EffectRow::share)
      .add({"low", "1", "Lower end of the 95 % interval of the share."}, &EffectRow::low)
      .add({"high", "1", "Upper end of the 95 % interval of the share."}, &EffectRow::high)
      .add({"log", "", "Whether the logarithm of the measure was analysed, because it spans orders of magnitude."},
           &EffectRow::log);
  return {"effects",
          "Over all cases: what one choice, or two together, explain of the spread of one measure. Choices of two "
          "levels have differences (answers.csv) and no share; a measure whose spread round-off explains has none.",
          rows};
}

TableType<ReasonRow> reasons_type() {
  RowType<ReasonRow> rows;
  rows.add({"status", "", "refused (does not apply), diverged or failed; done, with a doubt."}, &ReasonRow::status)
      .add({"reason", "", "Why, as it stands in cases.csv; doubts of one kind are one, that of the first case."},
           &ReasonRow::reason)
      .add({"cases", "1", "Number of cases that give this reason."}, &ReasonRow::cases)
      .add({"case", "", "The first of them: its row in cases.csv."}, &ReasonRow::first);
  return {"reasons",
          "One row per reason for which finished cases have no result, or a doubtful one, in the study's order.", rows};
}

const TableType<answers::Clause>& answers::answers_type() {
  static const TableType<Clause> all = [] {
    RowType<Clause> type;
    type.add({"order", "1", "Number of the sentence in the answer, from 1."}, &Clause::order)
        .add({"form", "",
              "What is said: keeps, gains, differ, none (no difference), open (not told), apart (how far, as a share "
              "of the scale). Further words: needs (the step that would tell), matters, part (matters in some "
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
    return TableType<Clause>{"answers",
                             "What the study says to its question, in the order in which it is read. A row stands for "
                             "each set of methods, or each choice, that a sentence speaks of.",
                             type};
  }();
  return all;
}

}  // namespace ricochet
