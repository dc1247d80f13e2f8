#include "runners/report/scene_sketch.hpp"

#include <catch2/catch.hpp>
#include <regex>

#include "runners/report/summary_page.hpp"
#include "tests/runners/report/synthetic.hpp"

using namespace ricochet;
using Catch::Matchers::Contains;
using Scene = nlohmann::ordered_json;

using synthetic::count;

namespace {

Scene beam() {
  return Scene::parse(R"({"scene": {
    "structure": {"type": "beam", "length": 1.5, "young": 2e11, "density": 8000,
                  "section": {"type": "tube", "outer_diameter": 0.01, "wall": 0.0005}, "damping": {"stiffness": 1e-4, "mass": 0}},
    "stops": {"lower": "x>1.4 ? 0 : -0.0003", "upper": 0.0006, "at": [0.5, 1.5]},
    "support": {"amplitude": [0.001, 0.002, 0.004], "pulsation": 30}, "load": "0",
    "initial": {"displacement": "0", "velocity": "-2*x"}}, "duration": 0.5})");
}

std::string value_of(const Scene& study, const std::string& symbol) {
  for (const report::SceneNumber& one : report::scene_numbers(study))
    if (one.symbol == symbol) return one.text;
  return "";
}

}  // namespace

TEST_CASE("a sketch says the numbers of its scene, and what the study varies as a range", "[report]") {
  const Scene study = beam();
  CHECK(value_of(study, "L") == "1.5 m");
  CHECK(value_of(study, "EI") == "33.76 N m²");  // π(D⁴ − d⁴)/64 × E
  CHECK(value_of(study, "ρS") == "0.1194 kg/m");
  CHECK(value_of(study, "A₀ (clamp)") == "from 0.001 to 0.004 m (3 values)");
  CHECK(value_of(study, "u_t(x, 0)") == "-2*x");
  CHECK(value_of(study, "upper stop") == "0.0006 m");
  CHECK(value_of(study, "load").empty());  // a load of 0 is none
  CHECK(value_of(study, "η (damping, of M)").empty());
}

TEST_CASE("stops stand where they are, each with its gap", "[report]") {
  const std::string svg = report::scene_svg(beam());
  CHECK(count(svg, ">0.0006 m<") == 2);
  CHECK(count(svg, ">-0.0003 m<") + count(svg, ">−0.0003 m<") == 1);
  CHECK(count(svg, ">0 m<") == 1);  // the formula at the tip
  CHECK_THAT(svg, Contains("A₀ sin(ωt)"));
  CHECK_THAT(svg, !Contains("f(x, t)"));
  Scene one_sided = beam();
  one_sided["scene"]["stops"]["lower"] = nullptr;
  CHECK(count(report::scene_svg(one_sided), "class=\"stop\"") == count(svg, "class=\"stop\"") / 2);
}

TEST_CASE("the label of a stop at the tip ends within the drawing", "[report]") {
  Scene study = beam();
  study["scene"]["stops"] = Scene::parse(
      R"([{"name": "never-touched-plate-far-away", "at": {"x": 1.5}, "lower": null, "upper": 0.5}, {"name": "b", "at": {"x": 0.5}, "lower": null, "upper": 0.001}])");
  const std::string svg = report::scene_svg(study);
  CHECK_THAT(svg, Contains("never-touched-plate-far-away 0.5 m"));
  const std::regex label("<text x=\"([-0-9.]+)\" y=\"[-0-9.]+\" text-anchor=\"([a-z]+)\">([^<]*)<");
  for (std::sregex_iterator one(svg.begin(), svg.end(), label), end; one != end; ++one) {
    INFO((*one)[3]);
    // Letters are six pixels wide in the mean.
    const double wide = 6 * static_cast<double>((*one)[3].length());
    CHECK(std::stod((*one)[1]) + ((*one)[2] == "start" ? wide : (*one)[2] == "middle" ? wide / 2 : 0) <= 640);
  }
}

TEST_CASE("a sketch for a phone draws the same with larger words", "[report]") {
  const std::string wide = report::scene_svg(beam()), narrow = report::scene_svg(beam(), true);
  CHECK_THAT(narrow, Contains("class=\"sketch narrow\" viewBox=\"0 "));
  for (const char* one : {"class=\"stop\"", "<text", "class=\"structure\""})
    CHECK(count(narrow, one) == count(wide, one));
  CHECK_FALSE(narrow == wide);
}

