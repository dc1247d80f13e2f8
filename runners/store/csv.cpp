#include "runners/store/csv.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace ricochet {
namespace {

std::vector<std::string> measure_columns(const StudyResults& results) {
  std::vector<std::string> columns;
  // The measures of a trajectory stand in every trajectory's table; other kinds show what they have.
  if (results.kind == "trajectory")
    for (const MeasureInfo& measure : trajectory_measures()) columns.emplace_back(measure.name);
  for (const CaseRecord& record : results.cases)
    for (const auto& measure : record.measures)
      if (std::find(columns.begin(), columns.end(), measure.first) == columns.end()) columns.push_back(measure.first);
  return columns;
}

template <class Pairs>
auto find_key(const Pairs& pairs, const std::string& key) {
  return std::find_if(pairs.begin(), pairs.end(), [&](const auto& pair) { return pair.first == key; });
}

}  // namespace

std::string csv_number(double value) {
  if (!std::isfinite(value)) return "";
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
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
    fields.push_back(record.status);
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

std::string measures_csv() {
  std::string table = csv_line({"measure", "unit", "text"});
  for (const auto* list : {&trajectory_measures(), &further_measures()})
    for (const MeasureInfo& measure : *list)
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
