// The verbs `order` and `cheapest` on made errors: never a wrong order, no accuracy by chance.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "runners/asks/kind_verbs.hpp"
#include "runners/kinds/comparison/comparison_answers.hpp"

namespace ricochet::tests_of_error_asks {

using Catch::Matchers::Contains;

namespace {

/// One scheme: its errors by step, each with a time.
struct Scheme {
  std::string name;
  std::vector<double> errors;
  double floor = 0, seconds = 1e-3;  ///< of the coarsest step; halved steps take twice as long
};

StudyResults study_of(const std::vector<Scheme>& schemes, double size = 1) {
  StudyResults out;
  out.kind = "work-precision";
  out.columns = {"time", "step"};
  out.study = {{"errors", {"impulse"}}};
  for (const Scheme& scheme : schemes)
    for (std::size_t k = 0; k < scheme.errors.size(); ++k) {
      CaseRecord record;
      record.id = scheme.name + std::to_string(k);
      const double h = std::pow(2, -static_cast<double>(k));
      record.axes = {{"time", scheme.name}, {"step", h}};
      record.status = std::isnan(scheme.errors[k]) ? Status::diverged : Status::done;
      if (record.status == Status::diverged) record.reasons = {Said("energy that nothing gave")};
      if (record.status == Status::done)
        record.measures = {{"error.impulse", scheme.errors[k]},
                           {"floor.impulse", scheme.floor},
                           {"size.impulse", size},
                           {"timed_seconds", scheme.seconds / h},
                           {"timed_low", 0.9 * scheme.seconds / h},
                           {"timed_high", 1.1 * scheme.seconds / h}};
      out.cases.push_back(std::move(record));
    }
  return out;
}

asks::Answered ask(const StudyResults& results, const Json& keys) {
  const Choices choices(results);
  const asks::Evidence evidence(choices);
  const asks::Ask one = asks::ask_of(keys, 1);
  return one.has("order") ? order_ask(one, evidence) : cheapest_ask(one, evidence);
}

std::vector<double> powers(double p, std::size_t count, double level = 0) {
  std::vector<double> out;
  for (std::size_t k = 0; k < count; ++k) out.push_back(std::pow(2, -p * static_cast<double>(k)) + level);
  return out;
}

const asks::VerdictRow& row_of(const asks::Answered& answered, const std::string& level) {
  for (const asks::VerdictRow& row : answered.rows)
    if (row.level == level) return row;
  throw std::out_of_range(level);
}

}  // namespace

TEST_CASE("a clean order is that of the errors, whatever the floor of the reference", "[asks]") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(0, 1);
  std::size_t clean = 0, wide = 0, missed = 0;
  for (int draw = 0; draw < 400; ++draw) {
    constexpr double orders[] = {0.5, 1, 1.5, 2, 3, 4};
    const double p = orders[random() % 6], floor = std::pow(10, -12 * any(random));
    std::vector<double> errors = powers(p, 3 + random() % 7);
    std::size_t above = 0;
    for (double& one : errors) {
      above += one > 30 * floor;
      one = std::abs(one + floor * (2 * any(random) - 1));
    }
    const asks::Answered out = ask(study_of({{"one", errors, floor}}), {{"order", "impulse"}});
    REQUIRE(out.rows.size() == 1);
    const asks::VerdictRow& row = out.rows.front();
    INFO(p << " floor " << floor << ": " << out.sentence);
    // Errors at three floors are a third off: two slopes between halved steps are then 0.3 off, and by bad luck 0.5.
    if (row.verdict == "clean") {
      CHECK(std::abs(*row.value - p) < 0.55);
      wide += std::abs(*row.value - p) > 0.35;
      CHECK(*row.low <= *row.value);
      CHECK(*row.value <= *row.high);
      ++clean;
    } else {
      // Four errors far above the floor leave no doubt.
      missed += above >= 4;
      CHECK(row.reason != "");
    }
  }
  CHECK(clean > 200);
  CHECK(wide <= 2);
  CHECK(missed == 0);
}

TEST_CASE("an order ends where the errors do, and what follows no order has none", "[asks]") {
  const StudyResults results = study_of({{"clean", powers(2, 7)},
                                         {"level", powers(2, 9, 1e-3)},
                                         {"stays", {1, 0.9, 1, 0.95, 1, 0.9, 1}},
                                         {"jumps", {1, 0.1, 0.09, 0.002, 0.0019, 0.0001, 0.00009}},
                                         {"floor", powers(2, 7), 10},
                                         {"short", {1, 0.25}},
                                         {"lost", {NAN, NAN, NAN}}});
  const asks::Answered out = ask(results, {{"order", "error.impulse"}});
  const auto verdict = [&](const std::string& level) { return row_of(out, level).verdict; };
  CHECK(verdict("clean") == "clean");
  CHECK(*row_of(out, "clean").value == Approx(2));
  CHECK(verdict("level") == "clean");
  CHECK_THAT(row_of(out, "level").reason, Contains("the least error is 0.001 N s"));
  for (const char* level : {"stays", "jumps"}) {
    CHECK(verdict(level) == "none");
    CHECK_FALSE(row_of(out, level).value);
  }
  CHECK(verdict("floor") == "hidden");
  CHECK_THAT(row_of(out, "floor").reason, Contains("floor of the reference, 10 N s"));
  CHECK(verdict("short") == "hidden");
  CHECK(verdict("lost") == "no error");
  CHECK_THAT(row_of(out, "lost").reason, Contains("3 diverged: energy"));
  CHECK(out.left_out == 3);
  CHECK(out.passes == asks::Verdict::no);
  // Each series has its own floor.
  for (const auto& series : out.figure["series"])
    CHECK(series.value("floor", 0.0) == (series["name"] == "floor" ? 10 : 0));
}

