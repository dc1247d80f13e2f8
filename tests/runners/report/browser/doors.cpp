// A click on what is drawn of a case, or Enter on its row, opens the case. The film moves.
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>

#include "tests/places.hpp"
#include "tests/runners/report/browser/browser.hpp"
#include "tests/runners/report/browser/driven.hpp"
#include "tests/runners/scratch_folder.hpp"

using namespace ricochet;
using namespace ricochet::browser;
using Catch::Matchers::Contains;

namespace {

namespace fs = std::filesystem;

/// The study of a trajectory as the command reports it when something is different in it.
Page reported(const std::string& name, const browser::Json& change) {
  const fs::path folder = fs::path(tests::places().build) / "browser" / "doors" / name;
  fs::remove_all(folder);
  fs::create_directories(folder);
  browser::Json study =
      browser::Json::parse(read_text(tests::places().source + "/tests/runners/report/studies/trajectory.json"));
  study.merge_patch(change);
  write_text(folder / "study.json", study.dump(1));
  const std::string command = tests::places().command + " run '" + (folder / "study.json").string() + "' --out '" +
                              (folder / "there").string() + "' >'" + (folder / "said.txt").string() + "' 2>&1";
  INFO(command);
  REQUIRE(std::system(command.c_str()) != -1);
  REQUIRE(fs::exists(folder / "there" / "report.html"));
  return {name, read_text(folder / "there" / "report.html")};
}

/// Two masses on springs that files describe, let go against a stop, as the command reports them. `place`: x,y,z of the
/// second one, where the stop is.
Page reported_files(const std::string& name, const std::string& place) {
  const fs::path folder = fs::path(tests::places().build) / "browser" / "doors" / name;
  fs::remove_all(folder);
  fs::create_directories(folder);
  const std::string head = "%%MatrixMarket matrix array real symmetric\n2 2\n";
  write_text(folder / "K.mtx", head + "3\n-1\n3\n");
  write_text(folder / "M.mtx", head + "1\n0\n2\n");
  write_text(folder / "dofs.csv", "dof,node,component,x,y,z,held\n1,A,ux,0,0,0,\n2,B,ux," + place + ",\n");
  write_text(folder / "state.csv", "dof,displacement,velocity\n2,-0.3,0\n");
  write_text(folder / "study.json", R"json({
    "name": "files", "kind": "trajectory",
    "scene": {"structure": {"type": "assembled", "stiffness": "K.mtx", "mass": "M.mtx", "dofs": "dofs.csv",
                            "tip": {"node": "B", "component": "ux"}},
              "stops": [{"name": "wall", "at": {"node": "B", "component": "ux"}, "upper": 0.1}],
              "initial": {"file": "state.csv"}},
    "methods": {"mass": "consistent", "contact": ["signorini", {"name": "penalty", "stiffness": 100}],
                "time": "newmark-dumont-paoli"},
    "step": 1e-3, "duration": 8, "samples": 160, "snapshots": 80})json");
  const std::string command = tests::places().command + " run '" + (folder / "study.json").string() + "' --out '" +
                              (folder / "there").string() + "' >'" + (folder / "said.txt").string() + "' 2>&1";
  INFO(command);
  REQUIRE(std::system(command.c_str()) != -1);
  REQUIRE(fs::exists(folder / "there" / "report.html"));
  return {name, read_text(folder / "there" / "report.html")};
}

void check_film(const browser::Json& page) {
  const browser::Json& film = page.at("film");
  INFO(film);
  for (const browser::Json& state : film.at("states")) {
    // Half a count of the snapshot, and that the page's times and numbers are single ones.
    if (!state.at("curve").is_null())
      CHECK(state.at("tip").get<double>() ==
            Approx(state.at("curve").get<double>()).margin(0.51 * state.at("unit").get<double>()));
    CHECK_THAT(state.at("said").get<std::string>(), Contains("t = "));
  }
  CHECK(!film.at("states").back().at("curve").is_null());
  CHECK(film.at("stepped") == 2);
  CHECK(film.at("back") == 0);
  for (const char* what : {"playing", "stopped"}) CHECK(film.at(what) == true);
  CHECK(film.at("moved") > 0);
  CHECK(film.at("stage") > 100);
  CHECK(film.at("maps").size() == 2);
  for (const browser::Json& map : film.at("maps")) {
    CHECK(map.at("coloured") > 1000);
    CHECK((map.at("marks") > 0) == (map.at("impacts") > 0));
  }
}

}  // namespace

namespace ricochet::browser {

void require_doors(const browser::Json& page, const std::string& kind) {
  INFO(kind);
  // A click on a diagram or on basins opens an orbit or a cell, which have tests of their own.
  const bool swept = kind == "bifurcation" || kind == "basins";
  size_t doors = 0;
  for (const browser::Json& one : page.at("figures")) {
    if (swept || !one.contains("door") || one.at("door").is_null()) continue;
    const browser::Json& door = one.at("door");
    INFO(one.at("id") << ": " << door);
    ++doors;
    for (const char* what : {"opened", "one_of", "says_id"}) CHECK(door.at(what) == true);
    CHECK(door.at("facts") > 4);
    const std::string id = door.at("id"), command = door.at("commands")[0];
    CHECK_THAT(command, Catch::Matchers::StartsWith("ricochet case ") && Catch::Matchers::EndsWith(id));
    CHECK_THAT(door.at("commands")[1].get<std::string>(), Contains(id + " --study"));
  }
  CHECK((doors > 0) == !swept);
  INFO(page.at("row"));
  for (const char* what : {"opened", "next", "closed", "focus"}) CHECK(page.at("row").at(what) == true);
}

}  // namespace ricochet::browser

TEST_CASE("the film shows the state of the slider's instant, and its map where points are pushed",
          "[report][browser]") {
  if (left_out()) return;
  const browser::Json said = read_back("film", {reported("mass", {{"snapshots", 150}, {"samples", 300}}),
                                                {"beam", read_text(report_of("studies", "film"))}});
  check_film(said.at("mass"));
  check_film(said.at("beam"));
  CHECK_THAT(said.at("beam").at("film").at("scale").get<std::string>(), Contains("times as large as lengths"));
}

TEST_CASE("films of matrices show nodes on their plane, or bars where no node has a place", "[report][browser]") {
  if (left_out()) return;
  const browser::Json said = read_back("films", {reported_files("nodes", "1,0,0"), reported_files("bars", "0,0,0")});
  check_film(said.at("nodes"));
  check_film(said.at("bars"));
  CHECK_THAT(said.at("nodes").at("film").at("scale").get<std::string>(), Contains("times as large as lengths"));
  CHECK_THAT(said.at("bars").at("film").at("scale").get<std::string>(), !Contains("times as large as lengths"));
}
