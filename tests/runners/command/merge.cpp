/// Folders of one study joined: what comes out is what one run leaves, or nothing does.
#include <SQLiteCpp/SQLiteCpp.h>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <set>

#include "runners/store/checksums.hpp"
#include "runners/store/folder_lock.hpp"
#include "runners/store/read_store.hpp"
#include "runners/store/store.hpp"
#include "tests/runners/command/said.hpp"
#include "tests/runners/same_tables.hpp"

using namespace ricochet;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

std::string merge_study(const std::string& kind) {
  auto study = nlohmann::ordered_json::parse(R"({
    "name": "joined",
    "scene": {"structure": {"type": "beam", "length": 1.501, "young": 2e11, "density": 8000,
                            "section": {"type": "tube", "outer_diameter": 0.01, "wall": 0.0005}, "damping": {"stiffness": 1e-4}},
              "stops": {"lower": -0.1, "upper": 0.1, "at": "tip"}},
    "mesh": {"elements": 4},
    "methods": {"mass": ["consistent", {"name": "singular", "velocity": "P1"}], "contact": "signorini", "time": "newmark-dumont-paoli"}
  })");
  study["kind"] = kind;
  if (kind == "bifurcation") {
    study["scene"]["support"] = {{"amplitude", 0.08}, {"pulsation", 10}};
    study["mesh"]["elements"] = {3, 4};
    study.update(nlohmann::ordered_json::parse(R"({
      "parameter": {"pointer": "/scene/support/amplitude", "from": 0.07, "to": 0.1, "count": 5},
      "steps_per_period": 200, "start": ["rest", "up"], "transient": {"periods": 40, "at_most": 80}, "keep": 20,
      "refine": 0.002})"));
    return study.dump();
  }
  study["scene"]["initial"] = {{"displacement", "0.04*x^2"}, {"velocity", "-2*x"}};
  study["methods"]["mass"].push_back("lumped");
  study["exclude"] = {{{"mass", "lumped"}, {"step", 1e-4}, {"why", "not wanted"}}};
  study["step"] = {4e-4, 2e-4, 1e-4};
  study["duration"] = kind == "trajectory" ? 0.3 : 0.1;
  if (kind == "convergence") study["reference"] = "self";
  return study.dump();
}

void run_parts(const ScratchFolder& here, int of) {
  for (int number = 1; number <= of; ++number) {
    const std::string part = std::to_string(number);
    const CommandOutput said =
        say(here, "run study.json --part " + part + "/" + std::to_string(of) + " --out parts/" + part);
    INFO(said.out << said.err);
    REQUIRE(said.code == 0);
  }
}

/// Two parts of a trajectory in parts/1 and parts/2.
class TwoParts {
 public:
  TwoParts() {
    write_text(here / "study.json", merge_study("trajectory"));
    run_parts(here, 2);
  }
  /// Changes what the store of one part holds.
  void change(const std::string& part, const std::string& sql) const {
    SQLite::Database store((here / ("parts/" + part + "/results.sqlite")).string(), SQLite::OPEN_READWRITE);
    REQUIRE(store.exec(sql) > 0);
    // As if it had been stored so.
    seal_cases(store, "");
    seal_study(store);
  }
  /// The message of a merge that is refused with this code, and leaves nothing.
  std::string refused(const std::string& folders, int code) const {
    const CommandOutput said = say(here, "merge " + folders + " --out all");
    INFO(said.err << said.out);
    CHECK(said.code == code);
    CHECK(said.out.empty());
    CHECK_FALSE(fs::exists(here / "all"));
    CHECK_FALSE(fs::exists(here / ".all.merging"));
    return said.err;
  }
  std::string some_case(const std::string& part) const {
    return StoreReader(here / ("parts/" + part)).finished().front().id;
  }
  ScratchFolder here;
};

std::set<std::string> shared_keys(const fs::path& folder) {
  const StoreReader reader(folder);
  const auto keys = reader.motion_keys(reader.finished().front().arithmetic);
  return {keys.begin(), keys.end()};
}

}  // namespace

