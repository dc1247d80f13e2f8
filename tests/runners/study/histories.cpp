// Tables, spectra and motions of supports in studies: what they give, and what each fault of them says.
#include "runners/study/histories.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "runners/store/record_values.hpp"
#include "runners/store/snapshots.hpp"
#include "tests/refusals.hpp"
#include "tests/runners/kinds/trajectory/case_runs.hpp"
#include "tests/runners/scratch_folder.hpp"

using namespace ricochet;
using namespace ricochet::testing;
using Catch::Matchers::Contains;

namespace {

Json shaken_study() {
  return Json::parse(R"json({
    "name": "shaken", "kind": "trajectory",
    "scene": {"structure": {"type": "oscillator", "mass": 43.8e3, "stiffness": 3.942e7},
              "motions": [{"acceleration": {"file": "base.csv", "value": "a", "after": "zero"}}],
              "frame": "supports"},
    "methods": {"mass": "consistent", "contact": "none", "time": "newmark"},
    "step": 1e-4, "duration": 0.5, "samples": 50})json");
}

/// Studies whose files lie in a folder of their own.
class Studies : ScratchFolder, public CaseRuns {
 public:
  Studies() : CaseRuns(path()) {
    write("base.csv", "t,a\n0,0\n0.025,9.81\n0.05,0\n0.4,0\n");
    write("force.csv", "t,F\n0,0\n0.1,5\n0.2,5\n");
  }
  void write(const std::string& name, const std::string& text) const { write_text(*this / name, text); }
};

Json moved_by(const std::string& pointer, const Json& value) {
  Json study = shaken_study();
  study[Json::json_pointer(pointer)] = value;
  return study;
}

double end_of(const CaseRecord& record, const std::string& name) {
  for (std::size_t i = 0; i < record.curve.names.size(); ++i)
    if (record.curve.names[i] == name) return record.curve.columns[i].back();
  FAIL("no curve " << name);
  return 0;
}

Json with_force(const Json& force) {
  return Json::parse(R"json({
    "name": "pushed", "kind": "trajectory",
    "scene": {"structure": {"type": "oscillator", "mass": 2, "stiffness": 100}},
    "methods": {"mass": "consistent", "contact": "none", "time": "newmark"},
    "step": 1e-3, "duration": 0.2, "samples": 20})json")
      .patch(Json::parse(R"json([{"op": "add", "path": "/scene/load", "value": [{}]}])json"))
      .patch(Json::array({{{"op", "add"}, {"path", "/scene/load/0/force"}, {"value", force}}}));
}

}  // namespace

TEST_CASE("a table pushes as the formula that it samples, and its factor and columns are those that are named") {
  Studies studies;
  const Json table = {{"file", "force.csv"}, {"value", "F"}, {"factor", 2}, {"after", "hold"}};
  const CaseRecord by_table = studies.of(with_force(table)).front();
  const CaseRecord by_formula = studies.of(with_force("2*(t < 0.1 ? 50*t : 5)")).front();
  REQUIRE(by_table.status == Status::done);
  const double tip = end_of(by_table, "tip_displacement");
  CHECK(tip != 0);
  CHECK(tip == Approx(end_of(by_formula, "tip_displacement")).epsilon(1e-12));
}

TEST_CASE("motions: a sampled formula is the table of its samples, displacement and acceleration agree") {
  Studies studies;
  Json study = shaken_study();
  const double pi = 3.141592653589793;
  // φ = 1 mm sin(20π t): its acceleration has no value at t = 0 and at the end, as a natural spline asks.
  study["scene"]["motions"][0] = {
      {"displacement", {{"formula", "1e-3*sin(20*pi*t)"}, {"every", 1e-4}, {"until", 0.5}}}};
  const double by_displacement = end_of(studies.of(study).front(), "tip_displacement");
  study["scene"]["motions"][0] = {
      {"acceleration", {{"formula", "-1e-3*(20*pi)^2*sin(20*pi*t)"}, {"every", 1e-4}, {"until", 0.5}}},
      {"start", {{"velocity", 1e-3 * 20 * pi}}}};
  const double by_acceleration = end_of(studies.of(study).front(), "tip_displacement");
  // Both interpolate to (20π·1e-4)²/12 = 3e-6.
  CHECK(by_displacement == Approx(by_acceleration).epsilon(1e-4));
  CHECK(std::abs(by_displacement) > 1e-5);
}

