// Films of structures that files describe: nodes on their plane, or a bar for each point.
#include <catch2/catch.hpp>

#include "runners/store/record_values.hpp"
#include "runners/store/snapshots.hpp"
#include "tests/places.hpp"
#include "tests/runners/kinds/trajectory/case_runs.hpp"
#include "tests/runners/scratch_folder.hpp"

using namespace ricochet;

namespace {

const std::string head = "%%MatrixMarket matrix array real symmetric\n2 2\n";

/// Two masses A and B on springs; B is let go against a stop, and another stop stands between both.
Json two_masses() {
  return Json::parse(R"json({
    "name": "two", "kind": "trajectory",
    "scene": {"structure": {"type": "assembled", "stiffness": "K.mtx", "mass": "M.mtx", "dofs": "dofs.csv",
                            "tip": {"node": "B", "component": "ux"}},
              "stops": [{"name": "wall", "at": {"node": "B", "component": "ux"}, "upper": 0.1},
                        {"name": "gap", "at": {"node": "A", "component": "ux"}, "to": {"node": "B", "component": "ux"},
                         "upper": 0.5}],
              "initial": {"file": "state.csv"}},
    "methods": {"mass": "consistent", "contact": "signorini", "time": "newmark-dumont-paoli"},
    "step": 1e-3, "duration": 4, "samples": 40, "snapshots": 40})json");
}

void write_two_masses(const ScratchFolder& folder, const std::string& places) {
  write_text(folder / "K.mtx", head + "3\n-1\n3\n");
  write_text(folder / "M.mtx", head + "1\n0\n2\n");
  write_text(folder / "dofs.csv", "dof,node,component,x,y,z,held\n1,A,ux,0,0,0,\n2,B,ux," + places + ",\n");
  write_text(folder / "state.csv", "dof,displacement,velocity\n2,-0.3,0\n");
}

CaseRecord run_in(const Json& text, const ScratchFolder& folder) {
  Catalogue catalogue(tests::places().plugins, {}, {});
  Registry registry;
  const std::atomic<bool> stop = false;
  return run_case(parse_study(text.dump(1), catalogue, registry, folder.path()).cases.front(), registry, stop);
}

Snapshots film_of(const CaseRecord& record) {
  INFO(record.reason());
  REQUIRE(record.status == Status::done);
  const NumberTable* table = find_table(record.numbers, snapshots_name);
  REQUIRE(table);
  const auto found = snapshots_of(*table);
  REQUIRE(found);
  // A store gives back what it was given.
  const auto again = snapshots_of(table_of(*found));
  REQUIRE(again);
  CHECK(again->names == found->names);
  CHECK(again->y == found->y);
  CHECK(again->links == found->links);
  CHECK(again->stops == found->stops);
  CHECK(again->held == found->held);
  return *found;
}

}  // namespace

TEST_CASE("nodes are filmed on their plane: each along two axes, joined as K joins them, stops where they act") {
  const ScratchFolder folder;
  write_two_masses(folder, "1,0,0");
  const CaseRecord record = run_in(two_masses(), folder);
  const Snapshots film = film_of(record);
  CHECK(film.names == std::vector<std::string>{"A", "B"});
  CHECK(film.x == std::vector<double>{0, 1});
  REQUIRE(film.y.size() == 2);
  CHECK(film.links == std::vector<std::pair<int, int>>{{0, 1}});
  REQUIRE(film.stops.size() == 2);
  CHECK(film.stops[0] == Snapshots::Stop{1, -1, {1, 0}, "wall"});
  CHECK(film.stops[1] == Snapshots::Stop{0, 1, {1, 0}, "gap"});
  CHECK(film.upper == std::vector<double>{0.1, 0.5});
  REQUIRE(film.displacement.size() == film.t.size() * film.values());
  // Along x of B is the tip; nothing moves along the other axis.
  const auto& tips = record.curve.columns[1];
  for (std::size_t k = 1; k < film.t.size(); ++k) {
    const std::size_t sample = tips.size() - film.t.size() + k, at = k * film.values();
    CHECK(std::abs(film.metres * film.displacement[at + 2] - tips[sample]) <= 0.5001 * film.metres);
    CHECK(film.displacement[at + 1] == 0);
    CHECK(film.displacement[at + 3] == 0);
  }
}

TEST_CASE("nodes without places are filmed as a bar for each stop and point") {
  const ScratchFolder folder;
  write_two_masses(folder, "0,0,0");
  Json text = two_masses();
  text["scene"]["structure"].erase("tip");
  text["scene"]["points"] = Json::parse(R"([{"name": "first", "at": {"node": "A", "component": "ux"}}])");
  const Snapshots film = film_of(run_in(text, folder));
  CHECK(film.names == std::vector<std::string>{"wall", "gap", "first"});
  CHECK(film.y.empty());
  CHECK(film.values() == 3);
  CHECK(film.stops[1].at == 1);
  // At the start: B at −0.3, A less B 0.3, A at rest.
  CHECK(film.metres * film.displacement[0] == Approx(-0.3).epsilon(1e-4));
  CHECK(film.metres * film.displacement[1] == Approx(0.3).epsilon(1e-4));
  CHECK(film.displacement[2] == 0);
}

