// Kind `basins`, from the study's text to the cells of its grid.
#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <ricochet/loader/catalogue.hpp>

#include "runners/kinds/basins/basins.hpp"
#include "runners/store/record_values.hpp"
#include "runners/study/load_study.hpp"
#include "runners/table/table_reader.hpp"
#include "runners/table/text.hpp"
#include "tests/places.hpp"
#include "tests/runners/kinds/sweep/block_threads.hpp"

using namespace ricochet;
using Catch::Matchers::Contains;
using ricochet::testing::BlockThreads;

namespace {

/// An oscillator driven beside a stop: small motions miss it, others strike it, by their initial state.
Json grid_study(int columns, int rows, bool refine) {
  Json study = Json::parse(R"({
    "name": "grid", "kind": "basins",
    "scene": {
      "structure": {"type": "oscillator", "mass": 1, "stiffness": 1, "damping": 0.3,
                    "force": {"amplitude": 1, "pulsation": 2.6}},
      "stops": {"upper": 0.2, "at": "tip"},
      "initial": {"displacement": 0, "velocity": 0}
    },
    "methods": {"mass": "consistent", "contact": "signorini",
                "time": {"name": "newmark-dumont-paoli", "restitution": 0.3}},
    "steps_per_period": 64,
    "transient": {"periods": 60, "at_most": 160}, "keep": 32
  })");
  study["axes"] =
      Json::array({{{"pointer", "/scene/initial/displacement"}, {"from", -4}, {"to", 0.16}, {"count", columns}},
                   {{"pointer", "/scene/initial/velocity"}, {"from", -4}, {"to", 4}, {"count", rows}}});
  study["refine"] = refine;
  return study;
}

struct Opened {
  Catalogue catalogue{tests::places().plugins, {}, {}};
  Registry registry;
  Study study;
  explicit Opened(const Json& text) : study(parse_study(text.dump(1), catalogue, registry)) {}
  CaseRecord run(const CaseContext& context = {{}, "key"}) const {
    const std::atomic<bool> stop = false;
    return run_basins(study.cases.front(), registry, context, stop);
  }
};

CaseRecord run(const Json& text) {
  return Opened(text).run();
}

/// Column of the table `cells`.
std::vector<Cell> cells(const CaseRecord& record, const std::string& name) {
  const TableReader rows(record.tables.front());
  const std::size_t column = rows.column(name);
  std::vector<Cell> out;
  for (std::size_t row = 0; row < rows.size(); ++row) out.push_back(rows.cell(row, column));
  return out;
}

std::string bytes_of(const CaseRecord& record) {
  std::string text = word(record.status) + std::to_string(record.steps);
  for (const Row& row : record.tables.front().rows)
    for (const Cell& cell : row) text += csv_cell(cell);
  for (const auto& numbers : record.numbers.front().values)
    text.append(reinterpret_cast<const char*>(numbers.get().data()), numbers.size() * sizeof(double));
  return text;
}

}  // namespace

TEST_CASE("Every cell of a grid has its row and its section") {
  const CaseRecord record = run(grid_study(5, 4, false));
  CHECK(record.status == Status::done);
  const auto x = cells(record, "x"), y = cells(record, "y"), marched = cells(record, "marched"),
             source = cells(record, "source"), period = cells(record, "period"), status = cells(record, "status");
  REQUIRE(x.size() == 20);
  CHECK(x[0] == -4.0);
  CHECK(x[4] == 0.16);
  CHECK(y[0] == -4.0);
  CHECK(y[19] == 4.0);
  std::map<double, int> points;
  for (const double cell : record.numbers.front().values.front()) ++points[cell];
  for (std::size_t cell = 0; cell < x.size(); ++cell) {
    CHECK(status[cell] == "done");
    CHECK(marched[cell] == true);
    CHECK(source[cell] == cell);
    CHECK(points[static_cast<double>(cell)] == period[cell].whole().value_or(32));
  }
  CHECK_FALSE(record.numbers.front().exported);
}

