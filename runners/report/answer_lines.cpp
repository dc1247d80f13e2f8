#include "runners/report/answer_lines.hpp"

#include "runners/table/table_reader.hpp"

namespace ricochet::report {

std::vector<std::string> answer_lines(const StudyResults& results) {
  std::vector<std::string> lines;
  const Table* table = find_table(results.derived, "answers");
  if (!table) return lines;
  const TableReader rows(*table);
  const size_t column = rows.column("sentence");
  for (size_t row = 0; row < rows.size(); ++row)
    if (std::string text = rows.text(row, column); !text.empty()) lines.push_back(std::move(text));
  return lines;
}

}  // namespace ricochet::report
