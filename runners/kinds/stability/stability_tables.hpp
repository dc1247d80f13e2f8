#pragma once
#include <array>
#include <optional>
#include <ricochet/measure/stability/observed_stability.hpp>
#include <string>
#include <vector>

#include "runners/store/record.hpp"
#include "runners/table/row_type.hpp"

namespace ricochet {

struct SemiDiscrete;
struct StepPlan;
struct StepSpectrum;

/// By how much a step grows, and what does.
std::string growth_text(const StepSpectrum& known, bool closed);

/// What became of a step: as the plan predicts it, or as it was seen where that is worse.
enum class StepStatus { stable, marginal, unstable, failed, refused };
constexpr std::array<const char*, 5> words_of(StepStatus) {
  return {"stable", "marginal", "unstable", "failed", "refused"};
}

/// One row of `stability`: a step and contact state, what the plan predicts there and what became of it.
struct StabilityRow {
  std::optional<double> step;
  bool closed = false;
  std::optional<double> radius;
  std::string marginal;
  std::optional<double> limit_predicted, limit_observed;
  StepStatus status = StepStatus::failed;
  std::string reason;
};
TableType<StabilityRow> stability_type();

/// One row of `stability_observed`: a step and contact state that was marched.
struct ObservedRow {
  std::optional<double> step;
  bool closed = false;
  Behaviour behaviour = Behaviour::stable;
  std::optional<double> growth = {}, gain = {};
  std::optional<long long> impacts = {};
  std::optional<double> changes_per_impact = {}, fast_share = {};
  bool chatter = false;
  std::optional<long long> first_bad_step = {};
  long long steps = 0;
  std::string cause = {};
};
TableType<ObservedRow> stability_observed_type();

/// The one row of `restitution`: what a free mass keeps of its speed at a rigid stop, over the phases of a step.
struct RestitutionRow {
  std::string id;
  std::optional<double> step, least, mean, most, rho_inf;
};
TableType<RestitutionRow> restitution_type();

/// Gives the tables that a case of a stability study left their units and meanings, and today's column names. Older
/// stores say the contact state in the words of a column `contact`.
void describe_stability(std::vector<CaseRecord>& cases);

// The cells that a case of kind `stability` left, as a range of steps.

/// One step of a range.
struct StepCell {
  double step = 0;               ///< s
  std::optional<double> radius;  ///< of the contact state itself
  std::optional<double> worst;   ///< the larger of the radii that the marched cell meets: a scene is open as well
  std::string marginal;
  StepStatus status = StepStatus::failed;
  std::string reason;
  std::optional<Behaviour> behaviour = {};  ///< nothing where not observed
  /// By the tolerance of the spectrum itself (growth_tolerance).
  bool predicted_unstable() const;
  bool observed_unstable() const { return behaviour && !stays_bounded(*behaviour); }
  bool disagrees() const { return worst && behaviour && predicted_unstable() != observed_unstable(); }
};

/// One contact state of one case, along the step.
struct StepRange {
  std::vector<StepCell> cells;                ///< steps increase
  std::optional<double> predicted, observed;  ///< step limits, s
  std::optional<double> expected;             ///< the smaller of the predicted limits that the marched cell meets
};

/// The open or closed range of a case; nothing where its tables have no such rows.
std::optional<StepRange> step_range(const CaseRecord& record, bool closed);

/// Neighbouring steps at which prediction and observation differ in the same way.
struct Disagreement {
  double from = 0, to = 0;  ///< s
  std::size_t steps = 0;
  bool predicted_unstable = false;
};

/// How the cells of a range disagree; empty where they agree.
std::vector<Disagreement> disagreements(const StepRange& range);

// What the cells of a stability study come to: the step limits of each method and whether prediction and march agree.

/// An observed limit agrees with the expected one within this share of it.
inline constexpr double limit_tolerance = 0.02;

/// How far the steps of the open structure were stable, marched, else by the spectrum.
struct OpenLimit {
  std::optional<double> step;  ///< s; none: all were, or none
  double pulsation = 0;        ///< rad/s, of the mode that grows beyond it; 0: none does
  double last = 0;             ///< s, the largest step of the range
  bool unstable = false;       ///< below the range already
};
/// Compares it with the limit that the plan declares, where nothing is damped. Where they differ by more than
/// limit_tolerance the record gets a note and the measure `undeclared_limit`: h·ω up to which steps were stable.
void compare_with_declared(const StepPlan& plan, const SemiDiscrete& problem, const OpenLimit& open,
                           CaseRecord& record);

/// Whether the steps of a range have a limit: all of them are stable where there is none.
enum class RangeLimit { not_made, limit, none, below };
constexpr std::array<const char*, 4> words_of(RangeLimit) {
  return {"", "limit", "none", "below the range"};
}

/// One row of `step_limits`: a case and a contact state.
struct LimitRow {
  std::string id;
  bool closed = false, counted = false;
  RangeLimit prediction = RangeLimit::not_made;
  std::optional<double> predicted;
  RangeLimit observation = RangeLimit::not_made;
  std::optional<double> observed, expected, ratio;
  std::optional<bool> agrees;
  int disagreeing = 0;
  std::string marginal;
  std::optional<double> first_unstable;
  std::string grows;
  std::optional<bool> refused;
};
TableType<LimitRow> step_limits_type();
std::vector<LimitRow> step_limit_rows(const StudyResults& results);

/// step_limits of such rows: one per case and contact state, open before closed. A scene is open as well as closed: the
/// limit expected of it is the smaller of both predictions. A cell is expected to grow where either radius exceeds one.
/// The open structure does not depend on the contact law: of cases that differ in it alone one is `counted`, the first
/// that was done.
Table step_limits_table(const StudyResults& results, const std::vector<LimitRow>& rows);

/// step_limit_agreement: how many of the counted ranges agree, for the open structure, for closed contact, and for
/// both together.
Table step_limit_agreement_table(const Table& step_limits);

/// stability_cells: each step of each contact state with what was predicted and observed of it.
Table stability_cells_table(const StudyResults& results);

/// stability_disagreements: ranges of neighbouring steps where prediction and observation differ.
Table stability_disagreements_table(const StudyResults& results);

/// One row of `stability_roots`: a root on the unit circle that is the scheme's own, over the steps of a case.
struct RootRow {
  std::string id;
  bool closed = false;
  std::string place, root;
  bool twofold = false;
  double from = 0, to = 0;
  std::size_t steps = 0, of = 0;
  int times = 0;
};
TableType<RootRow> stability_roots_type();

/// Counts the roots of the step h, one of so many, in the rows of `stability_roots`.
void add_roots(std::vector<RootRow>& rows, bool closed, double h, std::size_t of, const StepSpectrum& spectrum);

}  // namespace ricochet
