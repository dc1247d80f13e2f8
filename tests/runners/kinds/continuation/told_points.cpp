// Which special points an answer tells: those where stable orbits end.
#include <algorithm>
#include <catch2/catch.hpp>

#include "runners/kinds/continuation/point_tables.hpp"
#include "runners/kinds/continuation/point_words.hpp"
#include "runners/report/choices.hpp"
#include "runners/run/finish_run.hpp"
#include "runners/table/table_reader.hpp"
#include "tests/runners/report/synthetic_points.hpp"

using namespace ricochet;

namespace {

std::vector<std::string> told_of(const StudyResults& all) {
  const Choices choices(all);
  const PointAnalysis points(choices);
  std::vector<std::string> out;
  for (const ToldPoint& one : points.told) out.emplace_back(word(one.point().kind));
  return out;
}

/// Changes the rows and the points of every case.
template <class Change>
StudyResults changed(const Change& change) {
  StudyResults all = synthetic::points();
  for (CaseRecord& record : all.cases) {
    const Table* branches = find_table(record.tables, branches_name);
    if (!branches) continue;
    std::vector<BranchRow> rows = branch_rows_in(*branches);
    std::vector<SpecialRow> points = special_points_type().read(record.tables);
    const std::vector<TurnRow> turns = turns_type().read(record.tables);
    change(rows, points);
    record.tables = {branches_type(4).with(rows), special_points_type().with(points), turns_type().with(turns)};
  }
  return with_tables(std::move(all));
}

/// Adds a loss of symmetry at the row of the outward branch that lies nearest to this share of its arc.
void add_symmetry(std::vector<BranchRow>& rows, std::vector<SpecialRow>& points, double share) {
  std::vector<BranchRow*> way;
  for (BranchRow& row : rows)
    if (row.branch == "orbit-1+") way.push_back(&row);
  const BranchRow& at = *way[static_cast<std::size_t>(share * static_cast<double>(way.size() - 1))];
  SpecialRow point;
  point.branch = at.branch;
  point.point = 99;
  point.kind = PointKind::symmetry;
  point.parameter = at.parameter;
  point.low = *at.parameter - 1e-6;
  point.high = *at.parameter + 1e-6;
  point.arc = at.arc;
  point.tip_displacement = at.tip_displacement;
  points.push_back(point);
}

}  // namespace

TEST_CASE("points are told where stable orbits end, one of each kind") {
  const StudyResults all = with_tables(synthetic::points());
  CHECK(told_of(all) == std::vector<std::string>{"fold", "torus", "first contact"});
}

TEST_CASE("a point of orbits that are unstable on both sides is not told") {
  const auto with_symmetry = [](double share) {
    return changed([&](auto& rows, auto& points) { add_symmetry(rows, points, share); });
  };
  // Beyond the fold, which stands at 1/1.9 of the way, every orbit is unstable.
  CHECK(told_of(with_symmetry(0.8)) == std::vector<std::string>{"fold", "torus", "first contact"});
}

TEST_CASE("multipliers that flicker for one row do not end stability") {
  const StudyResults all = changed([](auto& rows, auto&) {
    int count = 0;
    for (BranchRow& row : rows)
      if (*row.stable && ++count % 10 == 0) row.stable = false;
  });
  CHECK(told_of(all) == std::vector<std::string>{"fold", "torus", "first contact"});
}

TEST_CASE("where no orbit is stable every point is told") {
  const StudyResults all = changed([](auto& rows, auto& points) {
    for (BranchRow& row : rows) row.stable = false;
    add_symmetry(rows, points, 0.8);
  });
  const std::vector<std::string> told = told_of(all);
  CHECK(std::count(told.begin(), told.end(), "symmetry") == 1);
  CHECK(told.front() == "fold");
}

TEST_CASE("a fold at a first contact is told as the contact") {
  const StudyResults all = changed([](auto&, auto& points) {
    for (std::size_t k = 0; k < points.size(); ++k)
      if (points[k].kind == PointKind::contact) {
        SpecialRow fold = points[k];
        fold.kind = PointKind::fold;
        fold.point = 98;
        fold.prominence = 0.01;
        points.push_back(fold);
        break;
      }
  });
  const std::vector<std::string> told = told_of(all);
  CHECK(std::count(told.begin(), told.end(), "fold") == 1);
  CHECK(std::count(told.begin(), told.end(), "first contact") == 1);
}
