// Motions, tables and stops that move, in sweeps of every structure.
#include <fmt/format.h>

#include <numbers>
#include <ricochet/measure/orbits/section_march.hpp>

#include "runners/kinds/basins/basins.hpp"
#include "runners/kinds/sweep/forced_scenes.hpp"
#include "runners/kinds/sweep/with_parameter.hpp"
#include "tests/runners/kinds/sweep/sweep_case.hpp"
#include "tests/runners/kinds/trajectory/case_runs.hpp"
#include "tests/runners/scratch_folder.hpp"

using namespace ricochet;
using namespace ricochet::testing;
using Catch::Matchers::Contains;

namespace periodic_motions_tests {

constexpr double omega = 60, whole = 2 * std::numbers::pi / omega;  // rad/s, s
constexpr int transient = 20, kept = 16, per_period = 200;

/// A sweep of one value through a number of a scene.
Json swept_scene(const Json& scene, const std::string& pointer, double value, const Json& mesh = nullptr) {
  Json study = Json::parse(R"({
    "name": "moved", "kind": "bifurcation",
    "methods": {"mass": "consistent", "contact": "signorini", "time": {"name": "newmark-dumont-paoli", "beta": 0.5}},
    "start": ["rest"], "exponents": 0, "refine": null})");
  study["scene"] = scene;
  if (!mesh.is_null()) study["mesh"] = mesh;
  study["steps_per_period"] = per_period;
  study["transient"] = {{"periods", transient}, {"at_most", transient}};
  study["keep"] = kept;
  study["parameter"] = {{"pointer", pointer}, {"values", {value}}};
  return study;
}

Json spans(const char* more = "{}") {
  Json beam = Json::parse(R"({"type": "beam", "length": 2, "young": 2e11, "density": 8000,
    "section": {"type": "tube", "outer_diameter": 0.01, "wall": 0.0005}, "damping": {"stiffness": 2e-3},
    "supports": [{"name": "p1", "x": 0, "type": "pinned"}, {"name": "p2", "x": 1.1, "type": "pinned"},
                 {"name": "p3", "x": 2, "type": "pinned"}]})");
  beam.update(Json::parse(more));
  return beam;
}

Json harmonic(const char* supports, double amplitude = 1e-3) {
  return {{"supports", supports}, {"displacement", {{"amplitude", amplitude}, {"pulsation", omega}}}};
}

const char* const oscillator = R"({"type": "oscillator", "mass": 1, "stiffness": 1600, "damping": 4})";

/// Studies whose files lie in a folder of their own.
class Moved : ScratchFolder, public CaseRuns {
 public:
  Moved() : CaseRuns(path()) {
    const std::string head = "%%MatrixMarket matrix coordinate real symmetric\n4 4 ";
    write_text(*this / "K.mtx", head + "7\n1 1 1e4\n2 1 -1e4\n2 2 2e4\n3 2 -1e4\n3 3 2e4\n4 3 -1e4\n4 4 1e4\n");
    write_text(*this / "M.mtx", head + "2\n2 2 1\n3 3 1\n");
    write_text(
        *this / "dofs.csv",
        "dof,node,component,x,y,z,held\n1,N1,ux,0,0,0,left\n2,N2,ux,1,0,0,\n3,N3,ux,2,0,0,\n4,N4,ux,3,0,0,right\n");
    write_text(*this / "start.csv", "dof,displacement,velocity\n2,1e-4,0\n3,-1e-4,1e-3\n");
    std::string table = "t,F,a\n";
    constexpr int entries = 400;
    for (int i = 0; i <= entries; ++i) {
      const double turn = 2 * std::numbers::pi * (i % entries) / entries;
      table += fmt::format("{:.17g},{:.17g},{:.17g}\n", whole * i / entries, std::cos(turn),
                           -1e-3 * omega * omega * std::sin(turn));
    }
    write_text(*this / "one.csv", table);
  }
  CaseRecord run(const Json& text) {
    const std::atomic<bool> stop = false;
    CaseRecord record = run_bifurcation(study(text).cases.front(), registry(), {}, stop);
    INFO(record.reason());
    REQUIRE(record.status == Status::done);
    return record;
  }
  std::vector<double> strobes(const Json& text) {
    return column_of(numbers_of(run(text), "points"), "tip_displacement");
  }
  /// The tip of a trajectory of the same scene at the end of each period.
  std::vector<double> passed(Json text) {
    for (const char* key : {"parameter", "steps_per_period", "transient", "keep", "start", "exponents", "refine"})
      text.erase(key);
    text["kind"] = "trajectory";
    text["step"] = whole / per_period;
    constexpr int periods = transient + kept;
    text["duration"] = periods * whole * (1 + 1e-9);
    text["samples"] = periods;
    const CaseRecord record = first_of(text);
    INFO(record.reason());
    REQUIRE(record.status == Status::done);
    const Series& tip = record.curve.columns.at(1);
    return {tip.begin() + transient + 1, tip.end()};
  }
};