TEST_CASE("random loads: a seed is an axis, and each seed is another load") {
  Studies studies;
  Json study = with_force({{"psd", {{"formula", "4/(1 + (f/20)^2)"}, {"from", 1}, {"to", 50}, {"lines", 980}}}});
  study["scene"]["seed"] = {1, 2, 3};
  const std::vector<CaseRecord> records = studies.of(study), again = studies.of(study);
  REQUIRE(records.size() == 3);
  std::set<double> ends;
  for (std::size_t i = 0; i < 3; ++i) {
    REQUIRE(records[i].status == Status::done);
    ends.insert(end_of(records[i], "tip_displacement"));
    CHECK(end_of(records[i], "tip_displacement") == end_of(again[i], "tip_displacement"));
  }
  CHECK(ends.size() == 3);
  Json sure = with_force("sin(t)");
  sure["scene"]["seed"] = {1, 2, 3};
  CHECK_THROWS_WITH(studies.of(sure), Contains("seeds draw random loads (psd)"));
}

TEST_CASE("a spectrum from a table is the one of the formula that the table samples") {
  Studies studies;
  // A power of f is straight in logarithms, and 2 + f straight: entries may lie anywhere.
  studies.write("power.csv", "f,S [N^2/Hz]\n0.5,16\n3,0.444444444444444444\n60,0.00111111111111111111\n");
  studies.write("line.csv", "f (Hz),S\n0,1\n7,4.5\n60,31\n");
  const auto end = [&](Json psd) {
    psd.update({{"from", 1}, {"to", 50}, {"lines", 980}});
    return end_of(studies.of(with_force({{"psd", psd}})).front(), "tip_displacement");
  };
  CHECK(end({{"file", "power.csv"}, {"value", "S"}}) == Approx(end({{"formula", "4/f^2"}})).epsilon(1e-12));
  CHECK(end({{"file", "line.csv"}, {"value", "S"}, {"interpolation", "linear"}, {"factor", 2}}) ==
        Approx(end({{"formula", "2 + f"}})).epsilon(1e-12));
}

TEST_CASE("a random load that repeats within the run is told") {
  Studies studies;
  Json study = with_force({{"psd", {{"formula", 4}, {"from", 0}, {"to", 20}, {"lines", 100}}}});
  study["duration"] = 15;
  const auto notes = [&] {
    std::string all;
    const std::vector<CaseRecord> records = studies.of(study);
    for (const std::string& note : records.front().notes) all += note + "\n";
    return all;
  };
  // Lines 0.2 Hz apart repeat after 10 s.
  CHECK_THAT(notes(),
             Contains("the random load 0 repeats after 10 s, and the run takes 15 s: 1.5 times as many lines"));
  study["duration"] = 10;
  CHECK_THAT(notes(), !Contains("repeats"));
}

TEST_CASE("a table is part of what a case is: another content makes another case, another time another one too") {
  Studies studies;
  const Study before = studies.study(shaken_study());
  studies.write("base.csv", "t,a\n0,0\n0.025,9.8\n0.05,0\n0.4,0\n");
  Studies other;
  CHECK(other.study(shaken_study()).cases.front().id == before.cases.front().id);
  CHECK(studies.study(shaken_study()).cases.front().id != before.cases.front().id);
  // A stored study knows its files, and says when they are no longer those.
  Json stored = before.resolved;
  CHECK_THAT(studies.refusal(stored), Contains("base.csv has changed since the run began"));
}

