// The verb `points`: what is asked, in the order of its branch, with how far each branch went.
#include <algorithm>
#include <catch2/catch.hpp>

#include "runners/asks/kind_verbs.hpp"
#include "runners/kinds/continuation/continuation.hpp"
#include "runners/kinds/continuation/point_tables.hpp"
#include "runners/kinds/continuation/point_words.hpp"
#include "runners/run/finish_run.hpp"
#include "tests/runners/report/synthetic_points.hpp"

namespace ricochet::tests_of_points_asks {

using Catch::Matchers::Contains;

namespace {

asks::Answered ask(const StudyResults& results, const std::vector<std::string>& kinds) {
  const Choices choices(results);
  const PointAnalysis points(choices);
  return points_ask(asks::ask_of({{"points", kinds}}, 1), asks::Evidence(choices), points);
}

std::size_t count(const asks::Answered& out, const std::string& measure) {
  return static_cast<std::size_t>(
      std::count_if(out.rows.begin(), out.rows.end(), [&](const auto& row) { return row.measure == measure; }));
}

}  // namespace

TEST_CASE("points of the asked kinds have their value and interval, and every branch its end", "[asks]") {
  const StudyResults all = with_tables(synthetic::points());
  const asks::Answered every = ask(all, {"all"}), folds = ask(all, {"fold"});
  INFO(every.sentence << "\n" << folds.sentence);
  CHECK(count(every, "fold") > 0);
  CHECK(count(folds, "fold") == count(every, "fold"));
  CHECK(folds.rows.size() ==
        count(folds, "fold") + count(folds, "end of the branch") + count(folds, "shift of the fold"));
  CHECK(count(folds, "shift of the fold") > 0);
  CHECK(count(folds, "end of the branch") == count(every, "end of the branch"));
  CHECK(count(folds, "end of the branch") > 0);
  for (const asks::VerdictRow& row : every.rows)
    if (row.measure.starts_with("shift of")) {
      CHECK(row.low.has_value() == (row.verdict != "open"));
      if (row.low) {
        CHECK(*row.low <= *row.value);
        CHECK(*row.value <= *row.high);
      }
    } else if (row.measure != "end of the branch") {
      CHECK_THAT(row.reason, Contains("stable below: "));
      if (row.low) {
        CHECK(*row.low <= *row.value);
        CHECK(*row.value <= *row.high);
      }
    } else {
      CHECK_FALSE(row.low);  // how far it went is no interval
      CHECK(row.verdict != "");
    }
  CHECK(folds.passes == asks::Verdict::yes);
  CHECK_THAT(folds.sentence, Contains("folds at "));
  CHECK_THAT(folds.sentence, Contains("branch"));
}

TEST_CASE("what a second case confirms is told before what one case alone has", "[asks]") {
  const StudyResults all = with_tables(synthetic::points());
  const asks::Answered several = ask(all, {"all"});
  INFO(several.sentence);
  for (const asks::VerdictRow& row : several.rows)
    if (row.measure != "end of the branch" && !row.measure.starts_with("shift of"))
      CHECK(row.low.has_value() != (row.reason.find("no second case confirms it") != std::string::npos));
  CHECK_THAT(several.sentence, Contains(" ± ") && !Contains("no second case"));
  StudyResults first = synthetic::points();
  first.cases.resize(1);
  const asks::Answered single = ask(with_tables(std::move(first)), {"all"});
  INFO(single.sentence);
  CHECK_THAT(single.sentence, Contains(", which no second case confirms;") && !Contains(" ± "));
}

TEST_CASE("a turn by less than its place is uncertain by is no fold", "[asks]") {
  StudyResults made = synthetic::points();
  REQUIRE(count(ask(with_tables(made), {"fold"}), "fold") > 0);
  for (CaseRecord& record : made.cases)
    for (Table& table : record.tables)
      if (const auto column = find_column(table.columns, "prominence"); column && table.name == "special_points")
        for (Row& row : table.rows) row[*column] = Cell(1e-9);
  const asks::Answered out = ask(with_tables(std::move(made)), {"fold"});
  INFO(out.sentence);
  CHECK(count(out, "fold") == 0);
}

TEST_CASE("a kind that was not met is no where branches went on, and open where they stopped", "[asks]") {
  const StudyResults all = with_tables(synthetic::points());
  const asks::Answered out = ask(all, {"flip"});
  INFO(out.sentence);
  CHECK(count(out, "flip") == 0);
  CHECK(out.passes != asks::Verdict::yes);
  CHECK_THAT(out.sentence, Contains("no flip was met"));
}

TEST_CASE("unknown kinds of points are refused with the nearest", "[asks]") {
  const Study none;
  CHECK_NOTHROW(check_points_ask(none, {{"points", {"grazing", "lift_off", "first-contact", "all"}}}, "/ask/0/points"));
  try {
    check_points_ask(none, {{"points", {"fold", "flipp"}}}, "/ask/0/points");
    FAIL("accepted");
  } catch (const InputError& error) {
    CHECK(error.pointer() == "/ask/0/points/1");
    CHECK_THAT(error.what(), Contains("did you mean \"flip\"?"));
  }
}

}  // namespace ricochet::tests_of_points_asks
