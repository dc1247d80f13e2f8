// Verdicts on made tables whose truth is known: no wrong yes, no wrong no; what does not matter changes nothing.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <functional>
#include <map>
#include <ricochet/measure/statistics/draws.hpp>
#include <ricochet/contract/said_format.hpp>
#include <ricochet/engine/marcher.hpp>
#include <set>

#include "runners/store/study_tables.hpp"
#include "tests/runners/asks/made_tables.hpp"

using namespace ricochet;
using namespace ricochet::asks;

namespace {

TEST_CASE("asks: what is refused is left out of an effect, and one without a limit is as sure as both its levels") {
  // Levels agree within a thousandth; of the second scheme the third mass is refused.
  Made made;
  made.choices = {{"mass", {"m0", "m1", "m2"}}, {"time", {"t0", "t1"}}};
  made.truth = [](const std::vector<std::size_t>& at) { return 1 + 3e-4 * static_cast<double>(at[0]); };
  made.error = 1e-3;
  StudyResults results = made.results();
  std::size_t refused = 0;
  for (CaseRecord& record : results.cases) {
    if (record.axes[0].second != "m2" || record.axes[1].second != "t1") continue;
    record.status = Status::refused;
    record.reasons = {"m2 does not apply"};
    record.measures.clear();
    ++refused;
  }
  REQUIRE(refused == made.steps.size());
  const Json ask = {{"effect", "mass"}, {"on", "impulse"}, {"from", 0.01}};
  const Answered answered = answer_of(results, ask);
  INFO(answered.sentence);
  CHECK(answered.passes == Verdict::no);
  CHECK(answered.left_out == refused);
  // What has no value stands behind what has one.
  bool without = false;
  for (const VerdictRow& row : answered.rows) {
    if (row.verdict == "value") continue;
    CHECK_FALSE((row.value && without));
    without = without || !row.value;
  }
  CHECK(without);
  // One that fails is no such case: it is open.
  for (CaseRecord& record : results.cases)
    if (record.status == Status::refused) record.status = Status::failed;
  CHECK(answer_of(results, ask).passes == Verdict::open);

  // Differences of 1e-9, 3e-9 and 9e-9 have no limit; each level is known to a millionth.
  Made growing;
  growing.choices = {{"mass", {"m0", "m1"}}};
  growing.steps = {4e-3, 2e-3, 1e-3};
  const StudyResults apart = synthetic::full_factorial(
      growing.choices, growing.steps,
      [](const std::vector<std::size_t>& at, double h) {
        return 1 + 0.1 * h * h + (at[0] == 0 ? 0 : 1e-9 * std::pow(3, std::log2(4e-3 / h)));
      },
      "impulse");
  const Answered sure = answer_of(apart, ask);
  INFO(sure.sentence);
  CHECK(sure.passes == Verdict::no);
}

TEST_CASE("asks: a limit that holds since nothing happened in a doubtful run is open") {
  Made made;
  made.choices = {{"mass", {"m0", "m1"}}};
  made.truth = [](const std::vector<std::size_t>&) { return 0.0; };
  StudyResults results = made.results();
  const auto passes = [&] { return answer_of(results, {{"limit", "impulse"}, {"below", 1}}).passes; };
  for (CaseRecord& record : results.cases) record.measures.emplace_back("contact_instants", 0.0);
  CHECK(passes() == Verdict::yes);
  for (CaseRecord& record : results.cases) record.reasons = {"the run lasts a hundredth of the slowest period"};
  CHECK(passes() == Verdict::open);
  // Where a stop was touched, what is doubtful stands before the verdict.
  for (CaseRecord& record : results.cases) record.measures.back().second = 1.0;
  CHECK(passes() == Verdict::yes);
}

TEST_CASE("asks: a limit beyond the range is larger than what was found, and not told from another") {
  // Of m0 the limit is known; of m1 and m2 every step of the range, up to 1e-2 s, is stable.
  Made made;
  made.choices = {{"mass", {"m0", "m1", "m2"}}};
  made.steps = {1e-3};
  made.measure = "limit_observed";
  made.truth = [](const std::vector<std::size_t>&) { return 1e-4; };
  StudyResults results = made.results();
  results.kind = "stability";
  std::erase(results.columns, "step");
  for (CaseRecord& record : results.cases) {
    std::erase_if(record.axes, [](const auto& axis) { return axis.first == "step"; });
    if (record.axes[0].second == "m0") continue;
    record.measures = {{"least.limit_observed", 1e-2}};
    record.left_out.emplace_back("limit_observed", "every step of the range is stable");
  }
  const auto told = [&](Json ask) {
    const Answered answered = answer_of(results, ask);
    UNSCOPED_INFO(answered.sentence);
    return answered;
  };
  const Answered rank = told({{"rank", "limit_observed"}, {"over", "mass"}});
  REQUIRE(rank.rows.size() == 3);
  CHECK(rank.rows[0].verdict == "1 to 2");
  CHECK(rank.rows[2].verdict == "3");
  CHECK(rank.rows[2].level == "m0");
  CHECK(rank.left_out == 0);
  const Answered effect = told({{"effect", "mass"}, {"on", "limit_observed"}, {"from", 10}});
  CHECK(effect.verdict == "yes");
  CHECK(effect.sentence.find("to at least 0.01 s") != std::string::npos);
  CHECK(told({{"effect", "mass"}, {"on", "limit_observed"}, {"from", 100}}).passes == Verdict::open);
  CHECK(told({{"limit", "limit_observed"}, {"above", 5e-5}}).passes == Verdict::yes);
  CHECK(told({{"limit", "limit_observed"}, {"below", 5e-3}}).passes == Verdict::no);
  CHECK(told({{"limit", "limit_observed"}, {"below", 5e-2}}).passes == Verdict::open);
  CHECK(told({{"value", "limit_observed"}}).sentence.find("at least 0.01 s") != std::string::npos);
}

}  // namespace