TEST_CASE("every structure is drawn, a study without a scene has no sketch", "[report]") {
  const Scene oscillator = Scene::parse(R"({"scene": {"structure": {"type": "oscillator", "mass": 2, "stiffness": 3,
    "force": {"amplitude": 1, "pulsation": 2.2}}, "stops": {"upper": 0.1, "at": "tip"}},
    "parameter": {"pointer": "/scene/structure/force/amplitude", "from": 0.2, "to": 1.2, "count": 6}})");
  CHECK_THAT(report::scene_svg(oscillator), Contains("F cos(ωt + ψ)"));
  Scene named = oscillator;
  named["scene"]["stops"] = Scene::parse(R"([{"name": "wall", "at": {"x": 0}, "upper": 0.25}])");
  CHECK_THAT(report::scene_svg(named), Contains(">wall 0.25 m<"));
  CHECK(value_of(oscillator, "F") == "from 0.2 to 1.2 N, swept");
  const Scene bar = Scene::parse(R"({"scene": {"structure": {"type": "bar", "length": 2, "EA": 3, "rhoA": 1,
    "fixed": "right"}, "stops": {"lower": -0.5, "at": "tip"}}})");
  CHECK_THAT(report::scene_svg(bar), Contains("0.5 m"));
  CHECK(report::scene_svg(Scene::object()).empty());
  Scene broken = beam();
  broken["scene"]["stops"]["lower"] = "no formula";
  CHECK_THAT(report::scene_svg(broken), Contains("0.0006 m"));
}

TEST_CASE("a summary names what ran, what did not, and by what it is known again", "[report]") {
  StudyResults results = synthetic::results();
  results.study = beam();
  const std::string html = report::summary_html(Choices(results));
  CHECK_THAT(html, Contains(results.question));
  CHECK_THAT(html, Contains("newmark-dumont-paoli (beta 0.25, 0.5)"));
  CHECK_THAT(html, Contains(report::study_fingerprint(results)));
  CHECK_THAT(html, Contains("refused"));
  StudyResults other = results;
  other.study["duration"] = 0.6;
  CHECK(report::study_fingerprint(other) != report::study_fingerprint(results));
  other = results;
  other.environment.entries.emplace_back("started", "later");
  CHECK(report::study_fingerprint(other) == report::study_fingerprint(results));
}

TEST_CASE("no name of a study breaks the style of its pages", "[report]") {
  StudyResults results = synthetic::results();
  results.name = "a\"}</style><script>\\";
  const std::string style = report::page_margins(results);
  CHECK_THAT(style, !Contains("</style"));
  CHECK_THAT(style, Contains("\\22 }\\3c /style>"));
}

TEST_CASE("a beam's own supports are drawn where they stand, with spans, masses and forces", "[report]") {
  Scene study = beam();
  Scene& structure = study["scene"]["structure"];
  const std::string plain = report::scene_svg(study);
  structure["supports"] = Scene::parse(R"([{"name": "left", "x": 0, "type": "clamped"},
    {"name": "plate", "x": 0.6, "type": "pinned"},
    {"name": "grid", "x": 1.2, "type": "elastic", "stiffness": 1e5, "rotation": 20}])");
  structure["masses"] = Scene::parse(R"([{"x": 1.5, "mass": 0.25, "inertia": 0}])");
  study["scene"]["load"] = Scene::parse(R"json([{"at": 0.3, "force": "sin(t)"}])json");
  const std::string svg = report::scene_svg(study);
  for (const char* name : {"left", "plate", "grid"}) CHECK_THAT(svg, Contains(">" + std::string(name) + "<"));
  CHECK(count(svg, ">0.6 m<") == 2);  // two spans, and the end beyond the last support
  CHECK(count(svg, ">0.3 m<") == 1);
  CHECK(count(svg, "class=\"spring\"") == 2);
  CHECK_THAT(svg, Contains(">0.25 kg<") && Contains(">F(t)<") && !Contains("f(x, t)"));
  CHECK(value_of(study, "support left") == "at 0 m, clamped");
  CHECK(value_of(study, "support plate") == "at 0.6 m, pinned");
  CHECK(value_of(study, "support grid") == "at 1.2 m, elastic, stiffness 1e5 N/m, rotation 20 N m/rad");
  CHECK(value_of(study, "mass") == "at 1.5 m, 0.25 kg");
  CHECK_THAT(plain, !Contains("class=\"spring\""));
}

