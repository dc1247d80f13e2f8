// What a study asks, from a shell: what plan doubts, what run and report say and end with.
#include <algorithm>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tests/runners/command/said.hpp"

using Catch::Matchers::Contains;
using Json = nlohmann::ordered_json;

namespace {

/// A mass that meets a spring.
Json study(const Json& ask, const Json& steps) {
  return {{"name", "asks"},
          {"question", "How hard is the stop met?"},
          {"kind", "trajectory"},
          {"ask", ask},
          {"scene",
           {{"structure", {{"type", "bar"}, {"length", 1}, {"EA", 10}, {"rhoA", 1}, {"fixed", "left"}}},
            {"stops", Json::array({Json{{"name", "wall"}, {"at", {{"x", 1}}}, {"upper", 0.1}}})},
            {"initial", {{"velocity", "x"}}}}},
          {"mesh", {{"elements", 4}}},
          {"methods",
           {{"mass", "consistent"},
            {"contact", {{"name", "penalty"}, {"stiffness", {10, 100, 1000, 1e4, 2e4, 5e4, 1e5}}}},
            {"time", {"newmark", {{"name", "newmark"}, {"gamma", 0.6}}}}}},
          {"step", steps},
          {"duration", 1},
          {"samples", 10}};
}

}  // namespace

TEST_CASE("plan says of each ask what could stay open, before anything runs", "[asks]") {
  const ScratchFolder here;
  write_text(
      here / "one.json",
      study(Json::parse(R"([{"runs": true}, {"value": "peak_force"}, {"rank": "peak_force", "over": "time"}])"), 0.01)
          .dump());
  const CommandOutput one = say(here, "plan one.json");
  INFO(one.err);
  CHECK(one.code == 0);
  CHECK_THAT(one.out, Contains("\nask 2 (value peak_force): one step only") &&
                          Contains("\nask 3 (rank peak_force): one step only") && !Contains("ask 1"));
  write_text(here / "three.json", study(Json::parse(R"([{"value": "peak_force"}])"), {0.01, 0.005, 0.0025}).dump());
  CHECK_THAT(say(here, "plan three.json").out, !Contains("ask 1"));
}

TEST_CASE("run says each sentence above its rows, twelve at most, and a required yes that is missing is code 6",
          "[asks]") {
  const ScratchFolder here;
  write_text(here / "study.json",
             study({{{"value", "peak_force"}}, {{"limit", "peak_force"}, {"below", 1e-3}, {"require", true}}},
                   {0.01, 0.005, 0.0025})
                 .dump());
  const CommandOutput ran = say(here, "run study.json --out out");
  INFO(ran.out << ran.err);
  CHECK(ran.code == 6);
  CHECK_THAT(ran.out, Contains("How hard is the stop met?\n") && Contains("level") && Contains("value (N)") &&
                          Contains(" ± ") && Contains("… 14 rows in verdicts.csv\n") &&
                          Contains("Ask 2 requires a yes and has none.") && Contains("exit code 6: ask 2 "));
  CHECK(ran.out.find("Peak force") < ran.out.find("level"));
  CHECK(ran.out.find("level") < ran.out.find("No: "));
  // A column that is empty throughout is none.
  CHECK_THAT(ran.out, !Contains("stop  ") && !Contains("  of  "));

  const CommandOutput told = say(here, "report out --json");
  INFO(told.err);
  CHECK(told.code == 6);
  const Json json = Json::parse(told.out);
  CHECK(json.at("question") == "How hard is the stop met?");
  std::string table = read_text(here / "out/verdicts.csv");
  CHECK(json.at("verdicts").size() + 1 == static_cast<std::size_t>(std::count(table.begin(), table.end(), '\n')));
  CHECK(json.at("verdicts").at(0).at("verb") == "value");
  CHECK(json.at("verdicts").at(0).at("value").is_null());
  CHECK(json.at("verdicts").at(1).at("value").is_number());
  CHECK_THAT(ran.out, Contains(json.at("verdicts").at(0).at("sentence").get<std::string>()));
  // What is doubtful, left out or missing is told to programs, too.
  REQUIRE_FALSE(json.at("aside").empty());
  for (const Json& one : json.at("aside")) CHECK_THAT(ran.out, Contains(one.at("sentence").get<std::string>()));
  CHECK(json.at("aside").back() == Json({{"ask", 2}, {"sentence", "Ask 2 requires a yes and has none."}}));
  for (const Json& one : json.at("first")) CHECK_THAT(ran.out, Contains(one.get<std::string>()));
  CHECK(say(here, "report out out --json").code == 2);
  // A page of several folders is written whatever their asks say.
  std::filesystem::copy(here / "out", here / "other", std::filesystem::copy_options::recursive);
  CHECK(say(here, "report out other").code == 6);
  CHECK(std::filesystem::exists(here / "index.html"));
}
