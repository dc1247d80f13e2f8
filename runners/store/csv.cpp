#include "runners/store/csv.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace ricochet {
namespace {

std::vector<std::string> measure_columns(const StudyResults& results) {
  std::vector<std::string> columns = standing_measures(results.kind);
  for (const CaseRecord& record : results.cases)
    for (const auto& measure : record.measures)
      if (std::find(columns.begin(), columns.end(), measure.first) == columns.end()) columns.push_back(measure.first);
  return columns;
}

template <class Pairs>
auto find_key(const Pairs& pairs, const std::string& key) {
  return std::find_if(pairs.begin(), pairs.end(), [&](const auto& pair) { return pair.first == key; });
}

void append_number(double value, std::string& text) {
  if (!std::isfinite(value)) return;
  std::array<char, 32> digits{};
  text.append(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr);
}

/// The case and its axes, as every line of its tables begins.
std::string place_of(const CaseRecord& record, const std::vector<std::string>& columns) {
  std::string place = csv_field(record.id);
  for (const std::string& column : columns) {
    const auto axis = find_key(record.axes, column);
    place += ',';
    if (axis != record.axes.end()) place += csv_value(axis->second);
  }
  return place;
}

/// A column of a table as it is written: none (the table has no such column), numbers, or words.
struct Source {
  const std::vector<double>* values = nullptr;
  bool worded = false;
  std::vector<std::string> words;  // quoted
};

std::vector<Source> sources_of(const NumberTable& table, const std::vector<std::string>& columns) {
  std::vector<Source> sources;
  for (const std::string& column : columns) {
    Source& source = sources.emplace_back();
    for (std::size_t c = 0; c < table.columns.size(); ++c)
      if (table.names.at(c) == column) source.values = &table.columns[c];
    const auto words = find_key(table.words, column);
    if (words == table.words.end()) continue;
    source.worded = true;
    for (const std::string& word : words->second) source.words.push_back(csv_field(word));
  }
  return sources;
}

void write_rows(const NumberTable& table, const std::vector<std::string>& columns, const std::string& place,
                std::string& text, const std::function<void(std::string_view)>& write) {
  constexpr std::size_t piece = std::size_t{1} << 20U;
  const std::vector<Source> sources = sources_of(table, columns);
  for (std::size_t i = 0; i < table.rows(); ++i) {
    text += place;
    for (const Source& source : sources) {
      text += ',';
      if (!source.values || i >= source.values->size()) continue;
      const double value = (*source.values)[i];
      if (!source.worded)
        append_number(value, text);
      else if (value >= 0 && value < static_cast<double>(source.words.size()))
        text += source.words[static_cast<std::size_t>(value)];
    }
    text += '\n';
    if (text.size() < piece) continue;
    write(text);
    text.clear();
  }
}

}  // namespace

std::string csv_number(double value) {
  std::string text;
  append_number(value, text);
  return text;
}

std::string csv_field(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string field = "\"";
  for (const char c : text) {
    if (c == '"') field += '"';
    field += c;
  }
  return field + '"';
}

