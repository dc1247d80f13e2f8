#pragma once
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runners/store/record.hpp"

/// \file
/// What a record holds, by name, and how the rows of tables begin.
namespace ricochet {

/// Whether the case diverged or failed, rather than being refused or done.
bool went_wrong(const CaseRecord& record);

/// The measure of this name, if the case has it.
std::optional<double> measure(const CaseRecord& record, const std::string& name);

/// Why it is left out of the case, by its own rows of what is left out; "" where it is not.
const std::string& why_left_out(const CaseRecord& record, const std::string& name);

/// The measure of this name, if the case has it and does not leave it out: what was counted without number stays in
/// tables of cases alone.
std::optional<double> told_measure(const CaseRecord& record, const std::string& name);

/// Adds a measure to the record; one that is not finite is left out.
void put_measure(CaseRecord& record, const std::string& name, double value);

/// Steps in half a period of a compliant contact. Fewer than `fewest_contact_steps` do not resolve it.
inline constexpr const char* contact_steps_measure = "contact_steps";
inline constexpr double fewest_contact_steps = 8;

/// The case's value on this axis; nothing where it has no such axis.
Cell axis(const CaseRecord& record, const std::string& column);

/// The case's values on these axes, in their order.
Row axes_of(const CaseRecord& record, const std::vector<std::string>& columns);

/// Tells rows apart.
std::string key_of(const Row& row);

/// The cases that agree on these axes, in the study's order.
using Cases = std::vector<const CaseRecord*>;
std::vector<Cases> groups_of(const Cases& cases, const std::vector<std::string>& columns);
Cases all_cases(const StudyResults& results);
Cases with_status(const Cases& cases, Status status);

/// What the axes of these names mean: as the run described them, else as the study format does.
std::vector<Column> axis_columns(const StudyResults& results, const std::vector<std::string>& names);
Column axis_column(const StudyResults& results, const std::string& name);

/// `case`, the key of every table that speaks of cases.
Column case_column();

/// `case` and every axis of the study: how a row that speaks of one case begins.
std::vector<Column> place_columns(const StudyResults& results);
/// The cells of these columns.
Row place_of(const StudyResults& results, const CaseRecord& record);
/// The case and some of its axes.
Row place_of(const CaseRecord& record, const std::vector<std::string>& columns);

/// Appends a row: where it stands, then what is said there.
void add_row(Table& table, Row place, const Row& cells);

/// The rows of a table that the case carries, each behind its case and axes; `into` has the columns for them.
void append_rows(const StudyResults& results, const CaseRecord& record, const Table& own, Table& into);

/// A table without rows whose columns are `case`, every axis, then these.
Table table_of_cases(const StudyResults& results, std::string name, std::string text,
                     const std::vector<Column>& columns);
/// The same of a table that has these alone.
Table table_of_cases(const StudyResults& results, const Table& own);

/// Takes from those of the same name what tables of cases mean: what is stored of a column is its name.
void describe(std::vector<CaseRecord>& cases, const std::vector<Table>& tables,
              const std::vector<NumberTable>& numbers = {});

/// A value of a study or of a store as a cell. What is neither a word, a number nor a truth value is its JSON text.
Cell cell_of(const nlohmann::ordered_json& value);
/// The same cell as it is stored.
nlohmann::ordered_json json_of(const Cell& cell);

// What the records of a study hold, as tables.

/// What is known of a measure, as a column.
Column measure_column(const std::string& name);

/// cases: case, every axis, status, reason, steps, setup_seconds, run_seconds, then every measure. Measures of the kind
/// come first, in their order, then any other in the order met. A cell is nothing where a case has no such value. The
/// status of a case that is still running is `partial`.
Table cases_table(const StudyResults& results);

/// curves/ID.csv: one column per series, one line per sample.
std::string curve_csv(const Curve& curve);

/// The tables of numbers that are exported, in the order met, without rows. Columns are case, every axis, then those of
/// the table: of its first case, then any other in the order met.
std::vector<Table> number_heads(const StudyResults& results);

/// The rows of all cases under such a head; empty fields for what is not finite or not there. Handed to `write` in
/// pieces of about a megabyte, so that the size of the table is no matter.
void write_numbers_csv(const StudyResults& results, const Table& head,
                       const std::function<void(std::string_view)>& write);

/// measures: measure, unit, text: what each measure of cases.csv means.
Table measures_table();
/// left_out: case, item, reason.
Table left_out_table(const StudyResults& results);
/// notes: case, note.
Table notes_table(const StudyResults& results);
/// environment: name, value.
Table environment_table(const Environment& environment);

}  // namespace ricochet
