// What is refused of a study of kind `continuation`, and in which words.
#include "runners/kinds/continuation/continuation_study.hpp"

#include <algorithm>

#include "runners/kinds/stored_study.hpp"
#include "runners/run/run_study.hpp"
#include "tests/places.hpp"
#include "tests/runners/kinds/continuation/tube_study.hpp"
#include "tests/runners/scratch_folder.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

Json with(const std::string& pointer, Json value) {
  Json study = tube_continuation();
  study[Json::json_pointer(pointer)] = std::move(value);
  return study;
}

void check_says(const std::string& said, const std::vector<std::string>& parts) {
  INFO(said);
  for (const std::string& part : parts) CHECK(said.find(part) != std::string::npos);
}

}  // namespace

TEST_CASE("keys of continuation are refused by pointer, with what was found and expected") {
  check_says(error_of(with("/parameter/from", 0.1)), {"/parameter/from: ", "0.1 to 0.09", "from < to"});
  check_says(error_of(with("/orbits", Json::array())), {"/orbits: an empty list"});
  check_says(error_of(with("/orbits/0/at", 0.2)), {"/orbits/0/at: ", "0.2", "0.07 to 0.09"});
  check_says(error_of(with("/orbits/0/frm", "rest")), {"/orbits/0/frm: unknown key", "did you mean \"from\""});
  check_says(error_of(with("/orbits/0/from", "res")), {"/orbits/0/from: expected one of", "did you mean \"rest\""});
  check_says(error_of(with("/follow", "peices")), {"/follow: ", "did you mean \"pieces\""});
  check_says(error_of(with("/stop_at", "fol")), {"/stop_at: ", "did you mean \"fold\""});
  const std::string prominence = error_of(with("/prominence", -1));
  check_says(prominence, {"/prominence: expected a number in ]0, ", "found -1"});
  CHECK(prominence.find("in as the") == std::string::npos);
  check_says(error_of(with("/mark", {{"parameter", {0.5}}})), {"/mark/parameter/0: ", "0.5", "0.07 to 0.09"});
  Json twice = with("/orbits/0/symmetric", "yes");
  twice["orbits"][0]["period"] = 2;
  check_says(error_of(twice), {"/orbits/0/symmetric: an orbit of 2 periods", "odd"});
  twice["orbits"][0]["symmetric"] = true;
  check_says(error_of(twice), {"/orbits/0/symmetric: an orbit of 2 periods", "odd"});
  check_says(error_of(with("/orbits/0/symmetric", 1)),
             {"/orbits/0/symmetric: expected true, false or one of \"auto\"", "found 1"});
}

TEST_CASE("continuation follows real numbers of the scene or of a method alone") {
  check_says(error_of(with("/parameter/pointer", "/mesh/elements")),
             {"/parameter/pointer: continuation follows a real number", "/mesh/elements is part of the mesh"});
  check_says(error_of(with("/parameter/pointer", "/steps_per_period")), {"/parameter/pointer: ", "is a count"});
  check_says(error_of(with("/parameter/pointer", "/scene/structure/type")), {"is the word \"beam\""});
  check_says(error_of(with("/parameter/pointer", "/methods/mass/velocity")), {"is the word \"P1\""});
  check_says(error_of(with("/parameter/pointer", "/scene/support/amplitde")),
             {"/parameter/pointer: ", "did you mean", "/scene/support/amplitude"});
}

TEST_CASE("no orbit depends on where motions begin, so none is followed along it") {
  check_says(error_of(with("/parameter/pointer", "/scene/initial/displacement")),
             {"/parameter/pointer: /scene/initial/displacement is where motions begin", "expected a number"});
}

