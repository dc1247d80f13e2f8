#pragma once
#include <functional>
#include <string>
#include <utility>

#include "runners/asks/answer_asks.hpp"
#include "runners/kinds/kind.hpp"
#include "runners/report/choices.hpp"
#include "runners/store/record.hpp"

namespace ricochet {

/// The results of a study with all that follows from its cases, worked out once: the tables that stand beside cases.csv
/// (those of the kind, the answer and what it rests on, effects wherever at least two factors vary, those of the page),
/// and what the answer and the page ask. Rows speak of finished cases only; a partial study has partial tables.
/// `choices` and `analysis` refer to the results, which stay where they were made.
class AnalysedResults : public StudyResults {
 public:
  explicit AnalysedResults(StudyResults results);
  AnalysedResults(const AnalysedResults&) = delete;
  AnalysedResults& operator=(const AnalysedResults&) = delete;

  const Choices choices;
  const Analysis analysis;
  const asks::Asked asked;  ///< what the study asks, with its answers
};

/// The results with their tables.
inline AnalysedResults with_tables(StudyResults results) {
  return AnalysedResults(std::move(results));
}

using RenderReport = std::function<std::string(const AnalysedResults&)>;

}  // namespace ricochet