TEST_CASE("Boundary refinement finds what the whole grid holds, for less") {
  const CaseRecord whole = run(grid_study(21, 21, false)), refined = run(grid_study(21, 21, true));
  const auto regime = cells(whole, "class"), found = cells(refined, "class"), marched = cells(refined, "marched"),
             period = cells(whole, "period"), repeats = cells(refined, "period"), source = cells(refined, "source");
  const auto marched_count = std::count(marched.begin(), marched.end(), Cell(true));
  CHECK(marched_count < 0.55 * 441);
  CHECK(std::count(marched.begin(), marched.end(), Cell(false)) == 441 - marched_count);
  CHECK(std::count(regime.begin(), regime.end(), regime.front()) < 441);  // there is something to find
  int wrong = 0;
  for (std::size_t cell = 0; cell < regime.size(); ++cell) {
    const bool same = regime[cell] == found[cell] && period[cell] == repeats[cell];
    if (marched[cell] == true) CHECK(same);
    CHECK(marched[static_cast<std::size_t>(source[cell].whole().value())] == true);
    wrong += !same;
  }
  // Tongues thinner than the coarse grid, which no coarse cell meets: one cell in a hundred.
  CHECK(wrong <= 4);
  CHECK_THAT(refined.notes.back(), Contains(std::to_string(marched_count) + " of 441 cells were marched"));
}

TEST_CASE("Scenes shared by columns and rows are those of each cell alone") {
  // The stop as second axis shares nothing: its orbits at the stop of the scene are those of the initial states.
  Json alone = grid_study(5, 2, false);
  alone["axes"][1] = {{"pointer", "/scene/stops/upper"}, {"from", 0.2}, {"to", 0.4}, {"count", 2}};
  Json shared = grid_study(5, 2, false);
  shared["axes"][1] = {{"pointer", "/scene/initial/velocity"}, {"from", 0}, {"to", 1}, {"count", 2}};
  Json turned = shared;
  std::swap(turned["axes"][0], turned["axes"][1]);
  const auto first = [](const CaseRecord& record, std::size_t stride) {
    std::vector<double> tips;
    for (std::size_t i = 0; i < record.numbers.front().rows(); ++i)
      for (std::size_t cell = 0; cell < 5; ++cell)
        if (record.numbers.front().values[0][i] == static_cast<double>(stride * cell))
          tips.push_back(record.numbers.front().values[2][i]);
    return tips;
  };
  const auto wanted = first(run(alone), 1);
  CHECK_FALSE(wanted.empty());
  CHECK(first(run(shared), 1) == wanted);
  CHECK(first(run(turned), 2) == wanted);
}

TEST_CASE("Cells behind a stop are no starts, and are counted apart") {
  Json study = grid_study(4, 3, false);
  study["axes"][0]["to"] = 0.5;
  const CaseRecord record = run(study);
  const auto status = cells(record, "status"), reason = cells(record, "reason"), regime = cells(record, "class");
  CHECK(record.status == Status::done);
  CHECK(measure(record, "orbits") == 9.0);
  CHECK(measure(record, "starts") == 9.0);
  for (std::size_t cell = 0; cell < status.size(); ++cell) {
    CHECK(status[cell] == (cell % 4 == 3 ? "no start" : "done"));
    CHECK((regime[cell] == "no start") == (cell % 4 == 3));
    if (cell % 4 == 3) CHECK_THAT(reason[cell].text(), Contains("beyond the upper stop at 0.2 m"));
  }
  // The same cells without the column behind the stop: the same ends, and nothing to count apart.
  study["axes"][0]["to"] = -1;
  study["axes"][0]["count"] = 3;
  const CaseRecord inside = run(study);
  CHECK_FALSE(measure(inside, "starts"));
  const auto wanted = cells(inside, "class");
  for (std::size_t cell = 0; cell < wanted.size(); ++cell) CHECK(regime[cell / 3 * 4 + cell % 3] == wanted[cell]);
}

TEST_CASE("Where no cell is a start the case is refused, with the stop") {
  Json study = grid_study(2, 2, false);
  study["axes"][0]["from"] = 0.3;
  study["axes"][0]["to"] = 0.5;
  CHECK_THROWS_WITH(Opened(study), Contains("beyond the upper stop"));
}

