// What one time scheme tells of the limit of another.
#include <catch2/catch.hpp>
#include <vector>

#include "runners/store/study_tables.hpp"
#include "tests/runners/asks/made_tables.hpp"

using namespace ricochet;
using namespace ricochet::asks;

TEST_CASE("asks: schemes of a compliant law have one limit, and intervals that exclude each other are widened") {
  // Each scheme settles by itself; they are 10 % apart. The third agrees with the first.
  const std::vector<double> ends = {1.0, 1.1, 1.0001};
  StudyResults results = synthetic::full_factorial(
      {{"mass", {"m0"}}, {"time", {"t0", "t1", "t2"}}}, {8e-3, 4e-3, 2e-3, 1e-3},
      [&](const std::vector<std::size_t>& at, double h) { return ends[at[1]] + h * h; }, "impulse");
  const auto value = [&](Json where = Json::object()) {
    return answer_of(results, {{"value", "impulse"}, {"where", std::move(where)}});
  };
  const Json effect = {{"effect", "time"}, {"on", "impulse"}, {"from", 0.05}};
  // Of rigid laws the scheme has a part in the limit.
  CHECK(value().passes == Verdict::yes);
  CHECK(answer_of(results, effect).passes == Verdict::yes);
  for (CaseRecord& record : results.cases) record.measures.emplace_back("contact_steps", 40.0);
  const Answered all = value();
  INFO(all.sentence);
  CHECK(all.passes == Verdict::open);
  REQUIRE(all.rows.size() == 3);
  for (const VerdictRow& row : all.rows) {
    CHECK(row.verdict == "open");
    CHECK(row.reason == "it disagrees with another scheme, though both have one limit");
    CHECK((*row.low < 1.0 + 1e-4 && *row.high > 1.1));
  }
  const Answered changed = answer_of(results, effect);
  INFO(changed.sentence);
  CHECK(changed.passes == Verdict::open);
  CHECK(changed.reason == "both schemes have one limit as the step shrinks");
  CHECK(answer_of(results, {{"rank", "impulse"}, {"over", "time"}}).rows.front().verdict == "1 to 3");
  // What is asked of one scheme alone is tested by the others all the same.
  const Json limit = {{"limit", "impulse"}, {"below", 1.05}, {"where", {{"time", "t0"}}}};
  CHECK(answer_of(results, limit).passes == Verdict::open);
  CHECK(answer_of(results, limit).reason == all.rows.front().reason);
  // Those that agree are known, and a small difference of theirs is no effect of a scheme.
  std::erase_if(results.cases, [](const CaseRecord& one) { return one.axes[1].second == "t1"; });
  CHECK(answer_of(results, limit).passes == Verdict::yes);
  CHECK(answer_of(results, effect).passes == Verdict::no);
  // One that has not settled is known by one that has.
  StudyResults rough = synthetic::full_factorial(
      {{"mass", {"m0"}}, {"time", {"t0", "t1"}}}, {8e-3, 4e-3, 2e-3, 1e-3},
      [](const std::vector<std::size_t>& at, double h) {
        return 1 + h * h + (at[1] == 1 ? (h == 2e-3 ? 0.3 : 0.1) : 0);
      },
      "impulse");
  const Json of_rough = {{"value", "impulse"}, {"where", {{"time", "t1"}}}};
  const VerdictRow before = answer_of(rough, of_rough).rows.front();
  for (CaseRecord& record : rough.cases) record.measures.emplace_back("contact_steps", 40.0);
  const VerdictRow row = answer_of(rough, of_rough).rows.front();
  CHECK(before.verdict == "not settled");
  CHECK(row.verdict == "known");
  CHECK((*row.low < 1 && *row.high > 1));
  CHECK(*row.high - *row.low < *before.high - *before.low);
  CHECK(answer_of(rough, {{"limit", "impulse"}, {"below", 1.25}, {"where", {{"time", "t1"}}}}).passes == Verdict::yes);
  // Nor does one that seems to grow without bound.
  for (CaseRecord& record : rough.cases)
    if (record.axes[1].second == "t1") record.measures[0].second = 1e-5 / record.axes[2].second.get<double>();
  const VerdictRow bounded = answer_of(rough, of_rough).rows.front();
  CHECK(bounded.verdict == "known");
  CHECK((*bounded.low < 1 && *bounded.high > 1));
  // Two that disagree know nothing of a third.
  StudyResults apart = synthetic::full_factorial(
      {{"mass", {"m0"}}, {"time", {"t0", "t1", "t2"}}}, {8e-3, 4e-3, 2e-3, 1e-3},
      [](const std::vector<std::size_t>& at, double h) {
        return at[1] == 2 ? (h == 2e-3 ? 1.3 : 1.1) : 1 + 0.2 * static_cast<double>(at[1]) + h * h;
      },
      "impulse");
  for (CaseRecord& record : apart.cases) record.measures.emplace_back("contact_steps", 40.0);
  CHECK(answer_of(apart, {{"value", "impulse"}, {"where", {{"time", "t2"}}}}).rows.front().verdict != "known");
  // One that has not settled itself disproves nothing.
  StudyResults loose = synthetic::full_factorial(
      {{"mass", {"m0"}}, {"time", {"t0", "t1"}}}, {8e-3, 4e-3, 2e-3, 1e-3},
      [](const std::vector<std::size_t>& at, double h) {
        return at[1] == 0 ? 1 + h * h : h == 4e-3 || h == 1e-3 ? 1.3 : 1.2;
      },
      "impulse");
  for (CaseRecord& record : loose.cases) record.measures.emplace_back("contact_steps", 40.0);
  CHECK(answer_of(loose, limit).passes == Verdict::yes);
}

TEST_CASE("asks: what one scheme does not touch and another does is no zero") {
  const std::vector<double> ends = {0, 2};
  StudyResults results = synthetic::full_factorial(
      {{"mass", {"m0"}}, {"contact", {"c0", "c1"}}, {"time", {"t0", "t1"}}}, {8e-3, 4e-3, 2e-3, 1e-3},
      [&](const std::vector<std::size_t>& at, double h) { return at[1] == 1 ? 0 : ends[at[2]] * (1 + h * h); },
      "impulse");
  for (CaseRecord& record : results.cases)
    record.measures.emplace_back("contact_instants", record.measures[0].second == 0 ? 0.0 : 3.0);
  const auto limit = [&](double below, const char* law) {
    return answer_of(results, {{"limit", "impulse"}, {"below", below}, {"where", {{"time", "t0"}, {"contact", law}}}});
  };
  // Whether anything is touched is no matter of the scheme: one of them is wrong.
  const Answered near = limit(1, "c0");
  INFO(near.sentence);
  CHECK(near.passes == Verdict::open);
  CHECK(near.reason == "it touches nothing, and other schemes do");
  CHECK(*near.rows.front().high >= 2);
  CHECK(limit(3, "c0").passes == Verdict::yes);
  // Where no scheme touches a zero is one, whatever is touched with another law.
  CHECK(limit(1, "c1").passes == Verdict::yes);
  // What ends in zero after contact is no matter of touching.
  for (CaseRecord& record : results.cases)
    for (auto& [name, value] : record.measures)
      if (name == "contact_instants") value = 3;
  CHECK(limit(1, "c0").passes == Verdict::yes);
}
