// What is ranked, and how surely.
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "runners/store/study_tables.hpp"
#include "tests/runners/asks/made_tables.hpp"

using namespace ricochet;
using namespace ricochet::asks;

namespace {

/// The places that a row may have, "2" or "1 to 3".
std::pair<std::size_t, std::size_t> places_of(const VerdictRow& row) {
  const std::string& text = row.verdict;
  const std::size_t to = text.find(" to ");
  return {std::stoul(text), std::stoul(to == std::string::npos ? text : text.substr(to + 4))};
}

/// Checks that the true place of each row is one that it may have; returns how many pairs are told apart.
std::size_t check_places(const Answered& answered, const std::function<double(const VerdictRow&)>& truth) {
  std::size_t apart = 0;
  for (const VerdictRow& row : answered.rows) {
    std::size_t place = 1;
    for (const VerdictRow& other : answered.rows) {
      place += truth(other) > truth(row) ? 1 : 0;
      apart += places_of(row).second < places_of(other).first ? 1 : 0;
    }
    INFO(answered.sentence << "\n" << row.level << " " << row.verdict);
    CHECK(places_of(row).first <= place);
    CHECK(place <= places_of(row).second);
  }
  return apart;
}

}  // namespace

TEST_CASE("asks: what is ranked apart is apart in truth") {
  std::mt19937 random(3);
  std::size_t apart = 0;
  for (int k = 0; k < tries; ++k) {
    const Made made = random_methods(random, 2 + random() % 4);
    const StudyResults results = made.results();
    apart += check_places(answer_of(results, {{"rank", "impulse"}, {"over", "mass"}}), [&](const VerdictRow& row) {
      return made.truth({static_cast<std::size_t>(row.level.back() - '0')});
    });
  }
  CHECK(apart > tries);
}

TEST_CASE("asks: a wide interval is told apart from nothing that it reaches") {
  std::mt19937 random(11);
  std::size_t apart = 0;
  for (int k = 0; k < tries / 2; ++k) {
    const Made made = random_methods(random, 4);
    StudyResults results = made.results();
    // Each method errs in its own way.
    std::map<std::string, double> errors;
    for (CaseRecord& record : results.cases) {
      const std::string name = record.axes[0].second.get<std::string>();
      if (!errors.contains(name)) errors[name] = uniform(random, -0.5, 0.5);
      const double part = std::pow(record.axes[1].second.get<double>() / made.steps.front(), made.order);
      record.measures[0].second = made.truth({static_cast<std::size_t>(name.back() - '0')}) * (1 + errors[name] * part);
    }
    const Answered answered = answer_of(results, {{"rank", "impulse"}, {"over", "mass"}});
    apart += check_places(answered, [&](const VerdictRow& row) {
      return made.truth({static_cast<std::size_t>(row.level.back() - '0')});
    });
  }
  CHECK(apart > tries / 2);
}

TEST_CASE("asks: what the same draws move alike is ranked by its differences, and rarely against the truth") {
  Made made;
  made.choices = {{"mass", {"m0", "m1", "m2"}}, {seed_axis, {"1", "2", "3", "4"}}};
  const auto rank = [&] { return answer_of(made.results(), {{"rank", "impulse"}, {"over", "mass"}}); };
  made.truth = [](const std::vector<std::size_t>& at) { return 1 + 0.1 * static_cast<double>(at[0]); };
  made.error = 0.01;
  made.scatter = 0.2;
  const Answered alike = rank();
  INFO(alike.sentence);
  CHECK(alike.verdict == "told apart");
  CHECK(*alike.rows[0].low < *alike.rows[1].high);
  CHECK(alike.rows[0].level == "m2");
  CHECK(alike.rows[0].reason == "by its difference from the next at equal steps and seeds");
  // Draws of their own: with equal truths an order is told by chance, of three pairs each in one of twenty.
  made.truth = [](const std::vector<std::size_t>&) { return 1.0; };
  made.scatter = 0;
  made.chance = 0.1;
  int told = 0;
  for (made.first_seed = 1; made.first_seed <= 200; ++made.first_seed) told += rank().verdict != "not told apart";
  CHECK(told <= 20);
}

