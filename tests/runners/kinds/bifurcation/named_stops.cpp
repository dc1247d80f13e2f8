// Stops that have names, and matrices that are given, in sweeps.
#include "runners/kinds/sweep/forcing.hpp"
#include "runners/kinds/sweep/with_parameter.hpp"
#include "tests/places.hpp"
#include "tests/runners/kinds/sweep/sweep_case.hpp"
#include "tests/runners/scratch_folder.hpp"
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
  REQUIRE(record.status == Status::done);
  const NumberTable& impacts = numbers_of(record, "impacts");
  CHECK(impacts.columns.back().name == "stop");
  REQUIRE(impacts.words_of("stop"));
  CHECK(*impacts.words_of("stop") == std::vector<std::string>{"middle", "end"});
  const std::vector<double>&x = column_of(impacts, "x"), &stop = column_of(impacts, "stop");
  REQUIRE(impacts.rows() > 0);
  REQUIRE(stop.size() == impacts.rows());
  for (std::size_t i = 0; i < x.size(); ++i) CHECK(stop[i] == (x[i] == 0.75 ? 0 : 1));
}

TEST_CASE("bifurcation: a mass given by its matrices is the oscillator, whose base is the support of both") {
  const ScratchFolder folder;
  const std::string head = "%%MatrixMarket matrix coordinate real symmetric\n2 2 ";
  write_text(folder / "K.mtx", head + "3\n1 1 100\n2 1 -100\n2 2 100\n");
  write_text(folder / "M.mtx", head + "1\n2 2 1\n");
  write_text(folder / "dofs.csv", "dof,node,component,x,y,z,held\n1,B,ux,0,0,0,base\n2,A,ux,1,0,0,\n");
  Json oscillator = oscillator_sweep({0.02, 0.04}, 0);
  oscillator["parameter"]["pointer"] = "/scene/support/amplitude";
  oscillator["scene"] = Json::parse(R"({
    "structure": {"type": "oscillator", "mass": 1, "stiffness": 100, "damping": 0.2},
    "stops": {"upper": 0.05, "at": "tip"}, "support": {"amplitude": 0.02, "pulsation": 9}})");
  Json given = oscillator;
  given["scene"]["structure"] = Json::parse(R"({"type": "assembled", "stiffness": "K.mtx", "mass": "M.mtx",
    "dofs": "dofs.csv", "damping": {"stiffness": 2e-3}})");
  given["scene"]["stops"] = Json::parse(R"([{"name": "wall", "at": {"node": "A", "component": "ux"}, "upper": 0.05}])");
  const auto speeds = [&](const Json& text) {
    Catalogue catalogue(tests::places().plugins, {}, {});
    Registry registry;
    const Study study = parse_study(text.dump(1), catalogue, registry, folder.path());
    const std::atomic<bool> stop = false;
    const CaseRecord record = run_bifurcation(study.cases.front(), registry, {}, stop);
    REQUIRE(record.status == Status::done);
    return column_of(numbers_of(record, "impacts"), "speed");
  };
  const std::vector<double> a = speeds(oscillator), b = speeds(given);
  REQUIRE(a.size() == b.size());
  REQUIRE(!a.empty());
  for (std::size_t i = 0; i < a.size(); ++i) CHECK(b[i] == Approx(a[i]).epsilon(1e-11));
}

TEST_CASE("sweep: a support of given matrices that does not lift its stops alike has its period all the same") {
  SceneSpec scene =
      assembled_scene(assembled(beam_files(std::get<BeamSpec>(unit_beam().structure), 4, {1, "clamp", {}})));
  scene.support = {0.01, 3, 0};
  scene.stops.named = {{"end", at_node("N4"), {}, -0.1, 0.1}, {"turn", at_node("N4", "rz"), {}, -0.1, 0.1}};
  CHECK_NOTHROW(check_forcing(scene));
  CHECK(forcing_pulsation(scene) == 3);
}

}  // namespace swept_stops_tests
