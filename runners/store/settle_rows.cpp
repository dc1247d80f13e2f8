#include <SQLiteCpp/Column.h>
#include <SQLiteCpp/Statement.h>
#include <fmt/format.h>

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "runners/store/atomic_file.hpp"
#include "runners/store/checksums.hpp"
#include "runners/store/fingerprint.hpp"
#include "runners/store/read_store.hpp"
#include "runners/store/schema.hpp"
#include "runners/store/statements.hpp"
#include "runners/store/store.hpp"

namespace ricochet {
namespace {

void remove_curve(const std::filesystem::path& folder, const std::string& id) {
  const std::filesystem::path file = folder / "curves" / (id + ".csv");
  std::error_code error;
  std::filesystem::remove(file, error);
  if (error) throw StoreError(fmt::format("{}: cannot be removed: {}", file.string(), error.message()));
}

}  // namespace

std::set<std::string> Store::settle_rows() {
  std::set<std::string> kept;
  std::vector<std::string> aside, dropped, back;
  const Damage damage = find_damage(*database_);
  if (damage.pages) throw StoreError(damage_text(file_, damage));
  damaged_ = {damage.cases.begin(), damage.cases.end()};
  SQLite::Statement stored(*database_, "SELECT id, fingerprint, status FROM cases");
  while (stored.executeStep()) {
    const std::string id = stored.getColumn(0).getString(), fingerprint = stored.getColumn(1).getString();
    const auto found = expected_.find(id);
    if (damage.cases.contains(id))
      dropped.push_back(id);
    else if (found != expected_.end() && found->second.first == fingerprint)
      kept.insert(id);
    else if (fingerprint.empty() || stored.getColumn(2).getString() == "refused")
      dropped.push_back(id);  // not finished, or nothing that was computed
    else
      aside.push_back(id);
  }
  stored.reset();
  for (const auto& [id, expected] : expected_)
    if (kept.count(id) == 0 && is_aside(*database_, expected.first)) back.push_back(id);

  // Before the rows: a run that is killed here misses a file, which is written anew, and never has that of another row.
  for (const auto& ids : {aside, dropped, back})
    for (const std::string& id : ids)
      if (is_case_id(id)) remove_curve(file_.parent_path(), id);
  SQLite::Statement drop(*database_, "DELETE FROM cases WHERE id = ?");
  for (const std::string& id : dropped) insert(drop, id);
  // What is left of a damaged case, whose own row may be lost.
  for (const std::string& id : damage.cases) {
    for (const auto& [table, columns] : kRowsOfCases)
      insert(prepared_->of(fmt::format("DELETE FROM {} WHERE case_id = ?", table)), id);
    insert(prepared_->of("DELETE FROM sums WHERE case_id = ?"), id);
  }
  if (damaged_keys(*database_).contains("environment"))  // stated anew it would pass for whole
    write_environment({{{"environment", "damaged, left out"}}});
  Environment environment = read_environment(*database_);
  set_aside(*database_, aside, environment);
  SQLite::Statement move(*database_, "UPDATE cases SET position = ? WHERE id = ?");
  for (const std::string& id : kept) {
    insert(move, expected_.at(id).second, id);
    seal_place(*prepared_, id);
  }

  bool any = !kept.empty();  // of whose environment something is left
  for (const std::string& id : back) {
    const Environment earlier = bring_back(*database_, expected_.at(id).first, expected_.at(id).second);
    environment = any ? merge_environments(environment, earlier) : earlier;
    any = true;
    seal_place(*prepared_, id);
  }
  if (!back.empty()) write_environment(environment);
  returned_ = static_cast<int>(back.size());
  kept.insert(back.begin(), back.end());
  return kept;
}

}  // namespace ricochet
