// Tables and measures know a clearance by its name, as one stop.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <utility>

#include "runners/store/record_values.hpp"
#include "tests/runners/kinds/trajectory/case_runs.hpp"

using namespace ricochet;
using ricochet::testing::CaseRuns;

namespace {

/// A tube that is driven round in its plate.
Json whirling(const char* contact) {
  Json study = Json::parse(R"json({
    "name": "round", "kind": "trajectory",
    "scene": {"structure": {"type": "beam", "planes": 2, "length": 1.2, "section": {"type": "given", "EI": 40, "rhoS": 0.5},
                            "damping": {"mass": 20}},
              "stops": [{"name": "plate", "at": {"x": 0.8}, "clearance": {"radius": 2e-3, "sides": 32}, "tangent": {"slope_radius": 0.01}},
                        {"name": "end", "at": {"x": 1.2, "direction": [3, 4]}, "upper": 0.004, "lower": -0.004}],
              "load": [{"at": {"x": 1.0, "component": "uy"}, "force": "12*cos(25*t)"},
                       {"at": {"x": 1.0, "component": "uz"}, "force": "12*sin(25*t)"}]},
    "mesh": {"elements": 8},
    "methods": {"mass": "singular", "time": "newmark-dumont-paoli"},
    "step": 1e-4, "duration": 0.8, "window": {"from": 0.3, "to": 0.8, "parts": 8},
    "outputs": {"shocks": {"force_above": 0.1, "rest": 1e-3}, "rate": 1000, "segment": 0.1,
                "spectra": [{"of": "plate", "quantity": "displacement"}, {"of": "plate", "quantity": "force"}]},
    "observe": ["rms_force[plate]", "wear_power[plate]"]})json");
  study["methods"]["contact"] = Json::parse(contact);
  return study;
}

double reading(const CaseRecord& record, const std::string& name) {
  return measure(record, name).value_or(std::nan(""));
}

const Table& clearance_table(const CaseRecord& record, const std::string& name) {
  const auto found =
      std::find_if(record.tables.begin(), record.tables.end(), [&](const Table& table) { return table.name == name; });
  REQUIRE(found != record.tables.end());
  return *found;
}

}  // namespace

TEST_CASE("a clearance has one row, one name, and the resultant of its sides as force") {
  CaseRuns runs;
  using Law = std::pair<const char*, double>;
  for (const auto& [contact, flexibility] :
       {Law{R"("signorini")", 0}, Law{R"({"name": "penalty", "stiffness": 1e5})", 1e-5}}) {
    INFO(contact);
    const CaseRecord record = runs.first_of(whirling(contact));
    REQUIRE(record.status == Status::done);
    const Table& stops = clearance_table(record, "stops");
    const std::size_t name = find_column(stops.columns, "stop").value();
    CHECK(std::count_if(stops.rows.begin(), stops.rows.end(),
                        [&](const Row& row) { return row[name].text() == "plate"; }) == 1);
    const NumberTable& impacts = *find_table(record.numbers, "impacts");
    CHECK(*impacts.words_of("stop") == std::vector<std::string>{"plate", "end"});
    CHECK(static_cast<double>(impacts.rows()) == reading(record, "impacts"));
    CHECK(reading(record, "impacts[plate]") >= 1);
    // To pass from side to side changes no set of closed stops, of which there are two.
    CHECK(reading(record, "active_set_changes") <=
          2 * (reading(record, "impacts[plate]") + reading(record, "impacts[end]")));
    // Impulse = mean force times the time in contact, of the same instants.
    CHECK(reading(record, "mean_force[plate]") * reading(record, "contact_time[plate]") ==
          Approx(reading(record, "impulse[plate]")).epsilon(1e-12));
    // It whirls along the circle, in contact for most of the time: few impacts, a mean distance of about the radius.
    CHECK(reading(record, "window_contact_share[plate]") > 0.5);
    const double depth = flexibility * reading(record, "window_force[plate]");
    CHECK(reading(record, "window_displacement_mean[plate]") == Approx(2e-3 + depth).epsilon(0.05));
    // Along the circle it moves by R·ω.
    CHECK(reading(record, "wear_power[plate]") ==
          Approx(reading(record, "window_force[plate]") * 2e-3 * 25).epsilon(0.3));
    CHECK(std::isfinite(reading(record, "confidence.wear_power[plate]")));
    const NumberTable& orbits = *find_table(record.numbers, "orbits");
    CHECK(*orbits.words_of("stop") == std::vector<std::string>{"plate"});
    CHECK(orbits.rows() == 2001);
    const std::vector<double>&y = *orbits.numbers("first"), &z = *orbits.numbers("second");
    // As far as a corner, and what the largest force presses a spring in.
    const double far = 2e-3 * 1.0049 + 1.01 * reading(record, "peak_force[plate]") / 1e5;
    double largest = 0;
    for (std::size_t i = 0; i < orbits.rows(); ++i) largest = std::max(largest, std::hypot(y[i], z[i]));
    CHECK(largest <= far);
    CHECK(largest > 1.9e-3);
  }
}

