#include "runners/store/epoch.hpp"

#include <SQLiteCpp/Column.h>
#include <SQLiteCpp/Statement.h>
#include <fmt/format.h>

#include "runners/store/store_error.hpp"

namespace ricochet {
namespace {

struct Holder {
  long long number = 0;
  RunIdentity run;
};

Holder holder_of(SQLite::Database& database) {
  Holder holder;
  SQLite::Statement row(database, "SELECT number, run FROM epoch");
  if (row.executeStep()) holder = {row.getColumn(0).getInt64(), RunIdentity::from_json(row.getColumn(1).getString())};
  return holder;
}

}  // namespace

void Epoch::raise(SQLite::Database& database, const std::filesystem::path& file) {
  const Holder before = holder_of(database);
  const RunIdentity me = this_run();
  if (before.run.succeeds(me))
    throw StoreError(fmt::format("{}: a later start of this job has taken this folder over ({})",
                                 file.parent_path().string(), before.run.text()));
  database.exec("DELETE FROM epoch");
  SQLite::Statement add(database, "INSERT INTO epoch(number, run) VALUES(?, ?)");
  add.bind(1, static_cast<std::int64_t>(before.number + 1));
  add.bind(2, me.to_json());
  add.exec();
  number_ = before.number + 1;
}

void Epoch::check(SQLite::Database& database, const std::filesystem::path& file) const {
  if (number_ == 0) return;
  if (const Holder now = holder_of(database); now.number != number_)
    throw StoreError(fmt::format("{}: another run took this folder over ({}); this one has changed nothing since",
                                 file.parent_path().string(), now.run.text()));
}

}  // namespace ricochet