TEST_CASE("A value that every cell replaces is not looked at") {
  Json study = grid_study(3, 2, false);
  const CaseRecord wanted = run(study);
  study["scene"]["initial"]["displacement"] = 5;  // behind the stop
  const CaseRecord found = run(study);
  CHECK(cells(found, "class") == cells(wanted, "class"));
  CHECK(found.numbers.front().values[2].get() == wanted.numbers.front().values[2].get());
  const Opened opened(study);
  CHECK(plan_basins(opened.study.cases.front(), opened.registry).refusal.empty());
  // What no cell replaces is.
  study["scene"]["stops"]["upper"] = "x +";
  CHECK_THROWS_WITH(Opened(study), Contains("does not parse"));
}

TEST_CASE("Cells marched in batches of their own or many batches together are bitwise equal") {
  Json text = grid_study(96, 96, false);
  text["transient"] = {{"periods", 4}, {"at_most", 8}};
  text["keep"] = 16;
  const Opened opened(text);
  const std::string wanted = bytes_of(opened.run());
  // So many workers that three batches are marched at once.
  BlockThreads workers(opened.study.cases.front(), opened.registry, 64);
  CHECK((bytes_of(opened.run({{}, "key", &workers})) == wanted));

  // Stopped with all three under way, and gone on with one at a time: what was kept is of no batch or of whole ones.
  std::map<std::string, std::string> kept;
  std::atomic<bool> stop = false;
  CaseContext context{{}, "key", &workers};
  context.checkpoints.find = [&](const std::string& key) {
    stop = key.starts_with("orbits/");  // looked for when the integration begins
    return kept.count(key) ? kept[key] : "";
  };
  context.checkpoints.keep = [&](const std::string& key, const std::string& bytes) { kept[key] = bytes; };
  CHECK_THROWS_AS(run_basins(opened.study.cases.front(), opened.registry, context, stop), Interrupted);
  CHECK_FALSE(kept.empty());
  stop = false;
  context.blocks = nullptr;
  context.checkpoints.find = [&](const std::string& key) { return kept.count(key) ? kept[key] : ""; };
  CHECK((bytes_of(run_basins(opened.study.cases.front(), opened.registry, context, stop)) == wanted));
}

TEST_CASE("Workers, interruptions and damage to what was stored do not change basins") {
  const Opened opened(grid_study(13, 13, true));
  const std::string wanted = bytes_of(opened.run());
  for (int run = 0; run < 3; ++run) {
    BlockThreads workers(opened.study.cases.front(), opened.registry, 2);
    CHECK((bytes_of(opened.run({{}, "key", &workers})) == wanted));
  }

  std::map<std::string, std::string> kept;
  std::atomic<bool> stop = false;
  int saves = 0, looks = 0;
  CaseContext context;
  context.key = "key";
  context.checkpoints.find = [&](const std::string& key) {
    if (key.starts_with("orbits/") && ++looks % 5 == 0) stop = true;  // an integration that ends in its first periods
    return kept.contains(key) ? kept.at(key) : std::string();
  };
  context.checkpoints.keep = [&](const std::string& key, const std::string& bytes) {
    bytes.empty() ? void(kept.erase(key)) : void(kept[key] = bytes);
    if (++saves % 5 == 0) stop = true;
  };
  int interruptions = 0;
  for (;; ++interruptions) {
    REQUIRE(interruptions < 100);
    stop = false;
    try {
      const CaseRecord record = run_basins(opened.study.cases.front(), opened.registry, context, stop);
      CHECK((bytes_of(record) == wanted));  // not printed when it fails
      break;
    } catch (const Interrupted&) {
    }
    if (interruptions < 3)
      for (auto& [key, bytes] : kept) bytes.pop_back();
  }
  CHECK(interruptions > 3);
  CHECK(kept.empty());
}

TEST_CASE("A budget that is spent leaves rows that say so") {
  Json study = grid_study(25, 25, false);
  study["budget"] = 1e-6;
  const CaseRecord record = run(study);
  CHECK(record.status == Status::failed);
  const auto status = cells(record, "status");
  CHECK(status.size() == 625);
  CHECK(std::count(status.begin(), status.end(), Cell("failed")) > 0);
}
