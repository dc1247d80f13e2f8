#pragma once
#include "runners/store/record.hpp"

namespace ricochet {

/// `stability`, without rows: one per step and contact state, what the plan predicts there and what became of it.
Table stability_head();

/// `stability_observed`, without rows: one per step and contact state that was marched.
Table stability_observed_head();

/// `restitution`, without rows: one, what a free mass keeps of its speed at a rigid stop, over the phases of a step.
Table restitution_head();

/// Gives the tables that a case of a stability study left their units and meanings, and today's column names: stores
/// that are older say the contact state in the words of a column `contact`.
void describe_stability(CaseRecord& record);

/// Rows of `answers`: which schemes have a largest step and which none, and how often march and spectrum agree.
Table stability_answers(const StudyResults& results);

}  // namespace ricochet
