// Points, shocks, statistics of stops and spectra of a trajectory, by closed forms and by what they must add up to.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "runners/kinds/trajectory/stop_measures.hpp"
#include "runners/store/record_values.hpp"
#include "runners/table/table_reader.hpp"
#include "tests/refusals.hpp"
#include "tests/runners/kinds/trajectory/case_runs.hpp"

using namespace ricochet;
using ricochet::testing::CaseRuns;

namespace {

constexpr double pi = std::numbers::pi;

/// 100 kg on 1e4 N/m, let go at 1 m/s; period 2π/10 s.
Json swinging(double stop, double duration) {
  Json study = Json::parse(R"json({
    "name": "swinging", "kind": "trajectory",
    "scene": {"structure": {"type": "oscillator", "mass": 100, "stiffness": 1e4},
              "stops": [{"name": "wall", "at": {"x": 0}, "upper": 0}],
              "initial": {"velocity": 1}},
    "methods": {"mass": "consistent", "contact": {"name": "penalty", "stiffness": 1e6, "evaluation": "averaged"},
                "time": {"name": "newmark-dumont-paoli", "beta": 0.25}},
    "step": 1e-4})json");
  study["scene"]["stops"][0]["upper"] = stop;
  study["duration"] = duration;
  return study;
}

Json tube() {
  return Json::parse(R"json({
    "name": "tube", "kind": "trajectory",
    "scene": {"structure": {"type": "beam", "length": 1.5, "section": {"type": "given", "EI": 40, "rhoS": 0.12}},
              "load": "-20 - 60*sin(90*t)",
              "stops": [{"name": "plate", "at": {"x": 0.75}, "lower": -0.01, "upper": 0.01,
                         "tangent": {"slope_radius": 0.01}},
                        {"name": "end", "at": {"x": 1.5}, "lower": -0.01, "upper": 0.01}]},
    "mesh": {"elements": 10},
    "methods": {"mass": "consistent", "contact": {"name": "penalty", "stiffness": 1e6}, "time": "newmark-dumont-paoli"},
    "step": 5e-5, "march": "every-step", "duration": 0.1, "window": {"from": 0, "to": 0.1, "parts": 10}})json");
}

const std::vector<double>& curve_of(const CaseRecord& record, const std::string& name) {
  const auto& names = record.curve.names;
  const auto at = std::find(names.begin(), names.end(), name);
  REQUIRE(at != names.end());
  return record.curve.columns[static_cast<std::size_t>(at - names.begin())];
}

const Table& table_of(const CaseRecord& record, const char* name) {
  const Table* table = find_table(record.tables, name);
  REQUIRE(table);
  return *table;
}

}  // namespace

TEST_CASE("the curve of a point at the tip is that of the tip, and points of one motion keep its shape") {
  Json study = tube();
  study["scene"]["points"] = Json::parse(R"([{"name": "top", "at": {"x": 1.5}}, {"name": "half", "at": {"x": 0.75}},
                                             {"name": "root", "at": {"x": 0}}])");
  const CaseRecord record = CaseRuns().first_of(study);
  REQUIRE(record.status == Status::done);
  CHECK(curve_of(record, "top_displacement") == curve_of(record, "tip_displacement"));
  CHECK(curve_of(record, "top_velocity") == curve_of(record, "tip_velocity"));
  for (const double u : curve_of(record, "root_displacement")) CHECK(u == 0);
  CHECK(curve_of(record, "half_displacement") != curve_of(record, "top_displacement"));
  study["scene"].erase("points");
  const CaseRecord plain = CaseRuns().first_of(study);
  CHECK(curve_of(plain, "tip_displacement") == curve_of(record, "tip_displacement"));
  CHECK(plain.curve.names.size() + 6 == record.curve.names.size());
}

