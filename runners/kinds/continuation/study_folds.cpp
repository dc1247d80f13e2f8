// Folds over the cases of a study: which ones a step invents.
#include <algorithm>
#include <cmath>

#include "runners/kinds/continuation/study_points.hpp"

namespace ricochet {

std::optional<double> StudyPoints::end_of(std::size_t owner, const std::string& branch) const {
  for (const StudyPoint& one : points_)
    if (one.owner == owner && one.kind == PointKind::end && one.row.branch == branch) return one.row.parameter;
  return std::nullopt;
}

StudyPoints::FoldCounts StudyPoints::folds(std::size_t owner, std::size_t other) const {
  constexpr double same_end = 0.01;  // of the range
  FoldCounts out;
  for (const TurnRow& row : turns_[owner]) {
    const auto own = end_of(owner, row.branch), theirs = end_of(other, row.branch);
    if (!own || !theirs || std::abs(*own - *theirs) > same_end * range_) continue;
    out.all[row.prominence] += row.folds;
    int& nameless = out.nameless[row.prominence];
    nameless += row.folds;
    for (const StudyPoint& one : points_)
      nameless -= one.owner == owner && one.name >= 0 && one.kind == PointKind::fold && one.row.branch == row.branch &&
                  one.row.prominence.value_or(0) >= row.prominence;
  }
  return out;
}

std::optional<double> StudyPoints::least_fold() const {
  constexpr double times = 25;
  const auto step =
      std::find_if(axes_.begin(), axes_.end(), [](const RefinedAxis& one) { return one.words == std::string("step"); });
  const auto given = study_.results().study.find("prominence");
  if (step == axes_.end() || (given != study_.results().study.end() && !given->is_null())) return std::nullopt;
  const auto axis = static_cast<std::size_t>(step - axes_.begin());
  std::vector<std::size_t> steps = along(root_, axis);
  std::sort(steps.begin(), steps.end(), [&](std::size_t a, std::size_t b) { return size(a, axis) < size(b, axis); });
  if (steps.size() < 2) return std::nullopt;
  const auto finest = folds(steps[0], steps[1]).nameless, next = folds(steps[1], steps[0]).nameless;
  std::optional<double> largest;
  for (const auto& [prominence, count] : finest)
    if (const auto same = next.find(prominence); same != next.end() && same->second != count) largest = prominence;
  if (largest) *largest *= times;
  return largest;
}

}  // namespace ricochet