Json scene_of(const Json& structure, const Json& stops, const Json& motions) {
  Json scene = {{"structure", structure}};
  if (!stops.empty()) scene["stops"] = stops;
  if (!motions.empty()) scene["motions"] = motions;
  return scene;
}

Json stop_at(const char* at, double gap) {
  return Json::array({{{"name", "a"}, {"at", Json::parse(at)}, {"lower", -gap}, {"upper", gap}}});
}

TEST_CASE("bifurcation: the strobe of every structure is where a trajectory of it stands after as many periods") {
  Moved studies;
  const Json two = spans(R"({"planes": 2})");
  Json across = harmonic("p2", 4e-4);
  across["component"] = "uz";
  across["displacement"]["phase"] = 0.3;
  const Json holes = Json::parse(R"([
    {"name": "hole", "at": {"x": 0.5}, "clearance": {"radius": 4e-4, "sides": 16}},
    {"name": "carried", "at": {"x": 1.5}, "clearance": {"radius": 5e-4, "sides": 12}, "moves_with": "p2"}])");
  Json given = Json::parse(R"({"type": "assembled", "stiffness": "K.mtx", "mass": "M.mtx", "dofs": "dofs.csv",
                               "damping": {"stiffness": 1e-3}})");
  Json moving = stop_at(R"({"x": 0.5})", 2e-4);
  moving[0]["moves_with"] = Json::parse(R"json({"displacement": {"formula": "4e-4*sin(60*t)", "every": 1e-4
}
})json");
  moving[0]["moves_with"]["displacement"]["pulsation"] = omega;
  Json bodies = {{"bodies", {{"rod", spans()}, {"strap", Json::parse(oscillator)}}},
                 {"motions", Json::array({harmonic("p2")})},
                 {"stops", Json::parse(R"([{"name": "a", "at": {"body": "rod", "x": 0.5}, "to": {"body": "strap"},
                                            "lower": -2e-4, "upper": 2e-4}])")}};
  Json shaken = scene_of(two, Json::array({holes[0]}), Json::array());
  shaken["support"] = {{"amplitude", 1e-3}, {"pulsation", omega}};
  Json pushed = scene_of(Json::parse(oscillator), stop_at(R"({"x": 0})", 2e-4), Json::array());
  pushed["load"] =
      Json::parse(R"([{"force": {"file": "one.csv", "value": "F", "factor": 3, "interpolation": "cubic"}}])");
  pushed["load"][0]["force"]["period"] = whole;
  const Json none, elements = {{"elements", 4}};
  struct Case {
    const char* name;
    Json scene;
    const char* pointer;
    double value;
    Json mesh;
  };
  const Case cases[] = {
      {"spans", scene_of(spans(), stop_at(R"({"x": 0.5})", 2e-4), Json::array({harmonic("p2")})),
       "/scene/motions/0/displacement/amplitude", 1e-3, elements},
      {"modes", scene_of(spans(), stop_at(R"({"x": 0.5})", 2e-4), Json::array({harmonic("p2")})), "/scene/stops/0/at/x",
       0.5, Json::parse(R"({"elements": 4, "modes": 4})")},
      {"two planes", scene_of(two, holes, Json::array({harmonic("p2", 4e-4), across})),
       "/scene/stops/0/clearance/radius", 4e-4, elements},
      {"two planes, shaken", shaken, "/scene/support/amplitude", 1e-3, elements},
      {"assembled",
       scene_of(given, stop_at(R"({"node": "N2", "component": "ux"})", 2e-4), Json::array({harmonic("left")})),
       "/scene/stops/0/upper", 2e-4, none},
      {"bar",
       scene_of(Json::parse(R"({"type": "bar", "length": 1, "EA": 1e5, "rhoA": 1, "fixed": "right",
                                "damping": {"stiffness": 1e-3}})"),
                stop_at(R"({"x": 0})", 1e-3), Json::array({harmonic("clamp")})),
       "/scene/stops/0/upper", 1e-3, elements},
      {"oscillator", scene_of(Json::parse(oscillator), stop_at(R"({"x": 0})", 2e-4), Json::array({harmonic("base")})),
       "/scene/motions/0/displacement/amplitude", 1e-3, none},
      {"a table of forces", pushed, "/scene/load/0/force/factor", 3, none},
      {"a stop that moves", scene_of(spans(), moving, Json::array()), "/scene/stops/0/lower", -2e-4, elements},
      {"bodies", bodies, "/scene/stops/0/upper", 2e-4, Json::parse(R"({"elements": {"rod": 4}})")}};
  for (const Case& one : cases) {
    INFO(one.name);
    Json study = swept_scene(one.scene, one.pointer, one.value, one.mesh);
    if (one.mesh.is_null()) study.erase("mesh");
    const std::vector<double> a = studies.strobes(study), b = studies.passed(study);
    REQUIRE(a.size() == b.size());
    double largest = 0;
    for (const double x : a) largest = std::max(largest, std::abs(x));
    CHECK(largest > 1e-8);
    // Times of the table differ by round-off of 37 periods; damping keeps it small.
    for (std::size_t i = 0; i < a.size(); ++i) CHECK(std::abs(a[i] - b[i]) <= 1e-8 * largest);
  }
}

