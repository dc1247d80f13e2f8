#pragma once
#include <SQLiteCpp/Database.h>

#include "runners/store/record.hpp"

namespace ricochet {

/// Makes the view v_cases of these results: the columns of cases.csv (cases_table) over the finished cases, by the same
/// names, so that a query needs neither the rows of axes and measures nor JSON. Truth values are 0 and 1. There is no
/// view of curves, nor of tables of numbers (impacts): their series are packed, and SQL cannot read doubles out of a
/// blob.
void make_views(SQLite::Database& database, const StudyResults& results);

}  // namespace ricochet
