#include <catch2/catch.hpp>
#include <set>

#include "runners/kinds/sweep/sweep.hpp"
#include "runners/kinds/sweep/with_parameter.hpp"
#include "runners/store/fingerprint.hpp"
#include "tests/runners/study/study_fixture.hpp"

using namespace ricochet;
using namespace ricochet::tests;

namespace sweep_study_tests {
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

namespace {

Json changed(Json study, const std::string& pointer, const Json& value) {
  study[Json::json_pointer(pointer)] = value;
  return study;
}
Json sweep_with(const std::string& pointer, const Json& value) {
  return changed(small_sweep(), pointer, value);
}
Json basins_with(const std::string& pointer, const Json& value) {
  return changed(small_basins(), pointer, value);
}

Json range(const Json& from, const Json& to, const Json& count) {
  return {{"pointer", "/scene/support/amplitude"}, {"from", from}, {"to", to}, {"count", count}};
}
Json values(const Json& list) {
  return {{"pointer", "/scene/support/amplitude"}, {"values", list}};
}
std::vector<double> values_of(const Json& parameter) {
  return parameter_values(parse(sweep_with("/parameter", parameter)).cases.front().settings);
}

Json spring_sweep() {
  Json study = small_sweep();
  study["methods"]["contact"] = Json::array({"rigid", {{"name", "spring"}, {"stiffness", 1000}}});
  study["parameter"] = {{"pointer", "/methods/contact/stiffness"}, {"values", {10, 100}}};
  return study;
}

// Where the refusal points, and what it says.
struct Wrong {
  Json study;
  std::string start;
  std::vector<std::string> parts;
};

void check_refused(const std::vector<Wrong>& all) {
  for (const Wrong& wrong : all) {
    INFO(wrong.study.dump(1));
    const std::string message = refusal(wrong.study);
    CHECK_THAT(message, StartsWith(wrong.start));
    for (const std::string& part : wrong.parts) CHECK_THAT(message, Contains(part));
  }
}

}  // namespace

TEST_CASE("A diagram is one case per combination of axes, with complete settings") {
  const Study study = parse(small_sweep());
  CHECK(study.cases.size() == 2 * 2 * 2);
  CHECK(study.columns == std::vector<std::string>{"mass", "mass.velocity", "contact", "time", "time.beta",
                                                  "time.restitution", "time.order", "elements", "steps_per_period"});
  std::set<std::string> ids;
  for (const StudyCase& one : study.cases) {
    ids.insert(one.id);
    CHECK(one.step == 0);
    CHECK(one.duration == 0);
    CHECK(one.samples == 0);
    CHECK(one.axes.back() == std::pair<std::string, Json>("steps_per_period", one.steps_per_period));
    CHECK(one.settings.dump() ==
          R"({"parameter":{"pointer":"/scene/support/amplitude","values":[0.07,0.08,0.09]},)"
          R"("start":["rest","up","down",{"random":3,"seed":7}],"transient":{"periods":300,"at_most":2000},)"
          R"("keep":300,"section":"strobe","phase":0.0,"exponents":0,"refine":null})");
  }
  CHECK(ids.size() == study.cases.size());
  CHECK(study.cases.front().steps_per_period == 2000);
  CHECK(study.cases.back().steps_per_period == 8000);
}

TEST_CASE("A grid of basins has its own settings") {
  Json study = small_basins();
  study["refine"] = true;
  study["budget"] = 60;
  CHECK(parse(study).cases.front().settings.dump() ==
        R"({"axes":[{"pointer":"/scene/initial/displacement","values":[-1.0,-0.5,0.0,0.5,1.0]},)"
        R"({"pointer":"/scene/initial/velocity","values":[-2.0,-0.666666666667,0.666666666667,2.0]}],)"
        R"("transient":{"periods":300,"at_most":2000},"keep":300,"section":"strobe","phase":0.0,"exponents":0,)"
        R"("refine":true,"budget":60.0})");
}

TEST_CASE("A resolved sweep is the same sweep") {
  for (const Json& study : {small_sweep(), small_basins(), spring_sweep(), sweep_with("/parameter", values(0.08)),
                            sweep_with("/start", "up"), sweep_with("/start", {{"random", 2}})}) {
    const Study first = parse(study), second = parse(first.resolved);
    CHECK(second.resolved == first.resolved);
    REQUIRE(second.cases.size() == first.cases.size());
    for (std::size_t i = 0; i < first.cases.size(); ++i) {
      CHECK(second.cases[i].id == first.cases[i].id);
      CHECK(second.cases[i].settings == first.cases[i].settings);
      CHECK(second.cases[i].excluded == first.cases[i].excluded);
    }
  }
}

TEST_CASE("Values ascend, ends are exact, and decimals stay decimals") {
  CHECK(values_of(values({0.09, 0.07, 0.08})) == std::vector<double>{0.07, 0.08, 0.09});
  CHECK(values_of(values(0.07)) == std::vector<double>{0.07});
  // 0.07 + 7·0.001 is 0.07700000000000001 in doubles.
  CHECK(values_of(range(0.07, 0.1, 31))[7] == 0.077);
  CHECK(values_of(range(-0.05, 0.1, 31))[10] == 0);
  const std::vector<double> thirds = values_of(range(0, 1.0 / 3, 4));
  CHECK(thirds.back() == 1.0 / 3);
  CHECK(thirds[1] == Approx(1.0 / 9).epsilon(1e-12));
  // Narrower than twelve digits: the values stay apart.
  const std::vector<double> narrow = values_of(range(0.08, 0.08 + 1e-14, 5));
  CHECK(std::is_sorted(narrow.begin(), narrow.end(), std::less_equal<>()));
  const std::vector<double> many = values_of(range(0.07, 0.0999, 500));
  CHECK(many.size() == 500);
  CHECK(std::adjacent_find(many.begin(), many.end(), std::greater_equal<>()) == many.end());
}

TEST_CASE("A case of a sweep is told by everything it does, and by nothing else") {
  const auto id = [](const Json& study) { return parse(study).cases.front().id; };
  const std::string before = id(small_sweep());
  for (const auto& [pointer, value] : std::vector<std::pair<std::string, Json>>{{"/parameter/count", 5},
                                                                                {"/start", {"rest"}},
                                                                                {"/start/3/seed", 8},
                                                                                {"/transient", {{"periods", 301}}},
                                                                                {"/transient", {{"at_most", 2001}}},
                                                                                {"/keep", 301},
                                                                                {"/section", "impact"},
                                                                                {"/phase", 0.5},
                                                                                {"/exponents", 1},
                                                                                {"/refine", 1e-4},
                                                                                {"/steps_per_period", {2001}},
                                                                                {"/budget", 10}}) {
    INFO(pointer);
    const Study other = parse(sweep_with(pointer, value));
    CHECK(other.cases.front().id != before);
    Fingerprints fingerprints("bifurcation", "p");
    StudyCase same_id = other.cases.front();
    same_id.id = before;
    CHECK(fingerprints.of(same_id, {}) != fingerprints.of(parse(small_sweep()).cases.front(), {}));
  }
  CHECK(id(sweep_with("/parameter", values({0.09, 0.08, 0.07}))) == before);
  CHECK(id(sweep_with("/refine", nullptr)) == before);
  CHECK(id(sweep_with("/name", "other")) == before);
  // Where the parameter takes its own values, what the study says there has no part in the case.
  Json other = spring_sweep();
  other["methods"]["contact"][1]["stiffness"] = 5;
  CHECK(parse(other).cases.back().id == parse(spring_sweep()).cases.back().id);
}

TEST_CASE("Bad sweeps are refused with their place, what was expected and the nearest name") {
  const auto pointer = [](const std::string& to) { return sweep_with("/parameter/pointer", to); };
  Json list = small_sweep();
  list["scene"]["support"]["amplitude"] = {0.07, 0.08};
  Json methods_list = spring_sweep();
  methods_list["methods"]["contact"][1]["stiffness"] = {10, 100};
  Json no_stop = pointer("/scene/stops/lower");
  no_stop["scene"]["stops"]["lower"] = nullptr;
  Json still = small_sweep();
  still["scene"]["support"]["pulsation"] = 0;
  Json unforced = pointer("/scene/structure/damping/stiffness");
  unforced["scene"]["support"]["amplitude"] = 0;
  Json aperiodic = small_sweep();
  aperiodic["scene"]["load"] = "exp(-t)";
  Json impossible = sweep_with("/parameter", range(0.2, 0.3, 3));
  impossible["scene"]["stops"]["at"] = "nodes";
  Json initial = pointer("/scene/initial/velocity");
  Json stepped = small_sweep();
  stepped["step"] = 1e-4;
  Json excluded = spring_sweep();
  excluded["exclude"] = Json::array({{{"contact", "spring"}, {"why", "soft"}}});
  check_refused({
      {without("", "step"), "/step: missing", {}},
      {stepped, "/step: unknown key", {}},
      {pointer("/scene/support/amplitud"),
       "/parameter/pointer: \"/scene/support/amplitud\" names no number",
       {"did you mean \"/scene/support/amplitude\"", "/scene/stops/upper", "/methods/time/beta",
        "/scene/structure/section/wall"}},
      {pointer("/methods/time/order"), "/parameter/pointer: ", {"names no number"}},
      {pointer("/methods/contact/stiffness"), "/parameter/pointer: ", {"names no number"}},
      {pointer("/scene/structure/type"), "/parameter/pointer: ", {"names no number"}},
      {pointer("/scene/stops/at"), "/parameter/pointer: ", {"names no number"}},
      {pointer("/scene/support"), "/parameter/pointer: ", {"names no number"}},
      {pointer(""), "/parameter/pointer: ", {"names no number"}},
      {pointer("amplitude"), "/parameter/pointer: ", {"names no number"}},
      {sweep_with("/parameter/pointer", 3), "/parameter/pointer: expected a text", {}},
      {list, "/parameter/pointer: /scene/support/amplitude is a list", {"one number"}},
      {methods_list, "/parameter/pointer: /methods/contact/stiffness is a list", {}},
      {no_stop, "/parameter/pointer: /scene/stops/lower is null", {}},
      {sweep_with("/parameter", range(0.09, 0.07, 3)), "/parameter/from: the range from 0.09 to 0.07 is empty", {}},
      {sweep_with("/parameter", range(0.07, 0.07, 3)), "/parameter/from: the range", {}},
      {sweep_with("/parameter", range(0.07, 0.09, 1)), "/parameter/count: expected a whole number in [2, ", {}},
      {sweep_with("/parameter", range(1, 1.0000000000000002, 5)), "/parameter/count: 5 values do not fit", {}},
      {sweep_with("/parameter", range(0.07, "0.09", 2)), "/parameter/to: expected a number", {}},
      {sweep_with("/parameter", values(Json::array())), "/parameter/values: an empty list", {}},
      {sweep_with("/parameter", values({0.07, 0.08, 0.07})),
       "/parameter/values/2: repeats the value 0.07",
       {"/parameter/values/0"}},
      {sweep_with("/parameter", values({0.07, nullptr})), "/parameter/values/1: expected a number", {"found null"}},
      {sweep_with("/parameter", values({0.07, "x"})), "/parameter/values/1: expected a number", {}},
      {sweep_with("/parameter/values", {0.1}),
       "/parameter/from: does not go together with \"values\"",
       {"\"values\", or \"from\", \"to\", \"count\""}},
      {sweep_with("/parameter", {{"pointer", "/scene/support/amplitude"}}),
       "/parameter: expected either \"values\"",
       {}},
      {sweep_with("/parameter/vlaues", {0.1}), "/parameter/vlaues: unknown key", {"did you mean \"values\""}},
      {sweep_with("/parameter", {{"pointer", "/scene/support/amplitude"}, {"from", 0}, {"to", 1}}),
       "/parameter/count: missing",
       {}},
      {sweep_with("/start", Json::array()), "/start: an empty list", {}},
      {sweep_with("/start", "res"), "/start: expected one of", {"did you mean \"rest\""}},
      {sweep_with("/start", {"rest", "rest"}), "/start/1: repeats \"rest\"", {}},
      {sweep_with("/start", {"rest", 3}), "/start/1: expected one of", {"random"}},
      {sweep_with("/start", Json::array({{{"random", 2}}, {{"random", 3}}})), "/start/1: a second", {}},
      {sweep_with("/start", Json::array({{{"random", 0}}})), "/start/0/random: expected a whole number", {}},
      {sweep_with("/start", Json::array({{{"randon", 2}}})), "/start/0/randon: unknown key", {"\"random\""}},
      {sweep_with("/steps_per_period", 4), "/steps_per_period: expected a whole number in [8, ", {}},
      {sweep_with("/steps_per_period", {2000, 2000}), "/steps_per_period/1: repeats", {}},
      {sweep_with("/keep", 15), "/keep: expected a whole number in [16, ", {}},
      {sweep_with("/section", "strob"), "/section: expected one of", {"did you mean \"strobe\""}},
      {sweep_with("/refine", 0), "/refine: expected a number in ]0, ", {}},
      {sweep_with("/transient", {{"periods", 500}, {"at_most", 400}}), "/transient/at_most: at most 400", {"500"}},
      {sweep_with("/exponents", 41), "/exponents: 41 exponents of a state of 40 components", {"at most 40"}},
      {sweep_with("/exponents", -1), "/exponents: expected a whole number", {}},
      {sweep_with("/keep", 10000000),
       "/keep: 8 cases × 3 values × 6 starts × 1e+07 kept periods",
       {"80.6 GB", "16 GB"}},
      {still, "/scene/support/pulsation: ", {"steps per period"}},
      {unforced, "/section: a strobe", {"amplitude 0"}},
      {sweep_with("/parameter", values({0.0})), "/section: a strobe", {}},
      {aperiodic, "/scene/load: the load \"exp(-t)\" does not repeat", {}},
      {impossible, "/scene/support/amplitude: no value is possible; the first: ", {"0.2 m"}},
      {initial, "/start/0: the parameter /scene/initial/velocity", {"\"state\""}},
      {excluded, "/exclude: every case is excluded", {}},
  });
  check_refused({
      {basins_with("/axes", Json::array()), "/axes: expected a list of 2 objects, found 0", {}},
      {basins_with("/axes", 3), "/axes: expected a list of 2 objects, found 3", {}},
      {basins_with("/axes/0/count", 1), "/axes/0/count: expected a whole number in [2, ", {}},
      {basins_with("/axes/1/from", 2), "/axes/1/from: the range from 2 to 2 is empty", {}},
      {basins_with("/axes/1/pointer", "/scene/initial/displacement"), "/axes/1/pointer: repeats", {"/axes/0/pointer"}},
      {basins_with("/axes/1/pointer", "/scene/initial/velocty"), "/axes/1/pointer: ", {"did you mean"}},
      {basins_with("/axes/1/values", {0.1}), "/axes/1/values: unknown key", {}},
      {changed(basins_with("/axes/0/count", 3000), "/axes/1/count", 3000),
       "/axes: 1 case × 3000 × 3000 cells",
       {"16 GB"}},
      {basins_with("/refine", 0.1), "/refine: expected true or false", {}},
      {basins_with("/start", "rest"), "/start: unknown key", {}},
  });
}

TEST_CASE("What is possible at some value is no error of the study") {
  Json through = sweep_with("/parameter", range(0.05, 0.3, 6));
  through["scene"]["stops"]["at"] = "nodes";
  CHECK(refusal(through).empty());
  CHECK(refusal(sweep_with("/parameter", range(0, 0.09, 4))).empty());
  CHECK(refusal(sweep_with("/exponents", 40)).empty());
  Json impact = sweep_with("/section", "impact");
  impact["scene"]["support"]["amplitude"] = 0;
  impact["parameter"]["pointer"] = "/scene/structure/damping/stiffness";
  CHECK(refusal(impact).empty());  // free motion in steps of the period that the pulsation sets
  // The lower stop alone would leave the initial state outside, the pair does not.
  Json pair = small_basins();
  pair["axes"][0] = {{"pointer", "/scene/initial/displacement"}, {"from", 1.6}, {"to", 1.8}, {"count", 3}};
  pair["axes"][1] = {{"pointer", "/scene/stops/upper"}, {"from", 1.7}, {"to", 1.9}, {"count", 3}};
  CHECK(refusal(pair).empty());
}

TEST_CASE("A value of the scene that no orbit takes is not looked at") {
  // That of the parameter, beside values that are possible.
  Json own = sweep_with("/parameter", range(0.05, 0.09, 3));
  own["scene"]["stops"]["at"] = "nodes";
  own["scene"]["support"]["amplitude"] = 5;
  CHECK(refusal(own).empty());
  own["parameter"] = {{"pointer", "/scene/structure/damping/stiffness"}, {"values", {1e-4, 2e-4}}};
  CHECK_THAT(refusal(own), StartsWith("/scene/support/amplitude: "));
  // The initial state, where orbits begin at rest.
  Json rest = small_sweep();
  rest["start"] = {"rest", "up"};
  rest["scene"]["initial"]["displacement"] = "x";
  CHECK(refusal(rest).empty());
  rest["start"] = {"rest", "state"};
  CHECK_THAT(refusal(rest), StartsWith("/scene/initial/displacement: "));
  // Of several scenes the one that is impossible at every value is named.
  Json listed = small_basins();
  listed["scene"]["structure"]["stiffness"] = {1, -1};
  CHECK_THAT(refusal(listed), StartsWith("/scene/structure/stiffness/1: "));
}

TEST_CASE("Steps per period are an axis that excludes may name") {
  const Study study =
      parse(sweep_with("/exclude", Json::array({{{"steps_per_period", 8000}, {"mass", "poor"}, {"why", "too long"}}})));
  int excluded = 0;
  for (const StudyCase& one : study.cases) excluded += one.excluded ? 1 : 0;
  CHECK(excluded == 2);
}

}  // namespace sweep_study_tests

TEST_CASE("a parameter inside a list has the unit and the meaning of its key") {
  StudyResults results;
  results.study = Json::parse(R"({"scene": {
    "structure": {"type": "beam", "length": 1, "section": {"type": "given", "EI": 1, "rhoS": 1}},
    "stops": [{"name": "plate", "at": {"x": 1}, "lower": -0.1, "upper": 0.1}]}})");
  const auto swept = swept_axis(results, {{"pointer", "/scene/stops/0/upper"}});
  REQUIRE(swept);
  CHECK(swept->axis.unit == "m");
  CHECK(swept->axis.text.starts_with("Upper bound"));
}
