#pragma once
#include <SQLiteCpp/Column.h>
#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Statement.h>

#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "runners/table/number_table.hpp"

namespace ricochet {

/// Where a store holds numbers in one blob: a column of a curve, or of a piece of a table of numbers.
struct StoredPiece {
  enum class Of { curves, case_numbers };
  Of of = Of::curves;
  std::string case_id;
  int position = 0, part = 0;
  std::size_t size = 0;                             ///< numbers
  std::optional<std::vector<double>> numbers = {};  ///< where they are read already
};

/// The doubles of a blob.
std::vector<double> doubles_of(const SQLite::Column& blob);

/// Reads it. Throws StoreError where it is no longer there.
std::vector<double> read_piece(SQLite::Database& database, const StoredPiece& piece);

/// Reads series of a results.sqlite when somebody asks for them, by a connection of its own. May be used from several
/// threads.
class StoredSeries : public std::enable_shared_from_this<StoredSeries> {
 public:
  explicit StoredSeries(std::filesystem::path file) : file_(std::move(file)) {}

  /// A series of these pieces, of which there is one at least and all but the last are of one size.
  Series series(std::vector<StoredPiece> pieces);

 private:
  std::vector<double> read(const StoredPiece& piece);

  std::filesystem::path file_;
  std::mutex mutex_;
  std::unique_ptr<SQLite::Database> database_;
};

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
