#pragma once
#include "runners/store/record.hpp"

/// \file
/// What the cells of a stability study come to: the step limits of each method and whether prediction and march agree.
namespace ricochet {

/// An observed limit agrees with the expected one within this share of it.
inline constexpr double limit_tolerance = 0.02;

/// step_limits: one row per case and contact state, open before closed. A scene is open as well as closed: the limit
/// expected of it is the smaller of both predictions, and a cell is expected to grow where either radius exceeds one.
/// The open structure does not depend on the contact law: of cases that differ in it alone one is `counted`, the first
/// that was done.
Table step_limits_table(const StudyResults& results);

/// step_limit_agreement: how many of the counted ranges agree, for the open structure, for closed contact, and for
/// both together.
Table step_limit_agreement_table(const Table& step_limits);

/// stability_cells: each step of each contact state with what was predicted and observed of it.
Table stability_cells_table(const StudyResults& results);

/// stability_disagreements: ranges of neighbouring steps where prediction and observation differ.
Table stability_disagreements_table(const StudyResults& results);

}  // namespace ricochet
