#pragma once
#include <SQLiteCpp/Database.h>

#include <filesystem>

#include "runners/store/run_identity.hpp"

namespace ricochet {

/// Which run a store belongs to: a number that each run raises when it begins, with the name of that run. A lock on the
/// folder says the same where locks hold; on file systems where they do not (locks that each node keeps for itself, a
/// scheduler that starts a job again while its first start lives on), whoever finds another number than its own has
/// lost the store.
///
/// Both functions are called within the transaction that they speak of.
class Epoch {
 public:
  /// Takes the store over. Throws StoreError where it belongs to a later start of the same job.
  void raise(SQLite::Database& database, const std::filesystem::path& file);
  /// Throws StoreError, naming the run, where another one has taken the store over since. Nothing before raise().
  void check(SQLite::Database& database, const std::filesystem::path& file) const;

 private:
  long long number_ = 0;  // 0: none yet
};

}  // namespace ricochet