std::string csv_value(const nlohmann::ordered_json& value) {
  if (value.is_null()) return "";
  if (value.is_string()) return csv_field(value.get_ref<const std::string&>());
  if (value.is_number_float()) return csv_number(value.get<double>());
  return csv_field(value.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

std::string csv_line(const std::vector<std::string>& fields) {
  std::string line;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (i > 0) line += ',';
    line += fields[i];
  }
  return line + '\n';
}

std::string cases_csv(const StudyResults& results) {
  const std::vector<std::string> measures = measure_columns(results);
  std::vector<std::string> fields = {"id"};
  for (const std::string& column : results.columns) fields.push_back(csv_field(column));
  fields.insert(fields.end(), {"status", "reason", "steps", "setup_seconds", "run_seconds"});
  for (const std::string& measure : measures) fields.push_back(csv_field(measure));
  std::string table = csv_line(fields);
  for (const CaseRecord& record : results.cases) {
    fields = {csv_field(record.id)};
    for (const std::string& column : results.columns) {
      const auto axis = find_key(record.axes, column);
      fields.push_back(axis == record.axes.end() ? "" : csv_value(axis->second));
    }
    fields.emplace_back(record.partial ? "partial" : record.status);
    fields.push_back(csv_field(record.reason));
    fields.push_back(std::to_string(record.steps));
    fields.push_back(csv_number(record.setup_seconds));
    fields.push_back(csv_number(record.run_seconds));
    for (const std::string& name : measures) {
      const auto measure = find_key(record.measures, name);
      fields.push_back(measure == record.measures.end() ? "" : csv_number(measure->second));
    }
    table += csv_line(fields);
  }
  return table;
}

std::string curve_csv(const Curve& curve) {
  std::vector<std::string> fields;
  for (const std::string& name : curve.names) fields.push_back(csv_field(name));
  std::string table = csv_line(fields);
  std::size_t samples = 0;
  for (const auto& column : curve.columns) samples = std::max(samples, column.size());
  for (std::size_t i = 0; i < samples; ++i) {
    fields.clear();
    for (const auto& column : curve.columns) fields.push_back(i < column.size() ? csv_number(column[i]) : "");
    table += csv_line(fields);
  }
  return table;
}

std::string derived_csv(const DerivedTable& table) {
  std::vector<std::string> fields;
  for (const std::string& column : table.columns) fields.push_back(csv_field(column));
  std::string text = csv_line(fields);
  for (const auto& row : table.rows) {
    fields.clear();
    for (const auto& cell : row) fields.push_back(csv_value(cell));
    text += csv_line(fields);
  }
  return text;
}

std::vector<std::string> exported_tables(const StudyResults& results) {
  std::vector<std::string> names;
  for (const CaseRecord& record : results.cases)
    for (const NumberTable& table : record.numbers)
      if (table.exported && std::find(names.begin(), names.end(), table.name) == names.end())
        names.push_back(table.name);
  return names;
}

void write_numbers_csv(const StudyResults& results, const std::string& name,
                       const std::function<void(std::string_view)>& write) {
  std::vector<std::string> columns;
  for (const CaseRecord& record : results.cases)
    for (const NumberTable& table : record.numbers)
      if (table.exported && table.name == name)
        for (const std::string& column : table.names)
          if (std::find(columns.begin(), columns.end(), column) == columns.end()) columns.push_back(column);
  std::vector<std::string> fields = {"case"};
  for (const std::string& column : results.columns) fields.push_back(csv_field(column));
  for (const std::string& column : columns) fields.push_back(csv_field(column));
  std::string text = csv_line(fields);
  for (const CaseRecord& record : results.cases) {
    const std::string place = place_of(record, results.columns);
    for (const NumberTable& table : record.numbers)
      if (table.exported && table.name == name) write_rows(table, columns, place, text, write);
  }
  write(text);
}

std::string measures_csv() {
  std::string table = csv_line({"measure", "unit", "text"});
  for (const MeasureInfo& measure : all_measures())
    table += csv_line({measure.name, csv_field(measure.unit), csv_field(measure.text)});
  return table;
}

std::string left_out_csv(const StudyResults& results) {
  std::string table = csv_line({"id", "item", "reason"});
  for (const CaseRecord& record : results.cases)
    for (const auto& [item, reason] : record.left_out)
      table += csv_line({csv_field(record.id), csv_field(item), csv_field(reason)});
  return table;
}

std::string notes_csv(const StudyResults& results) {
  std::string table = csv_line({"id", "note"});
  for (const CaseRecord& record : results.cases)
    for (const std::string& note : record.notes) table += csv_line({csv_field(record.id), csv_field(note)});
  return table;
}

std::string environment_csv(const Environment& environment) {
  std::string table = csv_line({"name", "value"});
  for (const auto& [name, value] : environment.entries) table += csv_line({csv_field(name), csv_field(value)});
  return table;
}

}  // namespace ricochet
