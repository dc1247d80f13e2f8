#include "runners/store/record_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <ricochet/contract/said_format.hpp>
#include <stdexcept>

#include "runners/study/axis_meaning.hpp"
#include "runners/table/text.hpp"

namespace ricochet {

std::string CaseRecord::reason() const {
  return fmt::format("{}{}", excluded ? "excluded: " : "", fmt::join(reasons, "; "));
}

bool went_wrong(const CaseRecord& record) {
  return record.status == Status::diverged || record.status == Status::failed;
}

std::optional<double> measure(const CaseRecord& record, const std::string& name) {
  for (const auto& [key, value] : record.measures)
    if (key == name) return value;
  return std::nullopt;
}

const std::string& why_left_out(const CaseRecord& record, const std::string& name) {
  static const std::string none;
  const auto found = std::find_if(record.left_out.begin(), record.left_out.end(),
                                  [&](const auto& item) { return item.first == name; });
  return found == record.left_out.end() ? none : found->second;
}

std::optional<double> told_measure(const CaseRecord& record, const std::string& name) {
  const auto value = measure(record, name);
  return value && why_left_out(record, name).empty() ? value : std::nullopt;
}

void put_measure(CaseRecord& record, const std::string& name, double value) {
  if (std::isfinite(value)) record.measures.emplace_back(name, value);
}

Cell axis(const CaseRecord& record, const std::string& column) {
  for (const auto& [name, value] : record.axes)
    if (name == column) return cell_of(value);
  return {};
}

Row axes_of(const CaseRecord& record, const std::vector<std::string>& columns) {
  Row row;
  for (const std::string& column : columns) row.push_back(axis(record, column));
  return row;
}

std::string key_of(const Row& row) {
  std::string key;
  for (const Cell& cell : row) key += cell.text() + '\x1f';
  return key;
}

std::vector<Cases> groups_of(const Cases& cases, const std::vector<std::string>& columns) {
  std::vector<Cases> groups;
  std::map<std::string, std::size_t> place;
  for (const CaseRecord* record : cases) {
    const auto [at, fresh] = place.emplace(key_of(axes_of(*record, columns)), groups.size());
    if (fresh) groups.emplace_back();
    groups[at->second].push_back(record);
  }
  return groups;
}

Cases all_cases(const StudyResults& results) {
  Cases all;
  for (const CaseRecord& record : results.cases) all.push_back(&record);
  return all;
}

Cases with_status(const Cases& cases, Status status) {
  Cases found = cases;
  std::erase_if(found, [&](const CaseRecord* record) { return record->status != status; });
  return found;
}

Column axis_column(const StudyResults& results, const std::string& name) {
  const auto known = find_column(results.axes, name);
  return known ? results.axes[*known] : axis_meaning(name, results.study);
}

std::vector<Column> axis_columns(const StudyResults& results, const std::vector<std::string>& names) {
  std::vector<Column> columns;
  for (const std::string& name : names) columns.push_back(axis_column(results, name));
  return columns;
}

Column case_column() {
  return {"case", "", "The case: c and ten hexadecimal digits that depend on its axes alone, the same in every table."};
}

std::vector<Column> place_columns(const StudyResults& results) {
  return joined({case_column()}, axis_columns(results, results.columns));
}

Row place_of(const StudyResults& results, const CaseRecord& record) {
  return place_of(record, results.columns);
}

Row place_of(const CaseRecord& record, const std::vector<std::string>& columns) {
  Row row = {record.id};
  for (const std::string& column : columns) row.push_back(axis(record, column));
  return row;
}

void add_row(Table& table, Row place, const Row& cells) {
  place.insert(place.end(), cells.begin(), cells.end());
  table.rows.push_back(std::move(place));
}

void append_rows(const StudyResults& results, const CaseRecord& record, const Table& own, Table& into) {
  // Cases of one study may have different columns (as many exponents as each was asked for).
  for (const Column& column : own.columns)
    if (!find_column(into.columns, column.name)) {
      into.columns.push_back(column);
      for (Row& row : into.rows) row.emplace_back();
    }
  std::vector<std::size_t> places;
  for (const Column& column : own.columns) places.push_back(*find_column(into.columns, column.name));
  const Row place = place_of(results, record);
  for (const Row& row : own.rows) {
    Row whole = place;
    whole.resize(into.columns.size());
    for (std::size_t c = 0; c < places.size() && c < row.size(); ++c) whole[places[c]] = row[c];
    into.rows.push_back(std::move(whole));
  }
}

Table table_of_cases(const StudyResults& results, std::string name, std::string text,
                     const std::vector<Column>& columns) {
  std::vector<Column> place = place_columns(results);
  for (const Column& column : columns)
    if (find_column(place, column.name))
      throw std::logic_error("the table " + name + " has a column \"" + column.name +
                             "\", which is what an axis of the study is called");
  return {std::move(name), std::move(text), joined(std::move(place), columns), {}};
}

Table table_of_cases(const StudyResults& results, const Table& own) {
  return table_of_cases(results, own.name, own.text, own.columns);
}

void describe(std::vector<CaseRecord>& cases, const std::vector<Table>& tables,
              const std::vector<NumberTable>& numbers) {
  struct Described {
    Columns before, after;  // of the last table: most cases have the same
  };
  std::map<std::string_view, Described> known;
  const auto describe_all = [&](auto& own, const auto& heads) {
    for (auto& table : own)
      for (const auto& head : heads) {
        if (head.name != table.name) continue;
        table.text = head.text;
        Described& last = known[head.name];
        if (!last.before.same(table.columns)) {
          last.before = last.after = table.columns;
          describe(last.after, head.columns);
        }
        table.columns = last.after;
      }
  };
  for (CaseRecord& record : cases) {
    describe_all(record.tables, tables);
    describe_all(record.numbers, numbers);
  }
}

Cell cell_of(const nlohmann::ordered_json& value) {
  if (value.is_null()) return {};
  if (value.is_string()) return value.get_ref<const std::string&>();
  if (value.is_boolean()) return value.get<bool>();
  if (value.is_number_float()) return value.get<double>();
  const bool fits = !value.is_number_unsigned() ||
                    value.get<std::uint64_t>() <= static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
  if (value.is_number_integer() && fits) return value.get<std::int64_t>();
  return value.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

nlohmann::ordered_json json_of(const Cell& cell) {
  return cell.visit([](const auto& content) -> nlohmann::ordered_json {
    if constexpr (std::is_same_v<std::decay_t<decltype(content)>, std::monostate>)
      return nullptr;
    else
      return content;
  });
}

namespace {

std::vector<Column> measure_columns(const StudyResults& results) {
  std::vector<Column> columns;
  for (const std::string& name : standing_measures(results.kind)) columns.push_back(measure_column(name));
  for (const CaseRecord& record : results.cases)
    for (const auto& [name, value] : record.measures)
      if (!find_column(columns, name)) columns.push_back(measure_column(name));
  return columns;
}

/// A column of a table of numbers as it is written: none (the table has no such column), numbers, or words.
struct Source {
  std::shared_ptr<const std::vector<double>> values;
  bool worded = false;
  std::vector<std::string> words;  // quoted
};

std::vector<Source> sources_of(const NumberTable& table, const std::vector<Column>& columns) {
  std::vector<Source> sources;
  for (const Column& column : columns) {
    Source& source = sources.emplace_back();
    if (const Series* series = table.series(column.name)) source.values = series->share();
    const auto* words = table.words_of(column.name);
    if (!words) continue;
    source.worded = true;
    for (const std::string& word : *words) source.words.push_back(csv_field(word));
  }
  return sources;
}

void write_rows(const NumberTable& table, const std::vector<Column>& columns, const std::string& place,
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
        append_csv_number(value, text);
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

Column measure_column(const std::string& name) {
  if (const MeasureInfo* info = measure_info(name)) return {name, info->unit, info->text};
  return {name, "", "A measure of the case that the program does not describe."};
}

Table cases_table(const StudyResults& results) {
  const std::vector<Column> measures = measure_columns(results);
  Table table = table_of_cases(
      results, "cases", "One case: a combination of the study's axes, what became of it, and its measures.",
      {{"status", "", "done, refused (the combination does not apply), diverged, failed, or partial while it runs."},
       {"reason", "", "Why the case was refused, diverged or failed; of a done one, what makes its figures doubtful."},
       {"steps", "1", "Steps of time that were marched."},
       {"setup_seconds", "s", "Processor time of what comes before the first step."},
       {"run_seconds", "s", "Processor time of the marching."}});
  table.columns = joined(std::move(table.columns), measures);
  for (const CaseRecord& record : results.cases) {
    Row row = place_of(results, record);
    row.insert(row.end(), {record.partial ? "partial" : word(record.status), record.reason(), record.steps,
                           record.setup_seconds, record.run_seconds});
    for (const Column& column : measures) row.emplace_back(measure(record, column.name));
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::string curve_csv(const Curve& curve) {
  std::vector<std::string> fields;
  for (const std::string& name : curve.names) fields.push_back(csv_field(name));
  std::string table = csv_line(fields);
  std::size_t samples = 0;
  std::vector<std::shared_ptr<const std::vector<double>>> columns;
  for (const Series& column : curve.columns) {
    columns.push_back(column.share());
    samples = std::max(samples, column.size());
  }
  for (std::size_t i = 0; i < samples; ++i) {
    fields.clear();
    for (const auto& column : columns) fields.push_back(i < column->size() ? csv_number((*column)[i]) : "");
    table += csv_line(fields);
  }
  return table;
}

std::vector<Table> number_heads(const StudyResults& results) {
  std::vector<Table> heads;
  for (const CaseRecord& record : results.cases)
    for (const NumberTable& table : record.numbers) {
      if (!table.exported) continue;
      auto head = std::find_if(heads.begin(), heads.end(), [&](const Table& one) { return one.name == table.name; });
      if (head == heads.end()) head = heads.insert(heads.end(), table_of_cases(results, table.name, table.text, {}));
      for (const Column& column : table.columns)
        if (!find_column(head->columns, column.name)) head->columns.push_back(column);
    }
  return heads;
}

void write_numbers_csv(const StudyResults& results, const Table& head,
                       const std::function<void(std::string_view)>& write) {
  const auto own = static_cast<std::ptrdiff_t>(1 + results.columns.size());
  const std::vector<Column> columns(head.columns.begin() + own, head.columns.end());
  std::string text = csv_line(csv_head(head.columns));
  for (const CaseRecord& record : results.cases) {
    std::string place;
    for (const Cell& cell : place_of(results, record)) place += (place.empty() ? "" : ",") + csv_cell(cell);
    for (const NumberTable& table : record.numbers)
      if (table.exported && table.name == head.name) write_rows(table, columns, place, text, write);
  }
  write(text);
}

Table measures_table() {
  Table table{"measures",
              "One measure of a case.",
              {{"measure", "", "Name of the measure, a column of cases.csv."},
               {"unit", "", "Its unit; 1 for ratios and counts."},
               {"text", "", "What it means."}},
              {}};
  for (const MeasureInfo& measure : all_measures()) table.rows.push_back({measure.name, measure.unit, measure.text});
  return table;
}

Table left_out_table(const StudyResults& results) {
  Table table{"left_out",
              "One thing that the computation of a case leaves out because its scene does not need it.",
              {case_column(), {"item", "", "What is left out."}, {"reason", "", "Why the scene does not need it."}},
              {}};
  for (const CaseRecord& record : results.cases)
    for (const auto& [item, reason] : record.left_out) table.rows.push_back({record.id, item, reason});
  return table;
}

Table notes_table(const StudyResults& results) {
  Table table{"notes",
              "One remark on a case.",
              {case_column(), {"note", "", "What is to be known to read the figures of the case."}},
              {}};
  for (const CaseRecord& record : results.cases)
    for (const std::string& note : record.notes) table.rows.push_back({record.id, note});
  return table;
}

Table environment_table(const Environment& environment) {
  Table table{
      "environment",
      "One fact about the program and the machine that made the results.",
      {{"name", "", "What the fact is about: commit, compiler, processor, a library."}, {"value", "", "The fact."}},
      {}};
  for (const auto& [name, value] : environment.entries) table.rows.push_back({name, value});
  return table;
}

}  // namespace ricochet
