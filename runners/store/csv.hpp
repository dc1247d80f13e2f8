#pragma once
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "runners/store/record.hpp"

namespace ricochet {

/// The shortest decimal text that reads back as the same double; "" when not finite (no NaN reaches a row).
std::string csv_number(double value);

/// A field after RFC 4180: in double quotes, with inner quotes doubled, when it holds a comma, a quote or a line break.
std::string csv_field(std::string_view text);

/// An axis value as a field: strings as they are, numbers as csv_number, null as an empty field.
std::string csv_value(const nlohmann::ordered_json& value);

/// One line of fields already quoted, ending in '\n'.
std::string csv_line(const std::vector<std::string>& fields);

/// cases.csv: id, every axis column, status, reason, steps, setup_seconds, run_seconds, then every measure (those of
/// the kind, in their order, then any other in the order met). A field is empty where a case has no such value. The
/// status of a case that is still running is `partial`.
std::string cases_csv(const StudyResults& results);

/// curves/ID.csv: one column per series, one line per sample.
std::string curve_csv(const Curve& curve);

/// A derived table: its columns, then one line per row; empty fields for null.
std::string derived_csv(const DerivedTable& table);

/// The names of the tables of numbers that are exported, in the order met.
std::vector<std::string> exported_tables(const StudyResults& results);

/// The table `name` of all cases: case, every axis column, then the columns of the table (those of the first case, then
/// any other in the order met); empty fields for what is not finite or not there. Handed to `write` in pieces of about
/// a megabyte, so that the size of the table is no matter.
void write_numbers_csv(const StudyResults& results, const std::string& name,
                       const std::function<void(std::string_view)>& write);

/// The meaning of the measures: measure, unit, text.
std::string measures_csv();
/// id, item, reason.
std::string left_out_csv(const StudyResults& results);
/// id, note.
std::string notes_csv(const StudyResults& results);
/// name, value.
std::string environment_csv(const Environment& environment);

}  // namespace ricochet
