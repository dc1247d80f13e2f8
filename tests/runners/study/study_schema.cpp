#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "runners/study/load_study.hpp"
#include "tests/places.hpp"
#include "tests/runners/study/study_fixture.hpp"

using namespace ricochet;
using namespace ricochet::tests;

namespace {

/// What a validator of JSON Schema (ajv, by validator/validate.js) says of each value: null where it accepts it, else
/// its first error.
std::vector<Json> said_of(const Registry& registry, const std::vector<Json>& values) {
  const std::filesystem::path here = std::filesystem::path(places().build) / "tests/validator";
  std::filesystem::create_directories(here);
  // One file for each process, as tests run beside each other.
  const std::string asked = (here / (std::to_string(::getpid()) + ".asked")).string(), answered = asked + ".answered";
  {
    std::ofstream file(asked);
    file << study_schema(registry).dump() << "\n";
    for (const Json& value : values) file << value.dump() << "\n";
  }
  const std::string command =
      "node '" + places().source + "/tests/runners/study/validator/validate.js' <'" + asked + "' >'" + answered + "'";
  INFO(command << ": needs node, and ajv from npm, which tests/run.sh installs");
  REQUIRE(std::system(command.c_str()) == 0);
  std::vector<Json> answers;
  std::ifstream file(answered);
  for (std::string line; std::getline(file, line);) answers.push_back(Json::parse(line));
  REQUIRE(answers.size() == values.size());
  std::filesystem::remove(asked);
  std::filesystem::remove(answered);
  return answers;
}

/// The schema says of each value what the reader says of it.
void agree(const Registry& registry, const std::vector<Json>& good, const std::vector<Json>& bad) {
  std::vector<Json> all = good;
  all.insert(all.end(), bad.begin(), bad.end());
  const std::vector<Json> said = said_of(registry, all);
  for (std::size_t i = 0; i < all.size(); ++i) {
    INFO(all[i].dump(1));
    CHECK(refusal(all[i]).empty() == (i < good.size()));
    CHECK(said[i].is_null() == (i < good.size()));
  }
}

}  // namespace

TEST_CASE("The schema accepts every shipped study, as written and as resolved") {
  Catalogue catalogue(places().plugins, {}, {});
  Registry registry;
  catalogue.open_all(registry);
  std::vector<Json> studies;
  std::vector<std::string> names;
  for (const auto& item : std::filesystem::directory_iterator(places().source + "/studies")) {
    if (item.path().extension() != ".json") continue;
    std::ifstream stream(item.path());
    studies.push_back(Json::parse(stream));
    studies.push_back(load_study(item.path(), catalogue, registry).resolved);
    names.insert(names.end(), 2, item.path().string());
  }
  const std::vector<Json> said = said_of(registry, studies);
  for (std::size_t i = 0; i < said.size(); ++i) {
    INFO(names[i] << ": " << said[i]);
    CHECK(said[i].is_null());
  }
}

TEST_CASE("The schema and the reader agree on what is a study") {
  const Registry registry = stand_ins();
  const std::vector<Json> good = {
      small_study(),
      with("/scene/stops/at", {0.5, 1.5}),
      with("/scene/stops/at", Json::array({"tip", Json::array({0.5})})),
      with("/scene/stops/lower", {nullptr, -0.1, "-0.1"}),
      with("/scene/support", {{"amplitude", {0.01, 0.02}}, {"pulsation", 10}}),
      with("/methods/contact", {{"name", "spring"}, {"stiffness", {1, 10}}}),
      with("/methods/contact", {{"name", "rows"}, {"force", Json::parse("[[0, 0], [1, 0], [2, 3.5]]")}}),
      with("/methods/contact", {{"name", "rows"},
                                {"force", Json::parse("[[[0, 0], [1, 1]], [[0, 0], [1, 2]]]")},
                                {"back", Json::parse("[null, [[0, 0], [1, 1]]]")}}),
      with("/methods/mass", "poor"),
      with("/scene/structure/damping", {{"ratios", {0.02, 0.02}}}),
      with("/exclude", Json::array({{{"mass", "poor"}, {"why", "slow"}}})),
      with("/exclude", Json::array({{{"mass.velocity", "P1"}, {"why", "slow"}}})),
  };
  const std::vector<Json> bad = {
      with("/sttep", 1),
      without("", "step"),
      without("/scene/structure", "young"),
      without("/scene/structure", "type"),
      with("/scene/structure/lenght", 1),
      with("/scene/structure/length", -1),
      with("/scene/structure/length", "1"),
      with("/scene/structure/length", Json::array()),
      with("/scene/structure/length", {1.5, 1.5}),
      with("/scene/structure/section/type", "tueb"),
      with("/scene/structure/section",
           {{"type", "given"}, {"EI", 1}, {"rhoS", 1}}),  // young and density are too much then
      with("/scene/structure/section", {{"type", "circle"}, {"wall", 1}}),
      with("/scene/stops/at", "node"),
      with("/scene/stops/lower", true),
      with("/scene/load", nullptr),
      with("/mesh/elements", 0),
      with("/mesh/elements", 2.5),
      with("/kind", "trajectroy"),
      with("/duration", {0.1, 0.2}),
      with("/methods/mass", "ful"),
      with("/methods/mass", Json::array()),
      with("/methods/mass", {{"name", "full"}, {"velocity", "P1"}}),
      with("/methods/contact", "spring"),
      with("/methods/contact", {{"name", "spring"}, {"stiffness", 0}}),
      with("/methods/contact", {{"name", "rows"}, {"force", Json::parse("[[0, 0]]")}}),
      with("/methods/contact", {{"name", "rows"}, {"force", Json::parse("[[0, 0], [1, -1]]")}}),
      with("/methods/contact", {{"name", "rows"}, {"force", Json::parse("[[0, 0], [1, 1, 1]]")}}),
      with("/methods/contact", {{"name", "rows"}, {"force", nullptr}}),
      with("/methods/time", {{"name", "three-level"}, {"beta", 1.5}}),
      with("/methods/time", {{"name", "three-level"}, {"order", 1.5}}),
      with("/exclude", Json::array({{{"mass", "poor"}}})),
      with("/exclude", Json::array({{{"why", "all"}}})),
      with("/exclude", Json::array({{{"mas", "poor"}, {"why", "slow"}}})),
  };
  agree(registry, good, bad);
}

