#pragma once
#include <atomic>
#include <ricochet/contract/registry.hpp>

#include "runners/store/record.hpp"
#include "runners/study/study.hpp"

namespace ricochet {

/// What would run for a case, decided without running it.
struct CasePlan {
  std::string refusal;        ///< "" when the case applies
  std::string operator_name;  ///< diagonal, modal, band, sparse
  long long steps = 0;
  double predicted_seconds = 0;
  std::vector<std::pair<std::string, std::string>> left_out;  ///< item, reason
  std::vector<std::string> notes;
};

CasePlan plan_case(const StudyCase& study_case, const Registry& registry);

/// Thrown by run_case when `stop` became true while it marched; the case leaves nothing behind.
struct Interrupted {};

/// Runs one case of kind `trajectory` to its end. Whatever goes wrong in it is the record's status and reason; input
/// errors that only show on this case's mesh are InputError.
CaseRecord run_case(const StudyCase& study_case, const Registry& registry, const std::atomic<bool>& stop);

}  // namespace ricochet
