// A study of very many places is refused by some of them: a check of each would take minutes.
#include <catch2/catch.hpp>

#include "tests/runners/study/study_fixture.hpp"

using namespace ricochet;
using namespace ricochet::tests;
using Catch::Matchers::Contains;

namespace many_places_tests {
namespace {

Json basins(double pulsation) {
  Json study = small_study();
  study["kind"] = "basins";
  for (const char* key : {"step", "duration", "samples"}) study.erase(key);
  study["scene"]["support"] = {{"amplitude", 0.01}, {"pulsation", pulsation}};
  study["scene"]["initial"] = {{"displacement", "0.01*x"}, {"velocity", "x"}};
  study["methods"]["mass"] = "full";
  study["methods"]["time"] = "three-level";
  study["axes"] = Json::parse(R"json([{"pointer": "/scene/initial/displacement", "from": -1, "to": 1, "count": 1000},
                                      {"pointer": "/scene/initial/velocity", "from": -2, "to": 2, "count": 1000}])json");
  study["steps_per_period"] = 400;
  study["transient"] = {{"periods", 40}, {"at_most", 200}};
  study["keep"] = 16;
  return study;
}

std::string fault(const Json& json) {
  return testing::input_error([&] { parse(json); }, "");
}

}  // namespace

TEST_CASE("a million cells that no motion has are refused, and as many that some have are not") {
  CHECK_THAT(fault(basins(0)), Contains("no forcing has a period"));
  CHECK(fault(basins(10)).empty());
}

TEST_CASE("sixty thousand values that no orbit has are refused") {
  Json study = basins(0);
  study["kind"] = "bifurcation";
  for (const char* key : {"axes", "transient", "keep"}) study.erase(key);
  study["parameter"] = {{"pointer", "/scene/support/amplitude"}, {"from", 0.01}, {"to", 0.02}, {"count", 60000}};
  CHECK_THAT(fault(study), Contains("no forcing has a period"));
  study["scene"]["support"]["pulsation"] = 10;
  CHECK(fault(study).empty());
}

}  // namespace many_places_tests