TEST_CASE("asks: a limit is never said to hold, or to be broken, against the truth") {
  std::mt19937 random(1);
  std::size_t yes = 0, no = 0, open = 0;
  for (int k = 0; k < tries; ++k) {
    const Made made = random_methods(random, 1);
    const double truth = made.truth({0}), bound = truth * uniform(random, 0.7, 1.3);
    const Answered answered = answer_of(made.results(), {{"limit", "impulse"}, {"below", bound}});
    INFO("limit " << truth << ", asked below " << bound << ", error " << made.error << ", order " << made.order << "\n"
                  << answered.sentence);
    if (*answered.passes == Verdict::yes) {
      CHECK(truth < bound);
      ++yes;
    } else if (*answered.passes == Verdict::no) {
      CHECK(truth >= bound);
      ++no;
    } else {
      ++open;
    }
    CHECK(words_in(answered.sentence) <= 30);
  }
  // It does say something.
  CHECK(yes > tries / 5);
  CHECK(no > tries / 5);
  CHECK(open > 0);
}

TEST_CASE("asks: an effect is as large as asked, or smaller, in truth") {
  std::mt19937 random(2);
  std::size_t yes = 0, no = 0;
  for (int k = 0; k < tries; ++k) {
    Made made = random_methods(random, 2);
    // Methods may err in their own ways.
    const double other = uniform(random, -0.3, 0.3), base = made.truth({0}),
                 second = base * (1 + uniform(random, -0.2, 0.2));
    made.truth = [=](const std::vector<std::size_t>& at) { return at[0] == 0 ? base : second; };
    StudyResults results = made.results();
    for (CaseRecord& record : results.cases)
      if (record.axes[0].second == "m1") {
        const double part = std::pow(record.axes[1].second.get<double>() / made.steps.front(), made.order);
        record.measures[0].second = second * (1 + other * part);
      }
    const double from = uniform(random, 0.001, 0.2), share = std::abs(second - base) / base;
    const Answered answered = answer_of(results, {{"effect", "mass"}, {"on", "impulse"}, {"from", from}});
    INFO("share " << share << ", asked " << from << "\n" << answered.sentence);
    if (*answered.passes == Verdict::yes) {
      CHECK(share > from);
      ++yes;
    } else if (*answered.passes == Verdict::no) {
      CHECK(share < from);
      ++no;
    }
    const Answered turned = answer_of(results, {{"effect", "mass"}, {"on", "impulse"}, {"within", from}});
    CHECK((*turned.passes == Verdict::open) == (*answered.passes == Verdict::open));
    CHECK((*turned.passes == Verdict::yes) == (*answered.passes == Verdict::no));
    CHECK(words_in(answered.sentence) <= 30);
  }
  CHECK(yes > tries / 10);
  CHECK(no > tries / 10);
}