TEST_CASE("a point of a beam shows its bending moment and shear force, which balance a load at rest") {
  Json study = Json::parse(R"json({
    "name": "resting", "kind": "trajectory",
    "scene": {"structure": {"type": "beam", "length": 2, "section": {"type": "given", "EI": 40, "rhoS": 0.12}},
              "load": [{"at": 2, "force": 3}], "initial": {"displacement": "3*x^2*(6 - x)/240"},
              "points": [{"name": "half", "at": {"x": 1}, "fields": ["moment", "shear"]}, {"name": "end", "at": {"x": 2}}]},
    "mesh": {"elements": 4}, "methods": {"mass": "consistent", "contact": "none", "time": "newmark"},
    "step": 1e-3, "duration": 0.1, "samples": 10})json");
  const CaseRecord record = CaseRuns().first_of(study);
  REQUIRE(record.status == Status::done);
  // F(L − x), and −F.
  for (const double moment : curve_of(record, "half_moment")) CHECK(moment == Approx(3.0).epsilon(1e-7));
  for (const double shear : curve_of(record, "half_shear")) CHECK(shear == Approx(-3.0).epsilon(1e-7));
  CHECK(record.curve.names.back() == "half_shear");
  study["scene"]["points"][0]["fields"] = "momentum";
  CHECK_THAT(CaseRuns().refusal(study), Catch::Contains("/scene/points/0/fields") && Catch::Contains("moment"));
  Json swing = swinging(1, 1);
  swing["scene"]["points"] = Json::parse(R"([{"name": "mass", "at": {"x": 0}, "fields": "moment"}])");
  CHECK(CaseRuns().refusal(swing) == "/scene/points/0/fields: nothing bends in this oscillator; expected a beam");
}

TEST_CASE("the first point of a scene is where the tip of its tables is") {
  Json study = tube();
  study["scene"]["points"] = Json::parse(R"([{"name": "half", "at": {"x": 0.75}}])");
  const CaseRecord record = CaseRuns().first_of(study);
  CHECK(curve_of(record, "half_displacement") == curve_of(record, "tip_displacement"));
  CHECK(measure(record, "tip_displacement_end").value() == curve_of(record, "half_displacement").back());
}

TEST_CASE("a point counted from the supports leaves out what they move by") {
  Json study = Json::parse(R"json({
    "name": "shaken", "kind": "trajectory",
    "scene": {"structure": {"type": "beam", "length": 1.5, "section": {"type": "given", "EI": 40, "rhoS": 0.12}},
              "support": {"amplitude": 0.01, "pulsation": 30},
              "points": [{"name": "absolute", "at": {"x": 1}}, {"name": "relative", "at": {"x": 1}, "frame": "supports"}]},
    "mesh": {"elements": 6}, "methods": {"mass": "consistent", "contact": "none", "time": "newmark"},
    "step": 1e-3, "duration": 0.5, "samples": 50})json");
  const CaseRecord record = CaseRuns().first_of(study);
  REQUIRE(record.status == Status::done);
  const std::vector<double>&t = curve_of(record, "t"), &u = curve_of(record, "absolute_displacement"),
        &w = curve_of(record, "relative_displacement");
  for (std::size_t i = 0; i < t.size(); ++i) CHECK(u[i] - w[i] == Approx(0.01 * std::sin(30 * t[i])).margin(1e-12));
}

TEST_CASE("a shock of a study is a row, and its impact points to it") {
  Json study = swinging(0, 0.495);
  study["outputs"] = Json::parse(R"({"shocks": {"force_above": 0, "rest": 0.001}, "classes": 4})");
  study["observe"] = "shock_rate[wall]";
  const CaseRecord record = CaseRuns().first_of(study);
  REQUIRE(record.status == Status::done);
  const NumberTable* shocks = find_table(record.numbers, "shocks");
  REQUIRE(shocks);
  REQUIRE(shocks->rows() == 2);
  const double closed = std::sqrt(1.01e6 / 100), share = 1e-3;  // second order in ωh = 0.01
  CHECK(shocks->numbers("t_begin")->at(1) == Approx(pi / 10 + pi / closed).margin(2e-4));
  CHECK(shocks->numbers("peak_force")->at(1) == Approx(1e6 / closed).epsilon(share));
  CHECK(shocks->numbers("impulse")->at(1) == Approx(198.0198).epsilon(share));
  CHECK(shocks->words_of("stop")->front() == "wall");
  const NumberTable* impacts = find_table(record.numbers, "impacts");
  REQUIRE(impacts->rows() == 2);
  CHECK(impacts->columns.back().name == "shock");
  CHECK(*impacts->numbers("shock") == std::vector<double>{0, 1});
  CHECK(measure(record, "shock_rate[wall]").value() == Approx(2 / 0.495).epsilon(1e-12));
  CHECK(measure(record, "shock_time[wall]").value() == Approx(pi / closed).margin(2e-4));
  CHECK(measure(record, "rebound_time[wall]").value() == Approx(pi / closed).margin(2e-4));
  CHECK(measure(record, "shock_force_max[wall]").value() == Approx(1e6 / closed).epsilon(share));
  const Table& histogram = table_of(record, "histogram");
  REQUIRE(histogram.rows.size() == 4);
  CHECK(histogram.rows.back()[3].number() == 2.0);
  CHECK(histogram.rows.back()[4].number() == 1.0);
}

