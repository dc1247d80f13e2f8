// A page of very many cases holds some of them, and says so.
#include "runners/report/shown_cases.hpp"

#include <catch2/catch.hpp>
#include <set>

#include "runners/report/kind_page.hpp"
#include "runners/report/page.hpp"
#include "runners/table/table_reader.hpp"
#include "tests/runners/report/synthetic.hpp"

using namespace ricochet;
using namespace ricochet::report;
using Catch::Matchers::Contains;

namespace {

/// So many cases over two axes, every `bad`-th of them diverged, and a table of a row per case.
StudyResults many(int count, int bad) {
  StudyResults results;
  results.name = "many";
  results.kind = "trajectory";
  results.columns = {"mass", "stops.upper"};
  results.expected_cases = count;
  Table table{"energy_changes", "One case.", {{"case", "", ""}, {"value", "1", ""}}, {}};
  for (int i = 0; i < count; ++i) {
    CaseRecord record;
    record.id = std::to_string(1000003LL * i % 999983);  // in no order
    record.axes = {{"mass", i == count - 1 ? "lumped" : "consistent"}, {"stops.upper", 0.001 * (i % 100)}};
    record.status = i % bad == 0 ? "diverged" : "done";
    table.rows.push_back({record.id, 1.0 * i});
    results.cases.push_back(std::move(record));
  }
  results.derived = {table, {"answers", "One sentence.", {{"sentence", "", ""}}, {{"so it is"}}}};
  return results;
}

}  // namespace

TEST_CASE("shown cases: all of a study that a page can hold") {
  CHECK_FALSE(shown_cases(many(static_cast<int>(2 * most_shown_cases), 10)));
}

TEST_CASE("shown cases: of more some, each value of an axis, what is not done, and rows of no other case") {
  for (const int bad : {3, 1000}) {
    const StudyResults all = many(20000, bad);
    const auto shown = shown_cases(all);
    REQUIRE(shown);
    CHECK(shown->cases.size() == most_shown_cases);
    CHECK(shown->columns == all.columns);
    std::set<std::string> ids;
    std::set<std::string> masses, stops;
    std::size_t diverged = 0;
    for (const CaseRecord& record : shown->cases) {
      ids.insert(record.id);
      diverged += record.status == "diverged";
      masses.insert(CaseView::text(record, "mass"));
      stops.insert(CaseView::text(record, "stops.upper"));
    }
    CHECK(ids.size() == most_shown_cases);
    CHECK(masses == std::set<std::string>{"consistent", "lumped"});
    CHECK(stops.size() == 100);
    // Of many that diverged a quarter and those that the lot finds, of few all.
    CHECK((bad == 3 ? diverged > most_shown_cases / 4 && diverged < most_shown_cases : diverged == 20));
    const Table* changes = find_table(shown->derived, "energy_changes");
    REQUIRE(changes);
    CHECK(changes->rows.size() == most_shown_cases);
    for (const Row& row : changes->rows) CHECK(ids.contains(row.front().text()));
    CHECK(find_table(shown->derived, "answers")->rows.size() == 1);
    // In the order of the study, and the same ones each time.
    const auto again = shown_cases(all);
    CHECK(std::equal(shown->cases.begin(), shown->cases.end(), again->cases.begin(),
                     [](const CaseRecord& a, const CaseRecord& b) { return a.id == b.id; }));
    CHECK_THAT(shown_sentence(*shown, all), Contains("2000 of 20000 cases") && Contains("cases.csv"));
  }
}