TEST_CASE("asks: a method without any value is neither always nor never") {
  std::mt19937 random(13);
  Made made = random_methods(random, 2);
  synthetic::Choice axis{"stops.upper", {"0.1", "0.2", "0.3"}};
  made.choices.push_back(axis);
  made.truth = [](const std::vector<std::size_t>&) { return 0.5; };
  StudyResults results = made.results();
  for (CaseRecord& record : results.cases) {
    for (auto& [column, value] : record.axes)
      if (column == "stops.upper") value = std::stod(value.get<std::string>());
    if (record.axes[0].second != "m1") continue;
    record.status = Status::refused;
    record.reasons = {"no"};
    record.measures.clear();
  }
  const Answered answered = answer_of(results, {{"threshold", "impulse"}, {"below", 1}, {"along", "stops.upper"}});
  INFO(answered.sentence);
  CHECK(answered.verdict == "always");
  CHECK(answered.sentence.find("never") == std::string::npos);
  REQUIRE(answered.aside.size() == 1);
}

TEST_CASE("asks: seeds widen the interval of a mean, and each of them has to keep a peak below its limit") {
  // Thirty draws about 1 that scatter by a tenth.
  Made made;
  made.choices = {{seed_axis, {}}};
  for (int seed = 1; seed <= 30; ++seed) made.choices[0].levels.push_back(std::to_string(seed));
  made.truth = [](const std::vector<std::size_t>&) { return 1.0; };
  made.scatter = 0.1;
  StudyResults results = made.results();
  std::vector<double> draws;
  for (const CaseRecord& record : results.cases) draws.push_back(record.measures.front().second);
  const double largest = *std::max_element(draws.begin(), draws.end());
  const Json ask = {{"limit", "impulse"}, {"below", 0.999 * largest}};
  const Answered peak = answer_of(results, ask);
  INFO(peak.sentence);
  CHECK(peak.passes == Verdict::no);
  CHECK(peak.sentence.find("1 of 30 seeds is beyond") != std::string::npos);
  REQUIRE(peak.rows.front().high);
  CHECK(*peak.rows.front().high < 0.999 * largest);
  // Known with half-widths of their own: windows of one mean.
  for (CaseRecord& record : results.cases) record.measures.emplace_back("confidence.impulse", 0.2);
  const Answered mean = answer_of(results, ask);
  INFO(mean.sentence);
  CHECK(mean.passes == Verdict::yes);
}

TEST_CASE("asks: what is round-off beside its neighbours is zero, and known") {
  Made made;
  made.choices = {{"mass", {"m0", "m1"}}};
  made.truth = [](const std::vector<std::size_t>& at) { return at[0] == 0 ? 1.0 : 0.0; };
  made.error = 0.01;
  StudyResults results = made.results();
  int k = 0;
  for (CaseRecord& record : results.cases)
    if (record.axes[0].second == "m1") record.measures.front().second = ++k % 2 == 0 ? 2e-19 : -3e-19;
  const Answered answered = answer_of(results, {{"enough", "impulse"}, {"within", 0.05}});
  INFO(answered.sentence);
  CHECK(answered.passes == Verdict::yes);
  CHECK(answered.sentence.find("zero") == std::string::npos);
}

TEST_CASE("asks: what falls to zero with the step is not known better by a smaller one") {
  Made made;
  made.choices = {{"mass", {"m0"}}};
  const StudyResults results = synthetic::full_factorial(
      made.choices, {4e-3, 2e-3, 1e-3}, [](const std::vector<std::size_t>&, double h) { return 7 * h; }, "impulse");
  const Answered answered = answer_of(results, {{"enough", "impulse"}, {"within", 0.01}});
  INFO(answered.sentence);
  CHECK(answered.passes == Verdict::open);
  CHECK(answered.sentence.find("falls to zero with the step") != std::string::npos);
}

