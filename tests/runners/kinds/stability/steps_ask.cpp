// The verb `steps` on made limits: by Weyl's inequality the stop bounds the step where its part of ω² is the larger.
#include <catch2/catch.hpp>
#include <cmath>

#include "runners/asks/kind_verbs.hpp"
#include "runners/kinds/stability/stability.hpp"
#include "runners/kinds/stability/stability_side.hpp"
#include "runners/kinds/stability/stability_tables.hpp"

namespace ricochet::tests_of_steps_asks {

using Catch::Matchers::Contains;

namespace {

struct Spring {
  int elements;
  double open, stop;  ///< s: limit of the mesh; of the stop alone
};

/// Limits of a stop beside a mesh, one over the square of each added.
asks::Answered ask(const std::vector<Spring>& springs, const std::function<void(LimitRow&, LimitRow&)>& change = {}) {
  StudyResults results;
  results.kind = "stability";
  results.columns = {"elements"};
  results.study = {{"steps", {{"from", 1e-7}, {"to", 1e-3}}}};
  std::vector<LimitRow> rows;
  for (const Spring& one : springs) {
    CaseRecord& record = results.cases.emplace_back();
    record.id = "c" + std::to_string(one.elements);
    record.status = Status::done;
    record.axes = {{"elements", one.elements}};
    LimitRow open, closed;
    open.id = closed.id = record.id;
    closed.closed = true;
    open.prediction = closed.prediction = open.observation = closed.observation = RangeLimit::limit;
    open.predicted = open.observed = one.open;
    closed.predicted = closed.observed = 1 / std::sqrt(1 / (one.open * one.open) + 1 / (one.stop * one.stop));
    closed.agrees = true;
    if (change) change(open, closed);
    rows.push_back(open);
    rows.push_back(closed);
  }
  const Choices choices(results);
  return steps_ask(asks::ask_of({{"steps", "limit"}}, 1), asks::Evidence(choices), rows);
}

}  // namespace

TEST_CASE("the stop bounds the step where it alone has the smaller limit, and the mesh elsewhere", "[asks]") {
  const std::vector<Spring> springs = {
      {4, 2.3e-4, 3.5e-5}, {8, 5.7e-5, 2.8e-5}, {16, 1.4e-5, 6.5e-5}, {32, 1e-5, 1.001e-5}};
  const asks::Answered out = ask(springs);
  INFO(out.sentence);
  REQUIRE(out.rows.size() == springs.size());
  for (std::size_t k = 0; k < springs.size(); ++k) {
    CHECK(out.rows[k].verdict == (springs[k].stop < springs[k].open ? "the stop" : "the mesh"));
    CHECK(*out.rows[k].value < std::min(springs[k].open, springs[k].stop));
  }
  CHECK_THAT(out.rows.front().level, Contains("4 elements"));
  CHECK_THAT(out.sentence, Contains("The closed stop bounds the step") && Contains("; the mesh "));
  CHECK(out.passes == asks::Verdict::yes);
}

TEST_CASE("a step that is read off a sentence is allowed", "[asks]") {
  for (const double open : {8.0952e-5, 9.999e-5, 1e-4, 3.333333e-5}) {
    const asks::Answered out = ask({{4, open, 1}});
    const std::size_t bracket = out.sentence.find('(');
    INFO(out.sentence);
    REQUIRE(bracket != std::string::npos);
    const double read = std::stod(out.sentence.substr(bracket + 1));
    CHECK(read <= open * (1 + 1e-12));  // the same decimals
    CHECK(read > 0.99 * open);          // three digits
  }
}

TEST_CASE("a limit below the range of steps is none that a study may take", "[asks]") {
  const asks::Answered out = ask({{4, 1e-8, 1}});
  INFO(out.sentence);
  CHECK(out.passes == asks::Verdict::no);
  CHECK(out.rows.front().verdict == "no step is stable");
  CHECK(out.sentence == "No stable step from 1e-7 to 0.001 s.");
}

TEST_CASE("what has no limit, no stable step or another limit in marches is told so", "[asks]") {
  asks::Answered out = ask({{4, 1e-4, 1e-3}}, [](LimitRow& open, LimitRow& closed) {
    open.prediction = closed.prediction = open.observation = closed.observation = RangeLimit::none;
    open.predicted = closed.predicted = open.observed = closed.observed = {};
  });
  CHECK(out.rows.front().verdict == "no limit");
  CHECK_FALSE(out.rows.front().value);
  CHECK(out.sentence == "No limit from 1e-7 to 0.001 s.");
  out = ask({{4, 1e-4, 1e-3}}, [](LimitRow& open, LimitRow&) { open.prediction = RangeLimit::below; });
  CHECK(out.passes == asks::Verdict::no);
  CHECK_FALSE(out.rows.front().value);
  // A closed stop may have a limit where the structure has none.
  out = ask({{4, 1e-4, 1e-3}}, [](LimitRow& open, LimitRow&) {
    open.prediction = RangeLimit::none;
    open.predicted.reset();
  });
  CHECK(out.rows.front().verdict == "the stop");
  out = ask({{4, 1e-4, 1e-3}}, [](LimitRow&, LimitRow& closed) {
    closed.observed = 0.5 * *closed.predicted;
    closed.agrees = false;
  });
  CHECK(*out.rows.front().value == *out.rows.front().low);
  CHECK(*out.rows.front().high == Approx(2 * *out.rows.front().low));
  REQUIRE_FALSE(out.aside.empty());
  CHECK_THAT(out.aside.front(), Contains("another limit"));
}

TEST_CASE("of groups as large as each other one alone goes without its name", "[asks]") {
  // Limits of the stop, of the mesh and none, in turn: the names are long.
  std::vector<Spring> springs;
  for (int k = 0; k < 24; ++k) springs.push_back({k + 1, 1e-4, k % 3 == 0 ? 1e-5 : 1e-2});
  int number = 0;
  const asks::Answered out = ask(springs, [&](LimitRow& open, LimitRow& closed) {
    if (number++ % 3 != 2) return;
    open.prediction = closed.prediction = open.observation = closed.observation = RangeLimit::none;
    open.predicted = closed.predicted = open.observed = closed.observed = {};
  });
  INFO(out.sentence);
  const std::size_t first = out.sentence.find("elsewhere");
  CHECK((first == std::string::npos || out.sentence.find("elsewhere", first + 1) == std::string::npos));
  CHECK_THAT(out.sentence, Contains("the stop 8, the mesh 8"));
}

TEST_CASE("a step beyond which marches grow is not allowed, whatever the spectrum says", "[asks]") {
  // No spectrum grows; marches do from 3e-4 s on.
  asks::Answered out = ask({{4, 1e-4, 1e-3}}, [](LimitRow& open, LimitRow& closed) {
    open.prediction = closed.prediction = open.observation = RangeLimit::none;
    open.predicted = closed.predicted = open.observed = {};
    closed.observed = 3e-4;
    closed.agrees.reset();
  });
  INFO(out.sentence);
  CHECK(out.rows.front().verdict == "marches alone");
  CHECK(*out.rows.front().value == 3e-4);
  CHECK(out.sentence == "Marches grow beyond 3e-4 s, though no spectrum does.");
  // Of two limits that disagree the smaller one, of two that agree the predicted one.
  for (const bool agrees : {false, true}) {
    out = ask({{4, 2.3e-4, 3.5e-5}}, [&](LimitRow&, LimitRow& closed) {
      closed.observed = 0.9 * *closed.predicted;
      closed.agrees = agrees;
    });
    const double predicted = 1 / std::sqrt(1 / (2.3e-4 * 2.3e-4) + 1 / (3.5e-5 * 3.5e-5));
    CHECK(*out.rows.front().value == Approx((agrees ? 1 : 0.9) * predicted).epsilon(1e-12));
    CHECK(*out.rows.front().low == Approx(0.9 * predicted).epsilon(1e-12));
  }
}

TEST_CASE("marches with a closed stop that has no spectrum bound the step below what the mesh allows", "[asks]") {
  const auto told = [](std::optional<double> marched, RangeLimit how) {
    return ask({{4, 4e-4, 1e-3}}, [&](LimitRow&, LimitRow& closed) {
      closed.prediction = RangeLimit::not_made;
      closed.predicted = {};
      closed.observation = how;
      closed.observed = marched;
      closed.agrees.reset();
    });
  };
  const asks::Answered below = told(9e-5, RangeLimit::limit), above = told(3.99e-4, RangeLimit::limit),
                       never = told({}, RangeLimit::below), all = told({}, RangeLimit::none);
  CHECK(below.rows.front().verdict == "marches alone");
  CHECK(*below.rows.front().value == 9e-5);
  CHECK(below.sentence == "Marches grow beyond 9e-5 s.");
  CHECK_THAT(below.rows.front().reason, Contains("the closed stop was not predicted"));
  CHECK(above.rows.front().verdict == "the mesh");
  CHECK(never.passes == asks::Verdict::no);
  CHECK(all.rows.front().verdict == "the mesh");
}

TEST_CASE("impacts make no energy where the open structure has a limit of its own", "[asks]") {
  const auto gains = [](RangeLimit open_limit) {
    const asks::Answered out = ask({{4, 1e-4, 1e-3}}, [&](LimitRow& open, LimitRow& closed) {
      open.prediction = open.observation = open_limit;
      if (open_limit == RangeLimit::none) open.predicted = open.observed = {};
      closed.prediction = RangeLimit::none;
      closed.predicted = {};
      closed.disagreeing = 2;
      closed.observed = 5e-4;
    });
    return std::any_of(out.aside.begin(), out.aside.end(),
                       [](const std::string& one) { return one.starts_with("Impacts make energy"); });
  };
  CHECK(gains(RangeLimit::none));
  CHECK_FALSE(gains(RangeLimit::limit));
}

TEST_CASE("a scene that meets the stop only as it grows without contact shows nothing of contact", "[stability]") {
  const auto cell = [](bool stable, bool touched) {
    ObservedCell one;
    one.behaviour = stable ? Behaviour::stable : Behaviour::growing;
    one.touched = touched;
    return std::optional(one);
  };
  const std::vector<std::optional<ObservedCell>> open = {cell(true, false), cell(true, false), cell(false, false)};
  const auto untouched = [&](std::vector<std::optional<ObservedCell>> cells) {
    StabilitySide side;
    side.closed = true;
    side.cells = std::move(cells);
    side.forget_untouched(open);
    return side.untouched;
  };
  CHECK(untouched({cell(true, false), cell(true, false), cell(false, true)}));
  // It touches while it is stable, or grows where it does not without contact.
  CHECK_FALSE(untouched({cell(true, true), cell(true, true), cell(false, true)}));
  CHECK_FALSE(untouched({cell(true, false), cell(false, true), cell(false, true)}));
  CHECK_FALSE(untouched({std::nullopt, std::nullopt, std::nullopt}));
}

}  // namespace ricochet::tests_of_steps_asks
