#include "runners/study/load_study.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <set>

#include "runners/study/case_id.hpp"
#include "runners/study/fields.hpp"
#include "tests/places.hpp"
#include "tests/runners/study/study_fixture.hpp"

using namespace ricochet;
using namespace ricochet::tests;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

namespace {

std::set<std::string> ids(const Study& study) {
  std::set<std::string> all;
  for (const StudyCase& one : study.cases) all.insert(one.id);
  return all;
}

Json axis(const StudyCase& one, const std::string& name) {
  for (const auto& [key, value] : one.axes)
    if (key == name) return value;
  return "absent";
}

// Stops along the whole beam, so that the clamp meets them.
Json clamp_through_stop(const Json& amplitude) {
  Json study = with("/scene/support", {{"amplitude", amplitude}, {"pulsation", 1}});
  study["scene"]["stops"]["at"] = "nodes";
  return study;
}

}  // namespace

TEST_CASE("A study makes every combination of its lists, once") {
  const Study study = parse(small_study());
  CHECK(study.name == "small");
  CHECK(study.cases.size() == 2 * 1 * 2 * 2);
  CHECK(ids(study).size() == study.cases.size());
  CHECK(study.columns == std::vector<std::string>{"mass", "mass.velocity", "contact", "time", "time.beta",
                                                  "time.restitution", "time.order", "elements", "step"});
  const StudyCase& last = study.cases.back();
  CHECK(last.mass.name == "poor");
  CHECK(last.mass.parameters.word("velocity") == "P1");
  CHECK(last.time.parameters.real("beta") == 0.5);
  CHECK(last.time.parameters.integer("order") == 2);
  CHECK(last.step == 1e-4);
  CHECK(last.elements == 10);
  CHECK(last.duration == 0.1);
  CHECK(last.samples == 200);
  for (const StudyCase& one : study.cases) {
    CHECK(one.id.front() == 'c');
    CHECK(is_former_id(one.id.substr(1)));
  }
}

TEST_CASE("Absent keys mean what the format says") {
  const Study study = parse(Json::parse(R"({"name": "bare", "kind": "trajectory",
    "scene": {"structure": {"type": "beam", "length": 1, "section": {"type": "given", "EI": 2, "rhoS": 3}}},
    "mesh": {"elements": 1}, "methods": {"mass": "full", "contact": "rigid", "time": "three-level"}, "step": 1, "duration": 1})"));
  REQUIRE(study.cases.size() == 1);
  const StudyCase& one = study.cases.front();
  CHECK_FALSE(one.scene.stops.lower);
  CHECK_FALSE(one.scene.stops.upper);
  CHECK(one.scene.support.amplitude == 0);
  CHECK(one.scene.support.pulsation == 0);
  CHECK(one.scene.support.phase == 0);
  CHECK(one.scene.load.is_zero());
  CHECK(one.scene.initial.displacement.is_zero());
  CHECK(one.scene.initial.velocity.is_zero());
  CHECK(one.scene.initial.projection == InitialSpec::Projection::none);
  CHECK(one.samples == 200);
  CHECK(study.question.empty());
  const auto& beam = std::get<BeamSpec>(one.scene.structure);
  CHECK(beam.section.EI == 2);
  CHECK(beam.section.rhoS == 3);
  CHECK(beam.damping.stiffness == 0);
}

TEST_CASE("The resolved study is the same study") {
  for (const Json& study : {small_study(), with("/scene/support", {{"amplitude", {0.01, 0.02}}, {"pulsation", 10}}),
                            with("/scene/stops/at", Json::array({"nodes", Json::array({1, 1.5})})),
                            with("/exclude", Json::array({{{"mass", "poor"}, {"step", 1e-4}, {"why", "slow"}}}))}) {
    const Study first = parse(study), second = parse(first.resolved);
    CHECK(second.resolved == first.resolved);
    CHECK(second.columns == first.columns);
    REQUIRE(second.cases.size() == first.cases.size());
    for (std::size_t i = 0; i < first.cases.size(); ++i) {
      CHECK(second.cases[i].id == first.cases[i].id);
      CHECK(second.cases[i].excluded == first.cases[i].excluded);
    }
  }
}