TEST_CASE("asks: without a threshold is always, never or not told, and overlapping brackets do not differ") {
  // m0 changes between 2 and 3, m1 between 2 and 4 with 3 open, m2 is always and m3 never below 1.
  Made made;
  made.choices = {{"mass", {"m0", "m1", "m2", "m3"}}, {"stops.upper", {"1", "2", "3", "4"}}};
  made.truth = [](const std::vector<std::size_t>& at) {
    const double levels[4][4] = {{2, 2, 0.5, 0.5}, {2, 2, 1, 0.5}, {0.5, 0.5, 0.5, 0.5}, {2, 2, 2, 2}};
    return levels[at[0]][at[1]];
  };
  made.error = 0.01;
  StudyResults results = made.results();
  for (CaseRecord& record : results.cases) {
    record.axes[1].second = std::stod(record.axes[1].second.get<std::string>());
    // The last value of the open one lies beside 1 within what its steps leave.
    if (record.axes[0].second == "m1" && record.axes[1].second == 3.0)
      record.measures.front().second = 1 + (record.measures.front().second - 1) * 0.5;
  }
  const Json ask = {{"threshold", "impulse"}, {"below", 1.001}, {"along", "stops.upper"}};
  const Answered answered = answer_of(results, ask);
  INFO(answered.sentence);
  CHECK(answered.sentence.find("always") != std::string::npos);
  CHECK(answered.sentence.find("never") != std::string::npos);
  CHECK(answered.sentence.find("differ") == std::string::npos);
  CHECK(answered.sentence.find("no threshold") == std::string::npos);
}

TEST_CASE("asks: a case stands behind a verdict once, whatever the number of its stops") {
  Made made;
  made.choices = {{"mass", {"m0", "m1"}}};
  made.truth = [](const std::vector<std::size_t>&) { return 1.0; };
  made.measure = "peak_force[a]";
  StudyResults results = made.results();
  for (CaseRecord& record : results.cases) record.measures.emplace_back("peak_force[b]", 2.0);
  results.cases.back().measures.clear();
  const Answered answered = answer_of(results, {{"value", "peak_force"}});
  INFO(answered.sentence);
  CHECK(answered.rows.size() == 4);
  CHECK(answered.cases == results.cases.size() - 1);
  CHECK(answered.left_out == 1);
}

TEST_CASE("asks: the seeds that would do give the half-width asked, and one fewer does not") {
  std::mt19937 random(14);
  for (int k = 0; k < tries / 10; ++k) {
    Made made = random_methods(random, 1);
    made.choices.push_back({seed_axis, {"1", "2", "3", "4", "5", "6"}});
    made.scatter = uniform(random, 0.01, 0.3);
    made.first_seed = random();
    made.error = made.second = 0;
    const double within = uniform(random, 0.02, 0.5);
    const Answered answered = answer_of(made.results(), {{"enough", "impulse"}, {"within", within}});
    const VerdictRow& row = answered.rows.front();
    const auto would = std::find_if(answered.rows.begin(), answered.rows.end(),
                                    [](const VerdictRow& one) { return one.verdict == "seeds that would do"; });
    REQUIRE(would != answered.rows.end());
    const double scatter = 0.5 * (*row.high - *row.low) / half_interval_over_scatter(6);
    const auto half = [&](double n) { return scatter * half_interval_over_scatter(static_cast<std::size_t>(n)); };
    INFO(answered.sentence);
    // The law of t beyond 200 draws is that of many, within a hundredth.
    CHECK(half(*would->value) <= 1.01 * within * *row.value);
    if (*would->value > 2) CHECK(half(*would->value - 1) > 0.99 * within * *row.value);
  }
}