TEST_CASE("a free swing past a stop that it does not reach: mean, deviation and extremes of a sine") {
  constexpr double period = 2 * pi / 10, amplitude = 0.1;
  Json study = swinging(1, 4 * period);
  study["step"] = period / 4000;
  study["window"] = {{"from", 0}, {"to", 4 * period}, {"parts", 8}};
  const CaseRecord record = CaseRuns().first_of(study);
  REQUIRE(record.status == Status::done);
  const auto of = [&](const char* name) { return measure(record, std::string(name) + "[wall]").value(); };
  // Of the scheme's own sine, whose amplitude and period are off by (ωh)² at most.
  CHECK(of("window_displacement_mean") == Approx(0).margin(1e-5 * amplitude));
  CHECK(of("window_displacement_rms") == Approx(amplitude / std::sqrt(2)).epsilon(1e-5));
  CHECK(of("window_displacement_deviation") == Approx(amplitude / std::sqrt(2)).epsilon(1e-5));
  CHECK(of("window_displacement_max") == Approx(amplitude).epsilon(1e-5));
  CHECK(of("window_displacement_min") == Approx(-amplitude).epsilon(1e-5));
  CHECK(of("window_force") == 0);
  CHECK(of("window_contact_share") == 0);
  // A mean over no time is none.
  CHECK_FALSE(measure(record, "window_contact_force[wall]"));
  CHECK_FALSE(measure(record, "mean_force[wall]"));
  const Table& parts = table_of(record, "stop_parts");
  REQUIRE(parts.rows.size() == 8);
  const auto mean = find_column(parts.columns, "window_displacement_mean").value();
  // Half a period: 2/π of the amplitude.
  CHECK(parts.rows[2][mean].number().value() == Approx(2 / pi * amplitude).epsilon(1e-3));
  CHECK(parts.rows[3][mean].number().value() == Approx(-2 / pi * amplitude).epsilon(1e-3));
}

TEST_CASE("what a window of the whole run says of its stops adds up to what the run says of them") {
  Json study = tube();
  study["outputs"] = Json::parse(R"({"shocks": {"force_above": 0.1, "rest": 1e-4}})");
  const CaseRecord record = CaseRuns().first_of(study);
  REQUIRE(record.status == Status::done);
  const double duration = 0.1;
  for (const std::string stop : {"[plate]", "[end]"}) {
    const auto of = [&](const char* name) { return measure(record, name + stop).value(); };
    CHECK(of("window_force") * duration == Approx(of("impulse")).epsilon(1e-12));
    CHECK(of("window_contact_share") * duration == Approx(of("contact_time")).epsilon(1e-12));
    CHECK(of("window_contact_force") == Approx(of("mean_force")).epsilon(1e-12));
    CHECK(of("window_contact_rms_force") == Approx(of("rms_force")).epsilon(1e-12));
    CHECK(of("window_impact_rate") * duration == Approx(of("impacts")).epsilon(1e-12));
    CHECK(of("window_displacement_max") < 0.011);
    CHECK(of("confidence.window_force") >= 0);
    // Of a ratio of means, to first order.
    CHECK(of("confidence.window_contact_rms_force") > 0);
    CHECK(of("confidence.window_contact_rms_force") < of("rms_force"));
  }
  const Table& parts = table_of(record, "stop_parts");
  REQUIRE(parts.rows.size() == 20);
  const auto mean_of = [&](const char* name) {
    double mean = 0;
    for (std::size_t part = 0; part < 10; ++part)
      mean += parts.rows[part][find_column(parts.columns, name).value()].number().value() / 10;
    return mean;
  };
  const double force = mean_of("window_force"), wear = mean_of("wear_power"), rate = mean_of("shock_rate");
  CHECK(rate == Approx(measure(record, "shock_rate[plate]").value()).epsilon(1e-12));
  CHECK(rate > 0);
  for (const std::string mean : {"shock_rate", "shock_time", "rebound_time", "shock_force_mean"})
    CHECK(measure(record, "confidence." + mean + "[plate]").value() > 0);
  CHECK(force == Approx(measure(record, "window_force[plate]").value()).epsilon(1e-12));
  CHECK(wear == Approx(measure(record, "wear_power[plate]").value()).epsilon(1e-12));
  CHECK(wear > 0);
  CHECK_FALSE(measure(record, "wear_power[end]"));
  // The columns that stops.csv had stand first.
  const Table& stops = table_of(record, "stops");
  CHECK(find_column(stops.columns, "stop").value() == 11);
  CHECK(stops.columns[12].name == "window_displacement_mean");
  CHECK(stops.columns.back().name == "wear_power");
  const NumberTable* impacts = find_table(record.numbers, "impacts");
  CHECK(impacts->columns[impacts->columns.size() - 2].name == "tangent_speed");
}

