// Stops that have names, and matrices that are given, in sweeps.
#include "runners/kinds/sweep/with_parameter.hpp"
#include "tests/runners/kinds/sweep/sweep_case.hpp"
#include "tests/scene/structure/beam_files.hpp"
#include "tests/scene/working_set.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace swept_stops_tests {

TEST_CASE("bifurcation: impacts say the name of their stop, where stops have names") {
  Json text = beam_sweep({0.08, 0.09});
  CHECK_FALSE(numbers_of(run_sweep(text), "impacts").numbers("stop"));
  text["scene"]["stops"] = Json::parse(R"([{"name": "middle", "at": {"x": 0.75}, "lower": -0.05, "upper": 0.05},
                                           {"name": "end", "at": {"x": 1.501}, "lower": -0.1, "upper": 0.1}])");
  const CaseRecord record = run_sweep(text);
  REQUIRE(record.status == "done");
  const NumberTable& impacts = numbers_of(record, "impacts");
  CHECK(impacts.columns.back().name == "stop");
  REQUIRE(impacts.words_of("stop"));
  CHECK(*impacts.words_of("stop") == std::vector<std::string>{"middle", "end"});
  const std::vector<double>&x = column_of(impacts, "x"), &stop = column_of(impacts, "stop");
  REQUIRE(impacts.rows() > 0);
  REQUIRE(stop.size() == impacts.rows());
  for (std::size_t i = 0; i < x.size(); ++i) CHECK(stop[i] == (x[i] == 0.75 ? 0 : 1));
}

TEST_CASE("sweep: a support of given matrices that does not lift its stops alike is refused") {
  SceneSpec scene =
      assembled_scene(assembled(beam_files(std::get<BeamSpec>(unit_beam().structure), 4, {1, "clamp", {}})));
  scene.support = {0.01, 3, 0};
  scene.stops.named = {{"end", at_node("N4"), {}, -0.1, 0.1}};
  CHECK_NOTHROW(check_forcing(scene));
  scene.stops.named.push_back({"turn", at_node("N4", "rz"), {}, -0.1, 0.1});
  CHECK_THROWS_WITH(check_forcing(scene),
                    Catch::Matchers::Contains("the supports do not lift the stops and the tip alike"));
}

}  // namespace swept_stops_tests