TEST_CASE("asks: a step is asked for where its change is more than the draws make of it, and only there") {
  std::mt19937 random(15);
  int by_chance = 0, by_step = 0, more_draws = 0;
  const int all = tries / 10;
  for (int k = 0; k < all; ++k) {
    Made made;
    made.truth = [](const std::vector<std::size_t>&) { return 1.0; };
    made.choices = {{seed_axis, {"1", "2", "3", "4", "5", "6"}}};
    made.steps = {1e-3, 5e-4};
    made.scatter = 0.02;
    made.first_seed = random();
    const auto told = [&](const char* what) {
      const Answered answered = answer_of(made.results(), {{"enough", "impulse"}, {"within", 0.02}});
      return std::any_of(answered.rows.begin(), answered.rows.end(),
                         [&](const VerdictRow& row) { return row.verdict == what; });
    };
    made.chance = 0.2;
    by_chance += told("step that would do");
    more_draws += told("seeds that would do");
    made.chance = 0;
    made.error = 0.5;
    by_step += told("step that would do");
  }
  CHECK(by_chance <= all / 8);  // the interval holds 95 % of what is chance alone
  CHECK(more_draws == all);
  CHECK(by_step == all);
}

TEST_CASE("asks: a threshold lies between the levels that are told") {
  std::mt19937 random(4);
  std::size_t told = 0;
  for (int k = 0; k < tries / 2; ++k) {
    Made made = random_methods(random, 1);
    synthetic::Choice axis{"stops.upper", {}};
    std::vector<double> xs;
    for (int level = 0; level < 8; ++level) xs.push_back(0.1 * (level + 1));
    const double at = uniform(random, 0.05, 0.95);
    made.choices = {{"stops.upper", {}}};
    for (const double x : xs) made.choices[0].levels.push_back(fmt::format("{}", x));
    made.truth = [=](const std::vector<std::size_t>& level) { return 1 + (at - xs[level[0]]); };
    StudyResults results = made.results();
    for (CaseRecord& record : results.cases)
      record.axes[0].second = std::stod(record.axes[0].second.get<std::string>());
    const Answered answered = answer_of(results, {{"threshold", "impulse"}, {"below", 1}, {"along", "stops.upper"}});
    const VerdictRow& last = answered.rows.back();
    INFO("at " << at << ": " << answered.sentence);
    if (last.low) {
      CHECK(*last.low <= at);
      CHECK(at <= *last.high);
      ++told;
    }
    if (answered.verdict == "always") CHECK(at <= xs.front());
    if (answered.verdict == "never") CHECK(at >= xs.back());
    CHECK(words_in(answered.sentence) <= 30);
  }
  CHECK(told > tries / 5);
}

TEST_CASE("asks: the interval of a mean over seeds holds the truth as often as it says") {
  std::mt19937 random(5);
  int held = 0, all = 0;
  for (int k = 0; k < tries / 2; ++k) {
    Made made = random_methods(random, 1);
    made.choices.push_back({seed_axis, {"1", "2", "3", "4", "5", "6"}});
    made.scatter = uniform(random, 0.01, 0.3);
    made.first_seed = random();
    made.error = 0;
    made.second = 0;
    const Answered answered = answer_of(made.results(), {{"value", "impulse"}});
    REQUIRE(answered.rows.size() == 1);
    const VerdictRow& row = answered.rows.front();
    REQUIRE(row.low);
    ++all;
    held += *row.low <= made.truth({0}) && made.truth({0}) <= *row.high ? 1 : 0;
  }
  // 95 %, three deviations of a binomial either way.
  const double share = static_cast<double>(held) / all, deviation = std::sqrt(0.95 * 0.05 / all);
  CHECK(share > 0.95 - 3 * deviation);
  CHECK(share < 0.95 + 3 * deviation);
}

