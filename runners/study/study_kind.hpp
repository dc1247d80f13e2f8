#pragma once
#include <functional>
#include <string>
#include <vector>

#include "runners/study/fields.hpp"

namespace ricochet {

/// What a kind of study adds to the study format. The format itself knows no kind by name: it asks these.
///
/// A kind that has the key `step` (an axis, s) or `steps_per_period` (an axis) has it as a column of its cases. One
/// that has `duration`, `samples` or `reference` finds them in StudyCase. All functions but `settings` may be empty.
struct StudyKind {
  std::string name;           ///< the word after "kind"
  std::string text;           ///< what is made of each case, one sentence
  std::vector<Field> keys;    ///< in addition to those of every study
  bool shows_points = false;  ///< whether it shows the points of a scene

  /// What else determines the results of a case, complete and in a fixed order; null where nothing does. It is part of
  /// the case's id.
  std::function<Json(const Json& resolved)> settings;
  /// Refuses with InputError, by pointer, what the keys one by one cannot say; before any plugin is opened.
  std::function<void(const Json& resolved)> check;
  /// Refuses, at `pointer`, a measure that such a study has not. Empty: any measure of any kind is one.
  std::function<void(const Json& resolved, const std::string& measure, const std::string& pointer)> check_measure = {};
  /// The verbs of `ask` that it answers itself.
  std::vector<std::string> verbs = {};
  /// What a study that asks nothing is asked. Empty: the measures that it observes, by their values.
  std::function<Json(const Json& resolved)> default_asks = {};
  /// Refuses an entry of `ask` with one of these, whose verb stands at `pointer`.
  std::function<void(const Study& study, const Json& ask, const std::string& pointer)> check_ask = {};
  /// The same once the methods are known. `cases`: number of combinations of the axes; `dofs`: of the coarsest mesh.
  std::function<void(const Json& resolved, const Json& settings, const Registry& registry, double cases, int dofs)>
      check_methods;
  /// Whether some scene that the case marches in place of its own is possible, asked where its own is not. Its own is
  /// then not refused: it is never marched. Empty: cases march their own scene.
  std::function<bool(const StudyCase& study_case)> marches_another;
  /// Completes a case before it gets its id.
  std::function<void(const Json& settings, const Registry& registry, StudyCase& study_case)> complete;
  /// Appends cases that references solve; those of the axes then have none. Empty: cases have the study's references.
  std::function<void(const std::vector<MethodChoice>& references, Study& study)> add_references;
  /// Refuses a study none of whose cases could run, once all cases are there.
  std::function<void(const Study& study)> check_cases;
};

/// The kinds of study that this program has, in the order in which they are told. Given by the registry of kinds.
std::vector<const StudyKind*> study_kinds();

/// Throws InputError for what a study asks and cannot be asked. Given by the registry of verbs.
void check_asks(const Study& study);

/// The kind of this name; null where there is none.
const StudyKind* find_study_kind(const std::string& name);

/// The given keys of a study that are there and not null, in this order; null where none is.
Json given_settings(const Json& resolved, const std::vector<std::string>& keys);

}  // namespace ricochet