TEST_CASE("an accelerogram moves a structure alike in each form, and the case says which that was") {
  Studies studies;
  const auto ends = [&](const std::string& file, double factor, const std::string& text) {
    studies.write(file, text);
    const Json study = moved_by("/scene/motions/0/acceleration",
                                {{"file", file}, {"value", "a"}, {"factor", factor}, {"after", "zero"}});
    const CaseRecord record = studies.of(study).front();
    REQUIRE(record.status == Status::done);
    std::string notes;
    for (const std::string& note : record.notes)
      if (note.starts_with(file)) notes += note + "\n";
    return std::pair(end_of(record, "tip_displacement"), notes);
  };
  const auto [plain, none] = ends("plain.csv", 9.81, "t,a\n0,0\n0.25,1\n0.5,0\n");
  CHECK_THAT(none, !Contains(" read"));
  const auto [at2, said] = ends("a.AT2", 9.81, "RECORD\nVALLEY\nUNITS OF G\nNPTS= 3, DT= .25 SEC\n 0. .1D+01\n 0.\n");
  CHECK(at2 == plain);
  CHECK_THAT(said, Contains("a.AT2 is read as AT2: 3 values in G, dt 0.25 s, the first at t = 0"));
  const auto [german, points] = ends("b.csv", 9.81, "t [s];a [g]\n0;0\n0,25;1\n0,5;0\n");
  CHECK(german == plain);
  CHECK_THAT(points, Contains("b.csv: decimal commas are read as points\nb.csv: semicolons separate its cells\n"));
  // A unit without a factor would be taken for m/s².
  studies.write("c.csv", "t [s],a [g]\n0,0\n0.5,1\n");
  studies.write("d.csv", "t [ms],a\n0,0\n500,1\n");
  const auto refused = [&](const char* file, double factor) {
    return studies.refusal(
        moved_by("/scene/motions/0/acceleration", {{"file", file}, {"value", "a"}, {"factor", factor}}));
  };
  CHECK_THAT(refused("a.AT2", 1), Contains("a.AT2 is in G; expected \"factor\", which makes SI units of it"));
  CHECK_THAT(refused("c.csv", 1), Contains("c.csv: the column a [g] is in g; expected \"factor\""));
  CHECK_THAT(refused("d.csv", 2), Contains("d.csv: the column t [ms] is in ms; expected s"));
}

TEST_CASE("a surface goes by a number, a table of it, or its formula, and a period leaves it a mean", "[friction]") {
  Studies studies;
  studies.write("belt.csv", "t,V\n0,0.08\n1,0.08\n");
  studies.write("swing.csv", "t,V\n0,0.05\n0.1,0.15\n0.2,0.05\n");
  const auto end_with = [&](const Json& speed) {
    const Json study = Json::parse(R"json({
      "name": "belt", "kind": "trajectory",
      "scene": {"structure": {"type": "oscillator", "mass": 1.5, "stiffness": 600},
                "stops": [{"name": "belt", "at": {"x": 0}, "normal_force": 20, "friction": 0.1, "tangent": {}}]},
      "methods": {"mass": "consistent", "contact": "none", "time": "moreau-jean"},
      "step": 1e-3, "duration": 0.4, "samples": 20})json");
    Json with = study;
    with["scene"]["stops"][0]["tangent"]["speed"] = speed;
    return end_of(studies.of(with).front(), "tip_displacement");
  };
  const double still = end_with(0), constant = end_with(0.08);
  CHECK(still == 0);
  CHECK(std::abs(constant) > 1e-4);
  CHECK(end_with({{"file", "belt.csv"}, {"value", "V"}, {"after", "hold"}}) == Approx(constant).epsilon(1e-12));
  CHECK(end_with({{"formula", "0.08"}, {"every", 0.1}, {"until", 1}}) == Approx(constant).epsilon(1e-12));
  // Straight between its entries, the formula is the table; it turns round where it repeats.
  const double swing = end_with({{"file", "swing.csv"}, {"value", "V"}, {"period", 0.2}});
  CHECK(end_with({{"formula", "0.05+abs(0.1-abs(t-0.1))"}, {"every", 0.1}, {"period", 0.2}}) ==
        Approx(swing).epsilon(1e-12));
  CHECK(std::abs(swing - constant) > 1e-5);
}

