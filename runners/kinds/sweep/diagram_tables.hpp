#pragma once
#include <optional>
#include <ricochet/measure/attractors/attractors.hpp>
#include <ricochet/measure/attractors/diagram.hpp>
#include <ricochet/measure/statistics/choices.hpp>
#include <string>
#include <utility>
#include <vector>

#include "runners/json/json_text.hpp"
#include "runners/kinds/sweep/sweep_tables.hpp"
#include "runners/store/record.hpp"
#include "runners/table/table_reader.hpp"

/// \file
/// A bifurcation study as a diagram, and the steps of derive_dynamics(), each on what the one before it left.
namespace ricochet::dynamics {

// What the cases of a bifurcation study left, in the shape that comparisons need: cases × values × starts.

/// Tip and mirrored tip of one run's section, in SI units.
struct SectionReadings {
  std::vector<CloudPoint> points, opposite;  ///< `opposite` is as long, or empty
};

/// The sections of one case: a table of numbers, by two keys (parameter and start, or cell and nothing).
class SectionIndex {
 public:
  SectionIndex() = default;
  explicit SectionIndex(const NumberTable* table, const SectionColumns& columns, const Series* key,
                        const Series* second = nullptr);
  /// By parameter and start.
  static SectionIndex of_orbits(const CaseRecord& record);
  /// By cell.
  static SectionIndex of_cells(const CaseRecord& record);
  SectionReadings read(double key, const std::string& word) const;
  /// Every point of the table, and of the motions half a period before their strobes.
  void add_points(ScaleOfPoints& scale) const;
  const NumberTable* table() const { return table_; }

 private:
  struct Range {
    double key = 0, word = 0;  ///< the second one as it is stored
    std::size_t first = 0, last = 0;
  };
  static bool before(const Range& a, const Range& b);

  const NumberTable* table_ = nullptr;
  SectionColumns columns_;
  const std::vector<std::string>* words_ = nullptr;
  std::vector<Range> ranges_;  // sorted
};

/// What a case of the diagram was read from.
struct DiagramSource {
  const CaseRecord* record = nullptr;
  const Table* table = nullptr;
  SectionIndex sections;
  std::vector<OrbitRow> orbits = {};   ///< rows of the table
  std::vector<std::size_t> rows = {};  ///< of the runs, in the table
};

/// The whole study: its diagram, beside what it was read from.
struct StudyDiagram {
  const StudyResults* results = nullptr;
  SweptColumns swept;
  std::string parameter;  ///< in the study's words: "support.amplitude"
  bool strobed = true;
  Diagram diagram;                     ///< of the cases with a table of values
  std::vector<DiagramSource> sources;  ///< of these cases
  std::vector<ChoiceAxis> axes;        ///< one per column of the study, a level for each of these cases
  CloudPoint scale = {1, 1};

  const CaseRecord& record(std::size_t case_index) const { return *sources[case_index].record; }
};

/// Reads the cases. Points are only looked at for the scale.
StudyDiagram read_diagram(const StudyResults& results);

/// The section of a run, ready to be compared. Where it is periodic: the points of its cycle.
SettledSection settled_section(const StudyDiagram& study, std::size_t case_index, const DiagramRun& run);
/// How far a run is from itself.
HalvesNull null_of(const StudyDiagram& study, std::size_t case_index, const DiagramRun& run);

/// α of an orbit of a case at a value of the parameter (s); nothing where the study has no such number.
std::optional<double> viscosity_of(const StudyResults& results, const CaseRecord& record, double parameter);

/// The class of a row of a table of the cases: `failed` where its status is not done, undecided where it names none.
MotionClass motion_of(const std::string& regime, std::optional<double> period, const std::string& status);

/// The axes of the study, with a level for each of the cases.
std::vector<ChoiceAxis> axes_of(const StudyResults& results, const std::vector<const CaseRecord*>& cases);

// The steps of derive_dynamics(), each on the diagram that the one before it left.

/// Fills in the attractor of every decided run. Returns `distances`: every run against the reference case's from the
/// same start, made on the way (a section is prepared once).
Table find_attractors(StudyDiagram& study);

/// Which choice an attractor hangs on, in words.
struct PresenceLabel {
  std::string label, presence, sentence;  ///< of the table `attractors`; the sentence begins in the middle
};
/// Of judge_presence(): "common to all", "vanishes under refinement", "depends on AXIS", "depends on several choices",
/// "not compared".
PresenceLabel label_presence(const Presence& presence, const std::vector<ChoiceAxis>& axes);

Table attractors_table(const StudyDiagram& study);
Table verdicts_table(const StudyDiagram& study);
Table agreement_table(const StudyDiagram& study);
Table shifts_table(const StudyDiagram& study);
/// class_counts: for each case and class, the orbits that have it.
Table class_counts_table(const StudyDiagram& study);
/// numerical_viscosity: for each case, what its scheme adds to the viscosity of the scene.
Table numerical_viscosity_table(const StudyDiagram& study);

/// "signorini with 0.5": the levels of a case on the chosen axes.
std::string level_name(const std::vector<ChoiceAxis>& axes, const std::vector<std::size_t>& chosen, std::size_t c);
/// "0.0791792".
std::string six_digits(double value);
/// "83 %"; "0.4 %".
std::string percent(double share);
/// "1 case", "3 cases".
std::string count_of(std::size_t count, const std::string& one);

}  // namespace ricochet::dynamics

namespace ricochet {

// Tables of a bifurcation diagram, or of an image of basins, that show what the methods do to it. They are worked out
// of the `values`, `bifurcations` and `points` (or `cells` and `cell_points`) that the cases leave.
//
// Clouds of section points live in (tip displacement, tip velocity), without unit. Each is divided by its standard
// deviation over all section points of the study and the motions' places half a period before. A study of one orbit is
// so measured against its motion. Clouds of more than 64 points are thinned evenly to that. See
// core/measure/attractors: attractors.hpp (distances, their null, what counts as one attractor at one value, along the
// parameter) and basin_grid.hpp.
//
// *Reference case*: of the cases with anything to compare with, the one with the stiffest contact. The law tells how
// stiff it is; a rigid one is the stiffest. Then count the most steps per period, the most elements, the most modes,
// and the first of the study.
//
// What the columns of these tables mean is declared in sweep_tables.hpp. A change of `shifts` is matched with one of
// the same kind, classes and start: the nearest within a tenth of the values' range. Changes from or to "undecided" are
// left out. Intervals of verdicts touch: they end half way between two values. Of kind `basins` a motion and its mirror
// image are one attractor.

/// Whether a table of the cases is among those that are collected.
bool derived_as_dynamics(const std::string& table);

/// The motions of a sweep, as asks look at them.
struct SweptMotions {
  Diagram diagram;                         ///< its attractors numbered
  std::vector<const CaseRecord*> records;  ///< of its cases
};

/// Appends the tables of a bifurcation diagram to results.derived; an unfinished study has partial ones. Failed values
/// make no attractor.
SweptMotions derive_dynamics(StudyResults& results);

}  // namespace ricochet