TEST_CASE("bifurcation: a harmonic displacement is the support, and an acceleration without drift nearly is") {
  Moved studies;
  Json scene = scene_of(Json::parse(oscillator), stop_at(R"({"x": 0})", 2e-4), Json::array());
  scene["support"] = {{"amplitude", 1e-3}, {"pulsation", omega}};
  const auto speeds = [&](const Json& study) { return column_of(numbers_of(studies.run(study), "impacts"), "speed"); };
  const std::vector<double> support = speeds(swept_scene(scene, "/scene/support/amplitude", 9e-4));
  scene.erase("support");
  scene["motions"] = Json::array({harmonic("base")});
  const std::vector<double> motion = speeds(swept_scene(scene, "/scene/motions/0/displacement/amplitude", 9e-4));
  scene["motions"] =
      Json::parse(R"([{"acceleration": {"file": "one.csv", "value": "a"}, "start": {"velocity": null}}])");
  scene["motions"][0]["acceleration"]["period"] = whole;
  const std::vector<double> table = speeds(swept_scene(scene, "/scene/motions/0/acceleration/factor", 0.9));
  REQUIRE(support.size() == motion.size());
  REQUIRE(support.size() == table.size());
  REQUIRE(!support.empty());
  for (std::size_t i = 0; i < support.size(); ++i) {
    CHECK(motion[i] == Approx(support[i]).epsilon(1e-9));
    CHECK(table[i] == Approx(support[i]).epsilon(1e-4));  // straight between 400 entries: (2π/400)²/12 = 2e-5
  }
}