TEST_CASE("each fault of a surface's speed is told with its place", "[friction]") {
  Studies studies;
  studies.write("belt.csv", "t,V\n0,0.08\n0.1,0.08\n");
  const auto fault = [&](const Json& speed) {
    Json study = moved_by("/scene/stops", Json::parse(R"json([{"name": "belt", "at": {"x": 0}, "normal_force": 20,
                                                          "friction": 0.1, "tangent": {}}])json"));
    study["scene"].erase("motions");
    study["scene"].erase("frame");
    study["scene"]["stops"][0]["tangent"]["speed"] = speed;
    return studies.refusal(study);
  };
  CHECK_THAT(fault({{"file", "belt.csv"}, {"value", "V"}}),
             Contains("/scene/stops/0/tangent/speed/after: belt.csv ends at 0.1 s"));
  CHECK_THAT(fault({{"file", "belt.csv"}, {"value", "W"}}), Contains("/scene/stops/0/tangent/speed"));
  CHECK_THAT(fault({{"fil", "belt.csv"}}), Contains("/scene/stops/0/tangent/speed"));
  CHECK_THAT(fault("fast"), Contains("/scene/stops/0/tangent/speed: expected a number"));
}

TEST_CASE("without motions, random loads and frames nothing of a study changes") {
  Studies studies;
  const Json resolved = studies.study(with_force(1)).resolved;
  for (const char* key : {"motions", "frame", "seed"}) CHECK_FALSE(resolved["scene"].contains(key));
  CHECK_FALSE(resolved["scene"]["stops"].contains("moves_with"));
}

TEST_CASE("each fault of a table is told with its file, line and what was expected") {
  Studies studies;
  const std::string here = "/scene/motions/0/acceleration";
  CHECK_THAT(studies.refusal(moved_by(here + "/file", "bass.csv")),
             Contains(here + "/file") && Contains("no such file") && Contains("base.csv"));
  CHECK_THAT(studies.refusal(moved_by(here + "/value", "acc")), Contains("base.csv") && Contains("\"acc\""));
  CHECK_THAT(studies.refusal(moved_by(here + "/file", "../base.csv")), Contains("outside the folder of the study"));
  studies.write("back.csv", "t,a\n0,0\n0.13,1\n0.12,2\n");
  CHECK_THAT(studies.refusal(moved_by(here + "/file", "back.csv")),
             Contains("back.csv, line 4: t = 0.12 after 0.13; times must increase"));
  studies.write("short.csv", "t,a\n0,0\n");
  CHECK_THAT(studies.refusal(moved_by(here + "/file", "short.csv")), Contains("one entry; expected two"));
  studies.write("nan.csv", "t,a\n0,0\n1,nan\n");
  CHECK_THAT(studies.refusal(moved_by(here + "/file", "nan.csv")), Contains("nan.csv, line 3"));
  CHECK_THAT(studies.refusal(moved_by(here + "/after", "error")),
             Contains(here + "/after: base.csv ends at 0.4 s, the run at 0.5 s") && Contains("at most 0.4 s"));
  studies.write("late.csv", "t,a\n0.01,0\n1,1\n");
  CHECK_THAT(studies.refusal(moved_by(here + "/file", "late.csv")),
             Contains(here + "/before: late.csv begins at 0.01 s"));
  CHECK_THAT(studies.refusal(moved_by(here + "/interpolation", "cubic")), Contains("expected one of \"linear\""));
}

