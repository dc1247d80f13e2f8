#pragma once
#include "runners/kinds/comparison/references.hpp"
#include "runners/kinds/trajectory/run_case.hpp"

namespace ricochet {

/// Where a case keeps what would be lost if it were killed, and says how far it is.
struct CaseDesk {
  MotionShelf shelf;  ///< bytes by key; empty bytes forget a key
  std::string key;    ///< of this case and everything its bits depend on
  int workers = 1;    ///< threads that this case may use
};

/// What would run for a case of kind `bifurcation`.
CasePlan plan_bifurcation(const StudyCase& study_case, const Registry& registry);

/// Runs one case of kind `bifurcation`: every value of the parameter from every start, as lanes where they share a
/// factorisation. Tables `values`, `bifurcations`; numbers `points`, `impacts`, `portraits` (see the README's table of
/// files) and, not exported, `contact_law`: compliance (m/N; 0: rigid, absent: not known). A value that cannot be
/// marched, diverges or fails is a row with its reason; the case is done when any value is.
CaseRecord run_bifurcation(const StudyCase& study_case, const Registry& registry, const CaseDesk& desk,
                           const std::atomic<bool>& stop);

}  // namespace ricochet
