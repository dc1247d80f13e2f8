#pragma once
#include <map>
#include <optional>
#include <ricochet/measure/attractors/attractors.hpp>
#include <ricochet/measure/statistics/choices.hpp>
#include <string>
#include <utility>
#include <vector>

#include "runners/kinds/sweep/sweep_tables.hpp"
#include "runners/store/record.hpp"
#include "runners/table/table_reader.hpp"

/// \file
/// What the cases of a bifurcation study left, in the shape that comparisons need: cases × values × starts.
namespace ricochet::dynamics {

using Json = nlohmann::ordered_json;

/// Tip and mirrored tip of one run's section, in SI units.
struct SectionReadings {
  std::vector<CloudPoint> points, opposite;  ///< `opposite` is as long, or empty
};

/// The sections of one case: a table of numbers, by two keys (parameter and start, or cell and nothing).
class SectionIndex {
 public:
  SectionIndex() = default;
  /// `word` names the column that holds the second key; "" for none.
  SectionIndex(const CaseRecord& record, const std::string& table, const std::string& key, const std::string& word);
  SectionReadings read(double key, const std::string& word) const;
  const NumberTable* table() const { return table_; }
  /// Column of that name; null where the table has none.
  const std::vector<double>* column(const std::string& name) const { return table_ ? table_->numbers(name) : nullptr; }

 private:
  using Range = std::pair<std::size_t, std::size_t>;
  const NumberTable* table_ = nullptr;
  std::map<std::pair<double, std::string>, std::vector<Range>> ranges_;
};

/// What one value of the parameter and one start came to.
struct Run {
  double parameter = 0;
  int value = 0, start = 0;  ///< indices into Diagram::values and Diagram::starts
  int kind = -1;             ///< index into Diagram::kinds; < 0: undecided or failed, and never an attractor
  int period = 0;            ///< of a periodic run
  std::string regime, status;
  std::optional<bool> symmetric;
  std::optional<double> viscosity;  ///< alpha_equivalent, s
  int attractor = 0;                ///< from 1; 0: none
  std::size_t row = 0;              ///< of the case's table
  bool decided() const { return kind >= 0; }
};

/// One case with its runs in the order of its table.
struct CaseRuns {
  const CaseRecord* record = nullptr;
  const Table* table = nullptr;
  SectionIndex sections;
  std::vector<Run> runs;
  std::vector<int> at;  ///< value × starts + start → index into runs, −1 where there is none
  bool any_decided = false;
};

/// The whole study.
struct Diagram {
  const StudyResults* results = nullptr;
  SweptColumns swept;
  std::string parameter;  ///< in the study's words: "support.amplitude"
  bool strobed = true;
  std::vector<double> values;  ///< of all cases, ascending
  std::vector<std::string> starts, kinds;
  std::vector<CaseRuns> cases;   ///< those with a table of values
  std::vector<ChoiceAxis> axes;  ///< one per column of the study, a level for each of `cases`
  CloudPoint scale = {1, 1};
  int attractors = 0;  ///< identities run from 1 to this

  const Run* run(std::size_t case_index, int value, int start) const;
  /// Class of a kind in words: "periodic 2", "chaotic".
  const std::string& kind_name(int kind) const { return kinds[static_cast<std::size_t>(kind)]; }
};

/// Reads the cases. Points are only looked at for the scale.
Diagram read_diagram(const StudyResults& results);

/// The section of a run, ready to be compared. Where it is periodic: the points of its cycle.
SettledSection settled_section(const Diagram& diagram, const CaseRuns& owner, const Run& run);
/// How far a run is from itself.
HalvesNull null_of(const Diagram& diagram, const CaseRuns& owner, const Run& run);

/// Index of the reference case; none where no case has anything decided.
std::optional<std::size_t> reference_case(const Diagram& diagram);

/// α of a run (s); nothing where the study has no such number.
std::optional<double> viscosity_of(const Diagram& diagram, const CaseRuns& owner, const Run& run);

/// The axes of the study, with a level for each of the cases.
std::vector<ChoiceAxis> axes_of(const StudyResults& results, const std::vector<const CaseRecord*>& cases);

}  // namespace ricochet::dynamics
