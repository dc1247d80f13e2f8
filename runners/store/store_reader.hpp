#pragma once
#include <SQLiteCpp/Database.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "runners/store/record.hpp"

namespace ricochet {

/// FOLDER/results.sqlite, read case by case: what it holds may be larger than the memory. Errors are StoreError.
class StoreReader {
 public:
  explicit StoreReader(const std::filesystem::path& folder);

  /// The study and the environment, without cases.
  StudyResults head() const;
  /// A case that is finished, and what tells whether it is still that of the study.
  struct Finished {
    std::string id, fingerprint, status, arithmetic;
  };
  /// In the study's order.
  std::vector<Finished> finished() const;
  /// A case that finished() names.
  CaseRecord read(const std::string& id) const;

  /// The keys of Store::motion() for runs of this arithmetic, and what is kept under one of them.
  std::vector<std::string> motion_keys(const std::string& arithmetic) const;
  std::string motion(const std::string& key, const std::string& arithmetic) const;

 private:
  std::filesystem::path file_;
  std::unique_ptr<SQLite::Database> database_;
};

}  // namespace ricochet