TEST_CASE("a motion that stays on one side of a clearance is that of a stop there") {
  CaseRuns runs;
  Json round = whirling(R"("signorini")");
  round.erase("outputs");
  round.erase("observe");
  round["scene"]["load"].erase(1);
  round["scene"]["stops"].erase(1);
  round["scene"]["stops"][0].erase("tangent");
  // A few impacts: later ones grow what rounding left.
  round["duration"] = 0.15;
  round["window"] = Json::parse(R"({"from": 0.02, "to": 0.15, "parts": 8})");
  Json flat = round;
  flat["scene"]["stops"][0] = Json::parse(R"({"name": "plate", "at": {"x": 0.8}, "lower": -2e-3, "upper": 2e-3})");
  const CaseRecord a = runs.first_of(round), b = runs.first_of(flat);
  for (const char* name : {"impulse[plate]", "impacts[plate]", "rms_force[plate]", "window_rms_force[plate]", "impacts",
                           "energy_end", "drift_per_impact", "contact_instants", "active_set_changes",
                           "contact_force_mean", "contact_force_deviation", "first_impact", "first_release"})
    CHECK(reading(a, name) == Approx(reading(b, name)).epsilon(1e-9));
}

TEST_CASE("points of modes and nodes of matrices move within clearances as the beam does") {
  // The plane of a beam has its own studies; here the sentence of what is missing.
  CaseRuns runs;
  Json study = whirling(R"("signorini")");
  study["scene"]["stops"][0]["at"] = {{"point", "plate"}};
  CHECK_THROWS_WITH(runs.study(study), Catch::Contains("the beam has no nodes that are called"));
}

TEST_CASE("the radius of a clearance may vary, with every law") {
  CaseRuns runs;
  for (const char* law : {R"("signorini")", R"({"name": "penalty", "stiffness": 1e5})"}) {
    Json study = whirling(law);
    study["duration"] = 0.2;
    study.erase("window");
    study.erase("outputs");
    const CaseRecord alone = runs.first_of(study);
    Json& radius = study["scene"]["stops"][0]["clearance"]["radius"];
    radius = {1e-3, radius};
    const std::vector<CaseRecord> both = runs.of(study);
    REQUIRE(both.size() == 2);
    CHECK(std::any_of(both.front().axes.begin(), both.front().axes.end(),
                      [](const auto& axis) { return axis.first == "stops.0.clearance.radius"; }));
    for (const char* name : {"impulse[plate]", "first_impact", "energy_end"}) {
      CHECK(reading(both.back(), name) == reading(alone, name));
      CHECK(reading(both.front(), name) != reading(alone, name));
    }
  }
}

TEST_CASE("sides of a clearance move nothing under a compliant law, and rigid laws say what they leave of the circle") {
  CaseRuns runs;
  Json study = whirling(R"({"name": "penalty", "stiffness": 1e5})");
  study["duration"] = 0.4;
  study["window"]["to"] = 0.4;
  study.erase("outputs");
  const auto with_sides = [&](int sides, const std::vector<double>& offset) {
    study["scene"]["stops"][0]["clearance"]["sides"] = sides;
    study["scene"]["stops"][0]["clearance"]["offset"] = offset;
    return runs.first_of(study);
  };
  const CaseRecord few = with_sides(5, {0, 0}), many = with_sides(64, {0, 0}), away = with_sides(64, {3e-4, 0});
  for (const char* name : {"impulse[plate]", "peak_force[plate]", "contact_time[plate]", "wear_power[plate]",
                           "window_displacement_mean[plate]", "energy_end"})
    CHECK(reading(few, name) == reading(many, name));
  CHECK(reading(many, "impulse[plate]") > 0);
  CHECK(reading(away, "impulse[plate]") != reading(many, "impulse[plate]"));
  study["methods"]["contact"] = "signorini";
  const CaseRecord rigid = with_sides(16, {0, 0});
  CHECK(std::any_of(rigid.notes.begin(), rigid.notes.end(), [](const std::string& note) {
    return note == "stop plate is a polygon of 16 sides: its corners lie 3.9e-05 m beyond the circle of 0.002 m";
  }));
}
