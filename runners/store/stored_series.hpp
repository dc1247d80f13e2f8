#pragma once
#include <SQLiteCpp/Database.h>

#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "runners/table/series.hpp"

namespace ricochet {

/// Where a store holds numbers in one blob: a column of a curve, or of a piece of a table of numbers.
struct StoredPiece {
  enum class Of { curves, case_numbers };
  Of of = Of::curves;
  std::string case_id;
  int position = 0, part = 0;
  std::size_t size = 0;  ///< numbers
};

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

}  // namespace ricochet
