// The verbs `motions` and `effect` on motions of made diagrams: changes lie where they were made, whatever the order.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "runners/asks/kind_verbs.hpp"
#include "runners/kinds/bifurcation/bifurcation.hpp"
#include "runners/kinds/sweep/diagram_tables.hpp"
#include "runners/kinds/sweep/motion_asks.hpp"

namespace ricochet::tests_of_sweep_asks {

using Catch::Matchers::Contains;

namespace {

const MotionClass one{Regime::periodic, 1}, two{Regime::periodic, 2}, three{Regime::periodic, 3},
    none{Regime::no_contact, 0}, open{Regime::undecided, 0};

struct Made {
  StudyResults results;
  SweptMotions swept;
};

/// Cases of two schemes or more, each with its motions at 1, 2, 3, …; with as many steps, which change nothing.
Made study_of(const std::vector<std::vector<MotionClass>>& motions, std::mt19937* random = nullptr,
              const std::vector<int>& steps = {1000}) {
  std::vector<std::vector<MotionClass>> cases;
  for (const auto& of : motions) cases.insert(cases.end(), steps.size(), of);
  Made out;
  out.results.kind = "bifurcation";
  out.results.columns = {"time", "steps_per_period"};
  out.results.study = {{"parameter", {{"pointer", "/scene/support/pulsation"}}}};
  out.swept.diagram.starts = {{"rest", false}};
  for (std::size_t c = 0; c < cases.size(); ++c) {
    CaseRecord& record = out.results.cases.emplace_back();
    record.id = "c" + std::to_string(c);
    record.status = Status::done;
    record.axes = {{"time", "scheme" + std::to_string(c / steps.size() + 1)},
                   {"steps_per_period", steps[c % steps.size()]}};
    DiagramCase& of = out.swept.diagram.cases.emplace_back();
    for (std::size_t k = 0; k < cases[c].size(); ++k) {
      DiagramRun run;
      run.parameter = static_cast<double>(k + 1);
      run.motion = cases[c][k];
      run.settled = true;
      run.attractor = run.motion.decided() ? static_cast<int>(10 * c) + run.motion.period : 0;
      of.runs.push_back(run);
    }
    if (random) std::shuffle(of.runs.begin(), of.runs.end(), *random);
  }
  out.swept.diagram.number_values();
  for (const CaseRecord& record : out.results.cases) out.swept.records.push_back(&record);
  return out;
}

asks::Answered ask(const Made& made, const Json& keys) {
  const Choices choices(made.results);
  const asks::Evidence evidence(choices);
  const asks::Ask asked = asks::ask_of(keys, 1);
  return asked.has("effect") ? effect_on_sweep(asked, evidence, made.swept)
                             : motions_of_sweep(asked, evidence, made.swept);
}

const Json motions = {{"motions", "support.pulsation"}};

}  // namespace

TEST_CASE("motions are told in the order of the parameter, changes between the values where they lie", "[asks]") {
  const asks::Answered out = ask(study_of({{one, one, two, two, three}, {one, one, two, two, three}}), motions);
  INFO(out.sentence);
  CHECK_THAT(out.sentence, Contains("with every method from period 1 to 2 (2–3), period 2 to 3 (4–5"));
  CHECK(out.passes == asks::Verdict::yes);
  std::size_t changes = 0;
  for (const asks::VerdictRow& row : out.rows)
    changes += row.verdict == "period 1 to period 2" && row.low == 2 && row.high == 3;
  CHECK(changes == 2);
}

TEST_CASE("a change of one method alone is not that of every method", "[asks]") {
  const asks::Answered out = ask(study_of({{one, one, two, two, two}, {one, one, two, two, three}}), motions);
  CHECK_THAT(out.sentence, Contains("period 1 to 2 (2–3") && !Contains("2 to 3"));
  REQUIRE_FALSE(out.aside.empty());
  CHECK_THAT(out.aside.front(), Contains("One change of the motion"));
}

TEST_CASE("what is undecided stands first above a quarter, and behind it below", "[asks]") {
  asks::Answered out = ask(study_of({{one, two, open, open, open}}), motions);
  INFO(out.sentence);
  // Values stand for the range that is nearest to them: half an interval at an end.
  CHECK_THAT(out.sentence, Catch::Matchers::StartsWith("62 % of the range is undecided") ||
                               Catch::Matchers::StartsWith("63 % of the range is undecided"));
  CHECK(*out.rows.front().value == Approx(62.5));
  CHECK(out.passes == asks::Verdict::open);
  CHECK_THAT(out.sentence, Contains("period 1 to 2 (1–2"));
  out = ask(study_of({{one, two, two, two, open}}), motions);
  CHECK_THAT(out.sentence, Catch::Matchers::EndsWith("12 % of the range is undecided.") ||
                               Catch::Matchers::EndsWith("13 % of the range is undecided."));
  CHECK(out.passes == asks::Verdict::yes);
  // Two cases that differ are not undecided; one that is open beside one that is not leaves it open.
  out = ask(study_of({{one, one, two, open, open}, {one, two, two, two, open}}), motions);
  CHECK(*out.rows.front().value == Approx(37.5));
  out = ask(study_of({{open, open, open}}), motions);
  CHECK_THAT(out.sentence, Catch::Matchers::StartsWith("Open: no orbit is decided"));
}

TEST_CASE("an undecided start hides a motion and makes no change", "[asks]") {
  // From below no contact, from above period 1 wherever it is decided: both all along, but for the last value.
  Made made = study_of({{none, none, none, none, one}});
  made.swept.diagram.starts = {{"up", false}, {"down", false}};
  std::vector<DiagramRun>& runs = made.swept.diagram.cases.front().runs;
  const std::vector<MotionClass> down = {open, one, open, one, one};
  for (std::size_t k = 0; k < down.size(); ++k) {
    DiagramRun run = runs[k];
    run.start = 1;
    run.motion = down[k];
    run.attractor = run.motion.decided() ? run.motion.period : 0;
    runs.push_back(run);
  }
  runs[4].attractor = runs[9].attractor;
  const asks::Answered out = ask(made, motions);
  INFO(out.sentence);
  CHECK_THAT(out.sentence, Contains("from no contact and period 1 to period 1 (4–5") && !Contains("more"));
  // Half of the starts, over an eighth and a quarter of the range.
  CHECK(*out.rows[0].value == Approx(50 * (0.125 + 0.25)));
  CHECK(*out.rows[1].value == *out.rows[0].value);
  const auto stretch = std::find_if(out.rows.begin(), out.rows.end(),
                                    [](const auto& row) { return row.verdict == "no contact and period 1"; });
  REQUIRE(stretch != out.rows.end());
  CHECK(stretch->low == 1);
  CHECK(stretch->high == 4);
  CHECK(stretch->reason == "2 of 8 orbits are undecided");
}

TEST_CASE("kept periods that tell nothing of what does not repeat are said above the motions", "[asks]") {
  const auto aside_of = [](int keep, int exponents, const std::vector<MotionClass>& motions_of_case) {
    Made made = study_of({motions_of_case});
    made.results.study["keep"] = keep;
    made.results.study["exponents"] = exponents;
    return ask(made, motions).aside;
  };
  REQUIRE(aside_of(40, 0, {one, open}).size() == 1);
  CHECK(aside_of(40, 0, {one, open}).front() ==
        "40 kept periods without an exponent leave undecided whatever does not repeat; 60 tell regular from chaotic.");
  CHECK(aside_of(40, 1, {one, open}).empty());
  CHECK(aside_of(60, 0, {one, open}).empty());
  CHECK(aside_of(40, 0, {one, two}).empty());
}

TEST_CASE("motions beside each other are counted by attractor", "[asks]") {
  Made made = study_of({{one, one, two}});
  made.swept.diagram.starts = {{"rest", false}, {"up", false}};
  std::vector<DiagramRun>& runs = made.swept.diagram.cases.front().runs;
  for (int k = 0; k < 3; ++k) {
    DiagramRun run = runs[static_cast<std::size_t>(k)];
    run.start = 1;
    run.attractor += k == 1 ? 100 : 0;
    runs.push_back(run);
  }
  made.swept.diagram.number_values();
  const asks::Answered out = ask(made, motions);
  CHECK_THAT(out.sentence, Contains("period 1 to two of period 1 (1–2), two of period 1 to period 2 (2–3"));
}

TEST_CASE("orbits that are refused or end early keep a sweep from having run", "[asks]") {
  const auto runs_of = [](std::size_t refused, std::size_t diverged, bool all_done = true) {
    Made made = study_of({{one, one, two}, {one, two, two}});
    if (!all_done) {
      made.results.cases[1].status = Status::refused;
      made.results.cases[1].reasons = {Said("it does not apply")};
    }
    const Choices choices(made.results);
    const asks::Evidence evidence(choices);
    return asks::runs_of_places(asks::ask_of({{"runs", true}}, 1), evidence, "orbits", [&](const CaseRecord& record) {
      asks::Places out{3, {}};
      if (record.id != "c0") return out;
      if (refused > 0) out.ended["refused"] = refused;
      if (diverged > 0) out.ended["diverged"] = diverged;
      return out;
    });
  };
  CHECK(runs_of(0, 0).sentence == "Yes: all 2 cases run.");
  CHECK(runs_of(0, 0).passes == asks::Verdict::yes);
  const asks::Answered refused = runs_of(2, 0), ended = runs_of(1, 1), both = runs_of(2, 0, false);
  CHECK(refused.sentence == "2 of 2 cases run; of their 6 orbits, 2 refused.");
  CHECK(refused.passes == asks::Verdict::open);
  CHECK(ended.sentence == "2 of 2 cases run; of their 6 orbits, 1 diverged and 1 refused.");
  CHECK(ended.passes == asks::Verdict::no);
  CHECK(ended.rows.back().level == "orbits refused");
  CHECK(*ended.rows.back().value == 1);
  CHECK(both.sentence == "1 of 2 cases run; 1 refused (it does not apply); of their 6 orbits, 2 refused.");
  CHECK(both.passes == asks::Verdict::open);
}

TEST_CASE("rows in another order change no verdict", "[asks]") {
  std::mt19937 random(11);
  for (int draw = 0; draw < 30; ++draw) {
    const MotionClass some[] = {one, two, three, open};
    std::vector<std::vector<MotionClass>> cases(2);
    for (std::vector<MotionClass>& list : cases)
      for (int k = 0; k < 9; ++k) list.push_back(some[random() % 4]);
    const asks::Answered before = ask(study_of(cases), motions), after = ask(study_of(cases, &random), motions);
    CHECK(before.sentence == after.sentence);
    REQUIRE(before.rows.size() == after.rows.size());
    for (std::size_t k = 0; k < before.rows.size(); ++k) {
      CHECK(before.rows[k].verdict == after.rows[k].verdict);
      CHECK(before.rows[k].low == after.rows[k].low);
    }
  }
}

TEST_CASE("a choice changes the motion at the values where class or period differ", "[asks]") {
  const Json effect = {{"effect", "time"}, {"on", "motions"}, {"from", 0.2}};
  const auto twice = [](const std::vector<std::vector<MotionClass>>& cases) {
    return study_of(cases, nullptr, {500, 1000});
  };
  asks::Answered out = ask(twice({{one, one, two, two, three}, {one, two, two, two, two}}), effect);
  CHECK(out.sentence == "Yes: the time scheme changes the motion of 2 of 5 values (scheme2 against scheme1).");
  out = ask(twice({{one, one, two, two, three}, {one, one, two, two, three}}), effect);
  CHECK(out.passes == asks::Verdict::no);
  CHECK_THAT(out.sentence, Contains("none of the 5 values"));
  out = ask(twice({{one, one, two, two, open}, {one, one, two, open, open}}), effect);
  CHECK(out.passes == asks::Verdict::open);
  // Shares of places are told over all of them, the undecided ones too: 3 of 9 are no less than 1 % of 17.
  const std::vector<MotionClass> ones(9, one), others = {two, two, two, one, one, one, one, one, one};
  auto a = ones, b = others;
  a.insert(a.end(), 8, open);
  b.insert(b.end(), 8, open);
  out = ask(twice({a, b}), {{"effect", "time"}, {"on", "motions"}, {"from", 0.01}});
  CHECK(out.passes == asks::Verdict::yes);
}

}  // namespace ricochet::tests_of_sweep_asks
