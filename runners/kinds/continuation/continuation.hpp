#pragma once
#include <atomic>
#include <iosfwd>
#include <ricochet/contract/registry.hpp>
#include <vector>

#include "runners/answers/answer.hpp"
#include "runners/asks/evidence.hpp"
#include "runners/march/case_context.hpp"
#include "runners/march/prepare_case.hpp"
#include "runners/store/record.hpp"
#include "runners/study/study.hpp"

/// \file
/// Cases of kind `continuation`, one orbit of theirs, and what they answer.
namespace ricochet {

struct PointAnalysis;
struct PointRequest;

/// What would run for a case of kind `continuation`.
CasePlan plan_continuation(const StudyCase& study_case, const Registry& registry);

/// Solves the orbits of one case and follows their branches. Tables `branches`, `special_points`, `turns`. A case one
/// of whose orbits is not found is failed; the branches of the others are there.
CaseRecord run_continuation(const StudyCase& study_case, const Registry& registry, const CaseContext& context,
                            const std::atomic<bool>& stop);

// Cases that a reference solves: orbits of the scene itself, without a mesh and steps of time.

/// Appends a case for each reference and each scene of the study: "reference", "reference-2", … Their axes are those of
/// the scene. Throws InputError for what has no orbits of its own.
void add_reference_cases(const std::vector<MethodChoice>& references, Study& study);

CasePlan plan_reference(const StudyCase& study_case, const Registry& registry);
/// Follows its orbits by steps of arclength. Throws Interrupted where `stop` became true.
CaseRecord run_reference(const StudyCase& study_case, const Registry& registry, const std::atomic<bool>& stop);

/// Solves one orbit of a branch again, at any arc that the branch has: `ricochet point DIR CASE --branch B --arc S`.
/// Prints what it is, and writes its period as CSV; with `snapshots` keeps its film beside the case. By pieces the
/// branch is followed again from the kept state before the arc. By steps Newton's method is bordered by the secant of
/// the two rows around it. Throws PointRefused.
int solve_branch_point(const StudyResults& results, const PointRequest& asked, std::ostream& out);

/// Special points of asked kinds in the order of their branches, what is stable beside them, and how far branches went.
asks::Answered points_ask(const asks::Ask& ask, const asks::Evidence& evidence, const PointAnalysis& points);
void check_points_ask(const Study& study, const Json& ask, const std::string& pointer);

}  // namespace ricochet