TEST_CASE("asks: the order of cases, their ids and a level that is not asked change no verdict") {
  std::mt19937 random(6);
  for (int k = 0; k < tries / 10; ++k) {
    Made made = random_methods(random, 3);
    StudyResults results = made.results();
    const std::vector<Json> asks = {{{"value", "impulse"}},
                                    {{"limit", "impulse"}, {"below", 1}},
                                    {{"effect", "mass"}, {"on", "impulse"}, {"from", 0.1}},
                                    {{"rank", "impulse"}, {"over", "mass"}},
                                    {{"enough", "impulse"}, {"within", 0.01}}};
    std::vector<Answered> before;
    for (const Json& ask : asks) before.push_back(answer_of(results, ask));
    StudyResults shuffled = results;
    std::shuffle(shuffled.cases.begin(), shuffled.cases.end(), random);
    for (CaseRecord& record : shuffled.cases) record.id = "x" + record.id;
    for (std::size_t a = 0; a < asks.size(); ++a) {
      const Answered after = answer_of(shuffled, asks[a]);
      INFO(before[a].sentence << "\n" << after.sentence);
      CHECK(after.passes == before[a].passes);
      CHECK(after.cases == before[a].cases);
      // The first level is the one that others are compared with: the study's order is part of an effect's sign.
      if (!asks[a].contains("effect")) CHECK(after.verdict == before[a].verdict);
    }
    // One more level, asked of the first three alone.
    Made more = made;
    more.choices.push_back({"contact", {"a", "b"}});
    more.truth = [&](const std::vector<std::size_t>& at) { return made.truth(at) * (at[1] == 0 ? 1 : 3); };
    const StudyResults larger = more.results();
    for (std::size_t a = 0; a < asks.size(); ++a) {
      Json narrowed = asks[a];
      narrowed["where"] = {{"contact", "a"}};
      CHECK(answer_of(larger, narrowed).sentence == before[a].sentence);
    }
  }
}

TEST_CASE("asks: a case that is missing is counted and its reason said") {
  std::mt19937 random(7);
  for (int k = 0; k < tries / 10; ++k) {
    const Made made = random_methods(random, 3);
    StudyResults results = made.results();
    const std::size_t which = random() % results.cases.size();
    results.cases[which].status = Status::diverged;
    results.cases[which].reasons = {"step 3 is too large"};
    results.cases[which].measures.clear();
    for (const Json& ask : std::vector<Json>{{{"value", "impulse"}},
                                             {{"limit", "impulse"}, {"below", 1}},
                                             {{"effect", "mass"}, {"on", "impulse"}},
                                             {{"rank", "impulse"}, {"over", "mass"}}}) {
      const Answered answered = answer_of(results, ask);
      CHECK(answered.left_out == 1);
      CHECK(answered.cases == results.cases.size() - 1);
      REQUIRE(answered.aside.size() == 1);
      CHECK(answered.aside.front() == "Left out: 1 diverged: step 3 is too large.");
    }
  }
}

TEST_CASE("asks: errors are known to what their reference is known to") {
  std::mt19937 random(15);
  std::size_t told = 0;
  for (int k = 0; k < tries / 10; ++k) {
    Made made;
    made.choices = {{"time", {"a", "b"}}};
    made.measure = "error.impulse";
    const double first = uniform(random, 0.01, 0.03), second = uniform(random, 0.01, 0.03),
                 floor = uniform(random, 0, 0.02);
    made.truth = [=](const std::vector<std::size_t>& at) { return at[0] == 0 ? first : second; };
    StudyResults results = made.results();
    for (CaseRecord& record : results.cases) record.measures.emplace_back("floor.impulse", floor);
    const Answered effect = answer_of(results, {{"effect", "time"}, {"on", "error.impulse"}, {"from", "10 %"}});
    const Answered limit = answer_of(results, {{"limit", "error.impulse"}, {"below", 0.02}});
    INFO(first << " " << second << " floor " << floor << "\n" << effect.sentence << "\n" << limit.sentence);
    if (std::abs(second - first) <= floor) CHECK(*effect.passes != Verdict::yes);
    if (std::max(first, second) + floor >= 0.02) CHECK(*limit.passes != Verdict::yes);
    if (std::max(first, second) + floor < 0.02) CHECK(*limit.passes == Verdict::yes);
    told += *limit.passes != Verdict::open ? 1 : 0;
  }
  CHECK(told > 0);
}

