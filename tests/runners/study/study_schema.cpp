#include "runners/study/study_schema.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>

#include "tests/runners/study/study_fixture.hpp"

using namespace ricochet;
using namespace ricochet::tests;

namespace {

class Validator {
 public:
  explicit Validator(const Registry& registry) : text_(nlohmann::json(study_schema(registry))) {
    valijson::SchemaParser parser;
    parser.populateSchema(valijson::adapters::NlohmannJsonAdapter(text_), schema_);
  }
  bool accepts(const Json& study) {
    const nlohmann::json plain = study;
    valijson::Validator validator(valijson::Validator::kStrongTypes);
    return validator.validate(schema_, valijson::adapters::NlohmannJsonAdapter(plain), nullptr);
  }
  /// The first thing it says: "<root>[scene][structure]: …".
  std::string says(const Json& study) {
    const nlohmann::json plain = study;
    valijson::Validator validator(valijson::Validator::kStrongTypes);
    valijson::ValidationResults results;
    validator.validate(schema_, valijson::adapters::NlohmannJsonAdapter(plain), &results);
    valijson::ValidationResults::Error error;
    if (!results.popError(error)) return "";
    std::string text;
    for (const std::string& part : error.context) text += part;
    return text + ": " + error.description;
  }

 private:
  nlohmann::json text_;
  valijson::Schema schema_;
};

}  // namespace

TEST_CASE("The schema accepts every shipped study, as written and as resolved") {
  Catalogue catalogue(RICOCHET_PLUGIN_DIR, {}, {});
  Registry registry;
  catalogue.open_all(registry);
  Validator validator(registry);
  for (const auto& item : std::filesystem::directory_iterator(RICOCHET_SOURCE_DIR "/studies")) {
    if (item.path().extension() != ".json") continue;
    INFO(item.path().string());
    std::ifstream stream(item.path());
    CHECK(validator.accepts(Json::parse(stream)));
    CHECK(validator.accepts(load_study(item.path(), catalogue, registry).resolved));
  }
}

TEST_CASE("The schema and the reader agree on what is a study") {
  const Registry registry = stand_ins();
  Validator validator(registry);
  const std::vector<Json> good = {
      small_study(),
      with("/scene/stops/at", {0.5, 1.5}),
      with("/scene/stops/at", Json::array({"tip", Json::array({0.5})})),
      with("/scene/stops/lower", {nullptr, -0.1, "-0.1"}),
      with("/scene/support", {{"amplitude", {0.01, 0.02}}, {"pulsation", 10}}),
      with("/methods/contact", {{"name", "spring"}, {"stiffness", {1, 10}}}),
      with("/methods/mass", "poor"),
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
      with("/methods/time", {{"name", "three-level"}, {"beta", 1.5}}),
      with("/methods/time", {{"name", "three-level"}, {"order", 1.5}}),
      with("/exclude", Json::array({{{"mass", "poor"}}})),
      with("/exclude", Json::array({{{"why", "all"}}})),
      with("/exclude", Json::array({{{"mas", "poor"}, {"why", "slow"}}})),
  };
  for (const Json& study : good) {
    INFO(study.dump(1));
    CHECK(refusal(study).empty());
    CHECK(validator.accepts(study));
  }
  for (const Json& study : bad) {
    INFO(study.dump(1));
    CHECK_FALSE(refusal(study).empty());
    CHECK_FALSE(validator.accepts(study));
  }
}

TEST_CASE("The first thing that a validator says of a misspelt key is that key, where it stands") {
  Validator validator(stand_ins());
  const std::vector<std::pair<std::string, std::string>> all = {
      {"", "sttep"},
      {"/scene", "laod"},
      {"/scene/structure", "lenght"},
      {"/scene/structure/section", "diametre"},
      {"/scene/structure/damping", "stifness"},
      {"/mesh", "element"},
  };
  for (const auto& [pointer, key] : all) {
    std::string where = "<root>";
    for (std::size_t at = 1; at < pointer.size();) {
      const std::size_t end = std::min(pointer.find('/', at), pointer.size());
      where += "[" + pointer.substr(at, end - at) + "]";
      at = end + 1;
    }
    Json study = small_study();
    study["scene"]["structure"]["damping"]["stiffness"] = 1e-4;
    CHECK(validator.says(study).empty());
    study[Json::json_pointer(pointer + "/" + key)] = 1;
    INFO(pointer << "/" << key);
    using Catch::Matchers::Contains;
    CHECK_THAT(validator.says(study), Catch::Matchers::StartsWith(where + ": ") && Contains(key));
  }
}

TEST_CASE("The schema and the reader take remarks and $schema, at any level") {
  const Registry registry = stand_ins();
  Validator validator(registry);
  Json study = small_study();
  study["$schema"] = "./schema.json";
  study["//"] = "from the drawing of 12 May";
  study["scene"]["structure"]["// young"] = "certificate 4711";
  study["methods"]["contact"] = {{"name", "spring"}, {"stiffness", 1}, {"//", "a guess"}};
  CHECK(validator.accepts(study));
  const Study read = parse(study);
  CHECK(read.resolved.dump().find("//") == std::string::npos);
  CHECK(read.resolved.dump().find("$schema") == std::string::npos);
  study["methods"]["contact"].erase("//");
  study.erase("$schema");
  CHECK(parse(study).cases.front().id == read.cases.front().id);
}

TEST_CASE("The schema accepts plans, by file and as they are written") {
  Validator validator(stand_ins());
  for (const char* name : {"newmark.json", "bathe.json", "moreau-jean.json", "kane.json"}) {
    INFO(name);
    std::ifstream stream(std::string(RICOCHET_SOURCE_DIR "/tests/plugins/plan_files/") + name);
    Json plan = Json::parse(stream);
    CHECK(validator.accepts(with("/methods/time", {{"name", "plan"}, {"plan", plan}})));
    CHECK(validator.accepts(with("/methods/time", {{"name", "plan"}, {"file", name}, {"beta", {0.25, 0.5}}})));
    CHECK_FALSE(validator.accepts(with("/methods/time", {{"name", "other"}, {"file", name}})));
    plan["stages"][0]["matrx"] = 1;
    CHECK_FALSE(validator.accepts(with("/methods/time", {{"name", "plan"}, {"plan", plan}})));
  }
}

TEST_CASE("The schema and the reader agree on what is a sweep") {
  const Registry registry = stand_ins();
  Validator validator(registry);
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
  for (const Json& study : good) {
    INFO(study.dump(1));
    CHECK(refusal(study).empty());
    CHECK(validator.accepts(study));
  }
  for (const Json& study : bad) {
    INFO(study.dump(1));
    CHECK_FALSE(refusal(study).empty());
    CHECK_FALSE(validator.accepts(study));
  }
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
