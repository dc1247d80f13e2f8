#include <SQLiteCpp/Column.h>
#include <SQLiteCpp/Statement.h>
#include <fmt/format.h>

#include <optional>
#include <string>
#include <vector>

#include "runners/store/atomic_file.hpp"
#include "runners/store/checksums.hpp"
#include "runners/store/fingerprint.hpp"
#include "runners/store/read_store.hpp"
#include "runners/store/schema.hpp"
#include "runners/study/case_id.hpp"

namespace ricochet {

StoreReader::StoreReader(const std::filesystem::path& folder)
    : file_(folder / "results.sqlite"), database_(open_store(folder)) {}

const Damage& StoreReader::damage() const {
  if (!damage_) guarded(file_, database_.get(), [&] { damage_ = find_damage(*database_); });
  return *damage_;
}

StudyResults StoreReader::head() const {
  StudyResults head;
  guarded(file_, database_.get(), [&] { head = read_head(*database_); });
  return head;
}

std::vector<StoreReader::Finished> StoreReader::finished() const {
  std::vector<Finished> found;
  guarded(file_, database_.get(), [&] {
    SQLite::Statement rows(*database_,
                           "SELECT id, fingerprint, status, arithmetic FROM cases WHERE fingerprint != '' "
                           "ORDER BY position");
    while (rows.executeStep()) {
      const std::string id = rows.getColumn(0).getString();
      if (damage().cases.contains(id) || !is_case_id(id)) continue;
      found.push_back({id_of_today(id), rows.getColumn(1).getString(),
                       of_word<Status>(rows.getColumn(2).getString()) == Status::refused,
                       rows.getColumn(3).getString()});
    }
  });
  return found;
}

CaseRecord StoreReader::read(const std::string& id) const {
  std::optional<CaseRecord> found;
  guarded(file_, database_.get(), [&] { found = read_case(*database_, id); });
  if (!found) throw StoreError(fmt::format("{}: the case {} is no longer there", file_.string(), id));
  return std::move(*found);
}

std::vector<std::string> StoreReader::motion_keys(const std::string& arithmetic) const {
  std::vector<std::string> found;
  const std::string prefix = motion_key(arithmetic, "");
  guarded(file_, database_.get(), [&] {
    SQLite::Statement rows(*database_, "SELECT key FROM motions ORDER BY key");
    while (rows.executeStep())
      if (const std::string key = rows.getColumn(0).getString(); key.starts_with(prefix))
        found.push_back(key.substr(prefix.size()));
  });
  return found;
}

std::string StoreReader::motion(const std::string& key, const std::string& arithmetic) const {
  std::string content;
  guarded(file_, database_.get(), [&] { content = find_motion(*database_, motion_key(arithmetic, key)); });
  return content;
}

}  // namespace ricochet