TEST_CASE("Ids depend on what a case is, not on how the study is written") {
  const std::set<std::string> before = ids(parse(small_study()));
  SECTION("order of keys and of lists, spelling of numbers, defaults written out, name") {
    Json other = Json::parse(R"({
      "duration": 1e-1, "step": [0.0001, 0.001], "samples": 200,
      "methods": {"time": {"restitution": 0, "beta": [5e-1, 0.25], "name": "three-level"}, "contact": ["rigid"],
                  "mass": [{"velocity": "P1", "name": "poor"}, "full"]},
      "mesh": {"elements": [1e1]}, "kind": "trajectory", "name": "other", "question": "why?"})");
    other["scene"] = small_study()["scene"];
    other["scene"]["structure"]["density"] = 8e3;
    CHECK(ids(parse(other)) == before);
  }
  SECTION("whatever changes a case changes all ids") {
    for (const auto& [pointer, value] : std::vector<std::pair<std::string, Json>>{{"/duration", 0.2},
                                                                                  {"/samples", 100},
                                                                                  {"/scene/structure/young", 2.1e11},
                                                                                  {"/scene/load", "1"},
                                                                                  {"/mesh/elements", 11}}) {
      const std::set<std::string> after = ids(parse(with(pointer, value)));
      std::vector<std::string> common;
      std::set_intersection(before.begin(), before.end(), after.begin(), after.end(), std::back_inserter(common));
      CHECK(common.empty());
    }
  }
  SECTION("adding a value keeps the others") {
    const std::set<std::string> more = ids(parse(with("/step", {1e-3, 1e-4, 1e-5})));
    CHECK(std::includes(more.begin(), more.end(), before.begin(), before.end()));
  }
}

TEST_CASE("A list in the scene is an axis named by its place") {
  Json study = with("/scene/support", {{"amplitude", {0.01, 0.02, 0.03}}, {"pulsation", 10}});
  study["scene"]["stops"]["lower"] = {nullptr, "-0.1"};
  const Study read = parse(study);
  CHECK(read.cases.size() == 8 * 3 * 2);
  CHECK(std::count(read.columns.begin(), read.columns.end(), "support.amplitude") == 1);
  CHECK(std::count(read.columns.begin(), read.columns.end(), "stops.lower") == 1);
  for (const StudyCase& one : read.cases) {
    CHECK(axis(one, "support.amplitude") == one.scene.support.amplitude);
    CHECK(axis(one, "stops.lower").is_null() == !one.scene.stops.lower.has_value());
    CHECK(one.scene_json["support"]["amplitude"] == one.scene.support.amplitude);
  }
}

TEST_CASE("Positions of stops are one value, words or lists of positions are an axis") {
  const Study one = parse(with("/scene/stops/at", {0.5, 1.5}));
  CHECK(one.cases.size() == 8);
  CHECK(one.cases.front().scene.stops.positions == std::vector<double>{0.5, 1.5});
  const Study two = parse(with("/scene/stops/at", Json::array({"tip", "nodes", Json::array({0.5, 1.5})})));
  CHECK(two.cases.size() == 24);
  CHECK(two.cases.back().scene.stops.place == StopsSpec::Place::positions);
}

TEST_CASE("Excluded cases stay, with their reason") {
  const Study study =
      parse(with("/exclude", Json::array({{{"mass", "poor"}, {"step", 1e-4}, {"why", "slow"}},
                                          {{"time.beta", {0.25, 0.5}}, {"step", 1e-3}, {"why", "coarse"}}})));
  CHECK(study.cases.size() == 8);
  for (const StudyCase& one : study.cases) {
    if (one.step == 1e-3)
      CHECK(one.excluded == "coarse");
    else if (one.mass.name == "poor")
      CHECK(one.excluded == "slow");
    else
      CHECK_FALSE(one.excluded);
  }
}