TEST_CASE("merge: three parts are what one run leaves, in every table and in the answer") {
  const std::string kind = GENERATE("trajectory", "convergence", "bifurcation");
  CAPTURE(kind);
  const ScratchFolder here;
  write_text(here / "study.json", merge_study(kind));
  const CommandOutput one = say(here, "run study.json --out one");
  INFO(one.err);
  REQUIRE(one.code == 0);
  run_parts(here, 3);
  const CommandOutput merged = say(here, "merge parts/3 parts/1 parts/2 --out all/of/it/");
  INFO(merged.err);
  REQUIRE(merged.code == 0);
  CHECK_THAT(merged.out, Contains("merged from 3 folders") && !Contains("in none of") && !Contains("part "));
  same_tables::check_same(here / "one", here / "all/of/it");
  same_tables::check_same(here / "all/of/it", here / "one");
  CHECK(read_text(here / "one/study.json") == read_text(here / "all/of/it/study.json"));
  const CommandOutput compared = say(here, "compare one all/of/it");
  CHECK_THAT(compared.out, Contains("The results are equal to the last bit.") && Contains("answer: the same lines") &&
                               Contains("environment: the same"));
  const StudyResults all = read_store(here / "all/of/it"), single = read_store(here / "one");
  CHECK(all.part.whole());
  CHECK(all.expected_cases == single.expected_cases);
  CHECK(all.study == single.study);
  if (kind == "convergence") CHECK_FALSE(shared_keys(here / "one").empty());
  CHECK(shared_keys(here / "all/of/it") == shared_keys(here / "one"));
  // A run finds nothing to do.
  const CommandOutput again = say(here, "run study.json --out all/of/it");
  CHECK(again.code == 0);
  CHECK_THAT(again.err, Contains(", 0 to run") && !Contains("aside"));
}

TEST_CASE("merge: what is missing is counted, and a run in the merged folder adds it") {
  const ScratchFolder here;
  write_text(here / "study.json", merge_study("trajectory"));
  run_parts(here, 3);
  const CommandOutput merged = say(here, "merge parts/1 parts/3 --out all");
  CHECK(merged.code == 0);
  const std::string go_on = "run all/study.json --out all";
  CHECK_THAT(merged.out, Contains("3 of 9 cases are in none of these folders: `ricochet " + go_on + "` goes on"));
  CHECK_THAT(read_text(here / "all/report.html"), Contains("Partial results: 6 of 9 cases so far"));
  const CommandOutput more = say(here, go_on);
  CHECK(more.code == 0);
  CHECK_THAT(more.err, Contains("6 finished before, 3 to plan and run"));
  CHECK(say(here, "run study.json --out one").code == 0);
  same_tables::check_same(here / "one", here / "all");
  // A whole folder beside its parts: every case is there twice, and once in what comes out.
  const CommandOutput twice = say(here, "merge one parts/2 all --out both");
  CHECK(twice.code == 0);
  same_tables::check_same(here / "one", here / "both");
}

TEST_CASE("merge: a case that two folders have differently is named, and nothing is written") {
  TwoParts parts;
  fs::copy(parts.here / "parts/2", parts.here / "parts/other", fs::copy_options::recursive);
  const std::string id = parts.some_case("2"), where = " WHERE case_id = '" + id + "'";
  parts.change("other", "UPDATE cases SET run_seconds = 17, setup_seconds = 17");
  parts.change("other", "UPDATE measures SET value = 17 WHERE name = 'microseconds_per_step'");
  REQUIRE(say(parts.here, "merge parts/* --out times").code == 0);
  SECTION("a measure") {
    parts.change("other", "UPDATE measures SET value = value * (1 + 1e-15) + 1e-300" + where + " AND name = 'impulse'");
  }
  SECTION("a sample of the curve") {
    parts.change("other", "UPDATE curves SET series = zeroblob(length(series))" + where + " AND name != 't'");
  }
  SECTION("the status") {
    parts.change("other", "UPDATE cases SET status = 'diverged' WHERE id = '" + id + "'");
  }
  CHECK_THAT(parts.refused("parts/1 parts/2 parts/other", 2),
             Contains("parts/other: its case " + id + " is not that of parts/2: "));
}