TEST_CASE("a description in modes is filmed at its points") {
  const ScratchFolder folder;
  write_text(folder / "modes.csv", "mode,frequency,mass,damping\n1,1,1,0.01\n2,3,1,0.01\n");
  write_text(folder / "shapes.csv", "point,1,2\nmiddle,1,0\nquarter,0.7,1\n");
  Json text = two_masses();
  text["scene"] = Json::parse(R"json({
    "structure": {"type": "modal", "modes": "modes.csv", "shapes": "shapes.csv"},
    "stops": [{"name": "plate", "at": {"point": "quarter"}, "upper": 1e-3}],
    "load": [{"at": {"point": "middle"}, "force": "sin(6*t)"}]})json");
  const Snapshots film = film_of(run_in(text, folder));
  CHECK(film.names == std::vector<std::string>{"middle", "quarter"});
  CHECK(film.y.empty());
  REQUIRE(film.stops.size() == 1);
  CHECK(film.stops[0].at == 1);
}

namespace {

Json two_rods(const std::string& more) {
  return Json::parse(R"json({
    "name": "rods", "kind": "trajectory",
    "scene": {"bodies": {
      "rod": {"type": "beam", "length": 1, "section": {"type": "given", "EI": 10, "rhoS": 1}, )json" +
                     more + R"json(
              "supports": [{"name": "a", "x": 0, "type": "pinned"}, {"name": "b", "x": 1, "type": "pinned"}]},
      "ball": {"type": "oscillator", "mass": 1, "stiffness": 10}},
      "stops": [{"name": "gap", "at": {"body": "rod", "x": 0.3}, "to": {"body": "ball"}, "upper": 1e-3}],
      "load": [{"at": {"body": "rod", "x": 0.5}, "force": "sin(3*t)"}]},
    "mesh": {"elements": {"rod": 10}},
    "methods": {"mass": "consistent", "contact": {"name": "penalty", "stiffness": 1e4},
                "time": "newmark-dumont-paoli"},
    "step": 1e-3, "duration": 0.5, "samples": 40, "snapshots": 20})json");
}

}  // namespace

TEST_CASE("bodies are filmed in rows, and their stop holds a place of each") {
  const ScratchFolder folder;
  const CaseRecord record = run_in(two_rods(""), folder);
  const Snapshots film = film_of(record);
  REQUIRE(film.bodies.size() == 2);
  CHECK(film.bodies[0] == std::pair<std::string, int>("rod", 0));
  const auto ball = static_cast<std::size_t>(film.bodies[1].second);
  CHECK(film.x.size() == ball + 1);
  CHECK(film.y[ball] > film.y[0]);     // the rod goes upwards to it
  CHECK(film.x[ball] == Approx(0.3));  // and stands across from it
  REQUIRE(film.stops.size() == 1);
  CHECK(film.stops[0].name == "gap");
  CHECK(film.stops[0].to == static_cast<double>(ball));
  CHECK(film.stops[0].at == Approx(0.3 * static_cast<double>(ball - 1)));
  CHECK(film.held == std::vector<int>{0, static_cast<int>(ball) - 1});
  // Supported ends stay where they are, and nothing moves along the rod.
  for (std::size_t k = 0; k < film.t.size(); ++k)
    for (std::size_t p = 0; p < film.x.size(); ++p) {
      const std::size_t at = 2 * (k * film.x.size() + p);
      CHECK(film.displacement[at] == 0);
      if (p == 0 || p + 1 == ball) CHECK(film.displacement[at + 1] == 0);
    }
}

TEST_CASE("a beam in two planes is filmed in both, and every side of a clearance has its direction") {
  const ScratchFolder folder;
  Json text = two_rods("\"planes\": 2,");
  text["scene"]["structure"] = text["scene"]["bodies"]["rod"];
  text["scene"].erase("bodies");
  text["mesh"]["elements"] = 10;
  text["scene"]["stops"] =
      Json::parse(R"([{"name": "plate", "at": {"x": 0.5}, "clearance": {"radius": 1, "sides": 8}}])");
  text["scene"]["load"] = Json::parse(R"([{"at": {"x": 0.5, "component": "uz"}, "force": "1"}])");
  text["methods"]["contact"] = "signorini";
  const Snapshots film = film_of(run_in(text, folder));
  CHECK(film.axes == std::array<std::size_t, 2>{2, 1});
  CHECK(film.values() == 2 * film.x.size());
  REQUIRE(film.stops.size() == 4);
  for (const Snapshots::Stop& stop : film.stops) {
    CHECK(stop.name == "plate");
    CHECK(std::hypot(stop.direction[0], stop.direction[1]) == Approx(1));
  }
  // A push along z moves it along z alone.
  bool moved = false;
  for (std::size_t i = 0; i < film.displacement.size(); i += 2) {
    moved = moved || film.displacement[i] != 0;
    CHECK(film.displacement[i + 1] == 0);
  }
  CHECK(moved);
}