TEST_CASE("asks: a value within the round-off of its scene is zero") {
  Made made;
  made.choices = {{"mass", {"m0"}}};
  made.steps = {1e-3};
  made.measure = "tip_displacement_end";
  made.truth = [](const std::vector<std::size_t>&) { return 8.5e-18; };
  StudyResults results = made.results();
  for (CaseRecord& record : results.cases) {
    record.steps = 1000;
    record.measures.emplace_back("largest_tip_displacement", 1e-3);
  }
  const Answered answered = answer_of(results, {{"value", "tip_displacement_end"}});
  INFO(answered.sentence);
  REQUIRE(answered.rows.front().value);
  CHECK(*answered.rows.front().value == 0);
  // Of a scene of that size it is a value.
  for (CaseRecord& record : results.cases) record.measures.back().second = 1e-16;
  CHECK(*answer_of(results, {{"value", "tip_displacement_end"}}).rows.front().value != 0);
}

TEST_CASE("asks: round-off of a force at one stop is that of all forces, and a solve leaves more than its steps") {
  // At rest: 75 N at one stop and 0.04 N at the other, which differ by round-off of the 75 N from step to step.
  const auto of_rest = [](double first) {
    return synthetic::full_factorial(
        {{"mass", {"m0"}}}, {4e-3, 2e-3, 1e-3, 5e-4},
        [=](const std::vector<std::size_t>&, double h) { return first * (1 + 1e-14 * std::log2(4e-3 / h)); },
        "mean_force[near]");
  };
  const auto verdict = [](StudyResults results) {
    for (CaseRecord& record : results.cases) record.steps = 20;
    return answer_of(results, {{"value", "mean_force"}}).rows.front().verdict;
  };
  CHECK(verdict(of_rest(75)) == "known");
  StudyResults small = of_rest(0.04);
  for (CaseRecord& record : small.cases) {
    record.measures.front().second = 0.04 + 1e-10 * std::log2(4e-3 / record.axes.back().second.get<double>());
    record.measures.emplace_back("mean_force[far]", 75);
  }
  CHECK(verdict(small) == "known");
  // Alone at its stop that is a motion.
  for (CaseRecord& record : small.cases) record.measures.pop_back();
  CHECK(verdict(small) == "not settled");
}

TEST_CASE("asks: one step tells neither yes nor no, whatever its value") {
  std::mt19937 random(8);
  Made made = random_methods(random, 2);
  made.steps = {1e-3};
  const StudyResults results = made.results();
  for (const Json& ask : std::vector<Json>{{{"limit", "impulse"}, {"below", 100}},
                                           {{"limit", "impulse"}, {"below", 0.1}},
                                           {{"effect", "mass"}, {"on", "impulse"}, {"from", 1e-6}}}) {
    const Answered answered = answer_of(results, ask);
    INFO(answered.sentence);
    CHECK(answered.passes == Verdict::open);
    CHECK(answered.reason == "one step: what it leaves open is not known");
  }
}

TEST_CASE("asks: nothing on both sides is no agreement") {
  std::mt19937 random(9);
  Made made = random_methods(random, 2);
  made.truth = [](const std::vector<std::size_t>&) { return 0.0; };
  const Answered answered = answer_of(made.results(), {{"effect", "mass"}, {"on", "impulse"}, {"from", 0.05}});
  CHECK(answered.passes == Verdict::open);
  CHECK(answered.reason == "both are zero, or round-off");
  // What is zero after contact is a result.
  StudyResults touched = made.results();
  for (CaseRecord& record : touched.cases) record.measures.emplace_back("contact_instants", 7.0);
  const Answered after = answer_of(touched, {{"effect", "mass"}, {"on", "impulse"}, {"from", 0.05}});
  CHECK(after.passes == Verdict::no);
  CHECK(after.rows.front().reason == "both are zero, or round-off");
}