TEST_CASE("Wrong values are refused with their place, what was expected and the nearest name") {
  struct Wrong {
    Json study;
    std::string start;
    std::vector<std::string> parts;
  };
  const std::vector<Wrong> all = {
      {with("/sttep", 1), "/sttep: unknown key", {"did you mean \"step\""}},
      {with("/scene/structure/lenght", 1), "/scene/structure/lenght: unknown key", {"did you mean \"length\""}},
      {with("/scene/structure/section/EI", 1),
       "/scene/structure/section/EI: unknown key",
       {"\"outer_diameter\", \"wall\""}},
      {without("", "step"), "/step: missing", {"number in ]0, ∞[, in s"}},
      {without("", "scene"), "/scene: missing", {}},
      {without("/scene", "structure"), "/scene/structure: missing", {}},
      {without("/scene/structure", "young"), "/scene/structure/young: missing", {"Pa"}},
      {without("/scene/structure", "section"), "/scene/structure/section: missing", {}},
      {without("/scene/structure", "type"), "/scene/structure/type: missing", {"\"beam\""}},
      {with("/scene/structure/section", {{"tpye", "tube"}}),
       "/scene/structure/section/tpye: unknown key",
       {"did you mean \"type\""}},
      {with("/scene/structure/section/type", "tueb"),
       "/scene/structure/section/type: unknown type \"tueb\"",
       {"\"circle\"", "did you mean \"tube\""}},
      {with("/scene/structure/section/type", 3), "/scene/structure/section/type: expected one of", {"found 3"}},
      {with("/scene/structure/section", 3), "/scene/structure/section: expected an object", {"found 3"}},
      {with("/kind", "resonance"), "/kind: unknown kind \"resonance\"", {"there is: \"trajectory\""}},
      {with("/kind", "trajectroy"), "/kind: unknown kind", {"did you mean \"trajectory\""}},
      {with("/name", "a/b"), "/name: expected a name", {"a/b"}},
      {with("/name", ".."), "/name: expected a name", {}},
      {with("/name", 3), "/name: expected a text", {"found 3"}},
      {with("/scene/structure/length", -1.5),
       "/scene/structure/length: expected a number in ]0, ∞[, in m",
       {"found -1.5"}},
      {with("/scene/structure/length", "1.5"), "/scene/structure/length: expected a number", {"found \"1.5\""}},
      {with("/scene/structure/length", true), "/scene/structure/length: expected a number", {"found true"}},
      {with("/scene/structure/length", nullptr), "/scene/structure/length: expected a number", {"found null"}},
      {with("/scene/structure/length", {1.5, 0}), "/scene/structure/length/1: expected a number", {"found 0"}},
      {with("/scene/structure/length", Json::array()), "/scene/structure/length: an empty list", {}},
      {with("/scene/structure/length", {1.5, 1.5}),
       "/scene/structure/length/1: repeats the value",
       {"/scene/structure/length/0"}},
      {with("/scene/structure/section/wall", 0.006), "/scene/structure/section/wall: ", {"0.005"}},
      {with("/scene/structure/section/wall", {0.0005, 0.006}), "/scene/structure/section/wall/1: ", {}},
      {with("/scene/stops/at", "node"), "/scene/stops/at: expected \"nodes\"", {"did you mean \"nodes\""}},
      {with("/scene/stops/at", {0.5, 1.6}), "/scene/stops/at/1: ", {"1.6"}},
      {with("/scene/stops/at", {0.5, "a"}), "/scene/stops/at/0: ", {}},
      {with("/scene/stops/at", Json::array()), "/scene/stops/at: an empty list", {}},
      {with("/scene/stops/lower", true),
       "/scene/stops/lower: expected a number or a formula in x or null",
       {"found true"}},
      {with("/scene/stops/lower", 0.2), "/scene/stops/", {}},
      {with("/scene/stops/lower", {-0.1, 0.2}), "/scene/stops/lower/1: ", {}},
      {with("/scene/stops/lower", "-0.1*("), "/scene/stops/lower: ", {"-0.1*("}},
      {with("/scene/stops/lower", "-0.1*t"), "/scene/stops/lower: ", {"t"}},
      {with("/scene/load", nullptr), "/scene/load: expected a number or a formula in x and t", {"N/m"}},
      {with("/scene/initial/displacement", "0.2*x"), "/scene/initial/displacement: ", {}},
      {with("/scene/initial/velocity", {"0", "1/0*x"}), "/scene/initial/velocity/1: ", {}},
      {with("/scene/initial/projection", "constrain"),
       "/scene/initial/projection: expected one of",
       {"did you mean \"constraint\""}},
      {clamp_through_stop(0.5), "/scene/support/amplitude: ", {}},
      {clamp_through_stop({0.01, 0.5}), "/scene/support/amplitude/1: ", {}},
      {with("/scene/support", {{"amplitude", 0.5}}), "/scene/support/pulsation: missing", {}},
      {with("/mesh/elements", 0), "/mesh/elements: expected a whole number in [1, ", {"found 0"}},
      {with("/mesh/elements", 2.5), "/mesh/elements: expected a whole number", {"found 2.5"}},
      {with("/step", 0), "/step: expected a number in ]0, ∞[", {"found 0"}},
      {with("/step", {1e-3, -1e-3}), "/step/1: expected a number in ]0, ∞[", {}},
      {with("/step", 0.2), "/step: a step of 0.2 s is longer than the duration of 0.1 s", {}},
      {with("/step", 1e-300), "/step: ", {"steps"}},
      {with("/duration", 0), "/duration: expected a number in ]0, ∞[", {}},
      {with("/duration", {0.1, 0.2}), "/duration: ", {"a list is not possible here"}},
      {with("/samples", 1), "/samples: expected a whole number", {}},
      {with("/methods/mass", Json::array()), "/methods/mass: an empty list", {}},
      {with("/methods/mass", "ful"),
       "/methods/mass: no plugin provides the mass strategy \"ful\"",
       {"did you mean \"full\""}},
      {with("/methods/mass", Json::array({"full", {{"name", "por"}}})),
       "/methods/mass/1/name: no plugin provides",
       {"did you mean \"poor\""}},
      {with("/methods/mass", 3), "/methods/mass: expected the name of a method", {"found 3"}},
      {with("/methods/mass", {{"nam", "full"}}), "/methods/mass/nam: unknown key", {"did you mean \"name\""}},
      {with("/methods/mass", {{"velocity", "P1"}}), "/methods/mass/name: missing", {}},
      {with("/methods/mass", {{"name", {"full", "poor"}}}), "/methods/mass/name: expected the name of one method", {}},
      {with("/methods/mass", Json::array({"full", {{"name", "full"}}})),
       "/methods/mass/1: gives the same mass method as /methods/mass/0",
       {}},
      {with("/methods/mass", Json::array({"poor", {{"name", "poor"}, {"velocity", {"P0", "P1"}}}})),
       "/methods/mass/1/velocity/1: gives the same mass method as /methods/mass/0",
       {"mass.velocity = \"P1\""}},
      {with("/methods/contact", "spring"), "/methods/contact/stiffness: missing", {"N/m"}},
      {with("/methods/contact", {{"name", "spring"}, {"stifness", 1}}),
       "/methods/contact/stifness: unknown key",
       {"did you mean \"stiffness\""}},
      {with("/methods/contact", {{"name", "spring"}, {"stiffness", {1, 0}}}),
       "/methods/contact/stiffness/1: expected a number in ]0, ∞[, in N/m",
       {}},
      {with("/methods/time", {{"name", "three-level"}, {"beta", 1.5}}),
       "/methods/time/beta: expected a number in [0, 1]",
       {"found 1.5"}},
      {with("/methods/time", {{"name", "three-level"}, {"order", 1.5}}),
       "/methods/time/order: expected a whole number in [1, 4]",
       {"found 1.5"}},
      {with("/exclude", 3), "/exclude: expected a list", {}},
      {with("/exclude", {3}), "/exclude/0: expected an object", {}},
      {with("/exclude", Json::array({{{"step", 1e-3}}})), "/exclude/0/why: missing", {}},
      {with("/exclude", Json::array({{{"step", 1e-3}, {"why", " "}}})), "/exclude/0/why: expected the reason", {}},
      {with("/exclude", Json::array({{{"why", "all"}}})), "/exclude/0: names no axis", {}},
      {with("/exclude", Json::array({{{"stpe", 1e-3}, {"why", "x"}}})),
       "/exclude/0/stpe: \"stpe\" is no axis",
       {"did you mean \"step\""}},
      {with("/exclude", Json::array({{{"step", 1e-5}, {"why", "x"}}})),
       "/exclude/0/step: no case has step = 1e-05",
       {"0.001, 0.0001"}},
      {with("/exclude", Json::array({{{"mass", "por"}, {"why", "x"}}})),
       "/exclude/0/mass: no case has",
       {"did you mean \"poor\""}},
      {with("/exclude", Json::array({{{"mass", "full"}, {"mass.velocity", "P1"}, {"why", "x"}}})),
       "/exclude/0: no case has all",
       {}},
      {with("/exclude", Json::array({{{"contact", "rigid"}, {"why", "x"}}})), "/exclude: every case is excluded", {}},
      {Json(3), ": expected an object, found 3", {}},
      {Json::array(), ": expected an object", {}},
  };
  for (const Wrong& wrong : all) {
    INFO(wrong.study.dump(1));
    const std::string message = refusal(wrong.study);
    CHECK_THAT(message, StartsWith(wrong.start));
    for (const std::string& part : wrong.parts) CHECK_THAT(message, Contains(part));
  }
}

