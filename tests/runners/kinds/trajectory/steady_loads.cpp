// Energies of trajectories under steady loads: the same share wherever the motion ends.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "runners/store/record_values.hpp"
#include "runners/store/study_tables.hpp"
#include "tests/runners/kinds/trajectory/case_runs.hpp"

using namespace ricochet;
using namespace ricochet::testing;
using Catch::Matchers::Contains;

namespace {

constexpr double gravity = 9.81;

/// A ball of 1 kg that is let go 1 m over a stop.
Json dropped(const Json& time, double step, double duration) {
  Json study = Json::parse(R"({
    "name": "dropped", "kind": "trajectory",
    "scene": {"structure": {"type": "oscillator", "mass": 1, "stiffness": 0}, "stops": {"lower": 0, "at": "tip"},
              "load": [{"force": -9.81}], "initial": {"displacement": 1}},
    "methods": {"mass": "consistent", "contact": "signorini"}, "samples": 50
  })");
  study["methods"]["time"] = time;
  study["step"] = step;
  study["duration"] = duration;
  return study;
}

double of(const CaseRecord& record, const char* name) {
  INFO(name);
  const auto value = measure(record, name);
  REQUIRE(value);
  return *value;
}

}  // namespace

TEST_CASE("a ball has 81 % of its energy left after a bounce of 0.9, at the top of it and before it lands again") {
  for (const char* name : {"moreau-jean", "newmark-dumont-paoli"})
    for (const double end : {0.3, 0.4515 + 0.01, 0.8579, 1.264}) {
      Json time = {{"name", name}, {"restitution", 0.9}};
      if (std::string(name) == "newmark-dumont-paoli") time["beta"] = 0.25;
      const CaseRecord record = CaseRuns().first_of(dropped(time, 1e-4, end));
      INFO(name << " until " << end);
      CHECK(of(record, "energy_start") == Approx(gravity));
      CHECK(of(record, "energy_brought_in") == Approx(gravity));
      // It lands within a step: a share h/(the time of the fall) of the energy, at most twice.
      CHECK(of(record, "energy_left") == Approx(end < 0.45 ? 1 : 0.81).epsilon(1e-3));
      CHECK(of(record, "work_of_loads") == Approx(of(record, "work_of_steady_loads")));
    }
}

TEST_CASE("a rod that rests on its grid is never thrown back, and pushes as statics say, whatever mesh and scheme") {
  Json study = Json::parse(R"({
    "name": "rests", "kind": "trajectory",
    "scene": {"structure": {"type": "beam", "length": 1.2, "section": {"type": "given", "EI": 23.5, "rhoS": 0.105},
                            "damping": {"ratio": 0.02}},
              "stops": [{"name": "grid", "at": {"x": 0.8}}],
              "load": [{"shape": "-0.981", "time": "1"}], "initial": {"equilibrium": true}},
    "mesh": {"elements": [3, 6, 12, 24, 60]},
    "methods": {"mass": ["consistent", "lumped"], "contact": "signorini",
                "time": [{"name": "newmark-dumont-paoli", "beta": 0.5}, "moreau-jean"]},
    "step": 1e-4, "duration": 0.004, "samples": 10
  })");
  // w(b) of the uniform load less R b³/3EI is the bound, b = 0.8 m.
  constexpr double EI = 23.5, q = 0.981, L = 1.2, b = 0.8;
  constexpr double free = q * b * b * (6 * L * L - 4 * L * b + b * b) / (24 * EI);
  for (const double gap : {0.0, 0.002}) {
    study["scene"]["stops"][0]["lower"] = -gap;
    const double push = (free - gap) * 3 * EI / (b * b * b);
    for (const CaseRecord& record : CaseRuns().of(study)) {
      INFO(gap);
      for (const auto& [axis, level] : record.axes) INFO(axis << ' ' << level);
      REQUIRE(record.status == Status::done);
      CHECK(of(record, "impacts") == 0);
      // Nothing moves: no energy is there to have a share of.
      CHECK_FALSE(measure(record, "energy_left"));
      // Places at nodes of cubic elements are exact.
      CHECK(of(record, "peak_force[grid]") == Approx(push).epsilon(1e-7));
      CHECK(of(record, "mean_force[grid]") == Approx(push).epsilon(1e-7));
    }
  }
}

