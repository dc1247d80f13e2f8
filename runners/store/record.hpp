#pragma once
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <ricochet/contract/said.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "runners/store/status.hpp"
#include "runners/study/study.hpp"
#include "runners/table/number_table.hpp"
#include "runners/table/table.hpp"

namespace ricochet {

/// Sampled series of one case: columns of equal length, in the order of `names`.
struct Curve {
  std::vector<std::string> names;
  std::vector<Series> columns;
};

/// What one case left behind: a row of cases.csv, and its curve.
struct CaseRecord {
  std::string id;
  std::vector<std::pair<std::string, nlohmann::ordered_json>> axes;
  Status status = Status::failed;
  /// Why it is not done, one; of a done one what makes its figures doubtful, none where nothing does.
  std::vector<Said> reasons;
  bool excluded = false;  ///< by the study itself, which says why
  long long steps = 0;
  double setup_seconds = 0, run_seconds = 0;
  std::vector<std::pair<std::string, double>> measures;  ///< in a fixed order, finite (an absent measure is left out)
  std::vector<std::pair<std::string, std::string>> left_out;  ///< item, reason
  std::vector<std::string> notes;
  std::string operator_name;  ///< what compile chose: diagonal, modal, band, sparse
  Curve curve;
  std::vector<Table> tables;         ///< rows of its own, without the case's axes (stability.csv)
  std::vector<NumberTable> numbers;  ///< its large tables (points.csv, impacts.csv)
  std::string arithmetic;            ///< digest of the arithmetic that computed it; "": not known
  bool partial = false;              ///< saved while the case was running: what it had by then

  /// Its reasons in one text: "excluded: …", "…; …"; "" for none.
  std::string reason() const;
};

/// Whether a reference solved the case, and none of the study's methods.
inline bool is_reference(const CaseRecord& record) {
  return record.id.starts_with(reference_id);
}

/// How a note of a case begins that names a reference that does not apply, and says why.
inline constexpr const char* refused_reference = "reference that does not apply: ";

/// The entry of an environment that is the time at which its run began.
inline constexpr const char* kStarted = "started";

/// Where and with what the figures were made.
struct Environment {
  std::vector<std::pair<std::string, std::string>>
      entries;  ///< program, commit, compiler, flags, processor, cores, libraries …
};

/// What a store says of a study beside its cases.
struct StudyHeader {
  nlohmann::ordered_json study;  ///< resolved study
  std::string name, question, kind;
  std::vector<std::string> columns;  ///< axis columns of cases.csv, in order
  std::vector<Column> axes = {};     ///< what is known of them beyond the study format: parameters of methods
  std::map<std::string, std::string> method_words = {};  ///< see Study
  int expected_cases = 0;
  StudyPart part = {};  ///< of which these are the cases
  Environment environment;
};

/// What of a store is not as it was stored.
struct Damage {
  std::set<std::string> cases;  ///< ids, as they stand there
  bool environment = false;
  bool pages = false;  ///< the file has pages that cannot be read

  bool any() const { return !cases.empty() || environment || pages; }
  void merge(Damage other) {
    cases.merge(other.cases);
    environment = environment || other.environment;
    pages = pages || other.pages;
  }
};

/// Everything a store holds, which is everything a report is made from.
struct StudyResults : StudyHeader {
  std::vector<CaseRecord> cases;  ///< in the study's order; those not run yet are absent
  std::vector<Table> derived;     ///< worked out of the cases when they are read, not stored
  Damage damage = {};             ///< what of the store is left out, because it is not as it was stored
};

/// What a measure of a case means, as the kinds of study declare theirs (also the report's tooltips).
struct MeasureInfo {
  /// A measure of the computation (its time, its reference) says nothing of the motion: no effect of a choice is sought
  /// in it.
  enum class Of { motion, computation };
  const char* name;
  const char* unit;
  const char* text;
  Of of = Of::motion;
  bool aside = false;  ///< a first look at the table of cases leaves it out
  /// The measure of the same case that differences of this one are shares of; "1": it is a share itself; "": its own
  /// largest value.
  const char* scale = "";
  /// How an answer speaks of it.
  struct Reading {
    const char* words = "";            ///< "energy lost at the stops"; "": words of its name
    int direction = 0;                 ///< 1: more is better, −1: less is, 0: neither
    std::optional<double> truth = {};  ///< exact where nothing but contact changes energies, and the direction then
    bool decades = false;              ///< differences are factors, not shares
  };
  Reading reading = {};
  /// Whether each step and mesh has its own, as a step limit has: refinement leads it to no limit.
  bool of_each_size = false;
  /// Of a time that is counted in whole steps: how many it may be off by, "1" or the measure that counts them.
  const char* whole_steps = "";
  const char* floor = "";  ///< the measure of the same case that says what it is uncertain by; "": none
  bool where_met = false;  ///< cases.csv has it only where a case has one
  /// Of a measure of a stop that is blank while nothing touches it: the one that stands wherever this one may.
  const char* stands_with = "contact_time";
  bool mean = false;  ///< over a window: of draws of a load their mean is meant, and no single draw
};

/// The measures of all kinds, in order. Given by the registry of kinds.
const std::vector<MeasureInfo>& all_measures();
/// Those that stand in cases.csv of a study of this kind even where no case has one. Given by the registry of kinds.
std::vector<std::string> standing_measures(const std::string& kind);
/// What a measure means; null for one that nothing is known of.
const MeasureInfo* measure_info(const std::string& name);

}  // namespace ricochet
