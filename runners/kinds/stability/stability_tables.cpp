#include "runners/kinds/stability/stability_tables.hpp"

#include "runners/kinds/stability/stability_roots.hpp"

namespace ricochet {
namespace {

const Column step_column{"step", "s", "Time step h of the range."};

}  // namespace

Table stability_head() {
  return {"stability",
          "One step of the range, with the contact held open or closed: what the plan predicts, and what was seen.",
          {step_column,
           {"closed", "",
            "Whether contact is closed: predicted with points held on both sides, observed in the scene itself, whose "
            "contacts open and close. Otherwise the structure alone."},
           {"radius", "1", "Spectral radius of the step, the largest modulus of its eigenvalues."},
           {"marginal", "", "Which roots on the unit circle are the scheme's own, and what they do."},
           {"limit_predicted", "s", "Largest step of the range up to which the radius stays at 1; empty: none found."},
           {"limit_observed", "s", "Largest step up to which marches stay bounded, by bisection; empty: none found."},
           {"status", "", "stable, marginal, unstable, failed or refused."},
           {"reason", "", "What grows and how fast, and where prediction and march disagree."}},
          {}};
}

Table stability_observed_head() {
  return {"stability_observed",
          "One march: a step of the range, of the structure alone or of the scene with its contacts.",
          {step_column,
           {"closed", "", "Whether the scene with its contacts was marched; otherwise the structure alone."},
           {"behaviour", "", "stable, marginal (grows like the number of steps), unstable, diverged or failed."},
           {"growth", "1", "Growth of the amplitudes per step, where they grow geometrically."},
           {"gain", "1", "Largest energy that nothing gave, over all that was given."},
           {"impacts", "1", "Number of times that a contact point closed, summed over the points."},
           {"changes_per_impact", "1",
            "Changes of the set of closed points for each time that contact began anywhere; 2: it closes and opens."},
           {"fast_share", "1", "Share of the contact force's power above a quarter of the step frequency."},
           {"chatter", "",
            "Whether contact flickers: over 0.75 of the power is fast, or over 20 changes for each time that contact "
            "began."},
           {"first_bad_step", "1", "Number of the step at which the growth showed."},
           {"steps", "1", "Steps that were marched."},
           {"cause", "", "What was seen, one sentence; empty where it is stable."}},
          {}};
}

Table restitution_head() {
  return {"restitution",
          "What a free mass keeps of its speed at a rigid stop, over the phases of the step at which it arrives; from "
          "the plan alone.",
          {{"step", "s", "Step of the plan that was asked: the smallest of the range that has one."},
           {"least", "1", "Smallest −v⁺/v⁻ over 64 phases of the impact within the step."},
           {"mean", "1", "Their mean."},
           {"most", "1", "The largest; beyond 1 the scheme throws a mass back faster than it came."},
           {"rho_inf", "1", "What a step leaves of the highest frequencies, ρ∞; nothing for an explicit step."}},
          {}};
}

void describe_stability(CaseRecord& record) {
  for (Table& table : record.tables)
    for (const Table& head :
         {stability_head(), stability_observed_head(), stability_roots_head(), restitution_head()}) {
      if (head.name != table.name) continue;
      if (const auto contact = find_column(table.columns, "contact")) {
        table.columns[*contact].name = "closed";
        for (Row& row : table.rows) row.at(*contact) = row.at(*contact) == "closed";
      }
      describe(table, head);
    }
}

}  // namespace ricochet
