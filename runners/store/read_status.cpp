#include <SQLiteCpp/Column.h>
#include <SQLiteCpp/Statement.h>
#include <SQLiteCpp/Transaction.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>

#include "runners/store/read_store.hpp"
#include "runners/study/case_id.hpp"

namespace ricochet {

RunStatus read_status(const std::filesystem::path& folder) {
  RunStatus status;
  with_store(folder, [&](SQLite::Database& database) {
    SQLite::Transaction transaction(database);
    SQLite::Statement study(
        database, "SELECT key, value FROM study WHERE key NOT IN ('resolved', 'columns', 'axes', 'method_words')");
    while (study.executeStep()) {
      const std::string key = study.getColumn(0).getString();
      const auto value = nlohmann::ordered_json::parse(study.getColumn(1).getString());
      if (key == "name") status.name = value.get<std::string>();
      if (key == "question") status.question = value.get<std::string>();
      if (key == "kind") status.kind = value.get<std::string>();
      if (key == "expected_cases") status.expected = value.get<int>();
      if (key == "progress") {
        status.progress = value.at("text").get<std::string>();
        status.heard = value.at("at").get<std::string>();
      }
    }
    status.part = read_part(database).value_or(StudyPart{});
    SQLite::Statement rows(database, "SELECT status, fingerprint = '', count(*) FROM cases GROUP BY 1, 2");
    while (rows.executeStep()) {
      const int count = rows.getColumn(2).getInt();
      (rows.getColumn(1).getInt() != 0 ? status.partial : status.rows[rows.getColumn(0).getString()]) += count;
    }
    SQLite::Statement begun(database, "SELECT case_id, stage, since FROM begun ORDER BY since, case_id");
    while (begun.executeStep())
      status.under_way.push_back({id_of_today(begun.getColumn(0).getString()), begun.getColumn(1).getString(),
                                  begun.getColumn(2).getString()});
    SQLite::Statement epoch(database, "SELECT run FROM epoch");
    if (epoch.executeStep()) status.run = RunIdentity::from_json(epoch.getColumn(0).getString());
  });
  std::error_code error;
  const auto written = std::filesystem::last_write_time(folder / "results.sqlite", error);
  if (!error)
    status.silent =
        std::max(0.0, std::chrono::duration<double>(std::filesystem::file_time_type::clock::now() - written).count());
  return status;
}

}  // namespace ricochet
