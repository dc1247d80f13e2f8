#pragma once
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "runners/store/record.hpp"

/// \file
/// What the records of a study hold, as tables.
namespace ricochet {

/// What is known of a measure, as a column.
Column measure_column(const std::string& name);

/// cases: case, every axis, status, reason, steps, setup_seconds, run_seconds, then every measure (those of the kind,
/// in their order, then any other in the order met). A cell is nothing where a case has no such value. The status of a
/// case that is still running is `partial`.
Table cases_table(const StudyResults& results);

/// curves/ID.csv: one column per series, one line per sample.
std::string curve_csv(const Curve& curve);

/// The tables of numbers that are exported, in the order met, without rows: case, every axis, then the columns of the
/// table (those of the first case, then any other in the order met).
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
