// Snapshots: what is kept of a motion to be looked at is the motion, and its results are those of a run without.
#include "runners/store/snapshots.hpp"

#include <catch2/catch.hpp>

#include "runners/store/record_values.hpp"
#include "tests/runners/kinds/trajectory/case_runs.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

Json beam_study() {
  return Json::parse(R"({
    "name": "film", "kind": "trajectory",
    "scene": {"structure": {"type": "beam", "length": 1.501, "young": 2.0e11, "density": 8000,
                            "section": {"type": "tube", "outer_diameter": 0.01, "wall": 0.0005}},
              "stops": {"lower": "-0.1", "upper": "0.1", "at": "nodes"},
              "support": {"amplitude": 0.002, "pulsation": 30},
              "initial": {"displacement": "0.04*x^2", "velocity": "-2*x"}},
    "mesh": {"elements": 80},
    "methods": {"mass": "consistent", "contact": "signorini", "time": "newmark-dumont-paoli"},
    "step": 1e-4, "duration": 0.2, "samples": 40, "snapshots": 40})");
}

Snapshots snapshots(const CaseRecord& record) {
  const NumberTable* table = find_table(record.numbers, snapshots_name);
  REQUIRE(table);
  auto found = snapshots_of(*table);
  REQUIRE(found);
  return *found;
}

double tip(const Snapshots& shots, std::size_t k) {
  return shots.metres * shots.displacement[(k + 1) * shots.x.size() - 1];
}

}  // namespace

TEST_CASE("a snapshot's last place is the tip of the curve at that time, to half a count") {
  const CaseRecord record = CaseRuns().first_of(beam_study());
  REQUIRE(record.status == Status::done);
  const Snapshots shots = snapshots(record);
  REQUIRE(shots.t.size() == 41);
  CHECK(shots.t.front() == 0);
  CHECK(shots.x.size() == static_cast<std::size_t>(Snapshots::most_places));  // of 81 nodes
  CHECK(shots.point.size() <= static_cast<std::size_t>(Snapshots::most_places));
  const auto& times = record.curve.columns[0];
  const auto& tips = record.curve.columns[1];
  // The curve has the step of its start as its first sample; the others stand at the same steps.
  for (std::size_t k = 1; k < shots.t.size(); ++k) {
    const std::size_t sample = tips.size() - shots.t.size() + k;
    REQUIRE(times[sample] == shots.t[k]);
    CHECK(std::abs(tip(shots, k) - tips[sample]) <= 0.5001 * shots.metres);
  }
}

TEST_CASE("the forces of snapshots give the impulse of the run") {
  Json text = beam_study();
  text["scene"]["stops"]["at"] = "tip";
  const CaseRecord record = CaseRuns().first_of(text);
  const Snapshots shots = snapshots(record);
  REQUIRE_FALSE(shots.force.empty());
  double impulse = 0;
  for (std::size_t i = 0; i < shots.force.size(); ++i) {
    const std::size_t k = shots.pushed[i];  // one point
    REQUIRE(k > 0);
    impulse += std::abs(shots.newtons * shots.force[i]) * (shots.t[k] - shots.t[k - 1]);
  }
  // Each force is rounded to half a count, of which the largest has 32767.
  CHECK(impulse == Approx(measure(record, "impulse").value()).epsilon(1e-3));
}

TEST_CASE("results are the same with snapshots as without, and without there is no table") {
  Json text = beam_study();
  CaseRuns runs;
  const CaseRecord with = runs.first_of(text);
  text.erase("snapshots");
  const CaseRecord without = runs.first_of(text);
  CHECK(find_table(without.numbers, snapshots_name) == nullptr);
  CHECK(with.curve.columns == without.curve.columns);
  CHECK(with.steps == without.steps);
  for (const auto& [name, value] : without.measures)
    if (name != "microseconds_per_step") CHECK(measure(with, name) == value);
}

TEST_CASE("an oscillator has one place, and a bar moves along its axis") {
  Json text = beam_study();
  text["scene"] = Json::parse(
      R"({"structure": {"type": "oscillator", "mass": 1, "stiffness": 1}, "stops": {"upper": 0.5, "at": "tip"},
                                  "initial": {"displacement": -1, "velocity": 0}})");
  text.erase("mesh");
  text.update(Json::parse(R"({"step": 0.01, "duration": 8})"));
  const Snapshots mass = snapshots(CaseRuns().first_of(text));
  CHECK(mass.x == std::vector<double>{0});
  CHECK_FALSE(mass.along);
  CHECK(mass.upper == std::vector<double>{0.5});
  CHECK(std::isinf(mass.lower.front()));
  CHECK(tip(mass, 0) == Approx(-1));
  text["scene"] = Json::parse(R"({"structure": {"type": "bar", "length": 10, "EA": 900, "rhoA": 1, "fixed": "right"},
                                  "stops": {"lower": -0.1, "at": "tip"}, "initial": {"displacement": 0, "velocity": 0}})");
  text["mesh"] = {{"elements", 10}};
  CHECK(snapshots(CaseRuns().first_of(text)).along);
}

TEST_CASE("a table that is cut short is no film") {
  NumberTable table = *find_table(CaseRuns().first_of(beam_study()).numbers, snapshots_name);
  REQUIRE(snapshots_of(table));
  for (Series& column : table.values) column.own().resize(column.size() / 2);
  CHECK_FALSE(snapshots_of(table));
}