TEST_CASE("asks: first in all combinations is first in each") {
  std::mt19937 random(12);
  std::size_t all_told = 0;
  for (int k = 0; k < tries / 4; ++k) {
    Made made = random_methods(random, 3);
    made.choices.push_back({"contact", {"a", "b", "c"}});
    const auto truth = made.truth;
    std::vector<double> factors;
    for (int c = 0; c < 9; ++c) factors.push_back(uniform(random, 0.9, 1.1));
    made.truth = [=](const std::vector<std::size_t>& at) { return truth({at[0]}) * factors[3 * at[0] + at[1]]; };
    const Answered answered = answer_of(made.results(), {{"rank", "impulse"}, {"over", "mass"}});
    std::set<std::size_t> firsts;
    for (std::size_t c = 0; c < 3; ++c) {
      std::size_t best = 0;
      for (std::size_t m = 1; m < 3; ++m)
        if (made.truth({m, c}) > made.truth({best, c})) best = m;
      firsts.insert(best);
    }
    INFO(answered.sentence);
    if (answered.sentence.find("the same first in all 3") != std::string::npos) {
      CHECK(firsts.size() == 1);
      ++all_told;
    }
    if (answered.verdict == "turned round") CHECK(firsts.size() > 1);
  }
  CHECK(all_told > tries / 100);
}

TEST_CASE("asks: a ranking tells the most frequent order first, and where it is turned round") {
  Made made;
  made.choices = {{"mass", {"m0", "m1"}}, {"time", {"t0", "t1", "t2"}}};
  made.truth = [](const std::vector<std::size_t>& at) { return at[1] == 0 ? 2.0 - at[0] : 1.0 + at[0]; };
  made.error = 0.001;
  const Answered answered = answer_of(made.results(), {{"rank", "impulse"}, {"over", "mass"}});
  INFO(answered.sentence);
  CHECK(answered.verdict == "turned round");
  CHECK(answered.passes == Verdict::no);
  CHECK(answered.sentence.find("t1") != std::string::npos);
  CHECK(answered.sentence.find("m0 is first with t0") != std::string::npos);
}

TEST_CASE("asks: where one that is ranked has no value, none is called the largest") {
  Made made;
  made.choices = {{"mass", {"m0", "m1", "m2"}}};
  made.truth = [](const std::vector<std::size_t>& at) { return static_cast<double>(at[0]); };
  made.error = 1e-3;
  StudyResults results = made.results();
  for (CaseRecord& record : results.cases)
    if (record.axes[0].second != "m0") record.measures.clear();
  const Answered answered = answer_of(results, {{"rank", "impulse"}, {"over", "mass"}});
  INFO(answered.sentence);
  CHECK(answered.sentence.find("Open: ") == 0);
  CHECK(answered.sentence.find("2 of 3 have no value") != std::string::npos);
  CHECK(answered.passes == Verdict::open);
}

TEST_CASE("asks: beside a member without a value nothing has a place") {
  Made made;
  made.choices = {{"mass", {"m0", "m1", "m2"}}};
  made.truth = [](const std::vector<std::size_t>& at) { return static_cast<double>(at[0]); };
  made.error = 1e-6;
  StudyResults results = made.results();
  for (CaseRecord& record : results.cases)
    if (record.axes[0].second == "m2") record.measures.clear();
  const Answered open = answer_of(results, {{"rank", "impulse"}, {"over", "mass"}});
  INFO(open.sentence);
  CHECK(open.passes == Verdict::open);
  for (const VerdictRow& row : open.rows) CHECK(row.verdict == "open");
  // What is refused is no member.
  for (CaseRecord& record : results.cases)
    if (record.axes[0].second == "m2") record.status = Status::refused;
  CHECK(answer_of(results, {{"rank", "impulse"}, {"over", "mass"}}).passes == Verdict::yes);
}

TEST_CASE("asks: what is not settled, and touches no neighbour, is told as that") {
  // One rises by a thousandth at each halving, the other by three.
  const StudyResults results = two_methods({0.924, 0.925, 0.926, 0.927}, {0.903, 0.906, 0.909, 0.912});
  const Answered ranked = answer_of(results, {{"rank", "impulse"}, {"over", "mass"}});
  INFO(ranked.sentence);
  CHECK(ranked.verdict == "not told apart");
  for (const VerdictRow& row : ranked.rows) CHECK(row.reason == "it still rises with the step");
}

