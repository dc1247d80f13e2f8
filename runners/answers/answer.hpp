#pragma once
#include <optional>
#include <string>
#include <vector>

#include "runners/report/choices.hpp"
#include "runners/store/study_tables.hpp"

namespace ricochet::answers {

/// The form of a clause whose methods do not differ.
inline constexpr const char* alike = "none";

/// A sentence with what it says as numbers; at least one clause.
struct Sentence {
  std::string text;
  std::vector<Clause> clauses;
};

/// What a study says, in the order in which it is read.
struct Answer {
  std::vector<Sentence> sentences;
  /// Adds a sentence with one clause.
  void say(std::string text, Clause clause);
  void say(Sentence sentence) { sentences.push_back(std::move(sentence)); }
  Table table() const;
};

/// References that the study names and that refuse, a sentence each: errors are those against the others.
std::vector<Sentence> refused_references(const Choices& study);
/// What makes figures of finished cases doubtful: the sentence of the first case; of the others it may differ in
/// numbers.
struct Doubt {
  std::string text;
  bool differs = false;  ///< between cases, in its numbers
  Cases cases;
};
/// Doubts by kind, in the order of the study.
std::vector<Doubt> doubts_of(const StudyResults& results);
/// The same, a sentence each: "Doubtful: 2 of 3 cases (…): …"; of more than four kinds three.
std::vector<Sentence> doubted(const Choices& study);

/// That nothing moved; or that no case touched a stop, with the largest displacement against the gap. Nothing where one
/// did, or has no stops.
std::optional<Sentence> say_untouched(const Choices& study);

/// Why there is no value of what is known by works alone.
inline constexpr const char* no_work_form = "the scheme declares no work form";
/// Whether a case that ran has no value of what is told in contact alone, since nothing ever touched its stop.
bool of_untouched_stop(const std::string& measure, const CaseRecord& record);
/// Why a case that ran has no value of a measure; "" where that is not known.
std::string why_without(const std::string& measure, const CaseRecord& record);

/// One row of `limits`: a method and a measure.
struct MeasureLimit {
  std::string measure, id;
  std::optional<double> value = {}, uncertainty = {}, low = {}, high = {};
  std::string unit = {}, status = {};
  std::optional<double> order = {}, step_moves = {}, mesh_moves = {};
  int steps = 0, meshes = 0;
  std::string method = {};
  std::optional<int> tier = {};
  std::optional<double> truth = {};
};
const TableType<MeasureLimit>& limits_type();

/// limits: one row per method and measure.
Table limits_table(const Choices& study, const std::vector<std::string>& measures);
/// refinements: the values that limits rest on, one row per method, measure and size.
Table refinements_table(const Choices& study, const std::vector<std::string>& measures);
/// differences: one row per choice, measure and combination of all other choices.
Table differences_table(const Choices& study, const std::vector<std::string>& measures);

}  // namespace ricochet::answers
