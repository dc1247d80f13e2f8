#include "runners/run/outputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <vector>

#include "runners/kinds/kind.hpp"
#include "runners/run/curve_outputs.hpp"
#include "runners/store/atomic_file.hpp"
#include "runners/store/curve_files.hpp"
#include "runners/store/record_tables.hpp"
#include "runners/store/record_values.hpp"
#include "runners/store/store_error.hpp"
#include "runners/table/csv_text.hpp"
#include "runners/table/dictionary.hpp"

namespace ricochet {
namespace {

/// The tables that a folder's dictionary tells of: what stands before the first comma of its lines.
std::set<std::string> told_tables(const std::filesystem::path& dictionary) {
  std::set<std::string> names;
  std::ifstream lines(dictionary);
  for (std::string line; std::getline(lines, line);)
    if (const std::string name = line.substr(0, line.find(','));
        !name.empty() && name.find_first_not_of("abcdefghijklmnopqrstuvwxyz_") == std::string::npos)
      names.insert(name);
  return names;
}

/// The tables of one folder, each written as CSV and remembered for the dictionary.
class TableFolder {
 public:
  explicit TableFolder(const std::filesystem::path& folder)
      : folder_(folder), before_(told_tables(folder / "dictionary.csv")) {}

  void write(const Table& table) {
    write_file(file(table), table_csv(table));
    remember(table);
  }
  void write_numbers(const StudyResults& results) {
    for (const Table& head : number_heads(results)) {
      FileWriter file(this->file(head));
      write_numbers_csv(results, head, [&](std::string_view piece) { file.write(piece); });
      file.commit();
      remember(head);
    }
  }
  /// A table that was written elsewhere; one without columns is none.
  void remember(const Table& table) {
    if (!table.columns.empty()) heads_.push_back({table.name, table.text, table.columns, {}});
  }
  /// Last, when every table is known.
  void write_dictionary() {
    Table dictionary = dictionary_of(heads_);
    dictionary.rows.push_back(
        {"v_cases", "", "",
         "A view in results.sqlite: the finished cases, with the columns of cases by the same names, truth values as 0 "
         "and 1. Curves and long tables are packed there (little-endian doubles), which SQL cannot read: take theirs "
         "from the files of this folder."});
    write(dictionary);
  }
  /// Those of an earlier study of this folder, or of what this one was, that no longer are. What an export wrote beside
  /// stays.
  void remove_stale_tables() {
    for (const char* one : {"measures", "left_out", "notes", "environment", "curves", "table"}) before_.erase(one);
    for (const Table& head : heads_) before_.erase(head.name);
    std::error_code ignored;
    for (const std::string& name : before_) std::filesystem::remove(folder_ / (name + ".csv"), ignored);
  }

 private:
  std::filesystem::path file(const Table& table) const { return folder_ / (table.name + ".csv"); }

  const std::filesystem::path& folder_;
  std::set<std::string> before_;
  std::vector<Table> heads_;
};

/// What every results folder has beside its curves, and what an export begins with.
void write_results(TableFolder& tables, const StudyResults& results, const Table& curves) {
  tables.write(cases_table(results));
  tables.remember(curves);
  for (const Table& table : results.derived) tables.write(table);
  tables.write_numbers(results);
}

void write_study(const std::filesystem::path& folder, const StudyResults& results) {
  constexpr int indent = 2;
  const auto replace = nlohmann::ordered_json::error_handler_t::replace;
  write_file(folder / "study.json", results.study.dump(indent, ' ', false, replace) + '\n');
}

/// Tables of another study are not mixed with these: study.json says whose they are.
void refuse_foreign_tables(const std::filesystem::path& folder, const StudyResults& results) {
  std::error_code ignored;
  if (!std::filesystem::exists(folder / "cases.csv", ignored) && !std::filesystem::exists(folder / "curves", ignored))
    return;
  std::ifstream stream(folder / "study.json");
  const auto there = nlohmann::ordered_json::parse(stream, nullptr, false);
  if (there == results.study || (there.is_object() && there.value("name", "") == results.name)) return;
  const std::string whose = there.is_object() && there.contains("name") ? "of the study " + there["name"].dump()
                                                                        : "of a study that it does not name";
  throw StoreError(fmt::format("{}: this folder holds tables {}, not of \"{}\"; choose an empty or a new folder",
                               folder.string(), whose, results.name));
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
  remove_stale(folder, ".json", wanted);
}

}  // namespace

void write_outputs(const std::filesystem::path& folder, const StudyResults& results, const RenderReport& render,
                   const std::set<std::string>* changed) {
  write_study(folder, results);
  write_curve_files(folder, results, changed);
  TableFolder tables(folder);
  write_results(tables, results, has_curve_files(results) ? curves_head(results) : Table());
  tables.write_dictionary();
  tables.remove_stale_tables();
  write_failures(folder / "failures", results);
  write_file(folder / "report.html", render(results));
}

void write_tables(const std::filesystem::path& folder, const StudyResults& results, bool one_file) {
  refuse_foreign_tables(folder, results);
  make_folder(folder);
  write_study(folder, results);
  Table curves;
  if (one_file) {
    remove_curve_files(folder);
    curves = write_curve_table(folder, results);
  } else {
    remove_curve_table(folder);
    write_curve_files(folder, results, nullptr);
    if (has_curve_files(results)) curves = curves_head(results);
  }
  TableFolder tables(folder);
  write_results(tables, results, curves);
  tables.write(measures_table());
  tables.write(left_out_table(results));
  tables.write(notes_table(results));
  tables.write(environment_table(results.environment));
  tables.write_dictionary();
}

}  // namespace ricochet
