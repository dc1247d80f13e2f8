#include "runners/report/report.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

#include "runners/kinds/trajectory/page/page.hpp"
#include "runners/report/html.hpp"
#include "runners/report/kind_page.hpp"
#include "runners/store/atomic_file.hpp"
#include "runners/table/table_reader.hpp"
#include "tests/runners/report/rendered.hpp"
#include "tests/runners/report/synthetic.hpp"

using namespace ricochet;

using synthetic::count;

namespace {

bool page_contains(const std::string& page, const std::string& text) {
  return page.find(text) != std::string::npos;
}

}  // namespace

TEST_CASE("the page forbids the network and asks nothing of it", "[report]") {
  const std::string page = synthetic::rendered(synthetic::results());
  CHECK(page_contains(page, "http-equiv=\"Content-Security-Policy\" content=\"default-src 'none';"));
  CHECK(!page_contains(page, "connect-src"));
  CHECK(!page_contains(page, "http:"));
  CHECK(!page_contains(page, "https:"));
  CHECK(!page_contains(page, " src="));
  CHECK(!page_contains(page, "@import"));
  CHECK(!page_contains(page, "url(h"));
}

TEST_CASE("every case is a row, whatever became of it", "[report]") {
  const StudyResults results = synthetic::results();
  const std::string page = synthetic::rendered(results);
  CHECK(count(page, "<tr data-status=") == results.cases.size());
  for (const char* status : {"refused", "diverged"})
    CHECK(page_contains(page, "<tr data-status=\"" + std::string(status)));
  CHECK(page_contains(page, "use beta ≥ 1/4 &amp; gamma ≥ 1/2"));
  CHECK(page_contains(page, "the energy passed 1e9 J at step 77: &quot;no bound&quot; holds"));
}

TEST_CASE("a part of a study says that it is one, first of all", "[report]") {
  StudyResults results = synthetic::results();
  results.expected_cases = static_cast<int>(results.cases.size());
  CHECK(!page_contains(synthetic::rendered(results), "art 3 of 64"));
  results.part = {3, 64};
  const std::string page = synthetic::rendered(results);
  CHECK(page_contains(page,
                      "<p class=\"status-line\">Part 3 of 64, " + std::to_string(results.cases.size()) + " cases:"));
  CHECK(page_contains(page, "This is part 3 of 64 of the study."));
  CHECK(page.find("This is part 3 of 64") < page.find("<section id=\"answer\""));
}

TEST_CASE("a page of more cases than have files of their curves says where the curves are", "[report]") {
  StudyResults results = synthetic::results();
  const std::string few = synthetic::rendered(results);
  CHECK(page_contains(few, "\"curve_files\":true"));
  CHECK(page_contains(few, "its file in curves/"));
  CHECK(!page_contains(few, "--curves"));
  const CaseRecord one = *std::find_if(results.cases.begin(), results.cases.end(),
                                       [](const CaseRecord& record) { return !record.curve.names.empty(); });
  while (has_curve_files(results)) {
    results.cases.push_back(one);
    results.cases.back().id += std::to_string(results.cases.size());
    results.cases.back().curve.columns.assign(one.curve.names.size(), {0, 1});
  }
  const std::string many = synthetic::rendered(results);
  CHECK(page_contains(many, "\"curve_files\":false"));
  CHECK(!page_contains(many, "curves/ID.csv"));
  CHECK(!page_contains(many, "in curves/"));
  CHECK(page_contains(many, "`ricochet export DIR --to CSVDIR --curves`"));
}

TEST_CASE("partial results are said plainly", "[report]") {
  StudyResults results = synthetic::results();
  results.expected_cases = static_cast<int>(results.cases.size());
  CHECK(!page_contains(synthetic::rendered(results), "Partial results"));
  results.expected_cases += 12;
  CHECK(page_contains(synthetic::rendered(results), "Partial results: 36 of 48 cases so far."));
  results.cases.clear();
  const std::string empty = synthetic::rendered(results);
  CHECK(page_contains(empty, "Partial results: 0 of 48 cases so far."));
  CHECK(page_contains(empty, "No case has run yet."));
}

TEST_CASE("nothing that a study says can leave its place in the page", "[report]") {
  StudyResults results = synthetic::results();
  const std::string attack = "</script><script>alert(1)</script><!-- \"'&\xff";
  results.name = results.question = attack;
  results.study["name"] = attack;
  results.environment.entries.emplace_back(attack, attack);
  for (CaseRecord& record : results.cases) {
    record.axes[0].second = attack;
    record.id += attack;
    record.notes.push_back(attack);
    record.left_out.emplace_back(attack, attack);
    if (record.status != Status::done) record.reasons = {attack};
  }
  const std::string page = synthetic::rendered(results);
  CHECK(!page_contains(page, "<script>alert"));
  CHECK(!page_contains(page, "<!--"));
  CHECK(!page_contains(page, "\xff"));
  // Own script and two blocks of data: three pairs, and no other.
  CHECK(count(page, "</script") == 3);
  CHECK(count(page, "<script") == 3);
}

TEST_CASE("a kind without figures of its own still has its tables", "[report]") {
  StudyResults results = synthetic::results();
  results.kind = "stability";
  const std::string page = synthetic::rendered(results);
  CHECK(!page_contains(page, "<section class=\"figure\""));
  CHECK(count(page, "<tr data-status=") == results.cases.size());
}

TEST_CASE("what was left out is grouped over the cases", "[report]") {
  const std::string page = synthetic::rendered(synthetic::results());
  CHECK(count(page, "no damping is given") == 1);
  CHECK(page_contains(page, "all 36 cases"));
  CHECK(page_contains(page, "9 of 36 cases (mass singular; mass.velocity P0)"));
}

TEST_CASE("results without a single curve or measure make a page", "[report]") {
  StudyResults results = synthetic::results();
  for (CaseRecord& record : results.cases) {
    record.curve = {};
    record.measures.clear();
    record.status = Status::failed;
    record.reasons = {"it went wrong"};
  }
  results.derived.clear();
  const std::string page = synthetic::rendered(results);
  CHECK(page_contains(page, "No case has finished with a result"));
  // Beside the scripts, which have words of their own.
  CHECK(!page_contains(page.substr(0, page.find("<script")), "nan"));
}

TEST_CASE("rendering the same results twice gives the same bytes", "[report]") {
  const auto kind = report::trajectory_page();
  const StudyResults one = synthetic::results(), other = synthetic::results();
  CHECK(render_report(Choices(one), kind) == render_report(Choices(other), kind));
}

// A page of very many cases holds some of them, and says so.
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
  results.method_words = {{"mass lumped", "row sums"}};
  results.expected_cases = count;
  Table table{"energy_changes", "One case.", {{"case", "", ""}, {"value", "1", ""}}, {}};
  for (int i = 0; i < count; ++i) {
    CaseRecord record;
    record.id = std::to_string(1000003LL * i % 999983);  // in no order
    record.axes = {{"mass", i == count - 1 ? "lumped" : "consistent"}, {"stops.upper", 0.001 * (i % 100)}};
    record.status = i % bad == 0 ? Status::diverged : Status::done;
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
    CHECK(shown->method_words == all.method_words);  // methods have one name, however many cases there are
    CHECK(shown->columns == all.columns);
    std::set<std::string> ids;
    std::set<std::string> masses, stops;
    std::size_t diverged = 0;
    for (const CaseRecord& record : shown->cases) {
      ids.insert(record.id);
      diverged += record.status == Status::diverged;
      masses.insert(axis_words(record, "mass"));
      stops.insert(axis_words(record, "stops.upper"));
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
