#pragma once
#include <string>
#include <vector>

#include "runners/asks/evidence.hpp"

/// \file
/// What verbs on measures have in common: a line for each stop and each combination of levels.
namespace ricochet::asks {

/// One measure of one stop in one combination of levels.
struct Line {
  std::string measure, stop, level;
  Point point;
  std::vector<std::string> attributes = {};  ///< its levels one by one and its stop, in words; all lines alike
  bool one_stop = false;                     ///< whether all lines are of this stop, which the measure's words name

  bool known() const { return point.estimate.has_value(); }
  /// Whether some of its cases could run, and its law leaves the measure a limit; else it decides nothing where others
  /// do.
  bool applies() const;
  const Estimate& estimate() const { return *point.estimate; }
  /// "with hrz, stiffness 1e8 N/m at end": what tells it from the other lines; "".
  std::string place() const;
};

/// All lines of an ask, in one unit.
struct Lines {
  answers::MeasureWords words;  ///< of the measure without its stops
  std::vector<Line> all;
  std::size_t cases = 0, left_out = 0;
  std::vector<std::string> aside;    ///< what is left out, by reason
  std::vector<std::string> without;  ///< why cases have no value: "2 refused: …"

  std::vector<const Line*> known() const;
  bool any_applies() const;
  /// A value of this measure in words, with its unit.
  std::string text(const Estimate& estimate) const;
  std::string number(double value, std::optional<double> u = {}) const;
  /// A value that the user gave, with all its digits.
  std::string given(double value) const;
  /// The line as a row, without a verdict.
  VerdictRow row(const Line& line) const;
};

/// `columns`: that tell levels apart; those that vary where not given.
/// `as_stored`: in the unit of cases.csv, as limits are given; else what is a share of the energy brought in is told
/// so.
Lines lines_of(const Ask& ask, const Evidence& evidence, const std::string& measure, bool as_stored = false);
Lines lines_of(const Ask& ask, const Evidence& evidence, const std::string& measure,
               const std::vector<std::string>& columns, bool as_stored = false);

/// The name of a set of lines out of all: what these have in common and no other has, "with stiffness 1e8 N/m at mid";
/// of a single one its place; "" where there is no such name, and of all.
std::string set_name(const Lines& lines, const std::vector<const Line*>& set);

/// What becomes an answer of such lines: counts and what is left out.
Answered begin_answer(const Lines& lines);

/// The answer of lines without any value: open, where the question has a yes or a no. Nothing where some has one.
std::optional<Answered> without_values(const Lines& lines, Answered begun, bool yes_or_no = true);

/// The answer where no two lines differ in a choice alone: open.
Answered never_alone(Answered begun, const Lines& lines, const std::string& choice);

/// Whether the words of a measure are of several: "impacts at end".
bool is_plural(const std::string& words);

/// "both", "all 3".
std::string all_text(std::size_t count);
/// A level in words; "none" of null.
std::string or_none(const std::string& level);

/// A reason without what its first colon explains: "2 refused".
std::string short_reason(const std::string& reason);

/// "a, b and 3 more".
std::string some_of(const std::vector<std::string>& names, std::size_t most = 2);

/// Refuses a measure that this study has not, by the pointer of `key`.
void check_measure(const Ask& ask, const Study& study, const std::string& key, const std::string& measure);
/// The same of the measure after the verb.
void check_subject(const Ask& ask, const Study& study);
/// Refuses a measure whose stops have different units, as forces and moments.
void check_one_unit(const Ask& ask, const Study& study, const std::string& measure);
/// Refuses a choice or an axis that does not vary, or in which no two cases differ alone.
void check_choice(const Ask& ask, const Study& study, const std::string& key, const std::string& choice);

/// Refuses seeds, which are draws, as the choice after a key: they `why`.
void refuse_seeds(const Ask& ask, const std::string& key, const std::string& why, const std::string& measure);

/// Steps, meshes and seeds of a study, as they were planned.
struct Planned {
  std::size_t steps = 0, meshes = 0, seeds = 0;
  bool one_draw = false;  ///< of a random load, without parts of a window
};
Planned planned(const Study& study);
/// "One step only: no interval, and no verdict."; "".
std::string doubt_of_one_step(const Ask& ask, const Study& study);
/// The same of values, which one draw leaves open too.
std::string doubt_of_values(const Ask& ask, const Study& study);

/// A figure of bars with intervals, one for each line; `at`: a line across, in the unit of the rows.
Json bars(const Lines& lines, const std::vector<double>& at = {});

}  // namespace ricochet::asks