TEST_CASE("a scene without a forcing period has no orbits") {
  check_says(
      error_of(with("/scene/support/pulsation", 0)),
      {"/scene/support/pulsation: no forcing has a period (the pulsation is 0)", "the period of a motion or a table"});
  // Where it is a force that repeats not, its key is named.
  Json study = tube_continuation();
  study["scene"] = Json::parse(R"json({
    "structure": {"type": "oscillator", "mass": 1, "stiffness": 1, "force": {"amplitude": 1, "pulsation": 0}},
    "stops": {"lower": -0.3, "upper": 0.2, "at": "tip"}})json");
  study["parameter"] = Json::parse(R"({"pointer": "/scene/stops/upper", "from": 0.1, "to": 0.2})");
  study["orbits"] = Json::parse(R"([{"at": 0.15, "periods": 30}])");
  study.erase("mesh");
  check_says(error_of(study), {"/scene/structure/force/pulsation: no forcing has a period"});
}

TEST_CASE("a load of another period is an error") {
  const auto load = [](const std::string& force) { return with("/scene/load", {{{"at", 1.0}, {"force", force}}}); };
  check_says(error_of(load("sin(7.3*t)")), {"/scene/load/0/force: the load \"sin(7.3*t)\" does not repeat"});
  CHECK(error_of(load("sin(20*t)")) == "no error");
}

TEST_CASE("several bodies are followed, and need a forcing period as well") {
  Json study = tube_continuation();
  study["scene"] = Json::parse(R"json({
    "bodies": {"rod": {"type": "beam", "length": 0.5, "section": {"type": "given", "EI": 14.4, "rhoS": 0.6},
                       "damping": {"stiffness": 2e-5, "mass": 4}},
               "mass": {"type": "oscillator", "mass": 0.1, "stiffness": 1000, "damping": 1}},
    "stops": [{"name": "gap", "at": {"body": "rod", "x": 0.5}, "to": {"body": "mass"}, "upper": 1e-3}],
    "load": [{"at": {"body": "rod", "x": 0.5}, "force": "0.1*sin(30*t)"}],
    "support": {"amplitude": 0, "pulsation": 30}})json");
  study["mesh"] = Json::parse(R"({"elements": {"rod": 4}})");
  study["parameter"] = Json::parse(R"({"pointer": "/scene/stops/0/upper", "from": 1e-3, "to": 2e-3})");
  study["orbits"] = Json::parse(R"([{"at": 1.5e-3, "periods": 30}])");
  CHECK(error_of(study) == "no error");
  CHECK(continued(study).status == Status::done);
  study["scene"]["support"]["pulsation"] = 0;
  CHECK(error_of(study) == "no error");  // the load has waves
  study["scene"]["load"][0]["force"] = 0.1;
  check_says(error_of(study), {"no forcing has a period"});
}

TEST_CASE("a mass that the step does not resolve at its stop refuses the case") {
  Json study = tube_continuation();
  study["methods"] = Json::parse(R"({"mass": "consistent", "contact": "signorini",
                                     "time": {"name": "moreau-jean"}})");
  check_says(refusal_of(study), {"stops are met at whole steps by a mass", "Use a position-level scheme"});
  study["methods"]["time"] = Json::parse(R"({"name": "newmark-dumont-paoli", "restitution": 0.5})");
  check_says(refusal_of(study), {"stops are met at whole steps by a mass"});
  // Position-level stops without restitution are a projection, whatever the mass.
  study["methods"]["time"] = Json::parse(R"({"name": "newmark-dumont-paoli", "restitution": 0})");
  CHECK(refusal_of(study).empty());
  // Nor is a point without mass thrown back.
  study["methods"] = Json::parse(R"({"mass": "singular", "contact": "signorini",
                                     "time": {"name": "newmark-dumont-paoli", "restitution": 0.5}})");
  study["follow"] = "pieces";
  CHECK(refusal_of(study).empty());
}

TEST_CASE("a law that keeps a memory refuses the case") {
  const Json law = Json::parse(R"({"name": "lankarani-nikravesh", "stiffness": 1e6, "restitution": 0.8})");
  check_says(refusal_of(with("/methods/contact", law)), {"a law that keeps a memory has no derivative of it"});
}

