#include "runners/store/number_rows.hpp"

#include <SQLiteCpp/Statement.h>
#include <SQLiteCpp/Transaction.h>
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <nlohmann/json.hpp>

#include "runners/store/atomic_file.hpp"
#include "runners/store/checksums.hpp"
#include "runners/store/folder_lock.hpp"
#include "runners/store/read_store.hpp"
#include "runners/store/schema.hpp"

namespace ricochet {

std::vector<double> doubles_of(const SQLite::Column& blob) {
  std::vector<double> numbers(static_cast<std::size_t>(blob.getBytes()) / sizeof(double));
  if (!numbers.empty()) std::memcpy(numbers.data(), blob.getBlob(), numbers.size() * sizeof(double));
  return numbers;
}

std::vector<double> read_piece(SQLite::Database& database, const StoredPiece& piece) {
  const bool curve = piece.of == StoredPiece::Of::curves;
  SQLite::Statement row(database,
                        curve ? "SELECT series FROM curves WHERE case_id = ? AND position = ?"
                              : "SELECT series FROM case_numbers WHERE case_id = ? AND position = ? AND part = ?");
  row.bind(1, piece.case_id);
  row.bind(2, piece.position);
  if (!curve) row.bind(3, piece.part);
  if (std::vector<double> found = row.executeStep() ? doubles_of(row.getColumn(0)) : std::vector<double>{};
      found.size() == piece.size)
    return found;
  throw StoreError(fmt::format("{}: the case {} changed while it was read; run the command again",
                               database.getFilename(), piece.case_id));
}

Series StoredSeries::series(std::vector<StoredPiece> pieces) {
  Series::Source source;
  for (const StoredPiece& piece : pieces) source.size += piece.size;
  source.piece = std::max<std::size_t>(1, pieces.front().size);
  source.read = [self = shared_from_this(), pieces = std::move(pieces)](std::size_t number) {
    return self->read(pieces.at(number));
  };
  return Series(std::move(source));
}

std::vector<double> StoredSeries::read(const StoredPiece& piece) {
  if (piece.size == 0) return {};
  const std::lock_guard guard(mutex_);
  std::vector<double> found;
  guarded(file_, database_.get(), [&] {
    constexpr int wait_ms = 10000;
    if (!database_) database_ = std::make_unique<SQLite::Database>(file_, SQLite::OPEN_READONLY, wait_ms);
    found = read_piece(*database_, piece);
  });
  return found;
}

static_assert(std::endian::native == std::endian::little, "series are stored as little-endian doubles");

void bind_series(SQLite::Statement& statement, int index, const double* first, std::size_t count) {
  // An empty vector may have no address, and SQLite would store NULL.
  statement.bindNoCopy(index, count == 0 ? static_cast<const void*>("") : first,
                       static_cast<int>(count * sizeof(double)));
}

void insert_numbers(SQLite::Statement& add, const std::string& case_id, int& position, const NumberTable& table) {
  // SQLite holds no more than a billion bytes in one place.
  constexpr std::size_t piece = numbers_in_piece;
  for (std::size_t first = 0; first == 0 || first < table.rows(); first += piece, ++position)
    for (std::size_t c = 0; c < table.values.size(); ++c) {
      const std::vector<double>& values = table.values[c];
      const std::string& column = table.columns.at(c).name;
      add.reset();
      add.bind(1, case_id);
      add.bind(2, position);
      add.bind(3, static_cast<int>(c));
      add.bind(4, table.name);
      add.bind(5, table.exported ? 1 : 0);
      add.bind(6, column);
      add.bind(7);
      if (const auto* words = table.words_of(column))
        add.bind(7,
                 nlohmann::ordered_json(*words).dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
      bind_series(add, 8, values.data() + first, std::min(piece, values.size() - first));
      add.exec();
    }
}

void keep_numbers(const std::filesystem::path& folder, const std::string& case_id, const NumberTable& table) {
  const FolderLock lock(folder);
  with_store(folder, [&](SQLite::Database& database) {
    SQLite::Transaction transaction(database);
    if (!is_whole(database, "", case_id))
      throw StoreError(fmt::format("{}: the case {} is damaged; run its study again", folder.string(), case_id));
    SQLite::Statement remove(database, "DELETE FROM case_numbers WHERE case_id = ? AND name = ?");
    remove.bind(1, case_id);
    remove.bind(2, table.name);
    remove.exec();
    SQLite::Statement last(database, "SELECT coalesce(max(position), -1) FROM case_numbers WHERE case_id = ?");
    last.bind(1, case_id);
    last.executeStep();
    int position = last.getColumn(0).getInt() + 1;
    last.reset();
    SQLite::Statement add(database, insert_numbers_sql);
    insert_numbers(add, case_id, position, table);
    {
      Statements prepared(database);
      seal_case(prepared, "", case_id);
    }
    transaction.commit();
  });
}

}  // namespace ricochet
