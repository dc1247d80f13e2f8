// Tables and sentences on special points, of a study whose points move with known powers.
#include "runners/kinds/continuation/point_tables.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <set>

#include "runners/kinds/continuation/point_words.hpp"
#include "runners/kinds/kind.hpp"
#include "runners/run/finish_run.hpp"
#include "runners/table/table_reader.hpp"
#include "tests/runners/report/synthetic_points.hpp"

using namespace ricochet;
using Catch::Matchers::Contains;

namespace {

template <class Row>
std::vector<Row> of_name(const std::vector<Row>& rows, const std::string& name) {
  std::vector<Row> out;
  std::copy_if(rows.begin(), rows.end(), std::back_inserter(out), [&](const Row& row) { return row.name == name; });
  return out;
}

std::string name_of(const StudyResults& all, const std::string& kind) {
  for (const PointLimitRow& row : point_limits_type().read(all.derived))
    if (row.name.starts_with(kind)) return row.name;
  return "";
}

/// What a study that asks nothing is answered.
asks::Answered answered(const StudyResults& all) {
  const AnalysedResults own(all);
  REQUIRE(own.asked.all.size() == 1);
  return own.asked.all.front().second;
}

}  // namespace

TEST_CASE("limits and orders are those of the law that moves the points") {
  const synthetic::PointLaw law;
  const StudyResults all = with_tables(synthetic::points());
  const std::string fold = name_of(all, "fold"), contact = name_of(all, "first contact");
  CHECK(fold == "fold at 0.1006");
  CHECK(contact == "first contact at 0.07918");
  const auto limits = of_name(point_limits_type().read(all.derived), fold);
  REQUIRE_FALSE(limits.empty());
  // The reference: rigid stops, 20 elements, 8000 steps.
  const PointLimitRow& row = limits.front();
  CHECK(row.id == "smooth0-20-8000");
  REQUIRE(row.low);
  CHECK(*row.low <= law.fold);
  CHECK(law.fold <= *row.high);
  // Two meshes tell no order: the mesh leaves open by how much they differ, 0.1 (10^-3.8 − 20^-3.8).
  CHECK(*row.mesh_open == Approx(0.1 * (std::pow(10, -3.8) - std::pow(20, -3.8))).epsilon(1e-6));
  // Three numbers of steps tell one order: what first order would leave, three times the second's at ratio 2.
  CHECK(*row.step_open == Approx(3 * 279.2 / 8000 / 8000).epsilon(1e-3));
  CHECK_FALSE(row.law_open);
  CHECK_FALSE(row.reference);
  int steps = 0, springs = 0;
  for (const PointOrderRow& order : of_name(point_orders_type().read(all.derived), fold)) {
    if (order.refined == "steps_per_period") {
      CHECK(order.verdict == order_told);
      CHECK(*order.low <= 2);
      CHECK(2 <= *order.high);
      CHECK(order.used == 3);
      ++steps;
    } else if (order.refined == "contact.stiffness") {
      // 1e4 N/m has another fold: two levels are left.
      CHECK(order.sizes == 2);
      CHECK(order.verdict == order_not_told);
      ++springs;
    } else {
      CHECK(order.refined == "elements");
      CHECK(order.verdict == order_not_told);
    }
  }
  CHECK(steps >= 3);
  CHECK(springs == 2);
}

TEST_CASE("a case that went past a point says how far, and points then are not robust") {
  const StudyResults all = with_tables(synthetic::points());
  const std::string fold = name_of(all, "fold"), contact = name_of(all, "first contact");
  int absent = 0;
  for (const PointPresenceRow& row : of_name(point_presence_type().read(all.derived), fold)) {
    INFO(row.id);
    CHECK_FALSE(row.robust);
    if (row.id.starts_with("rough") && row.id.find("-10-") != std::string::npos) {
      CHECK(row.presence == "absent");
      // The branch went on to 1.9·0.526 of the way from 0.08 to 0.125 m.
      CHECK(*row.passed_to == Approx(0.08 + 0.526 * 1.9 * 0.045));
      ++absent;
    } else if (row.id.find("10000-") != std::string::npos) {
      CHECK(row.presence == "not reached");
      CHECK_FALSE(row.points);
    } else {
      CHECK(row.presence == "found");
      CHECK(row.points == 1);
    }
  }
  CHECK(absent == 12);
  for (const PointPresenceRow& row : of_name(point_presence_type().read(all.derived), contact)) CHECK(row.robust);
}

TEST_CASE("shifts are those of one choice at a time") {
  const StudyResults all = with_tables(synthetic::points());
  std::set<std::string> choices;
  for (const PointShiftRow& row : of_name(point_shifts_type().read(all.derived), name_of(all, "fold"))) {
    choices.insert(row.choice);
    CHECK(*row.low <= *row.shift);
    CHECK(*row.shift <= *row.high);
    if (row.id == "smooth100000-20-8000") {
      CHECK(row.choice == "contact");
      CHECK(*row.shift == Approx(-1.1e-4).epsilon(1e-6));
    }
    if (row.id == "rough0-20-8000") CHECK(*row.shift == Approx(-3e-5).epsilon(1e-6));
  }
  CHECK(choices == std::set<std::string>{"mass", "contact", "elements", "steps_per_period"});
}

