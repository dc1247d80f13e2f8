#include "runners/run/outputs.hpp"

#include <catch2/catch.hpp>

#include "tests/runners/scratch_folder.hpp"
#include "tests/runners/study/study_fixture.hpp"

using namespace ricochet;

namespace {

StudyResults results_with_points() {
  StudyResults results;
  results.name = "sweep";
  results.kind = "bifurcation";
  results.columns = {"mass"};
  CaseRecord record;
  record.id = "0123456789";
  record.axes = {{"mass", "singular"}};
  record.status = "done";
  record.numbers = {
      {"points", named_columns({"parameter", "start"}), {{0.07, 0.08}, {0, 1}}, {{"start", {"rest", "up"}}}},
      {"portraits", named_columns({"time"}), {{0.5}}, {}, false}};
  results.cases = {record};
  return results;
}

constexpr const char* points =
    "case,mass,parameter,start\n0123456789,singular,0.07,rest\n0123456789,singular,0.08,up\n";

}  // namespace

TEST_CASE("outputs: tables of numbers stand beside cases.csv, those for the report alone do not") {
  const ScratchFolder folder;
  write_outputs(folder.path(), results_with_points(), [](const StudyResults&) { return std::string("page"); });
  CHECK(read_text(folder / "points.csv") == points);
  CHECK_FALSE(std::filesystem::exists(folder / "portraits.csv"));
  CHECK(std::filesystem::exists(folder / "cases.csv"));
  write_tables(folder / "export", results_with_points());
  CHECK(read_text(folder / "export/points.csv") == points);
}

TEST_CASE("outputs: tables of one study are not written over those of another") {
  const ScratchFolder folder;
  StudyResults one = results_with_points(), other = results_with_points();
  one.study = {{"name", "sweep"}};
  one.cases[0].curve = {{"t"}, {{0, 1}}};
  other.name = "other";
  other.study = {{"name", "other"}};
  std::filesystem::create_directory(folder / "tables");
  write_text(folder / "tables/notes.txt", "what somebody keeps there");
  write_tables(folder / "tables", one);
  CHECK_THROWS_WITH(write_tables(folder / "tables", other),
                    Catch::Contains("of the study \"sweep\", not of \"other\"") && Catch::Contains("folder"));
  CHECK(std::filesystem::exists(folder / "tables/curves/0123456789.csv"));
  // The same study again, with fewer cases: none of what it had before stays.
  one.cases.clear();
  write_tables(folder / "tables", one);
  CHECK_FALSE(std::filesystem::exists(folder / "tables/curves/0123456789.csv"));
  std::filesystem::remove(folder / "tables/study.json");
  CHECK_THROWS_WITH(write_tables(folder / "tables", one), Catch::Contains("that it does not name"));
}

TEST_CASE("outputs: a sweep that went wrong leaves a study of that case alone, which is that case") {
  using namespace ricochet::tests;
  const ScratchFolder folder;
  Json text = small_sweep();
  SECTION("a number of the scene, beside an axis of the scene") {
    text["scene"]["support"]["pulsation"] = {10, 12};
  }
  SECTION("a parameter of the method") {
    text["methods"]["contact"] = Json::array({"rigid", {{"name", "spring"}, {"stiffness", 1000}}});
    text["parameter"] = {{"pointer", "/methods/contact/stiffness"}, {"values", {10, 100}}};
  }
  SECTION("a grid") {
    text = small_basins();
    text["steps_per_period"] = {1000, 2000};
  }
  const Study study = parse(text);
  StudyResults results;
  results.name = study.name;
  results.kind = study.kind;
  results.study = study.resolved;
  results.columns = study.columns;
  for (const StudyCase& one : study.cases) {
    if (one.excluded) continue;
    CaseRecord record;
    record.id = one.id;
    record.axes = one.axes;
    record.status = "diverged";
    results.cases.push_back(record);
  }
  REQUIRE(results.cases.size() > 1);
  write_outputs(folder.path(), results, [](const StudyResults&) { return std::string("page"); });
  for (const CaseRecord& record : results.cases) {
    const Study alone = parse(read_text(folder / ("failures/" + record.id + ".json")));
    REQUIRE(alone.cases.size() == 1);
    CHECK(alone.cases.front().id == record.id);
    CHECK(alone.kind == study.kind);
  }
}
