#include "runners/run/outputs.hpp"

#include <catch2/catch.hpp>
#include <cstdio>
#include <fstream>

#include "runners/store/atomic_file.hpp"
#include "runners/store/store.hpp"
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
  record.id = "c0123456789";
  record.axes = {{"mass", "singular"}};
  record.status = Status::done;
  record.numbers = {
      {"points", named_columns({"parameter", "start"}), {{0.07, 0.08}, {0, 1}}, {{"start", {"rest", "up"}}}},
      {"portraits", named_columns({"time"}), {{0.5}}, {}, false}};
  results.cases = {record};
  return results;
}

constexpr const char* points =
    "case,mass,parameter,start\nc0123456789,singular,0.07,rest\nc0123456789,singular,0.08,up\n";

}  // namespace

TEST_CASE("outputs: tables of numbers stand beside cases.csv, those for the report alone do not") {
  const ScratchFolder folder;
  write_outputs(folder.path(), results_with_points(), [] { return std::string("page"); });
  CHECK(read_text(folder / "points.csv") == points);
  CHECK_FALSE(std::filesystem::exists(folder / "portraits.csv"));
  CHECK(std::filesystem::exists(folder / "cases.csv"));
  write_tables(folder / "export", results_with_points());
  CHECK(read_text(folder / "export/points.csv") == points);
}

TEST_CASE(
    "outputs: of tables that the folder had, those that the results have no longer go, and a third party's stay") {
  const ScratchFolder folder;
  const auto page = [] { return std::string("page"); };
  write_outputs(folder.path(), results_with_points(), page);
  for (const char* name : {"mine.csv", "notes.csv"}) std::ofstream(folder / name) << "a,b\n1,2\n";
  REQUIRE(std::filesystem::exists(folder / "points.csv"));
  StudyResults other = results_with_points();
  other.name = "another";
  other.cases[0].numbers.clear();
  write_outputs(folder.path(), other, page);
  CHECK_FALSE(std::filesystem::exists(folder / "points.csv"));
  for (const char* name : {"mine.csv", "notes.csv", "cases.csv", "dictionary.csv"})
    CHECK(std::filesystem::exists(folder / name));
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
  CHECK(std::filesystem::exists(folder / "tables/curves/c0123456789.csv"));
  // The same study again, with fewer cases: none of what it had before stays.
  one.cases.clear();
  write_tables(folder / "tables", one);
  CHECK_FALSE(std::filesystem::exists(folder / "tables/curves/c0123456789.csv"));
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
    record.status = Status::diverged;
    results.cases.push_back(record);
  }
  REQUIRE(results.cases.size() > 1);
  write_outputs(folder.path(), results, [] { return std::string("page"); });
  for (const CaseRecord& record : results.cases) {
    const Study alone = parse(read_text(folder / ("failures/" + record.id + ".json")));
    REQUIRE(alone.cases.size() == 1);
    CHECK(alone.cases.front().id == record.id);
    CHECK(alone.kind == study.kind);
  }
}

namespace {

/// So many cases with a curve of two samples, the last but one with a series that the others have not.
StudyResults results_with_curves(std::size_t count) {
  StudyResults results;
  results.name = "many";
  results.study = {{"name", "many"}};
  results.kind = "trajectory";
  results.columns = {"step"};
  for (std::size_t i = 0; i < count; ++i) {
    CaseRecord record;
    char id[24];
    std::snprintf(id, sizeof id, "c%010zx", i);
    record.id = id;
    record.axes = {{"step", static_cast<double>(i)}};
    record.status = Status::done;
    record.curve = {{"t", "energy"}, {{0, 0.5}, {1.0 / 3, static_cast<double>(i)}}};
    if (i + 2 == count) record.curve = {{"t", "force"}, {{0, 0.5}, {7, 8}}};
    results.cases.push_back(std::move(record));
  }
  results.expected_cases = static_cast<int>(count);
  return results;
}

std::string dictionary_in(const std::filesystem::path& folder) {
  return read_text(folder / "dictionary.csv");
}

}  // namespace

TEST_CASE("outputs: of more cases than a folder is to have files no curve is written, and none of before stays") {
  const ScratchFolder folder;
  const auto write = [&](const StudyResults& results) {
    write_outputs(folder.path(), results, [&] { return where_curves_are(results); });
  };
  CHECK(has_curve_files(results_with_curves(kMostCurveFiles)));
  CHECK_FALSE(has_curve_files(results_with_curves(kMostCurveFiles + 1)));
  StudyResults refused = results_with_curves(kMostCurveFiles + 1);
  refused.cases.front().curve = {};
  CHECK(has_curve_files(refused));

  write(results_with_curves(3));
  CHECK(std::filesystem::exists(folder / "curves/c0000000002.csv"));
  CHECK_THAT(dictionary_in(folder.path()), Catch::Contains("curves,energy"));
  CHECK(read_text(folder / "report.html") == "each case has its own in curves/ID.csv");
  write(results_with_curves(kMostCurveFiles + 1));
  CHECK_FALSE(std::filesystem::exists(folder / "curves"));
  CHECK_THAT(dictionary_in(folder.path()), !Catch::Contains("curves,energy"));
  CHECK_THAT(read_text(folder / "report.html"), Catch::Contains("ricochet export") && Catch::Contains("--curves"));
  write(results_with_curves(3));
  CHECK(std::filesystem::exists(folder / "curves/c0000000002.csv"));
}

TEST_CASE("outputs: all curves in one table are those of the files, case by case") {
  const ScratchFolder folder;
  const StudyResults results = results_with_curves(4);
  {
    Store store(folder / "store", false);
    std::vector<ExpectedCase> expected;
    for (const CaseRecord& record : results.cases) expected.push_back({record.id, "f" + record.id});
    store.begin(results, expected);
    store.save(results.cases);
  }
  write_tables(folder / "csv", read_store(folder / "store"));
  CHECK(std::filesystem::exists(folder / "csv/curves/c0000000000.csv"));
  write_tables(folder / "csv", read_store(folder / "store"), true);
  CHECK_FALSE(std::filesystem::exists(folder / "csv/curves"));
  CHECK(read_text(folder / "csv/curves.csv") ==
        "case,t,energy,force\n"
        "c0000000000,0,0.3333333333333333,\nc0000000000,0.5,0,\n"
        "c0000000001,0,0.3333333333333333,\nc0000000001,0.5,1,\n"
        "c0000000002,0,,7\nc0000000002,0.5,,8\n"
        "c0000000003,0,0.3333333333333333,\nc0000000003,0.5,3,\n");
  CHECK_THAT(dictionary_in(folder / "csv"), Catch::Contains("curves,case") && Catch::Contains("curves,force"));
  write_tables(folder / "csv", read_store(folder / "store"));
  CHECK_FALSE(std::filesystem::exists(folder / "csv/curves.csv"));
  CHECK(std::filesystem::exists(folder / "csv/curves/c0000000003.csv"));
}