TEST_CASE("names stand in special_points, of ends nowhere") {
  const StudyResults all = with_tables(synthetic::points());
  int named = 0;
  for (const SpecialRow& row : special_points_type().read(all.derived)) {
    if (row.kind == PointKind::end) CHECK(row.name.empty());
    named += !row.name.empty();
    // The fold of the softest stop has no counterpart in the finest two cases of the reference.
    if (row.kind == PointKind::fold && row.id.find("10000-") == std::string::npos) CHECK(row.name == "fold at 0.1006");
  }
  CHECK(named > 0);
}

TEST_CASE("the order of cases changes no number and no sentence") {
  const StudyResults all = with_tables(synthetic::points());
  StudyResults shuffled = synthetic::points();
  // The first method stays the first: it is the reference.
  std::mt19937 random(3);
  std::shuffle(shuffled.cases.begin() + 1, shuffled.cases.end(), random);
  shuffled = with_tables(std::move(shuffled));
  const auto sorted = [](const StudyResults& results) {
    std::vector<std::string> out;
    for (const PointLimitRow& row : point_limits_type().read(results.derived))
      out.push_back(row.name + row.id + Cell(row.limit).text() + Cell(row.low).text());
    for (const PointPresenceRow& row : point_presence_type().read(results.derived))
      out.push_back(row.name + row.id + row.presence);
    std::sort(out.begin(), out.end());
    return out;
  };
  CHECK(sorted(all) == sorted(shuffled));
}

TEST_CASE("one case names nothing, and says so") {
  StudyResults one = synthetic::points();
  one.cases = {one.cases[5]};
  one = with_tables(std::move(one));
  CHECK(point_limits_type().read(one.derived).empty());
  const asks::Answered out = answered(one);
  // One case knows nothing of what its step leaves open: a value, no interval.
  CHECK_THAT(out.sentence, Contains("folds at 0.1006,"));
  CHECK(
      std::none_of(out.rows.begin(), out.rows.end(), [](const asks::VerdictRow& row) { return row.low.has_value(); }));
  CHECK(std::any_of(out.rows.begin(), out.rows.end(), [](const asks::VerdictRow& row) {
    return row.reason.find("no second case confirms it") != std::string::npos;
  }));
}

TEST_CASE("a study without orbits says why") {
  StudyResults none = synthetic::points();
  none.cases = {none.cases.front()};
  SpecialRow row;
  row.branch = "orbit-1";
  row.point = 1;
  row.kind = PointKind::end;
  row.parameter = 0.08;
  row.note = "no orbit of period 1 within 30 iterations";
  none.cases[0].tables = {branches_type(4).with({}), special_points_type().with({row}), turns_type().with({})};
  none = with_tables(std::move(none));
  CHECK(answered(none).sentence == "Open: no periodic orbit was found: no orbit of period 1 within 30 iterations.");
  StudyResults nothing;
  nothing.kind = "continuation";
  CHECK_NOTHROW(with_tables(nothing));
}

TEST_CASE("values are said to the digits that their intervals bear") {
  CHECK(point_value(0.1005653, 1.2e-6) == "0.1005653 ± 1.2e-6");
  CHECK(point_value(0.1005653, 3e-5) == "0.10057 ± 3e-5");
  CHECK(point_value(0.07917924475, 2e-9) == "0.079179245 ± 2e-9");
  CHECK(point_value(-2.64, 0.3) == "−2.6 ± 0.3");
  CHECK(point_value(0.1005653, std::nullopt) == "0.1005653");
}

TEST_CASE("folds of one case alone are listed from 25 times what the two finest steps disagree about") {
  for (const bool given : {false, true}) {
    StudyResults all = synthetic::points();
    if (given) all.study["prominence"] = 1e-5;
    for (CaseRecord& record : all.cases) {
      if (record.id != "smooth0-20-8000") continue;
      std::vector<SpecialRow> points = special_points_type().read(record.tables);
      SpecialRow fold = points.front();
      fold.kind = PointKind::fold;
      // 4000 and 8000 steps differ in turns of 2.2e-5 m: 5.4e-4 m.
      for (const double prominence : {1e-4, 1e-3}) {
        fold.point = static_cast<int>(points.size()) + 1;
        fold.parameter = fold.low = fold.high = 0.09 + prominence;
        fold.prominence = prominence;
        points.push_back(fold);
      }
      *find_table(record.tables, special_points_type().name) = special_points_type().with(points);
    }
    all = with_tables(std::move(all));
    std::vector<double> alone;
    for (const SpecialRow& row : special_points_type().read(all.derived))
      if (row.id == "smooth0-20-8000" && row.kind == PointKind::fold && row.name.empty())
        alone.push_back(*row.prominence);
    CHECK(alone == (given ? std::vector<double>{1e-4, 1e-3} : std::vector<double>{1e-3}));
  }
}
