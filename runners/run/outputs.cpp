#include "runners/run/outputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <memory>
#include <vector>

#include "runners/kinds/kind.hpp"
#include "runners/store/atomic_file.hpp"
#include "runners/store/record_values.hpp"
#include "runners/study/case_id.hpp"
#include "runners/table/text.hpp"

namespace ricochet {
namespace {

/// The tables that a folder's dictionary tells of: what stands before the first comma of its lines.
std::set<std::string> told_tables(const std::filesystem::path& dictionary) {
  std::set<std::string> names;
  if (std::error_code ignored; !std::filesystem::is_regular_file(dictionary, ignored)) return names;
  std::ifstream lines(dictionary);
  for (std::string line; std::getline(lines, line);)
    if (const std::string name = line.substr(0, line.find(','));
        !name.empty() && name.find_first_not_of("abcdefghijklmnopqrstuvwxyz_") == std::string::npos)
      names.insert(name);
  return names;
}

/// dictionary: what every column of these tables means. A row without a column says what a row of the table stands
/// for. The dictionary itself is listed last.
Table dictionary_of(const std::vector<Table>& tables) {
  Table dictionary{"dictionary",
                   "One column of one table of this folder, or what a row of the table stands for.",
                   {{"table", "",
                     "Name of the table, that of its file without .csv; curves are the files in curves/, or in an "
                     "export curves.csv."},
                    {"column", "", "Name of the column; empty where the line is about the rows of the table."},
                    {"unit", "", "Its unit: SI, 1 for ratios and counts, empty for words and truth values."},
                    {"meaning", "", "What the cells mean."}},
                   {}};
  const auto list = [&](const Table& table) {
    dictionary.rows.push_back({table.name, "", "", table.text});
    for (const Column& column : table.columns)
      dictionary.rows.push_back({table.name, column.name, column.unit, column.text});
  };
  for (const Table& table : tables) list(table);
  // A copy: the rows grow while it is listed.
  list(Table{dictionary.name, dictionary.text, dictionary.columns, {}});
  return dictionary;
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
  std::ifstream stream;
  if (std::filesystem::is_regular_file(folder / "study.json", ignored)) stream.open(folder / "study.json");
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
  if (!kind || !results.study.contains("scene")) return;  // nothing to make a study of
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

void write_outputs(const std::filesystem::path& folder, const StudyResults& results,
                   const std::function<std::string()>& page, const std::set<std::string>* changed) {
  write_study(folder, results);
  write_curve_files(folder, results, changed);
  TableFolder tables(folder);
  write_results(tables, results, has_curve_files(results) ? curves_head(results) : Table());
  tables.write_dictionary();
  tables.remove_stale_tables();
  write_failures(folder / "failures", results);
  write_file(folder / "report.html", page());
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

namespace {

/// The rows of one curve under these columns, the first of which is `case`.
std::string curve_rows(const std::string& id, const Curve& curve, const std::vector<Column>& columns) {
  std::size_t samples = 0;
  for (const Series& column : curve.columns) samples = std::max(samples, column.size());
  std::vector<std::shared_ptr<const std::vector<double>>> sources;
  for (std::size_t c = 1; c < columns.size(); ++c) {
    const auto found = std::find(curve.names.begin(), curve.names.end(), columns[c].name);
    sources.push_back(found == curve.names.end()
                          ? nullptr
                          : curve.columns[static_cast<std::size_t>(found - curve.names.begin())].share());
  }
  std::string text;
  for (std::size_t i = 0; i < samples; ++i) {
    text += id;
    for (const auto& source : sources) {
      text += ',';
      if (source && i < source->size()) append_csv_number((*source)[i], text);
    }
    text += '\n';
  }
  return text;
}

}  // namespace

void remove_stale(const std::filesystem::path& folder, const char* extension, const std::set<std::string>& wanted) {
  std::vector<std::filesystem::path> stale;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    const std::string stem = entry.path().stem().string();
    if (entry.path().extension() == extension && is_former_id(former_id(stem)) && wanted.count(stem) == 0)
      stale.push_back(entry.path());
  }
  for (const auto& file : stale) std::filesystem::remove(file, ignored);
}

void write_curve_files(const std::filesystem::path& folder, const StudyResults& results,
                       const std::set<std::string>* changed) {
  if (!has_curve_files(results)) return remove_curve_files(folder);
  const std::filesystem::path curves = folder / "curves";
  make_folder(curves);
  std::set<std::string> wanted;
  for (const CaseRecord& record : results.cases) {
    const std::filesystem::path file = curves / (record.id + ".csv");
    if (record.curve.names.empty()) continue;
    wanted.insert(record.id);
    if (changed != nullptr && changed->count(record.id) == 0 && std::filesystem::exists(file)) continue;
    write_file(file, curve_csv(record.curve));
  }
  remove_stale(curves, ".csv", wanted);
}

void remove_curve_files(const std::filesystem::path& folder) {
  remove_stale(folder / "curves", ".csv", {});
  // What somebody else put there stays.
  std::error_code not_empty;
  std::filesystem::remove(folder / "curves", not_empty);
}

void remove_curve_table(const std::filesystem::path& folder) {
  std::error_code ignored;
  std::filesystem::remove(folder / "curves.csv", ignored);
}

Table curves_head(const StudyResults& results) {
  const Kind* kind = find_kind(results.kind);
  const Table declared = kind ? kind->curve(results) : Table();
  Table curves{"curves", declared.text, {}, {}};
  for (const CaseRecord& record : results.cases)
    for (const std::string& name : record.curve.names)
      if (!find_column(curves.columns, name)) curves.columns.push_back({name, "", ""});
  describe(curves, declared);
  return curves;
}

Table write_curve_table(const std::filesystem::path& folder, const StudyResults& results) {
  Table curves = curves_head(results);
  curves.columns = joined({case_column()}, curves.columns);
  FileWriter file(folder / "curves.csv");
  file.write(csv_line(csv_head(curves.columns)));
  for (const CaseRecord& record : results.cases)
    if (!record.curve.names.empty()) file.write(curve_rows(record.id, record.curve, curves.columns));
  file.commit();
  return curves;
}

}  // namespace ricochet
