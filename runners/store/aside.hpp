#pragma once
#include <SQLiteCpp/Database.h>

#include <string>
#include <vector>

#include "runners/store/record.hpp"

/// \file
/// Cases of earlier versions of a study: kept in the store beside those that are asked for, by fingerprint, with their
/// measures, curves and tables and the environment they ran in, seen by nobody until they are asked for again. Each
/// call is made inside a transaction.
namespace ricochet {

/// Moves these cases, of this environment, aside.
void set_aside(SQLite::Database& database, const std::vector<std::string>& ids, const Environment& environment);

/// Whether a case of this fingerprint is kept aside.
bool is_aside(SQLite::Database& database, const std::string& fingerprint);

/// Moves the case of this fingerprint back, to its place in the study's order. Returns the environment it ran in.
Environment bring_back(SQLite::Database& database, const std::string& fingerprint, int position);

/// The number of cases that are kept aside.
int count_aside(SQLite::Database& database);

}  // namespace ricochet
