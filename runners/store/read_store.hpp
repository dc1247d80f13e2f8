#pragma once
#include <SQLiteCpp/Database.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>

#include "runners/store/record.hpp"
#include "runners/store/store.hpp"

namespace ricochet {

/// Opens FOLDER/results.sqlite, which is there. Throws StoreError.
std::unique_ptr<SQLite::Database> open_store(const std::filesystem::path& folder);

/// The same, for `use`.
void with_store(const std::filesystem::path& folder, const std::function<void(SQLite::Database&)>& use);

/// Reads every table in one read transaction: the state after some whole number of finished cases. The series of these
/// are read when somebody asks for them.
StudyResults read_tables(SQLite::Database& database);

/// What it holds of the study, and the environment; no cases.
StudyResults read_head(SQLite::Database& database);

/// One case, whole; nothing where there is none of this id.
std::optional<CaseRecord> read_case(SQLite::Database& database, const std::string& id);

/// The part of its study that the store holds; nothing where it holds none yet.
std::optional<StudyPart> read_part(SQLite::Database& database);

/// What is kept under a whole key of the motions; "" where nothing is.
std::string find_motion(SQLite::Database& database, const std::string& whole_key);

/// Where the stored cases ran.
Environment read_environment(SQLite::Database& database);

}  // namespace ricochet