TEST_CASE("rows in another order, and other cases, change no order", "[asks]") {
  std::mt19937 random(3);
  StudyResults results = study_of({{"one", powers(1, 6)}, {"other", powers(2, 6, 1e-5)}});
  const asks::Answered before = ask(results, {{"order", "impulse"}});
  std::shuffle(results.cases.begin(), results.cases.end(), random);
  const asks::Answered after = ask(results, {{"order", "impulse"}});
  for (const char* level : {"one", "other"}) {
    CHECK(row_of(before, level).value == row_of(after, level).value);
    CHECK(row_of(before, level).verdict == row_of(after, level).verdict);
  }
  std::erase_if(results.cases, [](const CaseRecord& one) { return one.id.starts_with("other"); });
  CHECK(row_of(ask(results, {{"order", "impulse"}}), "").value == row_of(before, "one").value);
  CHECK(before.sentence == "Impulse: order 2.00 with other, 1.00 with one.");
}

TEST_CASE("the cheapest stays within the share at all finer steps", "[asks]") {
  // One is within 1 % at its coarsest step by chance, and again from the fifth on.
  const StudyResults results = study_of({{"chance", {0.001, 0.2, 0.1, 0.05, 0.009, 0.004}, 0, 1e-4},
                                         {"steady", {0.5, 0.1, 0.009, 0.002, 0.001, 0.001}},
                                         {"rough", {0.5, 0.4, 0.3, 0.2, 0.1, 0.05}, 0, 1e-6}});
  const asks::Answered out = ask(results, {{"cheapest", "impulse"}, {"within", 0.01}});
  INFO(out.sentence);
  REQUIRE(out.rows.size() > 3);
  CHECK(out.rows[0].verdict == "cheapest");
  CHECK(out.rows[0].level == "chance, h = 0.0625 s");
  CHECK(*out.rows[0].value == Approx(1.6e-3));
  CHECK(*out.rows[1].value == Approx(4e-3));
  CHECK(out.rows[2].verdict == "not there");
  CHECK_THAT(out.rows[2].reason, Contains("its least error is 5 %"));
  CHECK_THAT(out.sentence, Contains("Chance at h = 0.0625 s") && Contains("rough never"));
  CHECK(out.passes == asks::Verdict::yes);
}

TEST_CASE("what is exact to round-off is no refutation, and less than declared is no yes", "[asks]") {
  // Some units of round-off of a motion of 5 m over 10⁴ to 10⁵ steps.
  StudyResults exact = study_of({{"one", {9e-15, 1.4e-13, 2e-14, 4.1e-13, 1e-13}}}, 5);
  for (CaseRecord& record : exact.cases) record.steps = 100000;
  asks::Answered out = ask(exact, {{"order", "impulse"}});
  INFO(out.sentence);
  CHECK(out.passes == asks::Verdict::open);
  CHECK(out.rows.front().verdict == "hidden");
  CHECK_THAT(out.rows.front().reason, Contains("round-off"));
  // Larger errors fall or they do not.
  for (CaseRecord& record : exact.cases) record.measures.front().second *= 1e4;
  CHECK(ask(exact, {{"order", "impulse"}}).passes == asks::Verdict::no);

  StudyResults first = study_of({{"one", powers(1, 6)}});
  for (CaseRecord& record : first.cases) record.measures.emplace_back("declared_order", 1.0);
  CHECK(ask(first, {{"order", "impulse"}}).passes == asks::Verdict::yes);
  for (CaseRecord& record : first.cases) record.measures.back().second = 2;
  out = ask(first, {{"order", "impulse"}});
  CHECK(out.passes == asks::Verdict::no);
  CHECK(out.rows.front().verdict == "clean");
  CHECK_THAT(out.sentence, Contains("less than the scheme declares"));
  for (CaseRecord& record : first.cases) record.measures.back().second = 0.5;
  CHECK(ask(first, {{"order", "impulse"}}).passes == asks::Verdict::yes);
}

