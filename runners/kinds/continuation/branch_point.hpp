#pragma once
#include <iosfwd>

#include "runners/kinds/kind.hpp"

namespace ricochet {

/// Solves one orbit of a branch again, at any arc that the branch has: `ricochet point DIR CASE --branch B --arc S`.
/// Prints what it is, and writes its period as CSV; with `snapshots` keeps its film beside the case. By pieces the
/// branch is followed again from the kept state before the arc; by steps Newton's method is bordered by the secant of
/// the two rows around it. Throws PointRefused.
int solve_branch_point(const StudyResults& results, const PointRequest& asked, std::ostream& out);

}  // namespace ricochet
