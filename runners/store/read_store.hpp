#pragma once
#include <SQLiteCpp/Database.h>

#include "runners/store/record.hpp"

namespace ricochet {

/// Reads every table in one read transaction: the state after some whole number of finished cases.
StudyResults read_tables(SQLite::Database& database);

/// Where the stored cases ran.
Environment read_environment(SQLite::Database& database);

}  // namespace ricochet
