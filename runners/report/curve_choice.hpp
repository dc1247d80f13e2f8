#pragma once
#include <set>
#include <string>

#include "runners/report/case_view.hpp"

namespace ricochet::report {

/// The cases of which a page holds curves over time: all where they fit the charts of a figure (24 rows of cases that
/// differ in the step alone, or 96 cases), else 24 such rows: those with the least and with the most of what the answer
/// speaks of first, and others spread evenly over the study.
class CurveChoice {
 public:
  CurveChoice(const CaseView& view, const StudyResults& all);
  bool holds(const std::string& id) const { return all_ || ids_.count(id) > 0; }
  /// "Curves over time: this page holds those of 70 of 912 cases …", and where the others are; "" where all are held
  /// and each has its file.
  std::string sentence() const;

 private:
  bool all_ = true;
  std::size_t with_curves_ = 0;
  bool files_ = true;
  std::string where_;
  std::set<std::string> ids_;
};

}  // namespace ricochet::report
