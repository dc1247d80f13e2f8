#include "runners/kinds/kind.hpp"

namespace ricochet {

Table answers_head() {
  return {
      "answers",
      "What the study says to its question, in the order in which it is read: one choice and one measure, or what "
      "its kind says.",
      {{"choice", "", "The axis; the name of a role stands for the method with its parameters."},
       {"measure", "", "The measure, a column of cases.csv."},
       {"verdict", "",
        "decides: a difference above 1 % and above twice what step and mesh leave open. does not matter: difference "
        "and what is open are both within 1 %. not resolved: what is open may be the difference. depends: in some "
        "combinations of the other choices only. not told: one step and one mesh. not observed: 0 or round-off. "
        "shares: what effects.csv says "
        "of the measure. Kinds "
        "that "
        "answer in their own way have words of their own."},
       {"effect", "1",
        "Spread of the measure over the levels of the choice, all else being the same and as fine as there is, over "
        "the scale: median over the combinations of the other choices."},
       {"largest", "1", "The largest such spread."},
       {"scale", "", "What effects are shares of; empty where the measure is a share itself."},
       {"step_open", "1",
        "What the step leaves open: by how much the measure moved between the two finest steps, over the scale; "
        "median over the combinations. Empty with one step."},
       {"mesh_open", "1", "The same of the two finest meshes."},
       {"window_open", "1",
        "Of a mean over a window: half its 95 % interval, over the scale; the widest of the levels, median over the "
        "combinations."},
       {"combinations", "1",
        "Combinations of the other choices in which two levels or more finished; those that the row speaks of, where a "
        "choice does not matter in some and is not resolved in others."},
       {"depends_on", "", "The other choice that tells where this one decides."},
       {"sentence", "", "The rows of one choice and one verdict, said together; empty but in the first of them."}},
      {}};
}

Row AnswerRow::row() const {
  return {choice,    measure,   verdict,     effect,       largest,    scale,
          step_open, mesh_open, window_open, combinations, depends_on, sentence};
}

}  // namespace ricochet