TEST_CASE("basins: bodies begin as they say, files are multiplied, and both axes move the cells") {
  Moved studies;
  const auto ends = [&](Json scene, const char* x, const char* y, const Json& mesh) {
    Json study = swept_scene(scene, x, 0, mesh);
    for (const char* key : {"parameter", "start", "exponents"}) study.erase(key);
    study["kind"] = "basins";
    study["refine"] = false;
    study["axes"] = Json::array({{{"pointer", x}, {"from", -1}, {"to", 1}, {"count", 2}},
                                 {{"pointer", y}, {"from", -2}, {"to", 2}, {"count", 2}}});
    const std::atomic<bool> stop = false;
    const CaseRecord record = run_basins(studies.study(study).cases.front(), studies.registry(), {}, stop);
    INFO(record.reason());
    CHECK(record.status == Status::done);
    return table_of(record, "cells").rows.size();
  };
  Json given = Json::parse(R"({"type": "assembled", "stiffness": "K.mtx", "mass": "M.mtx", "dofs": "dofs.csv",
                               "damping": {"stiffness": 1e-3}})");
  Json scene = scene_of(given, stop_at(R"({"node": "N2", "component": "ux"})", 2e-4), Json::array({harmonic("left")}));
  scene["initial"] = {{"file", "start.csv"}};
  CHECK(ends(scene, "/scene/initial/displacement_factor", "/scene/initial/velocity_factor", Json()) == 4);
  Json bodies = {{"bodies", {{"rod", spans()}, {"strap", Json::parse(oscillator)}}},
                 {"motions", Json::array({harmonic("p2")})},
                 {"stops", Json::parse(R"([{"name": "a", "at": {"body": "rod", "x": 0.5}, "to": {"body": "strap"},
                                            "lower": -2, "upper": 2}])")},
                 {"initial", Json::parse(R"({"strap": {"displacement": 1e-4, "velocity": 1e-3}})")}};
  CHECK(ends(bodies, "/scene/initial/strap/displacement", "/scene/initial/strap/velocity",
             Json::parse(R"({"elements": {"rod": 4}})")) == 4);
  const Json two = spans(R"({"planes": 2})");
  CHECK(ends(scene_of(two, Json::parse(R"([{"name": "hole", "at": {"x": 0.5}, "clearance": {"radius": 3}}])"),
                      Json::array({harmonic("p2")})),
             "/scene/initial/displacement_z", "/scene/initial/velocity_z", {{"elements", 4}}) == 4);
}

TEST_CASE("random starts of a beam in two planes move along both") {
  Moved studies;
  const Json two = spans(R"({"planes": 2})");
  const Study study = studies.study(
      swept_scene(scene_of(two, Json::parse(R"([{"name": "hole", "at": {"x": 0.5}, "clearance": {"radius": 4e-4}}])"),
                           Json::array({harmonic("p2")})),
                  "/scene/motions/0/displacement/amplitude", 1e-3, {{"elements", 4}}));
  ForcedScenes scenes(study.cases.front(), studies.registry());
  const int scene = scenes.add("/scene/motions/0/displacement/amplitude", 1e-3, false);
  LaneSpec lane = scenes[scene].lane;
  set_random_state(lane, scenes.problem(scenes[scene].group), 1, 1);
  const Eigen::VectorXd at = scenes.problem(scenes[scene].group).contact * lane.position;
  CHECK(std::abs(at[0]) > 1e-6);
  CHECK(std::abs(at[4]) > 1e-6);  // the side along z
  CHECK(at.cwiseAbs().maxCoeff() <= 4e-4);
}