TEST_CASE("Too many combinations are refused with their number, before they are made") {
  Json steps = Json::array(), amplitudes = Json::array();
  for (int i = 1; i <= 500; ++i) {
    steps.push_back(1e-6 * i);
    amplitudes.push_back(1e-5 * i);
  }
  Json study = with("/scene/support", {{"amplitude", amplitudes}, {"pulsation", 10}});
  study["step"] = steps;
  CHECK_THAT(refusal(study), Contains("1000000 combinations") && Contains("at most 200000"));
  // Where the longest list stands, whatever it is in.
  CHECK_THAT(refusal(study), Catch::Matchers::StartsWith("/scene/support/amplitude: "));
  study["step"].push_back(1e-3);
  CHECK_THAT(refusal(study), Catch::Matchers::StartsWith("/step: "));
}

TEST_CASE("Every shipped study parses with the plugins of this build") {
  int count = 0;
  for (const auto& item : std::filesystem::directory_iterator(places().source + "/studies")) {
    if (item.path().extension() != ".json") continue;
    INFO(item.path().string());
    Catalogue catalogue(places().plugins, {}, {});
    Registry registry;
    const Study study = load_study(item.path(), catalogue, registry);
    CHECK(study.name == item.path().stem().string());
    CHECK_FALSE(study.question.empty());
    // One grid of cells is a study; of others at least two are compared.
    CHECK(study.cases.size() > (study.kind == "basins" ? 0 : 1));
    // Only the libraries that the study names are open: one of each role.
    // A kind may have cases of references beside those of methods.
    bool solved = false;
    for (const StudyCase& one : study.cases)
      for (const MethodChoice& reference : one.references) solved = solved || reference.name != marched_reference;
    std::size_t roles = 3;
    if (solved) ++roles;
    if (!study.cases.front().friction.name.empty()) ++roles;
    CHECK(catalogue.opened().size() == roles);
    ++count;
  }
  CHECK(count >= 6);
}