TEST_CASE("merge: folders that one run would not have left are refused, with the folder and the cause") {
  TwoParts parts;
  SECTION("another study") {
    parts.change("2", "UPDATE study SET value = '\"other\"' WHERE key = 'name'");
    CHECK_THAT(parts.refused("parts/1 parts/2", 2),
               Contains("parts/2: it holds the study \"other\", and parts/1 holds \"joined\""));
  }
  SECTION("another version of the study") {
    write_text(parts.here / "edited.json", merge_study("convergence"));
    REQUIRE(say(parts.here, "run edited.json --part 2/2 --out parts/edited").code == 0);
    CHECK_THAT(
        parts.refused("parts/1 parts/edited", 2),
        Contains("parts/edited: it holds another version of the study \"joined\" than parts/1: they differ at /"));
  }
  SECTION("another program") {
    parts.change("2", "UPDATE cases SET fingerprint = 'f' || fingerprint");
    parts.change("2", "UPDATE environment SET value = 'of long ago' WHERE name = 'commit'");
    CHECK_THAT(parts.refused("parts/1 parts/2", 2),
               Contains("parts/2: its case " + parts.some_case("2") + " was computed by another program") &&
                   Contains("commit is of long ago there and "));
  }
  SECTION("another arithmetic") {
    parts.change("2", "UPDATE cases SET arithmetic = 'beef' WHERE status = 'done'");
    CHECK_THAT(parts.refused("parts/1 parts/2", 2),
               Contains("parts/2: its case ") && Contains("(arithmetic beef) than those of parts/1"));
  }
  SECTION("no results") {
    fs::create_directory(parts.here / "parts/none");
    CHECK_THAT(parts.refused("parts/1 parts/none", 5), Contains("parts/none: there is no results.sqlite here"));
    CHECK(fs::is_empty(parts.here / "parts/none"));
  }
  SECTION("a damaged store") {
    write_text(parts.here / "parts/2/results.sqlite",
               "this is no store, and longer than the header of one would be: " + std::string(200, '.'));
    CHECK_THAT(parts.refused("parts/1 parts/2", 5), Contains("parts/2/results.sqlite"));
  }
  SECTION("a run under way") {
    const FolderLock run(parts.here / "parts/2");
    CHECK_THAT(parts.refused("parts/1 parts/2", 5), Contains("parts/2: another run is using this folder"));
  }
  SECTION("a folder twice") {
    CHECK_THAT(parts.refused("parts/1 parts/2 ./parts/1/", 2), Contains("./parts/1/: this folder is named twice"));
  }
  SECTION("no folder to write") {
    CHECK_THAT(say(parts.here, "merge parts/1 parts/2").err, Contains("merge expects --out DIR"));
  }
}

TEST_CASE("merge: a folder that holds something is not written to, an empty one is") {
  TwoParts parts;
  const std::string before = read_text(parts.here / "parts/1/results.sqlite");
  for (const std::string out : {"parts/1", "study.json", "parts"}) {
    const CommandOutput said = say(parts.here, "merge parts/1 parts/2 --out " + out);
    CHECK(said.code == 2);
    CHECK_THAT(said.err, Contains(out + ": it is there, and not an empty folder"));
  }
  CHECK(read_text(parts.here / "parts/1/results.sqlite") == before);
  fs::create_directory(parts.here / "all");
  // What a killed merge left is in nobody's way.
  fs::create_directory(parts.here / ".all.merging");
  write_text(parts.here / ".all.merging/results.sqlite", "half");
  CHECK(say(parts.here, "merge parts/1 parts/2 --out all").code == 0);
  CHECK(read_store(parts.here / "all").cases.size() == 9);
  CHECK_FALSE(fs::exists(parts.here / ".all.merging"));
  CHECK_FALSE(fs::exists(parts.here / "all/results.lock"));
}

TEST_CASE("merge: unfinished cases keep what one folder has of them, finished ones nothing") {
  TwoParts parts;
  const StoreReader reader(parts.here / "parts/1");
  const auto finished = reader.finished();
  REQUIRE(finished.size() > 2);
  const std::string lost = finished[0].fingerprint, kept = finished[1].fingerprint, by = finished[1].arithmetic;
  REQUIRE_FALSE(by.empty());
  const auto keep = [&](const std::string& part, const std::string& key, const std::string& content) {
    parts.change(part, "INSERT INTO motions VALUES('" + by + "/" + key + "', '" + content + "')");
  };
  parts.change("1", "DELETE FROM cases WHERE id = '" + finished[0].id + "'");
  keep("1", "orbits/" + lost + "/0", "first");
  keep("2", "orbits/" + lost + "/0", "second");
  keep("2", "orbits/" + lost + "/1", "second");
  keep("2", "orbits/" + kept + "/0", "of no use");
  keep("1", "shared", "a");
  keep("2", "also shared", "b");
  parts.change("2", "INSERT INTO motions VALUES('beef/other', 'of another arithmetic')");
  REQUIRE(say(parts.here, "merge parts/1 parts/2 --out all").code == 0);
  CHECK(shared_keys(parts.here / "all") == std::set<std::string>{"orbits/" + lost + "/0", "shared", "also shared"});
  CHECK(read_motion(parts.here / "all", "orbits/" + lost + "/0", by) == "first");
  CHECK(read_motion(parts.here / "all", "also shared", by) == "b");
}
