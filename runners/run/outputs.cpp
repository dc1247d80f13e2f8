#include "runners/run/outputs.hpp"

#include <algorithm>
#include <vector>

#include "runners/kinds/kind.hpp"
#include "runners/kinds/trajectory/minimal_study.hpp"
#include "runners/store/atomic_file.hpp"
#include "runners/store/csv.hpp"

namespace ricochet {
namespace {

void write_curves(const std::filesystem::path& folder, const StudyResults& results,
                  const std::set<std::string>* changed) {
  make_folder(folder);
  for (const CaseRecord& record : results.cases) {
    const std::filesystem::path file = folder / (record.id + ".csv");
    if (record.curve.names.empty()) continue;
    if (changed != nullptr && changed->count(record.id) == 0 && std::filesystem::exists(file)) continue;
    write_file(file, curve_csv(record.curve));
  }
}

/// Only files named like a case: ten hexadecimal digits.
bool is_case_file(const std::filesystem::path& file, const char* extension) {
  constexpr std::size_t digits = 10;
  const std::string stem = file.stem().string();
  return file.extension() == extension && stem.size() == digits &&
         stem.find_first_not_of("0123456789abcdef") == std::string::npos;
}

void remove_stale_curves(const std::filesystem::path& folder, const StudyResults& results) {
  std::vector<std::filesystem::path> stale;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    const auto has_curve = [&](const CaseRecord& record) {
      return record.id == entry.path().stem().string() && !record.curve.names.empty();
    };
    if (is_case_file(entry.path(), ".csv") && std::none_of(results.cases.begin(), results.cases.end(), has_curve))
      stale.push_back(entry.path());
  }
  for (const auto& file : stale) std::filesystem::remove(file, ignored);
}

void write_derived(const std::filesystem::path& folder, const StudyResults& results) {
  for (const DerivedTable& table : results.derived) write_file(folder / (table.name + ".csv"), derived_csv(table));
}

void write_numbers(const std::filesystem::path& folder, const StudyResults& results) {
  for (const std::string& name : exported_tables(results)) {
    FileWriter file(folder / (name + ".csv"));
    write_numbers_csv(results, name, [&](std::string_view piece) { file.write(piece); });
    file.commit();
  }
}

/// failures/ID.json, one study per case that went wrong; files of cases that do no longer are removed.
void write_failures(const std::filesystem::path& folder, const StudyResults& results) {
  constexpr int indent = 2;
  const auto replace = nlohmann::ordered_json::error_handler_t::replace;
  std::set<std::string> wanted;
  const Kind* kind = find_kind(results.kind);
  if (!kind || !kind->alone || !results.study.contains("scene")) return;  // nothing to make a study of
  for (const CaseRecord& record : results.cases) {
    if (!went_wrong(record)) continue;
    const auto study = kind->alone(results, record);
    if (study.is_null()) continue;
    if (wanted.empty()) make_folder(folder);
    wanted.insert(record.id);
    write_file(folder / (record.id + ".json"), study.dump(indent, ' ', false, replace) + '\n');
  }
  std::vector<std::filesystem::path> stale;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored))
    if (is_case_file(entry.path(), ".json") && wanted.count(entry.path().stem().string()) == 0)
      stale.push_back(entry.path());
  for (const auto& file : stale) std::filesystem::remove(file, ignored);
}

}  // namespace

void write_outputs(const std::filesystem::path& folder, const StudyResults& results, const RenderReport& render,
                   const std::set<std::string>* changed) {
  constexpr int indent = 2;
  const auto replace = nlohmann::ordered_json::error_handler_t::replace;
  write_file(folder / "study.json", results.study.dump(indent, ' ', false, replace) + '\n');
  write_curves(folder / "curves", results, changed);
  remove_stale_curves(folder / "curves", results);
  write_file(folder / "cases.csv", cases_csv(results));
  write_derived(folder, results);
  write_numbers(folder, results);
  write_failures(folder / "failures", results);
  write_file(folder / "report.html", render(results));
}

void write_tables(const std::filesystem::path& folder, const StudyResults& results) {
  make_folder(folder);
  write_curves(folder / "curves", results, nullptr);
  write_file(folder / "cases.csv", cases_csv(results));
  write_derived(folder, results);
  write_numbers(folder, results);
  write_file(folder / "measures.csv", measures_csv());
  write_file(folder / "left_out.csv", left_out_csv(results));
  write_file(folder / "notes.csv", notes_csv(results));
  write_file(folder / "environment.csv", environment_csv(results.environment));
}

}  // namespace ricochet