TEST_CASE("observers of stops leave the motion as it is") {
  Json study = tube();
  study["outputs"] = Json::parse(R"({"shocks": {"force_above": 1}, "rate": 2000, "segment": 0.05,
      "spectra": [{"of": "end", "quantity": "displacement"}, {"of": "end", "quantity": "force"}]})");
  const CaseRecord full = CaseRuns().first_of(study);
  study.erase("outputs");
  study.erase("window");
  study["scene"]["stops"][0].erase("tangent");
  const CaseRecord lean = CaseRuns().first_of(study);
  REQUIRE(full.status == Status::done);
  for (const auto& [name, value] : lean.measures)
    // Energies are read at other steps, and summed up in another order.
    if (name != "microseconds_per_step")
      CHECK(measure(full, name).value() == Approx(value).epsilon(1e-11).margin(1e-12));
  CHECK(full.curve.columns.size() == lean.curve.columns.size());
  CHECK(curve_of(full, "tip_displacement") == curve_of(lean, "tip_displacement"));
}

TEST_CASE("a swing has its spectrum at its frequency, with half its squared amplitude") {
  constexpr double period = 2 * pi / 10, amplitude = 0.1;
  Json study = swinging(1, 40 * period);
  study["step"] = period / 2000;
  study["outputs"] = {
      {"spectra", {{{"of", "wall"}, {"quantity", "displacement"}}}}, {"rate", 32 / period}, {"segment", 8 * period}};
  const CaseRecord record = CaseRuns().first_of(study);
  const NumberTable* spectra = find_table(record.numbers, "spectra");
  REQUIRE(spectra);
  REQUIRE(spectra->rows() == 129);
  const std::vector<double>&density = *spectra->numbers("density"), &frequency = *spectra->numbers("frequency");
  double sum = 0;
  std::size_t top = 0;
  for (std::size_t k = 0; k < density.size(); ++k) {
    sum += density[k] * frequency[1];
    if (density[k] > density[top]) top = k;
  }
  CHECK(frequency[top] == Approx(1 / period).epsilon(1e-12));
  // The period of the scheme is off by (ωh)²/12: over 8 periods of a segment nothing is seen of it.
  CHECK(sum == Approx(amplitude * amplitude / 2).epsilon(1e-4));
}

TEST_CASE("levels of thirds of octaves are measures: the swing is in its own band, and is all there is") {
  constexpr double period = 2 * pi / 10, amplitude = 0.1;  // 1.59 Hz: the band of 1.6 Hz
  Json study = swinging(1, 200 * period);
  study["step"] = period / 2000;
  study["outputs"] = {
      {"spectra", {{{"of", "wall"}, {"quantity", "displacement"}}}}, {"rate", 32 / period}, {"segment", 32 * period}};
  study["observe"] = {"third_octave_displacement_1.6Hz[wall]"};
  const CaseRecord record = CaseRuns().first_of(study);
  // A Hann window leaves a line's power within two lines of it, 0.1 Hz here: the band is 0.36 Hz wide.
  CHECK(measure(record, "third_octave_displacement_1.6Hz[wall]").value() ==
        Approx(amplitude / std::sqrt(2)).epsilon(1e-3));
  CHECK(measure(record, "third_octave_displacement_1Hz[wall]").value() < 1e-3 * amplitude);
  const Table& rows = table_of(record, "third_octaves");
  REQUIRE(!rows.rows.empty());
  CHECK(rows.rows.front()[0].text() == "wall");

  study["observe"] = {"third_octave_force_1.6Hz[wall]"};
  CHECK_THAT(CaseRuns().refusal(study), Catch::Contains("/observe/0") && Catch::Contains("needs the spectrum of wall"));
  study["observe"] = {"third_octave_displacement_2000Hz[wall]"};
  CHECK_THAT(CaseRuns().refusal(study), Catch::Contains("none of 2000 Hz"));
}

