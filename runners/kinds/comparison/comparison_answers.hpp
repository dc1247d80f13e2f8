#pragma once
#include <optional>
#include <ricochet/measure/statistics/refinement.hpp>
#include <string>
#include <vector>

#include "runners/asks/evidence.hpp"
#include "runners/report/choices.hpp"

namespace ricochet {

/// order_runs: one row per method, error and refined quantity.
Table order_runs_table(const Choices& study);

/// The order in the step that an error may show.
struct ShownOrder {
  std::optional<double> order;  ///< what the scheme declares, or less where velocities are read by less
  std::string because = {};     ///< why it is less
};
ShownOrder shown_order(const CaseRecord& record, const std::string& error);

/// One method's errors along a refinement, at the finest of the other.
struct MethodRun {
  Cases cases;
  const CaseRecord* finest = nullptr;
  OrderRun run;
  ShownOrder declared;
  std::optional<double> motion;         ///< what a motion at rest would err by
  std::vector<SizedValue> errors = {};  ///< the coarsest first
  double floor = 0;
  /// OrderRun::clean(); and where impacts fall somewhere in their steps, two slopes that the next contradicts are none.
  bool clean() const;
};

/// Of every method with two sizes or more, among these cases. `refined`: "step" or "elements".
std::vector<MethodRun> runs_of(const Choices& study, const Cases& cases, const std::string& error,
                               const std::string& refined);
/// Among all cases.
std::vector<MethodRun> runs_of(const Choices& study, const std::string& error, const std::string& refined);

/// "the error of the impact times"; "impact times" alone, where that says which error it is.
std::string error_words(const std::string& error);
std::string short_error_words(const std::string& error);

/// What of the cases is in their errors beside the time scheme: the law, where references have rigid stops, or not the
/// mesh. A sentence each.
std::vector<std::string> reference_words(const Cases& cases);

/// What answers `order` and `cheapest`.
asks::Answered order_ask(const asks::Ask& ask, const asks::Evidence& evidence);
asks::Answered cheapest_ask(const asks::Ask& ask, const asks::Evidence& evidence);
/// Refuses an error that the study does not compute, and orders of fewer than three sizes.
void check_error_ask(const Study& study, const Json& ask, const std::string& pointer);
/// What a study that asks nothing is asked: the order of each error, or its value where no three sizes show one.
Json default_order_asks(const Json& resolved);
/// The cheapest for 1 and 0.1 % of its first error, and what a compared choice costs.
Json default_cheapest_asks(const Json& resolved);
/// The error of an ask by its own name: "impact-times" of "impact_times" and of "error.impact-times".
std::string error_name(std::string asked);

}  // namespace ricochet
