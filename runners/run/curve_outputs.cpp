#include "runners/run/curve_outputs.hpp"

#include <memory>
#include <vector>

#include "runners/kinds/kind.hpp"
#include "runners/store/atomic_file.hpp"
#include "runners/store/curve_files.hpp"
#include "runners/store/record_tables.hpp"
#include "runners/store/record_values.hpp"
#include "runners/table/csv_text.hpp"

namespace ricochet {
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
  constexpr std::size_t digits = 10;
  std::vector<std::filesystem::path> stale;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    const std::string stem = entry.path().stem().string();
    if (entry.path().extension() == extension && stem.size() == digits &&
        stem.find_first_not_of("0123456789abcdef") == std::string::npos && wanted.count(stem) == 0)
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
  Table curves{"curves", kind ? kind->curve.text : "", {}, {}};
  for (const CaseRecord& record : results.cases)
    for (const std::string& name : record.curve.names)
      if (!find_column(curves.columns, name)) curves.columns.push_back({name, "", ""});
  if (kind) describe(curves, kind->curve);
  return curves;
}

Table write_curve_table(const std::filesystem::path& folder, const StudyResults& results) {
  Table curves = curves_head(results);
  curves.columns.insert(curves.columns.begin(), case_column());
  FileWriter file(folder / "curves.csv");
  file.write(csv_line(csv_head(curves.columns)));
  for (const CaseRecord& record : results.cases)
    if (!record.curve.names.empty()) file.write(curve_rows(record.id, record.curve, curves.columns));
  file.commit();
  return curves;
}

}  // namespace ricochet