TEST_CASE("asks: a level whose law leaves the measure no limit decides nothing where others do") {
  Made made;
  made.choices = {{"mass", {"m0", "m1"}}, {"contact", {"rigid", "spring"}}};
  made.truth = [](const std::vector<std::size_t>&) { return 3.0; };
  made.error = 0.01;
  StudyResults results = made.results();
  const auto leave_out = [&](const char* law) {
    for (CaseRecord& record : results.cases)
      if (record.axes[1].second == law) record.left_out.emplace_back("impulse", no_limit);
  };
  const Json effect = {{"effect", "mass"}, {"on", "impulse"}, {"from", 0.05}},
             limit = {{"limit", "impulse"}, {"below", 4}};
  leave_out("rigid");
  for (const Json& ask : {effect, limit}) {
    const Answered answered = answer_of(results, ask);
    INFO(answered.sentence);
    CHECK(answered.passes == (ask == effect ? Verdict::no : Verdict::yes));
    REQUIRE_FALSE(answered.aside.empty());
    CHECK_THAT(answered.aside.front(), Catch::StartsWith("Left out: 8 without a value: no limit as the step shrinks"));
  }
  leave_out("spring");
  for (const Json& ask : {effect, limit}) CHECK(answer_of(results, ask).passes == Verdict::open);
}

TEST_CASE("asks: no contact law agrees with another where no stop is touched, and masses do") {
  Made made;
  made.truth = [](const auto&) { return 3.0; };
  made.error = 0.01;
  for (const std::string choice : {"contact", "contact.stiffness", "time.restitution", "mass"}) {
    made.choices = {{choice, {"a", "b"}}};
    StudyResults results = made.results();
    const Json ask = {{"effect", choice}, {"on", "impulse"}};
    const auto passes = [&](double instants) {
      StudyResults some = results;
      for (CaseRecord& record : some.cases) record.measures.emplace_back("contact_instants", instants);
      const Answered answered = answer_of(some, ask);
      INFO(choice << " " << answered.sentence);
      CHECK(words_in(answered.sentence) <= 30);
      if (instants == 0 && choice != "mass")
        CHECK_THAT(answered.sentence, Catch::Matchers::Contains("no stop is touched"));
      return *answered.passes;
    };
    CHECK(passes(1) == Verdict::no);
    CHECK(passes(0) == (choice == "mass" ? Verdict::no : Verdict::open));
    CHECK(*answer_of(results, ask).passes == Verdict::no);
  }
}

TEST_CASE("asks: cases that end alike but for their numbers are one line, and many reasons three") {
  Made made;
  made.choices = {{"mass", {"a", "b", "c", "d", "e", "f"}}};
  made.truth = [](const auto&) { return 3.0; };
  StudyResults results = made.results();
  const auto asides = [&] {
    const Answered answered = answer_of(results, {{"value", "impulse"}});
    for (const std::string& one : answered.aside) CHECK(one.starts_with("Left out: "));
    return answered.aside;
  };
  CHECK(asides().empty());
  // Of five masses; ends of an integration tell their numbers.
  LaneEnd end{.cause = EndCause::energy_beyond, .value = 1, .bound = 2};
  for (CaseRecord& record : results.cases) {
    if (record.axes[0].second == "a") continue;
    end.value *= 7;
    record.status = Status::diverged;
    record.reasons = {said("step {}, t = {} s: {}", static_cast<int>(end.value), end.value, told(end))};
  }
  CHECK(asides() == std::vector<std::string>{
                        "Left out: 20 diverged, the first: step 7, t = 7 s: the energy 7 J passed the bound 2 J."});
  const Answered ended = answer_of(results, {{"runs", true}});
  CHECK(ended.rows[1].reason == "the first: step 7, t = 7 s: the energy 7 J passed the bound 2 J");
  CHECK(ended.sentence == "4 of 24 cases run; 20 diverged (the first: step 7, t = 7 s).");
  for (CaseRecord& record : results.cases) {
    const std::string mass = record.axes[0].second.get<std::string>();
    if (mass == "a" || mass == "b") continue;
    record.status = Status::refused;
    record.reasons = {Said(mass + " does not apply")};
  }
  // Four each; the first two are told, in the order of the study.
  CHECK(asides() == std::vector<std::string>{
                        "Left out: 4 diverged, the first: step 7, t = 7 s: the energy 7 J passed the bound 2 J.",
                        "Left out: 4 refused: c does not apply.",
                        "Left out: 12 more for 3 other reasons, which are in reasons.csv."});
}
