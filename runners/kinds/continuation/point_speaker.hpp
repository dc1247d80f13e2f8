#pragma once
#include <string>
#include <vector>

#include "runners/answers/answer.hpp"
#include "runners/kinds/continuation/point_tables.hpp"
#include "runners/kinds/continuation/study_points.hpp"

namespace ricochet {

/// What an orbit does at a point of a kind, and the point as a thing.
struct PointWords {
  const char *kind, *does, *thing;
};
const PointWords& point_words(const std::string& kind);
bool is_point_kind(const std::string& kind);
/// The kind of a name that an ask may use: "first contact" of "grazing".
std::string point_kind(std::string asked);
/// Whether two points are of one kind and their intervals overlap.
bool at_one_place(const StudyPoint& a, const StudyPoint& b);

/// "0.1005650 ± 1.2e-6": to the first digit of u, to the second where that is a 1; four digits without u.
std::string point_value(double value, std::optional<double> half);

/// Sentences of a continuation study.
class PointSpeaker {
 public:
  PointSpeaker(const answers::Compared& study, const PointAnalysis& of);

  /// Whether a case left branches.
  bool known() const { return points_.reference() != nullptr; }
  void say_points(answers::Answer& answer) const;
  /// The points of one case where no other confirms them.
  void say_unconfirmed(answers::Answer& answer) const;
  void say_shifts(answers::Answer& answer) const;
  void say_absent(answers::Answer& answer) const;
  void say_turns(answers::Answer& answer) const;
  /// How far branches went, and why those that end inside the range do.
  void say_ends(answers::Answer& answer) const;
  /// Why no branch began.
  void say_nothing(answers::Answer& answer) const;

 private:
  /// Those of a case that can be told, what lies at one place once.
  std::vector<const StudyPoint*> distinct_of(std::size_t owner) const;
  /// What the first orbits of the finest case are, where no branch has a special point.
  void say_orbits(answers::Answer& answer) const;
  std::string subject(const ToldPoint& told) const;
  /// "folds at 0.10057 ± 3e-5 m", and its orders and the reference's value in parentheses.
  std::string place_words(const ToldPoint& told, answers::Sentence& said) const;
  std::string facts_words(const ToldPoint& told, answers::Sentence& said) const;
  std::string case_words(const CaseRecord& record) const;
  std::string unit() const { return unit_.empty() ? "" : " " + unit_; }
  const CaseRecord* record(const std::string& id) const;

  const answers::Compared& study_;
  const PointAnalysis& of_;
  const StudyPoints& points_;
  const std::vector<ToldPoint>& told_;
  std::string unit_;
};

}  // namespace ricochet