TEST_CASE("each fault of a motion is told with its place and the nearest name") {
  Studies studies;
  CHECK_THAT(studies.refusal(moved_by("/scene/motions/0/supports", "bass")),
             Contains("/scene/motions/0/supports") && Contains("did you mean \"base\"?"));
  CHECK_THAT(studies.refusal(moved_by("/scene/support", {{"amplitude", 1}, {"pulsation", 1}})),
             Contains("/scene/support: support and motions stand together"));
  CHECK_THAT(studies.refusal(moved_by("/scene/stops", {{"upper", 1}, {"at", "tip"}, {"moves_with", "floor"}})),
             Contains("/scene/stops/moves_with: no support \"floor\""));
  Json at_rest = with_force(1);
  at_rest["scene"]["frame"] = "supports";
  CHECK_THAT(studies.refusal(at_rest), Contains("/scene/frame: \"supports\" has no motion to count from"));
  Json both = shaken_study();
  both["scene"]["motions"][0]["displacement"] = {{"file", "base.csv"}, {"value", "a"}};
  CHECK_THAT(studies.refusal(both), Contains("does not go together with"));
  Json formula = shaken_study();
  formula["scene"]["motions"][0]["acceleration"] = {{"formula", "sin(t)"}, {"every", 0.1}, {"until", 0.01}};
  CHECK_THAT(studies.refusal(formula), Contains("acceleration/every"));
}

TEST_CASE("each fault of a spectrum is told with its frequency") {
  Studies studies;
  const auto refused = [&](const char* psd) { return studies.refusal(with_force({{"psd", Json::parse(psd)}})); };
  CHECK_THAT(refused(R"json({"formula": "12 - f", "from": 1, "to": 50, "lines": 49})json"),
             Contains("/scene/load/0/force/psd: S(f) is -") && Contains("Hz; expected 0 or above"));
  CHECK_THAT(refused(R"json({"formula": "t", "from": 1, "to": 50, "lines": 49})json"),
             Contains("psd/formula") && Contains("the only variable is f"));
  CHECK_THAT(refused(R"json({"formula": 1, "from": 50, "to": 5, "lines": 49})json"),
             Contains("psd/to") && Contains("ends at 5 Hz"));
  CHECK_THAT(refused(R"json({"formula": 1, "from": 1, "to": 5, "lines": 0})json"), Contains("psd/lines"));
}

TEST_CASE("each fault of a tabled spectrum is told with its place") {
  Studies studies;
  const auto refused = [&](const char* table, Json more = Json::object()) {
    studies.write("S.csv", table);
    Json psd = {{"file", "S.csv"}, {"value", "S"}, {"from", 5}, {"to", 20}, {"lines", 10}};
    psd.update(more);
    return studies.refusal(with_force({{"psd", psd}}));
  };
  CHECK_THAT(refused("f,S\n6,1\n30,1\n"), Contains("psd/from") && Contains("S.csv begins at 6 Hz"));
  CHECK_THAT(refused("f,S\n1,1\n19,1\n"), Contains("psd/to") && Contains("S.csv ends at 19 Hz"));
  CHECK_THAT(refused("f,S\n1,1\n"), Contains("has one frequency; expected two or more"));
  CHECK_THAT(refused("f,S\n1,1\n9,2\n8,3\n30,1\n"), Contains("f = 8 after 9; frequencies must increase"));
  CHECK_THAT(refused("f,S\n0,1\n30,1\n"), Contains("psd/interpolation") && Contains("expected \"linear\""));
  CHECK_THAT(refused("f,S\n1,1\n9,0\n30,1\n"), Contains("\"log\" has no S(f) = 0 at 9 Hz"));
  CHECK_THAT(refused("f,S\n1,1\n9,-2\n30,1\n", {{"interpolation", "linear"}}), Contains("S(f) is -"));
  CHECK_THAT(refused("f [rad/s],S\n1,1\n30,1\n"), Contains("is in rad/s; expected Hz"));
  CHECK_THAT(refused("f,S [g^2/Hz]\n1,1\n30,1\n"), Contains("is in g; expected \"factor\""));
  CHECK_THAT(refused("f,S [N]\n1,1\n30,1\n"), Contains("is in N; expected N²/Hz"));
  CHECK_THAT(refused("f,S\n1,1\n30,1\n", {{"frequency", "Hz"}}), Contains("Hz"));
  CHECK_THAT(refused("f,S\n1,1\n30,1\n", {{"formula", "1"}}), Contains("psd"));
}

