// One orbit of a diagram, marched again from what its case keeps.
#include "runners/kinds/sweep/march_point.hpp"

#include <catch2/catch.hpp>
#include <ricochet/loader/catalogue.hpp>

#include "runners/kinds/bifurcation/bifurcation.hpp"
#include "runners/kinds/sweep/orbit_rows.hpp"
#include "runners/study/load_study.hpp"
#include "tests/places.hpp"

using namespace ricochet;

namespace {

Json diagram() {
  return Json::parse(R"({
    "name": "diagram", "kind": "bifurcation",
    "scene": {"structure": {"type": "beam", "length": 1.501, "young": 2e11, "density": 8000,
                            "section": {"type": "tube", "outer_diameter": 0.01, "wall": 0.0005},
                            "damping": {"stiffness": 1e-4}},
              "stops": {"lower": -0.1, "upper": 0.1, "at": "nodes"},
              "support": {"amplitude": 0.07, "pulsation": 10},
              "initial": {"displacement": "0.01*x^2"}},
    "mesh": {"elements": 4},
    "methods": {"mass": "consistent", "contact": "signorini", "time": "newmark-dumont-paoli"},
    "parameter": {"pointer": "/scene/support/amplitude", "from": 0.08, "to": 0.095, "count": 3},
    "start": ["rest", "state", "up", {"random": 2, "seed": 3}], "steps_per_period": 200,
    "transient": {"periods": 5, "at_most": 10}, "keep": 16, "phase": 1.0
  })");
}

}  // namespace

TEST_CASE("A point is marched bitwise equal to those of its diagram") {
  Catalogue catalogue(tests::places().plugins, {}, {});
  Registry registry;
  const Study study = parse_study(diagram().dump(1), catalogue, registry);
  const StudyCase& one = study.cases.front();
  const std::atomic<bool> stop = false;
  const CaseRecord record = run_bifurcation(one, registry, {{}, "key"}, stop);
  REQUIRE(find_table(record.numbers, "points"));
  const NumberTable& points = *find_table(record.numbers, "points");
  const auto& starts = points.words.front().second;
  for (std::size_t s = 0; s < starts.size(); ++s)
    for (const double value : {0.08, 0.0875, 0.095}) {
      INFO(starts[s] << " " << value);
      const auto entry = find_entry(record, value, starts[s]);
      REQUIRE(entry);
      std::vector<std::size_t> rows;
      for (std::size_t i = 0; i < points.rows(); ++i)
        if (points.values[0][i] == value && points.values[1][i] == static_cast<double>(s)) rows.push_back(i);
      REQUIRE(rows.size() == 16);
      long long strobes = 0, samples = 0;
      march_point(one, registry, {value, starts[s], *entry, {16, 7}}, [&](const PointSample& sample) {
        ++samples;
        if (sample.strobe < 0) return;
        CHECK(sample.strobe == strobes);
        const std::size_t row = rows[static_cast<std::size_t>(strobes++)];
        CHECK(sample.displacement == points.values[3][row]);
        CHECK(sample.velocity == points.values[4][row]);
      });
      CHECK(strobes == 16);
      CHECK(samples == 16 * 7);
    }
  CHECK_FALSE(find_entry(record, 0.09, "rest"));
  CHECK_FALSE(find_entry(record, 0.08, "down"));
}

TEST_CASE("An entry takes along what the law remembers") {
  Orbit orbit;
  orbit.stage = Orbit::Stage::complete;
  orbit.entry.slots = {1, 2, 3};
  orbit.entry.efforts = {4};
  orbit.entry.memory = {5, 6};
  OrbitView view;
  view.value = 0.08;
  view.orbit = &orbit;
  CaseRecord record;
  add_entries(record, {view}, {"rest"});
  const auto entry = find_entry(record, 0.08, "rest");
  REQUIRE(entry);
  CHECK(entry->slots == orbit.entry.slots);
  CHECK(entry->efforts == orbit.entry.efforts);
  CHECK(entry->fastest.empty());
  CHECK(entry->memory == orbit.entry.memory);
}