TEST_CASE("The first thing that a validator says of a misspelt key is that key, where it stands") {
  const std::vector<std::pair<std::string, std::string>> all = {
      {"", "sttep"},
      {"/scene", "laod"},
      {"/scene/structure", "lenght"},
      {"/scene/structure/section", "diametre"},
      {"/scene/structure/damping", "stifness"},
      {"/mesh", "element"},
  };
  Json study = small_study();
  study["scene"]["structure"]["damping"]["stiffness"] = 1e-4;
  std::vector<Json> studies = {study};
  for (const auto& [pointer, key] : all) {
    studies.push_back(study);
    studies.back()[Json::json_pointer(pointer + "/" + key)] = 1;
  }
  const std::vector<Json> said = said_of(stand_ins(), studies);
  CHECK(said[0].is_null());
  for (std::size_t i = 0; i < all.size(); ++i) {
    INFO(all[i].first << "/" << all[i].second << ": " << said[i + 1]);
    REQUIRE(said[i + 1].is_object());
    CHECK(said[i + 1]["instancePath"] == all[i].first);
    CHECK(said[i + 1]["params"]["additionalProperty"] == all[i].second);
  }
}

TEST_CASE("The schema and the reader agree on what may be asked") {
  const auto asking = [](const char* list) { return with("/ask", Json::parse(list)); };
  Json named = with("/scene/stops", Json::array({{{"name", "end"}, {"at", {{"x", 1.5}}}, {"upper", 0.1}}}));
  const auto asking_stops = [&](const char* list) {
    Json study = named;
    study["ask"] = Json::parse(list);
    return study;
  };
  const std::vector<Json> good = {
      asking("[]"),
      asking(R"([{"runs": true}])"),
      asking(R"([{"effect": "mass", "on": "energy_end", "from": "5 %"}])"),
      asking(R"([{"effect": "mass", "on": "energy_end", "within": 0.05}])"),
      asking(R"([{"effect": "mass", "on": "energy_end", "from": "500 %"}])"),
      asking(R"([{"limit": "energy_end", "below": 1, "require": true}])"),
      asking(R"([{"value": "energy_end", "where": {"step": 1e-4, "mass": "full"}}])"),
      asking_stops(R"([{"value": "impulse", "stops": ["end"]}])"),
      asking_stops(R"([{"value": "impulse", "stops": "end"}])"),
  };
  const std::vector<Json> bad = {
      asking(R"({"runs": true})"),
      asking(R"([{"require": true}])"),
      asking(R"([{"runs": 1}])"),
      asking(R"([{"valeu": "energy_end"}])"),
      asking(R"([{"value": "energy_end", "limit": "energy_end", "below": 1}])"),
      asking(R"([{"enough": "energy_end"}])"),
      asking(R"([{"enough": "energy_end", "within": "5"}])"),
      asking(R"([{"enough": "energy_end", "within": "five %"}])"),
      asking(R"([{"enough": "energy_end", "within": -1}])"),
      asking(R"([{"effect": "mass", "on": "energy_end", "from": 5}])"),
      asking(R"([{"value": "energy_end", "where": 3}])"),
      asking(R"([{"value": "energy_end", "where": {"step": [1e-4]}}])"),
      asking_stops(R"([{"value": "impulse", "stops": 1}])"),
      with("/ask", Json(std::vector<Json>(9, {{"runs", true}}))),
  };
  agree(stand_ins(), good, bad);
}

TEST_CASE("The schema and the reader take remarks and $schema, at any level") {
  Json study = small_study();
  study["$schema"] = "./schema.json";
  study["//"] = "from the drawing of 12 May";
  study["scene"]["structure"]["// young"] = "certificate 4711";
  study["methods"]["contact"] = {{"name", "spring"}, {"stiffness", 1}, {"//", "a guess"}};
  CHECK(said_of(stand_ins(), {study})[0].is_null());
  const Study read = parse(study);
  CHECK(read.resolved.dump().find("//") == std::string::npos);
  CHECK(read.resolved.dump().find("$schema") == std::string::npos);
  study["methods"]["contact"].erase("//");
  study.erase("$schema");
  CHECK(parse(study).cases.front().id == read.cases.front().id);
}

