#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "runners/table/table.hpp"

/// \file
/// Tables as CSV after RFC 4180, numbers in the shortest digits that read back as the same double.
namespace ricochet {

/// The shortest decimal text that reads back as the same double; "" when not finite (no NaN reaches a row).
std::string csv_number(double value);

/// The same, behind what `text` holds.
void append_csv_number(double value, std::string& text);

/// A field: in double quotes, with inner quotes doubled, when it holds a comma, a quote or a line break.
std::string csv_field(std::string_view text);

/// A cell as a field, quoted where it must be.
std::string csv_cell(const Cell& cell);

/// One line of fields already quoted, ending in '\n'.
std::string csv_line(const std::vector<std::string>& fields);

/// The names of the columns, quoted where they must be.
std::vector<std::string> csv_head(const std::vector<Column>& columns);

/// The whole table: its columns, then one line per row; empty fields for nothing.
std::string table_csv(const Table& table);

}  // namespace ricochet