TEST_CASE("a tie is told as one, and what was timed once is no surer than its machine", "[asks]") {
  const Json asked = {{"cheapest", "impulse"}, {"within", 0.5}};
  StudyResults results =
      study_of({{"a", powers(1, 3), 0, 1e-3}, {"b", powers(1, 3), 0, 1.1e-3}, {"c", powers(1, 3), 0, 3e-3}});
  asks::Answered out = ask(results, asked);
  CHECK(out.verdict == "tie");
  for (CaseRecord& record : results.cases)
    std::erase_if(record.measures,
                  [](const auto& one) { return one.first == "timed_low" || one.first == "timed_high"; });
  out = ask(results, asked);
  INFO(out.sentence);
  CHECK(out.verdict == "tie");
  CHECK(out.rows[1].verdict == "the same within the timing noise");
  CHECK(out.rows[2].verdict == "there");
  CHECK_FALSE(out.rows[0].low);
  CHECK_THAT(out.rows[0].reason, Contains("timed once"));
  CHECK_THAT(out.sentence, Contains("noise") || Contains("not told apart"));
}

TEST_CASE("a crossing by chance reaches nothing, and an unknown reference tells nothing", "[asks]") {
  const Json asked = {{"cheapest", "impulse"}, {"within", 0.01}};
  asks::Answered out = ask(study_of({{"chance", {0.5, 0.001, 0.2, 0.1}}}), asked);
  CHECK(out.verdict == "nobody");
  CHECK_THAT(out.sentence, Catch::Matchers::StartsWith("Nobody"));
  CHECK_THAT(out.rows.front().reason, Contains("by chance"));
  CHECK_FALSE(out.rows.front().value);
  out = ask(study_of({{"one", {0.5, 0.001, 0.001}, 0.05}}), asked);
  CHECK(out.verdict == "open");
  CHECK_THAT(out.rows.front().reason, Contains("the reference itself is known to 5 %"));
  // A finer step that diverges leaves open whether the error stays there.
  out = ask(study_of({{"one", {0.5, 0.005, NAN}}}), asked);
  CHECK(out.verdict == "nobody");
  CHECK_THAT(out.rows.front().reason, Contains("a finer size has no error"));
  CHECK(out.left_out == 1);
}

TEST_CASE("an error that no case has is none, and no floor hides it", "[asks]") {
  StudyResults results = study_of({{"a", powers(2, 4)}, {"b", powers(2, 4)}});
  for (CaseRecord& record : results.cases) {
    record.measures.clear();
    record.left_out = {{"error.impulse", "neither motion touches a stop"}};
  }
  const asks::Answered out = ask(results, {{"order", "impulse"}});
  INFO(out.sentence);
  CHECK(out.verdict == "no error");
  CHECK_THAT(out.sentence, Contains("no error (") && Contains("neither motion touches a stop") && !Contains("floor"));
  REQUIRE(out.aside.size() == 1);
}

TEST_CASE("a curve of the cheapest is one method on one mesh, its steps in their order", "[asks]") {
  StudyResults results;
  for (const double elements : {8.0, 16.0}) {
    StudyResults one = study_of({{"a", powers(2, 4), 1e-6}, {"b", {NAN, NAN, NAN, NAN}}});
    std::reverse(one.cases.begin(), one.cases.end());
    for (CaseRecord& record : one.cases) {
      record.id += std::to_string(elements);
      record.axes.emplace_back("elements", elements);
      // Longer on the coarse mesh, and the second step is the fastest.
      for (auto& [name, value] : record.measures)
        if (name == "timed_seconds") value = (record.id[1] == '1' ? 1e-4 : value) * 16 / elements;
    }
    one.cases.insert(one.cases.begin(), results.cases.begin(), results.cases.end());
    results = one;
  }
  results.columns.push_back("elements");
  const Json series = ask(results, {{"cheapest", "impulse"}, {"within", 0.1}}).figure.at("series");
  REQUIRE(series.size() == 2);
  CHECK(series[0].at("name") == "a, 8 elements");
  CHECK(series[1].at("name") == "a, 16 elements");
  for (const Json& one : series) {
    REQUIRE(one.at("points").size() == 4);
    for (std::size_t k = 0; k < 4; ++k)
      CHECK(one.at("points")[k][1].get<double>() == Approx(100 * std::pow(4, -static_cast<double>(k))));
    CHECK(one.at("floor").get<double>() == Approx(1e-4));
  }
}

TEST_CASE("errors against rigid stops are said to hold the springs of the law", "[asks]") {
  StudyResults results = study_of({{"a", powers(2, 4)}});
  const auto told = [&](const Json& keys) {
    const asks::Answered out = ask(results, keys);
    return std::any_of(out.aside.begin(), out.aside.end(),
                       [](const std::string& one) { return one.find("rigid stops") != std::string::npos; });
  };
  for (const Json& keys : {Json{{"order", "impulse"}}, Json{{"cheapest", "impulse"}, {"within", 0.5}}}) {
    for (CaseRecord& record : results.cases) record.measures.emplace_back("reference_of_law", 0.0);
    CHECK(told(keys));
    for (CaseRecord& record : results.cases) record.measures.back().second = 1;
    CHECK_FALSE(told(keys));
    for (CaseRecord& record : results.cases) record.measures.pop_back();
  }
}

}  // namespace ricochet::tests_of_error_asks
