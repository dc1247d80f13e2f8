#pragma once
#include <map>
#include <string>
#include <vector>

#include "runners/asks/evidence.hpp"
#include "runners/table/table.hpp"

namespace ricochet::asks {

/// What answers a verb of a kind, by verb_of_kind().
using OwnAnswers = std::map<std::string, std::function<Answered(const Ask&, const Evidence&)>>;

/// What a study asks, each with its answer.
struct Asked {
  std::vector<std::string> first;  ///< what comes before all answers: that nothing happened
  std::vector<std::pair<Ask, Answered>> all;
  std::vector<std::string> proposed = {};  ///< of a study that asks nothing: what it could ask, as JSON
  /// Those that must be yes and are not.
  std::vector<const Ask*> unmet() const;
};

Asked answer_asks(const std::vector<Ask>& asks, const Evidence& evidence, const OwnAnswers& own);

/// verdicts: the rows of all answers; the first of each has its sentence.
Table verdicts_table(const Asked& asked);

}  // namespace ricochet::asks