TEST_CASE("asks: what an axis says nothing of is not ranked, and no level is \"none\"") {
  Made made;
  made.choices = {{"contact", {"signorini", "penalty"}}, {"contact.stiffness", {"1", "2"}}};
  made.truth = [](const std::vector<std::size_t>& at) { return 1.0 + static_cast<double>(at[1]); };
  made.error = 1e-3;
  StudyResults results = made.results();
  std::erase_if(results.cases,
                [](const CaseRecord& one) { return one.axes[0].second == "signorini" && one.axes[1].second == "2"; });
  for (CaseRecord& record : results.cases)
    if (record.axes[0].second == "signorini") record.axes[1].second = nullptr;
  const Answered ranked = answer_of(results, {{"rank", "impulse"}, {"over", "contact.stiffness"}});
  INFO(ranked.sentence);
  CHECK(ranked.verdict == "told apart");
  CHECK(ranked.rows.size() == 2);
  const Answered effect = answer_of(results, {{"effect", "contact.stiffness"}, {"on", "impulse"}, {"from", 0.01}});
  for (const VerdictRow& row : effect.rows) CHECK_FALSE(row.level.ends_with("against "));
}

TEST_CASE("asks: one wide interval stands aside, and the others have their places") {
  // Each method has its values at three steps; the first scatters over all others.
  const std::vector<std::vector<double>> values = {
      {1.0, 9.0, 4.0}, {3.001, 3.0005, 3.0002}, {2.001, 2.0005, 2.0002}, {1.001, 1.0005, 1.0002}};
  const StudyResults results = synthetic::full_factorial(
      {{"mass", {"m0", "m1", "m2", "m3"}}}, {4e-3, 2e-3, 1e-3},
      [&](const std::vector<std::size_t>& at, double h) {
        return values[at[0]][static_cast<std::size_t>(std::lround(std::log2(4e-3 / h)))];
      },
      "impulse");
  const Answered answered = answer_of(results, {{"rank", "impulse"}, {"over", "mass"}});
  INFO(answered.sentence);
  CHECK(answered.passes == Verdict::open);
  CHECK(answered.verdict == "in part");
  CHECK_THAT(answered.sentence, Catch::StartsWith("Largest impulse, m0 aside: m1 "));
  std::vector<std::string> places;
  for (const VerdictRow& row : answered.rows) places.push_back(row.level + " " + row.verdict);
  CHECK(places == std::vector<std::string>{"m0 1 to 4", "m1 1 to 2", "m2 2 to 3", "m3 3 to 4"});
}

TEST_CASE(
    "asks: a stop that nothing touches comes last, whatever its law says, and where none is touched none is first") {
  StudyResults results = synthetic::full_factorial(
      {{"mass", {"m0"}}}, {4e-3, 2e-3, 1e-3}, [](const std::vector<std::size_t>&, double h) { return 1 + h; },
      "impulse[a]");
  const auto add = [&](const std::string& name, double value) {
    for (CaseRecord& record : results.cases) record.measures.emplace_back(name, value);
  };
  add("impulse[b]", 0);
  add("impulse[c]", 2);
  const Json ask = {{"rank", "impulse"}, {"over", "stops"}};
  const Answered answered = answer_of(results, ask);
  INFO(answered.sentence);
  CHECK(answered.passes == Verdict::yes);
  CHECK_THAT(answered.sentence, Catch::Contains("nothing touches b"));
  REQUIRE(answered.rows.size() == 3);
  CHECK(answered.rows[0].stop == "c");
  CHECK(answered.rows[1].stop == "a");
  CHECK((answered.rows[2].stop == "b" && answered.rows[2].verdict == "last"));
  for (CaseRecord& record : results.cases)
    for (auto& [name, value] : record.measures) value = 0;
  const Answered none = answer_of(results, ask);
  INFO(none.sentence);
  CHECK(none.passes == Verdict::open);
  CHECK(none.reason == "nothing is touched");
}

TEST_CASE("asks: what a difference tells apart is no reason to have no place") {
  // The first and the last level have the same draws, between them one that draws by itself.
  const std::vector<double> draws = {-1, 1, -0.6, 0.7}, own = {0.9, -1, 0.8, -0.6};
  const StudyResults results = synthetic::full_factorial(
      {{"mass", {"m0", "m1", "m2"}}, {"seed", {"1", "2", "3", "4"}}}, {4e-3, 2e-3, 1e-3},
      [&](const std::vector<std::size_t>& at, double h) {
        return 10 + h - 0.1 * static_cast<double>(at[0]) + (at[0] == 1 ? own : draws)[at[1]];
      },
      "impulse");
  const Answered answered = answer_of(results, {{"rank", "impulse"}, {"over", "mass"}});
  INFO(answered.sentence);
  REQUIRE(answered.rows.size() == 3);
  for (const VerdictRow& row : answered.rows) {
    INFO(row.level << " " << row.verdict);
    if (row.level == "m1") continue;
    CHECK(row.verdict == (row.level == "m0" ? "1 to 2" : "2 to 3"));
    CHECK(row.reason == "its difference from m1 is not told from zero");
  }
}
