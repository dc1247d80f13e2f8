#pragma once
#include <functional>
#include <map>
#include <optional>
#include <ricochet/measure/attractors/match_points.hpp>
#include <string>
#include <utility>
#include <vector>

#include "runners/kinds/continuation/continuation_tables.hpp"
#include "runners/report/choices.hpp"

/// \file
/// The special points of a study over its cases: which are the same, and how they move as a case is refined.
namespace ricochet {

/// A special point of a case, and its name. Its owner is one of StudyPoints::cases().
struct StudyPoint : CasePoint {
  PointKind kind = PointKind::end;  ///< that of the row; a change of contact may be a first contact or a lift-off
  SpecialRow row = {};
  int period = 1;  ///< of its orbit
  std::optional<bool> symmetric = {};
  int name = -1;    ///< of StudyPoints::names()
  int sharing = 0;  ///< points of its kind at its place
};

/// A quantity that is refined: steps per period, elements or modes, stiffness of a contact law.
struct RefinedAxis {
  std::string column;
  const char* words = "";                                        ///< "step", "mesh", "stiffness"
  const char* symbol = "";                                       ///< what the order counts: "h", "ℓ", "1/κ"
  std::function<std::optional<double>(const CaseRecord&)> size;  ///< > 0, falls as the case becomes finer
};

/// What a point is called that several cases have.
struct NamedPoint {
  std::string text;                   ///< "fold at 0.1006"
  const StudyPoint* point = nullptr;  ///< that of the case nearest to the reference
};

/// Orders and limit of a named point with one method.
struct PointConvergence {
  struct Along {
    std::size_t axis = 0;  ///< of StudyPoints::axes()
    std::size_t sizes = 0;
    std::size_t finest = 0;  ///< of the cases of the order, which may lie at another mesh than the method's finest
    PointOrder order;
    PointLimit limit;
  };
  std::size_t finest = 0;             ///< the finest case of the method
  const StudyPoint* point = nullptr;  ///< there; null where it has none
  std::vector<Along> along;           ///< axes along which two cases or more have the point
  double value = 0;                   ///< where the limit is expected
  std::optional<double> half;         ///< of its interval; nothing where no refinement tells
};

class StudyPoints {
 public:
  explicit StudyPoints(const Choices& study);
  StudyPoints(const StudyPoints&) = delete;

  const Choices& study() const { return study_; }
  /// Those that left branches.
  const Cases& cases() const { return cases_; }
  /// The finest case of the first method; null without cases.
  const CaseRecord* reference() const { return cases_.empty() ? nullptr : cases_[root_]; }
  std::size_t root() const { return root_; }
  /// In the order of cases, then of their rows.
  const std::vector<StudyPoint>& points() const { return points_; }
  const std::vector<NamedPoint>& names() const { return names_; }
  const std::vector<RefinedAxis>& axes() const { return axes_; }
  /// Length of the range that is followed, in the unit of the parameter.
  double range() const { return range_; }

  /// The point of this name in a case; null where it has none.
  const StudyPoint* find(std::size_t owner, int name) const;
  PointPresence presence(std::size_t owner, int name, std::optional<BranchReach>* passed) const;
  /// The finest case of each method, in the study's order; the method of the reference first.
  const std::vector<std::size_t>& heads() const { return heads_; }
  /// The cases of the head's method that differ from it along this axis alone, itself among them.
  std::vector<std::size_t> along(std::size_t head, std::size_t axis) const;
  PointConvergence convergence(std::size_t head, int name) const;
  /// Folds of a case by prominence, on branches that end where those of another case do: others are not comparable.
  struct FoldCounts {
    std::map<double, int> all, nameless;
  };
  FoldCounts folds(std::size_t owner, std::size_t other) const;
  /// The least fold where the study names no prominence, in the unit of the parameter. It is 25 times the largest turn
  /// without a name that the two finest steps of the reference's method disagree about. There is none with one step, or
  /// where they agree.
  std::optional<double> least_fold() const;
  /// The limit of the cases that an order was told of.
  PointLimit limit(const PointConvergence::Along& along, int name) const {
    return point_limit(levels(along.finest, along.axis, name), along.order);
  }
  /// What the two cases differ in: choices, then refinements.
  std::vector<std::string> differences(std::size_t a, std::size_t b) const;
  /// What a case has of a choice or a refinement, as text.
  std::string level(std::size_t owner, const std::string& choice) const;

 private:
  struct Branch {
    std::string name;
    int period = 1;
    std::optional<bool> symmetric;
    BranchReach reach;
  };
  void read(const CaseRecord& record);
  void find_root();
  void find_heads();
  std::vector<CaseLink> links() const;
  CaseLink link_of(std::size_t c) const;
  void give_names();
  std::vector<PointLevel> levels(std::size_t case_of_chain, std::size_t axis, int name) const;
  std::optional<double> size(std::size_t owner, std::size_t axis) const { return axes_[axis].size(*cases_[owner]); }
  /// Whether a is finer than b: in the mesh, then the stiffness, then the step.
  bool finer(std::size_t a, std::size_t b) const;
  std::optional<double> end_of(std::size_t owner, const std::string& branch) const;

  const Choices& study_;
  std::vector<RefinedAxis> axes_;
  std::vector<std::string> method_columns_;
  Cases cases_;
  std::vector<std::string> method_;            // of each case
  std::vector<std::vector<Branch>> branches_;  // of each case
  std::vector<std::vector<TurnRow>> turns_;    // of each case
  std::vector<StudyPoint> points_;
  std::vector<NamedPoint> names_;
  std::map<std::pair<std::size_t, int>, std::size_t> place_;  // in points_: the first of a case with a name
  std::vector<std::size_t> heads_;
  std::size_t root_ = 0;
  double range_ = 1, tips_ = 0, arcs_ = 0;
};

}  // namespace ricochet
