#pragma once
#include <fmt/format.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "runners/answers/answer.hpp"
#include "runners/answers/numbers_in_words.hpp"
#include "runners/kinds/sweep/motion_asks.hpp"
#include "runners/kinds/sweep/sweep_tables.hpp"

namespace ricochet {

/// How a case compares with the reference.
struct Likeness {
  const CaseRecord* record = nullptr;
  int same = 0, decided = 0, all = 0;  ///< motions of the reference: found, decided in both, all
  std::optional<double> distance;      ///< median over values and starts
  double share() const { return all > 0 ? static_cast<double>(same) / all : 0; }
  /// At least 0.9 of all motions, or 0.01 away with none contradicted.
  bool same_diagram() const { return share() >= 0.9 || (distance && *distance <= near && same == decided); }
  /// No more than 0.01 away, and a quarter of what is decided contradicts at most: long periods and chaos part first.
  bool nearly_same() const { return !same_diagram() && distance && *distance <= near && 4 * same >= 3 * decided; }
  static constexpr double near = 0.01;
};

/// Values next to each other with one motion.
struct MotionRun {
  double from = 0, to = 0;
  std::string motion;
};

class DiagramSpeaker {
 public:
  explicit DiagramSpeaker(const answers::Compared& study)
      : study_(study), results_(study.results()), verdicts_(verdicts_type().read(results_.derived)) {
    for (const CaseRecord& record : results_.cases) by_id_[record.id] = &record;
    const std::vector<DistanceRow> distances = distances_type().read(results_.derived);
    find_reference(distances);
    if (!reference_) return;
    compare(distances);
    read_motions();
  }

  void say_methods(answers::Answer& answer) const;
  void say_steps(answers::Answer& answer) const;
  void say_robust(answers::Answer& answer) const;
  void say_motions(answers::Answer& answer) const;
  void say_changes(answers::Answer& answer) const;
  void say_coexistence(answers::Answer& answer) const;
  /// Whether starts are drawn: the study then asks which motions there are beside each other.
  bool random_starts() const;
  void say_speeds(answers::Answer& answer) const;
  /// Whether every interval is the same in all cases, so that the robust part is all of the diagram.
  bool all_robust() const {
    return !others_.empty() && !verdicts_.empty() &&
           std::all_of(verdicts_.begin(), verdicts_.end(),
                       [](const VerdictRow& row) { return row.verdict == "robust"; });
  }
  bool known() const { return reference_ != nullptr; }

 private:
  void find_reference(const std::vector<DistanceRow>& distances);
  void compare(const std::vector<DistanceRow>& of_orbits);
  void read_motions();
  double steps(const CaseRecord& record) const { return axis(record, "steps_per_period").number().value_or(0); }
  bool own_method(const CaseRecord& record) const { return study_.key(record) == study_.key(*reference_); }
  std::string name(const CaseRecord& record, bool with_mesh) const {
    std::string out = study_.name(record);
    const auto elements = study_.elements(record);
    if (with_mesh && study_.varies(study_.mesh_column()) && elements) out += " on " + study_.mesh_words(*elements);
    return out;
  }
  std::string told(const Likeness& one) const;
  answers::Clause clause(const char* form, const Likeness& one, const std::string& who) const;
  std::string parameter_unit() const { return unit_.empty() ? "" : " " + unit_; }
  std::string runs_text(const std::vector<MotionRun>& runs) const;
  std::map<double, double> single_impacts(const CaseRecord& record) const;

  const answers::Compared& study_;
  const StudyResults& results_;
  std::vector<VerdictRow> verdicts_;
  std::map<std::string, const CaseRecord*> by_id_;
  const CaseRecord* reference_ = nullptr;
  std::vector<Likeness> others_;
  std::string start_, parameter_, unit_;
  std::vector<MotionRun> runs_, values_;  ///< of the reference: runs of one motion, and each value
};

}  // namespace ricochet