TEST_CASE("The schema accepts plans, by file and as they are written") {
  for (const char* name : {"newmark.json", "bathe.json", "moreau-jean.json", "kane.json"}) {
    INFO(name);
    std::ifstream stream(std::string(places().source + "/plugins/plan_files/") + name);
    Json plan = Json::parse(stream);
    std::vector<Json> studies = {
        with("/methods/time", {{"name", "plan"}, {"plan", plan}}),
        with("/methods/time", {{"name", "plan"}, {"file", name}, {"beta", {0.25, 0.5}}}),
        with("/methods/time", {{"name", "other"}, {"file", name}}),
    };
    plan["stages"][0]["matrx"] = 1;
    studies.push_back(with("/methods/time", {{"name", "plan"}, {"plan", plan}}));
    const std::vector<Json> said = said_of(stand_ins(), studies);
    for (std::size_t i = 0; i < said.size(); ++i) {
      INFO(studies[i].dump(1));
      CHECK(said[i].is_null() == (i < 2));
    }
  }
}

TEST_CASE("The schema and the reader agree on what is a sweep") {
  const Registry registry = stand_ins();
  const auto changed = [](Json study, const std::string& pointer, const Json& value) {
    study[Json::json_pointer(pointer)] = value;
    return study;
  };
  const auto sweep = [&](const std::string& pointer, const Json& value) {
    return changed(small_sweep(), pointer, value);
  };
  const auto basins = [&](const std::string& pointer, const Json& value) {
    return changed(small_basins(), pointer, value);
  };
  const std::string amplitude = "/scene/support/amplitude";
  const std::vector<Json> good = {
      small_sweep(),
      small_basins(),
      parse(small_sweep()).resolved,
      parse(small_basins()).resolved,
      sweep("/parameter", {{"pointer", amplitude}, {"values", 0.07}}),
      sweep("/parameter", {{"pointer", amplitude}, {"values", {0.07, 0.08}}}),
      sweep("/start", "up"),
      sweep("/start", {{"random", 8}}),
      sweep("/start", {"state", "down"}),
      sweep("/transient", {{"periods", 10}}),
      sweep("/section", "extremum"),
      sweep("/refine", 1e-5),
      sweep("/exponents", 3),
      sweep("/steps_per_period", 100),
      sweep("/exclude", Json::array({{{"steps_per_period", 2000}, {"why", "coarse"}}})),
      basins("/refine", true),
      basins("/section", "impact"),
  };
  const std::vector<Json> bad = {
      sweep("/parameter", {{"pointer", amplitude}}),
      sweep("/parameter", {{"values", {0.07}}}),
      sweep("/parameter", {{"pointer", amplitude}, {"values", {0.07}}, {"from", 0}, {"to", 1}, {"count", 2}}),
      sweep("/parameter", {{"pointer", amplitude}, {"from", 0}, {"to", 1}}),
      sweep("/parameter", {{"pointer", amplitude}, {"values", Json::array()}}),
      sweep("/parameter", {{"pointer", amplitude}, {"values", {0.07, 0.07}}}),
      sweep("/parameter/count", 1),
      sweep("/start", "sideways"),
      sweep("/start", Json::array()),
      sweep("/start", Json::array({"up", "up"})),
      sweep("/start", Json::array({{{"random", 2}, {"sed", 1}}})),
      sweep("/start", Json::array({{{"seed", 2}}})),
      sweep("/transient/periodes", 10),
      sweep("/keep", 8),
      sweep("/section", "poincare"),
      sweep("/refine", true),
      sweep("/exponents", 0.5),
      sweep("/steps_per_period", 7),
      sweep("/step", 1e-4),
      sweep("/duration", 1),
      basins("/refine", 1e-3),
      basins("/axes/0/count", 1),
      basins("/axes/0/values", {0.1}),
      basins("/axes/2", {{"pointer", amplitude}, {"from", 0}, {"to", 1}, {"count", 2}}),
      basins("/start", "rest"),
  };
  agree(registry, good, bad);
}

TEST_CASE("Every object of the schema is closed and every key is described") {
  const std::function<void(const Json&, const std::string&)> visit = [&](const Json& schema, const std::string& path) {
    if (schema.is_object()) {
      // Conditions inside allOf only narrow an object that is closed already.
      if (schema.contains("properties") && schema.contains("type")) {
        INFO(path);
        CHECK(schema["additionalProperties"] == false);
      }
      for (const auto& [key, value] : schema.items()) visit(value, path + "/" + key);
    } else if (schema.is_array()) {
      for (const Json& item : schema) visit(item, path + "/-");
    }
  };
  const Json schema = study_schema(stand_ins());
  CHECK(schema["$schema"] == "http://json-schema.org/draft-07/schema#");
  visit(schema, "");
}