namespace {

double value_at(const CaseRecord& record, const std::string& name, double t) {
  const Series& times = record.curve.columns.front();
  for (std::size_t i = 0; i < record.curve.names.size(); ++i)
    for (std::size_t k = 0; k < times.size() && record.curve.names[i] == name; ++k)
      if (std::abs(times[k] - t) < 1e-9) return record.curve.columns[i][k];
  FAIL("no " << name << " at " << t);
  return 0;
}

const char* const coordinates = "%%MatrixMarket matrix coordinate real symmetric\n";
const std::string dof_header = "dof,node,component,x,y,z,held\n";

}  // namespace

// code_aster, SDLD103: three masses of 10 kg and four springs of 1e4 N/m; the left support has a = 2e5 t², the right
// one rests.
TEST_CASE("supports that move apart: static modes carry their motion, relative displacements the rest") {
  Studies studies;
  studies.write("K.mtx", std::string(coordinates) +
                             "5 5 9\n1 1 1e4\n2 1 -1e4\n2 2 2e4\n3 2 -1e4\n3 3 2e4\n4 3 -1e4\n"
                             "4 4 2e4\n5 4 -1e4\n5 5 1e4\n");
  studies.write("M.mtx", std::string(coordinates) + "5 5 3\n2 2 10\n3 3 10\n4 4 10\n");
  studies.write("dofs.csv", dof_header +
                                "1,N1,ux,0,0,0,left\n2,N2,ux,1,0,0,\n3,N3,ux,2,0,0,\n4,N4,ux,3,0,0,\n"
                                "5,N5,ux,4,0,0,right\n");
  Json study = Json::parse(R"json({
    "name": "chain", "kind": "trajectory",
    "scene": {"structure": {"type": "assembled", "stiffness": "K.mtx", "mass": "M.mtx", "dofs": "dofs.csv",
                            "tip": {"node": "N2", "component": "ux"}},
              "motions": [{"supports": "left",
                           "acceleration": {"formula": "2e5*t^2", "every": 1e-4, "until": 1.01, "after": "hold"}}],
              "frame": "supports"},
    "mesh": {"elements": 1},
    "methods": {"mass": "consistent", "contact": "none", "time": "newmark"},
    "step": 2e-5, "duration": 1, "samples": 11})json");
  const double first = value_at(studies.of(study).front(), "tip_displacement", 1);
  study["scene"]["structure"]["tip"]["node"] = "N3";
  const double second = value_at(studies.of(study).front(), "tip_displacement", 1);
  study["scene"]["structure"]["tip"]["node"] = "N2";
  study["scene"].erase("frame");
  const double absolute = value_at(studies.of(study).front(), "tip_displacement", 1);
  CHECK(first == Approx(-174.7902).epsilon(1e-6));
  CHECK(second == Approx(-199.7219).epsilon(1e-6));
  // The static mode is ¾ there, and φ(1 s) = 2e5/12 m.
  CHECK(absolute == Approx(12325.20976).epsilon(1e-7));
  CHECK(absolute - first == Approx(0.75 * 2e5 / 12).epsilon(1e-8));
}