TEST_CASE("matrices with places are drawn as nodes, links, stops with their names and loads", "[report]") {
  const Scene study = Scene::parse(R"json({"scene": {
    "structure": {"type": "assembled", "stiffness": "K.mtx", "mass": "M.mtx", "damping": {"ratio": 0.02}},
    "stops": [{"name": "wall", "at": {"node": "B", "component": "ux"}, "upper": 0.002},
              {"name": "pair", "at": {"node": "A", "component": "uz"}, "to": {"node": "C", "component": "uz"},
               "lower": -0.001, "upper": 0.003}],
    "load": [{"at": {"node": "A", "component": "ux"}, "force": "sin(t)"}]},
    "files": {"layout": {"axes": ["x", "z"], "nodes": ["A", "B", "C"], "x": [0, 1, 0], "y": [0, 0, 0.5], "held": [2],
      "links": [[0, 1], [0, 2]],
      "stops": [{"at": 1, "direction": [1, 0]}, {"at": 0, "to": 2, "direction": [0, 1]}],
      "loads": [{"at": 0, "direction": [1, 0]}]}}})json");
  const std::string svg = report::scene_svg(study);
  CHECK_THAT(svg, Contains("wall 0.002 m") && Contains("pair 0.003 m") && Contains(">F(t)<") && Contains(">1 m<"));
  CHECK_THAT(svg, Contains(">x<") && Contains(">z<"));
  CHECK(count(svg, "rect class=\"solid\"") == 1);
  CHECK(count(svg, "<line class=\"stop\"") == 3);  // faces
  CHECK(count(svg, "stop link") == 2);             // of both, a line to the other node
  CHECK(value_of(study, "damping ratio") == "0.02");
  CHECK(value_of(study, "load") == "at A ux, F(t) sin(t)");
  // A bound may be an axis of the study, or swept.
  Scene varied = study;
  varied["scene"]["stops"][0]["upper"] = {0.002, 0.004};
  varied["scene"]["stops"][1]["lower"] = 0;
  varied["parameter"] = {{"pointer", "/scene/stops/1/upper"}, {"from", 0.001}, {"to", 0.003}};
  CHECK(value_of(varied, "stop wall") == "B ux, upper 0.002 and 0.004 m");
  CHECK(value_of(varied, "stop pair") == "A uz, less C uz, lower 0 m, upper from 0.001 to 0.003 m, swept");
  CHECK_THAT(report::scene_svg(varied), Contains("wall 0.002 m"));
}

TEST_CASE("points without places are drawn in a row, each with its stops", "[report]") {
  const Scene study = Scene::parse(R"json({"scene": {
    "structure": {"type": "modal", "modes": "modes.csv", "shapes": "shapes.csv"},
    "stops": [{"name": "plate", "at": {"point": "middle"}, "lower": -1e-3, "upper": 2e-3}],
    "load": [{"at": {"point": "force"}, "force": {"file": "f.csv"}}]},
    "files": {"layout": {"points": ["force", "middle"]}}})json");
  const std::string svg = report::scene_svg(study);
  CHECK(count(svg, "<circle class=\"body\"") == 2);
  CHECK_THAT(svg, Contains(">plate 0.002 m<") && Contains(">middle<") && Contains(">F(t)<"));
  CHECK(value_of(study, "load") == "at point force, F(t) file f.csv");
  Scene none = study;
  none.erase("files");
  CHECK(report::scene_svg(none).empty());
}

namespace {

Scene rods(const std::string& stops) {
  return Scene::parse(R"({"scene": {"bodies": {
    "rod": {"type": "beam", "length": 0.5, "section": {"type": "given", "EI": 14.4, "rhoS": 0.6},
            "supports": [{"name": "a", "x": 0, "type": "pinned"}]},
    "strap": {"type": "beam", "length": 0.25, "section": {"type": "given", "EI": 1, "rhoS": 0.1}},
    "ball": {"type": "oscillator", "mass": 0.1, "stiffness": 3}}, "stops": )" +
                      stops + "}}");
}

// The heights of the lines of beams, from above.
std::vector<double> beam_heights(const std::string& svg) {
  std::vector<double> out;
  const std::string mark = "<line class=\"structure\"";
  for (std::size_t at = svg.find(mark); at != std::string::npos; at = svg.find(mark, at + 1))
    out.push_back(std::stod(svg.substr(svg.find("y1=\"", at) + 4)));
  return out;
}

}  // namespace

