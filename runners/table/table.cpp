#include "runners/table/table.hpp"

#include <algorithm>
#include <array>
#include <functional>

#include "runners/table/table_reader.hpp"
#include "runners/table/text.hpp"

namespace ricochet {

std::optional<bool> Cell::truth() const {
  const bool* truth = std::get_if<bool>(&content_);
  return truth ? std::optional(*truth) : std::nullopt;
}

std::optional<double> Cell::number() const {
  if (const double* number = std::get_if<double>(&content_)) return *number;
  if (const auto* whole = std::get_if<std::int64_t>(&content_)) return static_cast<double>(*whole);
  return std::nullopt;
}

std::optional<std::int64_t> Cell::whole() const {
  const auto* whole = std::get_if<std::int64_t>(&content_);
  return whole ? std::optional(*whole) : std::nullopt;
}

std::string Cell::text() const {
  if (const std::string* text = words()) return *text;
  if (const double* number = std::get_if<double>(&content_)) return csv_number(*number);
  if (const auto* whole = std::get_if<std::int64_t>(&content_)) return std::to_string(*whole);
  if (const bool* truth = std::get_if<bool>(&content_)) return *truth ? "true" : "false";
  return "";
}

bool operator==(const Cell& a, const Cell& b) {
  if (a.content_.index() == b.content_.index()) return a.content_ == b.content_;
  const std::optional<double> one = a.number(), other = b.number();
  return one && other && *one == *other;
}

std::vector<Column> named_columns(const std::vector<std::string>& names) {
  std::vector<Column> columns;
  for (const std::string& name : names) columns.push_back({name, "", ""});
  return columns;
}

std::vector<Column> joined(std::vector<Column> first, const std::vector<Column>& then) {
  first.insert(first.end(), then.begin(), then.end());
  return first;
}

std::optional<std::size_t> find_column(const std::vector<Column>& columns, std::string_view name) {
  const auto found = std::find_if(columns.begin(), columns.end(), [&](const Column& one) { return one.name == name; });
  if (found == columns.end()) return std::nullopt;
  return static_cast<std::size_t>(found - columns.begin());
}

const std::vector<Column>& Columns::get() const {
  static const std::vector<Column> none;
  return shared_ ? *shared_ : none;
}

std::vector<Column>& Columns::own() {
  if (!shared_ || shared_.use_count() > 1) shared_ = std::make_shared<std::vector<Column>>(get());
  return *shared_;
}

void describe(Columns& columns, const Columns& declared) {
  for (Column& column : columns.own())
    if (const auto known = find_column(declared, column.name)) column = declared[*known];
}

void describe(Table& table, const Table& declared) {
  table.text = declared.text;
  describe(table.columns, declared.columns);
}

std::size_t TableReader::column(std::string_view name) const {
  if (const std::size_t place = column_if_any(name); place != absent) return place;
  throw TableError("the table " + table_->name + " has no column " + std::string(name));
}

std::size_t TableReader::column_if_any(std::string_view name) const {
  return find_column(table_->columns, name).value_or(absent);
}

const Cell& TableReader::cell(std::size_t row, std::size_t column) const {
  static const Cell nothing;
  const Row& cells = table_->rows.at(row);
  return column < cells.size() ? cells[column] : nothing;
}

const Table* find_table(const std::vector<Table>& tables, std::string_view name) {
  const auto found = std::find_if(tables.begin(), tables.end(), [&](const Table& table) { return table.name == name; });
  return found == tables.end() ? nullptr : &*found;
}

Table* find_table(std::vector<Table>& tables, std::string_view name) {
  return const_cast<Table*>(find_table(std::as_const(tables), name));
}

/// Short texts that a thread made lately, by their hash.
struct RecentWords {
  static constexpr std::size_t longest = 32;
  std::array<SharedWords, 64> made{};
};

SharedWords::SharedWords(std::string text) {
  if (text.size() > RecentWords::longest) {
    body_ = new Body(std::move(text));
    return;
  }
  thread_local RecentWords recent;
  SharedWords& same = recent.made[std::hash<std::string>{}(text) % recent.made.size()];
  if (!same.body_ || same.text() != text) {
    SharedWords fresh;
    fresh.body_ = new Body(std::move(text));
    same = std::move(fresh);
  }
  body_ = same.body_;
  body_->owners.fetch_add(1, std::memory_order_relaxed);
}

}  // namespace ricochet