TEST_CASE("what has no period, another one or a drift is told with what to give") {
  Moved studies;
  const auto moved = [&](const char* motion) {
    return swept_scene(
        scene_of(Json::parse(oscillator), stop_at(R"({"x": 0})", 2e-3), Json::array({Json::parse(motion)})),
        "/scene/stops/0/upper", 2e-3);
  };
  CHECK(
      studies.refusal(moved(R"({"acceleration": {"file": "one.csv", "value": "a", "after": "zero"}})")) ==
      "/scene/motions/0/acceleration: says no period, and steps per period need one: expected \"period\" (s) of a "
      "table that repeats, or \"pulsation\" (rad/s) of a formula that does. A displacement may have an amplitude and a "
      "pulsation instead");
  CHECK(
      studies.refusal(moved(R"json({"displacement": {"formula": "1e-4*sin(60*t)", "every": 1e-4, "period": 0.1
}
})json")) ==
      "/scene/motions/0/displacement/period: 1e-4*sin(60*t) begins with 0 and ends with -2.79415498e-05; what repeats "
      "ends as it begins");
  CHECK(studies.refusal(moved(R"json({"displacement": {"formula": "sin(t)", "every": 1e-4
  }
  })json")) ==
        "/scene/motions/0/displacement/until: missing; expected the last instant in s, or the period of what repeats");
  CHECK(studies.refusal(moved(R"({"displacement": {"formula": "0", "every": 1e-4, "period": 0.1, "until": 0.1}})")) ==
        "/scene/motions/0/displacement/until: stands beside a period; expected one of both");
  CHECK(studies.refusal(moved(R"({"displacement": {"formula": "0", "every": 1e-4, "period": 0.1, "pulsation": 3}})")) ==
        "/scene/motions/0/displacement/pulsation: stands beside a period; expected one of both");
  CHECK(
      studies.refusal(moved(R"({"displacement": {"formula": "0", "every": 1e-4, "period": 0.1, "after": "hold"}})")) ==
      "/scene/motions/0/displacement/after: stands beside a period; what repeats has neither beginning nor end");
  CHECK_THAT(
      studies.refusal(moved(R"json({"acceleration": {"formula": "1+sin(60*t)", "every": 1e-4, "pulsation": 60
  }
  })json")),
      Contains("/scene/motions/0/acceleration: 1+sin(60*t) has a mean of 1 m/s² over its period, so the velocity "
               "grows without end; expected values whose mean is 0"));
  CHECK_THAT(studies.refusal(moved(R"json({"acceleration": {"formula": "sin(60*t)", "every": 1e-4, "pulsation": 60
  }
  })json")),
             Contains("/scene/motions/0/start/velocity: 0 m/s leaves a mean velocity of 0.01666") &&
                 Contains("a drift; expected -0.01666") && Contains("or null, which stands for it"));
  CHECK(studies.refusal(moved(R"({"acceleration": {"file": "one.csv", "value": "a", "after": "hold"},
                                  "start": {"velocity": null}})")) ==
        "/scene/motions/0/start/velocity: null is the start of what repeats; expected a number, or a period");
  Json two = moved(R"({"displacement": {"amplitude": 1e-4, "pulsation": 60}})");
  two["scene"]["stops"][0]["moves_with"] = Json::parse(R"({"displacement": {"amplitude": 1e-4, "pulsation": 91.7}})");
  CHECK_THAT(studies.refusal(two),
             Contains("/scene/stops/0/moves_with/displacement: the motion of the stop a does not repeat with a motion: "
                      "91.7 rad/s and 60 rad/s (") &&
                 Contains("no common period"));
  two["scene"]["stops"][0]["moves_with"]["displacement"]["pulsation"] = 90;  // 2 and 3 periods are one of both
  CHECK_NOTHROW(studies.study(two));
  CHECK_THAT(studies.refusal(moved(R"({"displacement": {"amplitud": 1e-4, "pulsation": 60}})")),
             Contains("unknown key \"amplitud\"; did you mean \"amplitude\"?"));
  Json swept = moved(R"({"displacement": {"amplitude": 1e-4, "pulsation": 60}})");
  swept["parameter"]["pointer"] = "/scene/motions/0/displacement/amplitud";
  CHECK_THAT(studies.refusal(swept),
             Contains("/parameter/pointer: ") && Contains("did you mean \"/scene/motions/0/displacement/amplitude\"?"));
}

}  // namespace periodic_motions_tests
