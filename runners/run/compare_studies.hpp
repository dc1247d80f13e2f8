#pragma once
#include <array>
#include <optional>
#include <ricochet/contract/worded.hpp>
#include <string>
#include <vector>

#include "runners/store/record.hpp"

/// \file
/// Two results folders side by side: what was asked differently, and what came out differently.
namespace ricochet {

/// A value that the two have differently; "" where one has none.
struct ChangedText {
  std::string where;  ///< JSON pointer, entry of the environment
  std::string a, b;
};

/// A case of both, by the cases themselves.
struct CasePair {
  const CaseRecord *a = nullptr, *b = nullptr;
};

/// How two numbers differ. `round_off`: by no more than 2⁻⁵² × steps of the measure's scale, what the round-off of an
/// integration may leave. `beyond`: by more.
enum class NumberChange { none, round_off, beyond, missing };
constexpr std::array<const char*, 4> words_of(NumberChange) {
  return {"equal", "within round-off", "beyond round-off", "only in one"};
}

/// A measure of a case of both.
struct MeasureChange {
  std::string measure;
  CasePair pair;
  std::optional<double> a, b;
  double relative = 0;  ///< |b − a| over the measure's scale, the larger of the two; 0 where one is missing
  NumberChange change = NumberChange::none;
};

/// A table of a case of both: of rows, or of columns of numbers.
struct TableChange {
  std::string table;
  CasePair pair;
  bool equal = false;  ///< bitwise, of numbers
};

struct StudyComparison {
  std::vector<ChangedText> inputs, environment;
  bool by_id = true;  ///< cases go together by their ids; else by their values on all axes of both
  std::vector<CasePair> pairs;
  std::vector<const CaseRecord*> only_a, only_b;
  std::vector<MeasureChange> measures;                  ///< of pairs that are done in both, measure by measure
  std::vector<TableChange> tables;                      ///< of the same pairs, case by case
  std::vector<std::string> lines_only_a, lines_only_b;  ///< of the answers

  std::vector<CasePair> status_changes() const;
  std::size_t count(NumberChange change) const;
};

/// The same values for the same axes are the same case, whatever else changed; ids go first, as they also say the
/// scene. Measures of the computation (its time) are no result and are left out. Both outlive what is returned.
StudyComparison compare_studies(const StudyResults& a, const StudyResults& b);

/// The two, and how their inputs and environments differ: how a person begins to read.
std::string facts_text(const StudyComparison& found, const StudyResults& a, const StudyResults& b);
/// What a person reads, at most a screen of it.
std::string comparison_text(const StudyComparison& found, const StudyResults& a, const StudyResults& b);
/// All of it: a row per input, case, measure, table and line.
Table comparison_table(const StudyComparison& found);

// Time schemes side by side, by what studies measured of each.

/// One row per time scheme, with those of its parameters that tell it from others of its name. A cell is the least and
/// the largest value over the cases of the first of these studies that measured it. In brackets stands that study's
/// name less what all their names begin with; nothing where none has. An order counts where its 95 % interval is not
/// wider than 0.5. The cell says of how many cases it does, "not told" where of none. The studies have their derived
/// tables.
Table league_table(const std::vector<StudyResults>& studies);

/// What the names of these studies begin with, up to a hyphen: "family-" of "family-free" and "family-beam".
std::string common_beginning(const std::vector<StudyResults>& studies);

/// A table in Markdown, columns with their units.
std::string markdown(const Table& table);

}  // namespace ricochet