TEST_CASE("A load is a formula, or a list of forces at points and of shapes with a history") {
  const auto load = [](const Json& value) { return parse(with("/scene/load", value)); };
  const Study listed = load(Json::parse(R"([{"at": 1.2, "force": "-3*t^2"}, {"shape": "x^2", "time": 2}])"));
  REQUIRE(listed.cases.size() == parse(small_study()).cases.size());
  const LoadSpec& read = listed.cases.front().scene.load;
  REQUIRE(read.terms.size() == 2);
  CHECK(read.terms[0].force);
  CHECK(read.terms[0].at == 1.2);
  CHECK(read.terms[0].history(0, 1) == -3);
  CHECK_FALSE(read.terms[1].force);
  CHECK(read.spread(3, 0) == 18 + read.terms[0].history(0, 0));
  CHECK(read.uses_t());
  // A list that holds anything but objects is an axis, of which such a list may be a value.
  const Study axis = load(Json::parse(R"(["0", [{"at": 1, "force": 5}]])"));
  CHECK(axis.cases.size() == 2 * listed.cases.size());
  CHECK(axis.cases.back().scene.load.terms.size() == 1);

  const auto refused = [&](const char* text) -> std::string {
    return testing::input_error([&] { load(Json::parse(text)); });
  };
  CHECK_THAT(refused(R"([{"at": 1, "force": 1}, {"at": 2, "force": 1}])"),
             StartsWith("/scene/load/1/at: ") && Contains("beyond the beam"));
  CHECK_THAT(refused(R"([{"force": 1}])"), StartsWith("/scene/load/0/at: missing"));
  CHECK_THAT(refused(R"([{"at": 1, "force": "x"}])"), StartsWith("/scene/load/0/force: ") && Contains("\"x\""));
  CHECK_THAT(refused(R"([{"at": 1, "forse": 1}])"), Contains("did you mean \"force\"?"));
  CHECK_THAT(refused(R"([{"at": 1, "force": 1, "shape": "x"}])"), Contains("does not go together with"));
  CHECK_THAT(refused(R"({"at": 1, "force": 1})"), StartsWith("/scene/load: ") && Contains("or a list of objects"));
  CHECK_THAT(refused("[]"), StartsWith("/scene/load: "));
}

TEST_CASE("Modes that a structure does not have, and a residual of no modes, are refused with their place") {
  Json study = small_study();
  const auto fault = [&]() -> std::string { return testing::input_error([&] { parse(study); }, ""); };
  study["mesh"] = {{"elements", {4, 8}}, {"modes", {3, 9, nullptr}}};
  CHECK(fault() == "/mesh/modes/1: 9 modes; the structure has 8 degrees of freedom on 4 elements");
  study["mesh"]["modes"] = {3, 8};
  CHECK(fault().empty());
  study["mesh"].erase("modes");
  study["mesh"]["residual"] = "none";
  CHECK(fault().starts_with("/mesh/residual: there is no mesh.modes"));
}