TEST_CASE("bodies are drawn by name, above what goes upwards to them, with the stops between them", "[report]") {
  const Scene study = rods(R"([
    {"name": "dimple", "at": {"body": "rod", "x": 0.25}, "to": {"body": "strap", "x": 0.1}, "upper": 1e-4},
    {"name": "wall", "at": {"body": "ball"}, "lower": -0.001}])");
  const std::string svg = report::scene_svg(study);
  for (const char* text : {">rod, 0.5 m<", ">strap, 0.25 m<", ">ball<", ">dimple 0.0001 m<"})
    CHECK_THAT(svg, Contains(text));
  CHECK(count(svg, "stop link") == 1);
  CHECK(count(svg, "<line class=\"stop\"") == 2);
  auto heights = beam_heights(svg);
  REQUIRE(heights.size() == 2);
  CHECK(heights[0] > heights[1]);
  heights = beam_heights(report::scene_svg(rods(R"([
    {"name": "dimple", "at": {"body": "rod", "x": 0.25}, "to": {"body": "strap", "x": 0.1}, "lower": -1e-4}])")));
  CHECK(heights[0] < heights[1]);
  CHECK_THAT(value_of(study, "body rod"), Contains("beam, EI 14.4 N m²") || Contains("beam, L 0.5 m"));
  CHECK(value_of(study, "stop dimple") == "rod x = 0.25 m, less strap x = 0.1 m, upper 0.0001 m");
}

TEST_CASE("a scene of one body is drawn as that structure", "[report]") {
  Scene study = beam(), body = beam();
  const std::string alone = report::scene_svg(study);
  body["scene"]["bodies"]["tube"] = body["scene"]["structure"];
  body["scene"].erase("structure");
  // What differs is the name in its description.
  const std::string svg = report::scene_svg(body);
  CHECK(svg.substr(svg.find('>')) == alone.substr(alone.find('>')));
}

TEST_CASE("a stop between two places of a beam, a direction and a clearance are drawn", "[report]") {
  Scene study = beam();
  study["scene"]["structure"]["planes"] = 2;
  study["scene"]["stops"] = Scene::parse(R"([
    {"name": "span", "at": {"x": 0.5}, "to": {"x": 1}, "upper": 1e-3},
    {"name": "slant", "at": {"x": 1, "direction": [0.6, 0.8]}, "lower": -2e-3},
    {"name": "plate", "at": {"x": 1.2}, "clearance": {"radius": 3e-3, "sides": [8, 16]}}])");
  const std::string svg = report::scene_svg(study);
  CHECK_THAT(svg, Contains(">span 0.001 m<") && Contains(">plate radius 0.003 m<") && Contains(">z<"));
  CHECK(count(svg, "stop link") == 1);
  CHECK(count(svg, "<line class=\"stop\"") == 2);
  CHECK(value_of(study, "stop plate") == "x = 1.2 m, within 0.003 m, sides 8 and 16");
  CHECK(value_of(study, "stop slant") == "x = 1 m along [0.6,0.8], lower −0.002 m");
}

TEST_CASE("a stop whose numbers are lists, with parameters of its own, is told and drawn", "[report]") {
  Scene study = beam();
  study["scene"]["stops"] = Scene::parse(R"([{"name": "bar", "at": {"x": [0.5, 1]}, "lower": 0, "upper": [1e-3, 2e-3],
    "stiffness": [1e5, 1e6], "restitution": 0.5, "moves_with": "clamp"}])");
  CHECK(value_of(study, "stop bar") ==
        "x = 0.5 m, lower 0 m, upper 0.001 and 0.002 m, moves with clamp, stiffness 1e5 and 1e6 N/m, restitution 0.5");
  CHECK(count(report::scene_svg(study), "<line class=\"stop\"") == 2);
}

TEST_CASE("a friction damper is a plate that is pressed, on the ground or on a rod to its other place", "[report]") {
  Scene scene = beam();
  scene["scene"]["stops"] = Scene::parse(R"([{"name": "pad", "at": {"x": 1}, "normal_force": 40, "friction": 0.2}])");
  const std::string grounded = report::scene_svg(scene);
  CHECK(count(grounded, ">pad<") == 1);
  // A rod in, two cheeks, their end, a rod out; then the ground and its hatch.
  CHECK(count(grounded, "class=\"stop\"") == 7);
  scene["scene"]["stops"][0]["to"] = {{"x", 0.5}};
  const std::string between = report::scene_svg(scene);
  CHECK(count(between, ">pad<") == 1);
  CHECK(count(between, "class=\"stop\"") == 6);  // without the ground, with a mark at the other place
  CHECK(count(between, "class=\"stop link\"") == 1);
}