TEST_CASE("a step without tangents refuses the case, and a motion that does not repeat makes no orbit") {
  Json study = Json::parse(R"({
    "name": "rebound", "kind": "continuation",
    "scene": {"structure": {"type": "oscillator", "mass": 1, "stiffness": 1, "damping": 0.04,
                            "force": {"amplitude": 1, "pulsation": 1.3}},
              "stops": {"upper": 0.5, "at": "tip"}},
    "methods": {"mass": "consistent", "contact": "signorini", "time": "laursen-love"},
    "steps_per_period": 400,
    "parameter": {"pointer": "/scene/structure/force/amplitude", "from": 0.9, "to": 1.1},
    "orbits": [{"at": 1, "periods": 400}]})");
  check_says(refusal_of(study), {"which has no tangents here"});
  study["methods"]["time"] = "kane";
  CHECK(refusal_of(study).empty());
  const CaseRecord record = continued(study);
  CHECK(record.status == Status::failed);
  check_says(record.reason(), {"no orbit at λ = 1: the scheme's own march leaves what was solved by "});
}

TEST_CASE("a restitution that stops have of their own counts where the scheme has none") {
  Json study = Json::parse(R"({
    "name": "rebound", "kind": "continuation",
    "scene": {"structure": {"type": "oscillator", "mass": 1, "stiffness": 1, "damping": 0.04,
                            "force": {"amplitude": 1, "pulsation": 1.3}},
              "stops": [{"name": "wall", "at": {"x": 0}, "upper": 0.5, "restitution": 0.6}]},
    "methods": {"mass": "consistent", "contact": "signorini", "time": "moreau-jean"},
    "steps_per_period": 400, "follow": "pieces",
    "parameter": {"pointer": "/scene/structure/force/amplitude", "from": 0.9, "to": 1.1},
    "orbits": [{"at": 1, "periods": 40}]})");
  check_says(refusal_of(study), {"the stops give back 0.6 of the speed"});
  study["follow"] = "steps";
  CHECK(refusal_of(study).empty());
}

TEST_CASE("pieces are refused of a parameter that is not affine, and of a law that is not linear") {
  Json study = with("/parameter", Json::parse(R"({"pointer": "/scene/support/pulsation", "from": 9, "to": 11})"));
  study["orbits"][0]["at"] = 10;
  study["follow"] = "pieces";
  check_says(refusal_of(study), {"/scene/support/pulsation does not enter linearly", "follow with steps"});
  Json hertz = tube_continuation();
  hertz["methods"]["contact"] = Json::parse(R"({"name": "hertz", "stiffness": 1e7})");
  CHECK(refusal_of(hertz).empty());
  hertz["follow"] = "pieces";
  check_says(refusal_of(hertz), {"its law is not linear", "follow with steps"});
}

TEST_CASE("an orbit that is asked to be its own image is refused on another scene") {
  Json study = with("/scene/stops/lower", -0.09);
  study["orbits"][0]["symmetric"] = "yes";
  check_says(refusal_of(study), {"the scene is not its own image: lower and upper stops differ by 0.01 m"});
  study["orbits"][0]["symmetric"] = true;
  check_says(refusal_of(study), {"the scene is not its own image: lower and upper stops differ by 0.01 m"});
  study["orbits"][0]["symmetric"] = false;
  CHECK(refusal_of(study).empty());
  Json odd = with("/steps_per_period", 201);
  CHECK(refusal_of(odd).empty());
  odd["orbits"][0]["symmetric"] = true;
  check_says(refusal_of(odd), {"the scene is not its own image: 201 steps per period are an odd number"});
}

TEST_CASE("a branch ends where the scene becomes impossible, and says why") {
  Json study = with("/parameter", Json::parse(R"({"pointer": "/methods/time/beta", "from": 0.48, "to": 0.6})"));
  study["orbits"][0]["at"] = 0.49;
  study["both_ways"] = false;
  CHECK(refusal_of(study).empty());
  const auto points = points_of(continued(study));
  REQUIRE_FALSE(points.empty());
  CHECK(*points.back().parameter == Approx(0.5).margin(1e-9));
  check_says(points.back().note, {"the range ends at 0.5", "at 0.6: "});
  // The other end is that of the study.
  study["both_ways"] = true;
  CHECK(points_of(continued(study)).back().note == "the range ends at 0.48");
  // Beyond 0.1 m the clamp goes through the stops.
  study = with("/scene/stops/at", "nodes");
  study["parameter"]["to"] = 0.12;
  study["follow"] = "pieces";
  CHECK(refusal_of(study).empty());
}

