#pragma once
#include <ricochet/contract/registry.hpp>

#include "runners/kinds/kind.hpp"
#include "runners/study/fields.hpp"
#include "runners/study/study.hpp"

/// \file
/// What the kinds that go through a parameter share: keys, settings, what they refuse before anything runs.
namespace ricochet {

/// How long an orbit is marched and what is read of it: transient, keep, section, phase.
std::vector<Field> orbit_keys();

/// from, to, count; `what`: what count numbers.
ObjectForm swept_range(const char* what);

/// pointer: what the values replace.
Field swept_pointer();

// What the kinds that go through a parameter have in common as kinds.

/// Format, runner, tables and study-of-one-case of a kind that goes through a parameter.
class SweepKind : public Kind {
 public:
  CaseRunner start(const RunContext& context) const override;
  Analysis analysis(StudyResults& results, const Choices& study) const override;
  std::string contradiction(const CaseRecord& record) const override;
  nlohmann::ordered_json alone(const StudyResults& results, const CaseRecord& record) const override;
  bool has_points() const override { return true; }

 protected:
  /// `verbs`: of `ask`, that it answers itself, checked by `check_ask`. `default_asks`: what a study that
  /// asks nothing is asked; may be empty.
  SweepKind(const char* name, const char* text, std::vector<Field> keys, std::vector<std::string> verbs,
            std::function<void(const Study& study, const Json& ask, const std::string& pointer)> check_ask,
            std::function<Json(const Json& resolved)> default_asks, std::vector<MeasureInfo> of_cases = {});

 private:
  /// Runs a case, with the context at which it keeps what would be lost if it were killed.
  virtual CaseRecord run(const StudyCase& study_case, const Registry& registry, const CaseContext& context,
                         const std::atomic<bool>& stop) const = 0;
  /// Appends the tables that compare the cases to results.derived.
  virtual Analysis derive(StudyResults& results) const = 0;
};

/// The measures of orbits.
std::vector<MeasureInfo> orbit_measures();

// What they add to a study: settings, and what they refuse before anything runs.

/// The settings of every case, complete and in a fixed order:
///     bifurcation: parameter {pointer, values}, start, transient, keep, section, phase, exponents, refine, budget
///     basins:      axes [{pointer, values}, {pointer, values}], transient, keep, section, phase, exponents (0),
///     refine,
///                  budget
/// `values` ascending, of a range n values (from·(n−1−i) + to·i)/(n−1), rounded to 12 digits where they stay different.
/// `budget` only where one is given. Throws InputError for a range that is empty or too narrow for its count.
Json sweep_settings(const Json& resolved);

/// The most memory that the results of a study may need, bytes.
inline constexpr double largest_results = 16e9;

/// Refuses, with pointer, what no case of the sweep could do:
///   · a pointer that names a list, or no scalar of the scene or of the methods (the nearest one, and all, are told),
///   · two axes with the same pointer, a start that does not read what the parameter changes,
///   · at_most < periods, more exponents than the state has components, results beyond largest_results.
/// `cases`: number of combinations of the axes; `dofs`: of the coarsest mesh.
void check_sweep(const Json& resolved, const Json& settings, const Registry& registry, double cases, int dofs);

/// Refuses, with the pointer `where`, what names no scalar of the scene or of the methods, or a list.
void check_swept_pointer(const Json& resolved, const std::string& pointer, const std::string& where,
                         const Registry& registry);

/// Marks the cases whose method does not have the parameter as excluded. Writes "swept" where the parameter is an axis
/// of the methods, and notes its declaration in the others. To be called when the cases are there.
void mark_sweep(const Json& settings, const Registry& registry, StudyCase& study_case);

/// Whether the scene is possible at some value of what is swept in it. Its own value is never marched, nor is its
/// initial state where no orbit begins there.
bool some_value_possible(const StudyCase& study_case);

/// What the steps of a case do not resolve of its load (load_changes()), at the first or the last value of what is
/// swept.
std::vector<Said> load_doubts(const StudyCase& study_case);

/// Refuses a study in which no value of any case is possible, or nothing is forced at any value while the section is a
/// strobe.
void check_values(const Study& study);

}  // namespace ricochet
