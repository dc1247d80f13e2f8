// The verbs `motions` and `effect` on motions of made grids: shares are exact, numbers of attractors mean nothing.
#include <catch2/catch.hpp>
#include <random>

#include "runners/kinds/basins/basin_analysis.hpp"
#include "runners/kinds/basins/basins.hpp"
#include "runners/kinds/sweep/motion_asks.hpp"

namespace ricochet::tests_of_basin_asks {

using Catch::Matchers::Contains;

namespace {

const MotionClass none{Regime::no_contact, 0}, one{Regime::periodic, 1}, two{Regime::periodic, 2},
    open{Regime::undecided, 0}, failed{Regime::failed, 0};

GridCell cell(const MotionClass& motion, int attractor) {
  GridCell out;
  out.present = true;
  out.motion = motion;
  out.end = out.attractor = attractor;
  return out;
}

struct Grids {
  StudyResults results;
  BasinAnalysis analysis;
};

/// A case for each grid and each number of steps, which changes nothing; restitution 0.1, 0.2, …
Grids study_of(const std::vector<std::vector<GridCell>>& grids, const std::vector<int>& steps = {1000}) {
  Grids out;
  out.results.kind = "basins";
  out.results.columns = {"time.restitution", "steps_per_period"};
  for (std::size_t c = 0; c < grids.size(); ++c)
    for (const int count : steps) {
      CaseRecord& record = out.results.cases.emplace_back();
      record.id = "c" + std::to_string(c) + "-" + std::to_string(count);
      record.status = Status::done;
      record.axes = {{"time.restitution", 0.1 * static_cast<double>(c + 1)}, {"steps_per_period", count}};
      BasinGrid grid;
      grid.columns = grids[c].size();
      grid.rows = 1;
      grid.cells = grids[c];
      out.analysis.grids.push_back(std::move(grid));
    }
  for (const CaseRecord& record : out.results.cases) out.analysis.records.push_back(&record);
  return out;
}

asks::Answered ask(const Grids& grids, const Json& keys) {
  const Choices choices(grids.results);
  const asks::Evidence evidence(choices);
  const asks::Ask asked = asks::ask_of(keys, 1);
  return asked.has("effect") ? effect_on_basins(asked, evidence, grids.analysis)
                             : motions_of_basins(asked, evidence, grids.analysis);
}

}  // namespace

TEST_CASE("places of another class or period have changed, whatever the numbers of attractors", "[asks]") {
  std::mt19937 random(5);
  for (int draw = 0; draw < 100; ++draw) {
    const MotionClass motions[] = {none, one, two};
    std::vector<GridCell> a, b;
    std::size_t changed = 0;
    const int shift = static_cast<int>(random() % 5);
    for (int k = 0; k < 60; ++k) {
      const std::size_t before = random() % 3, after = random() % 4 == 0 ? random() % 3 : before;
      a.push_back(cell(motions[before], static_cast<int>(before)));
      // Another case numbers its attractors in its own way.
      b.push_back(cell(motions[after], static_cast<int>(2 - after) + shift));
      changed += before != after;
    }
    CHECK(compare_motions(a, b).changed == changed);
    CHECK(compare_motions(b, a).changed == changed);
    CHECK(compare_motions(a, a).changed == 0);
    std::vector<std::size_t> order(a.size());
    for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
    std::shuffle(order.begin(), order.end(), random);
    std::vector<GridCell> c, d;
    for (const std::size_t k : order) c.push_back(a[k]), d.push_back(b[k]);
    CHECK(compare_motions(c, d).changed == changed);
  }
}

TEST_CASE("two motions of one class are matched by the places that they share", "[asks]") {
  // Both cases have two orbits of period 1; one place goes over from one to the other.
  const std::vector<GridCell> a = {cell(one, 0), cell(one, 0), cell(one, 0), cell(one, 1), cell(one, 1)};
  std::vector<GridCell> b = {cell(one, 7), cell(one, 7), cell(one, 4), cell(one, 4), cell(one, 4)};
  CHECK(compare_motions(a, b).changed == 1);
  // What one case alone has is no change of class or period.
  b[4] = cell(one, 9);
  CHECK(compare_motions(a, b).changed == 1);
  b[4] = cell(open, -1);
  CHECK(compare_motions(a, b).open == 1);
  CHECK(compare_motions(a, b).both == 4);
  b[4] = cell(failed, -1);
  CHECK(compare_motions(a, b).open == 1);
}

TEST_CASE("shares of motions are those of the cells, with what is undecided in their intervals", "[asks]") {
  std::vector<GridCell> a(100, cell(one, 0)), b(100, cell(one, 3));
  for (std::size_t k = 0; k < 10; ++k) a[k] = cell(none, 1);
  for (std::size_t k = 0; k < 40; ++k) b[k] = k < 20 ? cell(open, -1) : cell(none, 1);
  const asks::Answered out = ask(study_of({a, b}), {{"motions", "share"}});
  INFO(out.sentence);
  const auto find = [&](const std::string& level, const std::string& motion) {
    for (const asks::VerdictRow& row : out.rows)
      if (row.level == level && row.measure == motion) return row;
    throw std::out_of_range(level + motion);
  };
  CHECK(*find("e = 0.1", "period 1").value == Approx(90));
  CHECK(*find("e = 0.1", "no contact").value == Approx(10));
  CHECK(*find("e = 0.1", "undecided").value == 0);
  CHECK(*find("e = 0.2", "period 1").value == Approx(60));
  CHECK(*find("e = 0.2", "no contact").value == Approx(20));
  CHECK(*find("e = 0.2", "period 1").low < 60);
  CHECK(*find("e = 0.2", "period 1").high > 80);
  CHECK(*find("e = 0.2", "undecided").value == Approx(20));
  CHECK(out.verdict == "decided");
  CHECK_THAT(out.sentence, Contains("90 and 60 % of the starts end in period 1"));
}

TEST_CASE("what is undecided stands first above a quarter", "[asks]") {
  std::vector<GridCell> a(100, cell(one, 0));
  for (std::size_t k = 0; k < 66; ++k) a[k] = cell(open, -1);
  asks::Answered out = ask(study_of({a}), {{"motions", "share"}});
  CHECK_THAT(out.sentence, Catch::Matchers::StartsWith("66 % of the starts are undecided"));
  CHECK(out.passes == asks::Verdict::open);
  for (GridCell& every : a) every = cell(open, -1);
  out = ask(study_of({a}), {{"motions", "share"}});
  CHECK_THAT(out.sentence, Catch::Matchers::StartsWith("Open: none of the starts is decided"));
}

TEST_CASE("a choice changes the motions of a share of the starts, or does not, or it is open", "[asks]") {
  std::vector<GridCell> a(625, cell(one, 0)), b(625, cell(one, 1)), c(625, cell(one, 2));
  for (std::size_t k = 0; k < 34; ++k) a[k] = cell(none, 3);
  for (std::size_t k = 0; k < 5; ++k) b[k] = c[k] = cell(none, 3);
  const Json effect = {{"effect", "time.restitution"}, {"on", "motions"}};
  const auto twice = [](const std::vector<std::vector<GridCell>>& grids) { return study_of(grids, {500, 1000}); };
  asks::Answered out = ask(twice({a, b}), effect);
  CHECK(out.sentence == "Yes: restitution changes the motion of 29 of 625 starts (0.2 against 0.1).");
  CHECK(*out.rows.front().value == Approx(100 * 29.0 / 625));
  CHECK(out.passes == asks::Verdict::yes);
  out = ask(twice({b, c}), effect);
  CHECK_THAT(out.sentence, Catch::Matchers::StartsWith("No: restitution changes the motion of none of the 625 starts"));
  out = ask(twice({a, b, c}), effect);
  CHECK(out.verdict == "in part");
  const Json within = {{"effect", "time.restitution"}, {"on", "motions"}, {"within", 0.01}};
  out = ask(twice({b, c}), within);
  CHECK(out.passes == asks::Verdict::yes);
  CHECK_THAT(out.sentence, Catch::Matchers::StartsWith("Yes, they agree: "));
  out = ask(twice({a, b}), within);
  CHECK(out.passes == asks::Verdict::no);
  CHECK_THAT(out.sentence, Catch::Matchers::StartsWith("No, they do not agree: "));
  // One step leaves a yes and a no unknown, and motions that touch nothing are no agreement.
  CHECK(ask(study_of({a, b}), effect).passes == asks::Verdict::open);
  CHECK(ask(study_of({b, c}), within).passes == asks::Verdict::open);
  const std::vector<GridCell> still(625, cell(none, 0));
  out = ask(twice({still, still}), within);
  CHECK(out.passes == asks::Verdict::open);
  CHECK_THAT(out.rows.front().reason, Contains("no stop is touched"));
  // Undecided starts may have changed: more than asked.
  for (std::size_t k = 0; k < 20; ++k) b[600 + k] = cell(open, -1);
  out = ask(twice({b, c}), effect);
  CHECK(out.passes == asks::Verdict::open);
  CHECK_THAT(out.rows.front().reason, Contains("20 open"));
  out = ask(twice({b, c}), {{"effect", "time.restitution"}, {"on", "motions"}, {"from", 0.05}});
  CHECK(out.passes == asks::Verdict::no);
}

}  // namespace ricochet::tests_of_basin_asks
