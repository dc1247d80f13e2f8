#pragma once
#include <optional>
#include <ricochet/measure/attractors/attractors.hpp>
#include <ricochet/measure/attractors/diagram.hpp>
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
  explicit SectionIndex(const NumberTable* table, const SectionColumns& columns, const Series* key,
                        const Series* second = nullptr);
  /// By parameter and start.
  static SectionIndex of_orbits(const CaseRecord& record);
  /// By cell.
  static SectionIndex of_cells(const CaseRecord& record);
  SectionReadings read(double key, const std::string& word) const;
  /// Every point of the table, and of the motions half a period later.
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

}  // namespace ricochet::dynamics