TEST_CASE("a ball that comes to rest by rebounds hits without number, one that is caught does not") {
  const auto has_no_count = [](const CaseRecord& record) { return why_left_out(record, "impacts") == no_count; };
  // At rest after √(2/g) (1 + e)/(1 − e) = 1.36 s of e = 0.5.
  for (const char* name : {"moreau-jean", "nonsmooth-generalised-alpha", "newmark-dumont-paoli", "paoli-schatzman"}) {
    INFO(name);
    const Json rebounds = {{"name", name}, {"restitution", 0.5}}, caught = {{"name", name}, {"restitution", 0.0}};
    // Those that solve for positions close a point for two steps or three.
    for (const double h : {4e-3, 2e-3, 1e-3, 5e-4}) {
      INFO(h);
      CHECK(has_no_count(CaseRuns().first_of(dropped(rebounds, h, 2))));
    }
    CHECK_FALSE(has_no_count(CaseRuns().first_of(dropped(rebounds, 1e-3, 1))));
    CHECK_FALSE(has_no_count(CaseRuns().first_of(dropped(caught, 1e-3, 2))));
  }
}

TEST_CASE("a ball that bounces elastically keeps its energy by elastic schemes, and Newmark makes thirteen times it") {
  const CaseRecord kept =
      CaseRuns().first_of(dropped(Json{{"name", "moreau-jean"}, {"theta", 0.5}, {"restitution", 1}}, 0.01, 9.03));
  CHECK(of(kept, "energy_left") == Approx(1).epsilon(1e-9));
  const CaseRecord made = CaseRuns().first_of(dropped("newmark", 0.01, 9.03));
  CHECK(of(made, "energy_left") > 10);
  CHECK(of(made, "energy_brought_in") == Approx(gravity));
}

TEST_CASE("a load in time keeps a scale that never falls, and a structure that nothing holds says so") {
  double before = 0;
  for (const double end : {0.1, 0.37, 0.92, 1.4}) {
    Json study = dropped(Json{{"name", "moreau-jean"}, {"restitution", 0.5}}, 1e-3, end);
    study["scene"]["load"].push_back({{"force", "3*sin(9*t)"}});
    study["samples"] = static_cast<int>(std::lround(end / 0.01));  // the same instants, whatever the end
    const CaseRecord record = CaseRuns().first_of(study);
    CHECK(of(record, "energy_brought_in") >= before * (1 - 1e-12));
    CHECK(of(record, "energy_left") <= 1 + 1e-2);
    before = of(record, "energy_brought_in");
  }
  CHECK(before > gravity);
  Json loose = dropped("moreau-jean", 1e-3, 0.1);
  loose["scene"]["stops"] = {{"upper", 2}, {"at", "tip"}};
  const CaseRecord falling = CaseRuns().first_of(loose);
  bool said = false;
  for (const std::string& note : falling.notes) said = said || note.find("nothing holds the structure") == 0;
  CHECK(said);
  CHECK_FALSE(measure(falling, "energy_left"));
  // Thrown, it has what it was thrown with.
  loose["scene"]["initial"]["velocity"] = "2";
  CHECK(of(CaseRuns().first_of(loose), "energy_left") == Approx(1).epsilon(1e-6));
}

TEST_CASE("stops that nothing reaches are told with the smallest gap") {
  Json study = dropped("moreau-jean", 1e-3, 0.05);
  study["scene"]["stops"] = {{"lower", -3}, {"upper", 4}, {"at", "tip"}};
  const CaseRecord record = CaseRuns().first_of(study);
  CHECK(of(record, "smallest_gap") == 3);
  CHECK(of(record, "contact_instants") == 0);
  study["methods"]["contact"] = "none";
  CHECK_FALSE(measure(CaseRuns().first_of(study), "smallest_gap"));
}
