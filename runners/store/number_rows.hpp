#pragma once
#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Statement.h>

#include <filesystem>
#include <string>
#include <vector>

#include "runners/table/number_table.hpp"

namespace ricochet {

/// Binds numbers as a blob of little-endian doubles; they stay where they are until the statement has run.
void bind_series(SQLite::Statement& statement, int index, const double* first, std::size_t count);

/// Rows of a table of numbers that lie in one place.
inline constexpr std::size_t numbers_in_piece = std::size_t{1} << 20;

/// Adds a table of numbers to the rows of a case, as its `position`th, by this statement; inside a transaction.
inline constexpr const char* insert_numbers_sql = "INSERT INTO case_numbers VALUES(?, ?, ?, ?, ?, ?, ?, ?)";
void insert_numbers(SQLite::Statement& add, const std::string& case_id, int& position, const NumberTable& table);

/// Keeps a table of numbers beside what FOLDER/results.sqlite holds of a case, in place of one of the same name, while
/// nobody else writes there. Throws StoreError.
void keep_numbers(const std::filesystem::path& folder, const std::string& case_id, const NumberTable& table);

}  // namespace ricochet
