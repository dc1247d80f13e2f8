// Every dot is a door: a click on what is drawn of a case, or Enter on its row, opens the case, in a report of each
// kind; and the film moves.
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "tests/runners/report/browser/browser.hpp"
#include "tests/runners/scratch_folder.hpp"

using namespace ricochet;
using namespace ricochet::browser;
using Catch::Matchers::Contains;

namespace {

namespace fs = std::filesystem;

/// A study of tests/runners/report/studies as the command reports it; `change` is what is different in it.
Page reported(const std::string& kind, const std::string& name, const Json& change = Json::object()) {
  const fs::path folder = fs::path(RICOCHET_BINARY_DIR) / "browser" / "doors" / name;
  fs::remove_all(folder);
  fs::create_directories(folder);
  Json study = Json::parse(read_text(RICOCHET_SOURCE_DIR "/tests/runners/report/studies/" + kind + ".json"));
  study.merge_patch(change);
  write_text(folder / "study.json", study.dump(1));
  const std::string command = RICOCHET_COMMAND " run '" + (folder / "study.json").string() + "' --out '" +
                              (folder / "there").string() + "' >'" + (folder / "said.txt").string() + "' 2>&1";
  INFO(command);
  REQUIRE(std::system(command.c_str()) != -1);
  REQUIRE(fs::exists(folder / "there" / "report.html"));
  return {name, read_text(folder / "there" / "report.html")};
}

void check_doors(const Json& page, const std::string& kind) {
  INFO(kind);
  size_t doors = 0;
  for (const Json& one : page.at("figures")) {
    if (!one.contains("door") || one.at("door").is_null()) continue;
    const Json& door = one.at("door");
    INFO(one.at("id") << ": " << door);
    ++doors;
    for (const char* what : {"opened", "one_of", "says_id"}) CHECK(door.at(what) == true);
    CHECK(door.at("facts") > 4);
    const std::string id = door.at("id"), command = door.at("commands")[0];
    CHECK_THAT(command, Catch::Matchers::StartsWith("ricochet case ") && Catch::Matchers::EndsWith(id));
    CHECK_THAT(door.at("commands")[1].get<std::string>(), Contains(id + " --study"));
  }
  CHECK(doors > 0);
}

void check_row(const Json& page, const std::string& kind) {
  INFO(kind << " " << page.at("row"));
  for (const char* what : {"opened", "next", "closed", "focus"}) CHECK(page.at("row").at(what) == true);
}

void check_film(const Json& page) {
  const Json& film = page.at("film");
  INFO(film);
  for (const Json& state : film.at("states")) {
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
  for (const Json& map : film.at("maps")) {
    CHECK(map.at("coloured") > 1000);
    CHECK((map.at("marks") > 0) == (map.at("impacts") > 0));
  }
}

}  // namespace

TEST_CASE("every dot of every kind is a door to its case", "[report][browser]") {
  if (left_out()) return;
  const std::vector<std::string> marched = {"trajectory", "convergence", "work-precision", "stability"};
  const std::vector<std::string> swept = {"bifurcation", "basins"};
  std::vector<Page> pages;
  for (const std::string& kind : marched) pages.push_back(reported(kind, kind));
  for (const std::string& kind : swept) pages.push_back(reported(kind, kind));
  const Json said = read_back("doors-read", pages);
  for (const std::string& kind : marched) {
    check_doors(said.at(kind), kind);
    check_row(said.at(kind), kind);
  }
  for (const std::string& kind : swept) check_row(said.at(kind), kind);
  // What the page holds of a trajectory: its curves, its portrait, its impacts, its ledger.
  const Json& door = figure(said.at("trajectory"), "tip").at("door");
  CHECK(door.at("plots") == 4);
  for (const char* part : {"Phase portrait", "Measures", "Impacts", "Where its energy came from and went"})
    CHECK(says(door.at("headings"), part));
}

TEST_CASE("the film shows the state of the slider's instant, and its map where points are pushed",
          "[report][browser]") {
  if (left_out()) return;
  const Json beam = Json::parse(R"({
    "scene": {"structure": {"type": "beam", "length": 1.501, "young": 2.0e11, "density": 8000, "mass": null, "stiffness": null,
                            "force": null, "section": {"type": "tube", "outer_diameter": 0.01, "wall": 0.0005}},
              "initial": {"displacement": "0.04*x^2", "velocity": "-2*x"}},
    "mesh": {"elements": 10}, "methods": {"mass": ["consistent", "singular"], "contact": "signorini", "time": "newmark-dumont-paoli"},
    "step": 1e-4, "duration": 0.3, "snapshots": 100})");
  const Json said = read_back("film", {reported("trajectory", "mass", {{"snapshots", 150}, {"samples", 300}}),
                                       reported("trajectory", "beam", beam)});
  check_film(said.at("mass"));
  check_film(said.at("beam"));
  CHECK_THAT(said.at("beam").at("film").at("scale").get<std::string>(), Contains("times as large as lengths"));
}