// code_aster, SDND102, two masses that meet: a stop between them, supports that move against each other.
TEST_CASE("two masses that meet, shaken against each other") {
  Studies studies;
  studies.write("K.mtx", std::string(coordinates) +
                             "4 4 6\n1 1 98696\n2 1 -98696\n2 2 98696\n3 3 98696\n4 3 -98696\n4 4 98696\n");
  studies.write("M.mtx", std::string(coordinates) + "4 4 2\n2 2 25\n3 3 25\n");
  studies.write("dofs.csv", dof_header + "1,L,ux,0,0,0,left\n2,A,ux,1,0,0,\n3,B,ux,2,0,0,\n4,R,ux,3,0,0,right\n");
  studies.write("start.csv", "dof,displacement,velocity\n2,0,-0.015915494309189534\n3,0,0.015915494309189534\n");
  Json study = Json::parse(R"json({
    "name": "meeting", "kind": "trajectory",
    "scene": {"structure": {"type": "assembled", "stiffness": "K.mtx", "mass": "M.mtx", "dofs": "dofs.csv",
                            "damping": {"mass": 8.796467}},
              "motions": [
                {"supports": ["left"], "start": {"velocity": -0.015915494309189534},
                 "acceleration": {"formula": "sin(20*pi*t)", "every": 1e-4, "until": 0.45}},
                {"supports": ["right"], "start": {"velocity": 0.015915494309189534},
                 "acceleration": {"formula": "-sin(20*pi*t)", "every": 1e-4, "until": 0.45}}],
              "initial": {"file": "start.csv"},
              "stops": [{"name": "gap", "at": {"node": "A", "component": "ux"},
                         "to": {"node": "B", "component": "ux"}, "upper": 1e-3}]},
    "mesh": {"elements": 1},
    "methods": {"mass": "consistent", "contact": {"name": "penalty", "stiffness": 2.88e7}, "time": "newmark"},
    "step": 1e-5, "duration": 0.4, "samples": 8})json");
  const CaseRecord record = studies.of(study).front();
  REQUIRE(record.status == Status::done);
  // Converged to some 1e-8 m at this step; the printed ones are 3e-6 from these.
  CHECK(value_at(record, "tip_displacement", 0.05) == Approx(-3.5801e-4).margin(2e-7));
  CHECK(value_at(record, "tip_displacement", 0.25) == Approx(-1.8873e-4).margin(2e-7));
  CHECK(value_at(record, "tip_displacement", 0.4) == Approx(-1.8985e-4).margin(2e-7));
}

TEST_CASE("the film of given matrices has the first support as its clamp, where that moves") {
  Studies studies;
  studies.write("K.mtx", std::string(coordinates) + "2 2 3\n1 1 1e4\n2 1 -1e4\n2 2 1e4\n");
  studies.write("M.mtx", std::string(coordinates) + "2 2 1\n2 2 10\n");
  studies.write("dofs.csv", dof_header + "1,L,ux,0,0,0,left\n2,A,ux,1,0,0,\n");
  const CaseRecord record = studies
                                .of(Json::parse(R"json({
    "name": "film", "kind": "trajectory",
    "scene": {"structure": {"type": "assembled", "stiffness": "K.mtx", "mass": "M.mtx", "dofs": "dofs.csv"},
              "motions": [{"displacement": {"formula": "1e-3*sin(20*pi*t)", "every": 1e-4, "until": 0.1}}],
              "stops": [{"name": "wall", "at": {"node": "A", "component": "ux"}, "upper": 1}]},
    "mesh": {"elements": 1},
    "methods": {"mass": "consistent", "contact": "signorini", "time": "newmark"},
    "step": 1e-4, "duration": 0.1, "samples": 10, "snapshots": 8})json"))
                                .front();
  REQUIRE(record.status == Status::done);
  const NumberTable* table = find_table(record.numbers, snapshots_name);
  REQUIRE(table);
  const Snapshots shots = snapshots_of(*table).value();
  REQUIRE(shots.t.size() == shots.clamp.size());
  for (std::size_t k = 0; k < shots.t.size(); ++k)
    CHECK(shots.clamp[k] == Approx(1e-3 * std::sin(20 * 3.141592653589793 * shots.t[k])).margin(1e-9));
}