TEST_CASE("a root of the step on displacements without mass refuses the case") {
  Json study = tube_continuation();
  const std::vector<std::string> says = {"a root of modulus 1 on displacements without mass", "no orbit stands alone"};
  study["methods"]["time"]["beta"] = 0.25;
  check_says(refusal_of(study), says);
  // Without damping of the stiffness β = ½ has the roots ±i there: i²⁰⁰ = 1, i²⁰² = −1.
  study = with("/scene/structure/damping", {{"mass", 2}});
  CHECK(refusal_of(study).empty());
  study["scene"]["stops"]["lower"] = nullptr;
  check_says(refusal_of(study), says);
  study["steps_per_period"] = 202;
  CHECK(refusal_of(study).empty());
}

// Points of a bifurcation study beneath branches: which folders are refused, and what is read of the others.
namespace {

// The tube at two amplitudes, marched from rest.
void march_tube(const std::filesystem::path& folder, const Json& change = Json::object()) {
  Json study = tube_continuation();
  for (const char* key : {"orbits", "switch"}) study.erase(key);
  study["kind"] = "bifurcation";
  study["parameter"] = {{"pointer", "/scene/support/amplitude"}, {"values", {0.02, 0.085}}};
  study["transient"] = {{"periods", 5}};
  study["keep"] = 16;
  study["exponents"] = 0;
  study.merge_patch(change);
  static Catalogue catalogue(tests::places().plugins, {}, {});
  Registry registry;
  run_study(parse_study(study.dump(), catalogue, registry), catalogue, registry, {folder, 1, false});
}

}  // namespace

TEST_CASE("points beneath branches are those of the strobe of the same scene") {
  const ScratchFolder folder;
  march_tube(folder / "tube");
  Json study = tube_continuation();
  study["beneath"] = (folder / "tube").string();
  const OpenedContinuation opened = opened_continuation(study);
  // The folder has no part in what the cases compute.
  CHECK(opened.study.cases.front().id == opened_continuation(tube_continuation()).study.cases.front().id);
  const PointsBeneath all = points_beneath(opened.study.resolved, 1000);
  REQUIRE(all.tip.size() == all.stored);
  REQUIRE(all.stored >= 2);
  for (const double value : {0.02, 0.085})
    CHECK(std::find(all.parameter.begin(), all.parameter.end(), value) != all.parameter.end());
  CHECK(points_beneath(opened.study.resolved, 1).tip.size() == 1);
}

TEST_CASE("points of another scene, parameter or section are not drawn beneath branches") {
  const ScratchFolder folder;
  Json study = tube_continuation();
  const auto said = [&](const std::string& name, const Json& change) {
    march_tube(folder / name, change);
    study["beneath"] = (folder / name).string();
    return error_of(study);
  };
  const auto holds = [](const std::string& text, const std::string& part) { return text.find(part) != text.npos; };
  CHECK(holds(said("gap", {{"scene", {{"stops", {{"upper", 0.11}}}}}}), "/beneath: "));
  CHECK(holds(error_of(study), "has another scene: /scene/stops/upper differs"));
  CHECK(holds(said("pulsation", {{"parameter", {{"pointer", "/scene/support/pulsation"}, {"values", {9, 10}}}}}),
              "goes along /scene/support/pulsation; expected /scene/support/amplitude"));
  CHECK(holds(said("phase", {{"phase", 1.5}}), "another section, strobe at phase 1.5; expected strobe at phase 0"));
  study["beneath"] = (folder / "nowhere").string();
  CHECK(holds(error_of(study), "/beneath: "));
}

TEST_CASE("cases are computed again without the points beneath them") {
  StudyResults results;
  results.study = opened_continuation(tube_continuation()).study.resolved;
  results.study["beneath"] = "nowhere";
  CHECK(StoredStudy(results, {}).study.cases.size() == 1);
}