TEST_CASE("a force that holds a mass on its stop has the spectrum of the load, as impulses over samples") {
  Json study = swinging(0, 2);
  study["scene"]["structure"]["stiffness"] = 0;
  study["scene"]["initial"] = Json::object();
  study["scene"]["load"] = Json::array({{{"force", "30 + 8*sin(32*pi*t)"}}});
  study["methods"]["contact"] = "signorini";
  study["step"] = 1.0 / 25600;  // a hundred to a sample
  study["outputs"] = Json::parse(R"({"rate": 256, "segment": 0.25, "spectra": [{"of": "wall", "quantity": "force"}]})");
  const CaseRecord record = CaseRuns().first_of(study);
  REQUIRE(record.status == Status::done);
  const NumberTable* spectra = find_table(record.numbers, "spectra");
  REQUIRE(spectra);
  double sum = 0;
  for (std::size_t k = 0; k < spectra->rows(); ++k)
    sum += spectra->numbers("density")->at(k) * spectra->numbers("frequency")->at(1);
  // A mean over 1/256 s of a sine of 16 Hz, which is one of the frequencies. The load is met at whole steps.
  const double sinc = std::sin(pi / 16) / (pi / 16);
  CHECK(sum == Approx(8 * 8 * sinc * sinc / 2).epsilon(1e-3));
}

TEST_CASE("outputs that cannot be are refused by pointer, with the nearest name") {
  using Catch::Contains;
  Json study = tube();
  const auto with = [&](const char* outputs) {
    study["outputs"] = Json::parse(outputs);
    return CaseRuns().refusal(study);
  };
  CHECK(with(R"({"shocks": {}})") == "no error");
  CHECK_THAT(with(R"({"shock": {}})"), Contains("/outputs/shock: unknown key") && Contains("shocks"));
  CHECK_THAT(with(R"({"shocks": {"force_above": -1}})"), Contains("/outputs/shocks/force_above"));
  CHECK_THAT(with(R"({"rate": 1000})"), Contains("/outputs/rate: is of spectra, and none is asked for"));
  CHECK_THAT(with(R"({"rate": 100, "segment": 0.1, "spectra": [{"of": "plat", "quantity": "force"}]})"),
             Contains("/outputs/spectra/0/of: no stop \"plat\"") && Contains("did you mean \"plate\"?"));
  CHECK_THAT(with(R"({"segment": 0.1, "spectra": [{"of": "end", "quantity": "force"}]})"),
             Contains("/outputs/rate: missing"));
  CHECK_THAT(with(R"({"rate": 1e5, "segment": 0.1, "spectra": [{"of": "end", "quantity": "force"}]})"),
             Contains("/outputs/rate: 100000 Hz is above one sample in a step of 5e-05 s"));
  CHECK_THAT(with(R"({"rate": 100, "segment": 0.05, "spectra": [{"of": "end", "quantity": "force"}]})"),
             Contains("/outputs/segment") && Contains("5 samples; expected an even number"));
  CHECK_THAT(with(R"({"rate": 100, "segment": 0.2, "spectra": [{"of": "end", "quantity": "force"}]})"),
             Contains("/outputs/segment: 0.2 s in 0.1 s"));
  study.erase("outputs");
  study["observe"] = "wear_power[end]";
  CHECK(CaseRuns().refusal(study) == "/observe/0: wear_power needs what slides there; give tangent to the stop");
  study["observe"] = "shock_rate[end]";
  CHECK(CaseRuns().refusal(study) == "/observe/0: shock_rate counts shocks; give outputs.shocks");
  study["observe"] = "window_force[end]";
  CHECK(CaseRuns().refusal(study) == "no error");
  study.erase("window");
  CHECK(CaseRuns().refusal(study) == "/observe/0: window_force is measured over a window; give one");
  study["kind"] = "convergence";
  study.erase("observe");
  study["reference"] = "self";
  study["scene"]["points"] = Json::parse(R"([{"name": "half", "at": {"x": 0.75}}])");
  CHECK_THAT(CaseRuns().refusal(study), Contains("/scene/points: a study of kind convergence shows no points"));
}

TEST_CASE("the half interval of a measure of a stop says of which it is") {
  const MeasureInfo* info = measure_info("confidence.wear_power[bar-a]");
  REQUIRE(info);
  CHECK(std::string(info->unit) == "W");
  CHECK(info->of == MeasureInfo::Of::computation);
  CHECK_FALSE(measure_info("confidence.energy[bar-a]"));
}
