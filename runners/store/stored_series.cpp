#include "runners/store/stored_series.hpp"

#include <SQLiteCpp/Column.h>
#include <SQLiteCpp/Statement.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "runners/store/schema.hpp"
#include "runners/store/store_error.hpp"

namespace ricochet {

std::vector<double> read_piece(SQLite::Database& database, const StoredPiece& piece) {
  const bool curve = piece.of == StoredPiece::Of::curves;
  SQLite::Statement row(database,
                        curve ? "SELECT series FROM curves WHERE case_id = ? AND position = ?"
                              : "SELECT series FROM case_numbers WHERE case_id = ? AND position = ? AND part = ?");
  row.bind(1, piece.case_id);
  row.bind(2, piece.position);
  if (!curve) row.bind(3, piece.part);
  std::vector<double> found;
  bool there = row.executeStep();
  if (there) {
    const SQLite::Column blob = row.getColumn(0);
    found.resize(static_cast<std::size_t>(blob.getBytes()) / sizeof(double));
    if (!found.empty()) std::memcpy(found.data(), blob.getBlob(), found.size() * sizeof(double));
    there = found.size() == piece.size;
  }
  if (!there)
    throw StoreError(fmt::format("{}: the case {} changed while it was read; run the command again",
                                 database.getFilename(), piece.case_id));
  return found;
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

}  // namespace ricochet
