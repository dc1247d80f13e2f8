#include "runners/execution/outputs.hpp"

#include <catch2/catch.hpp>

#include "tests/runners/scratch_folder.hpp"

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
  record.numbers = {{"points", {"parameter", "start"}, {{0.07, 0.08}, {0, 1}}, {{"start", {"rest", "up"}}}},
                    {"portraits", {"time"}, {{0.5}}, {}, false}};
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

TEST_CASE("outputs: a sweep that went wrong is no single run to repeat") {
  const ScratchFolder folder;
  StudyResults results = results_with_points();
  results.study = {{"scene", nlohmann::ordered_json::object()}};
  results.cases[0].status = "failed";
  results.cases[0].axes.emplace_back("steps_per_period", 2000);
  write_outputs(folder.path(), results, [](const StudyResults&) { return std::string("page"); });
  CHECK_FALSE(std::filesystem::exists(folder / "failures"));
}
