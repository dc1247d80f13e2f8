// What a trajectory keeps: all that is asked for together, and what does not need a stop without one.
#include <catch2/catch.hpp>
#include <cmath>

#include "runners/store/record_values.hpp"
#include "runners/table/number_table.hpp"
#include "runners/table/table_reader.hpp"
#include "tests/runners/kinds/trajectory/case_runs.hpp"

using namespace ricochet;
using ricochet::testing::CaseRuns;

TEST_CASE("spectra of a point are there where no stop pushes") {
  // A sine of 3 Hz and 1 mm amplitude, by a load on a stiff spring: m ω² is 0.04 % of k.
  Json study = Json::parse(R"json({
    "name": "swayed", "kind": "trajectory",
    "scene": {"structure": {"type": "oscillator", "mass": 1, "stiffness": 1e6, "damping": 200},
              "load": [{"force": "1000*sin(6*3.14159265358979*t)"}],
              "points": [{"name": "mid", "at": {"x": 0}}]},
    "methods": {"mass": "consistent", "contact": ["none", "signorini"], "time": "newmark"},
    "step": 1e-3, "duration": 10, "window": {"from": 2, "to": 10},
    "outputs": {"spectra": [{"of": "mid", "quantity": "displacement"}], "rate": 100, "segment": 2},
    "observe": ["third_octave_displacement_3.15Hz[mid]"]})json");
  const auto look = [](const CaseRecord& record) {
    REQUIRE(record.status == Status::done);
    const NumberTable* spectra = find_table(record.numbers, "spectra");
    REQUIRE(spectra);
    double variance = 0;
    for (const double density : *spectra->numbers("density")) variance += density / 2;
    CHECK(variance == Approx(0.5e-6).epsilon(2e-3));
    // A line of 3 Hz in a window of Hann has a third of its power beside it, and the band ends between.
    CHECK(measure(record, "third_octave_displacement_3.15Hz[mid]").value() > 0.5 * std::sqrt(0.5e-6));
  };
  for (const CaseRecord& record : CaseRuns().of(study)) look(record);
  // A stop that is never met, and one that no law sees.
  study["scene"]["stops"] = Json::parse(R"([{"name": "wall", "at": {"x": 0}, "upper": 1}])");
  study["outputs"]["spectra"].push_back({{"of", "wall"}, {"quantity", "force"}});
  for (const CaseRecord& record : CaseRuns().of(study)) {
    const NumberTable& spectra = *find_table(record.numbers, "spectra");
    CHECK(spectra.rows() == 2 * 101);
    for (std::size_t i = 0; i < spectra.rows(); ++i)
      if ((*spectra.numbers("of"))[i] == 1) CHECK((*spectra.numbers("density"))[i] == 0);
  }
}

TEST_CASE("a film, parts of a window, wear and a clearance go together") {
  Json study = Json::parse(R"json({
    "name": "plate", "kind": "trajectory",
    "scene": {"structure": {"type": "beam", "planes": 2, "length": 1, "section": {"type": "given", "EI": 40, "rhoS": 1}},
              "stops": [{"name": "plate", "at": {"x": 1}, "clearance": {"radius": 1e-3, "sides": 8},
                         "tangent": {"slope_radius": 0.01}}],
              "points": [{"name": "mid", "at": {"x": 0.5}}],
              "load": [{"at": 1, "force": "10*sin(30*t)"}]},
    "mesh": {"elements": 2},
    "methods": {"mass": "consistent", "contact": {"name": "penalty", "stiffness": 1e5},
                "time": {"name": "newmark-dumont-paoli", "beta": 0.5}},
    "step": 1e-3, "duration": 1, "window": {"from": 0, "to": 1, "parts": 10}, "samples": 10, "snapshots": 5,
    "outputs": {"shocks": {"force_above": 0.1, "rest": 1e-3},
                "spectra": [{"of": "mid", "quantity": "displacement"}, {"of": "plate", "quantity": "force"}],
                "rate": 100, "segment": 0.5},
    "observe": ["wear_power[plate]"]})json");
  const CaseRecord record = CaseRuns().first_of(study);
  INFO(record.reason());
  REQUIRE(record.status == Status::done);
  CHECK(measure(record, "wear_power[plate]").value() > 0);
  for (const char* name : {"snapshots", "orbits", "spectra", "shocks", "impacts"}) {
    INFO(name);
    CHECK(find_table(record.numbers, name));
  }
  CHECK(find_table(record.tables, "stop_parts"));
}
