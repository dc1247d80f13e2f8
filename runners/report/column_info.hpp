#pragma once
#include <string>

namespace ricochet::report {

/// The unit of a column of a table and what it means; "" where nothing is known.
struct ColumnInfo {
  std::string unit, text;
};

/// Axes and measures by their names, and the columns that derived tables share.
ColumnInfo column_info(const std::string& name);

}  // namespace ricochet::report
