#pragma once
#include "runners/kinds/kind.hpp"
#include "runners/study/fields.hpp"

/// \file
/// What the kinds that compare each case with a reference add to a study.
namespace ricochet {

/// The errors that a comparing study may ask for, in the order of its tables.
const std::vector<std::string>& error_names();

/// step, duration, samples, reference, errors, horizon, budget.
std::vector<Field> comparison_keys();

/// Refuses a horizon beyond the duration.
void check_comparison(const Json& resolved);

// What the kinds that compare each case with a reference share.

/// The settings of a comparing case: reference, errors, horizon, repeats (where the kind times), budget.
Json comparison_settings(const Json& resolved);

/// Runs cases against references that are computed once. A study none of whose scenes has one is refused before
/// anything runs.
CaseRunner compare_cases(const RunContext& context);

/// References, repeats, and what reading and comparing motions takes.
double seconds_beside(const ForecastContext& context);

/// "tip-linf 1.23e-04, …": the first errors of a case; without any, what it says as a trajectory.
std::string errors_text(const CaseRecord& record);

/// The measures of every comparison: errors, their floors, how they were found.
std::vector<MeasureInfo> comparison_measures();

/// What the kinds that compare cases with a reference have in common.
class ComparisonKind : public Kind {
 public:
  CasePlan plan(const StudyCase& study_case, const Registry& registry) const override;
  CaseRunner start(const RunContext& context) const override { return compare_cases(context); }
  bool works_beside() const override { return true; }
  double beside(const ForecastContext& context) const override { return seconds_beside(context); }
  bool marches_once() const override { return true; }
  CaseRecord march(const StudyCase& study_case, const Registry& registry, const std::atomic<bool>& stop) const override;
  Table curve(const StudyResults&) const override;
  std::string outcome(const CaseRecord& record) const override { return errors_text(record); }
  nlohmann::ordered_json alone(const StudyResults& results, const CaseRecord& record) const override;

 protected:
  /// `verbs`: of `ask`, that it answers itself; `default_asks`: what a study that asks nothing is asked.
  ComparisonKind(const char* name, const char* text, std::vector<Field> keys, const std::vector<MeasureInfo>& of_cases,
                 std::vector<std::string> verbs, Json (*default_asks)(const Json& resolved));
  /// Appends errors and orders, then what `costs` says of them (may be null), then what the cases carry.
  static void put_tables(StudyResults& results, const Choices& study,
                         std::vector<Table> (*costs)(const StudyResults&) = nullptr);
};

class References;

/// Runs one case of kind `convergence` or `work-precision` and compares it with its references.
///
/// Measures: error.NAME and floor.NAME for each error of the study (see motion_errors.hpp) against the first reference
/// that applies. The floor is the larger of that reference's own gap and its distance to the other references. Further
/// horizon (s), and declared_order where the scheme declares one for such a run. Status `refused` when no reference
/// applies.
CaseRecord run_comparison(const StudyCase& study_case, const Registry& registry, References& references,
                          const std::atomic<bool>& stop);

/// Marching time of one case alone, s of processor: set-up apart, nothing observed, no sample taken. None when the case
/// does not reach its end.
std::optional<double> time_case(const StudyCase& study_case, const Registry& registry, const std::atomic<bool>& stop);

}  // namespace ricochet

// What reports of the comparing kinds share: errors along the step and along the elements, and their orders.
namespace ricochet::report {

KindPage comparison_page();

/// Where errors follow their fitted order, with the ends of that line. It is the longest run of points above their
/// floor within a factor of two of e = C x^p. Axes as in `orders`.
Table order_lines(const Choices& choices);

/// How many orders are confirmed, refuted and undecided; methods × errors with orders and verdicts. Then every order
/// with its interval and reason, what is not confirmed first. Empty without the table `orders`.
std::string orders_html(const Choices& choices);

}  // namespace ricochet::report
