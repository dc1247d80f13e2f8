#pragma once
#include <SQLiteCpp/Database.h>

#include <filesystem>
#include <functional>
#include <optional>

#include "runners/store/record.hpp"

namespace ricochet {

/// Opens FOLDER/results.sqlite, which is there, for `use`. Throws StoreError.
void with_store(const std::filesystem::path& folder, const std::function<void(SQLite::Database&)>& use);

/// Reads every table in one read transaction: the state after some whole number of finished cases.
StudyResults read_tables(SQLite::Database& database);

/// The part of its study that the store holds; nothing where it holds none yet.
std::optional<StudyPart> read_part(SQLite::Database& database);

/// Where the stored cases ran.
Environment read_environment(SQLite::Database& database);

}  // namespace ricochet
