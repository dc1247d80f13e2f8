#include "runners/store/number_rows.hpp"

#include <SQLiteCpp/Column.h>
#include <SQLiteCpp/Transaction.h>

#include <algorithm>
#include <bit>
#include <nlohmann/json.hpp>

#include "runners/store/folder_lock.hpp"
#include "runners/store/read_store.hpp"

namespace ricochet {

static_assert(std::endian::native == std::endian::little, "series are stored as little-endian doubles");

void bind_series(SQLite::Statement& statement, int index, const double* first, std::size_t count) {
  // An empty vector may have no address, and SQLite would store NULL.
  statement.bindNoCopy(index, count == 0 ? static_cast<const void*>("") : first,
                       static_cast<int>(count * sizeof(double)));
}

void insert_numbers(SQLite::Statement& add, const std::string& case_id, int& position, const NumberTable& table) {
  using Json = nlohmann::ordered_json;
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
        add.bind(7, Json(*words).dump(-1, ' ', false, Json::error_handler_t::replace));
      bind_series(add, 8, values.data() + first, std::min(piece, values.size() - first));
      add.exec();
    }
}

void keep_numbers(const std::filesystem::path& folder, const std::string& case_id, const NumberTable& table) {
  const FolderLock lock(folder);
  with_store(folder, [&](SQLite::Database& database) {
    SQLite::Transaction transaction(database);
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
    transaction.commit();
  });
}

}  // namespace ricochet
